// Quantities as text: "2 um", "1.86e-5 Pa s", "19300 kg/m^3", "15 %". They are converted to SI once, here.
//
// Grammar: number SPACE unit; the space may be missing before a letter or %. A unit is factors joined by spaces or `*`, with at
// most one `/`; every factor after the `/` divides. A factor is a prefix (y z a f p n u m k M G T), a symbol and an integer
// power `^n`; the whole numerator may be `1`. A text without unit is a plain number. S/s, with a prefix, are samples per
// second, as data sheets of converters write it. An exact symbol wins over prefix + symbol: "Pa s" is pascal second, "m Pa"
// metre pascal, "mPa" millipascal. Printed spellings are read as well: µ (micro sign or Greek mu) for u, the no-break space,
// the minus sign, the middle dot, ² and ³. So whatever softland prints as a quantity can be read again.
//
// Prefixes and `%` move the decimal exponent of the number before it is rounded, so that "2 um" is the double nearest to 2e-6,
// and a number in SI base units is read bit for bit.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace softland {

/// A physical dimension: powers of m, kg, s, A, K, rad, Vsp and Vdp. Angle is a dimension, so that rad/s and Hz differ. The
/// pull-in voltages Vsp and Vdp are dimensions, because their values in volts are computed later.
struct Dimension {
  std::array<int, 8> powers{};
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

namespace dimension {
inline constexpr Dimension none{};
inline constexpr Dimension length{{1}};
inline constexpr Dimension mass{{0, 1}};
inline constexpr Dimension time{{0, 0, 1}};
inline constexpr Dimension current{{0, 0, 0, 1}};
inline constexpr Dimension temperature{{0, 0, 0, 0, 1}};
inline constexpr Dimension angle{{0, 0, 0, 0, 0, 1}};
inline constexpr Dimension static_pull_in{{0, 0, 0, 0, 0, 0, 1}};
inline constexpr Dimension dynamic_pull_in{{0, 0, 0, 0, 0, 0, 0, 1}};
inline constexpr Dimension area{{2}};
inline constexpr Dimension velocity{{1, 0, -1}};
inline constexpr Dimension area_density{{-2}};
inline constexpr Dimension density{{-3, 1}};
inline constexpr Dimension frequency{{0, 0, -1}};
inline constexpr Dimension angular_frequency{{0, 0, -1, 0, 0, 1}};
inline constexpr Dimension force{{1, 1, -2}};
inline constexpr Dimension energy{{2, 1, -2}};
inline constexpr Dimension power{{2, 1, -3}};
inline constexpr Dimension pressure{{-1, 1, -2}};
inline constexpr Dimension stress_gradient{{-2, 1, -2}};
inline constexpr Dimension viscosity{{-1, 1, -1}};
inline constexpr Dimension stiffness{{0, 1, -2}};
inline constexpr Dimension rotational_stiffness{{2, 1, -2, 0, 0, -1}};
inline constexpr Dimension slowness{{-1, 0, 1}};
inline constexpr Dimension voltage{{2, 1, -3, -1}};
inline constexpr Dimension inverse_voltage{{-2, -1, 3, 1}};
inline constexpr Dimension slew_rate{{2, 1, -4, -1}};
inline constexpr Dimension charge{{0, 0, 1, 1}};
inline constexpr Dimension capacitance{{-2, -1, 4, 2}};
inline constexpr Dimension resistance{{2, 1, -3, -2}};
inline constexpr Dimension conductance{{-2, -1, 3, 2}};
inline constexpr Dimension resistivity{{3, 1, -3, -2}};
inline constexpr Dimension piezo_coefficient{{-1, -1, 3, 1}};
inline constexpr Dimension charge_density{{-2, 0, 1, 1}};
inline constexpr Dimension damping{{0, 1, -1}};
}  // namespace dimension

struct Quantity {
  double value = 0;  ///< number of the quantity [SI unit of the dimension]
  Dimension dimension;
};

/// Reads a quantity; its value is finite. Throws InvalidInput with the broken rule only ("unknown unit 'u'"): the caller adds
/// the key to the message.
[[nodiscard]] Quantity parse_quantity(std::string_view given);

/// Returns the SI symbol of a dimension: "m", "kg/m^3"; empty for a plain number; base units where no usual name exists.
[[nodiscard]] std::string unit_symbol(const Dimension& dimension);
/// Returns a noun for a dimension in messages: "a length", "a plain number".
[[nodiscard]] std::string_view noun(const Dimension& dimension);
/// Returns a description of a dimension for messages: "a length [m]", "a plain number".
[[nodiscard]] std::string describe(const Dimension& dimension);
/// Returns an example for messages, a text of this dimension such as "2 um"; empty if the dimension has no usual example.
[[nodiscard]] std::string_view example(const Dimension& dimension);

/// Returns the shortest decimal text that reads back to the same bits.
[[nodiscard]] std::string number_text(double value);
/// Returns a value as text, "2e-06 m", which reads back to the same bits. `value` is in the SI unit of `dimension`.
[[nodiscard]] std::string quantity_text(double value, const Dimension& dimension);
/// Returns a ratio as text in percent, "15 %" for 0.15, which reads back to the same bits.
[[nodiscard]] std::string percent_text(double value);

}  // namespace softland
