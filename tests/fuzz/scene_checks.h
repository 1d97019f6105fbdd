// Checks that hold of every scene that was read, whatever it was read from.
#pragma once

#include "config/scene.h"

namespace softland::fuzz {

/// The scene written and read again is the same, is taken or refused alike, and its resolved form resolves to itself.
void check_scene(const SceneFile& file);

}  // namespace softland::fuzz
