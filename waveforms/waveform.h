// The waveform families, such as pulse and chirp. Each family is a small aggregate in its own file that compiles to a Signal.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "waveforms/bspline.h"
#include "waveforms/chirp.h"
#include "waveforms/harmonic.h"
#include "waveforms/limits.h"
#include "waveforms/own_waveform.h"
#include "waveforms/pulse.h"
#include "waveforms/s_curve.h"
#include "waveforms/signal.h"
#include "waveforms/sines.h"
#include "waveforms/step.h"
#include "waveforms/table.h"

namespace softland {

using Waveform = std::variant<Step, Harmonic, Pulse, Table, SCurve, Chirp, BSpline, Sines, Own>;
/// Waveforms by the name of the drive, for some or all drives of a scene.
using DriveWaveforms = std::map<std::string, Waveform>;
/// Number of waveform families that a scene file can contain: all alternatives of Waveform except the last, the user's own
/// waveform.
inline constexpr std::size_t families_of_scenes = std::variant_size_v<Waveform> - 1;

/// Returns the voltage signal of a waveform from t = 0 on; `before` is the voltage before t = 0 [V], from which a first edge
/// rises. Throws InvalidInput with the parameter, its value and the rule.
[[nodiscard]] Signal signal(const Waveform& waveform, double before = 0);
[[nodiscard]] std::vector<Signal> signals_of(const std::vector<Waveform>& waveforms);
/// Returns the limits of a voltage source for the signal of a waveform. For a user's own waveform, which is approximated, the
/// voltage limits are wider by own_waveform_accuracy, and the slew limit by 1e-3.
[[nodiscard]] DriverLimits limits_for(const Waveform& waveform, DriverLimits limits);
/// Returns the waveform with its voltages multiplied by `volts`, its times multiplied by `time`, and its frequencies divided by
/// `time`; both factors are positive.
[[nodiscard]] Waveform scaled(Waveform waveform, double volts, double time);
/// Returns the name of the waveform's family: step | harmonic | pulse | table | s-curve | chirp | bspline | sines; for a user's
/// own waveform its name.
[[nodiscard]] std::string_view family(const Waveform& waveform);

/// Calls f with a default waveform of every family that a scene can hold, in the order of the alternatives of Waveform.
template <class F>
void for_each_family(F&& f) {
  [&]<std::size_t... i>(std::index_sequence<i...>) { (f(std::variant_alternative_t<i, Waveform>{}), ...); }
  (std::make_index_sequence<families_of_scenes>());
}

}  // namespace softland
