// The searched families that are one train: pulses of a level and a duration each, between which the switch may coast, by edges
// of one length, and then the hold level. The restrictions of each family stand in its row of searched_families.cc.
//
// A point is level_1 ... level_N, duration_1 ... duration_N, coast_1 ... and edge. A drive that brakes waits before each of its
// pulses instead of coasting after them.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "studies/search/search_space.h"
#include "studies/search/searched_shapes.h"

namespace softland::internal {

/// The restrictions of a family on its train.
struct TrainRules {
  std::size_t pulses = 0;              ///< 0: as many as requested, and none for other families
  bool coasts = false;                 ///< between two pulses there is no voltage
  std::array<double, 3> longest = {};  ///< durations, in first touches of the plain step; the last one holds for all later pulses
  double longest_edge = 0.1;           ///< longest edge, in periods of the first mode
  std::string_view first_duration = "duration_1_s";
};

/// A pulse of these levels and then the hold level. The durations are at least those of its edges, which are as long as the
/// driver asks for.
[[nodiscard]] Waveform pulse_of(const DriveSearch& s, std::span<const double> levels, std::span<const double> durations,
                                double edge);

void add_pulse(DriveSearch& s, const PreparedScene& p, double t0);
/// Adds a throw, a coast, and a level that holds fast.
void add_catch(DriveSearch& s, const PreparedScene& p, double t0);
void add_staircase(DriveSearch& s, const PreparedScene& p, double t0);
void add_coast(DriveSearch& s, const PreparedScene& p, double t0);
/// Adds pulses: the first throws the switch, the second holds it fast on its contact; those after it hold on.
void add_pulses(DriveSearch& s, const PreparedScene& p, double t0);
[[nodiscard]] Waveform train_at(const DriveSearch& s, std::span<const double> x);
[[nodiscard]] Parameters of_train(const DriveSearch& s, const Waveform& waveform);

}  // namespace softland::internal
