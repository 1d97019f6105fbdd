// Modes that another program computed, for people and programs, and as the table that a scene reads.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "exchange/mode_table.h"

namespace softland {

/// {"format","nodes","length_m","natural_frequencies_rad_s":[],"modes":[{"number","frequency_Hz","kind","share","taken_as"}],
/// "left_out":[],"notes":[]}; `taken_as` is null of a mode that is left out.
[[nodiscard]] nlohmann::json mode_table_json(const ModeTable& table);

/// A line about the file, and a table of its modes.
[[nodiscard]] std::string mode_table_text(const ModeTable& table);

/// x_m,width_m,rest_offset_m,mode_1,... in m and 1/sqrt(kg), below the header the row frequency_Hz; every digit. A width that is
/// not known stays empty.
[[nodiscard]] std::string mode_table_csv(const ModeTable& table);

/// A static SVG document with a chart per mode. Of a mode that is taken: its places in the file as dots, and the line that a
/// closing takes between them, which is clamped at the first place. Of one that is left out by what it is: how the sections
/// move along the direction of motion and across it, and how they twist, over the largest of them.
[[nodiscard]] std::string mode_table_svg(const ModeTable& table);

}  // namespace softland
