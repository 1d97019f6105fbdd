// Writes the methods of a scene in Python, one for each study: softland/_studies.py. What they take, and what their docstrings
// say, is what the program says of its options.
#include <fmt/format.h>

#include <cctype>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "reports/text.h"
#include "verbs/study.h"

namespace {

using softland::wrapped;
using softland::verbs::OptionRow;
using softland::verbs::Study;

constexpr std::string_view head =
    R"("""What softland tells of a scene: a method for each verb that looks at one. Made by the build, of what the program says."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal

from ._outcome import Outcome
from ._progress import Progress
from ._studying import Studying, Told, _assigned, _flag, _joined, _pairs, _path, _quantity, _text, _whole
from ._waveform import Waveform


class Studies(Studying):
)";

// A paragraph of a docstring: lines of 150 characters at the most, those after the first further in.
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

std::string method(const Study& study) {
  std::string positional, named, told, explained, waveforms;
  for (const OptionRow& one : study.options) {
    (one.is_positional ? positional : named) += parameter(one);
    told += fmt::format("            \"{}\": {},\n", one.name, one.told);
    explained += paragraph(one.keyword + ": " + one.note + one.about);
    if (one.kind == OptionRow::Kind::further) waveforms = ", " + one.keyword;
  }
  std::string about = study.about;
  about.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(about.front())));
  std::string text = fmt::format("    def {}(\n        self,\n{}        *,\n{}        progress: bool | Progress | None = None,\n",
                                 study.python, positional, named);
  text += fmt::format("    ) -> Outcome:\n        \"\"\"{}, as `softland {}`. Raises InvalidInput.{}\"\"\"\n", about, study.name,
                      explained.empty() ? explained : "\n\n" + explained + "        ");
  return text +
         (told.empty()
              ? fmt::format("        return self._study(\"{}\", {{}}, progress{})\n", study.name, waveforms)
              : fmt::format("        told: Told = {{\n{}        }}\n        return self._study(\"{}\", told, progress{})\n", told,
                            study.name, waveforms));
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
