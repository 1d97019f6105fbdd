// The waveform families. Each family is a small aggregate in its own file that compiles to a Signal.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "waveforms/harmonic.h"
#include "waveforms/pulse.h"
#include "waveforms/signal.h"
#include "waveforms/step.h"
#include "waveforms/table.h"

namespace softland {

using Waveform = std::variant<Step, Harmonic, Pulse, Table>;

/// Throws InvalidInput naming the parameter, its value and the rule.
[[nodiscard]] Signal signal(const Waveform& waveform);
/// step | harmonic | pulse | table
[[nodiscard]] std::string_view family(const Waveform& waveform);

}  // namespace softland
