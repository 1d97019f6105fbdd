// The families of waveforms that a search can vary: what their variables are, where a search of them begins, and the way from a
// point to a waveform and back. search_space.h says what they vary.
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

/// What a search can vary of a drive.
struct SearchedFamily {
  std::string_view name;
  std::string_view waveform;  ///< the family of a scene that it makes
  std::size_t count = 0;      ///< of levels, knots, pulses or sines, where there is a choice, if it is not given
  void (*add)(DriveSearch&, const PreparedScene&, double first_touch);
  Waveform (*at)(const DriveSearch&, std::span<const double> x);
  std::optional<std::vector<double>> (*parameters)(const DriveSearch&, const Waveform&);
  internal::TrainRules train = {};  ///< of a family that is a train of pulses
};

/// All of them, in the order in which they are listed.
[[nodiscard]] std::span<const SearchedFamily> searched_families();
/// The number that stands behind the name of a family, or the usual one, which is 0 where the family has none: "knots:8". Throws
/// InvalidInput where it is out of range.
[[nodiscard]] std::size_t number_of(const std::string& family, std::size_t usual);
/// Sets the family of a drive, and its number of levels, knots, pulses or sines: "pulse", "knots:8". Throws InvalidInput where
/// there is none.
void choose_family(DriveSearch& s, const std::string& text);

}  // namespace softland
