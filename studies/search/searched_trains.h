// The searched waveform families that are one pulse train: pulses of a level and a duration each, with coasting between pulses
// in some families, then the hold level; all edges have one duration. searched_families.cc has the restrictions of each family.
//
// The parameters of a train are level_1 ... level_N, duration_1 ... duration_N, coast_1 ... and edge. A drive that brakes the
// beam waits before each of its pulses instead of coasting after them.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "studies/search/search_space.h"
#include "studies/search/searched_shapes.h"

namespace softland::internal {

/// The restrictions of a waveform family on its pulse train.
struct TrainRules {
  std::size_t pulses = 0;  ///< number of pulses; 0: given by the user, or not a pulse train
  bool coasts = false;     ///< true: the drive has no voltage between two pulses
  /// Longest durations of the pulses, as multiples of the plain step's time of first contact; the last entry also applies to
  /// later pulses.
  std::array<double, 3> longest = {};
  double longest_edge = 0.1;  ///< longest edge of the pulses, in periods of the first mode
  std::string_view first_duration = "duration_1_s";
};

/// Returns a waveform with the given levels and durations, then the hold level. All edges have the duration `edge`, or a longer
/// one that the slew limit of the voltage source requires. No duration of a level is shorter than an edge.
[[nodiscard]] Waveform pulse_of(const DriveSearch& s, std::span<const double> levels, std::span<const double> durations,
                                double edge);

void add_pulse(DriveSearch& s, const PreparedScene& p, double t0);
/// Adds variables and starting points of the waveform family catch: a strong initial pulse, a coast, and a level that presses
/// the switch on its contact before the hold level.
void add_catch(DriveSearch& s, const PreparedScene& p, double t0);
void add_staircase(DriveSearch& s, const PreparedScene& p, double t0);
void add_coast(DriveSearch& s, const PreparedScene& p, double t0);
/// Adds variables and starting points of a waveform family of pulses: the first accelerates the switch, all others press it on
/// its contact.
void add_pulses(DriveSearch& s, const PreparedScene& p, double t0);
[[nodiscard]] Waveform train_at(const DriveSearch& s, std::span<const double> x);
[[nodiscard]] Parameters of_train(const DriveSearch& s, const Waveform& waveform);

}  // namespace softland::internal
