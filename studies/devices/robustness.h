// How drives do on devices as they come from manufacturing: statistics of every figure of merit over one ensemble, the same
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

/// The probabilities of the quantiles that are given.
inline constexpr std::array robustness_quantiles{0.05, 0.5, 0.95, 0.99};

struct EstimatedQuantile {
  double value = Metrics::unset;
  Interval interval = {};  ///< 95 %, from order statistics; a side is infinite where there are too few devices
};

/// Of a sample in which a device that does not close counts as +infinity.
[[nodiscard]] EstimatedQuantile estimated_quantile(const std::vector<double>& sample, double probability);

struct FigureStatistics {
  double mean = Metrics::unset, standard_deviation = Metrics::unset, skewness = Metrics::unset;  ///< of the devices that have it
  std::size_t devices = 0;                                                                       ///< that have it
  std::array<EstimatedQuantile, robustness_quantiles.size()> quantiles = {};                     ///< of all devices
};

/// A share of all devices.
struct Yield {
  std::size_t devices = 0;
  double value = Metrics::unset;
  Interval interval = {};  ///< 95 %, Wilson
};

/// Whether a device closes, and settles without a significant rebound.
[[nodiscard]] bool is_bounce_free(const DeviceOutcome& outcome);
[[nodiscard]] Yield yield_of(std::size_t devices, std::size_t all);

struct DriveRobustness {
  std::string name;
  DriveWaveforms waveforms;             ///< of the nominal device, in volts
  KnownUnits known = {};                ///< of the devices, whose units they are in
  std::vector<DeviceOutcome> outcomes;  ///< by device
  PerFigure<FigureStatistics> figures;  ///< of device_figures
  Yield closing;                        ///< the contact is reached, and the run could be followed
  Yield collapsed;                      ///< the beam is pulled onto the electrode
  Yield bounce_free;                    ///< the contact is reached, and it settles without a significant rebound
  std::vector<std::size_t> worst;       ///< devices, the highest rebound first; failures before all
};

struct RobustnessOptions {
  std::uint64_t samples = 2000;
  std::uint64_t seed = 1;
  PointSet points = PointSet::sobol;
  int jobs = 1;  ///< threads; does not change the result
  Vectors vectors = vectors_in_use();
  bool measures_drive_energy = false;  ///< of every device
  /// A last drive that is calibrated is judged with nothing known of the devices as well, with each measurement alone, and with
  /// all of them without error, sorted into classes and each device in its own units.
  bool worth_of_measuring = false;
  bool opens_on_command = false;  ///< EnsembleRun::opens_on_command
};

struct Robustness {
  std::vector<DriveRobustness> drives;             ///< the plain step first
  std::vector<DriveRobustness> by_knowledge = {};  ///< the last of them again: what measuring is worth
  std::size_t devices = 0;                         ///< fewer than asked for where it was interrupted
  bool interrupted = false;
  double duration = 0;   ///< window [s]
  double tolerance = 0;  ///< of the integrator
};

/// Keys of the figures whose spread is explained: sensitivity(), other_ways().
inline constexpr std::array explained_figures{key_of(&Metrics::initial_contact_time), key_of(&Metrics::largest_impact_velocity),
                                              key_of(&Metrics::major_bounce_height)};

/// How a figure depends on what varies.
struct FigureSensitivity {
  std::string_view key;  ///< of device_figures
  SobolEstimate estimate;
};
struct Sensitivity {
  std::vector<std::string> variables;      ///< of the spread
  std::vector<FigureSensitivity> figures;  ///< explained_figures
  std::string why_none;                    ///< empty where there are indices
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
  std::vector<std::vector<double>> gaps = {};  ///< by device, then by instant; below 0 in the contact [m]
};

/// A drive to be judged.
struct NamedDrive {
  std::string name;
  DriveWaveforms waveforms;      ///< in volts
  Calibration calibration = {};  ///< none: every device gets the volts of the nominal one
};

/// The drives on the devices of the spread of `nominal`, and the plain step to the same hold levels before them. Throws
/// InvalidInput for a scene without [spread] or without contact, and a drive that the scene does not have or beyond its limits.
[[nodiscard]] Robustness robustness(const PreparedScene& nominal, const std::vector<NamedDrive>& drives,
                                    const RobustnessOptions& options, const Watch& watch = {});

/// Sobol' indices of the figures under this drive, from `rows` rows of a design. There are none where variables are correlated,
/// since their shares cannot be told apart, nor where there is only one. Measurements count as exact.
[[nodiscard]] Sensitivity sensitivity(const PreparedScene& nominal, const DriveRobustness& drive, std::uint64_t rows,
                                      const RobustnessOptions& options, const Watch& watch = {});

/// The devices whose highest rebound is the 5, 50 and 95 % quantile of all, and how they close.
[[nodiscard]] std::vector<DeviceCourse> device_courses(const PreparedScene& nominal, const DriveRobustness& drive,
                                                       const Robustness& found, const RobustnessOptions& options);

/// How the first `devices` devices close until `end` [s], at `instants` instants; without those that cannot be described. Throws
/// Interrupted where `watch` asks to stop.
[[nodiscard]] GapCourses gap_courses(const PreparedScene& nominal, const DriveRobustness& drive, std::size_t devices,
                                     std::size_t instants, double end, const RobustnessOptions& options, const Watch& watch = {});

/// The scene of a device of that ensemble under one of its drives, with the errors of its sources written out: what `simulate`
/// runs to the same closing, as Ensemble::scene(), but for a sine whose times or volts are off (DeviceDrives::waveforms).
[[nodiscard]] SceneFile scene_of_device(const PreparedScene& nominal, const DriveRobustness& drive, std::size_t device,
                                        const RobustnessOptions& options);

namespace internal {

/// The statistics of these outcomes, by device.
[[nodiscard]] DriveRobustness summarised(NamedDrive drive, KnownUnits known, std::vector<DeviceOutcome> outcomes);
/// Shared by what looks closer at a drive of a Robustness.
[[nodiscard]] EnsembleRun run_of(const PreparedScene& nominal, const RobustnessOptions& options);
/// The drive, where measurements have no errors.
[[nodiscard]] EnsembleDrive exactly_measured(const PreparedScene& nominal, const DriveRobustness& drive);
/// The scene of the device with these values of the varying quantities; `device` is the number that the errors of its
/// measurements belong to.
[[nodiscard]] SceneFile scene_of_values(const Ensemble& ensemble, const DriveRobustness& drive, const std::vector<double>& values,
                                        std::uint64_t seed, std::size_t device);

}  // namespace internal
}  // namespace softland
