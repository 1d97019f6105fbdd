#include "document/heat_map.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/random.h"
#include "document/axis.h"
#include "tests/support/not_finite.h"
#include "tests/support/xml.h"

namespace softland::internal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Returns f(i, j) at the cells of a map.
std::vector<double> tabulated(std::size_t columns, std::size_t rows, const std::function<double(double, double)>& f) {
  std::vector<double> values;
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) values.push_back(f(static_cast<double>(i), static_cast<double>(j)));
  }
  return values;
}

double length_of(const ContourLine& line) {
  double length = 0;
  for (std::size_t k = 1; k < line.size(); ++k) length += std::hypot(line[k][0] - line[k - 1][0], line[k][1] - line[k - 1][1]);
  return length;
}

HeatMap map_of(std::vector<double> values, std::size_t columns) {
  const std::size_t rows = values.size() / columns;
  HeatMap map{.x = {"structure.length", "m", {}},
              .y = {"gap.contact", "m", {}},
              .label = "Impact velocity",
              .unit = "m/s",
              .values = std::move(values),
              .missing = {},
              .reasons = {"not computed", "no contact"}};
  for (std::size_t i = 0; i < columns; ++i) map.x.values.push_back(200e-6 + 1e-6 * static_cast<double>(i));
  for (std::size_t j = 0; j < rows; ++j) map.y.values.push_back(1e-6 + 1e-7 * static_cast<double>(j));
  map.missing.assign(map.values.size(), 1);
  return map;
}

TEST(ContourLines, OfAPlaneAreOneStraightLine) {
  const auto lines = contour_lines(tabulated(9, 6, [](double i, double j) { return 2 * i + j; }), 9, 8.5);
  ASSERT_EQ(lines.size(), 1u);
  for (const auto& [i, j] : lines[0]) EXPECT_NEAR(2 * i + j, 8.5, 1e-12);
  // The line runs from the lower edge of the map to the upper one.
  EXPECT_NEAR(length_of(lines[0]), std::hypot(2.5, 5), 1e-12);
}

TEST(ContourLines, OfAConeAreACircleThatEndsWhereItBegins) {
  const auto cone = [](double i, double j) { return std::hypot(i - 20, j - 20); };
  const auto lines = contour_lines(tabulated(41, 41, cone), 41, 12.25);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].front(), lines[0].back());
  // Chords of a circle and linear interpolation between cells: both errors are of second order in the cell size over the
  // radius.
  EXPECT_NEAR(length_of(lines[0]), 2 * M_PI * 12.25, 0.005 * 2 * M_PI * 12.25);
  for (const auto& [i, j] : lines[0]) EXPECT_NEAR(cone(i, j), 12.25, 0.02);
}

TEST(ContourLines, PartTheCornersOfASaddle) {
  // The middle is above the level, so that the two high corners are connected, and each low corner is cut off.
  const auto lines = contour_lines({1, 0, 0, 1}, 2, 0.4);
  ASSERT_EQ(lines.size(), 2u);
  for (const ContourLine& line : lines) {
    ASSERT_EQ(line.size(), 2u);
    const double i = (line[0][0] + line[1][0]) / 2, j = (line[0][1] + line[1][1]) / 2;
    EXPECT_NEAR(std::abs(i - j), 0.6, 1e-12) << "beside a low corner";
  }
}

TEST(ContourLines, KeepAwayFromCellsWithoutAValue) {
  auto values = tabulated(9, 9, [](double i, double) { return i; });
  values[4 * 9 + 4] = kNaN;
  const auto lines = contour_lines(values, 9, 4.5);
  ASSERT_EQ(lines.size(), 2u);
  for (const ContourLine& line : lines) EXPECT_NEAR(length_of(line), 3, 1e-12);
  EXPECT_TRUE(contour_lines(std::vector<double>(81, kNaN), 9, 4.5).empty());
  EXPECT_TRUE(contour_lines({}, 0, 1).empty());
}

TEST(ContourLevels, AreRoundAndWithin) {
  const auto levels = contour_levels({0.13, 0.87}, 9);
  ASSERT_EQ(levels.size(), 7u);
  for (std::size_t k = 0; k < levels.size(); ++k) EXPECT_NEAR(levels[k], 0.2 + 0.1 * static_cast<double>(k), 1e-12);
}

TEST(HeatMap, TellsASmoothFigureFromOneThatJumps) {
  const auto smooth = tabulated(30, 30, [](double i, double j) { return std::sin(i / 6) + j * j / 100; });
  EXPECT_FALSE(is_ragged(smooth, 30));
  std::uint64_t draw = 0;
  EXPECT_TRUE(is_ragged(tabulated(30, 30, [&](double, double) { return random_uniform(1, Stream::scene, draw++); }), 30));
  // A figure that is zero in one half of the map and one in the other half has one line.
  EXPECT_FALSE(is_ragged(tabulated(30, 30, [](double i, double) { return i < 15 ? 0.0 : 1.0; }), 30));
  EXPECT_FALSE(is_ragged({}, 0));
}

TEST(HeatMap, DoesNotSpendItsColoursOnAFewOutliers) {
  auto values = tabulated(20, 20, [](double i, double) { return i; });
  EXPECT_EQ(colour_range(values).high, 19);
  EXPECT_FALSE(colour_range(values).cut_above);
  values[7] = 1e6;
  EXPECT_EQ(colour_range(values).high, 19);
  EXPECT_TRUE(colour_range(values).cut_above);
  EXPECT_FALSE(colour_range(values).cut_below);
  // A single value, and no value.
  EXPECT_LT(colour_range({3, 3}).low, 3);
  EXPECT_GT(colour_range({0, 0}).high, 0);
  EXPECT_EQ(colour_range({kNaN}).low, 0);
}

TEST(HeatMap, IsWellFormedWithAxesInTheirUnitsAndMarkedCells) {
  auto values = tabulated(12, 10, [](double i, double j) { return 0.1 + 0.01 * i + 0.002 * j * j; });
  values[5] = kNaN;
  const std::string svg = "<svg>" + heat_map_elements(map_of(values, 12), 900) + "</svg>";
  EXPECT_EQ(test::xml_fault(svg), "");
  EXPECT_THAT(svg, HasSubstr("structure.length (µm)"));
  EXPECT_THAT(svg, HasSubstr("gap.contact (µm)"));
  EXPECT_THAT(svg, HasSubstr(">mm/s<"));
  EXPECT_THAT(svg, HasSubstr("fill=\"url(#reason-1)\""));
  EXPECT_THAT(svg, HasSubstr(">no contact<"));
  EXPECT_THAT(svg, Not(HasSubstr(">not computed<"))) << "no cell is";
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(HeatMap, BearsOneCellAndNoValues) {
  for (const double value : {3.0, 0.0, kNaN}) {
    const std::string svg = "<svg>" + heat_map_elements(map_of({value}, 1), 900) + "</svg>";
    EXPECT_EQ(test::xml_fault(svg), "") << value;
    EXPECT_THAT(svg, Not(HasSubstr("nan"))) << value;
  }
}

TEST(HeatMap, GrowsByRunsOfColourAndNotByCells) {
  const auto f = [](double i, double j) { return i + j; };
  const std::string svg = heat_map_elements(map_of(tabulated(200, 200, f), 200), 900);
  EXPECT_LT(svg.size(), 300'000u);
}

TEST(ScaleColour, GoesFromDarkBlueToYellow) {
  EXPECT_EQ(scale_colour(0), "#440154");
  EXPECT_EQ(scale_colour(1), "#fde725");
  EXPECT_EQ(scale_colour(0.5), "#21918c");
  EXPECT_EQ(scale_colour(7), scale_colour(1));
}

// Ends of columns that only a damaged or strange store has.
const std::vector<std::array<double, 2>> strange_ends{{1.8e-6, std::nextafter(1.8e-6, 1)},
                                                      {-std::nextafter(30.0, 31), -30},
                                                      {7, 7},
                                                      {0, 0},
                                                      {-1.7e308, 1.7e308},
                                                      {-1.7976931348623157e308, 1.7976931348623157e308},
                                                      {1.7e308, 1.7976931348623157e308},
                                                      {5e-324, 5e-324},
                                                      {0, 5e-324},
                                                      {-5e-324, 5e-324},
                                                      {5e-324, 1.7976931348623157e308},
                                                      {1e15, 1e15 + 0.125},
                                                      {-1e300, 1e-300},
                                                      {-kInfinity, kInfinity},
                                                      {0, kInfinity},
                                                      {kNaN, 1},
                                                      {1, kNaN},
                                                      {2, 1}};

TEST(Ticks, OfAnyEndsAreFewAndBetweenThem) {
  for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic}) {
    for (const auto& [low, high] : strange_ends) {
      for (const int wanted : {3, 5, 8, 9}) {
        const std::vector<double> found = ticks({.scale = scale, .low = low, .high = high}, wanted);
        EXPECT_LE(found.size(), 20u) << low << " " << high;
        for (const double tick : found) {
          const double beyond = 2e-9 * std::abs(tick) + 1e-8 * (high / 4 - low / 4);
          EXPECT_TRUE(std::isfinite(tick) && tick + beyond >= low && tick - beyond <= high) << tick << ": " << low << " " << high;
        }
      }
    }
  }
  EXPECT_EQ(ticks({.scale = AxisScale::linear, .low = -1.7e308, .high = 1.7e308}, 8).size(), 7u);
}

TEST(AxisOfAPicture, GivesAFinitePixelForEveryNumber) {
  for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic}) {
    for (const auto& [low, high] : strange_ends) {
      const Axis axis{.scale = scale, .low = low, .high = high, .pixel_low = 100, .pixel_high = 20};
      for (const double value : {low, high, 0.0, -1.0, 1e308, -1e308, 5e-324, kInfinity, kNaN}) {
        const double pixel = axis.pixel(value);
        EXPECT_TRUE(std::abs(pixel) <= 1e7) << value << " on " << low << " " << high;
      }
    }
  }
  const Axis axis{.scale = AxisScale::linear, .low = -1.6e308, .high = 1.6e308, .pixel_low = 100, .pixel_high = 20};
  EXPECT_DOUBLE_EQ(axis.pixel(0), 60);
  EXPECT_DOUBLE_EQ(axis.pixel(0.8e308), 40);
}

TEST(HeatMaps, OfManyCellsAreThinnedAndSaySo) {
  const HeatMap whole = map_of(tabulated(300, 40, [](double i, double j) { return 1000 * i + j; }), 300);
  const HeatMap map = thinned_map(whole, 2000);
  EXPECT_LE(map.values.size(), 2000u);
  EXPECT_GE(map.values.size(), 1500u);
  ASSERT_EQ(map.values.size(), map.x.values.size() * map.y.values.size());
  EXPECT_EQ(map.missing.size(), map.values.size());
  const auto place = [](const std::vector<double>& values, double value) {
    return static_cast<double>(std::find(values.begin(), values.end(), value) - values.begin());
  };
  for (std::size_t k = 0; k < map.values.size(); ++k) {
    const double i = place(whole.x.values, map.x.values[k % map.x.values.size()]);
    const double j = place(whole.y.values, map.y.values[k / map.x.values.size()]);
    EXPECT_EQ(map.values[k], 1000 * i + j);
  }
  EXPECT_THAT(map.x.label, HasSubstr("structure.length, one in 6 of 300 values"));
  EXPECT_EQ(thinned_map(whole, 12'000).x.label, "structure.length");
}

TEST(HeatMaps, OfAnyNumbersAreDrawn) {
  for (const auto& [low, high] : strange_ends) {
    std::vector<double> values =
        tabulated(5, 4, [&](double i, double j) { return static_cast<int>(i + j) % 2 == 0 ? low : high; });
    values[7] = kNaN;
    HeatMap map = map_of(values, 5);
    const std::string drawn = heat_map_elements(map, 900);
    EXPECT_THAT(drawn, Not(HasSubstr("\"nan"))) << low << " " << high;
    EXPECT_THAT(drawn, Not(HasSubstr("inf"))) << low << " " << high;
    if (!(low < high) || !std::isfinite(low) || !std::isfinite(high)) continue;
    map.x.values = {low, std::midpoint(low, high), high};  // axes have finite numbers
    map.y.values = {low, high};
    map.values.resize(6);
    map.missing.resize(6);
    EXPECT_THAT(heat_map_elements(map, 900), Not(HasSubstr("\"nan"))) << low << " " << high;
  }
}

}  // namespace
}  // namespace softland::internal
