// Lanes of four numbers, which a processor with vector instructions processes at once. Arrays of any size are padded to whole
// lanes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace softland {

inline constexpr std::size_t lanes = 4;
using Lane = Eigen::Array<double, lanes, 1>;

/// Returns the values, filled up with the number `idle` to a multiple of four, the size of a lane.
[[nodiscard]] inline std::vector<double> padded_to_lanes(std::vector<double> values, double idle) {
  values.resize((values.size() + lanes - 1) / lanes * lanes, idle);
  return values;
}

/// Returns the lane (four numbers) of a padded array that begins at index `begin`.
inline Eigen::Map<Lane> lane(std::vector<double>& values, std::size_t begin) { return Eigen::Map<Lane>(values.data() + begin); }
inline Eigen::Map<const Lane> lane(const std::vector<double>& values, std::size_t begin) {
  return Eigen::Map<const Lane>(values.data() + begin);
}

/// Loads a lane (four numbers) of an array of `size` numbers; numbers beyond the end of the array are 0. An incomplete lane is
/// loaded number by number: a vector load of numbers that were just stored one by one would have to wait for these stores.
[[nodiscard]] inline Lane load_lane(const double* from, std::size_t begin, std::size_t size) {
  if (begin + lanes <= size) return Eigen::Map<const Lane>(from + begin);
  const std::size_t left = size - begin;
  from += begin;
  return {from[0], left > 1 ? from[1] : 0, left > 2 ? from[2] : 0, 0};
}
inline void store_lane(const Lane& lane, double* to, std::size_t begin, std::size_t size) {
  to += begin;
  if (begin + lanes <= size) {
    Eigen::Map<Lane>{to} = lane;
    return;
  }
  const std::size_t left = size - begin;
  to[0] = lane[0];
  if (left > 1) to[1] = lane[1];
  if (left > 2) to[2] = lane[2];
}

}  // namespace softland
