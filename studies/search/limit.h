// The limit that no drive waveform can beat: the least time in which a switch can make first contact at no more than a given
// speed, within the voltages of its voltage sources. No closing can be quicker than its first contact, so that this time is a
// lower bound for every waveform family. Robustness and the time after the contact cost further time. The bound holds for the
// model with its number of modes: a waveform could gain from the further modes of a real beam.
//
// The contact point may cross the contact plane only at the end. The optimum is local: the better of two, found from the
// quickest single swing and from the motion under a given waveform. The swing is full pull, then full release, as a mass on a
// spring is stopped (Leus & Elata 2008, J. MEMS 17, 236). Through a thick film it is full pull alone; the touch is then slowed
// down in steps. Drives that the actuator does not vary are at their hold levels from t = 0 on.
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
  double impact_velocity = 1e-3;  ///< largest permitted speed of the contact point at the first contact [m/s]
  bool at_rest = false;           ///< true: all modes have to end at rest in the closed equilibrium
  double peak = std::numeric_limits<double>::infinity();  ///< largest permitted voltage of the pulling electrode [V]
  /// Waveforms of the drives, for example from a search. The optimum is also sought from the motion under these waveforms, if
  /// they make contact.
  DriveWaveforms start = {};
  Progress progress = {};
};

struct LeastTime {
  /// Outcome of the search for the least time. `done`: found; `no_contact`: the drives cannot bring the switch to its contact
  /// in one swing; `numerical_failure`: the optimum was not found, or a simulation of its waveforms gives another result;
  /// `interrupted`.
  Status status = Status::not_run;
  std::string message = {};
  bool from_start = false;                                 ///< true if the optimum was found from LeastTimeOptions::start
  double time = std::numeric_limits<double>::quiet_NaN();  ///< least time until the first contact [s]
  double impact_velocity = std::numeric_limits<double>::quiet_NaN();  ///< speed of the contact point at the first contact [m/s]
  /// If all modes must end at rest: largest permitted difference of a modal coordinate at first contact from its value in the
  /// closed equilibrium, in contact gaps.
  double distance = std::numeric_limits<double>::quiet_NaN();
  /// Largest permitted speed of the contact point at the first contact [m/s].
  double permitted = std::numeric_limits<double>::quiet_NaN();
  /// Permitted voltage of the controlled electrode [V]; NaN if no electrode is controlled.
  double peak = std::numeric_limits<double>::quiet_NaN();
  /// Time [s] and speed [m/s] of the first contact in a simulation of the closing under `waveforms`.
  double simulated_time = std::numeric_limits<double>::quiet_NaN(), simulated_velocity = simulated_time;
  /// Waveforms of the controlled drives. After first contact the drives pull fully for as long as the motion to the contact has
  /// taken.
  DriveWaveforms waveforms = {};
  ControlledCourse course = {};
};

/// Computes the least time of the first contact. Throws InvalidInput for a scene that FirstTouchProblem refuses.
[[nodiscard]] LeastTime least_time(const PreparedScene& prepared, const LeastTimeOptions& options);

/// Returns waveforms of the controlled drives that bring every mode to rest on the contact in about the least time. A drive
/// takes a ninth, or an eighteenth, of the first mode's period from one end of its range to the other, since jumps would excite
/// modes that the model neglects. The search of a piezo, or of several drives, begins with these waveforms. `impact_velocity`
/// is as in LeastTimeOptions. The list is empty if FirstTouchProblem refuses the switch, or for more than four modes, which
/// would take minutes.
[[nodiscard]] std::vector<DriveWaveforms> rest_to_rest_starts(const PreparedScene& prepared, Actuator actuator,
                                                              double impact_velocity, const Progress& progress);

/// A closing with the waveforms of least time until first contact. The drives then pull to keep the switch closed while its
/// modes decay (the catch), and end on the hold levels.
struct LimitLanding {
  LeastTime path = {};
  /// Time from first contact to the pull that keeps the switch closed (the catch); the drives are constant in this time [s].
  double catch_delay = 0;
  double catch_time = 0;                 ///< time from first contact until the drives go to the hold levels [s]; 0: no catch
  PreparedScene scene;                   ///< scene with the waveforms of the closing, read back from its text
  Closing closing;                       ///< closing, simulated over the whole simulated time of the scene
  std::vector<CheckingRun> checks = {};  ///< simulations of the closing with a tighter integrator and with more modes
  bool bounce_free = false;              ///< true if the contact settles without a significant rebound, also in `checks`
};

struct LimitOptions {
  Actuator actuator = Actuator::electrostatic;
  /// Permitted impact velocity [m/s]; none: 1 % of the impact velocity under the plain step.
  std::optional<double> impact_velocity = {};
  DriveWaveforms start = {};                  ///< waveforms from which the optimum is also sought: see LeastTimeOptions::start
  std::map<std::string, double> before = {};  ///< voltages of the drives of `start` before t = 0, if not 0 [V]
  bool curves = true;  ///< true: also compute least times for several peak voltages and permitted impact velocities
};

struct Limit {
  PreparedScene given;
  LimitOptions options;
  double impact_velocity = std::numeric_limits<double>::quiet_NaN();  ///< largest permitted impact velocity [m/s]
  ClosedState closed_state = {};                                      ///< state of the closed switch under the hold levels
  std::string hold_warning = {};  ///< warning if the hold levels do not keep the switch closed
  Metrics step;                   ///< figures of merit of the closing under the plain step
  /// Slow approach by which a drive can move the switch to its contact through stable equilibria; none if no drive can, or if
  /// the scene has no [spread].
  std::optional<StableApproach> approach = {};
  /// Impact velocity of a slow approach through stable equilibria in the time in which the contact force of the plain step gets
  /// steady: quasi_static_speed() [m/s].
  double quasi_static = std::numeric_limits<double>::quiet_NaN();
  LeastTime touch;  ///< least time of a first contact at the permitted impact velocity
  LeastTime rest;   ///< least time of a first contact with every mode at rest
  /// The quickest bounce-free closing; if no closing is bounce-free, that with the lowest rebound.
  std::optional<LimitLanding> landing;
  std::vector<LeastTime> over_peak, over_velocity;
  bool interrupted = false;
};

/// Computes the least closing time of any waveform. An interrupted run returns the results so far, or throws Interrupted before
/// the first result. Throws the exceptions of least_time(). Throws InvalidInput without a given impact velocity if the plain
/// step does not touch, for a controlled electrode that pulls away from the contact, and for a starting waveform at another
/// equilibrium than the scene.
[[nodiscard]] Limit limit(const SceneFile& file, const LimitOptions& options, const Progress& progress = {});

}  // namespace softland
