#include "waveforms/step.h"

#include <fmt/format.h>

namespace softland {

Signal signal(const Step& step, double before) {
  require_of("level", std::isfinite(step.level),
             [&] { return fmt::format("level of a step is {} V; it must be finite", step.level); });
  require_of("rise_time", step.rise_time >= 0 && std::isfinite(step.rise_time),
             [&] { return fmt::format("rise_time of a step is {} s; it must be finite and >= 0", step.rise_time); });
  return Signal::piecewise_linear({{0, before}, {step.rise_time, step.level}}, before);
}

}  // namespace softland
