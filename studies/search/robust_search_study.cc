#include "studies/search/robust_search_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <iterator>
#include <utility>

#include "base/executor.h"
#include "base/require.h"
#include "studies/closing/plain_step.h"
#include "studies/search/devices_findings.h"
#include "studies/search/robust_cost.h"

namespace softland {
namespace {

// Numbers of varied devices on which the candidates of the nominal search are compared: first all candidates, then the best.
constexpr std::size_t scouted_on = 16, ranked_on = 64;
constexpr std::size_t kept_of_scouted = 24;  // candidates kept after `scouted_on` devices, by each of two costs
constexpr std::size_t most_of_ranked = 2;    // candidates kept after `ranked_on` devices, by each of two costs
constexpr std::size_t most_judged = 3;       // largest number of candidates tried on fresh devices
constexpr double end_of_nominal = 0.3;       // end of the search on the nominal device, as a share of a time budget

constexpr const char *fast_row = "fast", *soft_row = "soft";
// Largest time until a steady contact under the waveforms "fast", "default" and "soft" that are offered to the user, as a
// multiple of that under the plain step.
constexpr double fast_within = 0.5, usual_within = 1, soft_within = 2;
constexpr double by_chance = 1.02;  // tolerance of fast_within, usual_within and soft_within: times differ on fresh devices
constexpr double fewer_bounce_free = 0.05;

class RobustSearchStudy {
 public:
  RobustSearchStudy(const SceneFile& file, const OptimizeOptions& options, const RobustSearchOptions& devices)
      : file_(file),
        options_(options),
        devices_(devices),
        progress_{.stop = options.stop, .report = [this](std::string_view what, double part) { tell(what, part); }},
        searched_(file, options, devices, progress_.report) {}

  RobustSearchResult run() {
    OptimizeResult nominal = searched_for_nominal();
    result_.emplace(RobustSearchResult{.varied = first().given, .nominal = nominal, .best = std::move(nominal)});
    try {
      if (result_->nominal.best_scene && !progress_.stopped()) {
        choose_of_all();
        judge();
      }
    } catch (const Interrupted&) {  // the search was interrupted: return the results so far
    }
    searched_.give_up();
    if (beside_.valid()) beside_.wait();  // wait until the search over devices ends: its results are read below
    if (progress_.stopped() && result_->rows.empty()) take_leader();
    result_->interrupted = progress_.stopped();
    if (!result_->rows.empty()) complete_findings(*result_, searched_, options_.seed);
    return *std::move(result_);
  }

 private:
  [[nodiscard]] const SearchSetting& first() const { return searched_.first(); }
  // Reports the progress of the study, but not while the search on the nominal device runs, which reports itself.
  void tell(std::string_view what, double part) const {
    if (options_.on_preparation && !searches_nominal_) options_.on_preparation(what, part);
  }

  OptimizeResult searched_for_nominal() {
    nominal_options_ = options_of_nominal();
    try {
      OptimizeResult nominal = optimize(file_, nominal_options_);
      searches_nominal_ = false;
      return nominal;
    } catch (...) {
      searched_.give_up();
      throw;
    }
  }

  // Returns the options of the search on the nominal device. This search keeps candidate waveforms, which are then ranked on
  // varied devices; its on_start also passes on the parameters of the search over devices.
  OptimizeOptions options_of_nominal() {
    OptimizeOptions own = options_;
    own.keep_tried = true;
    if (std::isfinite(own.max_seconds)) own.max_seconds = searched_.budget().seconds_left(end_of_nominal);
    own.max_seconds = std::max(own.max_seconds, 1e-3);
    // The search on the nominal device does not write best.toml: that file gets the waveform for varied devices.
    own.on_improvement = {};
    own.on_estimate = [this](const SearchEstimate& of_nominal) {
      if (options_.on_estimate) options_.on_estimate(searched_.estimate(of_nominal));
    };
    own.on_start = [this](const FamilyColumns& of_nominal) {
      FamilyColumns all = of_nominal;
      std::ranges::copy(searched_.columns().families, std::back_inserter(all.families));
      if (options_.on_start) options_.on_start(all);
      nominal_options_.memory = options_.memory;  // on_start may have created the memory of evaluations
      search_beside(of_nominal.families.size());
    };
    return own;
  }

  // Starts the search over devices in parallel, and waits until it has evaluated a first candidate. Only then the search on the
  // nominal device begins, which has `before` waveform families.
  void search_beside(std::size_t before) {
    const bool is_beside = options_.jobs > 1, is_timed = std::isfinite(options_.max_seconds);
    const double of_nominal = is_timed ? end_of_nominal * options_.max_seconds : 0;
    std::promise<void> looked;
    const std::future<void> look = looked.get_future();
    beside_ = std::async(is_beside ? std::launch::async : std::launch::deferred,
                         [this, before, reserved = is_beside ? 0 : of_nominal, given = std::move(looked)]() mutable {
                           // If no candidate is evaluated, the destructor of the promise `own` ends the wait for it in
                           // look.wait().
                           std::promise<void> own = std::move(given);
                           searched_.run(
                               before, [&own] { own.set_value(); }, reserved);
                         });
    if (!is_beside) {
      beside_.wait();
    } else if (is_timed) {
      static_cast<void>(look.wait_for(std::chrono::duration<double>(of_nominal)));
    } else {
      look.wait();
    }
    searches_nominal_ = true;
  }

  // Makes the best candidate so far the result of a search that was interrupted before the final evaluation.
  void take_leader() {
    const ChosenFrom* leader = searched_.leader();
    if (leader == nullptr) return;
    OptimizeResult& best = result_->best;
    best.best_scene = read_back(scene_of(leader->waveforms), "best.toml", best.scene);
    best.best = simulate(*best.best_scene, true);
    best.checks.clear();
    best.goal_met = goal_met(options_.target, best.best->metrics, best.baseline.metrics);
    best.confirmed = false;
    best.better_than_baseline = true;
    best.best_cost = leader->tail;
    best.baseline_cost = searched_.cost().value(searched_.step_on_others(), searched_.aims().tail);
    best.family = leader->family;
    best.prefix.clear();
    best.parameters = leader->parameters;
    best.variables = leader->variables;
  }

  void choose_of_all() {
    beside_.get();
    for (ChosenFrom& one : ranked_again()) searched_.place(std::move(one));
    result_->candidates = searched_.placed();
  }

  [[nodiscard]] DriveWaveforms nominal_waveforms() const {
    return first().space.searched(result_->nominal.best_scene->drives.waveforms());
  }

  // Returns those candidates of the search on the nominal device that perform best on varied devices. The result of that search
  // comes first.
  std::vector<ChosenFrom> ranked_again() {
    std::vector<ChosenFrom> all;
    for (TriedWaveform& one : result_->nominal.tried)
      all.push_back(
          {.measure = "drawing", .family = one.family, .waveforms = std::move(one.waveforms), .parameters = {}, .variables = {}});
    result_->nominal.tried.clear();
    all = best_on(std::move(all), scouted_on, kept_of_scouted);
    all = best_on(std::move(all), ranked_on, most_of_ranked);
    ChosenFrom nominal{.measure = "drawing",
                       .family = result_->nominal.family,
                       .waveforms = nominal_waveforms(),
                       .parameters = result_->nominal.parameters,
                       .variables = result_->nominal.variables};
    all.insert(all.begin(), std::move(nominal));
    return all;
  }

  // Returns the candidates with the least cost on the first `devices` devices: the best `kept` by the tail of the cost, and the
  // best `kept` by the bounce-free share.
  std::vector<ChosenFrom> best_on(std::vector<ChosenFrom> all, std::size_t devices, std::size_t kept) {
    struct Ranked {
      double tail, share;
      std::size_t number;
    };
    std::vector<Ranked> ranked(all.size());
    run_tasks(
        all.size(), options_.jobs,
        [&](std::size_t i) {
          const std::vector<DeviceOutcome> outcomes = searched_.cost().close(first().drives(all[i].waveforms), 0, devices, 1);
          ranked[i] = {searched_.cost().value(outcomes, searched_.aims().tail),
                       searched_.cost().value(outcomes, searched_.aims().share), i};
        },
        options_.stop);
    progress_.throw_if_stopped();
    searched_.budget().took(static_cast<long>(all.size() * devices));
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

  void judge() {
    const CalibratedSearch measured = searched_.in_measured_units(result_->candidates.front(), nominal_waveforms());
    tell("evaluating on new devices", 0);
    result_->free = searched_.free();
    result_->approach = searched_.approach();
    make_choices();
    result_->varied = over_whole_window(first().given);
    std::vector<NamedDrive> drives{{.name = for_nominal_design, .waveforms = searched_.all_drives(nominal_waveforms())}};
    for (const DeviceChoice& one : result_->choices) {
      if (one.name != default_choice) drives.push_back(named(one.name.c_str(), one.candidate));
    }
    if (undelayed_) drives.push_back(named(undelayed_row, *undelayed_));
    drives.push_back(of_candidate(0));  // reports describe the last waveforms in this list
    result_->verdict = robustness(result_->varied, drives, verdict_options(), progress_);
    result_->interrupted = result_->verdict.interrupted;
    add_row(plain_step_row, plain_step(first().given, options_.actuator));
    add_row(for_nominal_design, nominal_waveforms());
    add_row(for_the_devices, result_->candidates.front().waveforms);
    decide();
    decide_choices();
    if (undelayed_) add_row(undelayed_row, undelayed_->waveforms);
    add(measured);
    judge_front(*result_, searched_, progress_);
    draw_courses(*result_, verdict_options(), progress_);
    result_->findings.windows = hold_windows(first().given, verdict_options(), progress_);
  }

  // Returns the candidate with the softest impacts among those under which devices wait at most `times` as long for a steady
  // contact as under the plain step; null if there is no such candidate.
  [[nodiscard]] const ChosenFrom* softest_within(double times, const std::vector<ChosenFrom>& candidates) const {
    const ChosenFrom* best = nullptr;
    for (const ChosenFrom& one : candidates) {
      if (!one.is_good_enough || !(one.waited <= by_chance * times * searched_.free().until)) continue;
      if (best == nullptr || one.measured < best->measured) best = &one;
    }
    return best;
  }

  [[nodiscard]] bool drive_alike(const ChosenFrom& a, const ChosenFrom& b) const {
    const PreparedScene& given = first().given;
    return same_drives(given.commanded(first().drives(a.waveforms)), given.commanded(first().drives(b.waveforms)));
  }

  // Chooses the waveforms to offer: the first candidate as default, and a quicker and a softer one if they differ from the
  // default.
  void make_choices() {
    const ChosenFrom& usual = result_->candidates.front();
    const double until = searched_.free().until, tau = usual.waited / until;
    const auto add = [&](const char* name, const ChosenFrom* one) {
      if (one == nullptr || (name != default_choice && drive_alike(*one, usual))) return;
      result_->choices.push_back({.name = name, .candidate = *one});
    };
    const bool is_late = tau > by_chance * usual_within;
    const ChosenFrom* fast = softest_within(is_late ? usual_within : fast_within, result_->candidates);
    const std::vector<ChosenFrom> on_the_way = searched_.looked_at();
    if (is_late && fast == nullptr) fast = softest_within(usual_within, on_the_way);
    if (until > 0 && fast != nullptr && fast->waited < worth_choosing * usual.waited) add(fast_row, fast);
    add(default_choice, &usual);
    const ChosenFrom* const soft = softest_within(soft_within, result_->candidates);
    const bool is_softer = soft != nullptr && soft->impact_speed < worth_choosing * usual.impact_speed &&
                           soft->bounce_free > usual.bounce_free - fewer_bounce_free;
    if (until > 0 && !is_late && is_softer) add(soft_row, soft);
    if (options_.actuator != Actuator::pzt || !searched_.approach() || searched_.approach()->holder.empty()) return;
    for (const ChosenFrom& one : result_->candidates) {
      if (undelayed_ || is_quasi_static(one.family) || !one.is_good_enough) continue;
      undelayed_ = one;
    }
    if (undelayed_ && drive_alike(*undelayed_, usual)) undelayed_.reset();
  }

  [[nodiscard]] NamedDrive named(const char* name, const ChosenFrom& one) const {
    return {.name = name, .waveforms = searched_.all_drives(one.waveforms), .calibration = searched_.known().calibration()};
  }

  // Returns the scene with a simulated time in which all offered waveforms end, and the bounces under the plain step, too.
  [[nodiscard]] PreparedScene over_whole_window(PreparedScene given) const {
    double window = whole_window({});
    for (const DeviceChoice& one : result_->choices) window = std::max(window, whole_window(one.candidate.waveforms));
    if (window <= given.duration) return given;
    set_window(given.scene.file, given.duration = given.scene.simulate.duration = window);
    return given;
  }

  // Returns the simulated time in which these waveforms end, and the bounces under the plain step, too [s].
  [[nodiscard]] double whole_window(const DriveWaveforms& waveforms) const {
    const PreparedScene& given = first().given;
    const double needed = window_for(given, given.commanded(first().drives(waveforms))), bounces = 1.2 * searched_.free().until;
    const double window = std::max(needed, bounces);
    return window > given.duration ? rounded_up(window) : window;
  }

  void add(const CalibratedSearch& measured) {
    result_->pull_in = measured.pull_in;
    result_->closing_time = measured.closing_time;
    findings().by_error = measured.by_error;
    if (measured.rows.empty()) return;
    const DevicesRow own = result_->row_of_devices();
    std::vector<DevicesRow> rows;
    for (DevicesRow row : measured.rows) {
      row.inherit(own);
      for (const DevicesRow& other : rows) row.inherit(other);
      rows.push_back(std::move(row));
    }
    std::ranges::copy(rows, std::back_inserter(result_->rows));
    const DevicesRow& best = rows[measured.best];
    if (!best.is_worth_measuring(own)) return;
    findings().measured = best.name;
    result_->calibrated = with_waveforms(result_->nominal.baseline_scene, measured.best_waveforms);
    if (const double window = whole_window(measured.best_waveforms); window > first().given.duration)
      set_window(*result_->calibrated, window);
    result_->calibrated->set(best.knowledge.time_error ? fmt::format("calibration.{}.error=\"50 ns\"", measured_time)
                                                       : fmt::format("calibration.{}.error=\"1 %\"", measured_pull_in));
  }

  [[nodiscard]] RobustnessOptions verdict_options() const {
    return {.samples = searched_.verdict(),
            .seed = options_.seed,
            .jobs = options_.jobs,
            .measures_drive_energy = options_.target.measures_drive_energy()};
  }
  [[nodiscard]] NamedDrive of_candidate(std::size_t n) const { return named(for_the_devices, result_->candidates[n]); }

  // Adds a row to the table of results, with the results of the final evaluation for the waveform of this name, or else for a
  // waveform with equal drive signals.
  void add_row(const char* name, const DriveWaveforms& waveforms) {
    const std::vector<DriveRobustness>& drives = result_->verdict.drives;
    auto found = std::ranges::find(drives, std::string_view(name), &DriveRobustness::name);
    if (found == drives.end()) {
      const PreparedScene& given = first().given;
      const std::vector<Signal> own = given.commanded(given.in_drive_order(searched_.all_drives(waveforms)));
      found = std::ranges::find_if(drives, [&](const DriveRobustness& other) {
        return same_drives(own, given.commanded(given.in_drive_order(other.waveforms)));
      });
    }
    if (found != drives.end()) result_->rows.push_back({.name = name, .knowledge = found->known.calibration(), .judged = *found});
  }

  // Decides the result by the final evaluation on fresh devices: the first candidate that is no worse than the plain step,
  // otherwise the plain step.
  void decide() {
    const double significant = first().given.scene.metrics.significant_rebound;
    std::vector<DriveRobustness>& drives = result_->verdict.drives;
    const DriveRobustness step = drives.front();
    std::vector<std::string>& worse_in = findings().worse_in;
    const auto compare = [&] {
      const std::vector<std::string_view> keys =
          softland::worse_in(result_->row_of_devices().judged.outcomes, step.outcomes, significant, options_.seed);
      worse_in.assign(keys.begin(), keys.end());
    };
    std::size_t n = 0;
    for (compare(); !worse_in.empty() && n + 1 < std::min(searched_.good_enough(), most_judged) && !progress_.stopped();
         compare()) {
      Robustness next = robustness(result_->varied, {of_candidate(++n)}, verdict_options(), progress_);
      result_->interrupted = next.interrupted;
      result_->row_of_devices().judged = next.drives.back();
      std::erase_if(drives, [](const DriveRobustness& one) { return one.name == for_the_devices; });
      drives.push_back(std::move(next.drives.back()));
    }
    result_->best.plain_step_wins = !worse_in.empty();
    if (result_->best.plain_step_wins) {
      result_->row_of_devices().judged = step;
      win({});
    } else {
      result_->chosen = result_->candidates[n];
      prefer_sooner(step);
      const ChosenFrom& winner = *result_->chosen;
      win(winner.waveforms);
      result_->best.family = winner.family;
      result_->best.prefix.clear();
      result_->best.parameters = winner.parameters;
      result_->best.variables = winner.variables;
      note_delay(winner);
    }
    for (const Condition& condition : searched_.conditions())
      findings().conditions.push_back(fulfilled(result_->row_of_devices().judged.outcomes, condition));
  }

  // Makes the offered quicker waveform ("fast") the best one, if it is worse neither than the best waveform nor than the plain
  // step.
  void prefer_sooner(const DriveRobustness& step) {
    const double significant = first().given.scene.metrics.significant_rebound;
    const auto fast = std::ranges::find(result_->choices, std::string_view(fast_row), &DeviceChoice::name);
    std::vector<DriveRobustness>& drives = result_->verdict.drives;
    const auto judged = std::ranges::find(drives, std::string_view(fast_row), &DriveRobustness::name);
    if (fast == result_->choices.end() || judged == drives.end()) return;
    const auto is_worse_than = [&](const std::vector<DeviceOutcome>& other) {
      return !softland::worse_in(judged->outcomes, other, significant, options_.seed).empty();
    };
    if (is_worse_than(result_->row_of_devices().judged.outcomes) || is_worse_than(step.outcomes)) return;
    result_->chosen = fast->candidate;
    result_->choices.erase(fast);
    judged->name = for_the_devices;
    result_->row_of_devices().judged = *judged;
    findings().worse_in.clear();
    DriveRobustness winner = std::move(*judged);
    drives.erase(judged);
    std::erase_if(drives, [](const DriveRobustness& one) { return one.name == for_the_devices; });
    drives.push_back(std::move(winner));
  }

  void note_delay(const ChosenFrom& winner) {
    const std::optional<StableApproach>& approach = searched_.approach();
    if (options_.actuator != Actuator::pzt || !is_quasi_static(winner.family) || approach->holder.empty()) return;
    const Signal step = signal(winner.waveforms.at(approach->holder));
    for (const double time : step.breakpoints()) {
      if (std::isnan(findings().step_delay) && time > 0) findings().step_delay = time;
    }
  }

  // Completes the waveforms offered to the user with their performance on fresh devices. Leaves out a waveform if a quicker one
  // is no worse in impact velocity, rebound and force.
  void decide_choices() {
    std::vector<DeviceChoice> all = std::exchange(result_->choices, {});
    if (result_->best.plain_step_wins) return;
    const double significant = first().given.scene.metrics.significant_rebound;
    const std::vector<DriveRobustness>& drives = result_->verdict.drives;
    const double of_step = waited(drives.front().outcomes, result_->free.figure);
    std::vector<DeviceChoice> kept;
    for (DeviceChoice& one : all) {
      const bool is_default = one.name == default_choice;
      if (is_default) one.candidate = *result_->chosen;
      const std::string_view row = is_default ? std::string_view(for_the_devices) : std::string_view(one.name);
      const auto found = std::ranges::find(drives, row, &DriveRobustness::name);
      one.judged = found != drives.end() ? *found : result_->row_of_devices().judged;
      one.tau = waited(one.judged.outcomes, result_->free.figure) / of_step;
      const auto equals = [&](const DeviceChoice& sooner) {
        return softland::worse_in(sooner.judged.outcomes, one.judged.outcomes, significant, options_.seed).empty();
      };
      const bool harder_than_step =
          !is_default && !softland::worse_in(one.judged.outcomes, drives.front().outcomes, significant, options_.seed).empty();
      if (harder_than_step || (!is_default && std::ranges::any_of(kept, equals))) continue;
      kept.push_back(std::move(one));
    }
    for (DeviceChoice& one : kept) {
      if (one.name == default_choice) continue;
      one.scene = scene_of(one.candidate.waveforms);
      result_->rows.push_back({.name = one.name, .knowledge = one.judged.known.calibration(), .judged = one.judged});
    }
    result_->choices = std::move(kept);
  }

  // Returns the nominal scene with these waveforms in volts, over the simulated time of the final evaluation.
  [[nodiscard]] SceneFile scene_of(const DriveWaveforms& waveforms) const {
    SceneFile file = with_waveforms(result_->nominal.baseline_scene, waveforms);
    if (result_->varied.duration > first().given.duration) set_window(file, result_->varied.duration);
    return file;
  }

  // Makes these waveforms the result of the search, with a confirmed simulation of the closing of the nominal device.
  void win(const DriveWaveforms& waveforms) {
    OptimizeResult& best = result_->best;
    const OptimizeResult& nominal = result_->nominal;
    best.best_scene = read_back(scene_of(waveforms), "best.toml", nominal.scene);
    best.best = simulate(*best.best_scene, true, progress_);
    best.checks = run_checks(*best.best_scene);
    const Metrics& m = best.best->metrics;
    best.goal_met = goal_met(options_.target, m, nominal.baseline.metrics);
    best.confirmed = best.goal_met && std::ranges::all_of(best.checks, [](const CheckingRun& run) {
                       return run.varied == Varied::gas || run.metrics.is_bounce_free();
                     });
    best.better_than_baseline = !best.plain_step_wins;
    best.harder_than_step = hardness_beyond_step(m, nominal.baseline.metrics);
    best.best_cost = searched_.cost().value(result_->row_of_devices().judged.outcomes, searched_.aims().tail);
    best.baseline_cost = searched_.cost().value(result_->verdict.drives.front().outcomes, searched_.aims().tail);
  }

  [[nodiscard]] DevicesFindings& findings() { return result_->findings; }
  const SceneFile& file_;
  const OptimizeOptions& options_;
  const RobustSearchOptions& devices_;
  Progress progress_;
  std::atomic<bool> searches_nominal_ = false;
  RobustSearch searched_;
  OptimizeOptions nominal_options_;
  // Result of the whole search; empty until the search on the nominal device has ended.
  std::optional<RobustSearchResult> result_;
  // The best candidate with the electrode's plain step at t = 0. It gets a row of results, for comparison, if the search may
  // choose the instant of this step.
  std::optional<ChosenFrom> undelayed_;
  std::future<void> beside_;  // search over devices in another thread; the last member, since it uses the others
};

}  // namespace

bool RobustSearchResult::plain_step_is_bounce_free() const {
  return !verdict.drives.empty() && quantile_95(verdict.drives.front().outcomes, key_of(&Metrics::major_bounce_height)) <=
                                        varied.scene.metrics.significant_rebound;
}

RobustSearchResult robust_search(const SceneFile& file, const OptimizeOptions& options, const RobustSearchOptions& devices) {
  require(options.own_waveforms.empty(), "own waveforms are searched for the nominal design, or over devices by one measure");
  return RobustSearchStudy(file, options, devices).run();
}

}  // namespace softland
