// Declares the command-line options of a verb, in the order of its --help, and the action of the verb. This file also has the
// help texts of options that several verbs share.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace softland::apps {

/// The options that every verb has.
struct Common {
  std::string command;           ///< command line, recorded in results
  std::string scene;             ///< path of the scene file
  std::vector<std::string> set;  ///< values KEY=VALUE of the options --set, in order
  std::string json;              ///< file for the JSON, "-" for standard output, empty for none
  std::string out;               ///< folder or file of --out, empty for none
  bool quiet = false;
  const std::atomic<bool>* stop = nullptr;
};

/// A verb on the command line. The values that its options set must live as long as the action of the verb: keep them in a
/// shared pointer that the function passed to runs() holds.
class Verb {
 public:
  /// `options` is the part of the command line that belongs to the verb; `common` receives the options that every verb has.
  Verb(CLI::App& options, Common& common) : options_(options), common_(common) {}

  void positional(const char* name, std::string& value, const std::string& about, bool required = true);
  /// Adds a positional argument with any number of words, after all other positional arguments.
  void more(const char* name, std::vector<std::string>& values, const std::string& about);
  /// Adds an option; `word` stands for the value in --help. An empty value, as from an unset shell variable, is refused.
  void option(const char* name, std::string& value, const char* word, const std::string& about);
  /// Adds an option whose value may be empty: the verb checks the value.
  void optional(const char* name, std::optional<std::string>& value, const char* word, const std::string& about);
  /// Adds an option with one value that may be given several times.
  void repeated(const char* name, std::vector<std::string>& values, const char* word, const std::string& about);
  void flag(const char* name, bool& value, const std::string& about);
  /// Sets the text below the options in --help: remarks and examples.
  void footer(const std::string& text);

  /// Adds the scene as a positional argument: `word` stands for the scene in --help, `what` describes the scene.
  void with_scene(const char* word, const char* what, bool required = true);
  void with_set(const std::string& about);
  void with_quiet();
  void with_json();
  void with_out(const std::string& about);
  void with_out_file(const std::string& about);

  /// Sets the action of the verb, which returns the exit status (apps/exit_status.h). An action that fails throws: see
  /// apps/failure.h.
  void runs(std::function<int(const Common&)> what) { run_ = std::move(what); }
  /// Returns true if the command line names this verb; call it after parsing.
  [[nodiscard]] bool chosen() const;
  [[nodiscard]] int run() const { return run_(common_); }

 private:
  CLI::App& options_;
  Common& common_;
  std::function<int(const Common&)> run_;
};

}  // namespace softland::apps
