// Reads the table of vibration modes that softland writes (CSV). Internal to exchange/.
#pragma once

#include <string>
#include <string_view>

#include "exchange/mode_table.h"

namespace softland::internal {

/// Returns true if a text has the header of a table of modes, with columns x_m and mode_1.
[[nodiscard]] bool is_mode_csv(std::string_view text);
/// Reads a table of vibration modes. Its columns are x_m, optionally width_m and rest_offset_m, then mode_1, mode_2 ... The
/// first row, frequency_Hz, has the frequencies of the modes; each further row has the shapes at one position.
[[nodiscard]] ModeTable read_mode_csv(std::string_view text, const std::string& file);

}  // namespace softland::internal
