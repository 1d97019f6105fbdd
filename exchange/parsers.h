// Parsers of recorded files: columns of numbers, SPICE sources, value change dumps, Universal File Format. Internal to
// exchange/.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "exchange/recording.h"

namespace softland::internal {

/// Returns the kind of a file that cannot hold a recording, such as "a mesh" or "a picture"; empty for any other file.
[[nodiscard]] std::string refused_kind(std::string_view text);

/// Reads a recording from columns of numbers, or from channels written as rows of numbers.
[[nodiscard]] Recording read_columns(std::string_view text, const std::string& file, const ReadKeys& keys);

/// Returns true if a text holds the breakpoints of SPICE sources (PWL), not plain columns of numbers.
[[nodiscard]] bool is_spice_pwl(std::string_view text);
[[nodiscard]] Recording read_spice_pwl(std::string_view text, const std::string& file, const ReadKeys& keys);

/// Returns true if a text begins like a value change dump (VCD).
[[nodiscard]] bool is_vcd(std::string_view text);
[[nodiscard]] Recording read_vcd(std::string_view text, const std::string& file, const ReadKeys& keys);

/// Returns true if a file begins like a file of the Universal File Format.
[[nodiscard]] bool is_uff(std::string_view content);
[[nodiscard]] Recording read_uff(std::string_view content, const std::string& file, const ReadKeys& keys);

}  // namespace softland::internal
