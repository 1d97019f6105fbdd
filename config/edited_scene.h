// Replaces numbers in the text of a scene and preserves its comments, order and units.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/scene.h"

namespace softland {

/// A new value for a key of a scene that holds one quantity, or for an element of a list.
struct SceneEdit {
  std::string path;         ///< path of the key in the scene, such as "structure.thickness"
  std::size_t element = 0;  ///< number of the list element that changes, from 1; 0 for a key without a list
  Quantity value;
  std::string remark = {};  ///< comment to add to the line of the key; empty for none
};

/// Returns the scene's text with the new values, each in the unit of the value that it replaces, to ten digits. A missing key
/// is added to its section in the SI unit; a missing section is added at the end of the text. `name` is the name of the text
/// in messages. Throws InvalidInput for a text that is not TOML, and for a key to be added to an inline table.
[[nodiscard]] std::string edited_scene(std::string_view text, const std::string& name, const std::vector<SceneEdit>& edits);

/// Returns the text of a scene with the section [spread] (process variation) of another scene, which replaces an existing
/// [spread] or is added at the end. Throws InvalidInput if an existing spread has no header [spread] or [spread.NAME].
[[nodiscard]] std::string with_spread_of(std::string_view text, const std::string& name, const SceneFile& other);

}  // namespace softland
