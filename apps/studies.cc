#include "apps/studies.h"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/shell_word.h"
#include "studies/closing/auto_settings.h"

namespace softland::apps {
namespace {

using verbs::Ending;
using verbs::OptionRow;

// Option values that CLI11 sets, by name of the option.
struct Given {
  std::map<std::string, std::string> texts;
  // Option values that may be empty texts; none: the option was not given.
  std::map<std::string, std::optional<std::string>> optional;
  std::map<std::string, bool> flags;
  std::map<std::string, std::vector<std::string>> repeated;

  [[nodiscard]] verbs::Arguments arguments() const {
    verbs::Arguments all;
    for (const auto& [name, text] : texts) {
      if (!text.empty()) all[name] = {text};
    }
    for (const auto& [name, text] : optional) {
      if (text) all[name] = {*text};
    }
    for (const auto& [name, is_told] : flags) {
      if (is_told) all[name] = {""};
    }
    for (const auto& [name, words] : repeated) {
      if (!words.empty()) all[name] = words;
    }
    return all;
  }
};

std::string spelled(std::string_view name) { return "--" + std::string(name); }

DriveWaveforms waveforms_of(const std::string& result, const PreparedScene& nominal, const Progress& progress) {
  const Drives drives = prepare(scene_of_result(result), false, progress).drives;
  const std::string elsewhere = initial_state_difference(drives.waveforms(), drives.before(), nominal);
  require(elsewhere.empty(), [&] { return result + ": " + elsewhere; });
  return drives.waveforms();
}

// Writes the files of a verb's outcome to the folder of --out. Returns text for the user: the names of the files, and the shell
// commands that use these files.
std::string leave(ResultFolder& folder, const verbs::Outcome& outcome) {
  const bool interrupted = outcome.ending == Ending::interrupted;
  std::vector<std::string> listed;
  std::string scene;
  for (const verbs::Outcome::File& file : outcome.files) {
    folder.write(file.name, file.text());
    if (!file.listed.empty()) listed.push_back(file.listed);
    if (file.name.ends_with(".toml")) scene = file.name;
  }
  const std::filesystem::path place = folder.destination(interrupted);
  std::string text = files_written(place, listed);
  if (!outcome.next.empty()) text += fmt::format(fmt::runtime(outcome.next), shell_word((place / scene).string()));
  folder.publish(interrupted);
  return text;
}

void declare(Verb& verb, const OptionRow& option, Given& given) {
  const std::string name = spelled(option.name);
  switch (option.kind) {
    case OptionRow::Kind::flag:
      return verb.flag(name.c_str(), given.flags[option.name], option.about);
    case OptionRow::Kind::repeated:
      return verb.repeated(name.c_str(), given.repeated[option.name], option.word.c_str(), option.about);
    case OptionRow::Kind::further:
      return verb.more(option.name.c_str(), given.repeated[option.name], option.about);
    case OptionRow::Kind::text:
    case OptionRow::Kind::object:
      break;
  }
  if (option.may_be_empty)
    verb.optional(name.c_str(), given.optional[option.name], option.word.c_str(), option.about);
  else
    verb.option(name.c_str(), given.texts[option.name], option.word.c_str(), option.about);
}

}  // namespace

int run_study(const verbs::Study& study, const Common& c, const verbs::Arguments& arguments) {
  const auto run = study.ask(arguments);
  if (study.leaving != nullptr)
    require(arguments.contains(study.leaving) == !c.out.empty(), [&] {
      return fmt::format("--{0} and --out must be given together: the {0} is written to the folder of --out", study.leaving);
    });
  const bool takes_results = study.scene != verbs::scene_alone;
  const SceneFile file = takes_results ? load_scene_or_result(c) : load_scene(c);
  static_cast<void>(read_scene(file));  // reading marks the files that the scene names as inputs: no output may replace them
  std::optional<ResultFolder> folder = reserve_outputs(c, study.files);
  std::optional<ShownWork> work(std::in_place, c.quiet, c.stop);
  const Progress& progress = work->progress();
  verbs::Outcome found =
      run({.scene = file,
           .name = c.scene,
           .command = c.command,
           .progress = progress,
           .prepared =
               [&](bool default_limits) {
                 return std::make_shared<const PreparedScene>(prepare_and_choose(file, default_limits, progress));
               },
           .load = scene_of_result,
           .waveforms_of = [&](const std::string& result,
                               const PreparedScene& nominal) { return waveforms_of(result, nominal, progress); },
           .text = [&] { return c.set.empty() ? read_file(c.scene) : file.text(); },
           .note = c.quiet ? std::function<void(const std::string&)>()
                           : [](const std::string& line) { print_note(with_fields(line, "--")); },
           .leaves_files = folder.has_value()});
  work.reset();
  if (folder && !found.files.empty()) found.text += leave(*folder, found);
  print_json_or(c, found.json, found.text + found.last);
  if (!found.fault.empty()) print_note(found.fault);
  return exit_status_of(found.ending);
}

void add_study(Verb& verb, const verbs::Study& study, RunTold run) {
  const auto given = std::make_shared<Given>();
  const auto declare_those = [&](bool behind_the_scene) {
    for (const OptionRow& option : study.options) {
      if (option.door != OptionRow::Door::python && (option.kind == OptionRow::Kind::further) == behind_the_scene)
        declare(verb, option, *given);
    }
  };
  verb.with_scene(study.subject, study.scene, study.takes.scene);
  declare_those(true);
  if (study.takes.set) verb.with_set(study.changes);
  if (study.takes.quiet) verb.with_quiet();
  if (study.takes.json) verb.with_json();
  declare_those(false);
  if (study.leaves != nullptr) verb.with_out(study.leaves);
  verb.footer(study.remarks);
  verb.runs([&study, given, run](const Common& common) {
    Common c = common;
    if (c.out.empty() && study.place != nullptr) c.out = study.place;
    return study.ask ? run_study(study, c, given->arguments()) : run(c, given->arguments());
  });
}

}  // namespace softland::apps
