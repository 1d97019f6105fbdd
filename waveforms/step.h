// Step: 0 V before t = 0, a linear rise to `level` on [0, rise_time], then constant.
#pragma once

#include <array>

#include "waveforms/parameter.h"
#include "waveforms/signal.h"

namespace softland {

template <class P>
struct StepOf {
  P level = 0;      ///< [V]
  P rise_time = 0;  ///< [s], >= 0
};
using Step = StepOf<double>;

template <>
struct FamilyOf<Step> {
  static constexpr std::string_view name = "step";
  static constexpr auto parameters = std::to_array<Parameter<Step>>({
      {"level", Meaning::level, &Step::level, true, "held for ever"},
      {"rise_time", Meaning::time, &Step::rise_time, false, "linear rise from 0 V"},
  });
};

/// The pieces of a valid step.
template <class P>
[[nodiscard]] Pieces<P> pieces(const StepOf<P>& step) {
  return internal::straight_pieces<P>({{P(0), P(0)}, {step.rise_time, step.level}});
}
/// Throws InvalidParameter.
[[nodiscard]] Signal signal(const Step& step);

}  // namespace softland
