// The least time in which a switch can make first contact at no more than a given speed, within the voltages of its voltage
// sources. The contact point may cross the contact plane only at the end. The optimum is local: the better of two, found from
// the quickest single swing and from the motion under a given waveform. The swing is full pull, then full release, as a mass on
// a spring is stopped (Leus & Elata 2008, J. MEMS 17, 236). Through a thick film it is full pull alone; the touch is then slowed
// down in steps. Drives that the actuator does not vary are at their hold levels from t = 0 on.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "base/choice.h"
#include "base/progress.h"
#include "optimizers/collocation.h"
#include "studies/closing/prepared.h"
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

/// The part of a search for a least time that began last.
enum class SearchStage { start, slower_touch, modes_to_rest, finer_controls, finer_mesh };
inline constexpr auto search_stages = std::to_array<Named<SearchStage>>({{SearchStage::start, "start"},
                                                                         {SearchStage::slower_touch, "slower touch"},
                                                                         {SearchStage::modes_to_rest, "modes to rest"},
                                                                         {SearchStage::finer_controls, "finer controls"},
                                                                         {SearchStage::finer_mesh, "finer mesh"}});
static_assert(is_complete<search_stages>());

struct LeastTime {
  /// Outcome of the search for the least time. `done`: found; `no_contact`: the drives cannot bring the switch to its contact
  /// in one swing; `numerical_failure`: the optimum was not found, or a simulation of its waveforms gives another result;
  /// `interrupted`.
  Status status = Status::not_run;
  std::string message = {};
  bool from_start = false;                                            ///< true if the search began from LeastTimeOptions::start
  SearchStage stage = SearchStage::start;                             ///< part of the search that began last
  int iterations = 0;                                                 ///< iterations of Ipopt, in all problems that it solved
  double time = std::numeric_limits<double>::quiet_NaN();             ///< least time until the first contact [s]
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

/// Returns the outcomes of the searches by which least_time() decides: that from the swing, then that from
/// LeastTimeOptions::start if this is given.
[[nodiscard]] std::vector<LeastTime> least_time_by_start(const PreparedScene& prepared, const LeastTimeOptions& options);
/// Returns the place of the outcome that least_time() returns among those of least_time_by_start().
[[nodiscard]] std::size_t place_of_least(const std::vector<LeastTime>& by_start);

/// Returns waveforms of the controlled drives that bring every mode to rest on the contact in about the least time. A drive
/// takes a ninth, or an eighteenth, of the first mode's period from one end of its range to the other, since jumps would excite
/// modes that the model neglects. The search of a piezo, or of several drives, begins with these waveforms. `impact_velocity`
/// is as in LeastTimeOptions. The list is empty if FirstTouchProblem refuses the switch, or for more than four modes, which
/// would take minutes.
[[nodiscard]] std::vector<DriveWaveforms> rest_to_rest_starts(const PreparedScene& prepared, Actuator actuator,
                                                              double impact_velocity, const Progress& progress);

}  // namespace softland
