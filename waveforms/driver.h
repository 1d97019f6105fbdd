// The applied voltage that a voltage source makes of the commanded signal: a digital-to-analogue converter, an amplifier, and a
// resistance before the capacitance of the switch.
//
//   sample_rate f      the signal is sampled at k / f, and every sample is held until the next one
//   bits n             samples are rounded to the nearest of 2^n voltages that divide [min_voltage, max_voltage] evenly
//   max_slew           where samples are held, the output goes from sample to sample no faster
//   bandwidth f_b      T dV/dt + V = input, T = 1 / (2 pi f_b): the amplitude of a sine of this frequency falls by 3 dB
//   source_resistance  a filter T dV/dt + V = input with T = R (C + Cp), C the load, Cp the parallel_capacitance beside it
//
// The stages apply in this order, each if it is given, and are exact: filtered held samples are exponentials. Only a signal of
// changing frequency (a chirp) is filtered as cubics, with an error of 1e-6 of its amplitude. The output stays within the range
// of the input and 0 V. An exponential is dropped after 40 time constants, at 4e-18 of its initial value.
#pragma once

#include <optional>

#include "waveforms/limits.h"
#include "waveforms/signal.h"
#include "waveforms/source_errors.h"

namespace softland {

struct DriverModel {
  std::optional<double> sample_rate = {};  ///< sample rate of the converter [Hz], > 0
  /// Number of bits of the converter, > 0; only with a sample_rate and finite limits of the voltage.
  std::optional<int> bits = {};
  std::optional<double> bandwidth = {};          ///< bandwidth of the amplifier [Hz], > 0
  std::optional<double> source_resistance = {};  ///< resistance between source and switch [ohm], > 0
  double parallel_capacitance = 0;               ///< capacitance of leads and instruments, in parallel to the switch [F], >= 0
  double load = 0;                               ///< capacitance of the switch that the source charges [F], >= 0

  /// Returns the time constant with which the source charges the load and the parallel capacitance [s]; 0 without a source
  /// resistance.
  [[nodiscard]] double charging_time() const { return source_resistance.value_or(0) * (load + parallel_capacitance); }
  /// Returns true if the applied voltage equals the commanded voltage.
  [[nodiscard]] bool is_ideal() const { return !sample_rate && !bandwidth && !source_resistance; }
};

/// Returns the samples of the commanded signal that the converter of a source holds, each until the next sample. Returns the
/// commanded signal for a source without samples, and for a signal of 0 V at all times. A sine without an end is sampled up to
/// `end` [s]; after that its mean value is held. Throws InvalidInput for more than 1e7 samples.
[[nodiscard]] Signal held(const Signal& commanded, const DriverModel& model, const DriverLimits& limits, double end);

/// Returns the samples of the commanded signal for a generator or a file. While the signal stays at its voltage before t = 0,
/// the samples are not rounded, so that the voltage does not jump at t = 0.
[[nodiscard]] Signal commanded_samples(const Signal& commanded, const DriverModel& model, const DriverLimits& limits, double end);

/// Returns the limits of the voltage source for a table of samples. By rounding, the change between two samples may exceed the
/// change of the waveform by one step of the converter.
[[nodiscard]] DriverLimits limits_of_samples(DriverLimits limits, const DriverModel& model);

/// Returns the applied voltage of the source: the output of its converter with gain, offset and delay. Throws InvalidInput as
/// held() does. A source commanded to 0 V at all times applies its offset; before t = 0 it applies the commanded voltage.
[[nodiscard]] Signal applied(const Signal& commanded, const DriverModel& model, const DriverLimits& limits, double end,
                             const SourceErrors& errors = {});

namespace internal {

/// The stages by which applied() computes the applied voltage, in order: sampling with rounding, slew limit, filter.
[[nodiscard]] Signal sampled(const Signal& commanded, double rate, std::optional<int> bits, const DriverLimits& limits,
                             double end);
[[nodiscard]] Signal slewed(const Signal& held, double max_slew);
/// Returns the solution of T dV/dt + V = input, from V = 0 at t = 0; `time_constant` T > 0 [s].
[[nodiscard]] Signal filtered(const Signal& input, double time_constant);

}  // namespace internal
}  // namespace softland
