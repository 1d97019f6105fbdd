// The waveform families that a search can vary: variables, starting points, and the conversion of a point to a waveform and
// back. search_space.h lists the variables of each family.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "studies/search/search_space.h"
#include "studies/search/searched_trains.h"

namespace softland {

/// A waveform family: functions for the variables, the waveforms and the points of one drive.
struct SearchedFamily {
  std::string_view name;
  std::string_view waveform;  ///< type of the waveform family's waveforms in a scene file
  /// Default number of levels, knots (corners), pulses or sines, if the waveform family has such a number.
  std::size_t count = 0;
  void (*add)(DriveSearch&, const PreparedScene&, double first_touch);
  Waveform (*at)(const DriveSearch&, std::span<const double> x);
  std::optional<std::vector<double>> (*parameters)(const DriveSearch&, const Waveform&);
  internal::TrainRules train = {};  ///< restrictions of a waveform family that is a train of pulses
};

/// Returns all waveform families that a search can vary, in the order in which messages list them.
[[nodiscard]] std::span<const SearchedFamily> searched_families();
/// Returns the number after the name of a waveform family ("knots:8"), or the default `usual`, which is 0 for a family without
/// a number. Throws InvalidInput if the number is out of range.
[[nodiscard]] std::size_t number_of(const std::string& family, std::size_t usual);
/// Sets the waveform family of a drive, and the number of levels, knots, pulses or sines, from a text like "pulse" or
/// "knots:8". Throws InvalidInput if no family has that name.
void choose_family(DriveSearch& s, const std::string& text);

// Joint starting points: waveforms of all searched drives that close the switch by a single swing: the drives pull, then release,
// so that the contact point reaches the contact with zero velocity (swing.h). A pull after contact then keeps the switch closed.
// The search of several drives, or of a piezo, begins with these waveforms.
//
// The pulling electrode goes to its limits. The other drives use only shares of their ranges, since their full range would
// excite the higher modes. A piezo pulls and then lifts; an electrode on the far side (away from the contact) waits and then
// brakes.

/// Returns one waveform per drive for every share of the voltage ranges and every duration of the pull after contact for which
/// a single swing to the contact exists. None for a single electrode, whose waveform families have such starts themselves, and
/// none if the gas film is compressible.
[[nodiscard]] std::vector<DriveWaveforms> joint_rest_to_rest_starts(const PreparedScene& given, const SearchSpace& space);

}  // namespace softland
