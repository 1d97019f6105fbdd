// Step waveform: a linear rise of the voltage to `level` on [0, rise_time], from the voltage before t = 0, then constant.
#pragma once

#include <array>

#include "waveforms/parameter.h"
#include "waveforms/signal.h"

namespace softland {

template <class P>
struct StepOf {
  P level = 0;      ///< voltage after the rise [V]
  P rise_time = 0;  ///< duration of the rise [s], >= 0
};
using Step = StepOf<double>;

template <>
struct FamilyOf<Step> {
  static constexpr std::string_view name = "step";
  static constexpr auto parameters = std::to_array<Parameter<Step>>({
      {"level", ParameterKind::level, &Step::level, true, "level after the rise, which is held"},
      {"rise_time", ParameterKind::time, &Step::rise_time, false,
       "linear rise from `before`; driver: as steep as max_slew of the driver permits, a jump where it has none"},
  });
  [[nodiscard]] static Step example() { return {.level = 3, .rise_time = 1}; }
};

/// Returns the signal pieces of a valid step, which begins at the voltage `before` [V].
template <class P>
[[nodiscard]] Pieces<P> pieces(const StepOf<P>& step, const P& before = P(0)) {
  return internal::straight_pieces<P>({{P(0), before}, {step.rise_time, step.level}});
}
/// Compiles the step to a voltage signal. Throws InvalidParameter for an invalid step.
[[nodiscard]] Signal signal(const Step& step, double before = 0);

}  // namespace softland
