// The limit of all drive waveforms: the least time in which a switch can make first contact at no more than a given speed,
// within the voltages of its drivers. No closing can be quicker than its first contact, so that this time is a lower bound for
// every waveform family. Robustness and the time after the contact cost further time. The bound holds for the model with its
// number of modes: a waveform could gain from the further modes of a real beam.
//
// The contact point may cross the contact plane only at the end. The optimum is local: the better of two, found from the
// quickest single swing and from the motion under a given waveform. The swing is full pull, then full release, as a mass on a
// spring is stopped (Leus & Elata 2008, J. MEMS 17, 236). Drives that the actuator does not vary are at their hold levels from
// t = 0 on.
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
  double impact_velocity = 1e-3;                          ///< largest permitted speed of the first contact [m/s]
  bool at_rest = false;                                   ///< true: all modes have to end in the closed equilibrium, at rest
  double peak = std::numeric_limits<double>::infinity();  ///< largest voltage of the pulling electrode [V]
  /// Waveforms of the drives, for example from a search. The optimum is also sought from the motion under these waveforms, if
  /// they make contact.
  DriveWaveforms start = {};
  Progress progress = {};
};

struct LeastTime {
  /// done; no_contact: the drives cannot bring the switch to its contact in one swing; numerical_failure: the optimum was not
  /// found, or a simulation of its waveforms gives another result; interrupted.
  Status status = Status::not_run;
  std::string message = {};
  bool from_start = false;                                 ///< true if the optimum was found from LeastTimeOptions::start
  double time = std::numeric_limits<double>::quiet_NaN();  ///< least time of the first contact [s]
  double impact_velocity = std::numeric_limits<double>::quiet_NaN();  ///< speed of the first contact [m/s]
  /// For a first contact at rest: largest difference of a modal coordinate from its value in the closed equilibrium, in contact
  /// gaps.
  double distance = std::numeric_limits<double>::quiet_NaN();
  double permitted = std::numeric_limits<double>::quiet_NaN();  ///< permitted speed of the first contact [m/s]
  double peak = std::numeric_limits<double>::quiet_NaN();  ///< permitted voltage of the controlled electrode [V]; NaN without a
                                                           ///< controlled electrode
  /// Time [s] and speed [m/s] of the first contact in a simulation of the closing under `waveforms`.
  double simulated_time = std::numeric_limits<double>::quiet_NaN(), simulated_velocity = simulated_time;
  DriveWaveforms waveforms = {};  ///< waveforms of the controlled drives, which keep pulling after the first contact
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
  double catch_delay = 0;                ///< time from first contact to the pull; the drives stay constant meanwhile [s]
  double catch_time = 0;                 ///< time from first contact to the hold levels [s]; 0: without a catch
  PreparedScene scene;                   ///< scene with the waveforms, read back from its text
  Closing closing;                       ///< closing, simulated over the whole window of the scene
  std::vector<CheckingRun> checks = {};  ///< simulations with a tighter integrator and with more modes
  bool bounce_free = false;              ///< settles without a significant rebound, also in `checks`
};

struct LimitOptions {
  Actuator actuator = Actuator::electrostatic;
  std::optional<double> impact_velocity = {};  ///< permitted impact velocity [m/s]; none: 1 % of that under the plain step
  DriveWaveforms start = {};                   ///< starting waveforms: see LeastTimeOptions::start
  std::map<std::string, double> before = {};   ///< voltages of the drives of `start` before t = 0, if not 0 [V]
  bool curves = true;                          ///< true: computes least times as functions of peak voltage and of permitted
                                               ///< impact velocity
};

struct Limit {
  PreparedScene given;
  LimitOptions options;
  double impact_velocity = std::numeric_limits<double>::quiet_NaN();  ///< permitted impact velocity [m/s]
  ClosedState closed_state = {};                                      ///< closed equilibrium under the hold levels
  std::string hold_warning = {};  ///< warning if the hold levels do not keep the switch closed
  Metrics step;                   ///< figures of merit of the plain step
  /// How a drive can move the switch to its contact through stable equilibria on the devices of [spread]; none if no drive can,
  /// or without [spread].
  std::optional<StableApproach> approach = {};
  double quasi_static =
      std::numeric_limits<double>::quiet_NaN();  ///< impact speed of the stable approach within the time until the plain step's
                                                 ///< force is steady: quasi_static_speed() [m/s]
  LeastTime touch;                               ///< least time of a first contact at the permitted impact velocity
  LeastTime rest;                                ///< least time of a first contact with every mode at rest
  std::optional<LimitLanding> landing;           ///< the quickest bounce-free closing; if there is none, the closing with the
                                                 ///< lowest rebound
  std::vector<LeastTime> over_peak, over_velocity;
  bool interrupted = false;
};

/// Computes the limit. An interrupted run returns the results so far, or throws Interrupted before the first result. Throws
/// InvalidInput as least_time() does, if the plain step does not touch and no impact velocity is given, if the controlled
/// electrode pulls away from the contact, and if a given waveform begins at another equilibrium.
[[nodiscard]] Limit limit(const SceneFile& file, const LimitOptions& options, const Progress& progress = {});

}  // namespace softland
