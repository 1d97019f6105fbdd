// The quasi-static approach: its path, its waveforms, and their closings.
#include "studies/search/quasi_static.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>
#include <string>
#include <vector>

#include "model/constants.h"
#include "studies/search/search_setting.h"
#include "studies/search/search_space.h"
#include "tests/studies/scenes.h"
#include "waveforms/table.h"

namespace softland {
namespace {

constexpr double t0 = 25e-6;
const char* const before_the_fold = "gap.contact=1.4 um";

PreparedScene with_piezo(std::initializer_list<std::string_view> changes = {}) { return prepare(gold_pzt(changes), true); }

TEST(StableApproach, IsThatOfThePiezoWhoseElectrodeHoldsTheClosedSwitch) {
  const PreparedScene p = with_piezo();
  const auto alone = stable_approach(p, Actuator::pzt), both = stable_approach(p, Actuator::both);
  ASSERT_TRUE(alone && both);
  EXPECT_EQ(alone->drive, "piezo");
  EXPECT_EQ(alone->holder, "main");
  EXPECT_EQ(alone->low, 0);
  EXPECT_NEAR(alone->reaches, p.scene.device.gap.contact / p.model.basis().piezo_deflection(), 1e-6);
  EXPECT_GT(both->low, 0) << "the piezo alone does not reach the contact of all devices within 1 V";
  EXPECT_LE(std::abs(both->reaches) + 2.5 * both->deviation, 1.0);
  EXPECT_FALSE(stable_approach(p, Actuator::electrostatic)) << "the contact lies beyond the fold";
  EXPECT_FALSE(stable_approach(with_piezo({"driver.piezo.min_voltage=-0.9 V"}), Actuator::pzt)) << "beyond the limit";
}

TEST(StableApproach, SpreadsToFirstOrderAsItsDevicesDo) {
  // The share of devices within the limit follows the normal distribution with this deviation.
  const PreparedScene p = with_piezo();
  const StableApproach found = *stable_approach(p, Actuator::pzt);
  const double share = share_with_path(p, found, 1024, 3, 2);
  const double normal = 0.5 * std::erfc((std::abs(found.reaches) - 1.0) / found.deviation / std::sqrt(2.0));
  EXPECT_NEAR(share, normal, 0.01);
  EXPECT_GT(share, 0.9);
  EXPECT_LT(share, 1.0);
}

TEST(StableApproach, TellsHowFarThePlacesAreApartWhereDevicesTouch) {
  const PreparedScene p = with_piezo();
  const StableApproach found = *stable_approach(p, Actuator::pzt);
  // Returns the voltage below which this share of the devices touches, by bisection on the limit.
  const auto voltage_of = [&](double share) {
    double low = 0.7, high = 1.2;
    for (int i = 0; i < 12; ++i) {
      StableApproach limited = found;
      limited.limit = -(low + high) / 2;
      (share_with_path(p, limited, 512, 5, 2) < share ? low : high) = (low + high) / 2;
    }
    return low;
  };
  const double apart = (voltage_of(0.95) - voltage_of(0.05)) * std::abs(found.slope);
  EXPECT_NEAR(found.touch_places(), apart, 0.08 * apart);
  const double period = 2 * pi / p.model.basis().angular_frequencies()[0];
  EXPECT_NEAR(quasi_static_speed(found, p, 3.5 * period), found.touch_places() / (2 * period), 1e-9);
  EXPECT_TRUE(std::isinf(quasi_static_speed(found, p, 1.4 * period)));
}

TEST(StableApproach, CountsTheGainOfItsSource) {
  const StableApproach plain = *stable_approach(with_piezo(), Actuator::pzt),
                       weaker = *stable_approach(with_piezo({"driver.piezo.gain=0.98"}), Actuator::pzt);
  EXPECT_NEAR(weaker.reaches, plain.reaches / 0.98, 1e-9);
  const PreparedScene varied =
      with_piezo({"spread.amplifier={ keys = [\"driver.piezo.gain\"], distribution = \"normal\", cov = \"3 %\" }"});
  EXPECT_NEAR(stable_approach(varied, Actuator::pzt)->deviation, std::hypot(plain.deviation, 0.03 * plain.reaches), 1e-4);
}

TEST(StableApproach, IsThatOfAnElectrodeBeforeItsFold) {
  const auto found =
      stable_approach(prepare(gold({before_the_fold, "driver.main.max_voltage=25 V"}), true), Actuator::electrostatic);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->drive, "main");
  EXPECT_TRUE(found->holder.empty());
  EXPECT_FALSE(stable_approach(prepare(gold(), true), Actuator::electrostatic));
}

// Returns the amplitude of a mode after a rise of straight lines, if its frequency is `ratio` times the one for which the rise
// is shaped.
double ringing(const Table& rise, double period, double ratio) {
  std::complex<double> sum = 0;
  constexpr int parts = 4000;
  const double height = rise.voltage.back() - rise.voltage.front();
  for (std::size_t k = 1; k < rise.time.size(); ++k) {
    const double length = rise.time[k] - rise.time[k - 1];
    for (int i = 0; i < parts && length > 0; ++i) {
      const double time = rise.time[k - 1] + (i + 0.5) / parts * length;
      sum += (rise.voltage[k] - rise.voltage[k - 1]) / parts * std::polar(1.0, 2 * pi * ratio * time / period);
    }
  }
  return std::abs(sum / height);
}

TEST(QuasiStatic, RisesWithoutVibrationOfDevicesWhoseFrequencyDiffers) {
  // |sinc(pi r) cos^(N-1)(pi r / 2)|: a ramp of one period, shaped by N impulses half a period apart.
  const PreparedScene p = with_piezo();
  const double period = 2 * pi / p.model.basis().angular_frequencies()[0];
  for (const auto& [family, impulses] :
       {std::pair("quasi-static:2", 2), std::pair("quasi-static", 3), std::pair("quasi-static:4", 4)}) {
    const SearchSpace space(p, Actuator::pzt, family, t0);
    std::vector<double> x = space.starts().front();
    x[2] = x[0];  // no further line: the approach ends with the rise
    const Table all = std::get<Table>(space.waveforms(x).at("piezo"));
    Table rise;
    for (std::size_t k = 0; k < all.time.size() && all.time[k] <= (impulses + 1) / 2.0 * period * (1 + 1e-9); ++k)
      rise.time.push_back(all.time[k]), rise.voltage.push_back(all.voltage[k]);
    EXPECT_NEAR(rise.time.back(), (impulses + 1) / 2.0 * period, 1e-9 * period) << family;
    for (const double ratio : {0.93, 0.965, 1.0, 1.035}) {
      const double sinc = std::sin(pi * ratio) / (pi * ratio), shaper = std::pow(std::cos(pi * ratio / 2), impulses - 1);
      EXPECT_NEAR(ringing(rise, period, ratio), std::abs(sinc * shaper), 1e-6) << family << " " << ratio;
    }
  }
}

void expect_approach_within_limits(const PreparedScene& p, Actuator actuator, const std::string& family) {
  const SearchSpace whole(p, actuator, family, t0);
  for (const SearchSpace& space : {whole, whole.paced(500e-6), whole.paced(100e-6)}) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<std::vector<double>> points = space.starts();
    for (int i = 0; i < 500; ++i) {
      std::vector<double> x;
      for (const Variable& v : space.variables()) {
        const double u = uniform(random);
        x.push_back(u < 0.1 ? v.lower : u > 0.9 ? v.upper : std::lerp(v.lower, v.upper, uniform(random)));
      }
      points.push_back(x);
    }
    for (const std::vector<double>& x : points) {
      for (const auto& [drive, waveform] : space.waveforms(x)) {
        const Signal told = signal(waveform);
        ASSERT_EQ(violation(told, p.drives.at(drive).limits.value()), "") << drive << " " << testing::PrintToString(x);
        ASSERT_NEAR(told.hold_level(), p.drives.at(drive).hold_level(), 1e-12) << drive << " " << testing::PrintToString(x);
      }
    }
  }
}

TEST(QuasiStatic, NeverLeavesTheLimitsAndEndsOnTheHoldLevel) {
  for (const char* family : {"quasi-static", "quasi-static:2", "quasi-static:20"}) {
    for (const Actuator actuator : {Actuator::pzt, Actuator::both}) expect_approach_within_limits(with_piezo(), actuator, family);
    expect_approach_within_limits(
        with_piezo({"driver.main.max_slew=2 V/us", "waveform.main.rise_time=100 us", "driver.piezo.max_slew=0.05 V/us"}),
        Actuator::both, family);
    expect_approach_within_limits(prepare(gold({before_the_fold, "driver.main.max_voltage=25 V"}), true), Actuator::electrostatic,
                                  family);
  }
}

TEST(QuasiStatic, LetsThePlainStepComeWhenTheContactIsMade) {
  const PreparedScene p = with_piezo();
  const SearchSpace space = SearchSpace(p, Actuator::pzt, "quasi-static", t0).paced(500e-6);
  const std::vector<double> x = space.starts().front();
  const DriveWaveforms all = space.waveforms(x);
  ASSERT_EQ(all.size(), 2U);
  const Table step = std::get<Table>(all.at("main"));
  EXPECT_EQ(step.voltage.front(), 0);
  EXPECT_EQ(step.voltage.back(), p.drives.at("main").hold_level());
  EXPECT_EQ(step.time.back(), step.time[step.time.size() - 2]) << "a jump";
  EXPECT_NEAR(step.time.back(), 500e-6, 1e-6) << "when the contact is to be steady";
  EXPECT_GT(std::get<Table>(all.at("piezo")).time.back(), step.time.back()) << "the piezo goes back after it";
}

TEST(QuasiStatic, IsFoundAgainFromItsWaveforms) {
  const SearchSpace space(with_piezo(), Actuator::both, "quasi-static", t0);
  const std::vector<double> x = space.starts().front();
  std::vector<double> moved = x;
  moved[0] *= 0.98, moved[1] *= 1.05;
  EXPECT_FALSE(space.parameters(space.waveforms(moved))) << "tables do not say which";
  const std::vector<double> found = space.nearest(space.waveforms(moved));
  EXPECT_NEAR(found[0], moved[0], 0.005 * moved[0]);
  EXPECT_NEAR(found[1], moved[1], 0.02 * moved[1]);
}

TEST(QuasiStatic, IsRefusedWhereNoDriveCarriesTheSwitch) {
  try {
    (void)SearchSpace(prepare(gold(), true), Actuator::electrostatic, "quasi-static", t0);
    FAIL();
  } catch (const InvalidInput& refused) {
    EXPECT_THAT(refused.what(), testing::HasSubstr("carries the switch to its contact through stable equilibria"));
  }
}

}  // namespace
}  // namespace softland
