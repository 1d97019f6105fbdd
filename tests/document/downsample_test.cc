#include "document/downsample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace softland::internal {
namespace {

using Column = std::vector<double>;

TEST(Downsampling, KeepsEverythingThatFits) {
  const Column few{1, 2, 3};
  EXPECT_EQ(downsampled({&few}, 4), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(downsampled({}, 10).empty());
}

TEST(Downsampling, KeepsTheExtremesOfEveryColumnAndBothEnds) {
  constexpr std::size_t rows = 20000;
  constexpr std::size_t most = 3000;
  Column smooth(rows), spiky(rows);
  for (std::size_t row = 0; row < rows; ++row) smooth[row] = std::sin(1e-2 * static_cast<double>(row));
  spiky[777] = 5;
  spiky[778] = -4;
  spiky[19001] = 3;
  const std::vector<std::size_t> kept = downsampled({&smooth, &spiky}, most);
  EXPECT_LE(kept.size(), most);
  EXPECT_GT(kept.size(), most / 4);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  const std::set<std::size_t> set(kept.begin(), kept.end());
  EXPECT_EQ(set.size(), kept.size());
  for (const std::size_t row : {std::size_t{0}, std::size_t{777}, std::size_t{778}, std::size_t{19001}, rows - 1})
    EXPECT_TRUE(set.contains(row)) << row;
  for (const Column* column : {&smooth, &spiky}) {
    const auto [low, high] = std::minmax_element(column->begin(), column->end());
    double kept_low = INFINITY, kept_high = -INFINITY;
    for (const std::size_t row : kept) {
      kept_low = std::min(kept_low, (*column)[row]);
      kept_high = std::max(kept_high, (*column)[row]);
    }
    EXPECT_EQ(kept_low, *low);
    EXPECT_EQ(kept_high, *high);
  }
}

TEST(Downsampling, NeverTakesNotANumberForAnExtreme) {
  Column column(1000, 1.0);
  column[500] = std::numeric_limits<double>::quiet_NaN();
  column[501] = 2;
  const std::vector<std::size_t> kept = downsampled({&column}, 8);
  EXPECT_NE(std::find(kept.begin(), kept.end(), 501u), kept.end());
}

}  // namespace
}  // namespace softland::internal
