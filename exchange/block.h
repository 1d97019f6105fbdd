// The numbers of a file in columns, and what stands above them. Internal to exchange/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/layout.h"
#include "exchange/preamble.h"
#include "exchange/recording.h"

namespace softland::internal {

struct Block {
  std::vector<int> columns;                 ///< number of each column in the file, from 1
  std::vector<std::vector<double>> values;  ///< NaN where a number is missing
  std::vector<Missing> missing;
  std::vector<std::uint32_t> lines;       ///< line of each row
  std::vector<std::string> names, units;  ///< name and unit of each column, from above or in it; empty without any
  std::vector<int> digits;                ///< significant ones of the numbers of each column, of some rows
  bool has_headings = false;
  Preamble preamble;
  std::vector<std::string> left_out, notes;
};

/// The note about a last line without a line end.
inline constexpr std::string_view may_be_cut = "the last line has no line end: its last number may have been cut";

/// Columns of numbers below any lines. Throws InvalidInput with line, column and rule.
[[nodiscard]] Block read_block(std::string_view text, const Refusals& refusals, const ReadKeys& keys);

/// Rows that are channels, each with as many numbers: a name, and then numbers; or numbers alone. Nothing where the text is not
/// such rows. Throws InvalidInput for rows of other lengths.
[[nodiscard]] std::optional<Block> read_lying_rows(std::string_view text, const Refusals& refusals, const ReadKeys& keys);

}  // namespace softland::internal
