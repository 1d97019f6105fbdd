#include "waveforms/thinned.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "waveforms/driver.h"

namespace softland {
namespace {

constexpr double time_constant = 1e-7, duration = 2e-5;  // [s]
constexpr std::size_t row_count = 20001;

// A ramp to 20 V that is held, with noise.
Table noisy(double noise) {
  Table table;
  for (std::size_t i = 0; i < row_count; ++i) {
    const double time = duration * static_cast<double>(i) / (row_count - 1), share = std::clamp((time - 3e-6) / 1e-7, 0.0, 1.0);
    table.time.push_back(time);
    table.voltage.push_back(20 * share + noise * (2 * random_uniform(3, Stream::scene, i) - 1));
  }
  return table;
}

double largest_difference(const Table& a, const Table& b) {
  const Signal behind_a = internal::filtered(signal(a), time_constant), behind_b = internal::filtered(signal(b), time_constant);
  double largest = 0;
  for (int i = 0; i <= 4000; ++i) {
    const double time = duration * i / 4000;
    largest = std::max(largest, std::abs(behind_a.voltage(time) - behind_b.voltage(time)));
  }
  return largest;
}

TEST(Thinned, TheVoltageBehindTheSourceDiffersByNoMoreThanItSays) {
  for (const double noise : {0.0, 0.05, 0.5}) {
    const Table table = noisy(noise);
    constexpr double asked = 0.02;  // [V]
    const Thinned made = thinned(table, time_constant, asked);
    EXPECT_LE(made.error, asked * (1 + 1e-12));
    EXPECT_LE(largest_difference(table, made.table), made.error + 1e-9) << noise;  // rounding
    EXPECT_LT(made.table.time.size(), row_count / 3) << noise;
    EXPECT_GT(made.error, 0);
  }
  EXPECT_LT(thinned(noisy(0), time_constant, 0.02).table.time.size(), 60U);
}

TEST(Thinned, KeepsRowsOfTheTableTheEndsAndJumps) {
  Table table = noisy(0.05);
  table.time.insert(table.time.begin() + 10000, table.time[10000]);
  table.voltage.insert(table.voltage.begin() + 10000, 5.0);
  const Thinned made = thinned(table, time_constant, 0.02);
  EXPECT_EQ(made.table.time.front(), 0);
  EXPECT_EQ(made.table.time.back(), table.time.back());
  EXPECT_EQ(made.table.voltage.back(), table.voltage.back());
  std::size_t at = 0;
  for (std::size_t i = 0; i < made.table.time.size(); ++i) {
    while (at < table.time.size() && (table.time[at] != made.table.time[i] || table.voltage[at] != made.table.voltage[i])) ++at;
    ASSERT_LT(at, table.time.size()) << "row " << i << " is none of the table";
  }
  EXPECT_EQ(std::count(made.table.time.begin(), made.table.time.end(), table.time[10000]), 2);
  EXPECT_NO_THROW(static_cast<void>(signal(made.table)));
}

TEST(Thinned, ToNoErrorKeepsAllRows) {
  const Table table = noisy(0.05);
  EXPECT_EQ(thinned(table, time_constant, 0).table.time, table.time);
  const Table two{.time = {0, 1}, .voltage = {0, 5}};
  EXPECT_EQ(thinned(two, 1, 1).table.voltage, two.voltage);
}

}  // namespace
}  // namespace softland
