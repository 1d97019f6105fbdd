// Numbers as people read them: SI prefix, significant digits, no-break space before the unit.
#pragma once

#include <string>
#include <string_view>

namespace softland::internal {

/// An SI prefix: value = shown number * factor.
struct Prefix {
  double factor = 1;
  std::string_view symbol;  ///< "n", "µ", "" ...
};

/// The prefix that shows `largest` (in absolute value) with one to three digits before the decimal point; none for 0 and
/// non-finite values.
[[nodiscard]] Prefix prefix_for(double largest);

/// `value` with `digits` significant digits and the prefix that suits it: 4.45e-05, "s" -> "44.5 µs". Non-finite: an em dash; 0:
/// "0 s". Between number and unit stands a no-break space (U+00A0). An empty unit gives a plain number without prefix.
[[nodiscard]] std::string quantity(double value, std::string_view unit, int digits = 3);

/// As above, but a 0 gets the prefix of `neighbour`, beside which it is read: "803 nm" and "0 nm".
[[nodiscard]] std::string quantity_beside(double value, double neighbour, std::string_view unit, int digits = 3);

/// `value` with at most `digits` significant digits and no trailing zeros; an exponent only beyond 1e-4 and 1e6.
[[nodiscard]] std::string plain_number(double value, int digits = 3);

}  // namespace softland::internal
