#include "waveforms/s_curve.h"

#include "waveforms/pulse.h"

namespace softland {

Signal signal(const SCurve& curve, double before) {
  internal::require_levels_and_edges("an S-curve", curve.levels, curve.times, curve.edge);
  return Signal(pieces(curve, before), before);
}

}  // namespace softland
