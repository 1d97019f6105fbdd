// [spread] of a scene: from text to distributions. Internal to config/.
#pragma once

#include "config/scene.h"
#include "config/scene_file_impl.h"

namespace softland::internal {

/// Sets scene.spread; everything else of the scene has been read. Throws InvalidInput.
void read_spread(Scene& scene, const SceneFile::Impl& file);

/// [spread] with every default written out, and the values of a file instead of its name; empty where there is none.
[[nodiscard]] toml::table resolved_spread(const SceneFile::Impl& file);

}  // namespace softland::internal
