// A quasi-static sweep: the voltage of a switch rises slowly and falls again. The switch is open while the voltage rises to the
// pull-in voltage, and closed while it falls to the release voltage.
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
  closed,  ///< the switch is closed: the beam rests on the contact
  none     ///< no stable equilibrium: the beam has collapsed onto the electrode, or the switch has no contact
};

/// Returns the state of the switch in a sweep as text: "open", "closed" or "collapsed_onto_electrode".
[[nodiscard]] std::string_view to_string(SweepState state);

struct SweepPoint {
  double voltage = 0;                                             ///< voltage of the electrode that is swept [V]
  double deflection = std::numeric_limits<double>::quiet_NaN();   ///< deflection of the contact point, towards the contact [m]
  double capacitance = std::numeric_limits<double>::quiet_NaN();  ///< capacitance of the swept electrode [F]
  bool is_up = true;                                              ///< true while the swept voltage rises
  SweepState state = SweepState::none;
};

struct SweepRange {
  double first = 0, last = 0;  ///< first and last voltage of the rising half of the sweep [V]
  int points = 0;              ///< number of evenly spaced voltages in the rising half, ends included; at least 2
};

/// Returns the points of the sweep in order: `range.points` up to the last voltage and as many down, so that the last voltage
/// occurs twice. The switch begins open if an open equilibrium exists, stays open while that equilibrium is stable, and stays
/// closed while its closed equilibrium is stable. The electrode must pull towards the contact. If `progress` asks to stop, the
/// points so far are returned. Throws InvalidInput for fewer than 2 points, and the exceptions of static_pull_in().
[[nodiscard]] std::vector<SweepPoint> static_sweep(const Switch& model, std::size_t drive, Bias bias, const SweepRange& range,
                                                   const Progress& progress = {});

}  // namespace softland
