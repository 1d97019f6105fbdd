// The choice of vector instructions in this build; in a file of its own, so that another choice recompiles only this file.
#include "model/ensemble/ensemble_closings.h"
#include "model/ensemble/lane_closing.h"

namespace softland {

simd::LaneRunner simd::lane_runner(Vectors vectors) {
#ifdef SOFTLAND_LANES_AVX512
  if (vectors == Vectors::avx512) return run_avx512;
#endif
#ifdef SOFTLAND_LANES_AVX2
  if (vectors == Vectors::avx2) return run_avx2;
#endif
  static_cast<void>(vectors);
  return nullptr;
}

bool has(Vectors vectors) {
  if (vectors == Vectors::none) return true;
  if (simd::lane_runner(vectors) == nullptr) return false;
#if defined(__x86_64__)
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  if (vectors == Vectors::avx2) return avx2;
  return avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd");
#else
  return false;
#endif
}

}  // namespace softland
