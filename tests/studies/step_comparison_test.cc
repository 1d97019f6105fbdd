// Tests if a drive is worse than the plain step, on synthetic outcomes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "studies/search/robust_cost.h"

namespace softland {
namespace {

constexpr std::size_t devices = 400;

// Returns a sample of devices whose impact velocities and rebounds are evenly distributed about these medians, within 10 %.
std::vector<DeviceOutcome> outcomes(double speed, double height, double force) {
  std::vector<DeviceOutcome> all;
  for (std::size_t k = 0; k < devices; ++k) {
    const double factor = 0.9 + 0.2 * static_cast<double>((k * 37) % devices) / devices;
    DeviceOutcome o;
    o.metrics.largest_impact_velocity = factor * speed;
    o.metrics.status = Status::done;
    o.metrics.major_bounce_height = factor * height;
    o.metrics.peak_contact_force = factor * force;
    all.push_back(o);
  }
  return all;
}

const std::vector<DeviceOutcome> step = outcomes(0.1, 500e-9, 1e-6);

std::vector<std::string_view> worse(const std::vector<DeviceOutcome>& drive) { return worse_in(drive, step, 1e-9, 3); }

using testing::ElementsAre;
using testing::IsEmpty;

TEST(WorseThanStep, ComparesTheDevicesThatBothHave) {
  std::vector<DeviceOutcome> few = outcomes(0.2, 100e-9, 0.5e-6);
  few.resize(40);  // the run was interrupted
  const std::vector<std::string_view> speed{key_of(&Metrics::largest_impact_velocity)};
  EXPECT_EQ(worse(few), speed);
  EXPECT_THAT(worse_in(step, few, 1e-9, 3),
              ElementsAre(key_of(&Metrics::major_bounce_height), key_of(&Metrics::peak_contact_force)));
  EXPECT_THAT(worse({}), IsEmpty());
}

TEST(WorseThanStep, NamesTheFiguresInWhichADriveIsWorse) {
  EXPECT_THAT(worse(step), IsEmpty()) << "it is no worse than itself";
  EXPECT_THAT(worse(outcomes(0.05, 100e-9, 0.5e-6)), IsEmpty());
  EXPECT_THAT(worse(outcomes(0.2, 100e-9, 0.5e-6)), ElementsAre("largest_impact_velocity_m_s"));
  EXPECT_THAT(worse(outcomes(0.05, 600e-9, 0.5e-6)), ElementsAre("major_bounce_height_m"));
  EXPECT_THAT(worse(outcomes(0.05, 100e-9, 2e-6)), ElementsAre("peak_contact_force_N"));
}

TEST(WorseThanStep, AcceptsDifferencesThatMayBeChance) {
  // One device in twenty is slightly faster, the others are slower: the quantile is above that of the step, but its interval is
  // not.
  std::vector<DeviceOutcome> drive = step;
  for (std::size_t k = 0; k < devices; ++k) {
    double& speed = drive[k].metrics.largest_impact_velocity;
    speed = speed > 0.1089 ? 1.0001 * speed : 0.9 * speed;
  }
  EXPECT_THAT(worse(drive), IsEmpty());
}

TEST(WorseThanStep, TakesReboundsThatAreNotSignificantAsEqual) {
  const std::vector<DeviceOutcome> flat = outcomes(0.1, 0.1e-9, 1e-6);
  EXPECT_THAT(worse_in(outcomes(0.1, 0.8e-9, 1e-6), flat, 1e-9, 3), IsEmpty());
  EXPECT_THAT(worse_in(outcomes(0.1, 2e-9, 1e-6), flat, 1e-9, 3), ElementsAre("major_bounce_height_m"));
}

TEST(WorseThanStep, CountsADeviceThatDoesNotCloseAsTheWorst) {
  std::vector<DeviceOutcome> drive = outcomes(0.05, 100e-9, 0.5e-6);
  for (std::size_t k = 0; k < devices / 10; ++k) drive[k] = DeviceOutcome{};
  EXPECT_EQ(worse(drive).size(), 3U);
  EXPECT_THAT(worse_in(drive, drive, 1e-9, 3), IsEmpty()) << "both are infinite";
}

TEST(NoHarderThanStep, HoldsOfTheStepAndOfWhatIsSofter) {
  const std::vector<Condition> conditions = at_most_step(step, 1e-9);
  ASSERT_EQ(conditions.size(), 3U);
  EXPECT_TRUE(hold(conditions, step)) << "19 devices of 20 are below its own quantile";
  EXPECT_TRUE(hold(conditions, outcomes(0.05, 0, 0.5e-6)));
  EXPECT_FALSE(hold(conditions, outcomes(0.11, 0, 0.5e-6))) << "faster";
  EXPECT_FALSE(hold(conditions, outcomes(0.05, 550e-9, 0.5e-6))) << "rebounds higher";
  EXPECT_FALSE(hold(conditions, outcomes(0.05, 0, 1.1e-6))) << "presses harder";
}

TEST(NoHarderThanStep, AsksNothingWhereTheStepDoesNotCloseAndLittleOfReboundsThatAreNotSignificant) {
  EXPECT_THAT(at_most_step({DeviceOutcome{}}, 1e-9), IsEmpty());
  const std::vector<Condition> flat = at_most_step(outcomes(0.1, 0.1e-9, 1e-6), 1e-9);
  EXPECT_TRUE(hold(flat, outcomes(0.05, 0.8e-9, 0.5e-6)));
  EXPECT_FALSE(hold(flat, outcomes(0.05, 2e-9, 0.5e-6)));
}

}  // namespace
}  // namespace softland
