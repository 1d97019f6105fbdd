// The times of the rows of a file: its column of times, and all that it says beside them, which must agree. Internal to
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

/// A column that is times, or numbers the samples.
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
  std::vector<double> times = {};       ///< [s]; empty where the file has none and says no interval
  std::optional<double> interval = {};  ///< interval that the file states [s]
  bool stand_in_file = false;           ///< true if the file has the times, false if they follow from the interval
  bool have_unit = false;
  double last_digit = 0;  ///< [s]
  std::vector<std::string> notes = {};
};

/// The times of `count` rows. Throws InvalidInput where two sources disagree by more than an interval, with the names of both and
/// the keys that decide; `keys.interval` and `keys.uneven` have decided.
[[nodiscard]] RowTimes times_of_rows(const TimeColumn* column, std::size_t count, const Preamble& preamble, const ReadKeys& keys,
                                     const Refusals& refusals);

}  // namespace softland::internal
