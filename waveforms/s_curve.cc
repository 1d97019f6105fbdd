#include "waveforms/s_curve.h"

#include "waveforms/pulse.h"

namespace softland {

Signal signal(const SCurve& curve) {
  internal::require_levels_and_edges("an S-curve", curve.levels, curve.times, curve.edge);
  return Signal(pieces(curve));
}

}  // namespace softland
