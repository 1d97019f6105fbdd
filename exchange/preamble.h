// Reads the preamble of an instrument file, the lines above the numbers: sampling rate, time of the first sample, units.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/measure.h"

namespace softland::internal {

/// A statement of the preamble about the times, such as the interval or the number of samples.
struct TimeClaim {
  enum class Of { interval, start, trigger_sample, centre, samples, period };
  Of of = Of::interval;
  std::string key;        ///< key as the file writes it
  double value = 0;       ///< [s], or a number of samples
  bool has_unit = false;  ///< true if the file gives the unit of this number
};

/// The content of a preamble. Members that the file does not give are empty.
struct Preamble {
  std::vector<TimeClaim> claims = {};         ///< statements about the times, in the order of the file, without repetition
  std::optional<double> vertical_scale = {};  ///< size of a vertical division [unit of the channel]
  std::optional<double> high = {}, low = {};  ///< voltages of the largest and the smallest code [V]
  std::optional<Unit> vertical_unit = {};
  std::optional<Unit> horizontal_unit = {};
  std::string source;  ///< name of the channel
  std::string text;    ///< the whole preamble in lower case, by which the format is recognised

  /// Reads one line; `cells` are its cells as separated in the file.
  void take_line(std::string_view line, const std::vector<std::string_view>& cells);
  /// Reads a key and its value; returns false for an unknown key.
  bool take(std::string_view key, std::string_view value);
  /// Returns the first statement of a kind; null without such a statement.
  [[nodiscard]] const TimeClaim* first(TimeClaim::Of of) const;
};

/// Returns true if a line is a known key with a number or a unit as its value.
[[nodiscard]] bool is_setting(const std::vector<std::string_view>& cells);

/// Returns the name of the format of a preamble and headings, such as "Rigol CSV"; "columns" for an unknown format.
[[nodiscard]] std::string_view format_of(std::string_view text);

}  // namespace softland::internal
