// Reads the table of vibration modes of [structure] kind = "modes" from a file or from the scene itself. Internal to config/.
#pragma once

#include <string_view>
#include <vector>

#include "config/scene.h"
#include "config/section_reader.h"

namespace softland::internal {

/// Names of the keys that give the source of the modes and the format of their file.
namespace modal_keys {
inline constexpr std::string_view file = "file", axis = "axis", direction = "direction", length_unit = "length_unit",
                                  mass_unit = "mass_unit", mass = "mass", mass_normalised = "mass_normalised", clamp = "clamp",
                                  positions = "positions", frequencies = "frequencies", shapes = "shapes",
                                  rest_offsets = "rest_offsets", widths = "widths", far_anchor = "far_anchor";
}  // namespace modal_keys

/// Returns the keys of [structure] that describe the table of modes: its file, or frequencies, positions and shapes.
[[nodiscard]] std::vector<Key> modal_table_keys();

/// Sets the table of modes, length, width and number of modes of the structure. A file of another program adds a note to the
/// scene. Throws InvalidInput with key, file and rule for unreadable data and for keys that contradict each other or the file.
void read_modal_table(Scene& scene, const SectionReader& in);

/// Replaces the name of a file of modes in a scene by the table of modes itself, so that the scene needs no other file. The
/// written numbers read back to the same bits. Scenes with other structures are not changed.
void hold_table(toml::table& root, const Structure& structure);

}  // namespace softland::internal
