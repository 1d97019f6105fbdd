// Which measurable figures of a device pin its waveform: how well the factors of voltage and of time that a recipe needs on a
// device can be told from one figure of it, or from two, and how the devices close with factors told so.
//
//   best factors   (s_V, s_t) of device k minimise  s_k + (ln s_V)^2 + (ln s_t)^2,   s_k its score for `bounce` (robust_cost.h)
//                  under V(t) = s_V V_0(t / s_t), the recipe V_0 being the scene's own drive; searched by Nelder and Mead's
//                  simplex from the device's own units (its Vdp, its period). Where the recipe drives a piezo, its voltages have
//                  a factor s_p of their own, from the device's own unit of it: what a volt deflects over the contact gap.
//   told factors   ln s = a + sum_i b_i ln x_i, least squares over one half of the devices, used on the other half, and vice
//   versa
//
// The score is flat where a device already lands softly, and there the best factors would be anything: the squares choose the
// smallest change of the waveform that lands it, and are too small to spoil a landing. All factors are fitted by the same
// figures, so that the fit is the same whatever the two misses are worth to each other. It is judged by closings alone: figures
// are ranked by the 95 % quantile of the score of the devices, all of them in the half that the factors were not fitted to.
//
// Closing times are those of steps to multiples of the nominal device's Vdp, the same volts for all devices. Figures are measured
// with errors of their own, in fitting and in use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "studies/devices/robustness.h"

namespace softland {

/// What can be measured of a device.
struct MeasurableFigure {
  std::string name;            ///< "Vdp", "time at 1.25 Vdp"
  std::string unit;            ///< SI
  double nominal = 0;          ///< of the nominal device [unit]
  double error = 0;            ///< of its measurement, relative, one standard deviation
  std::vector<double> values;  ///< by device, without error [unit]; NaN where a device does not have it
};

/// How devices do whose factors are told from these figures.
struct Prediction {
  std::string name;
  std::vector<std::size_t> figures;  ///< numbers in IdentificationStudy::figures
  /// Of the logarithms of the best factors of volts, of time and of a piezo's volts: their root mean square miss on devices that
  /// were not fitted to, and its square over their variance. NaN where nothing is fitted; of a piezo also where it is not driven.
  double volts_miss = Metrics::unset, time_miss = Metrics::unset, piezo_miss = Metrics::unset;
  double volts_unexplained = Metrics::unset, time_unexplained = Metrics::unset, piezo_unexplained = Metrics::unset;
  bool is_judged = false;         ///< the rest is known
  double score = Metrics::unset;  ///< 95 % quantile
  Yield bounce_free;
  EstimatedQuantile impact_speed;    ///< 95 %, largest of all touches [m/s]
  EstimatedQuantile rebound_height;  ///< 95 % [m]
};

struct IdentificationOptions {
  std::uint64_t samples = 256;
  std::uint64_t seed = 1;
  int jobs = 1;                               ///< threads; does not change the result
  std::vector<double> steps{1.1, 1.25, 1.5};  ///< whose closing times are measured, over the nominal Vdp
  double pull_in_error = 0, static_pull_in_error = 0, release_error = 0, frequency_error = 0, piezo_error = 0, time_error = 0;
};

struct IdentificationStudy {
  std::vector<MeasurableFigure> figures;
  std::vector<DeviceUnits> best;        ///< factors by device; NaN where none were found under which it closes
  std::vector<Prediction> references;   ///< nothing, own units, all figures, the best factors themselves
  std::vector<Prediction> predictions;  ///< single figures and pairs, the best first; those not judged last
  std::size_t devices = 0;
  bool spread_assumed = false;  ///< the scene says nothing of how devices differ
  bool drives_piezo = false;    ///< whose voltages then have a factor of their own
  bool interrupted = false;
};

inline constexpr std::uint64_t fewest_measured = 16, most_measured = 100'000;

/// Assumes a spread where the scene has none. Throws InvalidInput for a scene without contact, or an electrode that pulls in; for
/// one whose drive is the plain step, which has no landing to pin; and for samples outside [fewest_measured, most_measured].
/// Throws Interrupted where `watch` asks to stop before the best factors of all devices are known.
[[nodiscard]] IdentificationStudy identify(SceneFile file, const IdentificationOptions& options, const Watch& watch = {});

}  // namespace softland
