// Chooses the number of modes that the closing of a scene needs, for modes = "auto".
//
// The chosen number is the smallest one at which three further modes change no figure by more than the tolerance. The figures,
// under the scene's own waveforms, are
// - initial contact time, impact velocity, and the highest rebound within one period of the first mode after first touch;
// - the static and dynamic pull-in voltages that the scene uses;
// - the static pull-in, release and collapse voltages, which are compared at twice and four times as many modes (by_modes.h).
// These larger numbers of modes must also agree about the stability of the closed state. Fewer than three further modes do not
// suffice: on the reference closing three to five modes agree within 2 % in the rebound height, but the sixth changes it by
// half. A beam that is clamped at both ends is compared with six further modes, since every second mode is antisymmetric.
//
// The change of a figure is relative to its own size, but at least to a hundredth of its scale in a closing (contact gap,
// contact gap times first angular frequency).
#pragma once

#include <string>

#include "base/progress.h"
#include "config/scene.h"

namespace softland {

inline constexpr double auto_modes_tolerance = 0.03;

struct AutoModes {
  int modes = 0;
  bool touches = true;  ///< true if the closing touches in its window
  double moved = 0;     ///< largest relative change of a figure with further modes
  [[nodiscard]] bool settled() const { return moved <= auto_modes_tolerance; }
  /// Returns the sentence about the choice that a result holds.
  [[nodiscard]] std::string note() const;
};

/// Returns the chosen number of modes, or the largest number that can be compared with further ones if the figures change at
/// every number. Throws as prepare() does.
[[nodiscard]] AutoModes choose_modes(const SceneFile& file, const Progress& progress = {});

}  // namespace softland
