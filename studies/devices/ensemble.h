// An ensemble of devices with process variation: the switches of a scene's [spread]. Each switch depends only on the scene, the
// seed and its number.
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

/// A device of an ensemble, with its varied quantities and its model.
struct SampledDevice {
  std::vector<double> values;   ///< values of the varied quantities, in the order of [spread], from DeviceSpread::to_values
  std::optional<Switch> model;  ///< model of the device; none if its values are impossible
  std::string refusal;          ///< rule that the values violate if the device is impossible
};

class Ensemble {
 public:
  /// Makes devices 0 to size - 1 of this scene. Their waveforms have the voltages of the nominal device. Keeps a reference to
  /// `nominal`. Throws InvalidInput if the scene has no [spread], and the exceptions of SamplePoints.
  Ensemble(const PreparedScene& nominal, std::uint64_t size, std::uint64_t seed = 1, PointSet points = PointSet::sobol);
  /// Makes the devices at the points of a design for Sobol' indices, the shares of a figure's variance by varied quantity.
  Ensemble(const PreparedScene& nominal, const SobolDesign& design);

  [[nodiscard]] const PreparedScene& nominal() const { return *nominal_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Returns the point of device k in the open unit cube: one coordinate per varied quantity, before any correlation is
  /// applied.
  [[nodiscard]] std::vector<double> point(std::uint64_t k) const;
  /// Returns the values of the varied quantities of device k.
  [[nodiscard]] std::vector<double> values(std::uint64_t k) const;
  /// True if a varied key determines further numbers of a scene, so that the scene of each device is read again from its keys.
  [[nodiscard]] bool reads_anew() const { return reads_anew_; }
  /// Returns the scene of the device with these values, in volts and without [spread]. `simulate` gives this scene the figures
  /// that the ensemble gives the device. The figures differ within the tolerance if the ensemble is closed in SIMD lanes
  /// (model/ensemble/ensemble_closings.h).
  [[nodiscard]] SceneFile scene(const std::vector<double>& values) const;

 private:
  Ensemble(const PreparedScene& nominal, std::uint64_t size, std::function<void(std::uint64_t, std::span<double>)> point);

  const PreparedScene* nominal_;
  std::uint64_t size_;
  std::function<void(std::uint64_t, std::span<double>)> point_;
  SceneFile resolved_;  // scene of the nominal device, with every default written out
  // True if a varied key determines further numbers of a scene, so that the scene of each device is read again.
  bool reads_anew_ = false;
};

/// Builds devices one after another. Each thread has its own builder. A device does not depend on devices built before it.
class DeviceBuilder {
 public:
  /// Keeps a reference to `ensemble`, which must outlive this object.
  explicit DeviceBuilder(const Ensemble& ensemble) : ensemble_(&ensemble), scratch_(ensemble.nominal().scene) {}
  [[nodiscard]] SampledDevice device(std::uint64_t k) { return device(ensemble_->values(k)); }
  /// Builds the device with these values of the varied quantities.
  [[nodiscard]] SampledDevice device(std::vector<double> values);

 private:
  void describe(SampledDevice& device);

  const Ensemble* ensemble_;
  Scene scratch_;  // scene whose varied numbers are those of the last device built
};

/// The result of the closing of one device.
struct DeviceOutcome {
  Metrics metrics;
  /// Reason why the device has no figures: its values are impossible, or its closing cannot be simulated.
  std::string failure = {};
  /// False if the hold levels do not keep the device closed. DeviceCloser checks this for settled devices only, RobustCost for
  /// every device.
  bool is_held = true;

  /// True if the device closed and the closing was simulated to the end of the simulated time.
  [[nodiscard]] bool closed() const { return failure.empty() && std::isfinite(metrics.major_bounce_height); }
  /// Returns the value of a figure of the device, or Figure::worst for a device that does not close.
  [[nodiscard]] double of(const Figure& figure) const;
};

/// Returns the time of first contact, or of the first closing of the connection of several contacts, under a step of one drive
/// from 0 V, with the other drives at a bias [s]. NaN if the switch does not close within `duration` [s].
[[nodiscard]] double closing_time(const Switch& model, std::size_t drive, double step, Bias bias, double duration);
/// Number of periods of the first mode within which a step must close a switch.
inline constexpr double periods_to_close = 20;

/// The quantities that a per-device calibration measures, besides the frequency.
struct MeasuredQuantities {
  bool pull_in = false, closing_time = false, piezo = false;
  [[nodiscard]] static MeasuredQuantities of(const Calibration& calibration) {
    return {calibration.pull_in_error.has_value(), calibration.time_error.has_value(), calibration.piezo_error.has_value()};
  }
  /// Returns the measured quantities that are in `a` or in `b`.
  friend MeasuredQuantities operator|(const MeasuredQuantities& a, const MeasuredQuantities& b) {
    return {a.pull_in || b.pull_in, a.closing_time || b.closing_time, a.piezo || b.piezo};
  }
};

/// Reason, for messages, why a calibration has no scale factors for a device.
inline constexpr const char* not_measured = "its pull-in voltage, or what its piezo does, cannot be measured";

/// Measures devices relative to the nominal device, with the errors of a calibration. A closing time gives the factor s of a
/// device's voltages. Under a step to closing_step Vdp (Vdp of the nominal device) the device takes as long to close as the
/// nominal device under a step to closing_step Vdp / s.
class PullInMeter {
 public:
  /// Keeps a reference to `nominal`, whose closing electrode is measured. `precision` is the relative precision of pull-in
  /// voltages; that of the nominal device is found to dynamic_pull_in_precision or better. Throws InvalidInput if a measurement
  /// needs an electrode, a pull-in voltage or a piezo that the switch lacks, or if the piezo does not move the contact point.
  PullInMeter(const PreparedScene& nominal, const MeasuredQuantities& quantities, double precision = dynamic_pull_in_precision);
  /// Return the pull-in voltage [V] and the first frequency [Hz] of the nominal device.
  [[nodiscard]] double pull_in() const { return pull_in_; }
  [[nodiscard]] double frequency() const;
  /// Returns the displacement of the contact point per volt at the piezo, divided by the contact gap [1/V]; 0 without a piezo.
  [[nodiscard]] static double piezo_unit(const Switch& model);
  /// Returns the index in Switch::drives() of the electrode whose pull-in voltage or closing time is measured.
  [[nodiscard]] std::size_t electrode() const { return electrode_; }
  /// Returns the closing time of the nominal device under the step whose closing time is measured [s]; NaN if closing times are
  /// not measured.
  [[nodiscard]] double closing_time() const;
  /// Returns the scale factors computed from the closing time of a device [s]; the factor of the voltages is NaN if the device
  /// does not close.
  [[nodiscard]] DeviceUnits units_by_time(double time) const;
  /// Returns the scale factors of a device without measurement error. The factor of the voltages is NaN for a device that has
  /// no pull-in voltage, or that does not close.
  [[nodiscard]] DeviceUnits exact(const Switch& model) const;
  /// Returns the measured scale factors of device k, before sorting into classes; the errors depend on `seed` and k alone.
  [[nodiscard]] static DeviceUnits measured(const DeviceUnits& exact, const Calibration& calibration, std::uint64_t seed,
                                            std::uint64_t k);

 private:
  // Returns the pull-in voltage of the measured electrode [V].
  [[nodiscard]] double pull_in(const Switch& model, double precision) const;
  void learn_times();
  [[nodiscard]] double time_of(const Switch& model, double step) const;

  struct TimedVoltage {
    // Closing time of the nominal device under a step to closing_step Vdp / `volts` [s]. `volts` is the voltage factor of a
    // device that takes this time under a step to closing_step Vdp.
    double time, volts;
  };

  const PreparedScene* nominal_;
  MeasuredQuantities quantities_;
  double precision_;
  std::vector<TimedVoltage> voltages_ =
      {};  // closing times of the nominal device under several voltage steps, in increasing order
  std::size_t electrode_ = 0;
  double pull_in_ = Metrics::unset;
};

/// The scale factors that a calibration assigns to devices: the measured factors or, if devices are sorted into classes, the
/// factors at the centre of a device's class.
class MeasuredUnits {
 public:
  /// Makes the classes from `reference`: the exact scale factors of devices that represent [spread], as in measured_units().
  /// Throws InvalidInput if classes are needed and none of these devices can be measured.
  MeasuredUnits(const Calibration& calibration = {}, std::span<const DeviceUnits> reference = {});
  [[nodiscard]] const Calibration& calibration() const { return calibration_; }
  /// Returns a copy of this object with exact measurements and the same classes.
  [[nodiscard]] MeasuredUnits without_errors() const;
  /// Returns the assigned scale factors of device k, given its exact ones; the errors depend on `seed` and k alone.
  [[nodiscard]] DeviceUnits of(const DeviceUnits& exact, std::uint64_t seed, std::uint64_t k) const;
  /// Returns the scale factors that the calibration assigns to a device with the factors `measured`.
  [[nodiscard]] DeviceUnits of(const DeviceUnits& measured) const;

  struct Class {
    DeviceUnits centre;
    double share = 0;  ///< share of the devices of [spread] that belong to this class
  };
  /// Returns the classes of devices, ordered by the voltage factor of their centre; none if every device has its own scale
  /// factors.
  [[nodiscard]] std::vector<Class> classes() const;

 private:
  Calibration calibration_;
  Classes classes_;  // classes of devices in the logarithms of the factors of voltages, time and piezo voltages
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
  std::vector<Waveform> waveforms;  ///< waveforms of the nominal device, in the order of Switch::drives() [V]
  MeasuredUnits known = {};
};

struct EnsembleRun {
  double duration = 0;  ///< simulated time of every closing [s]
  /// Relative tolerance of the integrator; the 95th percentile of the highest rebound has an error below 0.4 %.
  double tolerance = 1e-5;
  std::uint64_t seed = 1;  ///< seed of the errors of the calibration's measurements
  int jobs = 1;            ///< number of threads; does not change the outcomes
  Vectors vectors = vectors_in_use();
  bool measures_drive_energy = false;
  /// True if drives may command the devices to open (open_command.h). Closings then end at the command to open.
  bool opens_on_command = false;
};

/// Closes one device and returns the figures of the run, which the options `run` may end early.
[[nodiscard]] DeviceOutcome close_device(const SampledDevice& device, const std::vector<Signal>& signals,
                                         const MetricsOptions& options, const ClosingOptions& run);

struct DeviceClosing {
  const SampledDevice* device = nullptr;
  const std::vector<Signal>* signals = nullptr;
  std::vector<double> gains = {};  ///< factor of each drive's signal; empty if all factors are 1
  ClosingOptions run;
  /// True to measure the drive energy in SIMD lanes; closings that are simulated one by one always measure the energy.
  bool measures_drive_energy = false;
};
/// Closes several devices. Devices whose laws are available in SIMD lanes (model/ensemble/ensemble_closings.h) are closed
/// together, the others one by one. All have the tolerance of the first device. An outcome does not depend on the other
/// devices.
[[nodiscard]] std::vector<DeviceOutcome> close_devices(std::span<const DeviceClosing> closings, const MetricsOptions& options,
                                                       Vectors vectors);

/// A device, and the drive signals that are applied to it.
struct DrivenDevice {
  const SampledDevice* device = nullptr;
  const std::vector<Signal>* signals = nullptr;  ///< signals that are applied to the device, one per drive
  double duration = 0;                           ///< simulated time of the closing [s]
};
/// Closes devices as close_devices() does, and finds whether their hold levels keep them closed. Each device has its own
/// simulated time and steady contact force; `run` has the other options. `near` is the closed equilibrium of a similar switch
/// under similar drives, for use as a starting point.
[[nodiscard]] std::vector<DeviceOutcome> close_driven(std::span<const DrivenDevice> devices, const MetricsOptions& options,
                                                      const ClosingOptions& run, const std::optional<ClosedEquilibrium>& near,
                                                      bool measures_drive_energy, Vectors vectors);

/// Closes devices under several sets of waveforms. Waveforms with a calibration are scaled by the factors of each device.
class DeviceCloser {
 public:
  /// Keeps references to `nominal` and `drives`. Throws the exceptions of the constructor of PullInMeter.
  DeviceCloser(const PreparedScene& nominal, const std::vector<EnsembleDrive>& drives, const EnsembleRun& run,
               const std::atomic<bool>* stop = nullptr);
  /// Returns the outcomes of the devices `first`, first + 1, ..., by set of waveforms, then by device. Outcomes that an
  /// interruption prevented are unset.
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
  std::vector<std::vector<Signal>> nominal_signals_;  // drive signals of every set of waveforms on the nominal device
  // Command to open that each set of waveforms gives on the nominal device; none for waveforms without this command.
  std::vector<std::optional<OpenCommand>> nominal_commands_;
  std::vector<std::optional<ClosedEquilibrium>>
      nominal_closed_;  // closed equilibrium of the nominal device under the hold levels of each set of waveforms
};

/// Closes all devices under each of these sets of waveforms. Returns the outcomes by set of waveforms, then by device. After an
/// interruption, the outcomes are those of the first devices only.
[[nodiscard]] std::vector<std::vector<DeviceOutcome>> close_all(const Ensemble& ensemble,
                                                                const std::vector<EnsembleDrive>& drives, const EnsembleRun& run,
                                                                const Progress& progress = {});

}  // namespace softland
