// Devices with process variation: the switches of a scene's [spread], each a function of its number.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/watch.h"
#include "model/closing.h"
#include "model/ensemble/fleet.h"
#include "model/pull_in.h"
#include "objectives/figures.h"
#include "objectives/metrics.h"
#include "sampling/classes.h"
#include "sampling/points.h"
#include "sampling/sobol_indices.h"
#include "studies/closing/open_command.h"
#include "studies/closing/prepared.h"
#include "studies/devices/device_drives.h"

namespace softland {

/// One device of an ensemble.
struct SampledDevice {
  std::vector<double> values;   ///< values of the varied quantities, in the order of the spread, as DeviceSpread::to_values
  std::optional<Switch> model;  ///< none if such a device cannot be described
  std::string refusal;          ///< the reason
};

class Ensemble {
 public:
  /// Makes devices 0 to size - 1 of this scene, which keep the volts of the waveforms of the nominal device. Keeps a reference
  /// to `nominal`. Throws InvalidInput if the scene has no [spread], and what SamplePoints throws.
  Ensemble(const PreparedScene& nominal, std::uint64_t size, std::uint64_t seed = 1, PointSet points = PointSet::sobol);
  /// Makes the devices at the points of a design for Sobol' indices.
  Ensemble(const PreparedScene& nominal, const SobolDesign& design);

  [[nodiscard]] const PreparedScene& nominal() const { return *nominal_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Point of device k in the open unit cube: a coordinate for each varied quantity, before any correlation.
  [[nodiscard]] std::vector<double> point(std::uint64_t k) const;
  /// Values of the varied quantities of device k.
  [[nodiscard]] std::vector<double> values(std::uint64_t k) const;
  /// True if a varied key may change other members of a scene, so that each is read anew.
  [[nodiscard]] bool reads_anew() const { return reads_anew_; }
  /// The scene of that device alone, in volts and without [spread], which `simulate` runs to the same figures. They differ
  /// within the tolerance if ensembles are closed in lanes (model/ensemble/fleet.h).
  [[nodiscard]] SceneFile scene(const std::vector<double>& values) const;

 private:
  Ensemble(const PreparedScene& nominal, std::uint64_t size, std::function<void(std::uint64_t, std::span<double>)> point);

  const PreparedScene* nominal_;
  std::uint64_t size_;
  std::function<void(std::uint64_t, std::span<double>)> point_;
  SceneFile resolved_;       // scene of the nominal device
  bool reads_anew_ = false;  // true if a varied key may change other members
};

/// Builds devices one after the other. Each thread has a builder of its own; a device does not depend on those built before it.
class DeviceBuilder {
 public:
  /// Keeps a reference to `ensemble`.
  explicit DeviceBuilder(const Ensemble& ensemble) : ensemble_(&ensemble), scratch_(ensemble.nominal().scene) {}
  [[nodiscard]] SampledDevice device(std::uint64_t k) { return device(ensemble_->values(k)); }
  /// The device with these values of the varied quantities.
  [[nodiscard]] SampledDevice device(std::vector<double> values);

 private:
  void describe(SampledDevice& device);

  const Ensemble* ensemble_;
  Scene scratch_;  // its varied numbers are those of the last device
};

/// The result of the closing of one device.
struct DeviceOutcome {
  Metrics metrics;
  std::string failure = {};  ///< reason for missing figures: refused as a device, or not to be simulated
  /// False if the hold levels do not keep the device closed, as far as that was tested: by DeviceCloser for settled devices, by
  /// RobustCost for every device.
  bool is_held = true;

  /// True if it closed and its closing could be followed to the end of the window.
  [[nodiscard]] bool closed() const { return failure.empty() && std::isfinite(metrics.major_bounce_height); }
  /// Value for a distribution in which larger is worse: a device that does not close has Figure::worst.
  [[nodiscard]] double of(const Figure& figure) const;
};

/// Time of the first touch under a step of one drive from 0 V, with the others at a bias; NaN if it does not touch in
/// `duration` [s].
[[nodiscard]] double closing_time(const Switch& model, std::size_t drive, double step, Bias bias, double duration);
/// Periods of the first mode in which a step closes a switch, or does not.
inline constexpr double periods_to_close = 20;

/// Measurements on devices beside their frequency and, if they have one, the effect of their piezo.
struct Gauges {
  bool pull_in = false, closing_time = false, piezo = false;
  [[nodiscard]] static Gauges of(const Calibration& calibration) {
    return {calibration.pull_in_error.has_value(), calibration.time_error.has_value(), calibration.piezo_error.has_value()};
  }
  /// Gauges of both.
  friend Gauges operator|(const Gauges& a, const Gauges& b) {
    return {a.pull_in || b.pull_in, a.closing_time || b.closing_time, a.piezo || b.piezo};
  }
};

/// Reason for missing units of a device.
inline constexpr const char* not_measured = "its pull-in voltage, or what its piezo does, cannot be measured";

/// Measures devices against the nominal one, with the errors of a calibration. A closing time gives the volts of a device: the
/// nominal device closes under a step to closing_step Vdp / s in the time that the device takes under closing_step Vdp. s is
/// the factor of its volts.
class DeviceMeter {
 public:
  /// Keeps a reference to `nominal`, whose closing electrode it measures. Throws InvalidInput if a gauge needs an electrode or
  /// a pull-in voltage that is missing. Throws it also for a requested piezo that the switch lacks, or that does not move its
  /// contact point. The relative `precision` is that of pull-in voltages; that of the nominal device is found to
  /// dynamic_pull_in_precision at least.
  DeviceMeter(const PreparedScene& nominal, const Gauges& gauges, double precision = dynamic_pull_in_precision);
  /// Pull-in voltage [V] and frequency [Hz] of the nominal device.
  [[nodiscard]] double pull_in() const { return pull_in_; }
  [[nodiscard]] double frequency() const;
  /// The unit of a switch's piezo: displacement of the contact point per volt, over the contact gap; 0 without a piezo [1/V].
  [[nodiscard]] static double piezo_unit(const Switch& model);
  /// The number of the electrode among the drives.
  [[nodiscard]] std::size_t electrode() const { return electrode_; }
  /// Closing time under the step of the measurement; NaN if it is not measured [s].
  [[nodiscard]] double closing_time() const;
  /// The volts of a device that closes in this time [s], in units of the nominal one; NaN if it does not close.
  [[nodiscard]] DeviceUnits told_by(double time) const;
  /// The exact units. A device whose pull-in voltage cannot be found, or that does not close, has NaN volts.
  [[nodiscard]] DeviceUnits exact(const Switch& model) const;
  /// The measured units of device k, whatever its class; the errors are functions of seed and k.
  [[nodiscard]] static DeviceUnits measured(const DeviceUnits& exact, const Calibration& calibration, std::uint64_t seed,
                                            std::uint64_t k);

 private:
  [[nodiscard]] double pull_in(const Switch& model, double precision) const;  // [V]
  void learn_times();
  [[nodiscard]] double time_of(const Switch& model, double step) const;

  struct ToldVolts {
    double time, volts;  // [s], over those of the nominal device
  };

  const PreparedScene* nominal_;
  Gauges gauges_;
  double precision_;
  std::vector<ToldVolts> told_ = {};  // sorted by time
  std::size_t electrode_ = 0;
  double pull_in_ = Metrics::unset;
};

/// Units of devices that a calibration knows: the measured ones or, with classes by measurements, those of the centre of the
/// class.
class KnownUnits {
 public:
  /// Makes the classes of `reference`, devices without error that represent the spread: known_units() has them. Throws
  /// InvalidInput if it needs them and none can be measured.
  KnownUnits(const Calibration& calibration = {}, std::span<const DeviceUnits> reference = {});
  [[nodiscard]] const Calibration& calibration() const { return calibration_; }
  /// The same with exact measurements, in the same classes.
  [[nodiscard]] KnownUnits without_errors() const;
  /// Units of device k, whose exact ones are `exact`; the errors are functions of seed and k.
  [[nodiscard]] DeviceUnits of(const DeviceUnits& exact, std::uint64_t seed, std::uint64_t k) const;
  /// Units of a measured device.
  [[nodiscard]] DeviceUnits of(const DeviceUnits& measured) const;

  struct Class {
    DeviceUnits centre;
    double share = 0;  ///< share of the devices of the spread
  };
  /// Classes by the voltage of their centre; none if every device has its own units.
  [[nodiscard]] std::vector<Class> classes() const;

 private:
  Calibration calibration_;
  Classes classes_;  // classes of the logarithms of volts, time and the piezo's volts
};
/// Returns the units for each of these calibrations. The classes are made of devices that depend on the spread alone: a device
/// belongs to the same class in every study. Throws Interrupted if `watch` asks to stop.
[[nodiscard]] std::vector<KnownUnits> known_units(const PreparedScene& nominal, std::span<const Calibration> calibrations,
                                                  int jobs, const Watch& watch = {});

/// Standard deviations of the devices of the spread from the nominal one, in volts, in time and in a piezo's volts, relative.
/// Throws Interrupted if `watch` asks to stop.
[[nodiscard]] DeviceUnits deviation_of_units(const PreparedScene& nominal, bool need_pull_in, int jobs, const Watch& watch = {});

/// The drives of every device: the waveforms of the nominal device, or, with a per-device calibration, the same in the units of
/// each device; with the errors of its sources if these vary.
struct EnsembleDrive {
  std::vector<Waveform> waveforms;  ///< waveforms in the order of Switch::drives() [V]
  KnownUnits known = {};
};

struct EnsembleRun {
  double duration = 0;      ///< window [s]
  double tolerance = 1e-5;  ///< tolerance of the integrator: moves 95th percentiles of B_H by less than 0.4 %
  std::uint64_t seed = 1;   ///< seed of the errors of measurements
  int jobs = 1;             ///< threads; does not change the outcomes
  Vectors vectors = vectors_in_use();
  bool measures_drive_energy = false;
  /// True if drives may command the devices to open (open_command.h): closings end there.
  bool opens_on_command = false;
};

/// Closes one device; figures are those of the run, however early its options end it.
[[nodiscard]] DeviceOutcome close_device(const SampledDevice& device, const std::vector<Signal>& signals,
                                         const MetricsOptions& options, const ClosingOptions& run);

struct DeviceClosing {
  const SampledDevice* device = nullptr;
  const std::vector<Signal>* signals = nullptr;
  std::vector<double> gains = {};  ///< gains of these signals; none: 1
  ClosingOptions run;
  bool measures_drive_energy = false;  ///< measures it in lanes, too; single closings always do
};
/// Closes several devices, in lanes if their laws are written for that (model/ensemble/fleet.h), the others one by one. All
/// have the tolerance of the first. An outcome does not depend on the other devices.
[[nodiscard]] std::vector<DeviceOutcome> close_devices(std::span<const DeviceClosing> closings, const MetricsOptions& options,
                                                       Vectors vectors);

/// A device and its drives.
struct DrivenDevice {
  const SampledDevice* device = nullptr;
  const std::vector<Signal>* signals = nullptr;  ///< signals, one per drive
  double duration = 0;                           ///< window [s]
};
/// Closes devices, in lanes as close_devices(), to outcomes that tell whether they are held closed. Each device has a window
/// and a steady force of its own; `run` has the other options. The closed equilibrium `near` is that of a switch and drives
/// that differ little from these.
[[nodiscard]] std::vector<DeviceOutcome> close_driven(std::span<const DrivenDevice> devices, const MetricsOptions& options,
                                                      const ClosingOptions& run, const std::optional<ClosedEquilibrium>& near,
                                                      bool measures_drive_energy, Vectors vectors);

/// Closes devices under drives, in the units of each device if they are calibrated.
class DeviceCloser {
 public:
  /// Keeps references to `nominal` and `drives`. Throws what DeviceMeter throws.
  DeviceCloser(const PreparedScene& nominal, const std::vector<EnsembleDrive>& drives, const EnsembleRun& run,
               const std::atomic<bool>* stop = nullptr);
  /// The outcomes of devices `first`, first + 1, ..., by drive; after a stop, those that were not begun are unset.
  [[nodiscard]] std::vector<std::vector<DeviceOutcome>> operator()(std::span<const SampledDevice> devices,
                                                                   std::uint64_t first) const;

 private:
  const PreparedScene* nominal_;
  const std::vector<EnsembleDrive>* drives_;
  ClosingOptions options_;
  std::uint64_t seed_;
  Vectors vectors_;
  bool measures_drive_energy_;
  DeviceDrives device_drives_;
  std::optional<DeviceMeter> meter_;
  std::vector<std::vector<Signal>> nominal_signals_;              // signals of every drive
  std::vector<std::optional<OpenCommand>> nominal_commands_;      // one per drive that may have one
  std::vector<std::optional<ClosedEquilibrium>> nominal_closed_;  // equilibrium under its hold levels
};

/// Closes all devices under each of these drives, and returns the outcomes of a drive, by device. After a stop, they are those
/// of the first devices.
[[nodiscard]] std::vector<std::vector<DeviceOutcome>> close_all(const Ensemble& ensemble,
                                                                const std::vector<EnsembleDrive>& drives, const EnsembleRun& run,
                                                                const Watch& watch = {});

}  // namespace softland
