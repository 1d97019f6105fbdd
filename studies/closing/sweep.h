// The static course of a switch whose voltage is swept slowly up and down again: open up to the pull-in voltage, closed on the
// way back down to the release voltage.
#pragma once

#include <limits>
#include <string_view>
#include <vector>

#include "base/watch.h"
#include "model/pull_in.h"
#include "model/switch.h"

namespace softland {

enum class SweepState {
  open,
  closed,  ///< closed on the contact
  none     ///< no stable equilibrium that a scene describes: the beam has collapsed onto the electrode, or there is no contact
};

/// "open", "closed" or "collapsed_onto_electrode".
[[nodiscard]] std::string_view to_string(SweepState state);

struct SweepPoint {
  double voltage = 0;                                             ///< voltage of the swept electrode [V]
  double deflection = std::numeric_limits<double>::quiet_NaN();   ///< deflection of the contact point, towards the contact [m]
  double capacitance = std::numeric_limits<double>::quiet_NaN();  ///< capacitance of the swept electrode [F]
  bool is_up = true;                                              ///< true on the way from the first voltage to the last
  SweepState state = SweepState::none;
};

struct SweepRange {
  double first = 0, last = 0;  ///< [V]
  int points = 0;              ///< at least 2, evenly spaced, both ends among them
};

/// Returns as many points on the way to the last voltage as on the way back, in order; the last of the first half is the first
/// of the second. The switch stays open while it has a stable open equilibrium, and closed while it has a closed one that it
/// does not leave; it begins open if it can. The electrode must pull towards the contact. A sweep that `watch` asks to stop
/// returns its points so far. Throws InvalidInput for fewer than 2 points and as static_pull_in() does.
[[nodiscard]] std::vector<SweepPoint> static_sweep(const Switch& model, std::size_t drive, Bias bias, const SweepRange& range,
                                                   const Watch& watch = {});

}  // namespace softland
