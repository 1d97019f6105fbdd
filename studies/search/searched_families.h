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
  std::string_view waveform;  ///< type of the waveforms in a scene file
  std::size_t count = 0;      ///< default number of levels, knots, pulses or sines, if the family has such a number
  void (*add)(DriveSearch&, const PreparedScene&, double first_touch);
  Waveform (*at)(const DriveSearch&, std::span<const double> x);
  std::optional<std::vector<double>> (*parameters)(const DriveSearch&, const Waveform&);
  internal::TrainRules train = {};  ///< restrictions of a family that is a train of pulses
};

/// All waveform families, in the order in which messages list them.
[[nodiscard]] std::span<const SearchedFamily> searched_families();
/// The number after the name of a family ("knots:8"), or the default `usual`, which is 0 for a family without a number. Throws
/// InvalidInput if the number is out of range.
[[nodiscard]] std::size_t number_of(const std::string& family, std::size_t usual);
/// Sets the waveform family of a drive, and the number of levels, knots, pulses or sines, from a text like "pulse" or
/// "knots:8". Throws InvalidInput if no family has that name.
void choose_family(DriveSearch& s, const std::string& text);

}  // namespace softland
