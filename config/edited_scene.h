// The text of a scene with other numbers in it: comments, sources, order and units of what is written stay.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/scene.h"

namespace softland {

/// A key of one quantity, or an element of a list of them, that gets another value.
struct SceneEdit {
  std::string path;         ///< "structure.thickness"
  std::size_t element = 0;  ///< of a list, counted from 1; 0: the key is none
  Quantity value;
  std::string remark = {};  ///< becomes a comment at the end of its line, before it what was written; empty: none
};

/// The value in the unit that is written there, to ten digits. A key that is not written is added to its section, or with its
/// section at the end, in the SI unit. `name` stands for the text in messages. Throws InvalidInput for a text that is no TOML,
/// and where a key cannot be added because its section is an inline table.
[[nodiscard]] std::string edited_scene(std::string_view text, const std::string& name, const std::vector<SceneEdit>& edits);

/// The text with the section [spread] of another scene in the place of its own, or at the end. Throws InvalidInput where its own
/// is no section under a header.
[[nodiscard]] std::string with_spread_of(std::string_view text, const std::string& name, const SceneFile& other);

}  // namespace softland
