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

// Returns "settling, impact and energy".
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
  static constexpr auto name = "optimize", about = "search the drive waveform that closes without bounce", python = "optimize",
                        scene = scene_alone,
                        leaves = "folder for the report, the waveform found and all data (default: softland-out)",
                        place = "softland-out";
  static constexpr auto in_python =
      "The result has the keys of result.json, and `files` such as best.toml. `softland optimize --help` lists the "
      "optimizers.";
  static constexpr Takes takes{.scene = false};
  static Outcome shown_again(const nlohmann::json& json) {
    if (json.contains("baseline") || !json.contains("seeds")) return closing_shown_again(json);
    const SeedsRecord record = read_seeds(json);  // a study of several seeds was interrupted
    return {.json = json_of(record), .text = text_of(record)};
  }
  static std::string remarks() {
    return "Without a scene: scenes/mem-gold-pzt.toml. The hold level is the scene's own; its [driver.*] limits are never left.\n"
           "A scene that holds a landing already (best.toml of an earlier search) is refined and, without --robust, never ends "
           "worse.\n" +
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
             ", or a weighted sum such as \"0.7 bounce + 0.3 energy\"; the goal of each asks for no significant rebound");
  a.object("objective", "Callable[[dict[str, Any], dict[str, float]], Any] | None", "None",
           "(closing, step) -> F in the place of a target: both are dicts of figures [SI], of a candidate and of the plain step; "
           "F >= 0, about 1 for the step, is minimised; over devices it is called once for a candidate: the figures of `closing` "
           "are arrays (devices,) of those that close, and it returns an array; of the drawing they are floats");
  a.object("lands_first", "bool", "True", "whether the objective counts among waveforms that land without a significant rebound");
  a.object("own_waveforms", "Sequence[OwnWaveform]", "()",
           "families that are functions of Python, for their names in `waveform`");
  a.as({.type = "Literal[\"electrostatic\", \"pzt\", \"both\"] | None", .value = "None"})
      .text("actuator", r.actuator, "NAME",
            "drives that the search may shape: " + listed(actuators) +
                "; default: all that the scene has, and with --robust none or a measure electrostatic");
  a.text("waveform", r.waveform, "NAME",
         "family to search: " + listed_searched_families() +
             ", with a number of levels, knots, pulses or sines: knots:8; for each drive its own: main=step,pzt=pulse; several, "
             "each begun where those before it ended, of which the best goes on: " +
             fmt::format(
                 "{} (default), {} (for both, and electrodes on both sides), {} (for pzt); with a measure of --robust knots, "
                 "with --calibrate catch; quasi-static moves all drives and is searched over devices",
                 default_families(Shaped::electrode), default_families(Shaped::several), default_families(Shaped::piezo)));
  a.text(
      "robust", r.robust, "MEASURE",
      "devices that differ as [spread] says: auto (default, but for --seeds; where the scene has no [spread] one is "
      "assumed) races measures and families over devices and searches for the drawing beside it; none searches for the drawing "
      "alone; one measure alone: yield (as many devices as possible without a rebound), yield:\"bounce_count == 0\", "
      "cvar:0.9 (the mean of the worst tenth), quantile:0.95, mean+2sigma, worst");
  a.repeated(
      "constrain", r.constrain, "CONDITION",
      "condition that the winner on the drawing, and 95 % of the devices, have to fulfil: \"permanent_contact_time < 60 us\"; "
      "may be repeated");
  a.text("hold-step", r.hold_step, "chosen|fixed",
         "with --actuator pzt, when the plain step of the electrode comes: at an instant that is searched, after a slow "
         "approach by the piezo (chosen, default), or at t = 0 (fixed)");
  a.text("calibrate", r.calibrate, "LIST",
         "measured on every device before it is driven, whose waveform is then in its own units: \"Vdp,frequency\" or, with "
         "errors, \"Vdp:1 %,frequency:0.5 %\"; piezo, the deflection per volt on it over the contact gap, as well; "
         "\"Vdp,frequency in 8 classes\": sorted by it, one waveform for each class; none: "
         "not even what [calibration] says");
  a.as({.type = "int | None"})
      .text("samples", r.samples, "N",
            "devices that a search by one measure looks at (default: 128), or fresh ones of the verdict (default: 2000)");
  a.text("optimizer", r.optimizer, "NAME", "auto (default), or another of the names below");
  a.program().repeated(
      "start", r.starts, "FILE",
      "begin with the waveform of this scene or result (of softland limit, say), which must be of the searched drives; "
      "from another family, with the nearest waveform of the searched one; it stays the best unless a better one is "
      "found, and without --robust the search never ends worse; may be repeated");
  a.object("start", "Sequence[Mapping[str, Waveform]]", "()", "waveforms by drive [V] to begin with");
  a.as({.type = "int | str | None"})
      .text("budget", r.budget, "N|TIME",
            fmt::format(
                "evaluations, or time (\"90 s\"); default: {} for an electrode, {} for several drives, {} for a "
                "piezo, half as much again for {}; and {} closings of devices, up to twice as many where many land, fewer where "
                "closings take more work than usual, which the first line says; with --robust auto all closings together, with a "
                "measure closings of devices, {}",
                default_budget(Target::bounce, Shaped::electrode), default_budget(Target::bounce, Shaped::several),
                default_budget(Target::bounce, Shaped::piezo), targets_with_own_cost(), race_closings, default_closings));
  seed_option(a.as({.type = "int | None"}), r.seed, "same result, whatever --jobs is");
  a.program().text(
      "seeds", r.seeds, "N",
      "search from N seeds, --seed and those after it, as one study: the best is reported, and how the others spread");
  a.flag(
      "resume", r.resume,
      "go on with the search in the folder of --out that was interrupted, or ended by its budget; what it has evaluated is not "
      "simulated again, and options that are not given are those it began with");
  a.program().text("cycle", r.cycle, "RATE",
                   "search the closing and the opening waveform of a switch that is cycled at this rate, together: \"2 kHz\"; as "
                   "softland cycle --search does, with its files");
  a.program().text("duty", r.duty, "SHARE", "with --cycle, share of a cycle before the command to open (default: 50 %)");
  a.program().flag(
      "limit", r.limit,
      fmt::format(
          "tell how near the winner's touch comes to the least time of any waveform of these drives also where a "
          "driver has a max_slew or a cantilever more than four modes, which may take minutes, and with a budget below {}",
          evaluations_worth_a_limit));
  jobs_option(a, r.jobs, "threads (default: one per core)");
  a.object("out", "str | os.PathLike[str] | None", "None",
           "folder in which all evaluations are kept while the search runs, and its files when it ends");
  a.object(
      "callback", "Callable[[int, float, float, float], Any] | None", "None",
      "(evaluations, best cost, cost of the plain step, cost now) after each evaluation on record; one that returns True ends "
      "the search, of which the best so far is then the result");
}

}  // namespace

OptimizeRequest optimize_request(const Told& told) { return read_options<OptimizeVerb>(told); }

Study optimize_study() { return described<OptimizeVerb>(); }

}  // namespace softland::verbs
