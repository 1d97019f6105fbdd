// The limit that no drive waveform can beat: the least time in which a switch can make first contact at no more than a given
// speed, within the voltages of its voltage sources. No closing can be quicker than its first contact, so that this time is a
// lower bound for every waveform family. Robustness and the time after the contact cost further time. The bound holds for the
// model with its number of modes: a waveform could gain from the further modes of a real beam.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/choice.h"
#include "base/progress.h"
#include "objectives/metrics.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/prepared.h"
#include "studies/closing/simulate.h"
#include "studies/devices/stable_approach.h"
#include "studies/search/least_time.h"
#include "studies/search/optimize.h"
#include "studies/search/search_space.h"

namespace softland {

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

/// The result for which a least time is computed first.
enum class LimitGoal { touch, quicker_landing, rest, over_velocity, over_peak };
inline constexpr auto limit_goals = std::to_array<Named<LimitGoal>>({{LimitGoal::touch, "touch"},
                                                                     {LimitGoal::quicker_landing, "quicker landing"},
                                                                     {LimitGoal::rest, "at rest"},
                                                                     {LimitGoal::over_velocity, "over impact velocity"},
                                                                     {LimitGoal::over_peak, "over peak voltage"}});
static_assert(is_complete<limit_goals>());

/// A search for a least time from one start. An optimum has one from the quickest swing, and one from a waveform that is given.
struct LimitAttempt {
  LimitGoal goal = LimitGoal::touch;
  LeastTime found = {};   ///< outcome of the search, without its waveforms
  bool accepted = false;  ///< true if it found the optimum, and no other start gave a lower time
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
  std::vector<LimitAttempt> attempts = {};  ///< all searches for least times, in the order of the work
  bool interrupted = false;
};

/// Computes the least closing time of any waveform. An interrupted run returns the results so far, or throws Interrupted before
/// the first result. Throws the exceptions of least_time(). Throws InvalidInput without a given impact velocity if the plain
/// step does not touch, for a controlled electrode that pulls away from the contact, and for a starting waveform at another
/// equilibrium than the scene.
[[nodiscard]] Limit limit(const SceneFile& file, const LimitOptions& options, const Progress& progress = {});

}  // namespace softland
