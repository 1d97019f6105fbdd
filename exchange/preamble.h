// The lines above the numbers of an instrument's file: the sampling rate, the time of the first sample, the units.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/measure.h"

namespace softland::internal {

/// A number that a file says of its times beside them.
struct TimeClaim {
  enum class Of { interval, start, trigger_sample, centre, samples, period };
  Of of = Of::interval;
  std::string key;        ///< key as the file writes it
  double value = 0;       ///< [s], or a number of samples
  bool has_unit = false;  ///< the file says the unit of this number
};

/// The result of all lines above the numbers; nothing where the file does not say it.
struct Preamble {
  std::vector<TimeClaim> claims = {};         ///< claims in the order of the file, none of them twice
  std::optional<double> vertical_scale = {};  ///< per division
  std::optional<double> high = {}, low = {};  ///< voltages of the largest and the smallest code [V]
  std::optional<Unit> vertical_unit = {};
  std::optional<Unit> horizontal_unit = {};
  std::string source;  ///< name of the channel
  std::string text;    ///< the whole preamble in lower case, by which a format is known

  /// Takes what one line says: `cells` as separated in the file.
  void take_line(std::string_view line, const std::vector<std::string_view>& cells);
  /// Takes a key and its value, and returns whether it knows the key.
  bool take(std::string_view key, std::string_view value);
  /// The first claim of a kind, or none.
  [[nodiscard]] const TimeClaim* first(TimeClaim::Of of) const;
};

/// True if a line of cells is a key that is known, and a number or a unit as its value.
[[nodiscard]] bool is_setting(const std::vector<std::string_view>& cells);

/// The name of the format that a preamble and headings belong to, "Rigol CSV"; "columns" where it is none that is known.
[[nodiscard]] std::string_view format_of(std::string_view text);

}  // namespace softland::internal
