// Checks that every scene must pass, wherever its text comes from.
#pragma once

#include "config/scene.h"

namespace softland::fuzz {

/// Checks that writing and reading the scene gives the same scene, that both are accepted or refused alike, and that resolving
/// the resolved scene changes nothing.
void check_scene(const SceneFile& file);

}  // namespace softland::fuzz
