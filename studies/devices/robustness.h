// Performance of sets of waveforms on devices with process variation: statistics of every figure of merit over one ensemble.
// All sets are simulated on the same devices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "objectives/figure_values.h"
#include "sampling/interval.h"
#include "studies/devices/ensemble.h"

namespace softland {

/// Probabilities of the reported quantiles of figures over the devices.
inline constexpr std::array robustness_quantiles{0.05, 0.5, 0.95, 0.99};

struct EstimatedQuantile {
  double value = Metrics::unset;
  /// 95 % confidence interval of the quantile, from order statistics; an end is infinite if there are too few devices.
  Interval interval = {};
};

/// Estimates a quantile of a figure from its values on devices; a device that does not close counts as +infinity.
[[nodiscard]] EstimatedQuantile estimated_quantile(const std::vector<double>& sample, double probability);

struct FigureStatistics {
  /// Mean, standard deviation and skewness of the figure over the devices that have the figure.
  double mean = Metrics::unset, standard_deviation = Metrics::unset, skewness = Metrics::unset;
  std::size_t devices = 0;                                                    ///< number of devices that have the figure
  std::array<EstimatedQuantile, robustness_quantiles.size()> quantiles = {};  ///< quantiles of the figure over all devices
};

/// A share of all devices, such as the share of devices that close.
struct Yield {
  std::size_t devices = 0;
  double value = Metrics::unset;
  Interval interval = {};  ///< 95 % confidence interval of the share (Wilson)
};

/// True if a device closes, and settles without a significant rebound.
[[nodiscard]] bool is_bounce_free(const DeviceOutcome& outcome);
[[nodiscard]] Yield yield_of(std::size_t devices, std::size_t all);

struct DriveRobustness {
  std::string name;
  DriveWaveforms waveforms;             ///< waveforms for the nominal device, in volts
  MeasuredUnits known = {};             ///< scale factors that the calibration assigns to the waveforms of each device
  std::vector<DeviceOutcome> outcomes;  ///< outcomes of the closings, by device
  PerFigure<FigureStatistics> figures;  ///< statistics of the figures in device_figures
  Yield closing;      ///< share of devices that touch their contact and are simulated to the end of the simulated time
  Yield collapsed;    ///< share of devices whose beam collapses onto the electrode
  Yield bounce_free;  ///< share of devices that close and settle without a significant rebound
  std::vector<std::size_t> worst;  ///< devices in order of decreasing rebound height, after those that do not close
};

struct RobustnessOptions {
  std::uint64_t samples = 2000;
  std::uint64_t seed = 1;
  PointSet points = PointSet::sobol;
  int jobs = 1;  ///< number of threads; does not change the result
  Vectors vectors = vectors_in_use();
  bool measures_drive_energy = false;  ///< true to measure the drive energy (delivered by the voltage sources) on every device
  /// True to repeat the closings under the last set of waveforms, if it has a calibration, with other calibrations: with no
  /// measurement, with each measurement alone, and with all measurements without error. The last is simulated with the devices
  /// sorted into classes, and with each device's own scale factors.
  bool worth_of_measuring = false;
  bool opens_on_command = false;  ///< true if the waveforms may command devices to open: EnsembleRun::opens_on_command
};

struct Robustness {
  std::vector<DriveRobustness> drives;  ///< results of the sets of waveforms, the plain step first
  /// Results of the last set of waveforms with other calibrations, which show what each measurement is worth.
  std::vector<DriveRobustness> by_knowledge = {};
  std::size_t devices = 0;  ///< number of simulated devices; fewer than requested if interrupted
  bool interrupted = false;
  double duration = 0;   ///< simulated time of the closings [s]
  double tolerance = 0;  ///< relative tolerance of the integrator in the closings
};

/// Keys of the figures for which sensitivity() and box_and_chaos() compute results.
inline constexpr std::array explained_figures{key_of(&Metrics::initial_contact_time), key_of(&Metrics::largest_impact_velocity),
                                              key_of(&Metrics::major_bounce_height)};

/// The sensitivity of a figure to the varied quantities.
struct FigureSensitivity {
  std::string_view key;  ///< key of the figure, one of device_figures
  SobolEstimate estimate;
};
struct Sensitivity {
  std::vector<std::string> variables;      ///< names of the varied quantities of [spread]
  std::vector<FigureSensitivity> figures;  ///< sensitivities of the figures in explained_figures
  std::string why_none;                    ///< reason why there are no Sobol' indices; empty if the indices exist
};

/// The simulated motion of the device at a quantile (`probability`) of the highest rebound.
struct DeviceCourse {
  double probability = 0;
  std::size_t device = 0;
  Trajectory trajectory;
};

/// The gaps of the contacts of several devices at common instants, evenly spaced from 0 to `end`.
struct GapCourses {
  double end = 0;                              ///< last instant of the gaps over time [s]
  std::vector<std::vector<double>> gaps = {};  ///< contact gaps by device, then by instant [m]; below 0 in contact
};

/// A set of waveforms whose performance robustness() computes.
struct NamedDrive {
  std::string name;
  DriveWaveforms waveforms;  ///< waveforms for the nominal device, in volts
  /// Measurements by which the waveforms are scaled to each device; empty if every device has the voltages of the nominal
  /// device.
  Calibration calibration = {};
};

/// Closes the devices of the [spread] of `nominal` under the plain step to the scene's hold levels, then under each set of
/// waveforms. Throws InvalidInput for a scene without [spread] or without contact, for a drive that the scene lacks, and for
/// exceeded limits of a drive.
[[nodiscard]] Robustness robustness(const PreparedScene& nominal, const std::vector<NamedDrive>& drives,
                                    const RobustnessOptions& options, const Progress& progress = {});

/// Computes Sobol' indices of the figures under the waveforms of `drive`, from `rows` rows of a Sobol' design. None for
/// correlated variables, whose shares of the variance cannot be separated, and for a single variable. Measurements count as
/// exact.
[[nodiscard]] Sensitivity sensitivity(const PreparedScene& nominal, const DriveRobustness& drive, std::uint64_t rows,
                                      const RobustnessOptions& options, const Progress& progress = {});

/// Returns the devices at the 5th, 50th and 95th percentile of the highest rebound, with their motion.
[[nodiscard]] std::vector<DeviceCourse> device_courses(const PreparedScene& nominal, const DriveRobustness& drive,
                                                       const Robustness& found, const RobustnessOptions& options);

/// Returns the contact gaps of the first `devices` devices until `end` [s], at `instants` instants. Devices with impossible
/// values are left out. Throws Interrupted if `progress` asks to stop.
[[nodiscard]] GapCourses gap_courses(const PreparedScene& nominal, const DriveRobustness& drive, std::size_t devices,
                                     std::size_t instants, double end, const RobustnessOptions& options,
                                     const Progress& progress = {});

/// Returns the scene of a device of the ensemble under one of the sets of waveforms, with the errors of the device's sources
/// written out. Simulating this scene gives the closing of the device in the ensemble, within the limits of Ensemble::scene().
/// An exception is a sine with errors of times or voltages, which becomes a table (DeviceDrives::written).
[[nodiscard]] SceneFile scene_of_device(const PreparedScene& nominal, const DriveRobustness& drive, std::size_t device,
                                        const RobustnessOptions& options);

/// Returns the simulated time in which these commanded signals end, and in which the contact settles afterwards; at least that of
/// `nominal` [s].
[[nodiscard]] double window_for(const PreparedScene& nominal, std::span<const Signal> commanded);
/// Sets the simulated time of a scene [s].
void set_window(SceneFile& file, double window);

/// Returns a simulated time [s], or another positive number, rounded up to two significant digits. The result is the double that
/// is nearest to this decimal, so that a scene file says "0.0017 s".
[[nodiscard]] double rounded_up(double window);

namespace internal {

/// Returns the statistics of a set of waveforms from the outcomes of the devices, which are ordered by device.
[[nodiscard]] DriveRobustness summarised(NamedDrive drive, MeasuredUnits known, std::vector<DeviceOutcome> outcomes);
/// Returns the options with which robustness() closes devices, for further closings under the same waveforms.
[[nodiscard]] EnsembleRun run_of(const PreparedScene& nominal, const RobustnessOptions& options);
/// Returns the set of waveforms with its calibration as if measured without error.
[[nodiscard]] EnsembleDrive exactly_measured(const PreparedScene& nominal, const DriveRobustness& drive);
/// Returns the scene of the device with these values of the varied quantities. `device` is the number that determines the
/// errors of the device's measurements.
[[nodiscard]] SceneFile scene_of_values(const Ensemble& ensemble, const DriveRobustness& drive, const std::vector<double>& values,
                                        std::uint64_t seed, std::size_t device);

}  // namespace internal
}  // namespace softland
