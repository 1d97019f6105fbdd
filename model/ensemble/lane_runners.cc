// The choice of vector (SIMD) instructions in this build, in a separate file, so that another choice recompiles only this file.
#include <fmt/format.h>

#include <cstdlib>

#include "base/require.h"
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

Vectors vectors_in_use() {
  constexpr const char* variable = "SOFTLAND_VECTORS";
  const char* asked = std::getenv(variable);
  if (asked == nullptr || *asked == '\0') {
    for (const Vectors widest : {Vectors::avx512, Vectors::avx2})
      if (has(widest)) return widest;
    return Vectors::none;
  }
  for (const VectorsRow& row : vector_instructions) {
    if (row.name != asked) continue;
    require(has(row.value), [&] {
      return fmt::format("{} = {}: this processor or this build does not have these instructions; choose none or narrower ones",
                         variable, asked);
    });
    return row.value;
  }
  throw InvalidInput(fmt::format("{} = {}: must be none, avx2 or avx512", variable, asked));
}

}  // namespace softland
