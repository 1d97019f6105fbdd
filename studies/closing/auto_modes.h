// modes = "auto": how many modes the closing of a scene needs.
//
// Modes are added until the figures stop moving: initial contact time, impact velocity and highest rebound within one period of
// the first mode after it (the first macro-bounce), under the scene's own waveforms, and the static and dynamic pull-in voltages
// that the scene uses. The first number of modes is taken that three further ones do not move by more than the tolerance: on the
// reference closing three to five modes agree within 2 % in the rebound height, and the sixth moves it by half. Between two
// clamps every second mode is antisymmetric, so six are tried. Nor may twice and four times as many modes (by_modes.h) move
// static pull-in, release and pull-through voltages by more, or say otherwise of whether the closed state is stable. A figure
// counts relative to its own size, but at least to a hundredth of what a closing is like (contact gap, and that times the first
// frequency).
#pragma once

#include <string>

#include "base/watch.h"
#include "config/scene.h"

namespace softland {

inline constexpr double auto_modes_tolerance = 0.03;

struct AutoModes {
  int modes = 0;
  bool touches = true;  ///< the closing that is judged
  double moved = 0;     ///< the most that further modes move a figure, relative
  [[nodiscard]] bool settled() const { return moved <= auto_modes_tolerance; }
  /// What a result says about it.
  [[nodiscard]] std::string note() const;
};

/// Where nothing settles up to the most modes there are, the largest number that can be judged. Throws as prepare() does.
[[nodiscard]] AutoModes choose_modes(const SceneFile& file, const Watch& watch = {});

}  // namespace softland
