#include "document/quantity.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <sstream>

#include "config/units.h"
#include "tests/support/not_finite.h"
#include "tests/support/printed.h"

namespace softland::internal {
namespace {

TEST(Quantity, CarriesAPrefixThreeDigitsAndANoBreakSpace) {
  EXPECT_EQ(quantity(4.45e-5, "s"), "44.5\u00a0µs");
  EXPECT_EQ(quantity(803.1e-9, "m"), "803\u00a0nm");
  EXPECT_EQ(quantity(0.1328, "m/s"), "133\u00a0mm/s");
  EXPECT_EQ(quantity(28.087, "V", 4), "28.09\u00a0V");
  EXPECT_EQ(quantity(1e-9, "m", 1), "1\u00a0nm");
  EXPECT_EQ(quantity(2.25e6, "rad/s"), "2.25\u00a0Mrad/s");
}

TEST(Quantity, HasATrueMinusSign) {
  EXPECT_EQ(quantity(-0.25, "V"), "−250\u00a0mV");
  EXPECT_EQ(plain_number(-2.5), "−2.5");
}

TEST(Quantity, RoundsBeforeItChoosesThePrefix) {
  EXPECT_EQ(quantity(999.96e-6, "s"), "1.00\u00a0ms");
  EXPECT_EQ(quantity(999.4e-6, "s"), "999\u00a0µs");
}

TEST(Quantity, OfNothingIsADashAndOfZeroIsZero) {
  EXPECT_EQ(quantity(kNaN, "s"), "—");
  EXPECT_EQ(quantity(std::numeric_limits<double>::infinity(), "s"), "—");
  EXPECT_EQ(quantity(0, "m"), "0\u00a0m");
  EXPECT_EQ(quantity(-0.0, "m"), "0\u00a0m");
  EXPECT_EQ(quantity_beside(0, 803.1e-9, "m"), "0\u00a0nm");
}

TEST(Quantity, ShowsNothingBelowTheResolutionOfItsUnit) {
  EXPECT_EQ(quantity(35.3e-15, "m"), "< 1\u00a0pm");
  EXPECT_EQ(quantity(26e-18, "s"), "< 1\u00a0fs");
  EXPECT_EQ(quantity(7.3e-33, "J"), "< 1\u00a0zJ");
  EXPECT_EQ(quantity(-26e-18, "s"), "0\u00a0s");
  EXPECT_EQ(quantity(2.449e-12, "m"), "2\u00a0pm") << "not 2.45 pm";
}

TEST(Quantity, IsRoundedToItsError) {
  EXPECT_EQ(quantity_within(306.8e-6, 12e-6, "s", 4), "307\u00a0µs");
  EXPECT_EQ(error_of(306.8e-6, 12e-6, "s", 4), "12\u00a0µs");
  EXPECT_EQ(quantity_within(306.8e-6, 34e-6, "s", 4), "310\u00a0µs");
  EXPECT_EQ(error_of(306.8e-6, 34e-6, "s", 4), "40\u00a0µs");
  EXPECT_EQ(quantity_within(34.2694e-6, 43e-15, "s", 4), "34.27\u00a0µs");
  EXPECT_EQ(error_of(34.2694e-6, 43e-15, "s", 4), "< 0.01\u00a0µs");
  EXPECT_EQ(quantity_within(2e-9, 30e-9, "m", 4), "0\u00a0nm");
  EXPECT_EQ(error_of(2e-9, 30e-9, "m", 4), "30\u00a0nm");
  EXPECT_EQ(error_of(0, 30e-18, "m", 4), "< 1\u00a0pm");
  EXPECT_EQ(error_of(0, 2e-9, "m", 4), "2\u00a0nm");
  EXPECT_EQ(quantity_within(54, 2, "", 4), "54");
  EXPECT_EQ(error_of(54, 2, "", 4), "2");
  EXPECT_EQ(error_of(54, 0, "", 4), "0");
  EXPECT_EQ(quantity_within(54, kNaN, "", 4), "54");
  EXPECT_EQ(error_of(54, kNaN, "", 4), "—");
}

/// A printed quantity, parsed.
struct Printed {
  double value = 0;
  double last_place = 0;  ///< value of one unit in the last digit; zeros before the unit do not count as digits
  int digits = 0;         ///< number of digits from the first nonzero one
  bool bound = false;     ///< true for "< 1 pm"
};

std::optional<Printed> read_back(std::string text, const std::string& unit) {
  if (unit == "V/s" && text.ends_with("V/µs")) {
    std::optional<Printed> fast = read_back(text, "V/µs");
    if (fast) fast->value *= 1e6, fast->last_place *= 1e6;
    return fast;
  }
  Printed p;
  if (text.starts_with("< ")) {
    p.bound = true;
    text.erase(0, 2);
  }
  const std::size_t space = text.find("\u00a0");
  if (space == std::string::npos) return std::nullopt;
  const std::string named = text.substr(space + 2);
  if (!named.ends_with(unit)) return std::nullopt;
  const std::string prefix = named.substr(0, named.size() - unit.size());
  const std::vector<std::pair<std::string, double>> factors{{"y", 1e-24}, {"z", 1e-21}, {"a", 1e-18}, {"f", 1e-15}, {"p", 1e-12},
                                                            {"n", 1e-9},  {"µ", 1e-6},  {"m", 1e-3},  {"", 1.0},    {"k", 1e3},
                                                            {"M", 1e6},   {"G", 1e9},   {"T", 1e12}};
  const auto factor = std::find_if(factors.begin(), factors.end(), [&](const auto& one) { return one.first == prefix; });
  if (factor == factors.end()) return std::nullopt;
  std::string number = text.substr(0, space);
  const bool negative = number.starts_with("−");
  if (negative) number.erase(0, std::string("−").size());
  if (number.find_first_not_of("0123456789.") != std::string::npos) return std::nullopt;
  const std::size_t point = number.find('.'), end = number.find_last_not_of('0') + 1;
  const std::size_t zeros = point == std::string::npos && end > 0 ? number.size() - end : 0;
  const std::size_t decimals = point == std::string::npos ? 0 : number.size() - point - 1;
  p.last_place = factor->second * std::pow(10, static_cast<double>(zeros) - static_cast<double>(decimals));
  p.value = (negative ? -1 : 1) * std::stod(number) * factor->second;
  std::erase(number, '.');
  const std::size_t first = number.find_first_not_of('0');
  p.digits = first == std::string::npos ? 0 : static_cast<int>(number.size() - first);
  return p;
}

TEST(Quantity, OfAFastSlewIsInVoltsPerMicrosecond) {
  EXPECT_EQ(quantity(2e7, "V/s"), "20.0\u00a0V/µs");
  EXPECT_EQ(given_quantity(1e6, "V/s"), "1\u00a0V/µs");
  EXPECT_EQ(quantity(999, "V/s"), "999\u00a0V/s");
  EXPECT_EQ(quantity_beside(0, 2e7, "V/s"), "0\u00a0V/µs");
  EXPECT_EQ(quantity_within(2e7, 3e4, "V/s", 4), "20.00\u00a0V/µs");
  EXPECT_EQ(error_of(2e7, 3e4, "V/s", 4), "0.03\u00a0V/µs");
}

TEST(Quantity, NeverSaysMoreThanIsKnownNorLessThanIsAskedFor) {
  std::mt19937_64 generator(1);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(generator); };
  constexpr double slack = 1 + 1e-9;  // factor for the rounding of parsed numbers
  constexpr int runs = 20000;
  for (int run = 0; run < runs; ++run) {
    const std::vector<std::string> units{"m", "s", "m/s", "N", "J", "V", "V/s", "Hz", "N s/m^2"};
    const std::string& unit = units[generator() % units.size()];
    const int digits = 1 + static_cast<int>(generator() % 5);
    const double value = (generator() % 2 == 0 ? 1 : -1) * std::pow(10, uniform(-23, 11));
    const bool known = generator() % 2 == 0;
    const double error = known ? std::abs(value) * std::pow(10, uniform(-12, 2)) : kNaN;
    const std::string text = quantity_within(value, error, unit, digits);
    const auto p = read_back(text, unit);
    ASSERT_TRUE(p) << text << " of " << value;
    const double least = resolution(unit);
    if (p->bound) {
      EXPECT_LT(value, least) << text;
      EXPECT_GT(value, 0) << text;
      continue;
    }
    // No digit is below the resolution, below the second digit of the error, or beyond the requested digits; "300" has three
    // digits.
    EXPECT_GE(p->last_place * slack, least) << text << " of " << value;
    if (known && p->value != 0) {
      EXPECT_LE(error, 20 * slack * p->last_place) << text << " known to " << error;
    }
    EXPECT_LE(p->digits, std::max(digits, 3)) << text << " of " << value;
    // The error of the text is at most half of its last digit, half of the last requested digit, or the error of the value.
    const double asked = std::pow(10, std::floor(std::log10(std::abs(value))) - digits + 1);
    const double allowed = std::max({asked, least, known ? error : 0.0});
    EXPECT_LE(std::abs(p->value - value), 0.5 * slack * allowed + 1e-12 * std::abs(value))
        << text << " of " << value << " known to " << error << ", " << digits << " digits";
  }
}

TEST(ErrorOf, HasTwoDigitsAndIsABoundWhereTheValueHidesIt) {
  std::mt19937_64 generator(2);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(generator); };
  constexpr int runs = 20000;
  for (int run = 0; run < runs; ++run) {
    const double value = std::pow(10, uniform(-11, -2)), error = value * std::pow(10, uniform(-12, 2));
    const std::string shown = quantity_within(value, error, "m", 4), text = error_of(value, error, "m", 4);
    const auto v = read_back(shown, "m"), e = read_back(text, "m");
    ASSERT_TRUE(v && e) << shown << " ± " << text;
    if (v->bound) continue;
    EXPECT_LE(e->digits, 3) << shown << " ± " << text;  // two digits, and the 0 of "110 µm"
    if (e->bound) {
      EXPECT_LT(error, e->value) << shown << " ± " << text;
    } else {
      EXPECT_GE(e->value / error, 1 - 1e-8) << shown << " ± " << text << " of " << error;
      EXPECT_LE(e->value / error, 2.001) << shown << " ± " << text << " of " << error;  // half of the last digit rounds up
    }
  }
}

TEST(AbsurdNumber, FindsWhatUsedToBePrinted) {
  for (const char* text : {"35.3 fm", "26 as", "890 zs", "41 pm/s", "140 aN", "0.0000000073 yJ", "1.41e+07 times lower",
                           "2.5e-04 m", "2.5e-4 m", "fell to -3 V", "2.1590012 GHz", "14100000 times lower"})
    EXPECT_NE(absurd_number(text), "") << text;
  for (const char* text :
       {"35 pm", "< 1 fs", "known to 1e-9", "−3 V", "54 times", "1.234 nm", "1e-7, 2 modes", "1-2", "120476 rhs"})
    EXPECT_EQ(absurd_number(text), "") << text;
}

TEST(GivenQuantity, HasNoTrailingZeros) {
  EXPECT_EQ(given_quantity(30, "V"), "30\u00a0V");
  EXPECT_EQ(given_quantity(17.7673, "V", 5), "17.767\u00a0V");
  EXPECT_EQ(given_quantity(-1, "V"), "−1\u00a0V");
  EXPECT_EQ(given_quantity(600e-6, "s"), "600\u00a0µs");
  EXPECT_EQ(given_quantity(1e-15, "m"), "< 1\u00a0pm");
}

TEST(PlainNumber, KeepsWholeNumbersWhole) {
  EXPECT_EQ(plain_number(2500), "2500");
  EXPECT_EQ(plain_number(57), "57");
  EXPECT_EQ(plain_number(0.00325), "0.00325");
  EXPECT_EQ(plain_number(2.0123), "2.01");
  EXPECT_EQ(plain_number(0), "0");
  EXPECT_EQ(plain_number(1.41e7), "1.41e7");
  EXPECT_EQ(plain_number(-2e-5), "−2e-5");
}

TEST(Scientific, IsWrittenAsInAScene) {
  EXPECT_EQ(scientific(1e-4), "1e-4");
  EXPECT_EQ(scientific(2.46e-9), "2.5e-9");
  EXPECT_EQ(relative_error(0), "0");
  EXPECT_EQ(relative_error(9e-12), "< 1e-9");
  EXPECT_EQ(relative_error(kNaN), "—");
}

TEST(Quantity, IsReadAgainByAScene) {
  for (const char* unit : {"m", "s", "V", "m/s", "N", "J", "V/s", "Hz", "rad/s", "rad", "Pa", "N/m", "N s/m^2"}) {
    for (int exponent = -24; exponent <= 14; ++exponent) {
      for (const double digits : {1.0, -2.5, 9.87654}) {
        const double value = digits * std::pow(10, exponent);
        for (const std::string& text : {quantity(value, unit), given_quantity(value, unit)}) {
          if (text.starts_with("<")) continue;  // a bound instead of a number
          Quantity read;
          ASSERT_NO_THROW(read = parse_quantity(text)) << text;
          const double shown = std::abs(value) < resolution(unit) ? 0 : value;
          EXPECT_NEAR(read.value, shown, 0.006 * std::abs(value) + resolution(unit)) << text;
          EXPECT_EQ(read.dimension, parse_quantity(std::string("1 ") + unit).dimension) << text;
        }
      }
    }
  }
}

TEST(Times, EndAtAThousand) {
  EXPECT_EQ(times(8.43), "8.4 times");
  EXPECT_EQ(times(107.2), "107 times");
  EXPECT_EQ(times(1.41e7), "more than 1000 times");
  EXPECT_EQ(percent(0.212), "21.2 %");
  EXPECT_EQ(percent(53.1), "53 times");
  EXPECT_EQ(relative_change(-0.055), "−5.5 %");
  EXPECT_EQ(relative_change(0.25), "+25.0 %");
  EXPECT_EQ(relative_change(-1e-9), "0.0 %");
  EXPECT_EQ(relative_change(53.09), "× 54");
  EXPECT_EQ(relative_change(1e6), "> × 1000");
}

TEST(Share, IsFullOnlyForAllAndNoneOnlyForNone) {
  EXPECT_EQ(share_text(0.212), "21.2 %");
  EXPECT_EQ(share_text(127.0 / 128), "99.2 %");
  EXPECT_EQ(share_text(1), "100 %");
  EXPECT_EQ(share_text(0), "0.0 %");
  EXPECT_EQ(share_text(2999.0 / 3000), "> 99.9 %");
  EXPECT_EQ(share_text(1.0 / 3000), "< 0.1 %");
  EXPECT_EQ(share_text(0.1 * 3 + 0.7), "100 %");
  EXPECT_EQ(share_text(1 - (0.7 + 0.2 + 0.1)), "0.0 %") << "a rounding error is no device";
  EXPECT_EQ(share_text(std::numeric_limits<double>::quiet_NaN()), "—");
  EXPECT_EQ(share_number(0.25), "25.0");
}

TEST(Quantity, BeyondThePrefixesHasAnExponent) {
  EXPECT_EQ(quantity(1e300, "s"), "1e300\u00a0s");
  EXPECT_EQ(quantity(-1.797e308, "V"), "−1.8e308\u00a0V") << "rounded it would be infinite";
  EXPECT_EQ(quantity(2.5e-300, "Hz"), "2.5e-300\u00a0Hz");
  EXPECT_EQ(given_quantity(1.5e20, "m"), "1.5e20\u00a0m");
  EXPECT_EQ(error_of(1e300, 3e297, "s", 4), "3e297\u00a0s");
  EXPECT_EQ(error_of(5e-324, 5e-324, ""), "5e-324");
  EXPECT_EQ(whole(12345678), "12345678");
  EXPECT_EQ(whole(1e300), "1e300");
}

}  // namespace
}  // namespace softland::internal
