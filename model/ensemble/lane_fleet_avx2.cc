// Compiled for processors with AVX2 and FMA alone: see fleet.cc.
#include "model/ensemble/lane_fleet.h"

namespace softland::fleet {

void run_avx2(const LaneLayout& layout, LaneClosing* closings, std::size_t count) {
  run_in<std::experimental::simd<double, std::experimental::simd_abi::deduce_t<double, 4>>>(layout, closings, count);
}

}  // namespace softland::fleet
