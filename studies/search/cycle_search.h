// The search for the closing and the opening waveform of a switch that is cycled at a rate. Both waveforms are searched
// together, since each begins with the residual vibration of the other.
//
// A waveform for the closing alone is found first (optimize.h). Then pulses are found that brake the opening (opening.h),
// so that the contact point hardly swings in the last third of the open part of a cycle. Then both waveforms are improved
// together. A pair of waveforms is simulated for the first few cycles from rest, and costs as much as the worst of their
// closings (objectives/cost.h), scored until the command to open. A pair that does not close, or is closed at the end of a
// cycle, costs more than every pair that closes and opens. Drives stay within the limits of [driver.*].
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>

#include "base/progress.h"
#include "config/scene.h"
#include "objectives/cost.h"
#include "optimizers/problem.h"
#include "studies/closing/actuator.h"
#include "studies/devices/cycling.h"

namespace softland {

struct CycleSearchOptions {
  double rate = 0;    ///< rate at which the switch is cycled [Hz]
  double duty = 0.5;  ///< share of a cycle before the command to open the switch
  Aim target = Target::bounce;
  Actuator actuator = Actuator::electrostatic;  ///< drives whose waveforms are searched
  std::string family = {};  ///< waveform families of the closing waveform, as for families_of(); empty: default families
  /// Number of simulated candidates: a third each for the closing, the opening, and both together.
  long max_evaluations = 3000;
  std::size_t cycles = 10;  ///< number of cycles over which the best pair of waveforms is simulated
  std::uint64_t seed = 1;
  int jobs = 1;
};

struct CycleSearchResult {
  PreparedScene given;
  /// Simulated cycles with the plain pair (step to close, step to open), and with the best pair if there is one.
  Cycling cycling;
  std::string family;  ///< waveform family of the closing waveform
  /// Waveform parameters of the best pair, by key: closing.drive.name, opening.drive.name.
  std::map<std::string, double> parameters;
  double cost = std::numeric_limits<double>::quiet_NaN();        ///< cost of the best pair of waveforms
  double plain_cost = std::numeric_limits<double>::quiet_NaN();  ///< cost of the plain pair: a step to close and a step to open
  long evaluations = 0;                                          ///< number of evaluated pairs of waveforms
  /// The scene of one cycle, a closing and an opening on command, of the best pair of waveforms; of the plain pair if no pair
  /// was feasible.
  SceneFile scene;
  bool interrupted = false;

  [[nodiscard]] bool is_better() const { return cost < plain_cost; }
};

/// Searches the waveforms of a cycle. Throws the exceptions of optimize(), and InvalidInput for a scene without an open state,
/// and for a rate at which no waveform of the waveform family fits into the closed or the open part of a cycle.
[[nodiscard]] CycleSearchResult search_cycle(const SceneFile& file, const CycleSearchOptions& options,
                                             const Progress& progress = {});

}  // namespace softland
