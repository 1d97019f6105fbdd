// What a voltage source makes of the signal that it is told to give: a digital-to-analogue converter, an amplifier, and a
// resistance before the capacitance of the switch.
//
//   sample_rate f      the signal is sampled at k / f, and every sample is held until the next one
//   bits n             samples are rounded to the nearest of 2^n voltages that divide [min_voltage, max_voltage] evenly
//   max_slew           where samples are held, the output goes from one to the next no faster
//   bandwidth f_b      T dV/dt + V = input, T = 1 / (2 pi f_b): the amplitude of a sine of this frequency falls by 3 dB
//   source_resistance  the same with T = R (C + Cp), C the load, Cp the parallel_capacitance beside it
//
// in this order, each where it is given. All of them are exact: held samples through a filter are exponentials. What changes its
// frequency (a chirp) is filtered as cubics within 1e-6 of its amplitude. The output stays between the smallest and the largest
// input and 0 V, and what is left of an exponential after 40 time constants, 4e-18 of it, is dropped.
#pragma once

#include <optional>

#include "waveforms/limits.h"
#include "waveforms/signal.h"
#include "waveforms/source_errors.h"

namespace softland {

struct DriverModel {
  std::optional<double> sample_rate = {};        ///< [Hz], > 0
  std::optional<int> bits = {};                  ///< > 0; only with a sample_rate and finite limits of the voltage
  std::optional<double> bandwidth = {};          ///< [Hz], > 0
  std::optional<double> source_resistance = {};  ///< [ohm], > 0
  double parallel_capacitance = 0;               ///< of leads and instruments, behind the resistance [F], >= 0
  double load = 0;                               ///< capacitance that the source charges beside it [F], >= 0

  /// T with which it charges both through its resistance [s]; 0 without one.
  [[nodiscard]] double charging_time() const { return source_resistance.value_or(0) * (load + parallel_capacitance); }
  /// Whether the output is what the source is told.
  [[nodiscard]] bool is_ideal() const { return !sample_rate && !bandwidth && !source_resistance; }
};

/// The samples that its converter holds, each until the next; what the source is told where it takes none, and where that is 0 V
/// at all times. A sine that never ends is sampled up to `end` [s], when the value that it swings about takes over. Throws
/// InvalidInput when it would take more than 1e7 samples.
[[nodiscard]] Signal held(const Signal& told, const DriverModel& model, const DriverLimits& limits, double end);

/// The same for a generator or a file: what the source has stood at before t = 0 is not rounded as long as it stays there, so
/// that nothing jumps when the samples are told.
[[nodiscard]] Signal told_samples(const Signal& told, const DriverModel& model, const DriverLimits& limits, double end);

/// The limits that a table is held against: samples that were rounded may rise by a step of the converter more from one to the
/// next than the waveform that they were taken of.
[[nodiscard]] DriverLimits limits_of_samples(DriverLimits limits, const DriverModel& model);

/// The output of the source, whose gain, offset and delay change what its converter gives; throws as held(). One that is told 0 V
/// at all times gives its offset; before t = 0 it gives what it is told.
[[nodiscard]] Signal driven(const Signal& told, const DriverModel& model, const DriverLimits& limits, double end,
                            const SourceErrors& errors = {});

namespace internal {

/// The parts of driven().
[[nodiscard]] Signal sampled(const Signal& told, double rate, std::optional<int> bits, const DriverLimits& limits, double end);
[[nodiscard]] Signal slewed(const Signal& held, double max_slew);
/// T dV/dt + V = input, from V = 0 at t = 0; `time_constant` T > 0 [s].
[[nodiscard]] Signal filtered(const Signal& input, double time_constant);

}  // namespace internal
}  // namespace softland
