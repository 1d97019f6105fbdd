// Devices as they come from manufacturing: the switches of a scene's [spread], each a function of its number.
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
  std::vector<double> values;   ///< of the varying quantities, in the order of the spread, as DeviceSpread::to_values
  std::optional<Switch> model;  ///< none where no such device can be described
  std::string refusal;          ///< why
};

class Ensemble {
 public:
  /// Devices 0 to size - 1 of this scene, which keep the volts that its waveforms have on the nominal device. Keeps a reference
  /// to `nominal`. Throws InvalidInput where the scene has no [spread], and what SamplePoints throws.
  Ensemble(const PreparedScene& nominal, std::uint64_t size, std::uint64_t seed = 1, PointSet points = PointSet::sobol);
  /// The devices at the points of a design for Sobol' indices.
  Ensemble(const PreparedScene& nominal, const SobolDesign& design);

  [[nodiscard]] const PreparedScene& nominal() const { return *nominal_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Where device k is in the open unit cube: a coordinate for each varying quantity, before any correlation.
  [[nodiscard]] std::vector<double> point(std::uint64_t k) const;
  /// Of the varying quantities of device k.
  [[nodiscard]] std::vector<double> values(std::uint64_t k) const;
  /// Whether a key may vary that other members of a scene follow, so that each is read anew.
  [[nodiscard]] bool reads_anew() const { return reads_anew_; }
  /// The scene of that device alone, in volts and without [spread]: what `simulate` runs to the same figures, but for
  /// what the tolerance leaves open where ensembles are closed in lanes (model/ensemble/fleet.h).
  [[nodiscard]] SceneFile scene(const std::vector<double>& values) const;

 private:
  Ensemble(const PreparedScene& nominal, std::uint64_t size, std::function<void(std::uint64_t, std::span<double>)> point);

  const PreparedScene* nominal_;
  std::uint64_t size_;
  std::function<void(std::uint64_t, std::span<double>)> point_;
  SceneFile resolved_;       // of the nominal device
  bool reads_anew_ = false;  // a key may vary that other members follow
};

/// Builds devices one after the other. Several threads have one each; a device is the same whatever was built before it.
class DeviceBuilder {
 public:
  /// Keeps a reference to `ensemble`.
  explicit DeviceBuilder(const Ensemble& ensemble) : ensemble_(&ensemble), scratch_(ensemble.nominal().scene) {}
  [[nodiscard]] SampledDevice device(std::uint64_t k) { return device(ensemble_->values(k)); }
  /// The device with these values of the varying quantities.
  [[nodiscard]] SampledDevice device(std::vector<double> values);

 private:
  void describe(SampledDevice& device);

  const Ensemble* ensemble_;
  Scene scratch_;  // whose varying numbers are those of the device built last
};

/// How the closing of one device ended.
struct DeviceOutcome {
  Metrics metrics;
  std::string failure = {};  ///< why it has no figures: refused as a device, or not to be simulated
  /// Not where the hold levels do not keep it closed, as far as that was asked: by DeviceCloser of what has settled, by
  /// RobustCost of every device.
  bool is_held = true;

  /// Whether it closed and its closing could be followed to the end of the window.
  [[nodiscard]] bool closed() const { return failure.empty() && std::isfinite(metrics.major_bounce_height); }
  /// As a distribution has it, where larger is worse: a device that does not close has Figure::worst.
  [[nodiscard]] double of(const Figure& figure) const;
};

/// When a switch first touches under a step of one drive from 0 V, the others standing at a bias; NaN where it does not touch in
/// `duration` [s].
[[nodiscard]] double closing_time(const Switch& model, std::size_t drive, double step, Bias bias, double duration);
/// Periods of the first mode in which a step closes a switch, or does not.
inline constexpr double periods_to_close = 20;

/// What is measured on devices beside their frequency and, where they have one, what their piezo does.
struct Gauges {
  bool pull_in = false, closing_time = false, piezo = false;
  [[nodiscard]] static Gauges of(const Calibration& calibration) {
    return {calibration.pull_in_error.has_value(), calibration.time_error.has_value(), calibration.piezo_error.has_value()};
  }
  /// Those of both.
  friend Gauges operator|(const Gauges& a, const Gauges& b) {
    return {a.pull_in || b.pull_in, a.closing_time || b.closing_time, a.piezo || b.piezo};
  }
};

/// Why a device has no units.
inline constexpr const char* not_measured = "its pull-in voltage, or what its piezo does, cannot be measured";

/// Measures devices against the nominal one, with the errors of a calibration. A closing time tells the volts of a device as
/// those that make the nominal one close as late: the nominal device closes under a step to closing_step Vdp / s in the time that
/// the device takes under closing_step Vdp, and s is the factor of its volts.
class DeviceMeter {
 public:
  /// Keeps a reference to `nominal`, of which it measures the electrode that closes the switch. Throws InvalidInput where there
  /// is none, or it has no pull-in voltage, and one of the gauges needs it; and where a piezo is asked for that the switch has
  /// not, or that does not move its contact point. `precision`: of pull-in voltages, relative; that of the nominal device is
  /// found to dynamic_pull_in_precision at least.
  DeviceMeter(const PreparedScene& nominal, const Gauges& gauges, double precision = dynamic_pull_in_precision);
  /// Of the nominal device [V], [Hz].
  [[nodiscard]] double pull_in() const { return pull_in_; }
  [[nodiscard]] double frequency() const;
  /// The unit of a switch's piezo: how far its volt moves the contact point, over the contact gap; 0 where there is none [1/V].
  [[nodiscard]] static double piezo_unit(const Switch& model);
  /// The number of the electrode among the drives.
  [[nodiscard]] std::size_t electrode() const { return electrode_; }
  /// Under the step whose closing time is measured; NaN where it is not [s].
  [[nodiscard]] double closing_time() const;
  /// The volts of a device that closes in this time, in units of the nominal one; NaN where it does not close [s].
  [[nodiscard]] DeviceUnits told_by(double time) const;
  /// Without error. A device whose pull-in voltage cannot be found, or that does not close, has NaN volts.
  [[nodiscard]] DeviceUnits exact(const Switch& model) const;
  /// What is measured of device k, whatever class it belongs to; the errors are functions of seed and k.
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
  std::vector<ToldVolts> told_ = {};  // by time
  std::size_t electrode_ = 0;
  double pull_in_ = Metrics::unset;
};

/// What a calibration knows of devices: their units as they are measured, or, where devices are sorted into classes by what is
/// measured, those of the centre of their class.
class KnownUnits {
 public:
  /// Classes are made of `reference`, devices that stand for all of the spread, without error: known_units() has them. Throws
  /// InvalidInput where there are none to sort.
  KnownUnits(const Calibration& calibration = {}, std::span<const DeviceUnits> reference = {});
  [[nodiscard]] const Calibration& calibration() const { return calibration_; }
  /// The same with measurements that do not err, in the same classes.
  [[nodiscard]] KnownUnits without_errors() const;
  /// Of device k, whose units are `exact`; the errors are functions of seed and k.
  [[nodiscard]] DeviceUnits of(const DeviceUnits& exact, std::uint64_t seed, std::uint64_t k) const;
  /// Of a device that was measured.
  [[nodiscard]] DeviceUnits of(const DeviceUnits& measured) const;

  struct Class {
    DeviceUnits centre;
    double share = 0;  ///< of the devices of the spread
  };
  /// By the voltage of their centre; none where every device has its own units.
  [[nodiscard]] std::vector<Class> classes() const;

 private:
  Calibration calibration_;
  Classes classes_;  // of the logarithms of volts, time and the piezo's volts
};
/// For each of these calibrations, their classes made of devices of the spread that depend on nothing but the spread: a device
/// belongs to the same class in every study. Throws Interrupted where `watch` asks to stop.
[[nodiscard]] std::vector<KnownUnits> known_units(const PreparedScene& nominal, std::span<const Calibration> calibrations,
                                                  int jobs, const Watch& watch = {});

/// Standard deviations of the devices of the spread from the nominal one, in volts, in time and in a piezo's volts, over its own.
/// Throws Interrupted where `watch` asks to stop.
[[nodiscard]] DeviceUnits deviation_of_units(const PreparedScene& nominal, bool need_pull_in, int jobs, const Watch& watch = {});

/// The drives that every device gets: the waveforms of the nominal device, or, where devices are calibrated, those in the units
/// of each one; with the errors of its sources where these vary.
struct EnsembleDrive {
  std::vector<Waveform> waveforms;  ///< in the order of Switch::drives() [V]
  KnownUnits known = {};
};

struct EnsembleRun {
  double duration = 0;      ///< window [s]
  double tolerance = 1e-5;  ///< of the integrator: 95 % quantiles of B_H then move by less than 0.4 %
  std::uint64_t seed = 1;   ///< of the errors of measurements
  int jobs = 1;             ///< threads; does not change the outcomes
  Vectors vectors = vectors_in_use();
  bool measures_drive_energy = false;
  /// Whether drives may command the devices to open (open_command.h): closings end there.
  bool opens_on_command = false;
};

/// The closing of one device; figures are those of the run, however early its options end it.
[[nodiscard]] DeviceOutcome close_device(const SampledDevice& device, const std::vector<Signal>& signals,
                                         const MetricsOptions& options, const ClosingOptions& run);

struct DeviceClosing {
  const SampledDevice* device = nullptr;
  const std::vector<Signal>* signals = nullptr;
  std::vector<double> gains = {};  ///< of these signals; none: 1
  ClosingOptions run;
  bool measures_drive_energy = false;  ///< in lanes, too; of closings one by one it is known anyway
};
/// The closings of several devices, in lanes where their laws are written for that (model/ensemble/fleet.h), the others one by
/// one. All of the first one's tolerance. An outcome does not depend on what else is closed.
[[nodiscard]] std::vector<DeviceOutcome> close_devices(std::span<const DeviceClosing> closings, const MetricsOptions& options,
                                                       Vectors vectors);

/// A device and what drives it.
struct DrivenDevice {
  const SampledDevice* device = nullptr;
  const std::vector<Signal>* signals = nullptr;  ///< one per drive
  double duration = 0;                           ///< window [s]
};
/// The closings of devices, in lanes as close_devices(), to outcomes that say what is held closed. `run`: but for its window and
/// its steady force, which are those of each device. `near`: the closed equilibrium of a switch and drives little different from
/// these.
[[nodiscard]] std::vector<DeviceOutcome> close_driven(std::span<const DrivenDevice> devices, const MetricsOptions& options,
                                                      const ClosingOptions& run, const std::optional<ClosedEquilibrium>& near,
                                                      bool measures_drive_energy, Vectors vectors);

/// Closes devices under drives, in the units of each device where they are calibrated.
class DeviceCloser {
 public:
  /// Keeps references to `nominal` and `drives`. Throws what DeviceMeter throws.
  DeviceCloser(const PreparedScene& nominal, const std::vector<EnsembleDrive>& drives, const EnsembleRun& run,
               const std::atomic<bool>* stop = nullptr);
  /// The outcomes of devices `first`, first + 1, ..., by drive; asked to stop, those that were not begun are unset.
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
  std::vector<std::vector<Signal>> nominal_signals_;              // of every drive
  std::vector<std::optional<OpenCommand>> nominal_commands_;      // one per drive, where it may have one
  std::vector<std::optional<ClosedEquilibrium>> nominal_closed_;  // under its hold levels
};

/// The closings of all devices under each of these drives: the outcomes of a drive, by device. Asked to stop, they are those of
/// the first devices.
[[nodiscard]] std::vector<std::vector<DeviceOutcome>> close_all(const Ensemble& ensemble,
                                                                const std::vector<EnsembleDrive>& drives, const EnsembleRun& run,
                                                                const Watch& watch = {});

}  // namespace softland
