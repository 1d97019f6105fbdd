// Finds the measurable figures of a device that determine its waveform. One or two figures predict the factors of voltage and
// time that a waveform needs on a device. The devices are then closed with the predicted factors.
//
//   best factors   (s_V, s_t) of device k minimise  s_k + (ln s_V)^2 + (ln s_t)^2,   s_k its score for `bounce` (robust_cost.h)
//                  under V(t) = s_V V_0(t / s_t), with the scene's own waveform V_0 (the recipe). Nelder and Mead's simplex
//                  starts from the factors that the device's Vdp and period give. If the recipe drives a piezo, its voltages
//                  have a separate factor s_p, which starts at the ratio of nominal to own deflection per volt and contact gap.
//   predicted      ln s = a + sum_i b_i ln x_i, with the figures x_i of the device. Least squares over one half of the devices
//   factors        give a and b_i for the other half, and vice versa.
//
// The score is flat if a device already closes without a bounce, and the best factors would be arbitrary. The squared
// logarithms select the smallest change of the waveform that closes it without a bounce; they are too small to make a soft
// closing bounce. The same figures predict all factors, so that the fit does not depend on the relative weight of the errors of
// the factors. Only simulated closings judge a prediction: figures are ranked by the 95th percentile of the scores of all
// devices, each with factors fitted to the other half.
//
// Closing times are measured under steps to multiples of the nominal device's Vdp, with the same voltages for all devices. Each
// figure has a measurement error, both in the fit and in the prediction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "studies/devices/robustness.h"

namespace softland {

/// A figure that can be measured on a device.
struct MeasurableFigure {
  std::string name;    ///< name of the figure, such as "Vdp" or "time at 1.25 Vdp"
  std::string unit;    ///< SI unit of the figure
  double nominal = 0;  ///< value of the figure on the nominal device [unit]
  double error = 0;    ///< relative standard deviation of the error with which the figure is measured
  /// Values of the figure by device, without error [unit]; NaN if the device does not have the figure.
  std::vector<double> values;
};

/// Results of devices whose factors are predicted from one or several figures.
struct Prediction {
  std::string name;
  /// Indices in IdentificationStudy::figures of the figures from which the factors are predicted.
  std::vector<std::size_t> figures;
  /// Errors of the predicted logarithms of the best factors of volts, of time and of a piezo's volts. A `miss` is the root mean
  /// square over the devices to which the prediction was not fitted; `unexplained` is its square over the variance of the best
  /// factor's logarithm. NaN if nothing is fitted, and for a piezo that the waveform does not drive.
  double volts_miss = Metrics::unset, time_miss = Metrics::unset, piezo_miss = Metrics::unset;
  double volts_unexplained = Metrics::unset, time_unexplained = Metrics::unset, piezo_unexplained = Metrics::unset;
  /// True if closings with the predicted factors were simulated; only then are `score` and the members after it set.
  bool is_judged = false;
  double score = Metrics::unset;  ///< 95th percentile over the devices of the score s_k (top of this file)
  Yield bounce_free;
  EstimatedQuantile impact_speed;    ///< 95th percentile over the devices of the largest impact velocity of all touches [m/s]
  EstimatedQuantile rebound_height;  ///< 95th percentile over the devices of the highest rebound [m]
};

struct IdentificationOptions {
  std::uint64_t samples = 256;
  std::uint64_t seed = 1;
  int jobs = 1;  ///< number of threads; does not change the result
  /// Levels of the steps whose closing times are measured, as multiples of the nominal Vdp.
  std::vector<double> steps{1.1, 1.25, 1.5};
  double pull_in_error = 0, static_pull_in_error = 0, release_error = 0, frequency_error = 0, piezo_error = 0, time_error = 0;
};

struct IdentificationStudy {
  std::vector<MeasurableFigure> figures;
  std::vector<DeviceUnits> best;  ///< best factors of the waveform by device; NaN if no factors close the device
  /// Results with factors from no figures, from Vdp and period, from all figures, and with the best factors.
  std::vector<Prediction> references;
  /// Results with factors from single figures and pairs, the best first; predictions without simulated closings last.
  std::vector<Prediction> predictions;
  std::size_t devices = 0;
  bool spread_assumed = false;  ///< true if the scene does not describe the process variation and the usual one is assumed
  bool drives_piezo = false;    ///< true if the waveform drives a piezo, whose voltages then have a separate factor
  bool interrupted = false;
};

inline constexpr std::uint64_t fewest_measured = 16, most_measured = 100'000;

/// Finds the figures that determine a device's waveform. Assumes the usual process variation if the scene has none. Throws
/// InvalidInput for a scene without contact, or without an electrode that pulls in; for a waveform that is a plain step, which
/// cannot close the switch softly; for a number of devices (`samples`) outside [fewest_measured, most_measured]. Throws
/// Interrupted if `progress` asks to stop before the best factors of all devices are known.
[[nodiscard]] IdentificationStudy identify(SceneFile file, const IdentificationOptions& options, const Progress& progress = {});

}  // namespace softland
