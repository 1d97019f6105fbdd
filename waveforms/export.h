// Waveform files other programs read.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "waveforms/signal.h"

namespace softland {

/// Breakpoints [s, V] whose straight connections stay within `tolerance` [V] of the signal on [0, end]; pulses and steps come out exact.
/// A jump becomes two points `jump_time` [s] apart.
[[nodiscard]] std::vector<std::pair<double, double>> polyline(const Signal& signal, double end, double tolerance, double jump_time);

/// CSV with a header `time_s,<drive>,<drive>...` on the union of all breakpoints; readable by the table family.
[[nodiscard]] std::string csv(const std::map<std::string, Signal>& signals, double end);

/// A SPICE subcircuit file with one PWL voltage source per drive, usable with .include in ngspice, LTspice, HSPICE.
[[nodiscard]] std::string spice_pwl(const std::map<std::string, Signal>& signals, double end);

}  // namespace softland
