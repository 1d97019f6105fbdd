// The cost of a drive over varied devices: a measure of risk over the costs of their closings, and conditions on their figures.
//
//   s_k   cost of the closing of device k, every figure over that of the plain step on the nominal device:
//           bounce             (largest touch speed + highest rebound) / 2
//           rebound            highest rebound               impact    largest touch speed
//           count              rebounds                      settling  permanent contact, over first contact of the step
//           energy             impact energy                 steady    steady force time, over first contact of the step
//           own objective      its value
//         A device that fails costs 3, or more than any that closes. It fails if it does not close, if its hold levels do not
//         keep it closed, if its closing cannot be followed, or if no such device can be described.
//   cost  R(s) + (share of devices that fail) + 0.02 min(median of first contact over that of the step, max(0, tau - 1))
//         + 10 (sum over the conditions: violation, where positive)
//
// The waiting time of a user is tau: the 95th percentile of the time from which on the contact force is steady, over the free
// time. The free time is that of the plain step on the same devices. The step bounces for that long, so that a slower first
// touch costs the user nothing. If fewer than 95 % of the devices get a steady force under the step, their permanent contact
// takes its place, or their first contact if they do not settle. A device that is not steady at the end of its run counts with
// the end.
//
// R of mean+sigma is that of the devices that do not fail, plus 3 (1 + factor) times the root of the share of those that do.
// The deviation over all of them would fall again if most fail.
//
// R is the requested measure (sampling/risk.h). For a yield it is 1 less the share of devices that fulfil its condition, plus a
// tenth of the mean of s, which leads the search where the share does not change. A condition holds when 95 % of the devices
// fulfil it: its violation is the 95th percentile of that of the devices (config/condition.h).
//
// A closing is scored until 60 % of a period of the first mode, or two and a half in contact, after first touch, and one period
// in contact after the last breakpoint of its drives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "config/condition.h"
#include "studies/devices/ensemble.h"
#include "studies/devices/robustness.h"
#include "studies/search/search_setting.h"

namespace softland {

/// Gives conditions beside the plain step limits of their own: what 95 % of the devices stay below under it. Throws
/// InvalidInput if the step has no such figure.
[[nodiscard]] std::vector<Condition> beside_step(std::vector<Condition> conditions, std::span<const DeviceOutcome> of_step);

/// The share of devices that has to fulfil a condition.
inline constexpr double constrained_share = 0.95;

/// The time until which waiting for a contact is free.
struct FreeTime {
  double Metrics::*figure = &Metrics::initial_contact_time;  ///< the time that counts
  double until = 0;  ///< 95th percentile [s]; 0: the median of first contact is priced alone, infinite: nothing is
};
/// Returns the time that the devices wait under the plain step, whose outcomes are `of_step`. Throws nothing: the time is 0 if
/// 95 % of them never touch.
[[nodiscard]] FreeTime free_time(std::span<const DeviceOutcome> of_step);

struct RobustAim {
  RobustMeasure measure;
  std::vector<Condition> conditions;
  FreeTime free = {};
};

/// Devices and their exact measured values, by these gauges and their frequency.
struct CalibratedEnsemble {
  std::vector<SampledDevice> devices;
  std::vector<DeviceUnits> exact;  ///< exact units; 1 for a device that cannot be described
};
/// Builds and measures the devices. `precision` is that of pull-in voltages, relative. Throws Interrupted if `progress` asks to
/// stop.
[[nodiscard]] CalibratedEnsemble calibrate_all(const Ensemble& ensemble, const MeasuredQuantities& quantities, double precision,
                                               int jobs, const Progress& progress = {});
/// Precision of pull-in voltages for comparing devices: far finer than any instrument. With a film that gives way slowly, which
/// is followed for long just above its pull-in voltage, it takes a sixth of the time of dynamic_pull_in_precision.
inline constexpr double compared_precision = 1e-5;

/// Devices that are built and measured.
struct BuiltEnsemble {
  std::vector<SampledDevice> devices;
  std::vector<DeviceUnits> units;  ///< units of a device's own drive, over those of the nominal one
};
/// Returns the same devices as they are known, by a calibration that needs no other gauges. The errors are functions of `seed`
/// and the number of the device. A device that cannot be measured is refused.
[[nodiscard]] BuiltEnsemble known_as(CalibratedEnsemble calibrated, const MeasuredUnits& known, std::uint64_t seed);
/// Builds the devices with their units. Throws Interrupted if `progress` asks to stop.
[[nodiscard]] BuiltEnsemble build_all(const Ensemble& ensemble, const MeasuredUnits& known, std::uint64_t seed, int jobs,
                                      const Progress& progress = {});

/// Builds devices of this search alone, for ranking candidates: closings of an accuracy of 1e-4 at best. They depend on `seed`
/// and `which`. Throws Interrupted if `progress` asks to stop.
[[nodiscard]] BuiltEnsemble own_devices(const SearchSetting& setting, const MeasuredUnits& known, std::uint64_t count,
                                        std::uint64_t seed, std::uint64_t which, int jobs, const Progress& progress);

class RobustCost {
 public:
  /// Keeps references to `setting` and `aim`.
  RobustCost(const SearchSetting& setting, const RobustAim& aim, BuiltEnsemble ensemble, Vectors vectors = vectors_in_use());

  [[nodiscard]] std::size_t devices() const { return ensemble_.devices.size(); }
  /// Closes devices [first, last) under their own drives; `waveforms` are those of the nominal device, one per drive.
  [[nodiscard]] std::vector<DeviceOutcome> close(const std::vector<Waveform>& waveforms, std::size_t first, std::size_t last,
                                                 int jobs) const;
  [[nodiscard]] double value(std::span<const DeviceOutcome> outcomes) const { return value(outcomes, aim_); }
  /// The cost by another aim.
  [[nodiscard]] double value(std::span<const DeviceOutcome> outcomes, const RobustAim& aim) const;
  /// The measure alone: R(s).
  [[nodiscard]] double measured(std::span<const DeviceOutcome> outcomes, const RobustAim& aim) const;
  /// Closes all devices under the plain step until 95 % of them carry a steady force, or for the longest of such runs.
  [[nodiscard]] std::vector<DeviceOutcome> close_by_step(int jobs) const;
  /// Closes all devices, and follows them after first touch for the window of the scene or until `free` [s], whichever is
  /// longer.
  [[nodiscard]] std::vector<DeviceOutcome> close_until(const std::vector<Waveform>& waveforms, double free, int jobs) const;
  /// False if the measure cannot tell these devices from those that all fail: as many of them fail as it looks at, or none
  /// fulfils the condition of a yield.
  [[nodiscard]] bool is_told(std::span<const DeviceOutcome> outcomes) const;

  /// s_k of a device that does not close.
  static constexpr double not_closed = 3;
  [[nodiscard]] const SampledDevice& device(std::size_t k) const { return ensemble_.devices[k]; }
  /// Closes device k in these units instead of those it was built with.
  [[nodiscard]] DeviceOutcome close(const std::vector<Waveform>& waveforms, std::size_t k, const DeviceUnits& units) const;
  /// s_k; that of a device that does not close if its figure is not known.
  [[nodiscard]] double score(const DeviceOutcome& outcome) const;

 private:
  // State of a device under its hold levels.
  struct Kept {
    bool is_held = true;
    double steady_force = Metrics::unset;  // [N]
    double resistance = Metrics::unset;    // [Ohm]
  };
  void find_gains();
  [[nodiscard]] Kept kept(std::size_t k, const std::vector<Signal>& signals) const;
  [[nodiscard]] ClosingOptions run(const std::vector<Signal>& signals, double steady_force) const;
  [[nodiscard]] std::vector<double> scores(std::span<const DeviceOutcome> outcomes) const;
  [[nodiscard]] static double measured(std::span<const DeviceOutcome> outcomes, const std::vector<double>& scores,
                                       const RobustAim& aim);
  [[nodiscard]] static double risk_of(std::span<const DeviceOutcome> outcomes, const std::vector<double>& scores,
                                      const Risk& measure);

  [[nodiscard]] std::vector<Signal> signals(const std::vector<Waveform>& waveforms, std::size_t k,
                                            const DeviceUnits& units) const;
  [[nodiscard]] std::vector<DeviceOutcome> close(const std::vector<Waveform>& waveforms, std::size_t first, std::size_t last,
                                                 double after_contact, int jobs) const;

  const SearchSetting& setting_;
  const RobustAim& aim_;
  BuiltEnsemble ensemble_;
  DeviceDrives drives_;
  std::optional<std::vector<std::vector<double>>> gains_;  // gains of every device; none if drives differ by more
  std::vector<double> ungained_levels_;                    // hold levels of the plain step from sources with a gain of 1
  Vectors vectors_;
  DeviceOutcome step_;                               // outcome of the nominal device
  std::optional<ClosedEquilibrium> nominal_closed_;  // equilibrium under the hold levels; none if not kept closed
  std::vector<double> levels_;                       // hold levels of the nominal device
  std::vector<Kept> kept_;                           // each device, under the hold levels
  double window_, tail_, wait_;                      // times after first touch, after the last breakpoint, for a touch [s]
};

/// True if a device does not close and stay closed, cannot be followed, or cannot be described.
[[nodiscard]] bool fails(const DeviceOutcome& outcome);

/// Time from which on a device carries a steady contact, as FreeTime defines it [s]. It is the end of the run if the contact is
/// not steady by then, infinite if the device fails.
[[nodiscard]] double waited(const DeviceOutcome& outcome, double Metrics::*figure);
/// 95th percentile of that time.
[[nodiscard]] double waited(std::span<const DeviceOutcome> outcomes, double Metrics::*figure);

/// True if a device fulfils a condition.
[[nodiscard]] bool fulfils(const DeviceOutcome& outcome, const Condition& condition);
/// The share of devices that fulfils it.
[[nodiscard]] Yield share_that_fulfils(std::span<const DeviceOutcome> outcomes, const Condition& condition);
/// True if constrained_share of the devices fulfils each of the conditions.
[[nodiscard]] bool hold(std::span<const Condition> conditions, std::span<const DeviceOutcome> outcomes);

}  // namespace softland
