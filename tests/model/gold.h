// The reference switch of the tests, and the step that closes it.
#pragma once

#include "model/switch.h"
#include "tests/support/devices.h"

namespace softland::test {

constexpr double step_level = 17.771;  // [V], about 1.25 Vdp

inline const Switch& gold() {
  static const Switch model(gold_cantilever());
  return model;
}

}  // namespace softland::test
