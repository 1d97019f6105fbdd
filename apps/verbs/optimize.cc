// The search for a waveform, of the nominal device or of devices that differ.
#include "studies/optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/robustness_files.h"
#include "apps/scenes.h"
#include "apps/search_log.h"
#include "apps/shell_word.h"
#include "apps/streams.h"
#include "apps/values.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "config/units.h"
#include "optimizers/problem.h"
#include "reports/quantity.h"
#include "reports/result_maker.h"
#include "reports/text.h"
#include "studies/robust_optimize.h"
#include "waveforms/export.h"

namespace softland::apps {
namespace {

namespace fs = std::filesystem;
using internal::percent;
using internal::quantity;

struct OptimizeRequest {
  std::string target = "bounce";
  std::string actuator = "electrostatic";
  std::string waveform = "pulse";
  std::string optimizer = "auto";
  std::string robust;                   ///< the measure of a robust search; empty: the nominal device alone
  std::vector<std::string> conditions;  ///< of a robust search
  std::string calibration;              ///< what is measured on every device; empty: what the scene says
  std::optional<std::string> samples;   ///< devices of a robust search
  std::optional<std::string> budget;    ///< evaluations ("2500") or time ("90 s"); default: default_budget(), or default_closings
  std::optional<std::string> seed;      ///< default: 1
  std::optional<std::string> jobs;      ///< default: one per core
};

// "2500" evaluations or "90 s".
void read_budget(const std::string& text, OptimizeOptions& options) {
  const auto rule = [&](bool ok) {
    require(ok, fmt::format("--budget {}: must be a whole number of evaluations such as 2500, or a time such as \"90 s\"",
                            shown(text)));
  };
  Quantity q;
  try {
    q = parse_quantity(text);
  } catch (const InvalidInput&) {
    rule(false);
  }
  if (q.dimension == dimension::time) {
    rule(q.value > 0);
    options.max_seconds = q.value;
    options.max_evaluations = 1'000'000'000;
  } else {
    rule(q.dimension == dimension::none && q.value >= 1 && q.value <= 1e9 && q.value == std::floor(q.value));
    options.max_evaluations = static_cast<long>(q.value);
  }
}

// How a winner does on devices of its scene's spread, beside the plain step, in a sentence; empty where nothing varies, or when
// asked to stop.
std::string on_devices(const Common& c, const Prepared& winner, int jobs, const fs::path& place) {
  if (winner.scene.spread.empty()) return {};
  constexpr std::uint64_t devices = 200;
  try {
    const WatchedWork work(c.quiet, c.stop);
    const Robustness found = robustness(winner, {{.name = "found", .waveforms = winner.drives.waveforms}},
                                        {.samples = devices, .jobs = jobs}, work.watch());
    if (found.interrupted || found.drives.size() < 2) return {};
    const auto at_95_percent = [](const DriveRobustness& drive, std::string_view key) {
      const EnsembleFigure& figure = ensemble_figure(key);
      const EstimatedQuantile& q = drive.figures[static_cast<std::size_t>(&figure - ensemble_figures().data())].quantiles[2];
      return std::isfinite(q.value) ? quantity(q.value, figure.unit) : std::string("no bound (more than 5 % do not close)");
    };
    const auto words = [&](const DriveRobustness& drive) {
      return fmt::format("rebounds up to {} and touches at up to {}", at_95_percent(drive, "major_bounce_height_m"),
                         at_95_percent(drive, "largest_impact_velocity_m_s"));
    };
    const DriveRobustness &step = found.drives[0], &own = found.drives[1];
    return "\n" +
           wrapped(fmt::format(
               "On {} devices that differ as [spread] says, with the same volts: {} land without a rebound, and 95 % have "
               "{} (plain step: {}, {}). More: softland robustness {}",
               devices, percent(own.bounce_free.value), words(own), percent(step.bounce_free.value), words(step),
               shell_word((place / "best.toml").string()))) +
           "\n";
  } catch (const Interrupted&) {
    return {};
  }
}

// What a search is asked for, but for its robustness.
OptimizeOptions read_options(const Common& c, const OptimizeRequest& request) {
  const TargetRow* target = find_named(targets, request.target);
  require(target != nullptr, [&] { return fmt::format("--target {}: must be {}", request.target, listed(targets)); });
  const Named<Actuator>* actuator = find_named(actuators, request.actuator);
  require(actuator != nullptr, [&] { return fmt::format("--actuator {}: must be {}", request.actuator, listed(actuators)); });
  OptimizeOptions options{.target = target->value,
                          .actuator = actuator->value,
                          .family = request.waveform,
                          .optimizer = request.optimizer,
                          .stop = c.stop};
  options.jobs = job_count(request.jobs);
  options.seed = seed_of(request.seed, options.seed);
  options.max_evaluations = request.robust.empty() ? default_budget(options.target, options.actuator) : default_closings;
  if (request.budget) read_budget(*request.budget, options);
  return options;
}

Common with_defaults(Common c) {
  if (c.scene.empty()) c.scene = shipped_scene("mem-gold-pzt.toml").string();
  if (c.out.empty()) c.out = "softland-out";
  return c;
}

RobustOptions read_robust_options(const OptimizeRequest& request) {
  const std::vector<FigureName> figures = conditioned_figures();
  const auto read = [](const std::string& option, const auto& parse) {
    try {
      return parse();
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("{}: {}", option, error.what()));
    }
  };
  RobustOptions robust;
  robust.aim.measure = read("--robust " + request.robust, [&] { return parse_robust_measure(request.robust, figures); });
  for (const std::string& text : request.conditions)
    robust.aim.conditions.push_back(read("--constrain", [&] { return parse_criterion(text, figures); }));
  robust.samples = sample_count(request.samples, robust.samples, 8, most_searched);
  require(request.optimizer == "auto",
          [&] { return fmt::format("--optimizer {}: a robust search has a method of its own", request.optimizer); });
  return robust;
}

// A search on its way: its progress, the folder it fills, its log.
class Searching {
 public:
  Searching(const Common& c, const OptimizeRequest& request, OptimizeOptions& options)
      : preparation_(std::in_place, c.quiet, c.stop),
        progress_(c.quiet, options, request.robust.empty() ? "evaluations" : "closings") {
    options.on_preparation = [this](std::string_view what, double part) {
      if (!preparation_) return;
      preparation_->watch().tell(what, part);
    };
    options.on_start = [this, &c, &request](const std::vector<std::string>& variables) {
      preparation_.emplace(c.quiet, c.stop);
      std::vector<std::string> files{"best.toml",   "best.csv",       "report.html",    "gap.svg",
                                     "result.json", "trajectory.csv", "evaluations.csv"};
      if (!request.robust.empty()) files.insert(files.end(), robustness_files.begin(), robustness_files.end());
      folder_ = claim_places(c, files);
      log_.emplace(*folder_, variables);
      if (c.quiet) return;
      const std::string devices = request.robust.empty() ? "" : fmt::format(", over devices of the spread ({})", request.robust);
      say(fmt::format("{}: searching a {} waveform, actuator {}, target {}{}; results go to {}", c.scene, request.waveform,
                      request.actuator, request.target, devices, c.out));
    };
    options.on_evaluation = [this](const Evaluation& e, const OptimizeProgress& p) {
      log_->evaluated(e);
      progress_.show(p);
    };
    options.on_progress = [this](const OptimizeProgress& p) { progress_.show(p); };
    options.on_improvement = [this](const Evaluation&, const SceneFile& best) { log_->improved(best); };
  }

  // When the search has ended.
  void close() {
    preparation_.reset();
    progress_.close();
    log_->flush();
  }
  [[nodiscard]] ResultFolder& folder() { return *folder_; }
  [[nodiscard]] const SearchLog& log() const { return *log_; }

 private:
  std::optional<WatchedWork> preparation_;
  SearchProgress progress_;
  std::optional<ResultFolder> folder_;
  std::optional<SearchLog> log_;
};

// Writes what a search has found, and names the files it leaves.
std::vector<std::string> write_found(Searching& searching, const OptimizeResult& result, Result& found, const fs::path& place) {
  for (const auto& [index, e] : searching.log().evaluations())
    found.search.evaluations.push_back({static_cast<double>(index), e.value});
  found.reproduce = {found.command, "softland simulate " + shell_word((place / "best.toml").string())};
  std::vector<std::string> left{"report.html", "gap.svg", "result.json"};
  ResultFolder& folder = searching.folder();
  if (result.best_scene) {
    folder.write("best.toml", result.best_scene->scene.file.text());
    folder.write("best.csv", csv(named_signals(*result.best_scene), result.best_scene->duration));
    left.insert(left.end(), {"trajectory.csv", "best.toml (run it with `softland simulate`)", "best.csv"});
  }
  left.emplace_back("evaluations.csv");
  write_result(folder, found);
  return left;
}

int status_of(const OptimizeResult& result) {
  if (result.search.termination == Termination::interrupted) return exit_interrupted;
  return result.best && result.better_than_baseline ? exit_done : exit_no_success;
}

int robust_optimize_verb(const Common& given, const OptimizeRequest& request) {
  const Common c = with_defaults(given);
  OptimizeOptions options = read_options(c, request);
  const RobustOptions robust = read_robust_options(request);
  SceneFile file = load_scene(c);
  set_calibration(file, request.calibration);
  Searching searching(c, request, options);
  RobustResult result = robust_optimize(file, options, robust);
  std::optional<RobustnessReport> report;
  if (result.verdict) {
    report.emplace(RobustnessReport{.nominal = *result.found.best_scene,
                                    .found = *result.verdict,
                                    .options = {.samples = robust.verdict, .seed = options.seed, .jobs = options.jobs},
                                    .command = c.command});
    add_details(*report, false, {.stop = c.stop, .progress = options.on_preparation});
    if (report->interrupted) result.found.search.termination = Termination::interrupted;
  }
  searching.close();

  Result found = result_of(result, options, robust, {.command = c.command});
  const bool interrupted = result.found.search.termination == Termination::interrupted;
  const fs::path place = searching.folder().destination(interrupted);
  std::vector<std::string> left = write_found(searching, result.found, found, place);
  std::string text;
  if (report) {
    write_robustness(searching.folder(), *report);
    left.insert(left.end(), robustness_files.begin(), robustness_files.end());
    text = "\n" + robustness_text(*report);
  }
  searching.folder().publish(interrupted);
  print_result(c, found, text + left_in(place, left));
  return status_of(result.found);
}

int optimize_verb(const Common& given, const OptimizeRequest& request) {
  if (!request.robust.empty()) return robust_optimize_verb(given, request);
  for (const bool is_given : {!request.conditions.empty(), !request.calibration.empty(), request.samples.has_value()})
    require(!is_given,
            "--constrain, --calibrate and --samples are for a search over devices: give --robust too, such as --robust cvar:0.9");
  const Common c = with_defaults(given);
  OptimizeOptions options = read_options(c, request);
  const SceneFile file = load_scene(c);
  Searching searching(c, request, options);
  const OptimizeResult result = optimize(file, options);
  searching.close();

  Result found = result_of(result, options, {.command = c.command});
  const bool interrupted = result.search.termination == Termination::interrupted;
  const fs::path place = searching.folder().destination(interrupted);
  const std::vector<std::string> left = write_found(searching, result, found, place);
  searching.folder().publish(interrupted);
  const bool judged = result.best_scene && !interrupted && c.json != "-";
  print_result(c, found, (judged ? on_devices(c, result.best_scene.value(), options.jobs, place) : "") + left_in(place, left));
  return status_of(result);
}

// "settling, impact and energy"
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

}  // namespace

void add_optimize(Verb& verb) {
  const auto request = std::make_shared<OptimizeRequest>();
  verb.with_scene(false);
  verb.with_json();
  verb.option("--target", request->target, "NAME",
              first_is_default(listed(targets)) + "; the goal of each asks for no significant rebound");
  verb.option("--actuator", request->actuator, "NAME",
              "drives that the search may shape: " + first_is_default(listed(actuators)));
  verb.option("--waveform", request->waveform, "NAME",
              "family to search: pulse (default), step, harmonic, catch, ramp, staircase, knots, coast, dual-pulse, pulses, "
              "s-curve, dither, "
              "chirp, bspline or sines; with a number of levels, knots, pulses or sines: knots:8; for each drive its own: "
              "main=step,pzt=pulse");
  verb.option("--robust", request->robust, "MEASURE",
              "search for devices that differ as [spread] says, and minimise over them: cvar:0.9 (the mean of the worst tenth), "
              "quantile:0.95, mean+2sigma, worst or yield:\"bounce_count == 0\"");
  verb.repeated("--constrain", request->conditions, "CONDITION",
                "condition that 95 % of the devices have to fulfil: \"permanent_contact_time < 60 us\"; may be repeated");
  verb.option(
      "--calibrate", request->calibration, "LIST",
      "measured on every device before it is driven, whose waveform is then in its own units: \"Vdp,frequency\" or, with "
      "errors, \"Vdp:1 %,frequency:0.5 %\"; \"Vdp,frequency in 8 classes\": sorted by it, one waveform for each class; none: "
      "not even what [calibration] says");
  verb.with_samples(request->samples, "devices that a robust search looks at (default: 128)");
  verb.option("--optimizer", request->optimizer, "NAME", "auto (default), or another of the names below");
  verb.optional(
      "--budget", request->budget, "N|TIME",
      fmt::format(
          "evaluations, or time (\"90 s\"); default: 2500 for electrostatic, 10000 for pzt and both, half as much again for "
          "{}; with --robust closings of devices, 60000",
          targets_with_own_cost()));
  verb.with_seed(request->seed, "same result, whatever --jobs is");
  verb.with_jobs(request->jobs, "threads (default: one per core)");
  verb.with_out("folder for the report, the waveform found and all data (default: softland-out)");
  verb.footer(
      "Without a scene: scenes/mem-gold-pzt.toml. The hold level is the scene's own; its [driver.*] limits are never left.\n"
      "A scene that holds a landing already (best.toml of an earlier search) is refined and, without --robust, never ends "
      "worse.\n" +
      optimizer_help() +
      "\nExamples:\n  softland optimize --target bounce --actuator pzt\n"
      "  softland optimize scenes/mem-gold.toml --actuator electrostatic --waveform pulse --seed 3 --out run3\n"
      "  softland optimize scenes/mem-gold.toml --robust cvar:0.9 --constrain \"initial_contact_time < 65 us\"\n"
      "  softland optimize scenes/mem-gold.toml --robust cvar:0.9 --waveform catch --calibrate \"Vdp:1 %,frequency:0.5 %\"");
  verb.runs([request](const Common& common) { return optimize_verb(common, *request); });
}

}  // namespace softland::apps
