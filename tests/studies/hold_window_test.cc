// Hold levels that keep devices closed: for given ranges, and for simulated devices.
#include "studies/devices/hold_window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "studies/devices/ensemble.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

TEST(HoldWindow, LeavesOutAsManyAsItMay) {
  std::vector<ClosedRange> devices;
  for (int i = 0; i < 200; ++i) devices.push_back({.release = 10 + 0.01 * i, .pulled_through = 30 + 0.02 * i});
  const HoldWindow all = hold_window(devices);
  EXPECT_DOUBLE_EQ(all.lower, 10 + 0.01 * 197) << "two of 200 may be lost";
  EXPECT_DOUBLE_EQ(all.upper, 30 + 0.02 * 2);
  devices[0].release = nowhere;  // no level holds this device
  const HoldWindow fewer = hold_window(devices);
  EXPECT_DOUBLE_EQ(fewer.lower, 10 + 0.01 * 198);
  EXPECT_DOUBLE_EQ(fewer.upper, 30 + 0.02 * 2) << "of which one is the first, another the one after it";
}

TEST(HoldWindow, IsOpenWhereNoneIsPulledThroughAndNoneWhereTooManyCannotBeHeld) {
  std::vector<ClosedRange> devices(100, {.release = 10, .pulled_through = nowhere});
  devices[7].pulled_through = 20;
  EXPECT_EQ(hold_window(devices).lower, 10);
  EXPECT_EQ(hold_window(devices).upper, std::numeric_limits<double>::infinity()) << "but for one of a hundred";
  devices[8].pulled_through = 25;
  EXPECT_EQ(hold_window(devices).upper, 25);
  devices[9].release = devices[10].release = nowhere;
  EXPECT_TRUE(std::isnan(hold_window(devices).lower));
  EXPECT_TRUE(std::isnan(hold_window(devices).upper));
  EXPECT_TRUE(std::isnan(hold_window({}).lower));
}

// The oracle is the pull-in study of each device, from its own scene.
TEST(HoldWindow, OfDevicesIsThatOfEachByItself) {
  constexpr double precision = 1e-4;  // precision of the search for the window, over a collapse voltage
  const PreparedScene nominal = prepare(gold({"structure.modes=2", "simulate.duration=100 us"}));
  const RobustnessOptions options{.samples = 12, .seed = 5, .jobs = 2};
  const HoldWindows found = hold_windows(nominal, options);
  EXPECT_EQ(found.devices, 12U);
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  double lower = 0, upper = std::numeric_limits<double>::infinity();
  for (std::uint64_t k = 0; k < options.samples; ++k) {
    const PreparedScene own = prepare(SceneFile::parse(ensemble.scene(ensemble.values(k)).text(), "device.toml"));
    const ClosedRange range = closed_range(own.model, 0, bias_of(own.scene, 0));
    lower = std::max(lower, range.release);
    upper = std::min(upper, range.pulled_through);
  }
  const HoldWindow& window = found.of_electrodes.at("main");
  EXPECT_NEAR(window.lower, lower, 1e-9 * lower);
  EXPECT_NEAR(window.upper, upper, 2 * precision * upper);
  EXPECT_LT(window.lower, window.upper);
}

}  // namespace
}  // namespace softland
