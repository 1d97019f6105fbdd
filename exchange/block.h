// Reads the columns of numbers of an instrument file, and the lines above the numbers. Internal to exchange/.
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
  std::vector<int> columns;                 ///< number of each column of numbers in the file, from 1
  std::vector<std::vector<double>> values;  ///< numbers by column and row; NaN where a number is missing
  std::vector<Missing> missing;
  std::vector<std::uint32_t> lines;  ///< line of the file in which each row is
  std::vector<std::string> names,
      units;                ///< name and unit of each column, from its heading or its cells; empty without a heading
  std::vector<int> digits;  ///< number of significant digits in each column, from some of its numbers
  bool has_headings = false;
  Preamble preamble;
  std::vector<std::string> left_out, notes;
};

/// Note for the user about a file whose last line has no line end.
inline constexpr std::string_view may_be_cut = "the last line has no line end: its last number may have been cut";

/// Reads the columns of numbers of a file, and the headings and settings in the lines above them. Throws InvalidInput with
/// line, column and the broken rule.
[[nodiscard]] Block read_block(std::string_view text, const Refusals& refusals, const ReadKeys& keys);

/// Reads a text in which every channel is a row of numbers, with or without a name in front. Returns none for any other text.
/// Throws InvalidInput for rows of different lengths.
[[nodiscard]] std::optional<Block> read_lying_rows(std::string_view text, const Refusals& refusals, const ReadKeys& keys);

}  // namespace softland::internal
