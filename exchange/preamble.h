// Reads the preamble of an instrument file, the lines above the numbers: sampling rate, time of the first sample, units.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/measure.h"

namespace softland::internal {

/// The statement of a key in the preamble (lines above the numbers) about the times, such as the sampling interval or the
/// number of samples.
struct TimeClaim {
  enum class Of { interval, start, trigger_sample, centre, samples, period };
  Of of = Of::interval;
  std::string key;        ///< key in the file that makes the statement, such as "Sample Interval"
  double value = 0;       ///< number that the preamble states: a time [s], or a count of samples
  bool has_unit = false;  ///< true if the file gives a unit with the stated number
};

/// The content of a preamble, the lines above the numbers. Members that the file does not give are empty.
struct Preamble {
  std::vector<TimeClaim> claims = {};  ///< statements about the times, in the order of the file, without repetition
  /// Size of a vertical division of the oscilloscope's screen [unit of the channel].
  std::optional<double> vertical_scale = {};
  std::optional<double> high = {}, low = {};  ///< voltages of the largest and smallest integer code of the samples [V]
  std::optional<Unit> vertical_unit = {};
  std::optional<Unit> horizontal_unit = {};
  std::string source;  ///< name of the recorded channel
  std::string text;    ///< the whole preamble in lower case, by which the format is recognised

  /// Reads one line of the preamble; `cells` are its cells, split by the separator of the file.
  void take_line(std::string_view line, const std::vector<std::string_view>& cells);
  /// Reads a key of the preamble and its value; returns false for an unknown key.
  bool take(std::string_view key, std::string_view value);
  /// Returns the first statement about the times of a kind, such as the interval; null without such a statement.
  [[nodiscard]] const TimeClaim* first(TimeClaim::Of of) const;
};

/// Returns true if a line is a known key of a preamble with a number or a unit as its value.
[[nodiscard]] bool is_setting(const std::vector<std::string_view>& cells);

/// Returns the name of the format of a preamble and headings, such as "Rigol CSV"; "columns" for an unknown format.
[[nodiscard]] std::string_view format_of(std::string_view text);

}  // namespace softland::internal
