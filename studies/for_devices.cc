#include "studies/for_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/executor.h"
#include "base/require.h"
#include "config/assumed_spread.h"
#include "sampling/statistics.h"
#include "studies/family_search.h"
#include "studies/modes_of_search.h"
#include "studies/plain_step.h"
#include "studies/worse_than_step.h"

namespace softland {
namespace {

constexpr std::uint64_t devices_of_choice = 512;
constexpr std::size_t scouted_on = 16, ranked_on = 64;  // devices: candidates of the nominal search
constexpr std::size_t kept_of_scouted = 24;             // by either measure
constexpr std::size_t most_of_ranked = 2;               // by either measure
constexpr std::size_t most_of_race = 3;                 // by either measure
constexpr std::size_t most_judged = 3;                  // winners, until one is not worse than the plain step
constexpr std::size_t most_of_front = 6;
constexpr double lands_half = 0.5;
constexpr double most_times = 5, most_times_of_landings = 7;  // the plain step's closing time, of 95 %
constexpr double margin = 0.98;                               // of the step's figures, in the choice
constexpr double more_open = 0.005;                           // of the devices
constexpr double ranked_by_share = 0.25;                      // of the devices land without a rebound
constexpr std::uint64_t measured_devices = 128;               // of a search in measured units
constexpr double coarse_error = 0.01, fine_error = 0.002;     // of measurements, relative
constexpr double least_times_of_error = 20;
constexpr std::array errors_of_pull_in{0.0005, 0.001, 0.002, 0.005, 0.01, 0.02};  // relative
constexpr std::size_t judged_by_error = 256;                                      // devices
constexpr std::uint64_t which_searched = 0, which_chosen = 1, which_measured = 2;
constexpr double end_of_drawing = 0.3, least_of_race = 0.4, end_of_race = 0.75;  // of a budget of time

constexpr const char *plain_step_row = "plain step", *for_the_drawing = "for the drawing", *for_the_devices = "for the devices";

double quantile_95(const std::vector<DeviceOutcome>& outcomes, std::string_view key) {
  std::vector<double> values;
  for (const DeviceOutcome& o : outcomes) values.push_back(o.of(figure_of(key)));
  return sample_quantile(values, 0.95);
}

double share_of(const std::vector<DeviceOutcome>& outcomes, bool (*holds)(const DeviceOutcome&)) {
  return static_cast<double>(std::ranges::count_if(outcomes, holds)) / static_cast<double>(outcomes.size());
}
bool closes(const DeviceOutcome& o) { return o.closed(); }

// What the choice asks of a candidate beside its rank.
struct Bounds {
  std::array<double, judged_figures.size()> figures;  // 95 % quantiles of the plain step
  double first_touch, open;                           // likewise, and its share of devices that do not close

  explicit Bounds(const std::vector<DeviceOutcome>& step)
      : first_touch(quantile_95(step, key_of(&Metrics::initial_contact_time))), open(1 - share_of(step, closes)) {
    for (std::size_t i = 0; i < figures.size(); ++i) figures[i] = quantile_95(step, judged_figures[i]);
  }
  /// `in_time`: whether it has to close in a usual time.
  [[nodiscard]] bool keeps(const std::vector<DeviceOutcome>& own, double significant, bool in_time) const {
    for (std::size_t i = 0; i < figures.size(); ++i) {
      const double value = quantile_95(own, judged_figures[i]);
      if (judged_figures[i] == key_of(&Metrics::major_bounce_height) && value <= significant) continue;
      if (value > margin * figures[i]) return false;
    }
    if (1 - share_of(own, closes) > open + more_open) return false;
    const double times = share_of(own, is_bounce_free) >= lands_half ? most_times_of_landings : most_times;
    return !in_time || !std::isfinite(first_touch) ||
           quantile_95(own, key_of(&Metrics::initial_contact_time)) <= times * first_touch;
  }
};

// The settings of the families that the scene has room for, and their names joined by +.
std::pair<std::vector<SearchSetting>, std::string> settings_of_race(const SceneFile& file, const OptimizeOptions& options,
                                                                    const std::string& wanted, const Watch& watch) {
  const bool chosen = !wanted.empty();
  const std::vector<std::string> names = families_of(chosen ? wanted : std::string(raced_families));
  if (chosen) return {search_settings(file, options.target, options.actuator, wanted, watch), wanted};
  std::vector<SearchSetting> settings{search_setting(file, options.target, options.actuator, names.front(), watch)};
  std::string kept = names.front();
  for (std::size_t k = 1; k < names.size(); ++k) {
    try {
      SearchSpace space(settings.front().given, options.actuator, names[k], settings.front().scale.step.initial_contact_time);
      settings.push_back(settings.front());
      settings.back().space = std::move(space);
      kept += "+" + names[k];
    } catch (const InvalidInput&) {
      continue;
    }
  }
  return {std::move(settings), kept};
}

class DevicesStudy {
 public:
  DevicesStudy(const SceneFile& file, const OptimizeOptions& options, const ForDevicesOptions& devices)
      : file_(file), options_(options), devices_(devices), watch_{.stop = options.stop, .progress = options.on_preparation} {
    SceneFile varied = file;
    spread_assumed_ = assume_spread(varied);
    auto [settings, families] = settings_of_race(varied, options, devices.families, watch_);
    const std::vector<SearchSetting> gentle = with_gentle_edges(settings, options.actuator, families);
    settings_ = begins_gently(gentle, options.starts) ? gentle : std::move(settings);
    names_ = families_of(families);
    known_ = known_units(first().given, std::array{first().given.scene.calibration}, options.jobs, watch_).front();
    raced_names_ = searched_names(settings_, families);
  }

  ForDevicesResult run() {
    drawing_options_ = options_of_drawing();
    OptimizeResult drawing = optimize(file_, drawing_options_);
    result_.emplace(ForDevicesResult{
        .varied = first().given, .drawing = drawing, .best = std::move(drawing), .spread_assumed = spread_assumed_});
    try {
      if (result_->drawing.best_scene && !stopped()) {
        search_devices();
        judge();
      }
    } catch (const Interrupted&) {  // what there is stands
    }
    result_->interrupted = stopped();
    return *std::move(result_);
  }

 private:
  [[nodiscard]] const SearchSetting& first() const { return settings_.front(); }
  [[nodiscard]] bool stopped() const { return options_.stop != nullptr && *options_.stop; }
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  void tell(std::string_view what, double part) const {
    if (options_.on_preparation) options_.on_preparation(what, part);
  }

  // The nominal search keeps what devices may do better with, and tells of its parameters among those of all searches.
  OptimizeOptions options_of_drawing() {
    OptimizeOptions own = options_;
    own.keep_tried = true;
    if (std::isfinite(own.max_seconds)) own.max_seconds = end_of_drawing * own.max_seconds - seconds();
    own.max_seconds = std::max(own.max_seconds, 1e-3);
    own.on_start = [this](const std::vector<std::string>& names) {
      std::vector<std::string> all = names;
      for (const std::string& name : raced_names_) all.push_back(std::string(raced_prefix) + name);
      first_ = names.size();
      if (options_.on_start) options_.on_start(all);
      if (options_.memory == nullptr) return;  // which may be there from now on only
      block_of_drawing_.emplace(0, names.size(), all.size());
      memory_of_drawing_.emplace(*options_.memory, *block_of_drawing_);
      drawing_options_.memory = &*memory_of_drawing_;
    };
    return own;
  }

  void search_devices() {
    tell("building devices", 0);
    cost_.emplace(first(), tail_aim_,
                  own_devices(first(), *known_, raced_devices, options_.seed, which_searched, options_.jobs, watch_));
    const double before = seconds();
    const std::vector<DeviceOutcome> step = closed(*cost_, {}, cost_->devices());
    reserve_for_verdict((seconds() - before) / static_cast<double>(step.size()));
    make_aims(step);
    std::vector<ChosenFrom> pool = ranked_again();
    tell("searching for the devices", 0);
    RaceResult raced = race(settings_, *cost_, aims_, {result_drawing_waveforms()}, race_options());
    result_->closings += raced.closings;
    watch_.throw_if_stopped();
    for (const bool by_share : {false, true}) {
      std::ranges::stable_sort(raced.racers, {}, [&](const Racer& r) { return by_share ? r.share : r.tail; });
      for (std::size_t i = 0; i < std::min(most_of_race, raced.racers.size()); ++i) add(pool, candidate_of(raced.racers[i]));
    }
    choose(std::move(pool));
  }

  [[nodiscard]] std::map<std::string, Waveform> result_drawing_waveforms() const {
    return first().space.searched(result_->drawing.best_scene->drives.waveforms);
  }

  void make_aims(const std::vector<DeviceOutcome>& step) {
    conditions_ = beside_step(devices_.conditions, step);
    no_harder_than_step_ = no_harder_than(step, first().given.scene.metrics.significant_rebound);
    const double step_time = quantile_95(step, key_of(&Metrics::initial_contact_time));
    const std::span<const Figure> figures = device_figures;
    tail_aim_ = {.measure = parse_robust_measure("cvar:0.9", figures), .conditions = conditions_};
    aims_ = {.tail = tail_aim_, .share = {.measure = parse_robust_measure("yield", figures), .conditions = conditions_}};
    if (!std::isfinite(step_time) || says_when_to_close()) return;
    const auto bound = [&](double times) {
      return parse_criterion(fmt::format("initial_contact_time < {:.17g} s", times * step_time), figures);
    };
    aims_.tail.conditions.push_back(bound(most_times));
    aims_.share.conditions.push_back(bound(most_times_of_landings));
  }

  // A condition of the user's takes the place of the usual bound.
  [[nodiscard]] bool says_when_to_close() const {
    return std::ranges::any_of(
        conditions_, [](const Criterion& one) { return one.figure.member == Figure::Member(&Metrics::initial_contact_time); });
  }
  [[nodiscard]] bool keeps_conditions(const std::vector<DeviceOutcome>& outcomes) const { return hold(conditions_, outcomes); }

  // Of a budget of time the searches leave what the verdict takes, where they keep a part; `closing`: of one device [s].
  void reserve_for_verdict(double closing) {
    constexpr double rows = 20;  // over a search's window: three over the whole one, three in measured units, and the front
    const double verdict = rows * static_cast<double>(devices_.verdict) * closing, all = options_.max_seconds;
    race_end_ = std::clamp(all - verdict, least_of_race * all, end_of_race * all);
  }

  RaceOptions race_options() {
    return {.closings = devices_.closings,
            .seed = options_.seed,
            .jobs = options_.jobs,
            .stop = options_.stop,
            .memory = options_.memory,
            .first = first_,
            .all = first_ + raced_names_.size(),
            .out_of_time = [this] { return seconds() > race_end_; },
            .progress = [this](double part) { tell("searching for the devices", part); }};
  }

  std::vector<DeviceOutcome> closed(const RobustCost& cost, const std::map<std::string, Waveform>& waveforms,
                                    std::size_t devices) {
    result_->closings += static_cast<long>(devices);
    return cost.close(first().drives(waveforms), 0, devices, options_.jobs);
  }

  // Of what the nominal search has tried the best on devices.
  std::vector<ChosenFrom> ranked_again() {
    std::vector<ChosenFrom> all;
    for (TriedWaveform& one : result_->drawing.tried)
      all.push_back(
          {.measure = "drawing", .family = one.family, .waveforms = std::move(one.waveforms), .parameters = {}, .variables = {}});
    result_->drawing.tried.clear();
    all = best_on(std::move(all), scouted_on, kept_of_scouted);
    all = best_on(std::move(all), ranked_on, most_of_ranked);
    ChosenFrom drawing{.measure = "drawing",
                       .family = result_->drawing.family,
                       .waveforms = result_drawing_waveforms(),
                       .parameters = result_->drawing.parameters,
                       .variables = result_->drawing.variables};
    all.insert(all.begin(), std::move(drawing));
    return all;
  }

  // The best `kept` by either measure.
  std::vector<ChosenFrom> best_on(std::vector<ChosenFrom> all, std::size_t devices, std::size_t kept) {
    struct Ranked {
      double tail, share;
      std::size_t number;
    };
    std::vector<Ranked> ranked(all.size());
    run_tasks(
        all.size(), options_.jobs,
        [&](std::size_t i) {
          const std::vector<DeviceOutcome> outcomes = cost_->close(first().drives(all[i].waveforms), 0, devices, 1);
          ranked[i] = {cost_->value(outcomes, aims_.tail), cost_->value(outcomes, aims_.share), i};
        },
        options_.stop);
    watch_.throw_if_stopped();
    result_->closings += static_cast<long>(all.size() * devices);
    std::vector<ChosenFrom> best;
    std::vector<bool> taken(all.size(), false);
    for (const bool by_share : {false, true}) {
      std::ranges::stable_sort(ranked, {}, [&](const Ranked& r) { return by_share ? r.share : r.tail; });
      for (std::size_t i = 0; i < std::min(kept, ranked.size()); ++i) {
        if (taken[ranked[i].number]) continue;
        taken[ranked[i].number] = true;
        best.push_back(all[ranked[i].number]);
      }
    }
    return best;
  }

  [[nodiscard]] ChosenFrom candidate_of(const Racer& racer) const {
    ChosenFrom c{.measure = racer.measure,
                 .family = names_[racer.family],
                 .waveforms = racer.waveforms,
                 .parameters = {},
                 .variables = settings_[racer.family].space.variables(),
                 .closings = racer.closings};
    for (std::size_t i = 0; i < racer.x.size(); ++i) c.parameters[c.variables[i].name] = racer.x[i];
    return c;
  }

  static void add(std::vector<ChosenFrom>& pool, ChosenFrom one) {
    const bool there = std::ranges::any_of(pool, [&](const ChosenFrom& other) {
      return other.family == one.family && other.parameters == one.parameters && !one.parameters.empty();
    });
    if (!there) pool.push_back(std::move(one));
  }

  // Of the candidates those that are good enough, the best first, then the others.
  void choose(std::vector<ChosenFrom> pool) {
    tell("choosing on other devices", 0);
    const RobustCost others(first(), tail_aim_,
                            own_devices(first(), *known_, devices_of_choice, options_.seed, which_chosen, options_.jobs, watch_));
    const Bounds bounds(closed(others, {}, others.devices()));
    struct Placed {
      ChosenFrom candidate;
      bool keeps, lands_half;
      double rank;
    };
    std::vector<Placed> placed;
    for (ChosenFrom& one : pool) {
      watch_.throw_if_stopped();
      const std::vector<DeviceOutcome> outcomes = closed(others, one.waveforms, others.devices());
      one.bounce_free = share_of(outcomes, is_bounce_free);
      one.tail = others.value(outcomes, aims_.tail);
      one.first_touch = quantile_95(outcomes, key_of(&Metrics::initial_contact_time));
      one.impact_speed = quantile_95(outcomes, key_of(&Metrics::largest_impact_velocity));
      const bool lands = one.bounce_free >= lands_half;
      const double significant = first().given.scene.metrics.significant_rebound;
      placed.push_back({one, bounds.keeps(outcomes, significant, !says_when_to_close()) && keeps_conditions(outcomes), lands,
                        lands ? -one.bounce_free : one.tail});
    }
    std::ranges::stable_sort(placed, [](const Placed& a, const Placed& b) {
      if (a.keeps != b.keeps) return a.keeps;
      if (a.lands_half != b.lands_half) return a.lands_half;
      return a.rank < b.rank;
    });
    eligible_ = static_cast<std::size_t>(std::ranges::count_if(placed, &Placed::keeps));
    for (Placed& one : placed) result_->candidates.push_back(std::move(one.candidate));
  }

  void judge() {
    const std::vector<NamedDrive> drives{{.name = for_the_drawing, .waveforms = all_drives(result_drawing_waveforms())},
                                         of_candidate(0)};
    std::vector<DevicesRow> measured;
    if (known_->calibration().is_empty()) measured = searched_in_units(result_->candidates.front());
    tell("verdict on fresh devices", 0);
    result_->verdict = robustness(first().given, drives, verdict_options(), watch_);
    result_->interrupted = result_->verdict.interrupted;
    add_row(plain_step_row, plain_step(first().given, options_.actuator));
    add_row(for_the_drawing, drives.front().waveforms);
    add_row(for_the_devices, drives.back().waveforms);
    decide();
    std::ranges::move(measured, std::back_inserter(result_->rows));
    front();
    result_->windows = hold_windows(first().given, verdict_options(), watch_);
  }

  [[nodiscard]] RobustnessOptions verdict_options() const {
    return {.samples = devices_.verdict,
            .seed = options_.seed,
            .jobs = options_.jobs,
            .measures_drive_energy = options_.target.measures_drive_energy()};
  }
  // The searched drives of a candidate, and the others as in the plain step.
  [[nodiscard]] std::map<std::string, Waveform> all_drives(std::map<std::string, Waveform> searched) const {
    const PreparedScene& step = result_->drawing.baseline_scene;
    searched.insert(step.drives.waveforms.begin(), step.drives.waveforms.end());
    return searched;
  }
  [[nodiscard]] NamedDrive of_candidate(std::size_t n) const {
    return {
        .name = for_the_devices, .waveforms = all_drives(result_->candidates[n].waveforms), .calibration = known_->calibration()};
  }

  // The row of a drive that is judged, by its name or as one that is driven alike.
  void add_row(const char* name, const std::map<std::string, Waveform>& waveforms) {
    const std::vector<DriveRobustness>& drives = result_->verdict.drives;
    auto found = std::ranges::find(drives, std::string_view(name), &DriveRobustness::name);
    if (found == drives.end()) {
      const PreparedScene& given = first().given;
      const std::vector<Signal> own = given.told(given.in_drive_order(all_drives(waveforms)));
      found = std::ranges::find_if(drives, [&](const DriveRobustness& other) {
        return same_drives(own, given.told(given.in_drive_order(other.waveforms)));
      });
    }
    if (found != drives.end()) result_->rows.push_back({.name = name, .knowledge = found->known.calibration(), .judged = *found});
  }

  [[nodiscard]] DevicesRow& row_of_devices() {
    return *std::ranges::find(result_->rows, std::string_view(for_the_devices), &DevicesRow::name);
  }

  // The first candidate that is not worse than the plain step wins; where there is none, the step does.
  void decide() {
    const double significant = first().given.scene.metrics.significant_rebound;
    std::vector<DriveRobustness>& drives = result_->verdict.drives;
    const DriveRobustness step = drives.front();
    const auto worse = [&] {
      return softland::worse_in(row_of_devices().judged.outcomes, step.outcomes, significant, options_.seed);
    };
    std::size_t n = 0;
    for (result_->worse_in = worse(); !result_->worse_in.empty() && n + 1 < std::min(eligible_, most_judged) && !stopped();
         result_->worse_in = worse()) {
      Robustness next = robustness(first().given, {of_candidate(++n)}, verdict_options(), watch_);
      result_->interrupted = next.interrupted;
      row_of_devices().judged = next.drives.back();
      if (drives.back().name == for_the_devices) drives.pop_back();
      drives.push_back(std::move(next.drives.back()));
    }
    result_->plain_step_wins = !result_->worse_in.empty();
    if (result_->plain_step_wins) {
      row_of_devices().judged = step;
      win(plain_step(first().given, options_.actuator));
    } else {
      result_->chosen = result_->candidates[n];
      win(result_->candidates[n].waveforms);
      result_->best.family = result_->candidates[n].family;
      result_->best.prefix.clear();
      result_->best.parameters = result_->candidates[n].parameters;
      result_->best.variables = result_->candidates[n].variables;
    }
    for (const Criterion& condition : conditions_) {
      const Yield share = share_that_fulfils(row_of_devices().judged.outcomes, condition);
      result_->conditions.push_back({.condition = condition, .share = share, .holds = share.value >= constrained_share});
    }
  }

  // On the nominal device.
  void win(const std::map<std::string, Waveform>& waveforms) {
    OptimizeResult& best = result_->best;
    const OptimizeResult& drawing = result_->drawing;
    best.best_scene =
        read_back(with_waveforms(drawing.baseline_scene, first().space.searched(waveforms)), "best.toml", drawing.scene);
    best.best = simulate(*best.best_scene, true, watch_);
    best.checks = confirm(*best.best_scene);
    const Metrics& m = best.best->metrics;
    best.goal_met = goal_met(options_.target, m, drawing.baseline.metrics);
    best.confirmed = best.goal_met && std::ranges::all_of(best.checks, [](const ConfirmingRun& run) {
                       return run.varied == Varied::gas || (run.metrics.settled && run.metrics.bounce_count == 0);
                     });
    best.better_than_baseline = !result_->plain_step_wins;
    best.best_cost = cost_->value(row_of_devices().judged.outcomes, aims_.tail);
    best.baseline_cost = cost_->value(result_->verdict.drives.front().outcomes, aims_.tail);
  }

  // Searches in units that are measured on every device: none where there is nothing to measure.
  std::vector<DevicesRow> searched_in_units(const ChosenFrom& winner) {
    const Calibration coarse{.pull_in_error = coarse_error};
    const Calibration both{.pull_in_error = coarse_error, .frequency_error = coarse_error};
    const Calibration fine{.pull_in_error = fine_error, .frequency_error = fine_error};
    const Calibration by_time{.time_error = usual_time_error};
    try {
      const DeviceMeter meter(first().given, {.closing_time = true});
      result_->pull_in = meter.pull_in();
      result_->closing_time = meter.closing_time();
    } catch (const InvalidInput&) {
      return {};  // no electrode that pulls in
    }
    // A recipe for what is known precisely: of a switch too quick for the instrument it has to be searched apart.
    const bool tells_time = result_->closing_time > least_times_of_error * usual_time_error;
    const auto found = searched_in(winner, std::array{coarse, tells_time ? by_time : fine});
    if (!found[0]) return {};
    std::vector<DevicesRow> rows{row_of_measured("Vdp to 1 %", *found[0], coarse, true),
                                 row_of_measured("Vdp and period to 1 %", *found[0], both, false)};
    if (found[1]) rows.push_back(row_of_measured("Vdp and period to 0.2 %", *found[1], fine, !tells_time));
    if (found[1] && tells_time) rows.push_back(row_of_measured("closing time to 50 ns", *found[1], by_time, true));
    const bool time_wins = found[1] && tells_time && is_better(rows.back(), rows.front());
    std::vector waveforms{*found[0]};
    if (found[1]) waveforms.push_back(*found[1]);
    judge_by_error(waveforms);
    result_->calibrated_row = time_wins ? rows.back().name : rows.front().name;
    result_->calibrated =
        with_waveforms(result_->drawing.baseline_scene, first().space.searched(time_wins ? *found[1] : *found[0]));
    result_->calibrated->set(time_wins ? fmt::format("calibration.{}.error=\"50 ns\"", measured_time)
                                       : fmt::format("calibration.{}.error=\"1 %\"", measured_pull_in));
    return rows;
  }

  // More devices that land, where half of them do in either; else the softer impacts.
  static bool is_better(const DevicesRow& a, const DevicesRow& b) {
    const double lands = std::max(a.judged.bounce_free.value, b.judged.bounce_free.value);
    if (lands >= lands_half) return a.judged.bounce_free.value > b.judged.bounce_free.value;
    return quantile_95(a.judged.outcomes, judged_figures[0]) < quantile_95(b.judged.outcomes, judged_figures[0]);
  }

  // On the devices of the verdict.
  DevicesRow row_of_measured(const char* name, const std::map<std::string, Waveform>& waveforms, const Calibration& knowledge,
                             bool searched_for_it) {
    const KnownUnits known = known_units(first().given, std::array{knowledge}, options_.jobs, watch_).front();
    const RobustCost fresh(first(), aims_.tail, known_as(gauged(knowledge), known, options_.seed));
    std::vector<DeviceOutcome> outcomes = closed(fresh, waveforms, fresh.devices());
    watch_.throw_if_stopped();
    return {.name = name,
            .knowledge = knowledge,
            .searched_for_it = searched_for_it,
            .judged_whole = false,
            .judged = internal::summarised({.name = name, .waveforms = all_drives(waveforms), .calibration = knowledge}, known,
                                           std::move(outcomes))};
  }

  // What the better of these waveforms reaches where Vdp is known with ever larger errors.
  void judge_by_error(const std::vector<std::map<std::string, Waveform>>& waveforms) {
    const GaugedEnsemble& all = gauged({.pull_in_error = coarse_error});
    const auto end = static_cast<std::ptrdiff_t>(std::min(judged_by_error, all.devices.size()));
    const GaugedEnsemble few{.devices = {all.devices.begin(), all.devices.begin() + end},
                             .exact = {all.exact.begin(), all.exact.begin() + end}};
    for (const double error : errors_of_pull_in) {
      const Calibration knowledge{.pull_in_error = error};
      const RobustCost fresh(first(), aims_.tail, known_as(few, KnownUnits(knowledge), options_.seed));
      KnownVdp best{.error = error};
      for (const auto& waveform : waveforms) {
        const std::vector<DeviceOutcome> outcomes = closed(fresh, waveform, fresh.devices());
        best.bounce_free = std::fmax(best.bounce_free, share_of(outcomes, is_bounce_free));
        best.impact_speed = std::fmin(best.impact_speed, quantile_95(outcomes, judged_figures[0]));
      }
      watch_.throw_if_stopped();
      result_->by_error.push_back(best);
    }
  }

  // The devices of the verdict, gauged once for all that is known of them.
  const GaugedEnsemble& gauged(const Calibration& knowledge) {
    std::optional<GaugedEnsemble>& all = knowledge.time_error ? gauged_by_time_ : gauged_by_pull_in_;
    if (!all)
      all = gauge_all(Ensemble(first().given, devices_.verdict, options_.seed), Gauges::of(knowledge), options_.jobs, watch_);
    return *all;
  }

  // On the devices of a search in measured units.
  bool is_harder_than_step(const RobustCost& cost, const std::map<std::string, Waveform>& waveforms) const {
    const std::vector<DeviceOutcome> outcomes = cost.close(first().drives(waveforms), 0, cost.devices(), 1);
    return !hold(no_harder_than_step_, outcomes);
  }
  [[nodiscard]] RaceAims no_harder() const {
    RaceAims aims = aims_;
    for (RobustAim* aim : {&aims.tail, &aims.share}) std::ranges::copy(no_harder_than_step_, std::back_inserter(aim->conditions));
    return aims;
  }

  using Found = std::optional<std::map<std::string, Waveform>>;
  // For each of these calibrations, side by side; none where a search came to nothing.
  std::array<Found, 2> searched_in(const ChosenFrom& winner, const std::array<Calibration, 2>& calibrations) {
    const auto family = std::ranges::find(names_, winner.family);
    const std::size_t k = family == names_.end() ? 0 : static_cast<std::size_t>(family - names_.begin());
    const std::vector<KnownUnits> known = known_units(first().given, calibrations, options_.jobs, watch_);
    std::array<Found, 2> all;
    std::array<std::atomic<double>, 2> parts{};
    std::array<long, 2> closings{};
    run_tasks(
        all.size(), options_.jobs,
        [&](std::size_t i) {
          const RobustCost cost(
              first(), aims_.tail,
              own_devices(first(), known[i], measured_devices, options_.seed, which_measured, options_.jobs, watch_));
          RaceOptions own = race_options();
          own.memory = nullptr;  // whose keys do not tell units
          own.progress = [&, i](double part) {
            parts[i] = part;
            tell("searching for devices that are measured", (parts[0] + parts[1]) / 2);
          };
          const auto searched = [&](const RaceAims& aims) {
            RaceResult found = race_alone(settings_[k], k, cost, aims, winner.bounce_free >= ranked_by_share,
                                          {winner.waveforms, result_drawing_waveforms()}, own);
            closings[i] += found.closings;
            return found;
          };
          RaceResult found = searched(aims_);
          if (!found.racers.empty() && is_harder_than_step(cost, found.racers.front().waveforms)) found = searched(no_harder());
          if (!found.racers.empty()) all[i] = found.racers.front().waveforms;
        },
        options_.stop);
    result_->closings += closings[0] + closings[1];
    watch_.throw_if_stopped();
    return all;
  }

  // The candidates of which none closes sooner and more softly, on the devices of the verdict.
  void front() {
    std::vector<const ChosenFrom*> kept;
    for (const ChosenFrom& one : result_->candidates) {
      const bool beaten = std::ranges::any_of(result_->candidates, [&](const ChosenFrom& other) {
        return other.first_touch <= one.first_touch && other.impact_speed <= one.impact_speed &&
               (other.first_touch < one.first_touch || other.impact_speed < one.impact_speed);
      });
      if (!beaten && std::isfinite(one.first_touch) && kept.size() < most_of_front) kept.push_back(&one);
    }
    const RobustCost fresh(first(), aims_.tail, known_as(gauged(known_->calibration()), *known_, options_.seed));
    for (const ChosenFrom* one : kept) {
      watch_.throw_if_stopped();
      const std::vector<DeviceOutcome> outcomes = closed(fresh, one->waveforms, fresh.devices());
      result_->front.push_back({.first_touch = quantile_95(outcomes, key_of(&Metrics::initial_contact_time)),
                                .impact_speed = quantile_95(outcomes, key_of(&Metrics::largest_impact_velocity)),
                                .bounce_free = share_of(outcomes, is_bounce_free),
                                .measure = one->measure,
                                .waveform = one->family});
    }
    std::ranges::stable_sort(result_->front, {}, &FrontPoint::first_touch);
  }

  const SceneFile& file_;
  const OptimizeOptions& options_;
  const ForDevicesOptions& devices_;
  Watch watch_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::vector<SearchSetting> settings_;
  std::vector<std::string> names_, raced_names_;
  std::optional<KnownUnits> known_;
  OptimizeOptions drawing_options_;
  std::optional<ParameterBlock> block_of_drawing_;  // its parameters among those of all searches
  std::optional<MemoryOfFamily> memory_of_drawing_;
  std::size_t first_ = 0;
  std::vector<Criterion> conditions_;  // with limits of their own
  RobustAim tail_aim_;
  RaceAims aims_;
  std::vector<Criterion> no_harder_than_step_;  // in volts
  std::optional<RobustCost> cost_;
  std::optional<GaugedEnsemble> gauged_by_pull_in_, gauged_by_time_;  // the devices of the verdict
  std::size_t eligible_ = 0;
  double race_end_ = 0;  // since the beginning [s]
  bool spread_assumed_ = false;
  std::optional<ForDevicesResult> result_;  // once there is a drawing
};

}  // namespace

void share_budget(OptimizeOptions& options, ForDevicesOptions& devices) {
  constexpr long share_of_drawing = 5;  // one part of so many
  const long all = options.max_evaluations;
  options.max_evaluations = std::max(1L, all / share_of_drawing);
  devices.closings = all - options.max_evaluations;
}

ForDevicesResult optimize_for_devices(const SceneFile& file, const OptimizeOptions& options, const ForDevicesOptions& devices) {
  require(
      options.own_waveforms.empty(),
      "own waveforms are searched for the drawing, or over devices by one measure: the race of families over devices does not "
      "take them");
  return DevicesStudy(file, options, devices).run();
}

}  // namespace softland
