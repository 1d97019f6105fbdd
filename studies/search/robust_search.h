// The search over varied devices: a tournament between waveform families by two measures (tournament.h), a choice among its
// candidates on devices that the tournament has not used, and searches with a per-device calibration. The tournament does not
// need the waveform of the nominal design.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/search/devices_findings.h"
#include "studies/search/family_tournament.h"
#include "studies/search/optimize.h"
#include "studies/search/robust_optimize.h"
#include "studies/search/search_budget.h"

namespace softland {

/// The best candidate so far of a running search over varied devices, evaluated on devices that the search has not used.
struct Leading {
  std::string family;
  /// Outcomes of the same devices under the plain step and under the best candidate waveform.
  std::vector<DeviceOutcome> of_step, own;
  /// Member of Metrics that is the time until contact in this search, see FreeTime::figure.
  double Metrics::*waited_for = nullptr;
  SceneFile scene;  ///< the scene with the best candidate's waveform
};

struct RobustSearchOptions {
  /// Conditions on device_figures that the waveform must fulfil on 95 % of the devices.
  std::vector<Condition> conditions = {};
  /// Number of fresh devices (new to the search) for the final evaluation of the waveforms.
  std::uint64_t verdict = 2000;
  bool verdict_is_asked = false;  ///< true: the user gave `verdict`; false: it may be reduced if closings are slow
  /// Waveform families of the tournament. If empty: tournament_families and the quasi-static approach, as far as the scene's
  /// limits permit.
  std::string families = {};
  /// True: with the actuator pzt, the instant of the electrode's plain step is searched; false: the step is at t = 0.
  bool hold_step_is_chosen = true;
  /// True: searches as earlier versions did, for old requests: the time of first contact adds to the cost, and there is no
  /// quasi-static approach.
  bool is_of_before = false;
  long closings = tournament_closings;  ///< total number of closings of the tournament of waveform families
  bool are_a_budget = false;            ///< true: `closings` is an upper limit, even if many devices are bounce-free
  bool counts_work = false;             ///< true: the tournament makes fewer closings if they are slow (search_budget.h)
  /// Function that is called with every new best candidate waveform; from any thread, one call at a time.
  std::function<void(const Leading&)> on_leading = {};
};

/// Divides one budget of closings: a fifth of options.max_evaluations for the search on the nominal device, the rest for the
/// tournament over devices.
void share_budget(OptimizeOptions& options, RobustSearchOptions& devices);

/// A row of the main table of results: performance of one waveform on the fresh devices (new to the search), under one
/// calibration.
struct DevicesRow {
  std::string name;             ///< name of the row: "plain step", "for the drawing", "for the devices", "Vdp to 1 %"
  Calibration knowledge = {};   ///< measured quantities by which each device's waveform is scaled
  bool searched_for_it = true;  ///< false: the waveform was searched for another calibration than `knowledge`
  DriveRobustness judged = {};

  /// Takes the results of the row `other`, if its devices close better and `other` needs no better calibration than this row.
  void inherit(const DevicesRow& other);
  /// Returns true if this calibrated row is so much better than `uncalibrated` that measuring every device is worthwhile.
  [[nodiscard]] bool is_worth_measuring(const DevicesRow& uncalibrated) const;
};
/// A further waveform is offered to the user only if its impact velocity, or its time until a steady contact, is below this
/// share of the default waveform's.
inline constexpr double worth_choosing = 0.9;

/// True if row `a` is better than row `b`: it has more bounce-free devices, or, if both have fewer than half, softer impacts.
[[nodiscard]] bool has_better_yield(const DevicesRow& a, const DevicesRow& b);

/// A candidate for the best waveform, with its performance on the devices on which the best one is chosen (not used by the
/// searches).
struct ChosenFrom {
  std::string measure,
      family;  ///< measure of risk and waveform family of the search that found the candidate, as in TournamentEntry
  DriveWaveforms waveforms;
  std::map<std::string, double>
      parameters;  ///< waveform parameters by drive.name; empty for some waveforms of the search on the nominal device
  std::vector<Variable> variables;
  long closings = 0;
  // The following members are the performance on the devices on which the best candidate is chosen.
  double bounce_free = 0, tail = 0;  ///< share of bounce-free devices; cost by the tail measure
  double measured = 0;  ///< measure of risk R(s) alone, without the cost of time and conditions, see RobustCost::measured()
  /// 95th percentiles over the devices of first contact time [s] and impact velocity [m/s].
  double first_touch = Metrics::unset, impact_speed = Metrics::unset;
  double median_touch = Metrics::unset;  ///< median over the devices of the time of first contact [s]
  double waited = Metrics::unset;        ///< 95th percentile over the devices of the time until contact by FreeTime::figure [s]
  /// True if the candidate may become the result: its figures are lower than under the plain step, and it fulfils the
  /// conditions.
  bool is_good_enough = false;
  bool is_in_usual_room = false;  ///< true if the tournament within the default voltage limits found the candidate
};

/// From this bounce-free share of devices on, waveforms are compared by their bounce-free shares; below it, by other figures.
inline constexpr double half_is_bounce_free = 0.5;

/// Return a quantile over devices of the figure `key` of device_figures, and its 95th percentile.
[[nodiscard]] double quantile(const std::vector<DeviceOutcome>& outcomes, std::string_view key, double probability);
[[nodiscard]] double quantile_95(const std::vector<DeviceOutcome>& outcomes, std::string_view key);
[[nodiscard]] double share_of(const std::vector<DeviceOutcome>& outcomes, bool (*holds)(const DeviceOutcome&));

/// Results of the searches with a per-device calibration.
struct CalibratedSearch {
  /// Dynamic pull-in voltage of the nominal device [V]; unset if devices cannot be calibrated.
  double pull_in = Metrics::unset;
  /// Closing time of the nominal device under the slow step by which devices are calibrated [s].
  double closing_time = Metrics::unset;
  std::vector<DevicesRow> rows = {};
  std::vector<CalibrationError> by_error = {};
  std::size_t best = 0;                ///< index in `rows` of the row with the best performance
  DriveWaveforms best_waveforms = {};  ///< the waveforms of row `best`, as for the nominal device
};

/// Prefix of the parameters of searches over devices, in tables that also have those of the search on the nominal device.
inline constexpr std::string_view tournament_prefix = "devices.";

class RobustSearch {
 public:
  /// Keeps references to `options` and `devices`. `tell` receives the progress, from any thread. Throws the exceptions of
  /// optimize().
  RobustSearch(const SceneFile& file, const OptimizeOptions& options, const RobustSearchOptions& devices,
               std::function<void(std::string_view what, double part)> tell);

  /// Returns the setting of the first waveform family; its scene is the given scene with the process variation that is used.
  [[nodiscard]] const SearchSetting& first() const { return settings_.front(); }
  [[nodiscard]] const MeasuredUnits& known() const { return *known_; }
  [[nodiscard]] bool spread_assumed() const { return spread_assumed_; }
  /// Returns the parameters of all waveform families; the names begin with tournament_prefix.
  [[nodiscard]] FamilyColumns columns() const;
  /// Returns the budget of the whole search. Its time begins at the construction of this object; it counts closings of devices.
  [[nodiscard]] SearchBudget& budget() { return budget_; }
  /// Returns `nominal`, the estimated work of the search on the nominal device, with the work of this search added.
  [[nodiscard]] SearchEstimate estimate(SearchEstimate nominal) const;

  /// Runs the tournament and the quasi-static searches, evaluates their best candidates on the devices for choosing the best
  /// one, and computes the calibrations of the fresh devices. The numbers of the waveform families in the memory begin at
  /// `before`. Calls `looked` once, after the first candidate was evaluated on the devices for choosing. Leaves `reserved` [s]
  /// of a time budget to later work other than the final evaluation. Throws Interrupted if a stop is requested.
  void run(std::size_t before, std::function<void()> looked, double reserved);
  /// Makes run() end soon, without a usable result. May be called from any thread.
  void give_up() { budget_.give_up(); }

  /// Returns the slow approach by which a drive moves the switch to its contact through stable equilibria; none if the
  /// quasi-static approach is not searched.
  [[nodiscard]] const std::optional<StableApproach>& approach() const { return approach_; }
  /// Returns the share of devices that the drive of approach() can move to their contact through stable equilibria.
  [[nodiscard]] double share_with_path() const { return share_with_path_; }

  /// Returns how long devices may take until contact at no cost, as found on devices under the plain step. This function and
  /// the following ones are valid after run().
  [[nodiscard]] const FreeTime& free() const { return free_; }
  /// Returns the cost over the devices on which the tournament tries waveforms.
  [[nodiscard]] const RobustCost& cost() const { return *cost_; }
  [[nodiscard]] const TournamentAims& aims() const { return aims_; }
  [[nodiscard]] const std::vector<Condition>& conditions() const { return conditions_; }
  /// Evaluates a candidate on the devices on which the best one is chosen (not used by the searches), and adds it to placed().
  void place(ChosenFrom candidate);
  /// Returns the best candidate so far of an interrupted search; null if it is no better than the plain step.
  [[nodiscard]] const ChosenFrom* leader() const;
  /// Returns the candidates that were evaluated while the tournament ran, with their performance on the devices on which the
  /// best one is chosen.
  [[nodiscard]] std::vector<ChosenFrom> looked_at() const {
    std::vector<ChosenFrom> all;
    for (const Placed& one : looked_at_) all.push_back(one.candidate);
    return all;
  }
  [[nodiscard]] const std::vector<DeviceOutcome>& step_on_others() const { return step_on_others_; }
  /// Returns the ranked candidate waveforms, the best first; candidates with ChosenFrom::is_good_enough come before all others.
  [[nodiscard]] std::vector<ChosenFrom> placed() const;
  [[nodiscard]] std::size_t good_enough() const {
    const auto found = std::ranges::count_if(placed_, [](const Placed& one) { return one.candidate.is_good_enough; });
    return static_cast<std::size_t>(found);
  }
  /// Searches with a per-device calibration, starting at the best waveform `winner` and at the nominal design's waveform
  /// `drawing`. The result has no rows if devices cannot be measured.
  [[nodiscard]] CalibratedSearch in_measured_units(const ChosenFrom& winner, const DriveWaveforms& nominal);
  /// Returns the cost over the fresh devices (new to the search), with their measured scale factors, for closings over the
  /// short simulated time of a search.
  [[nodiscard]] RobustCost verdict_devices(const MeasuredUnits& known);
  /// Returns the outcomes of all devices of `cost` under the waveforms; budget() counts these closings.
  [[nodiscard]] std::vector<DeviceOutcome> closed(const RobustCost& cost, const DriveWaveforms& waveforms);
  /// Returns the waveforms of all drives: `searched` for the searched drives, and the plain step for the others.
  [[nodiscard]] DriveWaveforms all_drives(DriveWaveforms searched) const;
  /// Returns the number of fresh devices (new to the search): as requested, or fewer if closings are slow.
  [[nodiscard]] std::uint64_t verdict() const { return verdict_; }

 private:
  // Upper bounds, relative to the plain step, on the figures of a candidate waveform that may become the result.
  struct Bounds {
    std::vector<double> figures;  // 95th percentiles under the plain step of judged_figures
    // 95th percentile of the time of first contact [s], and share of devices that stay open, under the plain step.
    double first_touch, open;

    explicit Bounds(const std::vector<DeviceOutcome>& step);
    /// Returns true if the devices' outcomes `own` under the candidate waveform are within the bounds. `in_time`: first contact
    /// must also not be much later than under the plain step. Rebounds below `significant` [m] are permitted.
    [[nodiscard]] bool keeps(const std::vector<DeviceOutcome>& own, double significant, bool in_time) const;
  };
  struct Placed {
    ChosenFrom candidate;
    bool half_is_bounce_free;
    double rank;

    [[nodiscard]] bool is_before(const Placed& other) const;
  };
  static void prefer_sooner(std::vector<Placed>& sorted);
  using Found = std::optional<DriveWaveforms>;

  void fit_budget();
  void run_family_tournament(double reserved);
  [[nodiscard]] std::vector<SearchSetting> tournament_settings() const;
  void run_tournaments();
  void take(std::vector<ChosenFrom>& pool, TournamentResult& found, bool is_in_usual_room) const;
  [[nodiscard]] std::vector<Pace> paces_of_search() const;
  void search_paces();
  void make_aims(const std::vector<DeviceOutcome>& step, const FreeTime& free);
  [[nodiscard]] bool says_when_to_close() const;
  void reserve_for_verdict(double closing, double reserved);
  [[nodiscard]] TournamentOptions tournament_options();
  void choose();
  void look(const Contender& contender);
  [[nodiscard]] std::vector<DeviceOutcome> on_others(const DriveWaveforms& waveforms);
  [[nodiscard]] Placed judged(ChosenFrom one, const std::vector<DeviceOutcome>& outcomes) const;
  [[nodiscard]] ChosenFrom candidate_of(const Contender& contender) const;
  void measure_ahead();
  [[nodiscard]] bool tells_time() const;
  [[nodiscard]] std::array<Found, 2> searched_in(const ChosenFrom& winner, const DriveWaveforms& nominal,
                                                 const std::array<Calibration, 2>& calibrations);
  [[nodiscard]] TournamentResult searched_at_pace(const RobustCost& cost, const TournamentAims& aims, std::size_t family,
                                                  TournamentOptions options);
  [[nodiscard]] bool is_harder_than_step(const RobustCost& cost, const DriveWaveforms& waveforms) const;
  [[nodiscard]] TournamentAims no_harder() const;
  [[nodiscard]] DevicesRow row_of(const char* name, const DriveWaveforms& waveforms, const Calibration& knowledge,
                                  bool searched_for_it);
  [[nodiscard]] std::vector<CalibrationError> judged_by_error(const std::vector<DriveWaveforms>& waveforms,
                                                              const DriveWaveforms& in_volts);
  [[nodiscard]] const CalibratedEnsemble& calibrated(const Calibration& knowledge);

  const OptimizeOptions& options_;
  const RobustSearchOptions& devices_;
  Progress progress_;
  SearchBudget budget_;
  bool spread_assumed_ = false;
  std::vector<SearchSetting> settings_;
  std::size_t tournament_families_ = 0;  // number of waveform families in the tournament: the first of settings_
  // Settings of the first tournament, within the default voltage limits; empty unless the scene's limits are wider.
  std::vector<SearchSetting> usual_room_;
  std::vector<std::string> names_;  // names of the waveform families
  std::optional<StableApproach> approach_;
  double share_with_path_ = Metrics::unset;
  std::optional<MeasuredUnits> known_;
  std::optional<SearchBudget> before_verdict_;  // part of the budget for all work before the final evaluation
  long tournament_length_ = tournament_closings;
  std::uint64_t verdict_ = RobustSearchOptions{}.verdict;
  std::vector<Condition> conditions_;  // the user's conditions, with numbers for limits relative to the plain step
  RobustAim tail_aim_;
  TournamentAims aims_;
  std::vector<Condition> at_most_step_;  // conditions: each of judged_figures must be at most that under the plain step
  // Costs over the devices on which the tournament tries waveforms, and over those on which the best candidate is chosen.
  std::optional<RobustCost> cost_, others_;
  FreeTime free_;
  std::vector<Contender> paced_;
  TournamentResult tournament_result_, tournament_in_usual_room_;
  std::optional<Bounds> bounds_;
  // Outcomes under the plain step of the devices on which the best candidate is chosen.
  std::vector<DeviceOutcome> step_on_others_;
  std::function<void()> looked_;
  std::vector<Placed> looked_at_;  // candidates evaluated while the tournament ran, in order of time
  std::optional<Placed> leader_;   // the best candidate in looked_at_
  std::vector<Placed> placed_;     // candidates evaluated by place(), in order of time
  // Fresh devices (new to the search) with their scale factors without measurement errors, for a calibration by pull-in voltage
  // and for one by closing time.
  std::optional<CalibratedEnsemble> calibrated_by_pull_in_, calibrated_by_time_;
  // Simulates the measurements of a calibration; empty if devices cannot be measured.
  std::optional<PullInMeter> meter_;
};

}  // namespace softland
