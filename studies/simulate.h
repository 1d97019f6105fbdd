// One closing, with figures of merit and their errors.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "model/closing.h"
#include "objectives/metrics.h"
#include "studies/prepared.h"

namespace softland {

struct Certificate;

struct Closing {
  Trajectory trajectory;
  Metrics metrics;
  /// Absolute error estimates, NaN where not estimated: the difference to a run at a hundredth of the tolerance, or what
  /// certify() makes of it.
  Metrics errors;
  double peak_voltage = 0;  ///< largest |V| of the electrodes' drives in the window, of the piezo where there is no electrode [V]
  double peak_slew = 0;     ///< largest |dV/dt| of any drive [V/s]; infinite for a jump
  std::vector<std::string> warnings;                    ///< of the scene, of the laws, and of ill-conditioned figures
  std::shared_ptr<const Certificate> certificate = {};  ///< from certify() only
};

/// Runs the scene's own waveforms. With `estimate_errors` a second, tighter run measures the error of each figure.
[[nodiscard]] Closing simulate(const Prepared& prepared, bool estimate_errors, const std::atomic<bool>* stop = nullptr);

}  // namespace softland
