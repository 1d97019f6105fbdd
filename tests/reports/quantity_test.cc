#include "reports/quantity.h"

#include <gtest/gtest.h>

#include <limits>

namespace softland::internal {
namespace {

TEST(Quantity, CarriesAPrefixThreeDigitsAndANoBreakSpace) {
  EXPECT_EQ(quantity(4.45e-5, "s"), "44.5\u00a0µs");
  EXPECT_EQ(quantity(803.1e-9, "m"), "803\u00a0nm");
  EXPECT_EQ(quantity(0.1328, "m/s"), "133\u00a0mm/s");
  EXPECT_EQ(quantity(28.087, "V", 4), "28.09\u00a0V");
  EXPECT_EQ(quantity(-0.25, "V"), "-250\u00a0mV");
  EXPECT_EQ(quantity(1e-9, "m", 1), "1\u00a0nm");
  EXPECT_EQ(quantity(3.5e-23, "J", 2), "35\u00a0yJ");
}

TEST(Quantity, RoundsBeforeItChoosesThePrefix) {
  EXPECT_EQ(quantity(999.96e-6, "s"), "1.00\u00a0ms");
  EXPECT_EQ(quantity(999.4e-6, "s"), "999\u00a0µs");
}

TEST(Quantity, OfNothingIsADashAndOfZeroIsZero) {
  EXPECT_EQ(quantity(std::numeric_limits<double>::quiet_NaN(), "s"), "—");
  EXPECT_EQ(quantity(std::numeric_limits<double>::infinity(), "s"), "—");
  EXPECT_EQ(quantity(0, "m"), "0\u00a0m");
  EXPECT_EQ(quantity_beside(0, 803.1e-9, "m"), "0\u00a0nm");
}

TEST(PlainNumber, KeepsWholeNumbersWhole) {
  EXPECT_EQ(plain_number(2500), "2500");
  EXPECT_EQ(plain_number(57), "57");
  EXPECT_EQ(plain_number(0.00325), "0.00325");
  EXPECT_EQ(plain_number(2.0123), "2.01");
  EXPECT_EQ(plain_number(0), "0");
}

}  // namespace
}  // namespace softland::internal
