#include "base/engineering.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softland {
namespace {

TEST(Engineering, WritesNumbersAsAScene) {
  EXPECT_EQ(engineering(60e-6, "m"), "60 um");
  EXPECT_EQ(engineering(5.9999999999999995e-05, "m"), "60 um");
  EXPECT_EQ(engineering(0.00025, "m"), "250 um");
  EXPECT_EQ(engineering(-3.5e-6, "m"), "-3.5 um");
  EXPECT_EQ(engineering(78e9, "Pa"), "78 GPa");
  EXPECT_EQ(engineering(1.86e-5, "Pa s"), "18.6 uPa s");
  EXPECT_EQ(engineering(-171e-12, "m/V"), "-171 pm/V");
  EXPECT_EQ(engineering(1, "V"), "1 V");
  EXPECT_EQ(engineering(0.3, "N/m"), "300 mN/m");
}

TEST(Engineering, ChangesThePrefixAtAThousand) {
  EXPECT_EQ(engineering(999e-9, "m"), "999 nm");
  EXPECT_EQ(engineering(1e-6, "m"), "1 um");
  EXPECT_EQ(engineering(std::nextafter(1e-6, 0), "m"), "1 um");
  EXPECT_EQ(engineering(1000, "m"), "1 km");
  EXPECT_EQ(engineering(1e-15, "m"), "1 fm");
}

TEST(Engineering, LeavesOutWhatDoesNotSuit) {
  EXPECT_EQ(engineering(0, "m"), "0 m");
  EXPECT_EQ(engineering(std::nan(""), "m"), "nan m");
  EXPECT_EQ(engineering(INFINITY, "Pa"), "inf Pa");
  EXPECT_EQ(engineering(1e-20, "m"), "1e-20 m");
  EXPECT_EQ(engineering(1e15, "m"), "1e15 m");
  EXPECT_EQ(engineering(19300, "kg/m^3"), "19300 kg/m^3");
  EXPECT_EQ(engineering(1e11, "1/m^2"), "100000000000 1/m^2");
  EXPECT_EQ(engineering(1e-8, "m^2"), "1e-8 m^2") << "nm^2 would be a square nanometre";
  EXPECT_EQ(engineering(1500, "Vdp"), "1500 Vdp");
  EXPECT_EQ(engineering(0.015, "%"), "0.015 %");
  EXPECT_EQ(engineering(0.05, ""), "0.05");
  EXPECT_EQ(engineering(1e-6, ""), "1e-6");
}

TEST(Engineering, RoundsToFewerDigitsWhenAsked) {
  EXPECT_EQ(engineering(31.4159e-9, "m", 3), "31.4 nm");
  EXPECT_EQ(engineering(3.2e-10, "", 1), "3e-10");
  EXPECT_EQ(engineering(1234.5, "", 2), "1234") << "and not 1.2e3";
  EXPECT_EQ(engineering(1000, "", 2), "1000");
  EXPECT_EQ(engineering(123e6, "", 2), "1.2e8");
}

TEST(Engineering, KeepsNumbersApartThatDiffer) {
  EXPECT_EQ(engineering(3.50001e-6, "m"), "3.50001 um");
  EXPECT_EQ(engineering(1.0 / 3, "V"), "333.333333333 mV");
}

}  // namespace
}  // namespace softland
