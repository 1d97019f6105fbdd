// The limit of what any drive waveform can do: the least time in which a switch can be brought to touch its contact at no more
// than a given speed, with the voltages that its drivers have. A landing cannot be quicker than its touch, so that this is a
// yardstick for every waveform, whatever its family; robustness and what happens after the touch come on top. It is one for the
// model with its number of modes: a beam has more, by which a waveform can gain.
//
// The contact point may cross its plane at the end only. The optimum is local: it begins with the quickest single swing (full
// pull, then full release, as a mass on a spring is stopped: Leus & Elata 2008, J. MEMS 17, 236) and is as good as any that was
// found from there, or from the flight under a waveform that is given. Drives that the actuator does not shape stand at their
// hold levels from t = 0 on.
#pragma once

#include <atomic>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/watch.h"
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
  double impact_velocity = 1e-3;                          ///< of the first touch, at most [m/s]
  bool at_rest = false;                                   ///< all modes at the closed equilibrium, not the contact point alone
  double peak = std::numeric_limits<double>::infinity();  ///< of the electrode that pulls, where it is less than its driver's [V]
  /// Waveforms of the drives, of a search for example: the optimum is looked for from their flight too, where that touches.
  DriveWaveforms start = {};
  Watch watch = {};
};

struct LeastTime {
  /// done; no_contact: the drives cannot bring the switch to its contact in one swing; numerical_failure: the optimum was not
  /// found, or a simulation of the waveform does not agree with it; interrupted.
  Status status = Status::not_run;
  std::string message = {};
  bool from_start = false;                                            ///< found from LeastTimeOptions::start
  double time = std::numeric_limits<double>::quiet_NaN();             ///< least time of the first touch [s]
  double impact_velocity = std::numeric_limits<double>::quiet_NaN();  ///< there [m/s]
  /// Of a landing at rest: how far any mode is from its place in the closed equilibrium, in contact gaps.
  double room = std::numeric_limits<double>::quiet_NaN();
  double permitted = std::numeric_limits<double>::quiet_NaN();  ///< speed [m/s]
  double peak = std::numeric_limits<double>::quiet_NaN();       ///< permitted [V]; NaN where no electrode is shaped
  /// By an integration of the closing under the waveforms, with the contact [s], [m/s].
  double simulated_time = std::numeric_limits<double>::quiet_NaN(), simulated_velocity = simulated_time;
  DriveWaveforms waveforms = {};  ///< of the drives that are shaped; from the touch on they pull
  ControlledCourse course = {};
};

/// Throws InvalidInput for a scene that the question does not fit (free_flight.h).
[[nodiscard]] LeastTime least_time(const PreparedScene& prepared, const LeastTimeOptions& options);

/// Waveforms of the drives that are shaped which bring every mode to rest on the contact, in about the least time for drives that
/// take a ninth, and an eighteenth, of the first mode's period from one end of their range to the other: without the jumps that
/// ring modes which the model leaves out. Where a search of a piezo, or of several drives, begins. `impact_velocity` as in
/// LeastTimeOptions. Those that are not found are left out; none where free_flight.h does not follow the switch, and of more
/// than four modes, which would take minutes.
[[nodiscard]] std::vector<DriveWaveforms> landings_at_rest(const PreparedScene& prepared, Actuator actuator,
                                                           double impact_velocity, const Watch& watch);

/// A landing under a waveform that begins as one of least time does. Then it goes on pulling, to keep the beam on its contact
/// while its modes ring down (the catch), and ends on the hold levels.
struct LimitLanding {
  LeastTime way = {};
  double catch_delay = 0;                  ///< from the touch until the pull, before which all is as at the touch [s]
  double catch_time = 0;                   ///< from the touch until the hold levels [s]; 0: held at once
  PreparedScene scene;                     ///< read back from its text
  Closing closing;                         ///< over the scene's whole window
  std::vector<ConfirmingRun> checks = {};  ///< by a tighter integrator and a richer beam
  bool bounce_free = false;                ///< settled without a significant rebound, in these runs too
};

struct LimitOptions {
  Actuator actuator = Actuator::electrostatic;
  std::optional<double> impact_velocity = {};  ///< permitted [m/s]; none: a hundredth of the plain step's
  DriveWaveforms start = {};                   ///< see LeastTimeOptions
  std::map<std::string, double> before = {};   ///< what the drives of `start` stand at before t = 0, where that is not 0 [V]
  bool curves = true;                          ///< over the peak voltage, and over the permitted speed
};

struct Limit {
  PreparedScene given;
  LimitOptions options;
  double impact_velocity = std::numeric_limits<double>::quiet_NaN();  ///< permitted [m/s]
  ClosedState closed_state = {};                                      ///< under the hold levels
  std::string hold_warning = {};                                      ///< where they do not keep the switch closed
  Metrics step;                                                       ///< of the plain step
  /// How the switch can be carried to its contact through stable equilibria on the devices of [spread]; none where it cannot be,
  /// or there is no [spread]. And the speed of that, in the time until the plain step's force is steady: quasi_static_speed().
  std::optional<StableApproach> approach = {};
  double quasi_static = std::numeric_limits<double>::quiet_NaN();  ///< [m/s]
  LeastTime touch;                                                 ///< at the permitted speed
  LeastTime rest;                                                  ///< with every mode at rest
  std::optional<LimitLanding> landing;  ///< the quickest without a rebound, else the one that rebounds least
  std::vector<LeastTime> over_peak, over_velocity;
  bool interrupted = false;
};

/// All of it. Asked to stop, it holds what there is. Throws InvalidInput as least_time(), where the plain step does not touch
/// and no speed is given, where the electrode that is shaped pulls away from the contact, and where a waveform to start with
/// begins at another rest; Interrupted before there is anything.
[[nodiscard]] Limit limit(const SceneFile& file, const LimitOptions& options, const Watch& watch = {});

}  // namespace softland
