// The search for a waveform that opens a closed switch without leaving it to swing: the other half of a switching cycle.
//
// The switch rests on its contact under the scene's hold levels until t = 0. The plain opening takes every drive to 0 V at once,
// or as fast as its source can; a beam without much damping then swings about its open position with the contact gap for
// amplitude, for as long as its gas takes. The search brakes it: every drive that the actuator may shape gives two pulses, each
// after a wait at 0 V, within the limits of [driver.*], and then stays at 0 V. An undamped plate under a constant pull is brought
// to rest by one pulse (Pontryagin; on the way back the bang-bang landing of bang_bang.h); the second one is for the modes that
// still ring.
//
// Minimised is the residual vibration over the contact gap, what of it leaves the band five times on top, and three tenths of
// the time until the switch is open for good in periods of its first mode. The winner is believed only after a run over the whole
// window at the scene's accuracy; runs by a tighter integrator and with two more modes confirm it.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/watch.h"
#include "model/trajectory.h"
#include "objectives/opening.h"
#include "optimizers/problem.h"
#include "studies/closing/prepared.h"
#include "studies/search/search_space.h"

namespace softland {

struct OpeningOptions {
  Actuator actuator = Actuator::electrostatic;  ///< drives that may brake
  double band = 0.05;                           ///< of the contact gap: nearer to its open position the switch counts as open
  long max_evaluations = 3000;
  std::uint64_t seed = 1;
  int jobs = 1;
  std::uint64_t devices = 200;  ///< of the spread, that the waveform is judged on; 0: none
};

/// An opening under some signals, one per drive of the switch.
struct Opening {
  std::vector<Signal> signals = {};
  double voltages_end = std::numeric_limits<double>::quiet_NaN();  ///< from when on all drives stand at 0 V [s]
  Trajectory trajectory;
  OpeningFigures figures;
};

struct ConfirmingOpening {
  std::string name;  ///< "tolerance 1e-9", "6 modes"
  OpeningFigures figures;
};

/// How devices open that differ as the scene says, or in the usual way (config/assumed_spread.h), whose sources do not err. They
/// are held closed, and open, by the volts of the nominal one. One that does not stay open counts as infinite.
struct DeviceOpenings {
  double open = 0;     ///< share that is open for good at the end of the window
  double in_band = 0;  ///< share that is in the band from the moment that the drives stand
  double settling_time = 0, residual_vibration = 0, overshoot = 0;  ///< 95 % quantiles [s], [m], [m]
};
struct OpeningsOnDevices {
  std::uint64_t devices = 0;  ///< that can be described and are held closed
  bool spread_assumed = false;
  DeviceSpread spread = {};  ///< that they are of
  DeviceOpenings plain, best;
};

struct OpeningResult {
  PreparedScene given;
  OpeningOptions options;
  double open_position = 0;   ///< of the contact point with all drives at 0 V [m]
  double band = 0;            ///< [m]
  double contact_force = 0;   ///< that holds the switch closed before t = 0 [N]
  double window = 0;          ///< [s]
  std::vector<double> holds;  ///< of the drives before t = 0 [V]
  Opening plain;
  std::optional<Opening> best;               ///< none where no waveform opens the switch
  std::map<std::string, double> parameters;  ///< of the best, by drive.name
  /// The waveforms of the best opening, as the drives are told, from their hold levels on; in volts. Else those of the plain one.
  std::optional<SceneFile> scene;
  std::vector<ConfirmingOpening> checks;
  std::optional<OpeningsOnDevices> on_devices;  ///< none where that was not asked for, or no waveform opens the switch
  OptimizerResult search;
  bool better = false;     ///< than the plain opening: sooner open for good, or, where neither is, with less vibration
  bool goal_met = false;   ///< in the band from the moment that the drives stand
  bool confirmed = false;  ///< in the other runs too
  bool interrupted = false;
};

/// Throws InvalidInput for a scene without contact or without an open or a closed equilibrium under its hold levels, for an
/// actuator that it lacks or whose drives have no limits, and options out of range; Interrupted before there is anything.
/// Numerical trouble is in the result.
[[nodiscard]] OpeningResult search_opening(const SceneFile& file, const OpeningOptions& options, const Watch& watch = {});

}  // namespace softland
