// Chooses the number of modes that the closing of a scene needs, for modes = "auto".
//
// The chosen number is the smallest one for which three further modes change no figure by more than the tolerance. These figures
// are compared, under the scene's own waveforms:
// - Initial contact time, impact velocity, and the highest rebound within one period of the first mode after first contact.
// - The static pull-in voltage of every electrode, and the dynamic one where waveforms or limits are in units of it.
// - The static pull-in, release and collapse voltages, which are compared at twice and four times as many modes (by_modes.h).
// The larger numbers of modes must also agree about the stability of the closed state. Fewer than three further modes do not
// suffice: for scenes/mem-gold.toml three to five modes agree within 2 % in the rebound height, but the sixth mode changes it
// by half. A beam that is clamped at both ends is compared with six further modes, since every second mode is antisymmetric.
//
// The change of a figure is relative to the figure's own size, but at least to a hundredth of its scale in a closing (contact
// gap, contact gap times first angular frequency, or the inverse of this frequency).
#pragma once

#include <string>

#include "base/progress.h"
#include "config/scene.h"

namespace softland {

inline constexpr double auto_modes_tolerance = 0.03;

struct AutoModes {
  int modes = 0;
  bool touches = true;  ///< true if the switch reaches its contact in the simulated time
  double moved = 0;     ///< largest relative change of a compared figure when the model gets more modes
  [[nodiscard]] bool settled() const { return moved <= auto_modes_tolerance; }
  /// Returns a sentence about the chosen number of modes, for results.
  [[nodiscard]] std::string note() const;
};

/// Returns the smallest number of modes that suffices for the closing of a scene. If more modes change the figures at every
/// number, returns the largest number that can be compared with more modes. Throws the exceptions of prepare().
[[nodiscard]] AutoModes choose_modes(const SceneFile& file, const Progress& progress = {});

}  // namespace softland
