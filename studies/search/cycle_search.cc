#include "studies/search/cycle_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/engineering.h"
#include "base/require.h"
#include "studies/search/opening.h"
#include "studies/search/optimize.h"
#include "studies/search/search_budget.h"
#include "studies/search/search_setting.h"
#include "waveforms/export.h"

namespace softland {
namespace {

constexpr std::size_t searched_cycles = 4;  // number of cycles that are simulated for a candidate pair of waveforms
// Largest error of the piecewise linear approximation of a waveform in a scene file, as a share of the peak voltage.
constexpr double waveform_tolerance = 1e-5;

class PairSearch {
 public:
  PairSearch(const SearchSetting& setting, const CycleSearchOptions& options, const Progress& progress)
      : setting_(setting),
        options_(options),
        progress_(progress),
        budget_({.stop = progress.stop}),
        coarse_(setting.given),
        pulses_(setting.given, options.actuator, hold_levels(setting.given.commanded(setting.given.waveforms())), "optimize"),
        closing_(setting.space.variables().size()),
        scale_(setting.scale) {
    coarse_.tolerance = setting.run.tolerance;
    scale_.score_window = std::max(times(1).on_time - scale_.step.initial_contact_time, 0.1 * times(1).on_time);
  }

  [[nodiscard]] CycleTimes times(std::size_t cycles) const {
    return {.period = 1 / options_.rate, .on_time = options_.duty / options_.rate, .cycles = cycles};
  }
  [[nodiscard]] std::size_t closing_parameters() const { return closing_; }
  [[nodiscard]] const BrakePulses& pulses() const { return pulses_; }
  [[nodiscard]] long evaluations() const { return budget_.taken(); }

  /// Returns the closing and opening waveforms of a point of the search, whose first parameters are those of the closing.
  /// Without parameters of the opening, the drives go to 0 V at once. Returns nothing if a drive exceeds its limits, or if a
  /// waveform is longer than its part of a cycle.
  [[nodiscard]] std::optional<CycleWaveforms> pair(std::span<const double> x) const {
    std::optional<std::vector<Signal>> closing = setting_.allowed_commands(setting_.space.waveforms(x.first(closing_)));
    if (!closing) return std::nullopt;
    CycleWaveforms waveforms{.name = "found", .closing = std::move(*closing), .opening = {}};
    for (const Corners& corners : x.size() > closing_ ? pulses_.commanded(x.subspan(closing_)) : pulses_.plain())
      waveforms.opening.push_back(Signal::piecewise_linear(corners, corners.front().second));
    const CycleTimes one = times(1);
    const bool fits =
        last_breakpoint(waveforms.closing) < one.on_time && last_breakpoint(waveforms.opening) < one.period - one.on_time;
    return fits ? std::optional(std::move(waveforms)) : std::nullopt;
  }

  /// Returns the cost of a pair of waveforms: that of the worst among the first `cycles` cycles; infinite if the simulation
  /// fails.
  [[nodiscard]] double cost(const CycleWaveforms& waveforms, std::size_t cycles = searched_cycles) const {
    const Cycles run = CycledSwitch(coarse_, coarse_.model, waveforms).run(times(cycles), false, {.stop = progress_.stop});
    if (run.cycles.size() < cycles) return std::numeric_limits<double>::infinity();
    double worst = 0;
    for (const CycleFigures& cycle : run.cycles) {
      double own =
          cycle.closes ? softland::cost(options_.target, cycle.metrics, scale_, setting_.given.scene.metrics) : never_touched + 1;
      if (!cycle.opens) own += never_touched;
      worst = std::max(worst, own);
    }
    return worst;
  }

  /// Returns the residual vibration of the contact point about its open position at the end of the first cycle, as a share of
  /// the contact gap.
  [[nodiscard]] double unrest(const CycleWaveforms& waveforms) const {
    const Cycles run = CycledSwitch(coarse_, coarse_.model, waveforms).run(times(1), false, {.stop = progress_.stop});
    if (run.cycles.empty()) return std::numeric_limits<double>::infinity();
    const CycleFigures& cycle = run.cycles.front();
    if (!cycle.opens) return never_touched;
    return cycle.swing / scale_.contact_gap;
  }

  using Price = double (PairSearch::*)(const CycleWaveforms& waveforms) const;
  [[nodiscard]] double price(Price by, std::span<const double> x) const {
    const std::optional<CycleWaveforms> waveforms = pair(x);
    return waveforms ? (this->*by)(*waveforms) : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] double cost_of_cycles(const CycleWaveforms& waveforms) const { return cost(waveforms); }

  /// Minimises the cost `by`, a member function, over the waveform parameters with index `first` and above; all other
  /// parameters stay as in `from`.
  [[nodiscard]] OptimizerResult improve(const char* what, Price by, std::size_t first, const std::vector<double>& from,
                                        std::vector<std::vector<double>> starts) {
    const std::vector<Variable> all = variables();
    const auto whole = [&](std::span<const double> x) {
      std::vector<double> point(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(first));
      point.insert(point.end(), x.begin(), x.end());
      return point;
    };
    SearchBudget third(budget_, std::max(1L, options_.max_evaluations / 3));
    OptimizerResult found = minimize_within(third,
                                            {.variables = {all.begin() + static_cast<std::ptrdiff_t>(first), all.end()},
                                             .objective = [&](std::span<const double> x) { return price(by, whole(x)); },
                                             .starts = std::move(starts)},
                                            options_.seed, options_.jobs, progress_, what);
    if (!found.x.empty()) found.x = whole(found.x);
    return found;
  }

  [[nodiscard]] std::vector<Variable> variables() const {
    std::vector<Variable> all;
    for (const auto& [part, own] : {std::pair{"closing.", setting_.space.variables()}, {"opening.", pulses_.variables()}}) {
      for (const Variable& v : own) all.push_back({part + v.name, v.lower, v.upper});
    }
    return all;
  }

 private:
  const SearchSetting& setting_;
  const CycleSearchOptions& options_;
  const Progress& progress_;
  SearchBudget budget_;  // budget of the search, which counts the evaluated pairs of waveforms
  PreparedScene coarse_;
  BrakePulses pulses_;
  std::size_t closing_;  // number of parameters of the closing waveform
  CostScale scale_;
};

// Returns the scene of one cycle: the switch closes with one of these waveforms, and opens with the other on command.
SceneFile scene_of_cycle(const PreparedScene& given, const CycleWaveforms& waveforms, const CycleTimes& times) {
  const std::vector<Signal> signals = cycled(waveforms, times);
  const std::vector<std::string> names = given.drive_names();
  DriveWaveforms tables;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == dispersion_drive) continue;  // the dispersion force counts as a drive, but has no voltage
    Table table;
    const double tolerance = waveform_tolerance * std::max(signals[k].peak(), 1e-9);
    for (const auto& [time, voltage] : polyline(signals[k], times.period, tolerance, 0)) {
      table.time.push_back(time);
      table.voltage.push_back(voltage);
    }
    tables[names[k]] = std::move(table);
  }
  SceneFile file = with_waveforms(given, tables);
  file.set(fmt::format("simulate.open_at=\"{} s\"", times.on_time));
  file.set(fmt::format("simulate.duration=\"{} s\"", times.period));
  return file;
}

// Reads the closing and opening waveforms back from a scene of one cycle, whose text rounds the numbers, so that the simulated
// waveforms are those of the text.
CycleWaveforms read_again(const SceneFile& file, const PreparedScene& given, const CycleTimes& times) {
  const PreparedScene read = read_back(file, "best.toml", given);
  CycleWaveforms waveforms{.name = "found", .closing = {}, .opening = {}};
  for (const Signal& s : read.commanded(read.waveforms())) {
    waveforms.closing.push_back(held_from(s, times.on_time));
    waveforms.opening.push_back(part_from(s, times.on_time, s.voltage_before(times.on_time)));
  }
  return waveforms;
}

// Searches the closing waveform alone, for a switch at rest.
OptimizeResult closing_alone(const SceneFile& file, const CycleSearchOptions& options, const Progress& progress) {
  OptimizeOptions how = usual_options(file, options.target, options.actuator);
  if (!options.family.empty()) how.family = options.family;
  how.max_evaluations = std::max(1L, options.max_evaluations / 3);
  how.seed = options.seed;
  how.jobs = options.jobs;
  how.stop = progress.stop;
  how.on_preparation = progress.report;
  how.on_evaluation = [&](const Evaluation&, const OptimizeProgress& now) {
    progress.tell("closings", static_cast<double>(now.evaluations) / static_cast<double>(how.max_evaluations));
  };
  return optimize(file, how);
}

}  // namespace

CycleSearchResult search_cycle(const SceneFile& file, const CycleSearchOptions& options, const Progress& progress) {
  require(options.rate > 0 && options.duty > 0 && options.duty < 1, "a rate must be above 0 Hz, and a duty above 0 and below 1");
  const OptimizeResult alone = closing_alone(file, options, progress);
  const SearchSetting setting = search_setting(file, options.target, options.actuator, alone.family, {.stop = progress.stop});
  const PreparedScene& given = setting.given;
  require(given.rest().has_value(), "with every drive at 0 V the switch has no stable open state: it cannot be opened");
  PairSearch search(setting, options, progress);

  // Start at the closing waveform that was searched alone, and at the default starts of its waveform family, without starts
  // whose waveforms are longer than their part of a cycle.
  std::vector<std::vector<double>> closings = setting.space.starts();
  if (alone.best_scene) {
    const DriveWaveforms found = setting.space.searched(alone.best_scene->drives.waveforms());
    if (setting.space.misfit(found).empty()) closings.insert(closings.begin(), setting.space.nearest(found));
  }
  std::erase_if(closings, [&](const std::vector<double>& x) { return !search.pair(x); });
  require(!closings.empty(), [&] {
    return fmt::format("at {} and a duty of {:g} % no waveform of the family \"{}\" fits into its part of a cycle, or no opening",
                       engineering(options.rate, "Hz", 4), 100 * options.duty, alone.family);
  });
  // Find the start with the lowest cost of a single cycle, from rest.
  std::vector<double> best = closings.front();
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& x : closings) {
    if (progress.stopped()) break;
    const double own = search.cost(*search.pair(x), 1);
    if (own < least) least = own, best = x;
  }

  CycleSearchResult result{.given = given,
                           .cycling = {.options = {.rate = options.rate,
                                                   .scans = false,
                                                   .duty = options.duty,
                                                   .cycles = options.cycles,
                                                   .devices = 0,
                                                   .seed = options.seed,
                                                   .jobs = options.jobs},
                                       .rate = options.rate,
                                       .drives = {}},
                           .family = alone.family,
                           .parameters = {},
                           .scene = file};
  const std::size_t closing = search.closing_parameters();
  const auto with = [&](const std::vector<double>& x, const std::vector<double>& opening) {
    std::vector<double> both(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(closing));
    both.insert(both.end(), opening.begin() + static_cast<std::ptrdiff_t>(closing), opening.end());
    return both;
  };
  if (!progress.stopped()) {
    const OptimizerResult calm = search.improve("openings", &PairSearch::unrest, closing, best, search.pulses().starts());
    if (!calm.x.empty()) best = calm.x;
  }
  if (!progress.stopped() && best.size() > closing) {
    std::vector<std::vector<double>> pairs{best};
    for (const std::vector<double>& x : closings) pairs.push_back(with(x, best));
    const OptimizerResult both = search.improve("pairs", &PairSearch::cost_of_cycles, 0, best, std::move(pairs));
    if (!both.x.empty()) best = both.x;
  }
  result.evaluations = search.evaluations();

  const CycleTimes one = search.times(1);
  CycleWaveforms found = *search.pair(best);
  result.scene = scene_of_cycle(given, found, one);
  found = read_again(result.scene, given, one);
  const std::vector<Variable> variables = search.variables();
  for (std::size_t k = 0; k < best.size(); ++k) result.parameters[variables[k].name] = best[k];
  const CycleWaveforms plain = plain_cycle(given, found);
  if (!progress.stopped()) {
    result.plain_cost = search.cost(plain);
    result.cost = search.cost(found);
  }
  for (const CycleWaveforms& waveforms : {plain, found}) {
    CycledDrive& drive = result.cycling.drives.emplace_back();
    drive.waveforms = waveforms;
    drive.cycles = CycledSwitch(given, given.model, waveforms).run(search.times(options.cycles), true, {.stop = progress.stop});
  }
  result.interrupted = result.cycling.interrupted = progress.stopped();
  return result;
}

}  // namespace softland
