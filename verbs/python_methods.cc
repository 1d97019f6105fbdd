// This program writes the methods of a scene in Python, one for each study: softland/_studies.py. Their parameters and
// docstrings come from the program's own description of its options.
#include <fmt/format.h>

#include <cctype>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "document/text.h"
#include "verbs/study.h"

namespace {

using softland::wrapped;
using softland::verbs::OptionRow;
using softland::verbs::Study;

constexpr std::string_view head =
    R"("""What softland tells of a scene: a method for each verb that looks at one. Made by the build, of what the program says."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

from ._closing import Closing
from ._outcome import Outcome
from ._progress import Progress
from ._studying import Studying, Told, _assigned, _flag, _joined, _pairs, _path, _paths, _quantity, _settings, _text, _whole
from ._tuning import PracticeDevice, Tuning
from ._waveform import OwnWaveform, Waveform

if TYPE_CHECKING:
    from ._results import Store


class Studies(Studying):
)";

// Formats a paragraph of a docstring: lines of 150 characters at most, those after the first further in.
std::string paragraph(std::string_view text) {
  constexpr std::size_t columns = 138;
  std::string line(text), lines;
  for (char& c : line) c = c == '\n' ? ' ' : c;
  for (const char c : wrapped(line, columns)) lines += c == '\n' ? std::string("\n            ") : std::string(1, c);
  return "        " + lines + "\n";
}

std::string parameter(const OptionRow& one) {
  return fmt::format("        {}: {}{},\n", one.keyword, one.type, one.value.empty() ? "" : " = " + one.value);
}

// Replaces the program's options in its words by those of Python: "threads of certify".
std::string in_keywords(std::string words, const Study& study) {
  for (const OptionRow& one : study.options) {
    const std::string option = "--" + one.name;
    for (std::size_t at = words.find(option); at != std::string::npos; at = words.find(option, at + 1)) {
      const std::size_t end = at + option.size();
      if (end == words.size() || (words[end] != '-' && std::islower(static_cast<unsigned char>(words[end])) == 0))
        words.replace(at, option.size(), one.keyword);
    }
  }
  return words;
}

// A verb that this module runs in its own way gets the given texts, and objects as they are.
std::string call(const Study& study, const std::string& told, const std::string& objects) {
  return study.ask && study.returns == std::string_view("Outcome")
             ? fmt::format("self._study(\"{}\", {}, progress{})", study.name, told, objects)
             : fmt::format("self._{}({}, progress{})", study.python, told, objects);
}

std::string method(const Study& study) {
  std::string positional, named, told, explained, objects;
  for (const OptionRow& one : study.options) {
    if (one.door == OptionRow::Door::program) continue;
    (one.is_positional ? positional : named) += parameter(one);
    explained += paragraph(one.keyword + ": " + one.note + in_keywords(one.about, study));
    if (one.kind != OptionRow::Kind::object) told += fmt::format("            \"{}\": {},\n", one.name, one.told);
    if (one.kind == OptionRow::Kind::object || one.kind == OptionRow::Kind::further) objects += ", " + one.keyword;
  }
  std::string about = study.about;
  about.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(about.front())));
  std::string text = fmt::format("    def {}(\n        self,\n{}        *,\n{}        progress: bool | Progress | None = {},\n",
                                 study.python, positional, named, study.progress);
  std::string more = explained;
  if (*study.in_python != '\0') more = paragraph(study.in_python) + (explained.empty() ? "" : "\n" + explained);
  text += fmt::format("    ) -> {}:\n        \"\"\"{}, as `softland {}`. Raises InvalidInput.{}\"\"\"\n", study.returns, about,
                      study.name, more.empty() ? more : "\n\n" + more + "        ");
  return text + (told.empty() ? fmt::format("        return {}\n", call(study, "{}", objects))
                              : fmt::format("        told: Told = {{\n{}        }}\n        return {}\n", told,
                                            call(study, "told", objects)));
}

}  // namespace

int main() {
  std::string text(head);
  bool is_first = true;
  for (const Study& study : softland::verbs::all_studies()) {
    text += (is_first ? "" : "\n") + method(study);
    is_first = false;
  }
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0 ? 0 : 1;
}
