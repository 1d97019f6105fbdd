// What stands above the numbers of an instrument's file: how often it took a sample, when the first one was, in which unit.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/measure.h"

namespace softland::internal {

/// What is known after all lines above the numbers; NaN, 0 or nothing where the file does not say it.
struct Preamble {
  std::optional<double> interval = {};        ///< between samples [s]
  std::optional<double> start = {};           ///< time of the first sample [s]
  std::optional<double> trigger_sample = {};  ///< number of the sample at t = 0
  std::optional<double> centre = {};          ///< time of the middle of the record [s]
  std::optional<double> samples = {};         ///< how many there should be
  std::optional<double> period = {};          ///< that the samples are [s]
  std::optional<double> frequency = {};       ///< of the period that the samples are [Hz]
  std::optional<double> vertical_scale = {};  ///< per division
  std::optional<double> high = {}, low = {};  ///< that the largest and the smallest code stand for [V]
  std::optional<Unit> vertical_unit = {};
  std::optional<Unit> horizontal_unit = {};
  std::string source;  ///< name of the channel
  std::string text;    ///< all of it, lower case, by which a format is known

  /// Takes what one line says: `cells` as separated in the file.
  void take_line(std::string_view line, const std::vector<std::string_view>& cells);
  /// Takes a key and its value. What it does not know says nothing.
  void take(std::string_view key, std::string_view value);
};

/// Whether a line of cells is a key that is known, and a number or a unit as its value.
[[nodiscard]] bool is_setting(const std::vector<std::string_view>& cells);

/// The name of the format that a preamble and headings belong to, "Rigol CSV"; "columns" where it is none that is known.
[[nodiscard]] std::string_view format_of(std::string_view text);

}  // namespace softland::internal
