// Formats the numbers in reports and messages. JSON files, for programs, hold all digits and do not use these functions.
//
// A number has an SI prefix, a true minus sign (U+2212) and a no-break space before its unit. Digits beyond the requested
// number, below the resolution of the unit, or below the error of the value are not shown: 26 attoseconds are "< 1 fs", 306.8
// µs with an error of 12 µs is 307 µs.
#pragma once

#include <string>
#include <string_view>

namespace softland::internal {

/// An SI prefix of a unit: value [unit] = number before the prefix * factor, as in 2e-6 m = 2 * 1e-6 m = 2 µm.
struct Prefix {
  double factor = 1;
  std::string_view symbol;  ///< symbol of the prefix: "n", "µ", "" ...
};

/// Returns the prefix with which `largest` (in absolute value) has one to three digits before the decimal point; no prefix for
/// 0 and non-finite values.
[[nodiscard]] Prefix prefix_for(double largest);

/// Returns true if a unit is usually written with a prefix: "m/s" and "V" are, "kg/m^3", "m^2" and "Vdp" are not.
[[nodiscard]] bool takes_prefix(std::string_view unit);

/// Returns the smallest meaningful value of a unit for a switch, a power of ten: 1 pm, 1 fs, 1 nm/s, 1 fN, 1 zJ (thermal energy
/// is 4 zJ), 1 µV, 1 V/s. Returns 0 for other units.
[[nodiscard]] double resolution(std::string_view unit);

/// Replaces the leading hyphen of a number by U+2212.
[[nodiscard]] std::string with_true_minus(const std::string& number);

/// Formats `value` with `digits` significant digits and the prefix that suits it: 4.45e-05, "s" -> "44.5 µs". Non-finite: an em
/// dash; 0: "0 s"; positive and below the resolution: "< 1 fs"; negative and above minus the resolution: "0 s". An empty unit
/// gives a plain number without prefix; a value beyond the prefixes has an exponent: "1e300 s".
[[nodiscard]] std::string quantity(double value, std::string_view unit, int digits = 3);

/// Formats as quantity() does, but gives 0 the prefix of `neighbour`, which stands beside it: "803 nm" and "0 nm".
[[nodiscard]] std::string quantity_beside(double value, double neighbour, std::string_view unit, int digits = 3);

/// Formats as quantity() does, but also rounds to the last shown digit of `error` [unit]; a NaN error is unknown and ignored.
[[nodiscard]] std::string quantity_within(double value, double error, std::string_view unit, int digits = 3);

/// Formats the error of a value that quantity_within() shows, in the prefix of the value: one significant digit, two when the
/// first is 1, rounded up. An error below the value's digits is "< 0.01 µs". Non-finite: an em dash.
[[nodiscard]] std::string error_of(double value, double error, std::string_view unit, int digits = 3);

/// Formats a value that a user typed: as quantity() does, but without trailing zeros: "30 V".
[[nodiscard]] std::string given_quantity(double value, std::string_view unit, int digits = 5);

/// Formats `value` with at most `digits` significant digits and no trailing zeros; an exponent, as in 1.41e7, only beyond 1e-4
/// and 1e6.
[[nodiscard]] std::string plain_number(double value, int digits = 3);

/// Formats a count with all its digits: "2500"; an exponent only from 1e15 on.
[[nodiscard]] std::string whole(double count);

/// Formats with one digit before the point and an exponent as in a scene file: "1e-4", "2.6e-9". Non-finite: an em dash.
[[nodiscard]] std::string scientific(double value, int digits = 2);

/// Formats a relative error as scientific() does; 0 as "0", and an error below 1e-9, smaller than any meaningful error, as "<
/// 1e-9".
[[nodiscard]] std::string relative_error(double value);

/// Formats a ratio of at least 1: "8.4 times", "107 times", "more than 1000 times".
[[nodiscard]] std::string times(double ratio);

/// Formats a spread or another ratio that may exceed 1: 0.212 -> "21.2 %"; a ratio above 10 as times() does.
[[nodiscard]] std::string percent(double ratio);

/// Formats a share of devices, waveforms or rows, from 0 to 1: 0.212 -> "21.2 %". Only all of them are "100 %" and only none
/// "0.0 %"; shares that would round to these are "> 99.9 %" and "< 0.1 %". Non-finite: an em dash.
[[nodiscard]] std::string share_text(double share);

/// Formats as share_text() does, without the unit, for several shares in one cell: "21.2".
[[nodiscard]] std::string share_number(double share);

/// Formats a relative change: 0.25 -> "+25.0 %", -0.05 -> "−5.0 %"; an increase by more than 1000 % as a factor: "× 54", "> ×
/// 1000".
[[nodiscard]] std::string relative_change(double change);

}  // namespace softland::internal
