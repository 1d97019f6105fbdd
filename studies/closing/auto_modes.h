// Chooses the number of modes that the closing of a scene needs, for modes = "auto".
//
// Modes are added until the figures stop moving. These are initial contact time, impact velocity and highest rebound within one
// period of the first mode after it (the first macro-bounce), under the scene's own waveforms. The static and dynamic pull-in
// voltages that the scene uses count as well. The chosen number of modes is the first that three further ones do not move by
// more than the tolerance. On the reference closing three to five modes agree within 2 % in the rebound height, and the sixth
// moves it by half. Between two clamps every second mode is antisymmetric, so six are tried. Twice and four times as many modes
// (by_modes.h) must not move static pull-in, release and collapse voltages by more, nor disagree about the stability of the
// closed state. A figure counts relative to its own size, but at least to a hundredth of the scale of a closing (contact gap,
// and that times the first frequency).
#pragma once

#include <string>

#include "base/watch.h"
#include "config/scene.h"

namespace softland {

inline constexpr double auto_modes_tolerance = 0.03;

struct AutoModes {
  int modes = 0;
  bool touches = true;  ///< the judged closing touches
  double moved = 0;     ///< largest relative change of a figure by further modes
  [[nodiscard]] bool settled() const { return moved <= auto_modes_tolerance; }
  /// The note about it in a result.
  [[nodiscard]] std::string note() const;
};

/// Returns the chosen number, or the largest number that can be judged if nothing settles up to the most modes. Throws as
/// prepare() does.
[[nodiscard]] AutoModes choose_modes(const SceneFile& file, const Watch& watch = {});

}  // namespace softland
