// Main program: parses the command line and runs the requested verb (subcommand).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <deque>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "apps/exit_status.h"
#include "apps/failure.h"
#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/streams.h"
#include "apps/studies.h"
#include "apps/verbs/verbs.h"
#include "base/nearest.h"
#include "base/require.h"
#include "base/shell_word.h"
#include "version.h"

namespace {

using namespace softland;
using namespace softland::apps;

// Returns the command line, with every word quoted for a shell.
std::string command_line(const std::vector<std::string>& words) {
  std::string line = "softland";
  for (const std::string& word : words) line += " " + shell_word(word);
  return line;
}

void describe(CLI::App& app) {
  app.name("softland");
  app.get_formatter()->label("SUBCOMMAND", "VERB");
  // Width of the column of option names in --help [characters]; CLI11 puts the help of longer names on the next line.
  app.get_formatter()->column_width(25);
  app.require_subcommand(1);
  app.set_help_flag("-h,--help", "print this help");
  app.set_version_flag("--version", "softland " + std::string(version), "print the version");
  std::string footer =
      "Examples:\n"
      "  softland optimize --target bounce --actuator pzt\n"
      "  softland new > my-switch.toml\n"
      "  softland check my-switch.toml\n"
      "  softland simulate my-switch.toml --set gap.contact=\"1.8 um\" --out closing\n"
      "  softland optimize my-switch.toml --actuator electrostatic --waveform pulse --budget \"90 s\"\n"
      "\n"
      "Exit status:";
  for (const ExitStatus& one : exit_statuses) footer += fmt::format("\n  {:<4} {}", one.status, one.about);
  app.footer(footer);
}

// Returns a message about the words that no option takes, in the order given: CLI11 reverses them. Proposes the option that
// was meant.
std::string not_expected(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining(true);
  std::string text =
      words.size() == 1 ? "The following argument was not expected:" : "The following arguments were not expected:";
  for (const std::string& word : words) text += " " + word;
  const auto misspelt = std::ranges::find_if(words, [](const std::string& word) { return word.starts_with("--"); });
  if (misspelt == words.end() || app.get_subcommands().empty()) return text;
  std::vector<std::string> options;
  for (const CLI::Option* option : app.get_subcommands().front()->get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  return text + did_you_mean(misspelt->substr(0, misspelt->find('=')), {options.begin(), options.end()});
}

// Parses the words of the command line into the options of `app`. Returns false if the words ask for the help or the version,
// which is then printed: there is no verb to run.
bool parse(CLI::App& app, std::vector<std::string> words, const std::vector<std::string>& names) {
  if (!words.empty() && !words.front().starts_with("-") && std::ranges::find(names, words.front()) == names.end())
    throw InvalidInput("unknown verb '" + words.front() + "'" + did_you_mean(words.front(), {names.begin(), names.end()}) +
                       " (see softland --help)");
  try {
    std::reverse(words.begin(), words.end());  // CLI11 expects the words of the command line in reverse order
    app.parse(words);
    return true;
  } catch (const CLI::CallForHelp&) {
    print(app.help());
  } catch (const CLI::CallForVersion&) {
    print(app.version() + "\n");
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    if (chosen.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
      throw InvalidInput("a verb is required: " + in_words(names, " or ") + " (see softland --help)");
    const bool is_extra = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
    throw InvalidInput((is_extra ? not_expected(app) : std::string(error.what())) + " (see softland " +
                       (chosen.empty() ? "" : chosen.front()->get_name() + " ") + "--help)");
  }
  return false;
}

int run(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  // A link to the program with the name "optimize" runs the verb `optimize`.
  if (std::filesystem::path(argv[0]).filename() == "optimize") words.insert(words.begin(), "optimize");

  Common common{.command = command_line(words), .stop = &stop_requested()};
  CLI::App app{
      "softland simulates the closing of a MEMS switch, and searches open-loop drive waveforms that close it fast and without\n"
      "bounce.\n"};
  describe(app);
  std::deque<Verb> declared;
  std::vector<std::string> names;
  const auto add = [&](const char* name, const char* about) -> Verb& {
    names.emplace_back(name);
    return declared.emplace_back(*app.add_subcommand(name, about)->group("Verbs"), common);
  };
  for (const verbs::Study& study : verbs::all_studies()) {
    const auto* const own = std::ranges::find(runs, study.name, &RunRow::name);
    add_study(add(study.name, study.about), study, own == runs.end() ? nullptr : own->run);
  }
  for (const VerbRow& row : other_verbs) row.add(add(row.name, row.about));
  if (!parse(app, words, names)) return exit_done;

  const auto chosen = std::find_if(declared.begin(), declared.end(), [](const Verb& verb) { return verb.chosen(); });
  try {
    return chosen->run();
  } catch (const OutputInterrupted&) {
    throw;
  } catch (const Interrupted&) {
    // The run was interrupted before it had any result: the file of --json gets only the status "interrupted".
    if (!common.json.empty())
      print_json_or(common, {{"status", "interrupted"}, {"version", version}, {"command", common.command}}, "");
    throw;
  }
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  catch_signals();
  try {
    return run(argc, argv);
  } catch (...) {
    const Failure failure = failure_of(std::current_exception());
    print_note(failure.message);
    return failure.status;
  }
}
