// The search over varied devices: a tournament between waveform families by two measures (race.h), a choice among its
// candidates on devices that the tournament has not used, and searches with a per-device calibration. The tournament does not
// need the waveform of the nominal design.
#pragma once

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
#include "studies/search/optimize.h"
#include "studies/search/paced_search.h"
#include "studies/search/race.h"
#include "studies/search/robust_optimize.h"
#include "studies/search/search_budget.h"

namespace softland {

/// The best candidate waveform so far of a running search over varied devices, evaluated on the devices on which the best
/// waveform is chosen.
struct Leading {
  std::string family;
  /// Outcomes of the same devices under the plain step and under the best candidate waveform.
  std::vector<DeviceOutcome> of_step, own;
  /// Member of Metrics with the time until contact that users wait for, as FreeTime::figure.
  double Metrics::*waited_for = nullptr;
  SceneFile scene;  ///< the scene with the best candidate's waveform
};

struct RobustSearchOptions {
  std::vector<Condition> conditions = {};  ///< conditions on device_figures that 95 % of the devices have to fulfil
  /// Number of fresh devices (new to the search) on which the waveforms are evaluated in the end.
  std::uint64_t verdict = 2000;
  bool verdict_is_asked = false;  ///< false: the number `verdict` is a default, reduced if closings are slow, see counts_work
  /// Waveform families of the tournament. Empty: those of raced_families that the scene's limits permit, and the quasi-static
  /// approach.
  std::string families = {};
  /// True: with the actuator pzt, the instant of the electrode's plain step is searched; false: the step is at t = 0.
  bool hold_step_is_chosen = true;
  bool is_of_before = false;      ///< true: searches as earlier versions did: the time of first contact costs, and there is
                                  ///< no quasi-static approach
  long closings = race_closings;  ///< total number of closings of the tournament of waveform families
  bool are_a_budget = false;      ///< true: `closings` is a limit even if many devices close without a bounce
  bool counts_work = false;       ///< true: the tournament makes fewer than `closings` if closings are slow (search_work.h)
  /// Function that is called with every new best candidate waveform; from any thread, one call at a time.
  std::function<void(const Leading&)> on_leading = {};
};

/// Divides one budget of closings: a fifth of options.max_evaluations for the search on the nominal device, the rest for the
/// tournament over devices.
void share_budget(OptimizeOptions& options, RobustSearchOptions& devices);

/// A row of the main table of results: the fresh devices (new to the search) under one waveform and calibration.
struct DevicesRow {
  std::string name;             ///< name of the row: "plain step", "for the drawing", "for the devices", "Vdp to 1 %"
  Calibration knowledge = {};   ///< measurements of each device by which its waveform is scaled
  bool searched_for_it = true;  ///< false: the waveform was searched for another calibration than `knowledge`
  /// True: simulated over the scene's whole simulated time; false: over the shorter time of a search.
  bool judged_whole = true;
  DriveRobustness judged = {};

  /// Takes the waveform of the row `other`, if `other` needs a less precise calibration and its devices close better.
  void inherit(const DevicesRow& other);
  /// Returns true if this row of results is so much better than a row without a calibration that devices are worth measuring.
  [[nodiscard]] bool is_worth_measuring(const DevicesRow& uncalibrated) const;
};
/// A further waveform is offered to the user only when its impact velocity or time is below this share of those of the first
/// one.
inline constexpr double worth_choosing = 0.9;

/// True if more devices of `a` than of `b` are bounce-free, provided that `a` or `b` has at least half bounce-free devices;
/// otherwise true if the impacts of `a` are softer.
[[nodiscard]] bool lands_better(const DevicesRow& a, const DevicesRow& b);

/// A candidate for the best waveform, with its figures on the devices on which the best waveform is chosen.
struct ChosenFrom {
  std::string measure, family;  ///< measure of risk and waveform family of the candidate's search, as in RaceEntry
  DriveWaveforms waveforms;
  std::map<std::string, double>
      parameters;  ///< waveform parameters by drive.name; empty for waveforms of the search on the nominal device
  std::vector<Variable> variables;
  long closings = 0;
  // The members below are figures on the devices on which the best waveform is chosen.
  double bounce_free = 0, tail = 0;  ///< bounce-free share of the devices; tail of the cost over the devices
  double measured = 0;  ///< measure of risk of the candidate waveform alone, without the cost of the time until contact
  /// 95th percentiles over the devices of first contact time [s] and impact velocity [m/s].
  double first_touch = Metrics::unset, impact_speed = Metrics::unset;
  double median_touch = Metrics::unset;  ///< median over the devices of the time of first contact [s]
  double waited = Metrics::unset;        ///< 95th percentile over the devices of the time until contact by FreeTime::figure [s]
  /// True if the candidate waveform meets the bounds of the choice: no figure much worse than under the plain step.
  bool is_good_enough = false;
  bool is_in_usual_room = false;  ///< true if the tournament within the default voltage limits found the candidate waveform
};

/// Bounce-free share of devices from which on candidate waveforms are compared by this share.
inline constexpr double lands_half = 0.5;

/// Return a quantile over devices of the figure `key` of device_figures, and its 95th percentile.
[[nodiscard]] double quantile(const std::vector<DeviceOutcome>& outcomes, std::string_view key, double probability);
[[nodiscard]] double quantile_95(const std::vector<DeviceOutcome>& outcomes, std::string_view key);
[[nodiscard]] double share_of(const std::vector<DeviceOutcome>& outcomes, bool (*holds)(const DeviceOutcome&));

/// Results of the searches with a per-device calibration.
struct CalibratedSearch {
  double pull_in = Metrics::unset;       ///< dynamic pull-in voltage of the nominal device [V]; set if devices can be
                                         ///< calibrated
  double closing_time = Metrics::unset;  ///< closing time of the nominal device under the step whose closing time is measured
                                         ///< [s]
  std::vector<DevicesRow> rows = {};
  std::vector<CalibrationError> by_error = {};
  std::size_t best = 0;                ///< index in `rows` of the best row
  DriveWaveforms best_waveforms = {};  ///< waveforms of the searched drives in the best of `rows`, for the nominal device
};

/// Prefix of the tournament's parameters, among the parameters of all searches.
inline constexpr std::string_view raced_prefix = "devices.";

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
  /// Returns the parameters of all waveform families; the names begin with raced_prefix.
  [[nodiscard]] FamilyColumns columns() const;
  /// Returns the budget of the whole search: its time, from the construction of this RobustSearch on, and the closings of
  /// devices so far.
  [[nodiscard]] SearchBudget& budget() { return budget_; }
  /// Adds the work of this search to `nominal`, the estimate for the search on the nominal device.
  [[nodiscard]] SearchEstimate estimate(SearchEstimate nominal) const;

  /// Runs the tournament, ranks its candidate waveforms, and measures the fresh devices (new to the search). The waveform
  /// families of the tournament come after `before` other families that share the memory. Calls `looked` once, after the first
  /// candidate was evaluated on the devices on which the best waveform is chosen. Leaves `reserved` [s] of a time budget to
  /// later work other than the final evaluation. Throws Interrupted if a stop is requested.
  void run(std::size_t before, std::function<void()> looked, double reserved);
  /// Makes run() end soon, without a usable result; from any thread.
  void give_up() { budget_.give_up(); }

  /// Returns the stable path by which a drive moves the switch to its contact; none if the quasi-static approach is not
  /// searched.
  [[nodiscard]] const std::optional<StableApproach>& approach() const { return approach_; }
  /// Returns the share of varied devices that a drive can move to their contact through stable equilibria.
  [[nodiscard]] double share_with_path() const { return share_with_path_; }

  // Results of run(), valid after this call.
  /// Returns the time until contact that costs nothing: that of the tournament's devices under the plain step.
  [[nodiscard]] const FreeTime& free() const { return free_; }
  /// Returns the cost of a waveform over the devices of the tournament.
  [[nodiscard]] const RobustCost& cost() const { return *cost_; }
  [[nodiscard]] const RaceAims& aims() const { return aims_; }
  [[nodiscard]] const std::vector<Condition>& conditions() const { return conditions_; }
  /// Evaluates a candidate waveform on the devices on which the best waveform is chosen, and adds it to placed().
  void place(ChosenFrom candidate);
  /// Returns the best candidate waveform so far of an interrupted search; null if worse than the plain step.
  [[nodiscard]] const ChosenFrom* leader() const;
  /// Returns the candidate waveforms that were evaluated during the tournament, with figures on the devices on which the best
  /// waveform is chosen.
  [[nodiscard]] std::vector<ChosenFrom> looked_at() const;
  [[nodiscard]] const std::vector<DeviceOutcome>& step_on_others() const { return step_on_others_; }
  /// Returns the ranked candidate waveforms, the best first; those with ChosenFrom::is_good_enough come before all others.
  [[nodiscard]] std::vector<ChosenFrom> placed() const;
  [[nodiscard]] std::size_t good_enough() const;
  /// Searches with a per-device calibration, starting at the best waveform `winner` and at the nominal design's waveform
  /// `drawing`. No rows if devices cannot be measured.
  [[nodiscard]] CalibratedSearch in_measured_units(const ChosenFrom& winner, const DriveWaveforms& drawing);
  /// Returns the cost over the fresh devices (new to the search), with their measured scale factors, for closings over the
  /// simulated time of a search.
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
    std::vector<double> figures;  // 95th percentiles of the figures judged_figures under the plain step
    // 95th percentile of the time of first contact [s], and share of open devices, under the plain step.
    double first_touch, open;

    explicit Bounds(const std::vector<DeviceOutcome>& step);
    /// Returns true if the devices' outcomes `own` under the candidate waveform are within the bounds. `in_time`: the candidate
    /// must also not close much later than the plain step.
    [[nodiscard]] bool keeps(const std::vector<DeviceOutcome>& own, double significant, bool in_time) const;
  };
  struct Placed {
    ChosenFrom candidate;
    bool lands_half;
    double rank;

    [[nodiscard]] bool is_before(const Placed& other) const;
  };
  static void prefer_sooner(std::vector<Placed>& sorted);
  using Found = std::optional<DriveWaveforms>;

  void fit_budget();
  void race_families(double reserved);
  [[nodiscard]] std::vector<SearchSetting> raced_settings() const;
  void race_all();
  void take(std::vector<ChosenFrom>& pool, RaceResult& raced, bool is_in_usual_room) const;
  [[nodiscard]] std::vector<Pace> paces_of_search() const;
  void search_paces();
  void make_aims(const std::vector<DeviceOutcome>& step, const FreeTime& free);
  [[nodiscard]] bool says_when_to_close() const;
  void reserve_for_verdict(double closing, double reserved);
  [[nodiscard]] RaceOptions race_options();
  void choose();
  void look(const Contender& contender);
  [[nodiscard]] std::vector<DeviceOutcome> on_others(const DriveWaveforms& waveforms);
  [[nodiscard]] Placed judged(ChosenFrom one, const std::vector<DeviceOutcome>& outcomes) const;
  [[nodiscard]] ChosenFrom candidate_of(const Contender& contender) const;
  void measure_ahead();
  [[nodiscard]] bool tells_time() const;
  [[nodiscard]] std::array<Found, 2> searched_in(const ChosenFrom& winner, const DriveWaveforms& drawing,
                                                 const std::array<Calibration, 2>& calibrations);
  [[nodiscard]] RaceResult searched_at_pace(const RobustCost& cost, const RaceAims& aims, std::size_t family,
                                            RaceOptions options);
  [[nodiscard]] bool is_harder_than_step(const RobustCost& cost, const DriveWaveforms& waveforms) const;
  [[nodiscard]] RaceAims no_harder() const;
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
  std::size_t raced_ = 0;  // number of settings in the tournament, which come first in settings_
  // Settings of the search within the default voltage limits; none unless the scene's limits are wider.
  std::vector<SearchSetting> usual_room_;
  std::vector<std::string> names_;  // names of the waveform families
  std::optional<StableApproach> approach_;
  double share_with_path_ = Metrics::unset;
  std::optional<MeasuredUnits> known_;
  std::optional<SearchBudget> before_verdict_;  // part of the search's budget for the work before the final evaluation
  long race_length_ = race_closings;
  std::uint64_t verdict_ = RobustSearchOptions{}.verdict;
  std::vector<Condition> conditions_;  // conditions on figures whose limits are numbers
  RobustAim tail_aim_;
  RaceAims aims_;
  std::vector<Condition> at_most_step_;  // conditions that no figure of a candidate waveform is worse than under the plain step
  // Costs of a waveform over the devices of the tournament, and over those on which the best waveform is chosen.
  std::optional<RobustCost> cost_, others_;
  FreeTime free_;
  std::vector<Contender> paced_;
  RaceResult race_, race_in_usual_room_;
  std::optional<Bounds> bounds_;
  // Outcomes under the plain step of the devices on which the best waveform is chosen.
  std::vector<DeviceOutcome> step_on_others_;
  std::function<void()> looked_;
  std::vector<Placed> looked_at_;  // candidate waveforms evaluated during the tournament, in this order
  std::optional<Placed> leader_;   // the best candidate waveform so far, among looked_at_
  std::vector<Placed> placed_;     // candidate waveforms in the order in which place() received them
  // Fresh devices (new to the search) with measured pull-in voltage, and with measured closing time.
  std::optional<CalibratedEnsemble> calibrated_by_pull_in_, calibrated_by_time_;
  // Measures pull-in voltage and closing time of devices; none if devices cannot be measured.
  std::optional<PullInMeter> meter_;
};

}  // namespace softland
