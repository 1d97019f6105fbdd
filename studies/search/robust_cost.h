// The cost of drive waveforms over varied devices: a measure of risk over the costs of their closings, and conditions on their
// figures.
//
//   s_k   cost of the closing of device k, every figure relative to the plain step on the nominal device:
//           bounce             (largest impact velocity + highest rebound) / 2
//           rebound            highest rebound               impact    largest impact velocity
//           count              rebounds                      settling  permanent contact, over first contact of the step
//           energy             impact energy                 steady    steady force time, over first contact of the step
//           own objective      its value
//         A device that fails costs 3, or more than any that closes. It fails if it does not close, if its hold levels do not
//         keep it closed, if its closing cannot be simulated, or if its parameters describe no valid device.
//   cost  R(s) + (share of devices that fail) + 0.02 min(median of first contact over that of the step, max(0, tau - 1))
//         + 10 (sum over the conditions: violation, where positive)
//
// tau is the waiting time of a user: the 95th percentile of the time from which on the contact force is steady, over the free
// time. The free time is the same percentile under the plain step. The plain step bounces for that long, so that a slower first
// contact costs the user nothing. If fewer than 95 % of the devices get a steady force under the step, the time of permanent
// contact is used instead, or of first contact if they do not settle. For a device whose force is not steady when its
// simulation ends, the end of the simulation is the time.
//
// R of mean+sigma is computed over the devices that do not fail, plus 3 (1 + factor) times the root of the share of failing
// devices. The standard deviation over all devices would decrease again if most devices fail.
//
// R is the requested measure (sampling/risk.h). For a yield, R is 1 less the share of devices that fulfil the yield's
// condition, plus a tenth of the mean of s, which guides the search where the share does not change. A condition holds when
// 95 % of the devices fulfil it: its violation is the 95th percentile of the devices' violations (config/condition.h).
//
// A closing is scored until 0.6 periods of the first mode, or 2.5 periods in contact, after first contact, and at least until
// one period in contact after the last breakpoint of its drives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "config/condition.h"
#include "studies/devices/ensemble.h"
#include "studies/devices/robustness.h"
#include "studies/search/search_setting.h"

namespace softland {

/// Replaces each limit that is relative to the plain step by a number: the 95th percentile of the figure over the outcomes
/// `of_step` under the plain step. Throws InvalidInput if this percentile does not exist.
[[nodiscard]] std::vector<Condition> beside_step(std::vector<Condition> conditions, std::span<const DeviceOutcome> of_step);

/// The share of devices that have to fulfil a condition of the search.
inline constexpr double constrained_share = 0.95;

/// The part of a device's time until contact that adds nothing to the cost: users wait as long under the plain step, which
/// bounces.
struct FreeTime {
  /// Member of Metrics that is the time until contact: of first contact, of permanent contact (settling), or of a steady force.
  double Metrics::*figure = &Metrics::initial_contact_time;
  /// 95th percentile of the time `figure` under the plain step [s]. 0: only the median of first contact adds to the cost;
  /// infinite: no time adds to the cost.
  double until = 0;
};
/// Returns how long devices may take until contact at no cost: the 95th percentile under the plain step, from the outcomes
/// `of_step` of devices; 0 if fewer than 95 % of them make contact. Throws no exception.
[[nodiscard]] FreeTime free_time(std::span<const DeviceOutcome> of_step);

struct RobustAim {
  RobustMeasure measure;
  std::vector<Condition> conditions;
  FreeTime free = {};
};

/// Devices, and the scale factors of their waveforms that a per-device calibration without measurement errors would give.
struct CalibratedEnsemble {
  std::vector<SampledDevice> devices;
  /// Scale factors of the devices' waveforms without measurement errors; 1 for an invalid device.
  std::vector<DeviceUnits> exact;
};
/// Builds the devices, and computes the quantities that a calibration measures, without measurement errors. The relative error
/// of pull-in voltages is `precision`. Throws Interrupted if `progress` asks to stop.
[[nodiscard]] CalibratedEnsemble calibrate_all(const Ensemble& ensemble, const MeasuredQuantities& quantities, double precision,
                                               int jobs, const Progress& progress = {});
/// Relative precision of computed pull-in voltages that scale the waveforms of devices, far finer than any instrument. If the
/// gas film is slow, motion just above pull-in takes long; computing pull-in voltages to this precision takes a sixth of the
/// time for dynamic_pull_in_precision.
inline constexpr double compared_precision = 1e-5;

/// Devices, with the factors by which a per-device calibration scales their waveforms.
struct BuiltEnsemble {
  std::vector<SampledDevice> devices;
  /// Measured factors by which each device's waveforms are scaled, relative to those of the nominal device.
  std::vector<DeviceUnits> units;
};
/// Returns the devices with the scale factors that the calibration `known` measures. These are the factors of `calibrated` with
/// random errors, which depend only on `seed` and the number of the device. `calibrated` must contain the quantities of
/// `known`. A device that cannot be measured is marked as refused.
[[nodiscard]] BuiltEnsemble known_as(CalibratedEnsemble calibrated, const MeasuredUnits& known, std::uint64_t seed);
/// Builds the devices, with their measured factors as by known_as(). Throws Interrupted if `progress` asks to stop.
[[nodiscard]] BuiltEnsemble build_all(const Ensemble& ensemble, const MeasuredUnits& known, std::uint64_t seed, int jobs,
                                      const Progress& progress = {});

/// Builds devices for ranking candidate waveforms, with a quadrature no finer than ranking needs. The random devices depend on
/// `seed` and on the number `which` of the sample. Throws Interrupted if `progress` asks to stop.
[[nodiscard]] BuiltEnsemble own_devices(const SearchSetting& setting, const MeasuredUnits& known, std::uint64_t count,
                                        std::uint64_t seed, std::uint64_t which, int jobs, const Progress& progress);

class RobustCost {
 public:
  /// Keeps references to `setting` and `aim` (measure of risk and conditions).
  RobustCost(const SearchSetting& setting, const RobustAim& aim, BuiltEnsemble ensemble, Vectors vectors = vectors_in_use());

  [[nodiscard]] std::size_t devices() const { return ensemble_.devices.size(); }
  /// Simulates the closings of the devices `first` to `last` - 1; `waveforms` are those of the nominal device, one per drive,
  /// before calibration.
  [[nodiscard]] std::vector<DeviceOutcome> close(const std::vector<Waveform>& waveforms, std::size_t first, std::size_t last,
                                                 int jobs) const;
  [[nodiscard]] double value(std::span<const DeviceOutcome> outcomes) const { return value(outcomes, aim_); }
  /// Returns the cost of the outcomes by another aim (measure of risk and conditions) than that of the constructor.
  [[nodiscard]] double value(std::span<const DeviceOutcome> outcomes, const RobustAim& aim) const;
  /// Returns the measure of risk R(s) alone, without the terms of the cost for failing devices, time and conditions.
  [[nodiscard]] double measured(std::span<const DeviceOutcome> outcomes, const RobustAim& aim) const;
  /// Simulates all devices under the plain step until 95 % of them carry a steady contact force. Repeats this with longer
  /// simulations, up to eight times the duration of the first.
  [[nodiscard]] std::vector<DeviceOutcome> close_by_step(int jobs) const;
  /// Simulates all devices. After first contact the simulation lasts for the scene's simulated time or for `free` [s],
  /// whichever is longer.
  [[nodiscard]] std::vector<DeviceOutcome> close_until(const std::vector<Waveform>& waveforms, double free, int jobs) const;
  /// Returns false if the measure of risk says nothing about the waveform: its tail consists of failing devices alone, or no
  /// device fulfils the condition of a yield.
  [[nodiscard]] bool is_told(std::span<const DeviceOutcome> outcomes) const;

  /// Cost s_k of a device that does not close.
  static constexpr double not_closed = 3;
  [[nodiscard]] const SampledDevice& device(std::size_t k) const { return ensemble_.devices[k]; }
  /// Simulates the closing of device k with its waveforms scaled by the factors `units`.
  [[nodiscard]] DeviceOutcome close(const std::vector<Waveform>& waveforms, std::size_t k, const DeviceUnits& units) const;
  /// Returns the cost s_k of a device; not_closed if the figure of merit that the cost rates is not known.
  [[nodiscard]] double score(const DeviceOutcome& outcome) const;

 private:
  // The closed state of a device under its hold levels.
  struct Kept {
    bool is_held = true;
    double steady_force = Metrics::unset;  // contact force from which on the contact counts as steady [N]
    double resistance = Metrics::unset;    // contact resistance of the closed device at rest [Ohm]
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
  std::optional<std::vector<std::vector<double>>>
      gains_;  // gains of every device's voltage sources; empty if the drive signals of devices differ by more than gains
  std::vector<double> ungained_levels_;  // hold levels of the plain step at gain 1 [V]
  Vectors vectors_;
  DeviceOutcome step_;  // outcome of the nominal device under the plain step
  // Closed equilibrium of the nominal device under the hold levels; none if these do not keep the device closed.
  std::optional<ClosedEquilibrium> nominal_closed_;
  std::vector<double> levels_;  // hold levels of the plain step on the nominal device [V]
  std::vector<Kept> kept_;      // closed state of each device under the hold levels of the plain step
  // Simulated time after first contact (window_), least time in contact (tail_) and longest wait for first contact (wait_),
  // both after the last breakpoint [s].
  double window_, tail_, wait_;
};

/// True if the device does not close, opens again under its hold levels, cannot be simulated, or has invalid parameters.
[[nodiscard]] bool fails(const DeviceOutcome& outcome);

/// Returns the time until contact of a device, by the member `figure` of Metrics [s]. If the device does not reach that
/// contact, this is the end of the simulation; infinite if the device fails.
[[nodiscard]] double waited(const DeviceOutcome& outcome, double Metrics::*figure);
/// Returns the 95th percentile over the devices of the time until contact, by the member `figure` of Metrics [s].
[[nodiscard]] double waited(std::span<const DeviceOutcome> outcomes, double Metrics::*figure);

[[nodiscard]] bool fulfils(const DeviceOutcome& outcome, const Condition& condition);
/// Returns the share of devices that fulfil the condition.
[[nodiscard]] Yield share_that_fulfils(std::span<const DeviceOutcome> outcomes, const Condition& condition);
/// True if constrained_share of the devices fulfils each of the conditions.
[[nodiscard]] bool hold(std::span<const Condition> conditions, std::span<const DeviceOutcome> outcomes);

// Compares drive waveforms with the plain step on varied devices.
//
// The compared figures are the largest impact velocity, the highest rebound and the peak force. The waveform is worse in a figure
// if the 95th percentile is above that under the step on the same devices, and the 95 % interval of the difference, by a
// bootstrap over devices, does not contain 0. Rebounds that are not significant are equal. A device that does not close has the
// worst value of every figure.

/// Keys of the compared figures, which are among device_figures.
inline constexpr std::array judged_figures{key_of(&Metrics::largest_impact_velocity), key_of(&Metrics::major_bounce_height),
                                           key_of(&Metrics::peak_contact_force)};

/// Returns the keys of the figures in which the waveform of `drive` is worse. Both lists of outcomes have the same devices, up
/// to the end of the shorter list; rebounds below the height `significant` are equal [m].
[[nodiscard]] std::vector<std::string_view> worse_in(const std::vector<DeviceOutcome>& drive,
                                                     const std::vector<DeviceOutcome>& step, double significant,
                                                     std::uint64_t seed);

/// Returns a condition for each of judged_figures: at most its 95th percentile over the outcomes of the plain step; for the
/// rebound, at most `significant` [m] if that is larger. A figure without a finite percentile has no condition.
[[nodiscard]] std::vector<Condition> at_most_step(const std::vector<DeviceOutcome>& step, double significant);

}  // namespace softland
