// Writes drive waveforms to files of other programs: CSV, converter codes, SPICE.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "waveforms/signal.h"

namespace softland {

/// Returns points (time [s], voltage [V]) whose connection by straight lines stays within `tolerance` [V] of the signal on [0,
/// end]; pulses and steps are exact. A jump at t becomes points at t and at t + jump_time [s], or at most a thousandth of the
/// following interval after t; with jump_time = 0 both points have the time t. If the signal jumps at t = 0, the points start
/// with this jump. The last point is at `end`, or one jump_time later. Throws InvalidInput unless end and jump_time are finite
/// and >= 0, the tolerance of a curve is > 0, and a piece has at most 1e7 points.
[[nodiscard]] std::vector<std::pair<double, double>> polyline(const Signal& signal, double end, double tolerance,
                                                              double jump_time);

/// Writes CSV with a header `time_s,<drive>,<drive>...` and a row for each breakpoint of any drive; read_table() reads the
/// file. A jump of any drive is two rows of the same time; sines and other curves are sampled so that straight lines stay
/// within 1e-4 of the drive's peak. A step, pulse or table that is the only signal reads back to the same signal bit for bit;
/// together with other drives its ramps are split at their breakpoints, to rounding. Throws InvalidInput when there is no
/// signal, a name does not fit into a header, or `end` is not finite and >= 0.
///
/// `sample_rates` are the sample rates of the drives that consist of held samples [Hz]. Each sample at k / rate has a row, up
/// to the last one, which is held without end. Reading the file gives the same samples.
[[nodiscard]] std::string csv(const std::map<std::string, Signal>& signals, double end,
                              const std::map<std::string, double>& sample_rates = {});

/// A drive waveform of held samples, to be written as integer codes of a converter.
struct Coded {
  Signal held;                      ///< voltage samples of a drive, each held until the next sample
  double sample_rate = 0;           ///< sample rate of the drive [Hz]
  int bits = 0;                     ///< number of bits of the converter; codes are 0 to 2^bits - 1
  double minimum = 0, maximum = 0;  ///< voltages of the smallest and of the largest code [V]
};
/// Writes CSV with converter codes of drive voltages: a header `index,<drive>,<drive>...` and a row for each sample at k /
/// rate, up to the last change of any drive. Throws InvalidInput without drives, and when their sample rates differ.
[[nodiscard]] std::string codes(const std::map<std::string, Coded>& drives);

/// Returns the name of a drive in SPICE: letters become lower case, and other characters than letters and digits an underscore.
[[nodiscard]] std::string spice_name(const std::string& drive);
/// Writes a SPICE file with one subcircuit `softland_<drive> plus minus` per drive, which holds one PWL voltage source; usable
/// with .include in ngspice, LTspice, HSPICE. A jump takes 1 ps, or a ten-millionth of `end` or a thousandth of the interval
/// after the jump if that is shorter; curves as in csv(). Names are those of spice_name(). The text `about` is in the first
/// line. Throws InvalidInput as csv(), and when two drives get the same name.
[[nodiscard]] std::string spice_pwl(
    const std::map<std::string, Signal>& signals, double end,
    std::string_view about = "Drive waveforms, one subcircuit each: Xname plus minus softland_drive");

}  // namespace softland
