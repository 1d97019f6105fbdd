// A quasi-static sweep: the voltage of a switch rises slowly and falls again. The switch is open up to the pull-in voltage, and
// on the way down closed until the release voltage.
#pragma once

#include <limits>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "model/pull_in.h"
#include "model/switch.h"

namespace softland {

enum class SweepState {
  open,
  closed,  ///< closed on the contact
  none     ///< no stable equilibrium: the beam has collapsed onto the electrode, or the switch has no contact
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
  int points = 0;              ///< number of evenly spaced voltages, ends included; at least 2
};

/// Returns the points of the sweep in order: `range.points` up to the last voltage and as many down, so that the last voltage
/// occurs twice. The switch begins open if it can. It stays open while it has a stable open equilibrium. It stays closed while
/// it has a closed equilibrium that it does not leave. The electrode must pull towards the contact. A sweep that `progress`
/// asks to stop returns its points so far. Throws InvalidInput for fewer than 2 points, and as static_pull_in() does.
[[nodiscard]] std::vector<SweepPoint> static_sweep(const Switch& model, std::size_t drive, Bias bias, const SweepRange& range,
                                                   const Progress& progress = {});

}  // namespace softland
