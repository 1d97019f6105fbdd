// Code compiled only for processors with AVX-512: see ensemble_closings.cc.
#include "model/ensemble/simd_closings.h"

namespace softland::simd {

void run_avx512(const LaneLayout& layout, LaneClosing* closings, std::size_t count) {
  run_in<std::experimental::simd<double, std::experimental::simd_abi::deduce_t<double, 8>>>(layout, closings, count);
}

}  // namespace softland::simd
