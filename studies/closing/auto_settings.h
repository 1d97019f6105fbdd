// The choices that a scene leaves to softland: modes = "auto" and effects = "auto". Each choice simulates the closing of a
// prepared scene several times, and returns a newly prepared scene.
#pragma once

#include "base/progress.h"
#include "studies/closing/prepared.h"

namespace softland {

/// Returns the scene with as many modes as its closing needs, then without the effects that hardly change its figures. Adds a
/// warning for each choice. A scene without "auto" is returned unchanged. `default_limits` requires the pull-in voltages of all
/// electrodes, as in prepare(). Throws the exceptions of prepare(), and Interrupted if `progress` asks to stop.
[[nodiscard]] PreparedScene choose(PreparedScene prepared, bool default_limits = false, const Progress& progress = {});

/// Prepares a user's scene: prepare(), then choose(). Adds a warning if more modes change the static pull-in voltages
/// (by_modes.h).
[[nodiscard]] PreparedScene prepare_and_choose(const SceneFile& file, bool default_limits = false, const Progress& progress = {});

}  // namespace softland
