// Parsers of one kind of content each. Internal to exchange/.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "exchange/recording.h"

namespace softland::internal {

/// Why a content is no record over time though it is of a known kind: a mesh, a picture; empty where it is not known.
[[nodiscard]] std::string refused_kind(std::string_view text);

/// Columns, or rows, of numbers.
[[nodiscard]] Recording read_columns(std::string_view text, const std::string& file, const ReadKeys& keys);

/// True if a text is breakpoints as sources of SPICE have them, rather than columns of plain numbers.
[[nodiscard]] bool is_spice_pwl(std::string_view text);
[[nodiscard]] Recording read_spice_pwl(std::string_view text, const std::string& file, const ReadKeys& keys);

/// Returns whether a text begins as a value change dump.
[[nodiscard]] bool is_vcd(std::string_view text);
[[nodiscard]] Recording read_vcd(std::string_view text, const std::string& file, const ReadKeys& keys);

/// True if bytes begin as the Universal File Format does.
[[nodiscard]] bool is_uff(std::string_view content);
[[nodiscard]] Recording read_uff(std::string_view content, const std::string& file, const ReadKeys& keys);

}  // namespace softland::internal
