// The families of waveforms that a search can vary: their variables, their starting points, and the conversion of a point to a
// waveform and back. search_space.h lists what they vary.
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

/// A family: what a search can vary of a drive.
struct SearchedFamily {
  std::string_view name;
  std::string_view waveform;  ///< the family of a scene that it makes
  std::size_t count = 0;      ///< default number of levels, knots, pulses or sines, if the family has a choice
  void (*add)(DriveSearch&, const PreparedScene&, double first_touch);
  Waveform (*at)(const DriveSearch&, std::span<const double> x);
  std::optional<std::vector<double>> (*parameters)(const DriveSearch&, const Waveform&);
  internal::TrainRules train = {};  ///< rules of a train of pulses
};

/// All families, in the order in which they are listed.
[[nodiscard]] std::span<const SearchedFamily> searched_families();
/// The number after the name of a family ("knots:8"), or the usual one, which is 0 if the family has none. Throws InvalidInput
/// if it is out of range.
[[nodiscard]] std::size_t number_of(const std::string& family, std::size_t usual);
/// Sets the family of a drive, and its number of levels, knots, pulses or sines: "pulse", "knots:8". Throws InvalidInput if no
/// family has that name.
void choose_family(DriveSearch& s, const std::string& text);

}  // namespace softland
