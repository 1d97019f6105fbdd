// Reports the modes that another program computed, and writes the table of modes that a scene reads.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "exchange/mode_table.h"
#include "reports/origin.h"

namespace softland {

/// The results of `softland modes` for a scene or a file of modes.
struct ModesRecord {
  struct Mode {
    int number = 0;  ///< number of the mode in the file of modes
    /// Frequency of the mode [Hz]; share of the squared motion of all nodes that is of the mode's kind: bending, in-plane, ...
    double frequency = 0, share = 0;
    std::string kind;
    std::string taken_as;  ///< name in the table that a scene reads, such as "mode_2"; empty for a mode that is left out
  };
  struct File {
    std::string summary;  ///< the file of modes described in one line
    std::string format;
    std::uint64_t nodes = 0;  ///< number of nodes of the mesh; 0 for a table of modes
    double length = 0;        ///< length of the beam in the file of modes [m]
    std::vector<Mode> modes;
    std::vector<std::string> left_out, notes;
  };
  Origin origin;
  std::vector<double> frequencies;         ///< natural angular frequencies of the modes [rad/s]
  std::vector<std::string> warnings = {};  ///< warnings of the scene whose modes are reported
  std::optional<File> file = {};
};
[[nodiscard]] ModesRecord record_of(const ModeTable& table, const std::string& command);
/// Names the members of the JSON.
void members(internal::Archive& a, ModesRecord& record);
[[nodiscard]] nlohmann::json json_of(const ModesRecord& record);
[[nodiscard]] ModesRecord read_modes(const nlohmann::json& from);
/// Returns text: a line about the file of modes, and a table of its modes.
[[nodiscard]] std::string text_of(const ModesRecord& record);

/// Returns the table of modes as CSV x_m,width_m,rest_offset_m,mode_1,... in m and 1/sqrt(kg), with the row frequency_Hz below
/// the header. Numbers have all digits; an unknown width is empty.
[[nodiscard]] std::string mode_table_csv(const ModeTable& table);

/// Returns a static SVG document with a chart per mode. The chart of a mode in the table has dots at the positions in the file,
/// and a line for the interpolation in a closing, clamped at the first position. The chart of a mode that is left out has the
/// displacements of the sections along and across the direction of motion and their twist, divided by the largest.
[[nodiscard]] std::string mode_table_svg(const ModeTable& table);

}  // namespace softland
