// Intervals of allowed values.
#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace softland {

/// An interval in SI units; an open end is not part of the interval.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_open = false;
  bool most_open = false;

  [[nodiscard]] constexpr bool contains(double value) const {
    return (least_open ? value > least : value >= least) && (most_open ? value < most : value <= most);
  }
  /// Returns the rule for a value of the range as text: "must be in [1 pm, 1 m]" or "must be in [0, 1)".
  [[nodiscard]] std::string rule(std::string_view unit) const;
  [[nodiscard]] constexpr bool operator==(const Range&) const = default;
};

inline constexpr Range positive{.least = 0, .least_open = true};
inline constexpr Range below_one{.least = 0, .most = 1, .most_open = true};

}  // namespace softland
