// Reads [spread], the process variation of a scene, into distributions. Internal to config/.
#pragma once

#include "config/scene.h"
#include "config/scene_file_impl.h"

namespace softland::internal {

/// Reads [spread], the process variation, into scene.spread; call it after all other sections are read. Throws InvalidInput.
void read_spread(Scene& scene, const SceneFile::Impl& file);

/// Returns [spread], the process variation, with every default written out, and the values of a file instead of its name; empty
/// without [spread].
[[nodiscard]] toml::table resolved_spread(const SceneFile::Impl& file);

}  // namespace softland::internal
