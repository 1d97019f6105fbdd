// A study is a verb that looks at one scene. Its options, its computation and its files are described once, for the command
// line and for Python. A verb that a door runs in its own way, such as a tuning on instruments or on a function of Python, has
// no computation: both doors take name, options and help from it.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/watch.h"
#include "config/scene.h"
#include "model/status.h"
#include "studies/closing/prepared.h"
#include "verbs/options.h"

namespace softland::verbs {

/// The ending of a verb. The program has an exit status for each.
enum class Ending { done, no_success, numerical_failure, interrupted };
/// Returns the ending of a verb whose closing has this status.
[[nodiscard]] Ending ending_of(Status status);

/// The findings of a verb, as the command line and Python take them.
struct Outcome {
  struct File {
    std::string name;
    std::function<std::string()> text;
    std::string listed = {};  ///< name in the list of files, "" where it is not listed
  };
  nlohmann::json json;
  std::string text;  ///< text for a terminal
  std::vector<File> files = {};
  std::string next = {};   ///< text below the files; "{}" stands for the scene in their folder that `export` takes
  std::string last = {};   ///< text below all
  std::string fault = {};  ///< reason why it is not done, for standard error even of a quiet run
  Ending ending = Ending::done;
};

/// The input of every verb.
struct Setting {
  SceneFile scene;
  std::string name;     ///< name of the scene as the user gave it
  std::string command;  ///< command line, for provenance
  const Watch& watch;
  /// Prepares the scene, without or with the limits that a search takes where the scene has none.
  std::function<std::shared_ptr<const PreparedScene>(bool default_limits)> prepared;
  /// Loads the scene of a file, or of a result.
  std::function<SceneFile(const std::string&)> load;
  /// Returns the waveforms of a result for the switch of `nominal`. Throws InvalidInput where they cannot drive it.
  std::function<DriveWaveforms(const std::string& result, const PreparedScene& nominal)> waveforms_of;
  /// Returns the scene as it is written, with its comments.
  std::function<std::string()> text;
  /// Takes a line about the scene or the result while the verb runs; empty: nobody listens. It names options as requested()
  /// does.
  std::function<void(const std::string&)> note = {};
};

/// The general options that a verb takes besides its own.
struct Takes {
  bool scene = true;                           ///< true where a scene is required
  bool set = true, quiet = true, json = true;  ///< options of the program
};

struct Study {
  const char *name, *about;
  const char *python, *returns, *progress;  ///< the method of a scene in Python, the type of its value, and a default
  const char* in_python;                    ///< further text of its docstring
  const char *subject, *scene;              ///< word for the scene in --help, and its description
  Takes takes;
  bool is_explorable;   ///< true where an exploration may run it at every point
  const char* leaves;   ///< description of the files in --out; null: it leaves no files
  const char* place;    ///< folder where --out names none; null: then none is written
  const char* leaving;  ///< option that the files belong to: --out requires it, and it requires --out; null: they belong to all
  const char* changes;  ///< example of --set
  std::string remarks;
  std::vector<std::string> files;  ///< names of files that --out may hold
  std::vector<OptionRow> options;
  /// Reads the given options; the study itself runs when the result is called. Throws InvalidRequest. Empty where a door runs
  /// the verb.
  std::function<std::function<Outcome(const Setting&)>(const Told&)> ask = {};
  /// Makes the text and the files of an outcome again from its JSON, as far as possible. Throws InvalidInput for other JSON.
  /// Empty where the verb leaves no record.
  std::function<Outcome(const nlohmann::json&)> shown_again = {};

  /// Returns the name of an option in Python.
  [[nodiscard]] std::string keyword(std::string_view option) const;
};

inline constexpr auto scene_or_result = "scene file (TOML), result folder (the --out of an earlier run), or result.json";
inline constexpr auto varied_scene = "scene file with [spread], result folder (the --out of an earlier run), or result.json";
inline constexpr auto scene_alone = "scene file (TOML)";
inline constexpr auto usual_change = "change one key of the scene, such as --set gap.contact=\"1.8 um\"";

/// Defaults for the members of a request that describe its verb.
struct Usual {
  static constexpr const char *returns = "Outcome", *progress = "None", *in_python = "", *subject = "SCENE",
                              *scene = scene_or_result, *leaves = nullptr, *place = nullptr, *leaving = nullptr,
                              *changes = usual_change;
  static constexpr Takes takes{};
  static constexpr bool is_explorable = false;
  static std::vector<std::string> files() { return {}; }
};

/// Reads a request from the given options. Throws InvalidRequest.
template <class Request>
[[nodiscard]] Request read_options(const Told& told) {
  Request request;
  OptionReader reader(told);
  options(reader, request);
  return request;
}

/// Returns the description of a request: a struct with name, about, python and remarks, and a template options(archive,
/// request). It has shown_again(json) where it leaves a record.
template <class Request>
[[nodiscard]] Study described() {
  OptionList list;
  Request defaults;
  options(list, defaults);
  Study study{.name = Request::name,
              .about = Request::about,
              .python = Request::python,
              .returns = Request::returns,
              .progress = Request::progress,
              .in_python = Request::in_python,
              .subject = Request::subject,
              .scene = Request::scene,
              .takes = Request::takes,
              .is_explorable = Request::is_explorable,
              .leaves = Request::leaves,
              .place = Request::place,
              .leaving = Request::leaving,
              .changes = Request::changes,
              .remarks =
                  [] {
                    if constexpr (requires { Request::remarks(); })
                      return Request::remarks();
                    else
                      return Request::remarks;
                  }(),
              .files = Request::files(),
              .options = list.all()};
  if constexpr (requires { Request::shown_again; }) study.shown_again = Request::shown_again;
  return study;
}

/// Returns the study of a request that has run(setting, request), too.
template <class Request>
[[nodiscard]] Study study_of() {
  Study study = described<Request>();
  study.ask = [](const Told& told) -> std::function<Outcome(const Setting&)> {
    return [request = read_options<Request>(told)](const Setting& setting) { return run(setting, request); };
  };
  return study;
}

// Each study has a file of its own.
[[nodiscard]] Study accuracy_study();
[[nodiscard]] Study calibrate_study();
[[nodiscard]] Study check_study();
[[nodiscard]] Study cycle_study();
[[nodiscard]] Study device_study();
[[nodiscard]] Study effects_study();
[[nodiscard]] Study explore_study();
[[nodiscard]] Study export_study();
[[nodiscard]] Study fit_study();
[[nodiscard]] Study limit_study();
[[nodiscard]] Study optimize_study();
[[nodiscard]] Study pull_in_study();
[[nodiscard]] Study release_study();
[[nodiscard]] Study robustness_study();
[[nodiscard]] Study simulate_study();
[[nodiscard]] Study tune_study();

/// Return the studies of a scene alone, and all studies, in the order of --help.
[[nodiscard]] const std::vector<Study>& scene_studies();
[[nodiscard]] const std::vector<Study>& all_studies();
/// Throws InvalidInput where no study has this name.
[[nodiscard]] const Study& study_named(std::string_view name);

}  // namespace softland::verbs
