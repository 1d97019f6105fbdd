// The search over devices: a race of families by two measures (race.h), a choice among candidates on devices that the race has
// not seen, and searches with a per-device calibration. The race does not need the nominal design's waveform.
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

/// The candidate that leads a search over devices in progress, on the devices of the choice.
struct Leading {
  std::string family;
  std::vector<DeviceOutcome> of_step, own;  ///< outcomes of the same devices under the plain step and the leader
  double Metrics::*waited_for = nullptr;    ///< the figure that FreeTime counts
  SceneFile scene;                          ///< the scene with the leader's waveform
};

struct RobustSearchOptions {
  std::vector<Condition> conditions = {};  ///< conditions on device_figures for 95 % of the devices
  std::uint64_t verdict = 2000;            ///< fresh devices of the verdict
  bool verdict_is_asked = false;           ///< false: slow closings get fewer devices, as counts_work says
  /// Families of the race. Empty: raced_families, as far as the scene has room for them, and the quasi-static approach.
  std::string families = {};
  bool hold_step_is_chosen = true;  ///< with the actuator pzt the electrode's plain step may come later than t = 0
  bool is_of_before = false;        ///< searches as the versions that priced the first touch and had no quasi-static approach
  long closings = race_closings;    ///< closings of the race
  bool are_a_budget = false;        ///< the race takes no more closings where many devices land
  bool counts_work = false;         ///< closings are usual ones: slow closings get fewer (search_work.h)
  /// Called with the leader whenever it is better than the one before; from any thread, one call at a time.
  std::function<void(const Leading&)> on_leading = {};
};

/// A row of the first table: the fresh devices under one kind of drive.
struct DevicesRow {
  std::string name;             ///< "plain step", "for the drawing", "for the devices", "Vdp to 1 %"
  Calibration knowledge = {};   ///< measurements on every device
  bool searched_for_it = true;  ///< false: the waveform was searched for another calibration
  bool judged_whole = true;     ///< judged over the whole window of a closing; false: over that of a search
  DriveRobustness judged = {};
};

/// True if more devices of `a` are bounce-free, where half of them are in either; else if the impacts of `a` are softer.
[[nodiscard]] bool lands_better(const DevicesRow& a, const DevicesRow& b);

/// A candidate of the choice, with its waveforms.
struct ChosenFrom {
  std::string measure, family;  ///< see RaceEntry
  DriveWaveforms waveforms;
  std::map<std::string, double> parameters;  ///< parameters by drive.name; empty for what the nominal search tried
  std::vector<Variable> variables;
  long closings = 0;
  // Figures on the devices of the choice:
  double bounce_free = 0, tail = 0;                                    ///< share of the devices; cost
  double measured = 0;                                                 ///< the measure alone, without any price of time
  double first_touch = Metrics::unset, impact_speed = Metrics::unset;  ///< 95th percentiles [s], [m/s]
  double median_touch = Metrics::unset;                                ///< median of the first touch [s]
  double waited = Metrics::unset;  ///< 95th percentile of what RobustSearch::free() counts [s]
  bool is_good_enough = false;     ///< meets the bounds of the choice
  bool is_in_usual_room = false;   ///< found by the race within the usual limits
};

/// Bounce-free share from which on that share decides, where it can.
inline constexpr double lands_half = 0.5;

/// A quantile of a figure of device_figures, and its 95th percentile.
[[nodiscard]] double quantile(const std::vector<DeviceOutcome>& outcomes, std::string_view key, double probability);
[[nodiscard]] double quantile_95(const std::vector<DeviceOutcome>& outcomes, std::string_view key);
[[nodiscard]] double share_of(const std::vector<DeviceOutcome>& outcomes, bool (*holds)(const DeviceOutcome&));

/// Results with measured devices.
struct CalibratedSearch {
  double pull_in = Metrics::unset;       ///< Vdp of the nominal device, if devices can be measured [V]
  double closing_time = Metrics::unset;  ///< closing time of the nominal device under the measured step [s]
  std::vector<DevicesRow> rows = {};
  std::vector<CalibrationError> by_error = {};
  std::size_t best = 0;                ///< index of the best row
  DriveWaveforms best_waveforms = {};  ///< waveforms of the searched drives for the nominal device
};

/// Prefix of the parameters of the race, among those of all searches.
inline constexpr std::string_view raced_prefix = "devices.";

class RobustSearch {
 public:
  /// Keeps references to the options. `tell` may be called from any thread. Throws as optimize() does.
  RobustSearch(const SceneFile& file, const OptimizeOptions& options, const RobustSearchOptions& devices,
               std::function<void(std::string_view what, double part)> tell);

  /// The setting of the first family: its scene is the given one with the spread that is used.
  [[nodiscard]] const SearchSetting& first() const { return settings_.front(); }
  [[nodiscard]] const MeasuredUnits& known() const { return *known_; }
  [[nodiscard]] bool spread_assumed() const { return spread_assumed_; }
  /// The parameters of all families, their names with raced_prefix.
  [[nodiscard]] FamilyColumns columns() const;
  /// The time of everything, and the closings of devices that were taken. It begins with the construction of the search.
  [[nodiscard]] SearchBudget& budget() { return budget_; }
  /// Adds the work of this search to the estimate `nominal` of the one on the nominal device.
  [[nodiscard]] SearchEstimate estimate(SearchEstimate nominal) const;

  /// Races, places what the race found, and measures the devices of the verdict. The families of the race stand behind `before`
  /// others that share the memory. After a first candidate was judged on the devices of the choice, `looked` is called once;
  /// never without a candidate. The part `reserved` of a budget of time is left for what follows beside the verdict [s]. Throws
  /// Interrupted when it is asked to stop.
  void run(std::size_t before, std::function<void()> looked, double reserved);
  /// Makes run() end soon, without a usable result; from any thread.
  void give_up() { budget_.give_up(); }

  /// How the switch can be carried to its contact; none if that is not searched.
  [[nodiscard]] const std::optional<StableApproach>& approach() const { return approach_; }
  /// The share of the devices of the spread with such a path.
  [[nodiscard]] double share_with_path() const { return share_with_path_; }

  // Results of run().
  /// The time until which waiting is free: as long as the devices of the race wait under the plain step.
  [[nodiscard]] const FreeTime& free() const { return free_; }
  /// The cost on the first of the raced devices.
  [[nodiscard]] const RobustCost& cost() const { return *cost_; }
  [[nodiscard]] const RaceAims& aims() const { return aims_; }
  [[nodiscard]] const std::vector<Condition>& conditions() const { return conditions_; }
  /// Judges a candidate on the devices of the choice.
  void place(ChosenFrom candidate);
  /// The leader at the last look of a search that was stopped; null if it is worse than the plain step.
  [[nodiscard]] const ChosenFrom* leader() const;
  /// The candidates that were judged on the way, on the devices of the choice.
  [[nodiscard]] std::vector<ChosenFrom> looked_at() const;
  [[nodiscard]] const std::vector<DeviceOutcome>& step_on_others() const { return step_on_others_; }
  /// The candidates that were placed: those that are good enough first, the best first.
  [[nodiscard]] std::vector<ChosenFrom> placed() const;
  [[nodiscard]] std::size_t good_enough() const;
  /// Searches with a per-device calibration, from a winner and from the nominal design's waveform: precisely measured devices
  /// need little else. No rows if nothing can be measured.
  [[nodiscard]] CalibratedSearch in_measured_units(const ChosenFrom& winner, const DriveWaveforms& drawing);
  /// Devices of the verdict as they are known, for closings over the window of a search.
  [[nodiscard]] RobustCost verdict_devices(const MeasuredUnits& known);
  /// The outcomes of all devices of a cost; they count as closings.
  [[nodiscard]] std::vector<DeviceOutcome> closed(const RobustCost& cost, const DriveWaveforms& waveforms);
  /// The searched drives of a candidate, and the others as in the plain step.
  [[nodiscard]] DriveWaveforms all_drives(DriveWaveforms searched) const;
  /// Fresh devices of the verdict: as many as requested, or fewer if closings are slow.
  [[nodiscard]] std::uint64_t verdict() const { return verdict_; }

 private:
  // Bounds of the choice on a candidate, beside its rank.
  struct Bounds {
    std::vector<double> figures;  // 95th percentiles of the plain step, of judged_figures
    double first_touch, open;     // likewise, and its share of open devices

    explicit Bounds(const std::vector<DeviceOutcome>& step);
    /// `in_time` is true if the candidate has to close in a usual time.
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
  std::size_t raced_ = 0;                  // number of raced settings; they come first
  std::vector<SearchSetting> usual_room_;  // settings within the usual limits; none if the scene's are no wider
  std::vector<std::string> names_;         // names of the families
  std::optional<StableApproach> approach_;
  double share_with_path_ = Metrics::unset;
  std::optional<MeasuredUnits> known_;
  std::optional<SearchBudget> before_verdict_;  // the part of the budget for everything before the verdict
  long race_length_ = race_closings;
  std::uint64_t verdict_ = RobustSearchOptions{}.verdict;
  std::vector<Condition> conditions_;  // conditions with limits of their own
  RobustAim tail_aim_;
  RaceAims aims_;
  std::vector<Condition> at_most_step_;      // conditions in volts
  std::optional<RobustCost> cost_, others_;  // costs on the devices of the race, and of the choice
  FreeTime free_;
  std::vector<Contender> paced_;
  RaceResult race_, race_in_usual_room_;
  std::optional<Bounds> bounds_;
  std::vector<DeviceOutcome> step_on_others_;  // closings under the plain step, until they are steady
  std::function<void()> looked_;
  std::vector<Placed> looked_at_;                                                 // candidates in the order of their judging
  std::optional<Placed> leader_;                                                  // the best of them
  std::vector<Placed> placed_;                                                    // candidates in the order of their placing
  std::optional<CalibratedEnsemble> calibrated_by_pull_in_, calibrated_by_time_;  // the measured devices of the verdict
  std::optional<PullInMeter> meter_;                                              // none if nothing can be measured
};

}  // namespace softland
