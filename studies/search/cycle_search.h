// The search for the closing and the opening waveform of a switch that is cycled at a rate: together, since each begins with the
// vibration that the other one leaves.
//
// A waveform for the closing alone is found first (optimize.h). Then pulses are found that brake the opening (brake_pulses.h), so
// that the contact point hardly swings in the last third of the time that is left for it. Then both are improved together. The
// cost of a pair is that of its worst cycle, of the first ones in a run from rest: of the closing as in every search
// (objectives/cost.h), scored until the command to open. What does not close, or is closed at the end of a cycle, costs more than
// all that do. Drives keep the limits of [driver.*].
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
  double rate = 0;    ///< [Hz]
  double duty = 0.5;  ///< share of a cycle before its command to open
  Aim target = Target::bounce;
  Actuator actuator = Actuator::electrostatic;  ///< drives that both waveforms may shape
  std::string family = {};                      ///< families of the closing: families_of(); empty: the usual ones
  long max_evaluations = 3000;                  ///< a third each for the closing, the opening, and both
  std::size_t cycles = 10;                      ///< simulated cycles of the pair that is found
  std::uint64_t seed = 1;
  int jobs = 1;
};

struct CycleSearchResult {
  PreparedScene given;
  Cycling cycling;                           ///< the cycles of the plain pair, and of the best where there is one
  std::string family;                        ///< family of the closing waveform
  std::map<std::string, double> parameters;  ///< parameters of the best, by closing.drive.name and opening.drive.name
  double cost = std::numeric_limits<double>::quiet_NaN();        ///< cost of the best pair
  double plain_cost = std::numeric_limits<double>::quiet_NaN();  ///< cost of the plain pair
  long evaluations = 0;                                          ///< evaluations of pairs
  /// The scene of one cycle of the best pair: it closes, and opens on command. It is the plain pair's if no pair was feasible.
  SceneFile scene;
  bool interrupted = false;

  [[nodiscard]] bool is_better() const { return cost < plain_cost; }
};

/// Throws InvalidInput as optimize() does, for a scene without an open state, and for a rate at which no waveform of the family
/// fits into its part of a cycle.
[[nodiscard]] CycleSearchResult search_cycle(const SceneFile& file, const CycleSearchOptions& options,
                                             const Progress& progress = {});

}  // namespace softland
