// The applied voltage of a voltage source for a commanded signal. The source is a digital-to-analogue converter, an amplifier,
// and a resistance before the capacitance of the switch.
//
//   sample_rate f      the signal is sampled at k / f, and every sample is held until the next sample
//   bits n             samples are rounded to the nearest of 2^n voltages that divide [min_voltage, max_voltage] evenly
//   max_slew           where samples are held, the output goes from sample to sample no faster
//   bandwidth f_b      T dV/dt + V = input, T = 1 / (2 pi f_b): the amplitude of a sine of this frequency falls by 3 dB
//   source_resistance  a filter T dV/dt + V = input with T = R (C + Cp), C the load, Cp the parallel_capacitance beside it
//
// The stages apply in this order; a stage without its parameter is left out. They are computed exactly: a filter turns held
// samples into exponentials. Only a signal of changing frequency (a chirp) is filtered as cubics, with an error of 1e-6 of its
// amplitude. The output stays within the range of the input and 0 V. An exponential is dropped after 40 time constants, at
// 4e-18 of its initial value.
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

  /// Returns the time constant R (C + Cp) with which the source charges load and parallel capacitance through its resistance
  /// [s]; 0 without a source resistance.
  [[nodiscard]] double charging_time() const { return source_resistance.value_or(0) * (load + parallel_capacitance); }
  /// Returns true if the applied voltage equals the commanded voltage.
  [[nodiscard]] bool is_ideal() const { return !sample_rate && !bandwidth && !source_resistance; }
};

/// Returns the output of the source's converter: samples of the commanded signal, each held until the next sample. Returns the
/// commanded signal for a source without a sample rate, and for a signal of 0 V at all times. A sine without an end is sampled
/// up to `end` [s]; afterwards its mean value is held. Throws InvalidInput for more than 1e7 samples.
[[nodiscard]] Signal held(const Signal& commanded, const DriverModel& model, const DriverLimits& limits, double end);

/// Returns the output of the source's converter, as held(), for export to a generator or a file. If the signal does not jump at
/// t = 0, the first sample is not rounded, so that the output does not jump there either.
[[nodiscard]] Signal commanded_samples(const Signal& commanded, const DriverModel& model, const DriverLimits& limits, double end);

/// Returns the limits of the voltage source with the slew limit that holds for a table of samples. Rounding to the codes of the
/// converter may increase the change between two samples by one voltage step.
[[nodiscard]] DriverLimits limits_of_samples(DriverLimits limits, const DriverModel& model);

/// Returns the applied voltage of the source: the commanded signal after sampling, slew limit, `errors` and filters, in this
/// order. Throws InvalidInput as held() does. A source commanded to 0 V at all times applies its offset. Before t = 0 the
/// applied voltage is the commanded voltage.
[[nodiscard]] Signal applied(const Signal& commanded, const DriverModel& model, const DriverLimits& limits, double end,
                             const SourceErrors& errors = {});

namespace internal {

/// The stages of applied(), in order. sampled() takes samples of a commanded signal and rounds them to the codes of the
/// converter; slewed() limits the slew of held samples; filtered() is the filter of amplifier or source resistance.
[[nodiscard]] Signal sampled(const Signal& commanded, double rate, std::optional<int> bits, const DriverLimits& limits,
                             double end);
[[nodiscard]] Signal slewed(const Signal& held, double max_slew);
/// Returns the solution V of T dV/dt + V = input, which starts at the input's voltage before t = 0; `time_constant` T > 0 [s].
[[nodiscard]] Signal filtered(const Signal& input, double time_constant);

}  // namespace internal
}  // namespace softland
