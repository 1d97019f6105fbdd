// An ensemble of devices with process variation: the switches of a scene's [spread]. Each switch depends only on its number.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "model/closing.h"
#include "model/ensemble/ensemble_closings.h"
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

/// A device of an ensemble.
struct SampledDevice {
  std::vector<double> values;   ///< values of the varied quantities, in the order of [spread], as DeviceSpread::to_values
  std::optional<Switch> model;  ///< model of the device; none if the device cannot be described
  std::string refusal;          ///< reason why the device cannot be described
};

class Ensemble {
 public:
  /// Makes devices 0 to size - 1 of this scene. Their waveforms have the voltages of the nominal device. Keeps a reference to
  /// `nominal`. Throws InvalidInput if the scene has no [spread], and the exceptions of SamplePoints.
  Ensemble(const PreparedScene& nominal, std::uint64_t size, std::uint64_t seed = 1, PointSet points = PointSet::sobol);
  /// Makes the devices at the points of a design for Sobol' indices, the shares of a figure's variance.
  Ensemble(const PreparedScene& nominal, const SobolDesign& design);

  [[nodiscard]] const PreparedScene& nominal() const { return *nominal_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Returns the point of device k in the open unit cube: one coordinate per varied quantity, before any correlation is
  /// applied.
  [[nodiscard]] std::vector<double> point(std::uint64_t k) const;
  /// Returns the values of the varied quantities of device k.
  [[nodiscard]] std::vector<double> values(std::uint64_t k) const;
  /// True if a varied key may change other members of a scene. The scene of each device is then read again from its keys.
  [[nodiscard]] bool reads_anew() const { return reads_anew_; }
  /// Returns the scene of the device with these values, in volts and without [spread]. `simulate` runs this scene to the same
  /// figures. They differ within the tolerance if the ensemble is closed in SIMD lanes
  /// (model/ensemble/ensemble_closings.h).
  [[nodiscard]] SceneFile scene(const std::vector<double>& values) const;

 private:
  Ensemble(const PreparedScene& nominal, std::uint64_t size, std::function<void(std::uint64_t, std::span<double>)> point);

  const PreparedScene* nominal_;
  std::uint64_t size_;
  std::function<void(std::uint64_t, std::span<double>)> point_;
  SceneFile resolved_;       // scene of the nominal device, with every default written out
  bool reads_anew_ = false;  // true if a varied key may change other members of the scene
};

/// Builds devices one after another. Each thread has its own builder. A device does not depend on devices built before it.
class DeviceBuilder {
 public:
  /// Keeps a reference to `ensemble`.
  explicit DeviceBuilder(const Ensemble& ensemble) : ensemble_(&ensemble), scratch_(ensemble.nominal().scene) {}
  [[nodiscard]] SampledDevice device(std::uint64_t k) { return device(ensemble_->values(k)); }
  /// Builds the device with these values of the varied quantities.
  [[nodiscard]] SampledDevice device(std::vector<double> values);

 private:
  void describe(SampledDevice& device);

  const Ensemble* ensemble_;
  Scene scratch_;  // scene whose varied numbers are those of the last built device
};

/// The result of the closing of one device.
struct DeviceOutcome {
  Metrics metrics;
  std::string failure = {};  ///< reason for missing figures: the device cannot be described, or its closing cannot be simulated
  /// False if the hold levels do not keep the device closed. DeviceCloser checks this for settled devices only, RobustCost for
  /// every device.
  bool is_held = true;

  /// True if the device closed and the closing was simulated to the end of the window.
  [[nodiscard]] bool closed() const { return failure.empty() && std::isfinite(metrics.major_bounce_height); }
  /// Returns the value of a figure, or Figure::worst for a device that does not close.
  [[nodiscard]] double of(const Figure& figure) const;
};

/// Returns the time of first contact under a step of one drive from 0 V, with the other drives at a bias [s]. NaN if the switch
/// does not close within `duration` [s].
[[nodiscard]] double closing_time(const Switch& model, std::size_t drive, double step, Bias bias, double duration);
/// Number of periods of the first mode within which a step must close a switch.
inline constexpr double periods_to_close = 20;

/// The quantities that are measured on each device, besides its frequency.
struct MeasuredQuantities {
  bool pull_in = false, closing_time = false, piezo = false;
  [[nodiscard]] static MeasuredQuantities of(const Calibration& calibration) {
    return {calibration.pull_in_error.has_value(), calibration.time_error.has_value(), calibration.piezo_error.has_value()};
  }
  /// Returns the measurements that are in `a` or in `b`.
  friend MeasuredQuantities operator|(const MeasuredQuantities& a, const MeasuredQuantities& b) {
    return {a.pull_in || b.pull_in, a.closing_time || b.closing_time, a.piezo || b.piezo};
  }
};

/// Reason, for messages, why the scale factors of a device are not known.
inline constexpr const char* not_measured = "its pull-in voltage, or what its piezo does, cannot be measured";

/// Measures devices relative to the nominal device, with the errors of a calibration. A closing time gives the factor s of a
/// device's voltages: under a step to closing_step Vdp the device closes in the time that the nominal device takes under
/// closing_step Vdp / s.
class PullInMeter {
 public:
  /// Keeps a reference to `nominal`, whose closing electrode is measured. `precision` is the relative precision of pull-in
  /// voltages; that of the nominal device is at least dynamic_pull_in_precision. Throws InvalidInput if a measurement needs an
  /// electrode, a pull-in voltage or a piezo that the switch lacks, or if the piezo does not move the contact point.
  PullInMeter(const PreparedScene& nominal, const MeasuredQuantities& quantities, double precision = dynamic_pull_in_precision);
  /// Return the pull-in voltage [V] and the first frequency [Hz] of the nominal device.
  [[nodiscard]] double pull_in() const { return pull_in_; }
  [[nodiscard]] double frequency() const;
  /// Returns the displacement of the contact point per volt at the piezo, over the contact gap; 0 without a piezo [1/V].
  [[nodiscard]] static double piezo_unit(const Switch& model);
  /// Returns the index of the measured electrode in Switch::drives().
  [[nodiscard]] std::size_t electrode() const { return electrode_; }
  /// Returns the closing time of the nominal device under the step whose closing time is measured [s]; NaN if closing times are
  /// not measured.
  [[nodiscard]] double closing_time() const;
  /// Returns the scale factors computed from the closing time of a device [s]; the factor of the voltages is NaN if the device
  /// does not close.
  [[nodiscard]] DeviceUnits units_by_time(double time) const;
  /// Returns the exact scale factors. The factor of the voltages is NaN for a device that has no pull-in voltage, or that does
  /// not close.
  [[nodiscard]] DeviceUnits exact(const Switch& model) const;
  /// Returns the measured scale factors of device k, before sorting into classes; the errors depend on `seed` and k alone.
  [[nodiscard]] static DeviceUnits measured(const DeviceUnits& exact, const Calibration& calibration, std::uint64_t seed,
                                            std::uint64_t k);

 private:
  [[nodiscard]] double pull_in(const Switch& model, double precision) const;  // pull-in voltage [V]
  void learn_times();
  [[nodiscard]] double time_of(const Switch& model, double step) const;

  struct ToldVolts {
    double time, volts;  // closing time [s]; factor of the step's voltages over those of the nominal step
  };

  const PreparedScene* nominal_;
  MeasuredQuantities quantities_;
  double precision_;
  std::vector<ToldVolts> told_ = {};  // closing times of the nominal device under several steps, in increasing order
  std::size_t electrode_ = 0;
  double pull_in_ = Metrics::unset;
};

/// The scale factors that a calibration assigns to devices: the measured ones or, if devices are sorted into classes, those at
/// the centre of a device's class.
class MeasuredUnits {
 public:
  /// Makes the classes from `reference`: the exact scale factors of devices that represent [spread], as in measured_units().
  /// Throws InvalidInput if classes are needed and none of these devices can be measured.
  MeasuredUnits(const Calibration& calibration = {}, std::span<const DeviceUnits> reference = {});
  [[nodiscard]] const Calibration& calibration() const { return calibration_; }
  /// Returns a copy with exact measurements and the same classes.
  [[nodiscard]] MeasuredUnits without_errors() const;
  /// Returns the assigned scale factors of device k, given its exact ones; the errors depend on `seed` and k alone.
  [[nodiscard]] DeviceUnits of(const DeviceUnits& exact, std::uint64_t seed, std::uint64_t k) const;
  /// Returns the scale factors that the calibration assigns to a device with these measured ones.
  [[nodiscard]] DeviceUnits of(const DeviceUnits& measured) const;

  struct Class {
    DeviceUnits centre;
    double share = 0;  ///< share of the devices of [spread] in this class
  };
  /// Returns the classes, ordered by the voltage of their centre; none if every device has its own scale factors.
  [[nodiscard]] std::vector<Class> classes() const;

 private:
  Calibration calibration_;
  Classes classes_;  // classes in the logarithms of the factors of voltages, time and piezo voltages
};
/// Returns the assigned scale factors for each of these calibrations. The classes depend on [spread] alone, so that a device
/// belongs to the same class in every study. Throws Interrupted if `progress` asks to stop.
[[nodiscard]] std::vector<MeasuredUnits> measured_units(const PreparedScene& nominal, std::span<const Calibration> calibrations,
                                                        int jobs, const Progress& progress = {});

/// Returns the relative standard deviations of the exact scale factors over the devices of [spread]. Throws Interrupted if
/// `progress` asks to stop.
[[nodiscard]] DeviceUnits deviation_of_units(const PreparedScene& nominal, bool need_pull_in, int jobs,
                                             const Progress& progress = {});

/// The drives of every device: the waveforms of the nominal device or, with a per-device calibration, these waveforms scaled by
/// the factors of each device. The drives have the errors of the device's sources if these errors vary.
struct EnsembleDrive {
  std::vector<Waveform> waveforms;  ///< waveforms in the order of Switch::drives() [V]
  MeasuredUnits known = {};
};

struct EnsembleRun {
  double duration = 0;      ///< time to simulate [s]
  double tolerance = 1e-5;  ///< tolerance of the integrator: error of the highest rebound's 95th percentile < 0.4 %
  std::uint64_t seed = 1;   ///< seed of the measurement errors
  int jobs = 1;             ///< number of threads; does not change the outcomes
  Vectors vectors = vectors_in_use();
  bool measures_drive_energy = false;
  /// True if drives may command the devices to open (open_command.h). Closings then end at the command to open.
  bool opens_on_command = false;
};

/// Closes one device. The figures are those of the run; the options `run` may end it before the end of the window.
[[nodiscard]] DeviceOutcome close_device(const SampledDevice& device, const std::vector<Signal>& signals,
                                         const MetricsOptions& options, const ClosingOptions& run);

struct DeviceClosing {
  const SampledDevice* device = nullptr;
  const std::vector<Signal>* signals = nullptr;
  std::vector<double> gains = {};  ///< gain of each signal; empty if all gains are 1
  ClosingOptions run;
  bool measures_drive_energy = false;  ///< true to measure the drive energy in SIMD lanes as well; closings one by one always
                                       ///< measure the energy
};
/// Closes several devices. Devices whose laws are available in SIMD lanes (model/ensemble/ensemble_closings.h) are closed
/// together, the others one by one. All have the tolerance of the first device. An outcome does not depend on the other
/// devices.
[[nodiscard]] std::vector<DeviceOutcome> close_devices(std::span<const DeviceClosing> closings, const MetricsOptions& options,
                                                       Vectors vectors);

/// A device, and the signals that are applied to it.
struct DrivenDevice {
  const SampledDevice* device = nullptr;
  const std::vector<Signal>* signals = nullptr;  ///< signals, one per drive
  double duration = 0;                           ///< time to simulate [s]
};
/// Closes devices as close_devices() does, and finds whether their hold levels keep them closed. Each device has its own window
/// and steady force; `run` has the other options. `near` is the closed equilibrium of a similar switch under similar drives,
/// for use as a starting point.
[[nodiscard]] std::vector<DeviceOutcome> close_driven(std::span<const DrivenDevice> devices, const MetricsOptions& options,
                                                      const ClosingOptions& run, const std::optional<ClosedEquilibrium>& near,
                                                      bool measures_drive_energy, Vectors vectors);

/// Closes devices under several drives. Drives with a calibration are scaled by the factors of each device.
class DeviceCloser {
 public:
  /// Keeps references to `nominal` and `drives`. Throws the exceptions of the constructor of PullInMeter.
  DeviceCloser(const PreparedScene& nominal, const std::vector<EnsembleDrive>& drives, const EnsembleRun& run,
               const std::atomic<bool>* stop = nullptr);
  /// Returns the outcomes of devices `first`, first + 1, ..., by drive. After an interruption, missing outcomes are unset.
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
  std::optional<PullInMeter> meter_;
  std::vector<std::vector<Signal>> nominal_signals_;          // signals of every drive on the nominal device
  std::vector<std::optional<OpenCommand>> nominal_commands_;  // command to open of each drive, if it has one
  std::vector<std::optional<ClosedEquilibrium>>
      nominal_closed_;  // closed equilibrium of the nominal device under the hold levels of each drive
};

/// Closes all devices under each of these drives. Returns the outcomes by drive, then by device. After an interruption, the
/// outcomes are those of the first devices only.
[[nodiscard]] std::vector<std::vector<DeviceOutcome>> close_all(const Ensemble& ensemble,
                                                                const std::vector<EnsembleDrive>& drives, const EnsembleRun& run,
                                                                const Progress& progress = {});

}  // namespace softland
