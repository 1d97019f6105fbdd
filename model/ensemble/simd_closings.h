// The simulation of several closings at once (ensemble_closings.h), one per lane of a SIMD vector. This header is included once
// for every set of vector instructions.
#pragma once

#include <cstddef>

#include "model/ensemble/lane_closing.h"
#include "model/ensemble/lane_laws.h"
#include "model/ensemble/simd_contacts.h"
#include "model/ensemble/simd_course.h"
#include "model/ensemble/simd_lanes.h"
#include "model/ensemble/simd_step.h"

namespace softland::simd {

template <class V, template <class> class FringingOf>
void run_with(const LaneLayout& layout, LaneClosing* closings, std::size_t count) {
  if (layout.film >= 0) {
    SimdClosings<V, UsualLaws<V, FringingOf, true>>(layout, closings, count).run();
  } else {
    SimdClosings<V, UsualLaws<V, FringingOf, false>>(layout, closings, count).run();
  }
}

template <class V>
void run_in(const LaneLayout& layout, LaneClosing* closings, std::size_t count) {
  if (layout.contacts > 1) {
    if (!layout.usual) return SimdClosings<V, AnyLaws<V>, most_contacts>(layout, closings, count).run();
    return SimdClosings<V, UsualLaws<V, MeijsFokkemaFringingOf, true, most_points>, most_contacts>(layout, closings, count).run();
  }
  if (!layout.usual) return SimdClosings<V, AnyLaws<V>>(layout, closings, count).run();
  switch (layout.fringing) {
    case LaneFringing::none:
      return run_with<V, NoFringingOf>(layout, closings, count);
    case LaneFringing::linear:
      return run_with<V, LinearFringingOf>(layout, closings, count);
    case LaneFringing::meijs_fokkema:
      return run_with<V, MeijsFokkemaFringingOf>(layout, closings, count);
  }
}

}  // namespace softland::simd
