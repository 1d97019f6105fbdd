// Which laws matter in a scene, by how much, and what they cost: the closing of the scene repeated with each of them in turn.
// First version: the gas. Drives keep their volts, so that only the law differs.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "objectives/metrics.h"
#include "studies/prepared.h"

namespace softland {

/// A number that people compare: "damping per length, closed", "N s/m^2".
struct NamedNumber {
  std::string name;
  std::string unit;  ///< empty: dimensionless
  double value = Metrics::unset;
};

/// The scene with one law in the place of its own.
struct Effect {
  std::string section;    ///< of the scene: "gas"
  std::string choice;     ///< the law, "none" where the effect is left out
  bool in_scene = false;  ///< what the scene itself says
  NamedNumber magnitude;
  NamedNumber group;                  ///< the dimensionless group that decides whether the law holds
  Metrics metrics;                    ///< of this closing
  double rhs_seconds = 0;             ///< per right-hand side, along this closing [s]
  std::vector<std::string> warnings;  ///< of this closing
};

struct Effects {
  std::vector<Effect> list;

  /// What the scene itself says in this section.
  [[nodiscard]] const Effect& own(const std::string& section) const;
  /// Largest less smallest value of a figure over the laws of a section that are films or dampers, not "none"; relative to the
  /// scene's own closing. NaN when it is missing in any of them.
  [[nodiscard]] double spread(const std::string& section, double Metrics::*figure) const;
};

/// (value - own) / own; NaN where either is missing.
[[nodiscard]] double relative_change(const Effect& effect, const Effect& own, double Metrics::*figure);

/// Repeats the closing with no gas and with every gas law, in the state of gas that the scene describes (air at 101325 Pa and 300
/// K where it describes none). The linear damper and the film over a slit only where the scene describes them.
[[nodiscard]] Effects compare_effects(const Prepared& prepared, const std::atomic<bool>* stop = nullptr);

/// Seconds per Switch::accelerations over the very states that a closing goes through, in flight and in contact in their true
/// proportion: the median of `repeats` passes.
[[nodiscard]] double right_hand_side_seconds(const Switch& device, const std::vector<Signal>& signals, double duration,
                                             int repeats);

}  // namespace softland
