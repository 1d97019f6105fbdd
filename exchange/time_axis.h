// Finds the times of the rows of a file, from its column of times and from its preamble, which must agree. Internal to
// exchange/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exchange/layout.h"
#include "exchange/measure.h"
#include "exchange/preamble.h"
#include "exchange/recording.h"

namespace softland::internal {

/// A column that holds times or sample numbers.
struct TimeColumn {
  const std::vector<double>& raw;
  const Missing& missing;
  std::string name;               ///< name without a unit
  std::optional<Unit> unit = {};  ///< unit that the column or its heading names
  int column = 0;                 ///< number in the file, from 1
  int digits = 0;                 ///< significant digits of its numbers
  const std::vector<std::uint32_t>& lines;
};

struct RowTimes {
  std::vector<double> times = {};       ///< times [s]; empty if the file has neither times nor an interval
  std::optional<double> interval = {};  ///< interval that the file states [s]
  bool stand_in_file = false;           ///< true if the file has the times, false if they follow from the interval
  bool have_unit = false;
  double last_digit = 0;  ///< unit of the last digit of the times in the file [s]
  std::vector<std::string> notes = {};
};

/// Returns the times of `count` rows. Throws InvalidInput if two statements of the file differ by more than an interval; the
/// message names both and the keys that decide. `keys.interval` or `keys.uneven` decides in advance.
[[nodiscard]] RowTimes times_of_rows(const TimeColumn* column, std::size_t count, const Preamble& preamble, const ReadKeys& keys,
                                     const Refusals& refusals);

}  // namespace softland::internal
