#include "config/units.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "base/engineering.h"
#include "base/require.h"

namespace softland {
namespace {

struct Good {
  std::string text;
  double value;
  Dimension dimension;
};

std::ostream& operator<<(std::ostream& out, const Good& good) { return out << good.text; }

class GoodQuantity : public testing::TestWithParam<Good> {};

// Values are compared exactly: a decimal prefix must not cause rounding.
TEST_P(GoodQuantity, IsReadExactly) {
  const Quantity quantity = parse_quantity(GetParam().text);
  EXPECT_EQ(quantity.value, GetParam().value);
  EXPECT_EQ(quantity.dimension, GetParam().dimension) << describe(quantity.dimension);
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Units, GoodQuantity, testing::Values(
    Good{"2 m", 2, dimension::length},
    Good{"2 um", 2e-6, dimension::length},
    Good{"2e0 um", 2e-6, dimension::length},
    Good{"+2.0 um", 2e-6, dimension::length},
    Good{"  2\tum ", 2e-6, dimension::length},
    Good{".5 m", 0.5, dimension::length},
    Good{"5. m", 5, dimension::length},
    Good{"1E3 fm", 1e-12, dimension::length},
    Good{"1 km", 1e3, dimension::length},
    Good{"250 \u00b5m", 250e-6, dimension::length},
    Good{"250\u00a0\u03bcm", 250e-6, dimension::length},
    Good{"3 V/\u00b5s", 3e6, dimension::slew_rate},
    Good{"100 1/\u03bcm\u00b2", 1e14, dimension::area_density},
    Good{"\u2212171\u202fpm/V", -171e-12, dimension::piezo_coefficient},
    Good{"1 N\u00b7m", 1, dimension::energy},
    Good{"19300 kg/m\u00b3", 19300, dimension::density},
    Good{"26 as", 26e-18, dimension::time},
    Good{"1 mm", 1e-3, dimension::length},
    Good{"1e+2 nm", 1e-7, dimension::length},
    Good{"1 kg", 1, dimension::mass},
    Good{"1 g", 1e-3, dimension::mass},
    Good{"1 mg", 1e-6, dimension::mass},
    Good{"1 us", 1e-6, dimension::time},
    Good{"1 mPa", 1e-3, dimension::pressure},
    Good{"1 m Pa", 1, dimension::stiffness},
    Good{"1 m*Pa", 1, dimension::stiffness},
    Good{"1 Pa * m", 1, dimension::stiffness},
    Good{"78 GPa", 78e9, dimension::pressure},
    Good{"1 MN/m^2", 1e6, dimension::pressure},
    Good{"1.86e-5 Pa s", 1.86e-5, dimension::viscosity},
    Good{"1.86e-5 kg/m s", 1.86e-5, dimension::viscosity},
    Good{"19300 kg/m^3", 19300, dimension::density},
    Good{"19300 kg/m3", 19300, dimension::density},
    Good{"100 um2", 1e-10, dimension::area},
    Good{"100 1/um2", 1e14, dimension::area_density},
    Good{"5 N/cm2", 5e4, dimension::pressure},
    Good{"19.3 g m^-3", 19.3e-3, dimension::density},
    Good{"100 1/um^2", 1e14, dimension::area_density},
    Good{"100 um^-2", 1e14, dimension::area_density},
    Good{"-171 pm/V", -171e-12, dimension::piezo_coefficient},
    Good{"1.6 %/V", 0.016, dimension::inverse_voltage},
    Good{"16 1/kV", 0.016, dimension::inverse_voltage},
    Good{"-171 pC/N", -171e-12, dimension::piezo_coefficient},
    Good{"3 V/us", 3e6, dimension::slew_rate},
    Good{"30 kHz", 30e3, dimension::frequency},
    Good{"30 1/s", 30, dimension::frequency},
    Good{"180543 rad/s", 180543, dimension::angular_frequency},
    Good{"1 Mrad/s", 1e6, dimension::angular_frequency},
    Good{"180 deg", std::numbers::pi, dimension::angle},
    Good{"20 degC", 293.15, dimension::temperature},
    Good{"-273.15 degC", 0, dimension::temperature},
    Good{"1 mK", 1e-3, dimension::temperature},
    Good{"15 %", 0.15, dimension::none},
    Good{"0.15", 0.15, dimension::none},
    Good{"1.25 Vdp", 1.25, dimension::dynamic_pull_in},
    Good{"1.25 Vsp", 1.25, dimension::static_pull_in},
    Good{"2 N m", 2, dimension::energy},
    Good{"2 J", 2, dimension::energy},
    Good{"2 W s", 2, dimension::energy},
    Good{"2 C V", 2, dimension::energy},
    Good{"2 V/A", 2, dimension::resistance},
    Good{"2 C/V", 2, dimension::capacitance},
    Good{"2 1/ohm", 2, dimension::conductance},
    Good{"100um", 100e-6, dimension::length},
    Good{"-2.5e-3mm", -2.5e-6, dimension::length},
    Good{"1.86e-5Pa s", 1.86e-5, dimension::viscosity},
    Good{"20degC", 293.15, dimension::temperature},
    Good{"15%", 0.15, dimension::none},
    Good{"1.25Vdp", 1.25, dimension::dynamic_pull_in},
    Good{"2 cm", 2e-2, dimension::length},
    Good{"2.33 g/cm^3", 2330, dimension::density},
    Good{"1 1/cm^2", 1e4, dimension::area_density},
    Good{"1013.25 hPa", 101325, dimension::pressure},
    Good{"1 bar", 1e5, dimension::pressure},
    Good{"10 mbar", 1e3, dimension::pressure},
    Good{"1 atm", 101325, dimension::pressure},
    Good{"760 Torr", 101325, dimension::pressure},
    Good{"-9.3 C/m^2", -9.3, dimension::charge_density},
    Good{"1.3e-5 N s/m", 1.3e-5, dimension::damping},
    Good{"25 MS/s", 25e6, dimension::frequency},
    Good{"25MS/s", 25e6, dimension::frequency},
    Good{"100 S/s", 100, dimension::frequency},
    Good{"2 MS", 2e6, dimension::conductance},
    Good{"2 m/m", 2, dimension::none}));
// clang-format on

struct Bad {
  std::string text;
  std::string message;
};

std::ostream& operator<<(std::ostream& out, const Bad& bad) { return out << bad.text; }

class BadQuantity : public testing::TestWithParam<Bad> {};

TEST_P(BadQuantity, IsRefusedWithTheRule) {
  try {
    const Quantity quantity = parse_quantity(GetParam().text);
    FAIL() << quantity.value << " " << describe(quantity.dimension);
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.what(), GetParam().message);
  }
}

constexpr const char* no_number = "must be a number and a unit";

// clang-format off
INSTANTIATE_TEST_SUITE_P(Units, BadQuantity, testing::Values(
    Bad{"", no_number},
    Bad{"um", no_number},
    Bad{"2,5 um", no_number},
    Bad{"--2 um", no_number},
    Bad{"2e um", "unknown unit 'e'"},
    Bad{"0x2 um", "unknown unit 'x2'"},
    Bad{"2_um", no_number},
    Bad{"2/um", no_number},
    Bad{"inf m", no_number},
    Bad{"nan m", no_number},
    Bad{"1_000 m", no_number},
    Bad{". m", no_number},
    Bad{"2 u", "unknown unit 'u'"},
    Bad{"2 UM", "unknown unit 'UM' (did you mean 'um'?)"},
    Bad{"2 min", "unknown unit 'min'"},
    Bad{"2 dm", "unknown unit 'dm'"},
    Bad{"2 cs", "unknown unit 'cs'"},
    Bad{"2 hN", "unknown unit 'hN'"},
    Bad{"2 katm", "unknown unit 'katm'"},
    Bad{"2 \xc2\xb5", "unknown unit 'u'"},
    Bad{"2 \xc2m", "unknown unit '\xc2m'"},
    Bad{"\u22122\u22121 m", no_number},
    Bad{"2 mVdp", "unknown unit 'mVdp'"},
    Bad{"2 k%", "unknown unit 'k%'"},
    Bad{"2 kdeg", "unknown unit 'kdeg'"},
    Bad{"2 1", "unknown unit '1'"},
    Bad{"2 m 1", "unknown unit '1'"},
    Bad{"2 3 m", "unknown unit '3'"},
    Bad{"2 s2", "unknown unit 's2'"},
    Bad{"2 m1", "unknown unit 'm1'"},
    Bad{"2 m-2", "unknown unit 'm-2'"},
    Bad{"2 m22", "unknown unit 'm22'"},
    Bad{"2 m^", "'m^' needs an integer power between -9 and 9, not 0"},
    Bad{"2 m^0", "'m^0' needs an integer power between -9 and 9, not 0"},
    Bad{"2 m^2.5", "'m^2.5' needs an integer power between -9 and 9, not 0"},
    Bad{"2 m^10", "'m^10' needs an integer power between -9 and 9, not 0"},
    Bad{"2 m^9 m^9", "with 'm^9' the power of m in the unit is 18; it must lie between -9 and 9"},
    Bad{"2 1/N^5", "with 'N^5' the power of s in the unit is 10; it must lie between -9 and 9"},
    Bad{"2 m^99999999999", "'m^99999999999' needs an integer power between -9 and 9, not 0"},
    Bad{"2 m ^2", "unknown unit ''"},
    Bad{"2 m/s/s", "more than one '/' in the unit 'm/s/s'"},
    Bad{"2 m/", "a factor is missing in the unit 'm/'"},
    Bad{"2 /m", "a factor is missing in the unit '/m'"},
    Bad{"2 m**s", "a factor is missing in the unit 'm**s'"},
    Bad{"2 *m", "a factor is missing in the unit '*m'"},
    Bad{"2 J/degC", "'degC' has an offset and can only stand alone; use K here"},
    Bad{"2 mdegC", "unknown unit 'mdegC'"},
    Bad{"1e400 m", "1e400 is outside the range of double precision"},
    Bad{"1e99999999999 m", "1e99999999999 is outside the range of double precision"},
    Bad{"1e308 km", "1e308 is outside the range of double precision"},
    Bad{"1e308 deg^-9", "1e308 deg^-9 is outside the range of double precision"}));
// clang-format on

TEST(Unit, OfWrongCaseIsAnsweredWithTheRightOne) {
  const auto refused = [](const char* text) {
    try {
      (void)parse_quantity(text);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused("1 torr"), "unknown unit 'torr' (did you mean 'Torr'?)");
  EXPECT_EQ(refused("1 KHz"), "unknown unit 'KHz' (did you mean 'kHz'?)");
  EXPECT_EQ(refused("1 Mv"), "unknown unit 'Mv' (did you mean 'MV'?)");
  EXPECT_EQ(refused("1 pa"), "unknown unit 'pa' (did you mean 'pA' or 'Pa'?)");
  EXPECT_EQ(refused("1 furlong"), "unknown unit 'furlong'");
}

TEST(Units, EveryPrefixGoesWithEveryUnitThatTakesOne) {
  struct Prefix {
    std::string text;
    int exponent;
  };
  const std::vector<Prefix> prefixes{{"y", -24},     {"z", -21},     {"a", -18}, {"f", -15}, {"p", -12}, {"n", -9}, {"u", -6},
                                     {"\u00b5", -6}, {"\u03bc", -6}, {"m", -3},  {"k", 3},   {"M", 6},   {"G", 9},  {"T", 12}};
  for (const char* unit : {"m", "g", "s", "A", "K", "Pa", "N", "J", "W", "V", "C", "F", "ohm", "S", "Hz", "rad", "bar"}) {
    const Quantity plain = parse_quantity(std::string("1 ") + unit);
    const int own = std::string(unit) == "g" ? -3 : std::string(unit) == "bar" ? 5 : 0;
    for (const Prefix& prefix : prefixes) {
      const Quantity scaled = parse_quantity("2.5 " + prefix.text + unit);
      EXPECT_EQ(scaled.value, std::stod("2.5e" + std::to_string(prefix.exponent + own))) << prefix.text << unit;
      EXPECT_EQ(scaled.dimension, plain.dimension) << prefix.text << unit;
    }
  }
  for (const char* unit : {"deg", "%", "Vsp", "Vdp"}) {
    EXPECT_NO_THROW((void)parse_quantity(std::string("1 ") + unit));
    for (const Prefix& prefix : prefixes) {
      EXPECT_THROW((void)parse_quantity("1 " + prefix.text + unit), InvalidInput) << prefix.text << unit;
    }
  }
}

TEST(Units, NumbersOfMessagesReadBack) {
  for (const char* unit : {"m",   "s",  "V",      "N",     "J",   "Pa", "Pa s",  "N/m", "m/V", "s/m",     "V/s",
                           "m/s", "kg", "kg/m^3", "1/m^2", "m^2", "Hz", "rad/s", "K",   "Vdp", "N s/m^2", "J/m^2"}) {
    for (int exponent = -30; exponent <= 30; ++exponent) {
      const double value = std::stod("-1.25e" + std::to_string(exponent));
      const Quantity read = parse_quantity(engineering(value, unit));
      EXPECT_NEAR(read.value, value, 1e-11 * std::abs(value)) << engineering(value, unit);
      EXPECT_EQ(read.dimension, parse_quantity(std::string("1 ") + unit).dimension) << engineering(value, unit);
    }
  }
}

TEST(Units, TwoWaysToWriteANumberGiveTheSameBits) {
  EXPECT_EQ(parse_quantity("0.1 um").value, parse_quantity("100 nm").value);
  EXPECT_EQ(parse_quantity("0.3 mm").value, parse_quantity("3e-4 m").value);
}

TEST(Units, AreNamedForPeople) {
  EXPECT_EQ(describe(dimension::length), "a length [m]");
  EXPECT_EQ(describe(dimension::none), "a plain number");
  EXPECT_EQ(describe(parse_quantity("1 m/s^2").dimension), "a quantity [m s^-2]");
  EXPECT_EQ(unit_symbol(dimension::density), "kg/m^3");
}

TEST(Units, TheExampleOfADimensionHasThatDimension) {
  for (const Dimension& dimension : {dimension::none,
                                     dimension::length,
                                     dimension::mass,
                                     dimension::time,
                                     dimension::current,
                                     dimension::temperature,
                                     dimension::angle,
                                     dimension::static_pull_in,
                                     dimension::dynamic_pull_in,
                                     dimension::area,
                                     dimension::velocity,
                                     dimension::area_density,
                                     dimension::density,
                                     dimension::frequency,
                                     dimension::angular_frequency,
                                     dimension::force,
                                     dimension::energy,
                                     dimension::power,
                                     dimension::pressure,
                                     dimension::viscosity,
                                     dimension::stiffness,
                                     dimension::voltage,
                                     dimension::slew_rate,
                                     dimension::charge,
                                     dimension::capacitance,
                                     dimension::resistance,
                                     dimension::conductance,
                                     dimension::piezo_coefficient,
                                     dimension::charge_density,
                                     dimension::damping}) {
    EXPECT_EQ(parse_quantity(example(dimension)).dimension, dimension) << example(dimension);
    EXPECT_EQ(parse_quantity("1 " + unit_symbol(dimension)).dimension, dimension) << unit_symbol(dimension);
    EXPECT_EQ(parse_quantity("1 " + unit_symbol(dimension)).value, 1) << unit_symbol(dimension);
  }
}

TEST(Units, AnyFiniteNumberReadsBackToTheSameBits) {
  const bool holds = rc::check([](std::uint64_t bits) {
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    RC_PRE(std::isfinite(value));
    for (const Dimension& dimension : {dimension::length, dimension::density, dimension::piezo_coefficient, dimension::none}) {
      const double read = parse_quantity(quantity_text(value, dimension)).value;
      RC_ASSERT(std::memcmp(&read, &value, sizeof value) == 0);
    }
  });
  EXPECT_TRUE(holds);
}

TEST(Units, APercentageHasTheDigitsOfItsRatio) {
  EXPECT_EQ(percent_text(0.15), "15 %");
  EXPECT_EQ(percent_text(0.035), "3.5 %");
  EXPECT_EQ(percent_text(1), "100 %");
  EXPECT_EQ(percent_text(-1.125), "-112.5 %");
  EXPECT_EQ(percent_text(0), "0 %");
  EXPECT_EQ(percent_text(5e-4), "5e-2 %");
  EXPECT_EQ(percent_text(1e300), "1e302 %");
  const bool holds = rc::check([](std::uint64_t bits) {
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    RC_PRE(std::isfinite(value) && std::abs(value) < 1e300);
    RC_ASSERT(parse_quantity(percent_text(value)).value == value);
    const double near = std::fmod(value, 10);
    RC_ASSERT(parse_quantity(percent_text(near)).value == near);
  });
  EXPECT_TRUE(holds);
}

TEST(Units, ExtremeNumbersReadBackToTheSameBits) {
  for (const double value : {std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::min(),
                             std::numeric_limits<double>::max(), -0.0, 0.1, 1.0 / 3.0}) {
    const double read = parse_quantity(quantity_text(value, dimension::voltage)).value;
    EXPECT_EQ(std::memcmp(&read, &value, sizeof value), 0) << value;
  }
}

}  // namespace
}  // namespace softland
