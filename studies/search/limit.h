// The limit of all drive waveforms: the least time in which a switch can touch its contact at no more than a given speed,
// within the voltages of its drivers. A landing cannot be quicker than its touch, so that this bounds every waveform, whatever
// its family. Robustness and the time after the touch come on top. The bound holds for the model with its number of modes: a
// beam has more, by which a waveform can gain.
//
// The contact point may cross its plane at the end only. The optimum is local. It begins with the quickest single swing: full
// pull, then full release, as a mass on a spring is stopped (Leus & Elata 2008, J. MEMS 17, 236). It is the best that was found
// from there, or from the flight under a given waveform. Drives that the actuator does not shape stand at their hold levels
// from t = 0 on.
#pragma once

#include <atomic>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "objectives/metrics.h"
#include "optimizers/collocation.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/prepared.h"
#include "studies/closing/simulate.h"
#include "studies/devices/stable_approach.h"
#include "studies/search/optimize.h"
#include "studies/search/search_space.h"

namespace softland {

struct LeastTimeOptions {
  Actuator actuator = Actuator::electrostatic;
  double impact_velocity = 1e-3;                          ///< largest speed of the first touch [m/s]
  bool at_rest = false;                                   ///< all modes reach the closed equilibrium
  double peak = std::numeric_limits<double>::infinity();  ///< peak of the pulling electrode, if below its driver's [V]
  /// Waveforms of the drives, of a search for example: the optimum is also sought from their flight, if that touches.
  DriveWaveforms start = {};
  Progress progress = {};
};

struct LeastTime {
  /// done; no_contact: the drives cannot bring the switch to its contact in one swing; numerical_failure: the optimum was not
  /// found, or a simulation of the waveform disagrees with it; interrupted.
  Status status = Status::not_run;
  std::string message = {};
  bool from_start = false;                                            ///< found from LeastTimeOptions::start
  double time = std::numeric_limits<double>::quiet_NaN();             ///< least time of the first touch [s]
  double impact_velocity = std::numeric_limits<double>::quiet_NaN();  ///< speed of that touch [m/s]
  /// Largest distance of any mode from its place in the closed equilibrium, in contact gaps, for a landing at rest.
  double distance = std::numeric_limits<double>::quiet_NaN();
  double permitted = std::numeric_limits<double>::quiet_NaN();  ///< permitted speed [m/s]
  double peak = std::numeric_limits<double>::quiet_NaN();       ///< permitted peak [V]; NaN if no electrode is shaped
  /// Touch time [s] and speed [m/s] by an integration of the closing under the waveforms, with the contact.
  double simulated_time = std::numeric_limits<double>::quiet_NaN(), simulated_velocity = simulated_time;
  DriveWaveforms waveforms = {};  ///< waveforms of the shaped drives; from the touch on they pull
  ControlledCourse course = {};
};

/// Throws InvalidInput for a scene that first_touch_problem.h does not follow.
[[nodiscard]] LeastTime least_time(const PreparedScene& prepared, const LeastTimeOptions& options);

/// Waveforms of the shaped drives that bring every mode to rest on the contact in about the least time. A drive takes a ninth,
/// or an eighteenth, of the first mode's period from one end of its range to the other: without the jumps that ring modes which
/// the model leaves out. The search of a piezo, or of several drives, begins with them. `impact_velocity` is as in
/// LeastTimeOptions. Those that are not found are left out. None if first_touch_problem.h does not follow the switch, or if it
/// has more than four modes, which would take minutes.
[[nodiscard]] std::vector<DriveWaveforms> rest_to_rest_starts(const PreparedScene& prepared, Actuator actuator,
                                                              double impact_velocity, const Progress& progress);

/// A landing under a waveform that begins as one of least time does. It then goes on pulling, to keep the beam on its contact
/// while its modes ring down (the catch), and ends on the hold levels.
struct LimitLanding {
  LeastTime path = {};
  double catch_delay = 0;                ///< time from the touch to the pull; the drives stay as at the touch [s]
  double catch_time = 0;                 ///< time from the touch to the hold levels [s]; 0: held at once
  PreparedScene scene;                   ///< scene that is read back from its text
  Closing closing;                       ///< closing over the scene's whole window
  std::vector<CheckingRun> checks = {};  ///< runs with a tighter integrator and a richer beam
  bool bounce_free = false;              ///< settles without a significant rebound, in these runs too
};

struct LimitOptions {
  Actuator actuator = Actuator::electrostatic;
  std::optional<double> impact_velocity = {};  ///< permitted speed [m/s]; none: a hundredth of the plain step's
  DriveWaveforms start = {};                   ///< see LeastTimeOptions
  std::map<std::string, double> before = {};   ///< voltages of the drives of `start` before t = 0, if not 0 [V]
  bool curves = true;                          ///< computes curves over the peak voltage and the permitted speed
};

struct Limit {
  PreparedScene given;
  LimitOptions options;
  double impact_velocity = std::numeric_limits<double>::quiet_NaN();  ///< permitted speed [m/s]
  ClosedState closed_state = {};                                      ///< closed state under the hold levels
  std::string hold_warning = {};                                      ///< warning if they do not keep the switch closed
  Metrics step;                                                       ///< figures of the plain step
  /// How the switch can be carried to its contact through stable equilibria on the devices of [spread]; none without such a
  /// path or without [spread]. Its speed is that within the time until the plain step's force is steady.
  std::optional<StableApproach> approach = {};
  double quasi_static = std::numeric_limits<double>::quiet_NaN();  ///< speed of that path: quasi_static_speed() [m/s]
  LeastTime touch;                                                 ///< least time at the permitted speed
  LeastTime rest;                                                  ///< least time with every mode at rest
  std::optional<LimitLanding> landing;  ///< the quickest bounce-free landing, else the one that rebounds least
  std::vector<LeastTime> over_peak, over_velocity;
  bool interrupted = false;
};

/// Computes the limit. A run that is asked to stop returns the results so far. Throws InvalidInput as least_time(). Throws it
/// if the plain step does not touch and no speed is given, if the shaped electrode pulls away from the contact, or if a given
/// waveform begins at another rest. Throws Interrupted before the first result.
[[nodiscard]] Limit limit(const SceneFile& file, const LimitOptions& options, const Progress& progress = {});

}  // namespace softland
