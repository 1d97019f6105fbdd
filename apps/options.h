// Declares the command-line options of a verb, in the order of its --help, and its action. The texts of options that several
// verbs share stand here.
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
  std::string command;           ///< command line, for provenance
  std::string scene;             ///< path of the scene file
  std::vector<std::string> set;  ///< values of --set key=value, in order
  std::string json;              ///< file for the JSON, "-" for standard output, empty for none
  std::string out;               ///< folder or file of --out, empty for none
  bool quiet = false;
  const std::atomic<bool>* stop = nullptr;
};

/// A verb on the command line. The values that its options set must live as long as its action; keep them in a shared pointer
/// that the function passed to runs() holds.
class Verb {
 public:
  /// `options` is the verb's part of the command line; `common` receives the options that every verb has.
  Verb(CLI::App& options, Common& common) : options_(options), common_(common) {}

  void positional(const char* name, std::string& value, const std::string& about, bool required = true);
  /// Adds a positional argument of any number of words, after the other positional arguments.
  void more(const char* name, std::vector<std::string>& values, const std::string& about);
  /// Adds an option; `word` stands for the value in --help. An empty text, as from an unset shell variable, is refused.
  void option(const char* name, std::string& value, const char* word, const std::string& about);
  /// Adds an option whose empty text is checked like any other value.
  void optional(const char* name, std::optional<std::string>& value, const char* word, const std::string& about);
  /// Adds an option with one value that may be given several times.
  void repeated(const char* name, std::vector<std::string>& values, const char* word, const std::string& about);
  void flag(const char* name, bool& value, const std::string& about);
  /// Sets the remarks and examples below the options.
  void footer(const std::string& text);

  /// Adds the scene as a positional argument: `word` stands for it in --help, and `what` describes it.
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
