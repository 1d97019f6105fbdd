// Finds the times of the rows of a recorded file, from its column of times and from its preamble, which must agree. Internal to
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

/// A column of a file that holds times or sample numbers.
struct TimeColumn {
  const std::vector<double>& raw;
  const Missing& missing;
  std::string name;               ///< name of the column of times without the unit
  std::optional<Unit> unit = {};  ///< unit of the times that the column or its heading names
  int column = 0;                 ///< number of the column in the file, from 1
  int digits = 0;                 ///< significant digits of the times in the column
  const std::vector<std::uint32_t>& lines;
};

struct RowTimes {
  std::vector<double> times = {};       ///< times of the rows [s]; empty if the file has neither times nor an interval
  std::optional<double> interval = {};  ///< sampling interval that the file states [s]
  bool stand_in_file = false;           ///< true if the file holds the times, false if they are computed from the interval
  bool have_unit = false;
  double last_digit = 0;  ///< resolution of the times: value of their last written digit [s]
  std::vector<std::string> notes = {};
};

/// Returns the times of `count` rows of a file. Throws InvalidInput if two statements of the file differ by more than a
/// sampling interval; the message names both, and the keys by which the user decides. With `keys.interval` or `keys.uneven`,
/// the user has decided, and such statements are not compared.
[[nodiscard]] RowTimes times_of_rows(const TimeColumn* column, std::size_t count, const Preamble& preamble, const ReadKeys& keys,
                                     const Refusals& refusals);

}  // namespace softland::internal
