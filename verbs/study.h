// A study is a verb that computes something from one scene. Options, computation and files of a study are described once, for
// the command line and for Python. Some verbs, such as the tuning on instruments, run differently on the command line and in
// Python: the description of such a verb has name, options and help, but no computation.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "config/scene.h"
#include "model/status.h"
#include "studies/closing/prepared.h"
#include "verbs/options.h"

namespace softland::verbs {

/// The way in which a verb ended; the program has an exit status for each.
enum class Ending { done, no_success, numerical_failure, interrupted };
/// Returns the way in which a verb ended whose closing has this status.
[[nodiscard]] Ending ending_of(Status status);

/// The results of a verb, for the command line and for Python.
struct Outcome {
  struct File {
    std::string name;
    std::function<std::string()> text;
    std::string listed = {};  ///< entry of the file in the printed list of files; empty: not listed
  };
  nlohmann::json json;
  std::string text;  ///< text of the outcome for a terminal
  std::vector<File> files = {};
  /// Text below the list of files, a command line of the verb `export`; "{}" stands for the path of the scene.
  std::string next = {};
  std::string last = {};   ///< text at the end of the terminal output
  std::string fault = {};  ///< reason why the verb did not succeed, printed to standard error even with --quiet
  Ending ending = Ending::done;
};

/// The input of every verb.
struct Setting {
  SceneFile scene;
  std::string name;     ///< name of the scene as the user gave it
  std::string command;  ///< command line or Python call, recorded in results
  const Progress& progress;
  /// Function that returns the scene prepared for simulation. With `default_limits`, electrodes and piezos without [driver] get
  /// the voltage limits of a search.
  std::function<std::shared_ptr<const PreparedScene>(bool default_limits)> prepared;
  /// Function that loads a scene from a scene file or from a result.
  std::function<SceneFile(const std::string&)> load;
  /// Function that returns the waveforms of a result for the switch of `nominal`. Throws InvalidInput if the waveforms do not
  /// fit the electrodes and piezos of the switch.
  std::function<DriveWaveforms(const std::string& result, const PreparedScene& nominal)> waveforms_of;
  /// Function that returns the text of the scene file, with comments.
  std::function<std::string()> text;
  /// Function that receives a line about the scene or the result while the verb runs; may be empty. The names of options in the
  /// line are marked by requested().
  std::function<void(const std::string&)> note = {};
  bool leaves_files = true;  ///< false: nobody reads Outcome::files, so that a verb may leave out what only they need
};

/// The general options that a verb takes, and their descriptions.
struct Takes {
  bool scene = true;                           ///< true if the verb requires a scene
  bool set = true, quiet = true, json = true;  ///< true if the verb has the options --set, --quiet and --json of the program
};

struct Study {
  const char *name, *about;
  /// The verb's method of a scene in Python: its name, the type of its result, and the default of its argument `progress`.
  const char *python, *returns, *progress;
  const char* in_python;        ///< further text of the docstring of the verb's method in Python
  const char *subject, *scene;  ///< word for the scene in --help, and description of the scene
  Takes takes;
  bool is_explorable;   ///< true if an exploration may run the verb at its points
  const char* leaves;   ///< description of the files that the verb writes to --out; null: no files
  const char* place;    ///< default folder of the verb's files; null: without --out no files are written
  const char* leaving;  ///< option that the user must give together with --out; null: none
  const char* changes;  ///< example of --set in the help of the verb
  std::string remarks;
  std::vector<std::string> files;  ///< names of files that the verb may write to --out
  std::vector<OptionRow> options;
  /// A function that reads the given options and returns a function that runs the verb. Throws InvalidRequest. Empty if the
  /// command line and Python run the verb differently.
  std::function<std::function<Outcome(const Setting&)>(const Arguments&)> ask = {};
  /// A function that makes the text and the files of an outcome again from its JSON, as far as possible. Throws InvalidInput
  /// for other JSON. Empty if the verb writes no JSON that can be read again.
  std::function<Outcome(const nlohmann::json&)> shown_again = {};

  /// Returns the name that an option has in Python.
  [[nodiscard]] std::string keyword(std::string_view option) const;
};

inline constexpr auto scene_or_result = "scene file (TOML), result folder (the --out of an earlier run), or result.json";
inline constexpr auto varied_scene = "scene file with [spread], result folder (the --out of an earlier run), or result.json";
inline constexpr auto scene_alone = "scene file (TOML)";
inline constexpr auto usual_change = "change one key of the scene, such as --set gap.contact=\"1.8 um\"";

/// A base of request types: default values of the members that describe the verb of the request (see Study).
struct Usual {
  static constexpr const char *returns = "Outcome", *progress = "None", *in_python = "", *subject = "SCENE",
                              *scene = scene_or_result, *leaves = nullptr, *place = nullptr, *leaving = nullptr,
                              *changes = usual_change;
  static constexpr Takes takes{};
  static constexpr bool is_explorable = false;
  static std::vector<std::string> files() { return {}; }
};

/// Reads the request of a verb from the given options. Throws InvalidRequest.
template <class Request>
[[nodiscard]] Request read_options(const Arguments& arguments) {
  Request request;
  OptionReader reader(arguments);
  options(reader, request);
  return request;
}

/// Returns the description of a verb from its request: a struct with name, about, python and remarks, and a function template
/// options(archive, request). A request may also have shown_again(json).
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

/// Returns the description of a verb for whose request a function run(setting, request) exists.
template <class Request>
[[nodiscard]] Study study_of() {
  Study study = described<Request>();
  study.ask = [](const Arguments& arguments) -> std::function<Outcome(const Setting&)> {
    return [request = read_options<Request>(arguments)](const Setting& setting) { return run(setting, request); };
  };
  return study;
}

// The functions from here on each return the description of one verb.
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

/// scene_studies() returns the verbs that need only a scene, all_studies() all verbs described as studies, in the order of
/// --help.
[[nodiscard]] const std::vector<Study>& scene_studies();
[[nodiscard]] const std::vector<Study>& all_studies();
/// Returns the study (verb) with this name. Throws InvalidInput for an unknown name.
[[nodiscard]] const Study& study_named(std::string_view name);

}  // namespace softland::verbs
