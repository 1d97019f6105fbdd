// Performance of drives on devices with process variation: statistics of every figure of merit over one ensemble, the same
// devices for every drive.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "objectives/figures.h"
#include "sampling/interval.h"
#include "studies/devices/ensemble.h"

namespace softland {

/// Probabilities of the reported quantiles.
inline constexpr std::array robustness_quantiles{0.05, 0.5, 0.95, 0.99};

struct EstimatedQuantile {
  double value = Metrics::unset;
  Interval interval = {};  ///< 95 %, from order statistics; a side is infinite if there are too few devices
};

/// Estimates a quantile; a device that does not close counts as +infinity.
[[nodiscard]] EstimatedQuantile estimated_quantile(const std::vector<double>& sample, double probability);

struct FigureStatistics {
  double mean = Metrics::unset, standard_deviation = Metrics::unset,
         skewness = Metrics::unset;                                           ///< over the devices that have the figure
  std::size_t devices = 0;                                                    ///< number of these devices
  std::array<EstimatedQuantile, robustness_quantiles.size()> quantiles = {};  ///< quantiles over all devices
};

/// A share of all devices.
struct Yield {
  std::size_t devices = 0;
  double value = Metrics::unset;
  Interval interval = {};  ///< 95 %, Wilson
};

/// True if a device closes, and settles without a significant rebound.
[[nodiscard]] bool is_bounce_free(const DeviceOutcome& outcome);
[[nodiscard]] Yield yield_of(std::size_t devices, std::size_t all);

struct DriveRobustness {
  std::string name;
  DriveWaveforms waveforms;             ///< waveforms of the nominal device, in volts
  KnownUnits known = {};                ///< units of the devices
  std::vector<DeviceOutcome> outcomes;  ///< outcomes by device
  PerFigure<FigureStatistics> figures;  ///< statistics of device_figures
  Yield closing;                        ///< share that reaches the contact in a run to the end
  Yield collapsed;                      ///< share whose beam collapses onto the electrode
  Yield bounce_free;                    ///< share that closes and settles without a significant rebound
  std::vector<std::size_t> worst;       ///< devices, the highest rebound first; failures before all
};

struct RobustnessOptions {
  std::uint64_t samples = 2000;
  std::uint64_t seed = 1;
  PointSet points = PointSet::sobol;
  int jobs = 1;  ///< threads; does not change the result
  Vectors vectors = vectors_in_use();
  bool measures_drive_energy = false;  ///< measures it on every device
  /// Judges a last drive that is calibrated also without a calibration, with each measurement alone, and with all of them
  /// without error: sorted into classes, and each device in its own units.
  bool worth_of_measuring = false;
  bool opens_on_command = false;  ///< EnsembleRun::opens_on_command
};

struct Robustness {
  std::vector<DriveRobustness> drives;             ///< the plain step first
  std::vector<DriveRobustness> by_knowledge = {};  ///< the last of them again: the value of its measurements
  std::size_t devices = 0;                         ///< fewer than requested if interrupted
  bool interrupted = false;
  double duration = 0;   ///< window [s]
  double tolerance = 0;  ///< tolerance of the integrator
};

/// Keys of the figures whose spread sensitivity() and other_ways() explain.
inline constexpr std::array explained_figures{key_of(&Metrics::initial_contact_time), key_of(&Metrics::largest_impact_velocity),
                                              key_of(&Metrics::major_bounce_height)};

/// The sensitivity of a figure to the varied quantities.
struct FigureSensitivity {
  std::string_view key;  ///< key of device_figures
  SobolEstimate estimate;
};
struct Sensitivity {
  std::vector<std::string> variables;      ///< variables of the spread
  std::vector<FigureSensitivity> figures;  ///< explained_figures
  std::string why_none;                    ///< empty if indices exist
};

/// The closing of a device that has a certain quantile of the highest rebound.
struct DeviceCourse {
  double probability = 0;
  std::size_t device = 0;
  Trajectory trajectory;
};

/// The gaps of the contacts of several devices at the same instants, which divide the time from 0 to `end` evenly.
struct GapCourses {
  double end = 0;                              ///< [s]
  std::vector<std::vector<double>> gaps = {};  ///< gaps by device, then by instant; below 0 in the contact [m]
};

/// A drive to judge.
struct NamedDrive {
  std::string name;
  DriveWaveforms waveforms;      ///< waveforms in volts
  Calibration calibration = {};  ///< none: every device gets the volts of the nominal one
};

/// Judges the drives on the devices of the spread of `nominal`, and the plain step to the same hold levels before them. Throws
/// InvalidInput for a scene without [spread] or without contact, and for a drive that the scene lacks or that is beyond its
/// limits.
[[nodiscard]] Robustness robustness(const PreparedScene& nominal, const std::vector<NamedDrive>& drives,
                                    const RobustnessOptions& options, const Watch& watch = {});

/// Computes Sobol' indices of the figures under this drive, from `rows` rows of a design. None for correlated variables, whose
/// shares cannot be separated, and for a single variable. Measurements count as exact.
[[nodiscard]] Sensitivity sensitivity(const PreparedScene& nominal, const DriveRobustness& drive, std::uint64_t rows,
                                      const RobustnessOptions& options, const Watch& watch = {});

/// Returns the devices whose highest rebound is the 5th, 50th and 95th percentile of all, and their closings.
[[nodiscard]] std::vector<DeviceCourse> device_courses(const PreparedScene& nominal, const DriveRobustness& drive,
                                                       const Robustness& found, const RobustnessOptions& options);

/// Returns the closings of the first `devices` devices until `end` [s], at `instants` instants, without devices that cannot be
/// described. Throws Interrupted if `watch` asks to stop.
[[nodiscard]] GapCourses gap_courses(const PreparedScene& nominal, const DriveRobustness& drive, std::size_t devices,
                                     std::size_t instants, double end, const RobustnessOptions& options, const Watch& watch = {});

/// Returns the scene of a device of that ensemble under one of its drives, with the errors of its sources written out. The
/// closing under `simulate` is the same, as Ensemble::scene(), except for a sine whose times or volts are off
/// (DeviceDrives::waveforms).
[[nodiscard]] SceneFile scene_of_device(const PreparedScene& nominal, const DriveRobustness& drive, std::size_t device,
                                        const RobustnessOptions& options);

namespace internal {

/// Returns the statistics of these outcomes, by device.
[[nodiscard]] DriveRobustness summarised(NamedDrive drive, KnownUnits known, std::vector<DeviceOutcome> outcomes);
/// Options of runs that look closer at a drive of a Robustness.
[[nodiscard]] EnsembleRun run_of(const PreparedScene& nominal, const RobustnessOptions& options);
/// Returns the drive with exact measurements.
[[nodiscard]] EnsembleDrive exactly_measured(const PreparedScene& nominal, const DriveRobustness& drive);
/// Returns the scene of the device with these values of the varied quantities; `device` is the number to which the errors of
/// its measurements belong.
[[nodiscard]] SceneFile scene_of_values(const Ensemble& ensemble, const DriveRobustness& drive, const std::vector<double>& values,
                                        std::uint64_t seed, std::size_t device);

}  // namespace internal
}  // namespace softland
