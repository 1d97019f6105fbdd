// The command line: what is asked, and nothing else.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>

#include "apps/exit_status.h"
#include "apps/failure.h"
#include "apps/interrupt.h"
#include "apps/output.h"
#include "apps/shell_word.h"
#include "apps/streams.h"
#include "apps/verbs.h"
#include "base/require.h"
#include "optimizers/problem.h"
#include "sampling/points.h"
#include "studies/other_ways.h"
#include "studies/search_space.h"
#include "version.h"

namespace {

using namespace softland;
using namespace softland::apps;

// Quoted so that the line can be pasted into a shell.
std::string command_line(int argc, char** argv) {
  std::string line = "softland";
  for (int i = 1; i < argc; ++i) line += " " + shell_word(argv[i]);
  return line;
}

std::string optimizer_help() {
  std::string text = "\nOptimizers:\n";
  for (const std::string_view name : optimizer_names()) {
    text += "  " + std::string(name) + std::string(14 - std::min<std::size_t>(13, name.size()), ' ') +
            std::string(optimizer_description(name)) + "\n";
  }
  return text;
}

const std::vector<std::string> coming{"explore"};

int run(int argc, char** argv) {
  Common common{.command = command_line(argc, argv), .stop = &stop_requested()};
  OptimizeRequest request;
  ExportRequest exported;
  std::string kind = "cantilever", result;

  // Called by the name `optimize`, the program is that verb.
  std::vector<std::string> words(argv + 1, argv + argc);
  if (std::filesystem::path(argv[0]).filename() == "optimize") {
    words.insert(words.begin(), "optimize");
    common.command.insert(8, " optimize");
  }
  for (const std::string& verb : coming) {
    if (!words.empty() && words.front() == verb) throw InvalidInput("the verb '" + verb + "' is not available yet");
  }
  for (const std::string& word : words) {
    for (const std::string_view option : {"--resume", "--shard"}) {
      if (word == option || word.starts_with(std::string(option) + "="))
        throw InvalidInput("the option " + std::string(option) + " is not available yet");
    }
  }

  CLI::App app{
      "softland lands MEMS switches softly: it simulates the closing of a described switch and searches the open-loop drive\n"
      "waveform that closes it fast and without bounce.\n"};
  app.name("softland");
  app.get_formatter()->label("SUBCOMMAND", "VERB");
  app.get_formatter()->column_width(24);
  app.require_subcommand(1);
  app.set_help_flag("-h,--help", "print this help");
  app.set_version_flag("--version", "softland " + std::string(version), "print the version");
  app.footer(
      "Examples:\n"
      "  softland optimize --target bounce --actuator pzt\n"
      "  softland new > my-switch.toml\n"
      "  softland check my-switch.toml\n"
      "  softland simulate my-switch.toml --set gap.contact=\"1.8 um\" --out closing\n"
      "  softland optimize my-switch.toml --actuator electrostatic --waveform pulse --budget \"90 s\"\n"
      "\nExit status: 0 done, 2 bad input, 3 numerical failure, 4 done but without success, 70 internal error (please report),\n"
      "71 no memory or threads, 74 output lost (disk full, pipe closed), 130 interrupted (what there is is written).");

  const auto first_is_default = [](std::string names) { return names.insert(names.find(','), " (default)"); };
  // `word` stands for the value in --help. Empty text is never meant: it comes from an unset shell variable.
  const auto option = [](CLI::App* verb, const char* name, std::string& value, const char* word, const std::string& about) {
    return verb->add_option(name, value, about)->type_name(word)->check([](const std::string& text) {
      return text.empty() ? "must not be empty" : "";
    });
  };
  const auto positional = [&](CLI::App* verb, const char* name, std::string& value, const char* about) {
    return option(verb, name, value, "", about);
  };
  // Empty text is looked at with the value.
  const auto optional = [](CLI::App* verb, const char* name, std::optional<std::string>& value, const char* word,
                           const char* about) {
    verb->add_option_function<std::string>(
            name, [&value](const std::string& text) { value = text; }, about)
        ->type_name(word);
  };
  const auto add_verb = [&](const char* name, const char* about) { return app.add_subcommand(name, about)->group("Verbs"); };
  const auto with_scene = [&](CLI::App* verb, bool required) {
    positional(verb, "SCENE", common.scene, "scene file (TOML)")->required(required);
    verb->add_option("--set", common.set, "change one key: --set gap.contact=\"1.8 um\"; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    verb->add_flag("--quiet", common.quiet, "no progress and no notes on standard error");
  };
  const auto with_json = [&](CLI::App* verb) {
    option(verb, "--json", common.json, "FILE", "write the result as JSON to this file, or - for standard output");
  };

  CLI::App* simulate = add_verb("simulate", "simulate the closing that a scene describes");
  with_scene(simulate, true);
  with_json(simulate);
  option(simulate, "--out", common.out, "FOLDER", "folder for report.html, gap.svg, result.json and trajectory.csv");
  bool certified = false;
  simulate->add_flag("--certify", certified, "errors that cover the true ones, and clouds of runs for ill-conditioned figures");
  optional(simulate, "--jobs", request.jobs, "N",
           "threads of --certify (default: one per core); the result does not depend on them");
  simulate->footer("Example:\n  softland simulate scenes/mem-gold.toml --set waveform.main.level=\"1.1 Vdp\" --json -");

  CLI::App* pull_in = add_verb("pull-in", "static and dynamic pull-in voltage and release voltage of every electrode");
  with_scene(pull_in, true);
  with_json(pull_in);
  pull_in->footer("Example:\n  softland pull-in scenes/mem-gold.toml --set structure.thickness=\"2.1 um\"");

  CLI::App* modes = add_verb("modes", "natural frequencies");
  with_scene(modes, true);
  with_json(modes);
  modes->footer("Example:\n  softland modes scenes/mem-gold-pzt.toml --set structure.modes=8");

  CLI::App* check = add_verb("check", "validate a scene and print derived numbers and warnings");
  with_scene(check, true);
  check->footer("Example:\n  softland check my-switch.toml");

  CLI::App* effects = add_verb("effects", "which effects matter in a scene, by how much, and what each costs");
  with_scene(effects, true);
  with_json(effects);
  effects->footer("Example:\n  softland effects scenes/mem-gold.toml --set gas.pressure=\"1 kPa\"");

  CLI::App* accuracy =
      add_verb("accuracy", "what accuracy costs in time: errors of the figures for every integrator and setting");
  with_scene(accuracy, true);
  with_json(accuracy);
  option(accuracy, "--out", common.out, "FOLDER", "folder for report.html, accuracy.svg and accuracy.json");
  accuracy->footer(
      "Combinations that take more than 2 s per closing are cut, and listed as such.\n"
      "Example:\n  softland accuracy scenes/mem-gold.toml --set simulate.duration=\"100 us\" --out accuracy");

  CLI::App* optimize = add_verb("optimize", "search the drive waveform that closes without bounce");
  with_scene(optimize, false);
  with_json(optimize);
  option(optimize, "--target", request.target, "NAME",
         first_is_default(listed(targets)) + "; the goal of each asks for no significant rebound");
  option(optimize, "--actuator", request.actuator, "NAME",
         "drives that the search may shape: " + first_is_default(listed(actuators)));
  option(optimize, "--waveform", request.waveform, "NAME",
         "family to search: pulse (default), step, harmonic, catch, ramp, staircase or knots; with a number of levels or knots: "
         "knots:8");
  option(optimize, "--robust", request.robust, "MEASURE",
         "search for devices that differ as [spread] says, and minimise over them: cvar:0.9 (the mean of the worst tenth), "
         "quantile:0.95, mean+2sigma, worst or yield:\"bounce_count == 0\"");
  optimize
      ->add_option("--constrain", request.conditions,
                   "condition that 95 % of the devices have to fulfil: \"permanent_contact_time < 60 us\"; may be repeated")
      ->type_name("CONDITION")
      ->allow_extra_args(false);
  option(optimize, "--calibrate", request.calibration, "LIST",
         "measured on every device before it is driven, whose waveform is then in its own units: \"Vdp,frequency\" or, with "
         "errors, \"Vdp:1 %,frequency:0.5 %\"; \"Vdp,frequency in 8 classes\": sorted by it, one waveform for each class; none: "
         "not even what [calibration] says");
  optional(optimize, "--samples", request.samples, "N", "devices that a robust search looks at (default: 128)");
  option(optimize, "--optimizer", request.optimizer, "NAME", "auto (default), or another of the names below");
  optional(optimize, "--budget", request.budget, "N|TIME",
           "evaluations, or time (\"90 s\"); default: 2500 for electrostatic, 10000 for pzt and both, half as much again for "
           "settling, impact and energy; with --robust closings of devices, 60000");
  optional(optimize, "--seed", request.seed, "N",
           "whole number from 0 on (default 1): same seed, same result, whatever --jobs is");
  optional(optimize, "--jobs", request.jobs, "N", "threads (default: one per core)");
  option(optimize, "--out", common.out, "FOLDER",
         "folder for the report, the waveform found and all data (default: softland-out)");
  optimize->footer(
      "Without a scene: scenes/mem-gold-pzt.toml. The hold level is the scene's own; its [driver.*] limits are never left.\n"
      "A scene that holds a landing already (best.toml of an earlier search) is refined and, without --robust, never ends "
      "worse.\n" +
      optimizer_help() +
      "\nExamples:\n  softland optimize --target bounce --actuator pzt\n"
      "  softland optimize scenes/mem-gold.toml --actuator electrostatic --waveform pulse --seed 3 --out run3\n"
      "  softland optimize scenes/mem-gold.toml --robust cvar:0.9 --constrain \"initial_contact_time < 65 us\"\n"
      "  softland optimize scenes/mem-gold.toml --robust cvar:0.9 --waveform catch --calibrate \"Vdp:1 %,frequency:0.5 %\"");

  RobustnessRequest robust;
  CLI::App* robustness = add_verb("robustness", "how drives do on devices that differ as [spread] says");
  positional(robustness, "SCENE", common.scene, "scene file with [spread], folder that --out named, or result.json")->required();
  robustness->add_option("RESULT", robust.results, "more of them, whose drives are judged on the devices of the first")
      ->type_name("");
  robustness->add_option("--set", common.set, "change one key of the first: --set spread.gaps.cov=\"1 %\"; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  robustness->add_flag("--quiet", common.quiet, "no progress and no notes on standard error");
  with_json(robustness);
  optional(robustness, "--samples", robust.samples, "N", "devices (default: 2000)");
  option(robustness, "--points", robust.points, "NAME", "how they are chosen: " + first_is_default(listed(point_sets)));
  option(robustness, "--calibrate", robust.calibration, "LIST",
         "measured on every device before it is driven, as for optimize; the report says what each measurement is worth");
  robustness->add_flag(
      "--other-ways", robust.other_ways,
      fmt::format("beside the sample, for the last drive: the worst and the best device of a box, by search, and "
                  "polynomial chaos; {} closings more",
                  2 * explained_figures.size() * OtherWaysOptions{}.closings_per_search));
  optional(robustness, "--seed", robust.seed, "N", "whole number from 0 on (default 1): same seed, same devices");
  optional(robustness, "--jobs", robust.jobs, "N", "threads (default: one per core); the result does not depend on them");
  option(robustness, "--out", common.out, "FOLDER",
         "folder for robustness.html, robustness.json, devices.csv and the worst devices as scenes");
  robustness->footer(
      "The plain step to the same hold levels is judged beside every drive. Every device gets the volts of the nominal one,\n"
      "or, where it is calibrated, the same waveform in its own units.\n"
      "Examples:\n  softland robustness scenes/mem-gold.toml --samples 500\n"
      "  softland robustness scenes/mem-gold.toml --other-ways --out box\n"
      "  softland robustness scenes/mem-gold.toml softland-out --out robust");

  CalibrateRequest measured;
  CLI::App* calibrate = add_verb("calibrate", "which measurable figures of a device pin its waveform best");
  positional(calibrate, "SCENE", common.scene, "scene file with [spread], folder that --out named, or result.json")->required();
  calibrate->add_option("--set", common.set, "change one key: --set spread.gaps.cov=\"1 %\"; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  calibrate->add_flag("--quiet", common.quiet, "no progress and no notes on standard error");
  with_json(calibrate);
  optional(calibrate, "--samples", measured.samples, "N", "devices (default: 256)");
  option(calibrate, "--steps", measured.steps, "LIST",
         "steps whose closing times are measured, in multiples of the nominal Vdp (default: 1.1,1.25,1.5)");
  option(calibrate, "--error", measured.errors, "LIST",
         "of the measurements, one standard deviation: \"Vdp:1 %,frequency:0.5 %\"; there are Vdp, Vsp, release, frequency and "
         "time (default: exact)");
  optional(calibrate, "--seed", measured.seed, "N", "whole number from 0 on (default 1): same seed, same devices");
  optional(calibrate, "--jobs", measured.jobs, "N", "threads (default: one per core); the result does not depend on them");
  calibrate->footer(
      "The scene's drive is the recipe: a landing, not the plain step. Every device is closed with the recipe's voltages and\n"
      "times multiplied by factors told from what is measured: from each figure, and from every pair.\n"
      "Example:\n  softland calibrate softland-out --error \"Vdp:0.2 %,frequency:0.1 %\"");

  CLI::App* fresh = add_verb("new", "print a commented scene to start from");
  positional(fresh, "KIND", kind,
             "cantilever (default), cantilever-pzt, clamped-clamped, plate, two-electrodes, nem-cantilever or nem-casimir");
  fresh->footer("Example:\n  softland new cantilever > my-switch.toml");

  CLI::App* exporting = add_verb("export", "print the waveforms of a result for a generator or a circuit simulator");
  positional(exporting, "RESULT", exported.result, "folder that --out named, result.json, or a scene file")->required();
  option(exporting, "--format", exported.format, "NAME", "csv (default) or spice-pwl");
  optional(exporting, "--device-vdp", exported.device_pull_in, "VOLTAGE",
           "dynamic pull-in voltage measured on a device: its own waveform, with voltages in proportion");
  optional(exporting, "--device-frequency", exported.device_frequency, "FREQUENCY",
           "first natural frequency measured on a device, with times in proportion to its period");
  exporting->footer(
      "Examples:\n  softland export softland-out --format spice-pwl > drive.cir\n"
      "  softland export softland-out --device-vdp \"14.6 V\" --device-frequency \"10.2 kHz\" > device-17.csv");

  CLI::App* report = add_verb("report", "make report.html and gap.svg of a result.json again");
  positional(report, "RESULT", result, "folder that --out named, or its result.json")->required();
  option(report, "--out", common.out, "FOLDER", "folder to write them to (default: beside the result)");
  report->footer("Example:\n  softland report softland-out");

  if (!words.empty() && !words.front().starts_with("-")) {
    const auto verbs = app.get_subcommands([](const CLI::App*) { return true; });
    const auto asked = [&](const CLI::App* verb) { return verb->get_name() == words.front(); };
    if (std::none_of(verbs.begin(), verbs.end(), asked))
      throw InvalidInput("there is no verb '" + words.front() + "' (see softland --help)");
  }
  try {
    std::reverse(words.begin(), words.end());  // CLI11 takes the words from the back
    app.parse(words);
  } catch (const CLI::CallForHelp&) {
    print(app.help());
    return exit_done;
  } catch (const CLI::CallForVersion&) {
    print(app.version() + "\n");
    return exit_done;
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    if (chosen.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
      throw InvalidInput(
          "a verb is required: simulate, pull-in, modes, check, effects, accuracy, optimize, robustness, calibrate, new, export "
          "or "
          "report "
          "(see softland --help)");
    }
    throw InvalidInput(std::string(error.what()) + " (see softland " + (chosen.empty() ? "" : chosen.front()->get_name() + " ") +
                       "--help)");
  }

  try {
    if (*simulate) return simulate_verb(common, certified, request.jobs);
    if (*robustness) return robustness_verb(common, robust);
    if (*pull_in) return pull_in_verb(common);
    if (*modes) return modes_verb(common);
    if (*check) return check_verb(common);
    if (*effects) return effects_verb(common);
    if (*accuracy) return accuracy_verb(common);
    if (*optimize) return optimize_verb(common, request);
    if (*calibrate) return calibrate_verb(common, measured);
    if (*fresh) return new_verb(kind);
    if (*exporting) return export_verb(common, exported);
    return report_verb(common, result);
  } catch (const OutputInterrupted&) {
    throw;
  } catch (const Interrupted&) {
    // Nothing was found yet: that is what the JSON says.
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
    say(failure.message);
    return failure.status;
  }
}
