// The choices that a scene leaves to softland: modes = "auto" and effects = "auto". Each repeats the closing of a scene that is
// prepared already, and gives one that is prepared anew.
#pragma once

#include "base/watch.h"
#include "studies/closing/prepared.h"

namespace softland {

/// The scene with as many modes as its closing needs, then without the effects that do not matter, and a warning for each choice
/// that says so; a scene that leaves none comes back as it is. `default_limits` as in prepare(). Throws as prepare() does, and
/// Interrupted where `watch` asks to stop.
[[nodiscard]] PreparedScene choose(PreparedScene prepared, bool default_limits = false, const Watch& watch = {});

/// What a user's scene asks for: prepare(), then choose(); and a warning where more modes move its static pull-in voltages
/// (by_modes.h).
[[nodiscard]] PreparedScene prepare_and_choose(const SceneFile& file, bool default_limits = false, const Watch& watch = {});

}  // namespace softland
