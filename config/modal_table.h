// Reads the table of modes that [structure] kind = "modes" names or holds. Internal to config/.
#pragma once

#include <string_view>
#include <vector>

#include "config/scene.h"
#include "config/section_reader.h"

namespace softland::internal {

/// Names of the keys for the place of the modes, and for the reading of their file.
namespace modal_keys {
inline constexpr std::string_view file = "file", axis = "axis", direction = "direction", length_unit = "length_unit",
                                  mass_unit = "mass_unit", mass = "mass", mass_normalised = "mass_normalised", clamp = "clamp",
                                  positions = "positions", frequencies = "frequencies", shapes = "shapes",
                                  rest_offsets = "rest_offsets", widths = "widths", far_anchor = "far_anchor";
}  // namespace modal_keys

/// Returns these keys, which stand before the fields of a ModalStructure.
[[nodiscard]] std::vector<Key> modal_table_keys();

/// Sets table, length, width and the number of modes of the structure; data from a file of another program becomes a note of
/// the scene. Throws InvalidInput with key, file and rule for unreadable data, and for a structure that is not a beam of
/// constant width.
void read_modal_table(Scene& scene, const SectionReader& in);

/// Puts the table itself where a scene names its file, so that the scene needs no other file: it reads back to the same bits.
/// Other structures stay as they are.
void hold_table(toml::table& root, const Structure& structure);

}  // namespace softland::internal
