// Tests the variables of a search, and that no waveform of a search exceeds the driver's limits.
#include "studies/search/search_space.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <string_view>

#include "scenes.h"
#include "studies/search/bang_bang.h"
#include "studies/search/optimize.h"
#include "studies/search/searched_families.h"
#include "studies/search/swing.h"
#include "waveforms/signal_slopes.h"

namespace softland {
namespace {

using testing::ElementsAre;

constexpr double first_touch = 25e-6;
/// Returns all families; those with a number occur with the smallest and the largest as well.
std::vector<std::string> all_families() {
  std::vector<std::string> all;
  for (const SearchedFamily& family : searched_families()) {
    all.emplace_back(family.name);
    if (family.count == 0) continue;
    for (const char* number : {":2", ":20"}) all.push_back(std::string(family.name) + number);
  }
  return all;
}
const std::vector<std::string> every_family = all_families();
/// True for families with a dither: the hold voltage of an electrode can be so near the limit that a dither cannot be slewed.
bool is_dither(const std::string& family) { return family == "harmonic" || family == "dither" || family == "chirp"; }

std::vector<std::string> names(const SearchSpace& space) {
  std::vector<std::string> all;
  for (const Variable& v : space.variables()) all.push_back(v.name);
  return all;
}

const PreparedScene& plain() {
  static const PreparedScene p = prepare(gold_pzt(), true);
  return p;
}

const PreparedScene& slow_drivers() {
  static const PreparedScene p = prepare(gold_pzt({"waveform.main.rise_time=100 us", "driver.main.max_slew=2 V/us",
                                                   "driver.piezo.max_slew=0.05 V/us", "driver.piezo.min_voltage=-0.4 V"}),
                                         true);
  return p;
}

// Checks that points at corners and inside of the box give signals within the limits.
void expect_within_limits(const PreparedScene& prepared, Actuator actuator, const std::string& family) {
  const SearchSpace space(prepared, actuator, family, first_touch);
  const std::vector<Variable> variables = space.variables();
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<std::vector<double>> points = space.starts();
  for (int i = 0; i < 3000; ++i) {
    std::vector<double> x;
    for (const Variable& v : variables) {
      const double u = uniform(random), part = u < 0.1 ? 0 : u > 0.9 ? 1 : uniform(random);
      x.push_back(part == 1 ? v.upper : v.lower + part * (v.upper - v.lower));
    }
    points.push_back(x);
  }
  for (const std::vector<double>& x : points) {
    for (const auto& [drive, waveform] : space.waveforms(x)) {
      const std::string said = violation(signal(waveform), prepared.drives.at(drive).limits.value());
      ASSERT_EQ(said, "") << drive << " " << family << " " << testing::PrintToString(x);
    }
  }
}

// Compares derivatives by parameters that share differences with single ones, at random points of every family, some of them on
// bounds. Returns how often parameters shared a difference.
int expect_shared_slopes(const PreparedScene& prepared, const std::string& family) {
  const SearchSpace space(prepared, Actuator::both, family, first_touch);
  const auto signals_at = [&](std::span<const double> x) {
    return prepared.applied(signals_of(prepared.in_drive_order(space.waveforms(x))));
  };
  std::vector<double> lower, upper;
  for (const Variable& v : space.variables()) lower.push_back(v.lower), upper.push_back(v.upper);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto point = [&](double on_bounds) {
    std::vector<double> x;
    for (std::size_t k = 0; k < lower.size(); ++k) {
      const double u = uniform(random), part = u < on_bounds ? 0 : u > 1 - on_bounds ? 1 : uniform(random);
      x.push_back(std::lerp(lower[k], upper[k], part));
    }
    return x;
  };
  const std::vector<ParameterGroup> groups = SignalSlopes(signals_at, point(0), lower, upper).groups();
  int shared = 0;
  for (int i = 0; i < 12; ++i) {
    const std::vector<double> x = point(i % 2 == 0 ? 0 : 0.1);
    const SignalSlopes alone(signals_at, x, lower, upper), together(signals_at, x, lower, upper, groups);
    shared += together.are_grouped() ? 1 : 0;
    EXPECT_EQ(alone.kinks(), together.kinks()) << family;
    const std::vector<Signal> signals = signals_at(x);
    for (std::size_t drive = 0; drive < signals.size(); ++drive) {
      for (std::size_t piece = 0; piece < signals[drive].pieces().size(); ++piece) {
        const double time = signals[drive].pieces()[piece].begin + 1e-7;
        const auto numbers = [&](const SignalSlopes& slopes) {
          std::map<std::size_t, std::pair<double, double>> all;
          for (const SignalSlopes::Slope& s : slopes.at(drive, piece)) all[s.parameter] = {s.begin, s.voltage(time)};
          return all;
        };
        EXPECT_EQ(numbers(alone), numbers(together)) << family << " drive " << drive << " piece " << piece;
      }
    }
  }
  return shared;
}

TEST(SearchSpace, HasTheSameSlopesWhereParametersShareDifferences) {
  for (const std::string& family : every_family) {
    const int shared = expect_shared_slopes(plain(), family);
    const bool has_many = std::string_view(family) == "bspline:20" || std::string_view(family) == "knots:20";
    EXPECT_TRUE(shared == 12 || !has_many) << family << " " << shared;
  }
}
TEST(SearchSpace, HasTheSameSlopesUnderSlewLimits) {
  int shared = 0;
  for (const std::string& family : every_family) shared += expect_shared_slopes(slow_drivers(), family);
  EXPECT_GT(shared, 0);
}
TEST(SearchSpace, HasTheSameSlopesThroughDrivers_optimized) {
  const PreparedScene filtered = prepare(gold_pzt({"driver.main.bandwidth=1 MHz", "driver.piezo.bandwidth=0.3 MHz"}), true);
  const PreparedScene sampled = prepare(gold_pzt({"driver.main.sample_rate=2 MHz", "driver.piezo.sample_rate=3 MHz"}), true);
  const PreparedScene rounded = prepare(gold_pzt({"driver.main.sample_rate=2 MHz", "driver.main.bits=8"}), true);
  for (const std::string& family : every_family) {
    for (const PreparedScene* drivers : {&filtered, &sampled, &rounded}) expect_shared_slopes(*drivers, family);
  }
}

TEST(SearchSpace, OfAPulseHasTwoLevelsTheirTimesAndAnEdge) {
  const SearchSpace space(plain(), Actuator::electrostatic, "pulse", first_touch);
  EXPECT_THAT(names(space), ElementsAre("main.level_1_V", "main.level_2_V", "main.time_1_s", "main.duration_2_s", "main.edge_s"));
}

TEST(SearchSpace, OfBothDrivesListsTheElectrodeFirst) {
  const SearchSpace space(plain(), Actuator::both, "step", first_touch);
  EXPECT_THAT(names(space), ElementsAre("main.rise_time_s", "piezo.rise_time_s"));
  const auto waveforms = space.waveforms(std::vector<double>{1e-6, 2e-6});
  EXPECT_EQ(std::get<Step>(waveforms.at("main")).rise_time, 1e-6);
  EXPECT_EQ(std::get<Step>(waveforms.at("piezo")).rise_time, 2e-6);
}

TEST(SearchSpace, BrakesWithTheElectrodeOnTheFarSide) {
  const PreparedScene p = prepare(scene("two-electrodes.toml"), true);
  const SearchSpace space(p, Actuator::electrostatic, "step", first_touch);
  EXPECT_THAT(names(space), ElementsAre("main.rise_time_s", "upper.rise_time_s"));
  EXPECT_EQ(SearchSpace(p, Actuator::electrostatic, "pulse", first_touch).variables().size(), 10u);
  const PreparedScene unlimited = prepare(without(scene("two-electrodes.toml"), "driver.upper"), true);
  EXPECT_THAT(names(SearchSpace(unlimited, Actuator::electrostatic, "step", first_touch)), ElementsAre("main.rise_time_s"));
}

TEST(SearchSpace, NeverTouchesTheHoldLevel) {
  const double hold = plain().drives.at("main").hold_level();
  for (const std::string& family : every_family) {
    const SearchSpace space(plain(), Actuator::both, family, first_touch);
    for (const auto& x : space.starts()) {
      const auto waveforms = space.waveforms(x);
      EXPECT_DOUBLE_EQ(signal(waveforms.at("main")).hold_level(), hold) << family;
      EXPECT_DOUBLE_EQ(signal(waveforms.at("piezo")).hold_level(), 0) << family;
    }
  }
}

TEST(SearchSpace, ReadsTheParametersOfItsOwnWaveformsBack) {
  for (const std::string& family : every_family) {
    const SearchSpace space(plain(), Actuator::both, family, first_touch);
    for (const auto& x : space.starts()) {
      const auto back = space.parameters(space.waveforms(x));
      ASSERT_TRUE(back) << family;
      ASSERT_EQ(back->size(), x.size());
      for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR((*back)[k], x[k], 1e-12 * std::abs(x[k])) << family << k;
    }
  }
}

TEST(SearchSpace, HasNoParametersForWhatItCannotReach) {
  const SearchSpace space(plain(), Actuator::electrostatic, "pulse", first_touch);
  const auto pulse = [&](double time, std::vector<double> levels) {
    return DriveWaveforms{{"main", Pulse{.levels = std::move(levels), .times = {time, time + 10e-6}, .edge = 1e-6}}};
  };
  EXPECT_TRUE(space.parameters(pulse(20e-6, {20, 10, 15})));
  EXPECT_FALSE(space.parameters(pulse(50e-6, {20, 10, 15}))) << "later than its bounds";
  EXPECT_FALSE(space.parameters(pulse(20e-6, {20, 1000, 15}))) << "above the driver's limit";
  EXPECT_FALSE(space.parameters({{"main", Pulse{.levels = {20, 15}, .times = {20e-6}, .edge = 1e-6}}}))
      << "another number of levels";
  EXPECT_FALSE(space.parameters({{"main", Step{.level = 15}}})) << "another family";
  EXPECT_FALSE(space.parameters({})) << "not driven";
}

TEST(SearchSpace, BoundsLevelsByTheDriversLimits) {
  for (const Actuator actuator : {Actuator::electrostatic, Actuator::pzt}) {
    const std::string drive = actuator == Actuator::pzt ? "piezo" : "main";
    const DriverLimits& limits = plain().drives.at(drive).limits.value();
    for (const Variable& v : SearchSpace(plain(), actuator, "pulse", first_touch).variables()) {
      EXPECT_LT(v.lower, v.upper) << v.name;
      if (!v.name.ends_with("_V")) continue;
      EXPECT_EQ(v.lower, limits.min_voltage) << v.name;
      EXPECT_EQ(v.upper, limits.max_voltage) << v.name;
    }
  }
}

TEST(SearchSpace, StartsInsideItsBounds) {
  for (const std::string& family : every_family) {
    const SearchSpace space(plain(), Actuator::both, family, first_touch);
    const auto variables = space.variables();
    ASSERT_FALSE(space.starts().empty());
    for (const auto& x : space.starts()) {
      ASSERT_EQ(x.size(), variables.size()) << family;
      for (std::size_t k = 0; k < x.size(); ++k) {
        EXPECT_GE(x[k], variables[k].lower) << variables[k].name;
        EXPECT_LE(x[k], variables[k].upper) << variables[k].name;
      }
    }
  }
}

class SearchedFamilies : public testing::TestWithParam<std::string> {};
TEST_P(SearchedFamilies, StayInsideTheLimits) { expect_within_limits(plain(), Actuator::both, GetParam()); }
TEST_P(SearchedFamilies, ObeyASlewLimit) {
  expect_within_limits(slow_drivers(), is_dither(GetParam()) ? Actuator::pzt : Actuator::both, GetParam());
}
TEST_P(SearchedFamilies, BrakeInsideTheLimits) {
  static const PreparedScene p = prepare(scene("two-electrodes.toml"), true);
  if (!is_dither(GetParam())) expect_within_limits(p, Actuator::electrostatic, GetParam());
}
INSTANTIATE_TEST_SUITE_P(SearchSpace, SearchedFamilies, testing::ValuesIn(every_family));

TEST(SearchSpace, OfPulsesCoastsBetweenThem) {
  const SearchSpace space(plain(), Actuator::electrostatic, "pulses:2", first_touch);
  EXPECT_THAT(names(space), ElementsAre("main.level_1_V", "main.level_2_V", "main.duration_1_s", "main.duration_2_s",
                                        "main.coast_1_s", "main.edge_s"));
  const auto waveforms = space.waveforms(std::vector<double>{20, 15, 20e-6, 40e-6, 10e-6, 1e-6});
  const Pulse& pulse = std::get<Pulse>(waveforms.at("main"));
  EXPECT_THAT(pulse.levels, ElementsAre(20, 0, 15, plain().drives.at("main").hold_level()));
  EXPECT_THAT(pulse.times, ElementsAre(20e-6, testing::DoubleEq(30e-6), testing::DoubleEq(70e-6)));
  const SearchSpace dual(plain(), Actuator::electrostatic, "dual-pulse", first_touch);
  EXPECT_EQ(names(dual), names(space));
}

TEST(SearchSpace, OfACoastEndsItsOnlyPulseBeforeTheHoldLevel) {
  const SearchSpace space(plain(), Actuator::electrostatic, "coast", first_touch);
  const auto waveforms = space.waveforms(std::vector<double>{20, 18e-6, 12e-6, 1e-6});
  const Pulse& pulse = std::get<Pulse>(waveforms.at("main"));
  EXPECT_THAT(pulse.levels, ElementsAre(20, 0, plain().drives.at("main").hold_level()));
  EXPECT_THAT(pulse.times, ElementsAre(18e-6, testing::DoubleEq(30e-6)));
}

TEST(SearchSpace, WaitsBeforeAPulseThatBrakes) {
  const PreparedScene p = prepare(scene("two-electrodes.toml"), true);
  const SearchSpace space(p, Actuator::electrostatic, "coast", first_touch);
  std::vector<double> x = space.starts().front();
  ASSERT_EQ(x.size(), 8U);
  x[4] = 20, x[5] = 7e-6, x[6] = 11e-6;  // level, duration, wait
  const auto waveforms = space.waveforms(x);
  const Pulse& brake = std::get<Pulse>(waveforms.at("upper"));
  EXPECT_THAT(brake.levels, ElementsAre(0, 20, 0));
  EXPECT_THAT(brake.times, ElementsAre(11e-6, testing::DoubleEq(18e-6)));
  EXPECT_THAT(*space.parameters(waveforms), testing::Pointwise(testing::DoubleNear(1e-12), x));
}

TEST(SearchSpace, BeginsWithTheQuickestSwing) {
  // Full voltage, 0 V, hold is among the starts of every family that can express it, with the same times.
  const double high = plain().drives.at("main").limits.value().max_voltage;
  const auto thrown = [&](const std::string& family, std::size_t level, std::size_t driven, std::size_t coasting) {
    const SearchSpace space(plain(), Actuator::electrostatic, family, first_touch);
    const std::vector<double> x = space.starts().back();
    EXPECT_EQ(x[level], high) << family;
    return std::pair(x[driven], x[coasting]);
  };
  const auto times = thrown("pulse", 0, 2, 3);
  EXPECT_EQ(thrown("catch", 0, 3, 4), times);
  EXPECT_EQ(thrown("coast", 0, 1, 2), times);
  EXPECT_EQ(thrown("dual-pulse", 0, 2, 4), times);
  const auto swing = quickest_swing(plain().model, {high, 0}, {0, 0}, 1e-3);
  ASSERT_TRUE(swing);
  EXPECT_EQ(times, std::pair(swing->driven_time, swing->releasing_time));
  // Families that can pull again after the touch have such starts, for several times.
  const SearchSpace space(plain(), Actuator::electrostatic, "dual-pulse", first_touch);
  std::set<double> pushes;
  for (const std::vector<double>& x : space.starts()) {
    if (x[2] == times.first) pushes.insert(x[3]);
  }
  EXPECT_EQ(pushes.size(), 4U);
}

TEST(SearchSpace, OfACompressibleFilmBeginsWithTheLandingOfItsFirstModeWithoutDamping) {
  const PreparedScene p = prepare(gold({"gas.model=reynolds"}), true);
  const double high = p.drives.at("main").limits.value().max_voltage;
  const auto landing = bang_bang(p.model, {high}, {0});
  ASSERT_TRUE(landing);
  const std::vector<double> x = SearchSpace(p, Actuator::electrostatic, "dual-pulse", first_touch).starts().back();
  EXPECT_EQ(x[2], landing->driven_time);
  EXPECT_EQ(x[4], landing->coasting_time);
}

// Returns the root mean square difference of two waveforms [V] from 0 to `end` [s].
double apart(const Waveform& a, const Waveform& b, double end) {
  const Signal one = signal(a), other = signal(b);
  double sum = 0;
  constexpr int instants = 2000;
  for (int i = 0; i < instants; ++i) sum += std::pow(one.voltage(i * end / instants) - other.voltage(i * end / instants), 2);
  return std::sqrt(sum / instants);
}

TEST(SearchSpace, FindsTheNearestWaveformOfAFamily) {
  const double end = 2.5 * first_touch;
  const double hold = plain().drives.at("main").hold_level();
  const Waveform thrown =
      Pulse{.levels = {20, 2, 19, hold}, .times = {0.55 * first_touch, 0.9 * first_touch, 1.8 * first_touch}, .edge = 0.5e-6};
  const auto miss = [&](const std::string& family, const Waveform& given) {
    const SearchSpace space(plain(), Actuator::electrostatic, family, first_touch);
    return apart(space.waveforms(space.nearest({{"main", given}})).at("main"), given, end);
  };
  EXPECT_LT(miss("catch", thrown), 1e-9) << "its own family: to the last digit";
  EXPECT_LT(miss("staircase:3", thrown), 0.5);
  EXPECT_LT(miss("dual-pulse", thrown), 1.5) << "it coasts on 2 V, which a train of pulses cannot";
  EXPECT_GT(miss("pulse", thrown), 3) << "the push after it is missing";
  // Splines and knots approximate the line of a table.
  Table table{.time = {0}, .voltage = {0}};
  for (int k = 1; k <= 40; ++k) {
    table.time.push_back(k * 2 * first_touch / 40);
    table.voltage.push_back(hold * (0.8 + 0.2 * std::sin(k * pi / 80)));
  }
  EXPECT_LT(miss("knots:6", table), 0.4);
  EXPECT_LT(miss("bspline:6", table), 1.5);
  EXPECT_LT(miss("bspline:16", table), 0.5) << "by least squares of many levels";
  const SearchSpace space(plain(), Actuator::both, "main=dual-pulse,pzt=sines:3", first_touch);
  const Waveform dither = Table{.time = {0, 1e-5, 3e-5, 4e-5}, .voltage = {0, 0.5, -0.5, 0}};
  const auto both = space.waveforms(space.nearest({{"main", thrown}, {"piezo", dither}}));
  EXPECT_LT(apart(both.at("piezo"), dither, end), 0.15);
}

TEST(SearchSpace, GivesEveryDriveTheFamilyThatIsNamedForIt) {
  const SearchSpace space(plain(), Actuator::both, "main=step,pzt=coast", first_touch);
  EXPECT_THAT(names(space),
              ElementsAre("main.rise_time_s", "piezo.level_1_V", "piezo.duration_1_s", "piezo.coast_1_s", "piezo.edge_s"));
  EXPECT_EQ(names(SearchSpace(plain(), Actuator::both, "piezo=coast,step", first_touch)), names(space));
  EXPECT_THAT(names(SearchSpace(plain(), Actuator::both, "main=step", first_touch)), testing::Contains("piezo.level_2_V"))
      << "a pulse where nothing else is said";
  const auto refused = [&](const std::string& family, Actuator actuator) {
    return refusal([&] { SearchSpace(plain(), actuator, family, first_touch); });
  };
  EXPECT_EQ(refused("main=step,pzt=coast", Actuator::electrostatic),
            "waveform main=step,pzt=coast: drive 'piezo' is not searched (searched: main)");
  EXPECT_EQ(refused("main=step,main=coast", Actuator::both), "waveform main=step,main=coast: drive 'main' has two families");
  EXPECT_EQ(refused("main=step,coast,ramp", Actuator::both),
            "waveform main=step,coast,ramp: 'ramp' is not of the form DRIVE=FAMILY, or a second family for all other drives");
  EXPECT_EQ(refused("main=stop", Actuator::electrostatic).substr(0, 29), "waveform stop: must be step, ");
}

TEST(SearchSpace, OfSinesKeepsTheirRatiosInsideTheLimits) {
  const SearchSpace space(plain(), Actuator::electrostatic, "sines:2", first_touch);
  const double hold = plain().drives.at("main").hold_level(), high = plain().drives.at("main").limits.value().max_voltage;
  const auto waveforms = space.waveforms(std::vector<double>{5 * hold, -2.5 * hold, 40e-6});
  const Sines& sines = std::get<Sines>(waveforms.at("main"));
  EXPECT_NEAR(sines.amplitudes[0] / sines.amplitudes[1], -2, 1e-12);
  EXPECT_NEAR(signal(sines).maximum(), high, 1e-6 * high) << "as large as the limit lets them be";
}

TEST(SearchSpace, OfKnotsIsALineThroughThemToTheHoldLevel) {
  const SearchSpace space(plain(), Actuator::electrostatic, "knots:3", first_touch);
  EXPECT_THAT(names(space), ElementsAre("main.level_1_V", "main.level_2_V", "main.level_3_V", "main.total_time_s", "main.part_1",
                                        "main.part_2", "main.part_3"));
  const auto waveforms = space.waveforms(std::vector<double>{4, 8, 2, 60e-6, 0.5, 1, 0.5});
  const Table& line = std::get<Table>(waveforms.at("main"));
  const double hold = plain().drives.at("main").hold_level();
  EXPECT_THAT(line.voltage, ElementsAre(0, 4, 8, 2, hold));
  EXPECT_THAT(line.time, ElementsAre(0, 0, testing::DoubleEq(15e-6), testing::DoubleEq(45e-6), testing::DoubleEq(60e-6)));
}

TEST(SearchSpace, OfACatchHoldsTheBeamFastAndThenLetsItBe) {
  const SearchSpace space(plain(), Actuator::electrostatic, "catch", first_touch);
  const auto waveforms = space.waveforms(std::vector<double>{20, 1, 15, 20e-6, 10e-6, 40e-6, 1e-6});
  const Pulse& pulse = std::get<Pulse>(waveforms.at("main"));
  EXPECT_THAT(pulse.levels, ElementsAre(20, 1, 15, plain().drives.at("main").hold_level()));
  EXPECT_THAT(pulse.times, ElementsAre(20e-6, testing::DoubleEq(30e-6), testing::DoubleEq(70e-6)));
}

TEST(SearchSpace, StepsObeyASlewLimit) { expect_within_limits(slow_drivers(), Actuator::both, "step"); }
TEST(SearchSpace, DithersOfThePiezoObeyASlewLimit) { expect_within_limits(slow_drivers(), Actuator::pzt, "harmonic"); }
TEST(SearchSpace, DithersOfTheElectrodeObeyASlewLimit) {
  expect_within_limits(slow_drivers(), Actuator::electrostatic, "harmonic");
}

TEST(SearchSpace, RefusesAPiezoWithoutLimits) {
  const PreparedScene p = prepare(without(gold_pzt(), "driver.piezo"), true);
  EXPECT_EQ(refusal([&] { SearchSpace(p, Actuator::pzt, "pulse", first_touch); }),
            "optimize needs [driver.piezo] with min_voltage and max_voltage: it never searches an unlimited drive");
}

TEST(SearchSpace, RefusesThePiezoOfASceneThatHasNone) {
  const PreparedScene p = prepare(gold(), true);
  for (const Actuator actuator : {Actuator::pzt, Actuator::both})
    EXPECT_EQ(refusal([&] { SearchSpace(p, actuator, "pulse", first_touch); }),
              "optimize actuator pzt|both needs a [piezo] section, and the scene has none");
}

TEST(SearchSpace, RefusesFamiliesWithoutParameters) {
  for (const std::string family : {"table", "spline", ""})
    EXPECT_EQ(refusal([&] { SearchSpace(plain(), Actuator::electrostatic, family, first_touch); }),
              "waveform " + family + ": must be " + listed_searched_families());
  EXPECT_THAT(listed_searched_families(), testing::StartsWith("step, pulse, harmonic, catch, ramp, staircase:N, knots:N, "));
  EXPECT_THAT(listed_searched_families(), testing::ContainsRegex(", sines:N or quasi-static:N$"));
  for (const std::string family : {"knots:1", "knots:21", "knots:", "knots:3x", "staircase:-2"})
    EXPECT_EQ(refusal([&] { SearchSpace(plain(), Actuator::electrostatic, family, first_touch); }),
              "waveform " + family + ": the number after " + family.substr(0, family.find(':')) + " must be from 2 to 20");
  EXPECT_EQ(refusal([&] { SearchSpace(plain(), Actuator::electrostatic, "pulse:3", first_touch); }),
            "waveform pulse:3: pulse has no number");
}

TEST(SearchSpace, RefusesADitherWithoutRoomAboutTheHoldLevel) {
  const PreparedScene p = prepare(gold({"waveform.main.level=30 V", "driver.main.max_voltage=30 V"}), true);
  EXPECT_EQ(refusal([&] { SearchSpace(p, Actuator::electrostatic, "harmonic", first_touch); }),
            "driver.main: the hold level 30 V stands at the driver's limit, which leaves no room for a dither");
  EXPECT_EQ(refusal([&] { SearchSpace(p, Actuator::electrostatic, "pulse", first_touch); }), "");
}

TEST(SearchedElectrode, IsMainElseTheFirst) {
  Device device;
  EXPECT_EQ(refusal([&] { (void)searched_electrode(device); }),
            "actuator electrostatic|both needs an electrode, and the scene has none");
  device.electrodes = {{.name = "left"}, {.name = "right"}};
  EXPECT_EQ(searched_electrode(device), "left");
  device.electrodes.push_back({.name = "main"});
  EXPECT_EQ(searched_electrode(device), "main");
  for (Electrode& e : device.electrodes) e.side = Side::far;
  EXPECT_EQ(refusal([&] { (void)searched_electrode(device); }),
            "optimize needs an electrode that pulls in, and all of the scene's are on the far side");
  device.electrodes[1].side = Side::near;
  EXPECT_EQ(searched_electrode(device), "right");
}

TEST(FamiliesOf, ReadsOneOrSeveral) {
  EXPECT_EQ(families_of("pulse"), std::vector<std::string>{"pulse"});
  EXPECT_EQ(families_of("knots:8+main=step,pzt=pulse+catch"),
            (std::vector<std::string>{"knots:8", "main=step,pzt=pulse", "catch"}));
  EXPECT_EQ(prefix_of("knots+catch", "catch"), "catch.");
  EXPECT_EQ(prefix_of("catch", "catch"), "");
  for (const char* text : {"+catch", "catch+", "catch++knots"})
    EXPECT_EQ(refusal([&] { (void)families_of(text); }),
              fmt::format("waveform {}: a family before or after '+' is missing", text));
  EXPECT_EQ(refusal([] { (void)families_of("catch+catch"); }), "waveform catch+catch: 'catch' is named twice");
  for (const Actuator actuator : {Actuator::electrostatic, Actuator::pzt, Actuator::both}) {
    for (const std::string& family : families_of(std::string(default_families(shaped_drives(plain().scene.file, actuator)))))
      EXPECT_EQ(refusal([&] { (void)SearchSpace(plain(), actuator, family, first_touch); }), "");
  }
}

TEST(ShapedDrives, AreSeveralWhereAnElectrodeBrakes) {
  EXPECT_EQ(shaped_drives(gold(), Actuator::electrostatic), Shaped::electrode);
  EXPECT_EQ(shaped_drives(gold(), Actuator::pzt), Shaped::piezo);
  EXPECT_EQ(shaped_drives(gold(), Actuator::both), Shaped::several);
  const SceneFile plate = scene("two-electrodes.toml");
  EXPECT_EQ(shaped_drives(plate, Actuator::electrostatic), Shaped::several);
  SceneFile unlimited = plate;
  unlimited.erase("driver.upper");
  EXPECT_EQ(shaped_drives(unlimited, Actuator::electrostatic), Shaped::electrode) << "what has no limits keeps its waveform";
  EXPECT_EQ(braking_electrodes(prepare(plate)).size(), 1u);
  EXPECT_EQ(braking_electrodes(prepare(unlimited)).size(), 0u);
}

TEST(Documentation, NamesTheFamiliesAndBudgetsThatAreTheDefault) {
  std::ifstream stream(std::string(SOFTLAND_SOURCE_DIR) + "/docs/reference/searches.md");
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  for (const Shaped drives : {Shaped::electrode, Shaped::piezo, Shaped::several})
    EXPECT_NE(text.find(fmt::format("`{}`", default_families(drives))), std::string::npos) << default_families(drives);
  EXPECT_NE(
      text.find(fmt::format("(default: {} for an electrode, {} for several drives, {} for a piezo",
                            default_budget(Target::bounce, Shaped::electrode), default_budget(Target::bounce, Shaped::several),
                            default_budget(Target::bounce, Shaped::piezo))),
      std::string::npos);
}

}  // namespace
}  // namespace softland
