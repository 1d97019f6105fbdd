// Modes that another program computed, for people and programs, and as the table that a scene reads.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "exchange/mode_table.h"
#include "reports/origin.h"

namespace softland {

/// The findings of `softland modes` about a scene or a file.
struct ModesRecord {
  struct Mode {
    int number = 0;                   ///< number of the mode in the file
    double frequency = 0, share = 0;  ///< frequency [Hz]; share: see ModeFound
    std::string kind;
    std::string taken_as;  ///< "mode_2", its name in the table that a scene reads; empty for a mode that is left out
  };
  struct File {
    std::string summary;  ///< the file in one line
    std::string format;
    std::uint64_t nodes = 0;  ///< nodes of the mesh; 0 for a table
    double length = 0;        ///< length of the beam [m]
    std::vector<Mode> modes;
    std::vector<std::string> left_out, notes;
  };
  Origin origin;
  std::vector<double> frequencies;         ///< natural angular frequencies [rad/s]
  std::vector<std::string> warnings = {};  ///< warnings of the scene
  std::optional<File> file = {};
};
[[nodiscard]] ModesRecord record_of(const ModeTable& table, const std::string& command);
[[nodiscard]] nlohmann::json json_of(const ModesRecord& record);
[[nodiscard]] ModesRecord read_modes(const nlohmann::json& from);
/// Returns a line about the file, and a table of the modes.
[[nodiscard]] std::string text_of(const ModesRecord& record);

/// Returns x_m,width_m,rest_offset_m,mode_1,... in m and 1/sqrt(kg), below the header the row frequency_Hz; every digit. A
/// width that is not known stays empty.
[[nodiscard]] std::string mode_table_csv(const ModeTable& table);

/// Returns a static SVG document with a chart per mode. The chart of a mode that is taken shows its places in the file as dots,
/// and the line of a closing between them, which is clamped at the first place. The chart of one that is left out shows how the
/// sections move along the direction of motion and across it, and how they twist, over the largest of them.
[[nodiscard]] std::string mode_table_svg(const ModeTable& table);

}  // namespace softland
