#include "verbs/optimize.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "optimizers/problem.h"
#include "reports/seeds_report.h"
#include "studies/search/searched_families.h"
#include "verbs/report_outcome.h"

namespace softland::verbs {
namespace {

// Returns the names of the targets with a separate cost function: "settling, impact and energy".
std::string targets_with_own_cost() {
  std::vector<std::string_view> names;
  for (const TargetRow& row : targets) {
    if (row.has_own_cost) names.push_back(row.name);
  }
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

std::string optimizer_help() {
  std::string text = "\nOptimizers:\n";
  for (const std::string_view name : optimizer_names()) {
    text += "  " + std::string(name) + std::string(14 - std::min<std::size_t>(13, name.size()), ' ') +
            std::string(optimizer_description(name)) + "\n";
  }
  return text;
}

struct OptimizeVerb : Usual, OptimizeRequest {
  static constexpr auto name = "optimize", about = "search a drive waveform that closes the switch without bounce",
                        python = "optimize", scene = scene_alone,
                        leaves = "folder for the report, the found waveform and all data (default: softland-out)",
                        place = "softland-out";
  static constexpr auto in_python =
      "The result has the keys of result.json, and `files` such as best.toml. `softland optimize --help` lists the optimizers.";
  static constexpr Takes takes{.scene = false};
  static Outcome shown_again(const nlohmann::json& json) {
    if (json.contains("baseline") || !json.contains("seeds")) return closing_shown_again(json);
    const SeedsRecord record = read_seeds(json);  // read the JSON of an interrupted study of several seeds
    return {.json = json_of(record), .text = text_of(record)};
  }
  static std::string remarks() {
    return "Without SCENE, scenes/mem-gold-pzt.toml is used. The hold voltage of the scene is kept, and so are the limits of\n"
           "[driver.*].\n"
           "A scene that already lands softly (best.toml of an earlier search) is refined. "
           "Without --robust it never ends worse.\n" +
           optimizer_help() +
           "\nExamples:\n  softland optimize --target bounce --actuator pzt\n"
           "  softland optimize scenes/mem-gold.toml --cycle \"2 kHz\"\n"
           "  softland optimize scenes/mem-gold.toml --seeds 8 --out seeds\n"
           "  softland optimize --resume --out seeds --budget 5000\n"
           "  softland optimize my.toml --start run1/best.toml --out run2\n"
           "  softland optimize scenes/mem-gold.toml --actuator electrostatic --waveform pulse --seed 3 --out run3\n"
           "  softland optimize scenes/mem-gold.toml --robust cvar:0.9 --constrain \"initial_contact_time < 65 us\"\n"
           "  softland optimize scenes/mem-gold.toml --robust cvar:0.9 --waveform catch --calibrate \"Vdp:1 %,frequency:0.5 %\"";
  }
};

template <class Archive>
void options(Archive& a, OptimizeVerb& r) {
  const auto by_default = [](std::string names) { return names.insert(names.find(','), " (default)"); };
  a.text("target", r.target, "NAME",
         by_default(listed(targets)) +
             ", or a weighted sum such as \"0.7 bounce + 0.3 energy\"; "
             "the goal of each target includes that no rebound is significant");
  a.object("objective", "Callable[[dict[str, Any], dict[str, float]], Any] | None", "None",
           "(closing, step) -> F, used instead of a target: both arguments are dicts of figures [SI], "
           "of the candidate and of the plain step. F >= 0, about 1 for the step, is minimised. "
           "In a search over devices it is called once for a candidate: the figures of `closing` are arrays (devices,) "
           "of the devices that close, and it returns an array; for the nominal design they are floats");
  a.object("lands_first", "bool", "True", "True: waveforms without a significant rebound come first, ranked by the objective");
  a.object("own_waveforms", "Sequence[OwnWaveform]", "()",
           "waveform families written as Python functions; `waveform` selects them by name");
  a.as({.type = "Literal[\"electrostatic\", \"pzt\", \"both\"] | None", .value = "None"})
      .text("actuator", r.actuator, "NAME",
            "drives that the search may shape: " + listed(actuators) +
                "; default: all drives of the scene; with --robust none or one statistic: electrostatic");
  a.text(
      "waveform", r.waveform, "NAME",
      "waveform family to search: " + listed_searched_families() +
          "; N is the number of levels, knots, pulses or sines, such as knots:8. "
          "Each drive may have its own family: main=step,pzt=pulse. "
          "Families joined by + are searched in turn: each search starts from the results of the earlier ones, "
          "and the best waveform is refined. Defaults: " +
          fmt::format("{} for electrostatic, {} for both and for electrodes on both sides, {} for pzt, "
                      "knots with one statistic of --robust, and catch with --calibrate. "
                      "quasi-static shapes all drives and needs a search over devices",
                      default_families(Shaped::electrode), default_families(Shaped::several), default_families(Shaped::piezo)));
  a.text("robust", r.robust, "MEASURE",
         "search under the process variation of [spread]. auto (default, except with --seeds; "
         "a spread is assumed if the scene has none) compares statistics and waveform families over simulated devices, "
         "and searches for the nominal design as well. none searches for the nominal design only. "
         "One statistic: yield (share of bounce-free devices), yield:\"bounce_count == 0\", cvar:0.9 (mean of the worst 10 %), "
         "quantile:0.95, mean+2sigma or worst");
  a.repeated("constrain", r.constrain, "CONDITION",
             "condition that the found waveform must fulfil for the nominal design and for 95 % of the devices, "
             "such as \"permanent_contact_time < 60 us\"; may be repeated");
  a.text("hold-step", r.hold_step, "chosen|fixed",
         "with --actuator pzt, time of the plain step of the electrode: chosen (default) searches the time, "
         "after a slow approach by the piezo; fixed is t = 0");
  a.text("calibrate", r.calibrate, "LIST",
         "per-device calibration: figures measured on every device, by which its waveform is scaled, "
         "such as \"Vdp,frequency\" or, with measurement errors, \"Vdp:1 %,frequency:0.5 %\". "
         "piezo is the deflection per volt divided by the contact gap. "
         "\"Vdp,frequency in 8 classes\" sorts the devices into classes with one waveform each. none ignores [calibration]");
  a.as({.type = "int | None"})
      .text("samples", r.samples, "N",
            "with one statistic of --robust, number of devices in the search (default: 128); "
            "with auto, number of new devices for the final evaluation (default: 2000)");
  a.text("optimizer", r.optimizer, "NAME", "auto (default), or another name of the list below");
  a.program().repeated(
      "start", r.starts, "FILE",
      "start from the waveform of this scene or result, such as that of softland limit. "
      "Its drives must be those that are searched. A waveform of another family is approximated in the searched family. "
      "Without --robust the search never ends worse than its start; may be repeated");
  a.object("start", "Sequence[Mapping[str, Waveform]]", "()", "waveforms by drive [V] to start from");
  a.as({.type = "int | str | None"})
      .text(
          "budget", r.budget, "N|TIME",
          fmt::format(
              "number of evaluations, or time such as \"90 s\". Default: {} for an electrode, {} for several drives, "
              "{} for a piezo, and half as many again for the targets {}. "
              "A search over devices adds {} closings of devices, up to twice as many if many devices land softly, "
              "or fewer if closings are slow to simulate (the first line of the output says so). "
              "With --robust auto, N counts the closings of the search, beside those by which its waveforms are compared and judged; with one statistic, closings of devices (default: {})",
              default_budget(Target::bounce, Shaped::electrode), default_budget(Target::bounce, Shaped::several),
              default_budget(Target::bounce, Shaped::piezo), targets_with_own_cost(), tournament_closings, default_closings));
  seed_option(a.as({.type = "int | None"}), r.seed, "the same result, whatever --jobs is");
  a.program().text("seeds", r.seeds, "N",
                   "search from N seeds, --seed and the following ones, as one study: the best result is reported, "
                   "with the scatter of the others");
  a.flag("resume", r.resume,
         "continue the search in the folder of --out that was interrupted or ended by its budget. "
         "Known evaluations are not simulated again, and options that are not given keep their values");
  a.program().text(
      "cycle", r.cycle, "RATE",
      "search the closing and the opening waveform together, for a switch that is cycled at this rate, such as \"2 kHz\"; "
      "the same as softland cycle --search");
  a.program().text("duty", r.duty, "SHARE", "with --cycle, share of a cycle before the command to open (default: 50 %)");
  a.program().flag(
      "limit", r.limit,
      fmt::format(
          "always compare the first touch with the least time of any waveform (softland limit): also with a budget below {}, "
          "with max_slew in a driver, and with more than four modes of a cantilever, where this may take minutes",
          evaluations_worth_a_limit));
  jobs_option(a, r.jobs, "number of threads (default: one per core)");
  a.object("out", "str | os.PathLike[str] | None", "None",
           "folder that keeps all evaluations during the search, and receives its files at the end");
  a.object("callback", "Callable[[int, float, float, float], Any] | None", "None",
           "(evaluations, best cost, cost of the plain step, current cost) is called after each recorded evaluation. "
           "If it returns True, the search ends, and its best waveform so far is the result");
}

}  // namespace

OptimizeRequest optimize_request(const Arguments& arguments) { return read_options<OptimizeVerb>(arguments); }

Study optimize_study() { return described<OptimizeVerb>(); }

}  // namespace softland::verbs
