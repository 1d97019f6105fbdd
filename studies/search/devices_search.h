// What is searched over devices: a race of families by two measures (race.h), a choice among candidates on devices that it has
// not seen, and searches in units that are measured on every device. The race does not need the drawing's waveform.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
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

namespace softland {

/// What leads a search over devices that goes on, on the devices of the choice.
struct Leading {
  std::string family;
  std::vector<DeviceOutcome> of_step, own;  ///< the same devices under the plain step, and under what leads
  double Metrics::*waited_for = nullptr;    ///< what FreeTime counts
  SceneFile scene;                          ///< under its waveform
};

struct ForDevicesOptions {
  std::vector<Criterion> conditions = {};  ///< on figures of device_figures, that 95 % of the devices have to fulfil
  std::uint64_t verdict = 2000;            ///< fresh devices
  bool verdict_is_asked = false;           ///< else slow closings have fewer, as counts_work has it
  /// Families of the race; empty: raced_families, as far as the scene has room for them, and the quasi-static approach.
  std::string families = {};
  bool hold_step_is_chosen = true;  ///< with the actuator pzt the electrode's plain step may come later than t = 0
  bool is_of_before = false;        ///< as versions did that priced the first touch and knew of no quasi-static approach
  long closings = race_closings;    ///< of the race
  bool are_a_budget = false;        ///< it takes no more of them where many devices land
  bool counts_work = false;         ///< they are usual closings: where closings take more work there are fewer (search_work.h)
  /// Told of what leads, whenever that is better than what was told before; from any thread, one call at a time.
  std::function<void(const Leading&)> on_leading = {};
};

/// A row of the first table: drives of one kind on the fresh devices.
struct DevicesRow {
  std::string name;             ///< "plain step", "for the drawing", "for the devices", "Vdp to 1 %"
  Calibration knowledge = {};   ///< what is measured on every device
  bool searched_for_it = true;  ///< else the waveform was made for another knowledge
  bool judged_whole = true;     ///< over the whole window of a closing, else over that of a search
  DriveRobustness judged = {};
};

/// More devices that land, where half of them do in either; else the softer impacts.
[[nodiscard]] bool lands_better(const DevicesRow& a, const DevicesRow& b);

/// A candidate of the choice, with its waveforms.
struct ChosenFrom {
  std::string measure, family;  ///< see RaceEntry
  DriveWaveforms waveforms;
  std::map<std::string, double> parameters;  ///< by drive.name; empty for what the nominal search tried
  std::vector<Variable> variables;
  long closings = 0;
  // On the devices of the choice:
  double bounce_free = 0, tail = 0;                                    ///< share of the devices; cost
  double measured = 0;                                                 ///< the measure alone, without any price of time
  double first_touch = Metrics::unset, impact_speed = Metrics::unset;  ///< 95 % quantiles [s], [m/s]
  double median_touch = Metrics::unset;                                ///< [s]
  double waited = Metrics::unset;                                      ///< 95 % quantile of what DevicesSearch::free() counts [s]
  bool is_good_enough = false;                                         ///< as the choice asks
  bool is_in_usual_room = false;                                       ///< the race within usual limits found it
};

/// The share of devices of which most land, which decides where it is as much.
inline constexpr double lands_half = 0.5;

/// A quantile of a figure of device_figures, and the 95 % one.
[[nodiscard]] double quantile(const std::vector<DeviceOutcome>& outcomes, std::string_view key, double probability);
[[nodiscard]] double quantile_95(const std::vector<DeviceOutcome>& outcomes, std::string_view key);
[[nodiscard]] double share_of(const std::vector<DeviceOutcome>& outcomes, bool (*holds)(const DeviceOutcome&));

/// What is reached with measured devices.
struct InMeasuredUnits {
  double pull_in = Metrics::unset;       ///< Vdp of the nominal device, where its devices can be measured [V]
  double closing_time = Metrics::unset;  ///< of the nominal device, under the step that is measured [s]
  std::vector<DevicesRow> rows = {};
  std::vector<KnownVdp> by_error = {};
  std::size_t best = 0;                ///< of the rows
  DriveWaveforms best_waveforms = {};  ///< of the searched drives, in these units
};

/// What names of parameters of the race begin with, among those of all searches.
inline constexpr std::string_view raced_prefix = "devices.";

class DevicesSearch {
 public:
  /// Keeps references to the options. `tell` may be called from any thread. Throws as optimize() does.
  DevicesSearch(const SceneFile& file, const OptimizeOptions& options, const ForDevicesOptions& devices,
                std::function<void(std::string_view what, double part)> tell);

  /// The setting of the first family: its scene is the given one with the spread that is looked at.
  [[nodiscard]] const SearchSetting& first() const { return settings_.front(); }
  [[nodiscard]] const KnownUnits& known() const { return *known_; }
  [[nodiscard]] bool spread_assumed() const { return spread_assumed_; }
  /// The parameters of all families, their names with raced_prefix.
  [[nodiscard]] FamilyColumns columns() const;
  /// Since it was made.
  [[nodiscard]] double seconds() const;
  /// What the search is going to take, besides what `nominal` tells of the one on the nominal device.
  [[nodiscard]] SearchEstimate estimate(SearchEstimate nominal) const;

  /// Races, places what the race came to, and measures the devices of the verdict. `before`: families in front of those of the
  /// race, among those that share the memory. `looked` is called once a first candidate was looked at on the devices of the
  /// choice; where none is, never. `reserved`: of a budget of time, for what follows beside the verdict [s]. Throws Interrupted
  /// where it is told to stop.
  void run(std::size_t before, std::function<void()> looked, double reserved);
  /// From any thread: run() ends soon, with nothing that is of use.
  void give_up() { gave_up_ = true; }

  /// How the switch can be carried to its contact, where that is searched; none elsewhere.
  [[nodiscard]] const std::optional<StableApproach>& approach() const { return approach_; }
  /// The share of the devices of the spread that can be.
  [[nodiscard]] double share_with_path() const { return share_with_path_; }

  // After run().
  /// Until when waiting is free: as long as the devices of the race wait under the plain step.
  [[nodiscard]] const FreeTime& free() const { return free_; }
  /// On the first of the raced devices.
  [[nodiscard]] const RobustCost& cost() const { return *cost_; }
  [[nodiscard]] const RaceAims& aims() const { return aims_; }
  [[nodiscard]] const std::vector<Criterion>& conditions() const { return conditions_; }
  /// Judges a candidate on the devices of the choice.
  void place(ChosenFrom candidate);
  /// What led when a search that was stopped had looked last; null where it is worse than the plain step.
  [[nodiscard]] const ChosenFrom* leader() const;
  /// What was looked at on the way, on the devices of the choice.
  [[nodiscard]] std::vector<ChosenFrom> looked_at() const;
  [[nodiscard]] const std::vector<DeviceOutcome>& step_on_others() const { return step_on_others_; }
  /// Those that were placed: first, the best first, those that are good enough.
  [[nodiscard]] std::vector<ChosenFrom> placed() const;
  [[nodiscard]] std::size_t good_enough() const;
  /// Searches in measured units from a winner, and from what lands the drawing: precisely measured devices need little else. No
  /// rows where there is nothing to measure.
  [[nodiscard]] InMeasuredUnits in_measured_units(const ChosenFrom& winner, const DriveWaveforms& drawing);
  /// Devices of the verdict as they are known, for closings over the window of a search.
  [[nodiscard]] RobustCost verdict_devices(const KnownUnits& known);
  /// The outcomes of all devices of a cost; they count as closings.
  [[nodiscard]] std::vector<DeviceOutcome> closed(const RobustCost& cost, const DriveWaveforms& waveforms);
  /// The searched drives of a candidate, and the others as in the plain step.
  [[nodiscard]] DriveWaveforms all_drives(DriveWaveforms searched) const;
  [[nodiscard]] long closings() const { return closings_; }
  /// Fresh devices of the verdict: as many as were asked for, or fewer where closings are slow.
  [[nodiscard]] std::uint64_t verdict() const { return verdict_; }

 private:
  // What the choice asks of a candidate beside its rank.
  struct Bounds {
    std::vector<double> figures;  // 95 % quantiles of the plain step, of judged_figures
    double first_touch, open;     // likewise, and its share of devices that do not close

    explicit Bounds(const std::vector<DeviceOutcome>& step);
    /// `in_time`: whether it has to close in a usual time.
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
  void look(const Racer& racer);
  [[nodiscard]] std::vector<DeviceOutcome> on_others(const DriveWaveforms& waveforms);
  [[nodiscard]] Placed judged(ChosenFrom one, const std::vector<DeviceOutcome>& outcomes) const;
  [[nodiscard]] ChosenFrom candidate_of(const Racer& racer) const;
  void measure_ahead();
  [[nodiscard]] bool tells_time() const;
  [[nodiscard]] std::array<Found, 2> searched_in(const ChosenFrom& winner, const DriveWaveforms& drawing,
                                                 const std::array<Calibration, 2>& calibrations);
  [[nodiscard]] RaceResult searched_at_pace(const RobustCost& cost, const RaceAims& aims, std::size_t family, RaceOptions options,
                                            long& closings) const;
  [[nodiscard]] bool is_harder_than_step(const RobustCost& cost, const DriveWaveforms& waveforms) const;
  [[nodiscard]] RaceAims no_harder() const;
  [[nodiscard]] DevicesRow row_of(const char* name, const DriveWaveforms& waveforms, const Calibration& knowledge,
                                  bool searched_for_it);
  [[nodiscard]] std::vector<KnownVdp> judged_by_error(const std::vector<DriveWaveforms>& waveforms,
                                                      const DriveWaveforms& in_volts);
  [[nodiscard]] const GaugedEnsemble& gauged(const Calibration& knowledge);

  const OptimizeOptions& options_;
  const ForDevicesOptions& devices_;
  Watch watch_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  bool spread_assumed_ = false;
  std::vector<SearchSetting> settings_;
  std::size_t raced_ = 0;                  // number of settings whose families are raced; they come first
  std::vector<SearchSetting> usual_room_;  // those within the usual limits; none where the scene's are no wider
  std::vector<std::string> names_;         // of the families
  std::optional<StableApproach> approach_;
  double share_with_path_ = Metrics::unset;
  std::optional<KnownUnits> known_;
  std::atomic<bool> gave_up_ = false;
  double race_end_ = 0;  // since the beginning [s]
  long race_length_ = race_closings;
  std::uint64_t verdict_ = ForDevicesOptions{}.verdict;
  std::vector<Criterion> conditions_;  // with limits of their own
  RobustAim tail_aim_;
  RaceAims aims_;
  std::vector<Criterion> no_harder_than_step_;  // in volts
  std::optional<RobustCost> cost_, others_;     // of the race, and of the choice
  FreeTime free_;
  std::vector<Racer> paced_;
  RaceResult race_, race_in_usual_room_;
  std::optional<Bounds> bounds_;
  std::vector<DeviceOutcome> step_on_others_;  // closings under the plain step, until they are steady
  std::function<void()> looked_;
  std::vector<Placed> looked_at_;                                     // in the order in which they came
  std::optional<Placed> leader_;                                      // of these
  std::vector<Placed> placed_;                                        // in the order in which they came
  std::optional<GaugedEnsemble> gauged_by_pull_in_, gauged_by_time_;  // the devices of the verdict
  std::optional<DeviceMeter> meter_;                                  // none where there is nothing to measure
  long closings_ = 0;
};

}  // namespace softland
