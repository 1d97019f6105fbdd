// The table of modes that softland writes. Internal to exchange/.
#pragma once

#include <string>
#include <string_view>

#include "exchange/mode_table.h"

namespace softland::internal {

/// True if a text has the header of such a table: x_m and mode_1.
[[nodiscard]] bool is_mode_csv(std::string_view text);
/// x_m, width_m and rest_offset_m, which may be left out, and a column per mode; the row below says frequency_Hz.
[[nodiscard]] ModeTable read_mode_csv(std::string_view text, const std::string& file);

}  // namespace softland::internal
