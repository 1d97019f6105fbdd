// Tests the limit for any waveform, against closed forms, values of an independent calculation, and simulations.
#include "studies/search/limit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/gauss.h"
#include "integrators/roots.h"
#include "model/constants.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/plain_step.h"
#include "studies/search/bang_bang.h"
#include "studies/search/first_touch_problem.h"
#include "studies/search/search_setting.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

// Returns the time of full voltage up to x_s, then 0 V, so that the plate arrives at the contact with speed v. The work of the
// field is the energy at the contact.
double bang_bang(const Structure& s, const Gap& gap, double volts, double v) {
  const double area = s.width * s.length, force = vacuum_permittivity * area * volts * volts / 2;
  const double mass = part_of<Plate>(s).mass, k = part_of<Plate>(s).stiffness;
  const auto work = [&](double x) { return force * (1 / (gap.electrode - x) - 1 / gap.electrode); };
  const double energy = (k * gap.contact * gap.contact + mass * v * v) / 2;
  const double x_s = gap.electrode - 1 / (energy / force + 1 / gap.electrode);
  // The substitution x = y^2 makes the root at rest smooth.
  const GaussRule rule = gauss_rule(60);
  double pulled = 0;
  for (std::size_t i = 0; i < rule.points.size(); ++i) {
    const double end = std::sqrt(x_s), y = end * (1 + rule.points[i]) / 2, x = y * y;
    pulled += rule.weights[i] * end / 2 * 2 * y / std::sqrt((2 * work(x) - k * x * x) / mass);
  }
  const double omega = std::sqrt(k / mass), amplitude = std::sqrt(2 * energy / k);
  return pulled + (std::asin(gap.contact / amplitude) - std::asin(x_s / amplitude)) / omega;
}

TEST(LeastTime, OfAnUndampedPlateIsThatOfABangBangDrive) {
  const PreparedScene p = prepare_and_choose(spring_plate(), true);
  for (const double v : {1e-3, 0.05}) {
    const LeastTime found = least_time(p, {.impact_velocity = v});
    ASSERT_EQ(found.status, Status::done) << found.message;
    EXPECT_NEAR(found.time / bang_bang(p.scene.device.structure, p.scene.device.gap, 120, v), 1, 1e-4);
    EXPECT_NEAR(found.impact_velocity / v, 1, 1e-3);
  }
}

TEST(LeastTime, OfTheGoldCantileverIsThatOfAnIndependentCalculation_slow) {
  const PreparedScene p = prepare_and_choose(gold(), true);
  // Another program with a free-form waveform gave 31.85, 31.66 and 31.06 us.
  for (const auto& [velocity, known] : {std::pair{1e-3, 31.85e-6}, {3e-3, 31.66e-6}, {10e-3, 31.06e-6}}) {
    const LeastTime found = least_time(p, {.impact_velocity = velocity});
    ASSERT_EQ(found.status, Status::done) << found.message;
    EXPECT_NEAR(found.time, known, 0.01e-6);
    EXPECT_NEAR(found.simulated_time / found.time, 1, 1e-4);
    EXPECT_LE(found.simulated_velocity, 1.2 * velocity);
  }
}

// A waveform with a landing within the tighter bound also meets the looser bound, so that its least time is no longer.
void expect_no_longer_where_more_speed_is_permitted(const PreparedScene& p, bool at_rest, std::initializer_list<double> speeds) {
  constexpr double same = 1e-3;
  double before = std::numeric_limits<double>::infinity();
  for (const double speed : speeds) {
    const LeastTime found = least_time(p, {.impact_velocity = speed, .at_rest = at_rest});
    ASSERT_EQ(found.status, Status::done) << speed << ": " << found.message;
    EXPECT_LE(found.time, (1 + same) * before) << speed;
    EXPECT_LE(found.impact_velocity, (1 + same) * speed);
    before = found.time;
  }
}

TEST(LeastTime, DoesNotGrowWithThePermittedSpeed) {
  const PreparedScene p = prepare_and_choose(spring_plate(), true);
  for (const bool at_rest : {false, true}) expect_no_longer_where_more_speed_is_permitted(p, at_rest, {2e-3, 0.02, 0.2});
}

TEST(LeastTime, OfTheGoldCantileverDoesNotGrowWithThePermittedSpeed_slow) {
  const PreparedScene p = prepare_and_choose(gold(), true);
  for (const bool at_rest : {false, true})
    expect_no_longer_where_more_speed_is_permitted(p, at_rest, {0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3, 30e-3});
}

// The frequencies of the modes differ by decades: with four modes the least time is 11.85 us.
TEST(LeastTime, OfAPiezoIsFoundAndShorterWithSixModes_slow) {
  const PreparedScene p = prepare_and_choose(gold_pzt({"structure.modes=6"}), true);
  const LeastTime found = least_time(p, {.actuator = Actuator::pzt, .impact_velocity = 1.33e-3});
  ASSERT_EQ(found.status, Status::done) << found.message;
  EXPECT_NEAR(found.time, 11.67e-6, 0.02e-6);
  EXPECT_NEAR(found.simulated_time / found.time, 1, 1e-4);
}

// Returns the time of two swings for a plate that one pull does not close. The plate is pulled from rest to its first turning
// point, released to the other side, pulled to x_s and released again, and arrives with speed v. The true optimum may turn
// slightly earlier or later.
double two_swings(const Structure& s, const Gap& gap, double volts, double v) {
  const double force = vacuum_permittivity * s.width * s.length * volts * volts / 2, m = part_of<Plate>(s).mass,
               k = part_of<Plate>(s).stiffness;
  const double omega = std::sqrt(k / m), d = gap.electrode, g = gap.contact;
  const auto work = [&](double x) { return force * (1 / (d - x) - 1 / d); };
  const double x1 = bracketed_zero([&](double x) { return work(x) - k * x * x / 2; }, 1e-9, 0.4 * d);
  const double energy = k * x1 * x1 / 2 - work(-x1);
  const double x_s = bracketed_zero([&](double x) { return energy + work(x) - (k * g * g + m * v * v) / 2; }, 0.0, g);
  const GaussRule rule = gauss_rule(60);
  double pulled = 0, pulled_again = 0;
  for (std::size_t i = 0; i < rule.points.size(); ++i) {
    // x = x1 sin^2(a) and x = y^2 - x1 make the roots at rest smooth.
    const double a = std::numbers::pi / 4 * (1 + rule.points[i]), x = x1 * std::sin(a) * std::sin(a);
    pulled +=
        rule.weights[i] * std::numbers::pi / 4 * 2 * x1 * std::sin(a) * std::cos(a) / std::sqrt((2 * work(x) - k * x * x) / m);
    const double end = std::sqrt(x_s + x1), y = end * (1 + rule.points[i]) / 2, z = y * y - x1;
    pulled_again += rule.weights[i] * end / 2 * 2 * y / std::sqrt((2 * (energy + work(z)) - k * z * z) / m);
  }
  const double amplitude = std::hypot(g, v / omega);
  return pulled + std::numbers::pi / omega + pulled_again + (std::asin(g / amplitude) - std::asin(x_s / amplitude)) / omega;
}

TEST(LeastTime, OfASwitchThatOnePullDoesNotCloseIsFoundFromASwingThatDoes) {
  SceneFile file = spring_plate();
  for (const char* change : {"driver.main.max_voltage=70 V", "waveform.main.level=70 V"}) file.set(change);
  const PreparedScene p = prepare_and_choose(file, true);
  const LeastTime alone = least_time(p, {.impact_velocity = 0.01});
  EXPECT_EQ(alone.status, Status::no_contact);
  const Pulse swing{.levels = {70, 0, 70}, .times = {24e-6, 47.5e-6}, .edge = 1e-8};
  const LeastTime found = least_time(p, {.impact_velocity = 0.01, .start = {{"main", swing}}});
  ASSERT_EQ(found.status, Status::done) << found.message;
  EXPECT_TRUE(found.from_start);
  const double known = two_swings(p.scene.device.structure, p.scene.device.gap, 70, 0.01);
  EXPECT_LE(found.time, known * (1 + 1e-4));
  EXPECT_GT(found.time, 0.97 * known);
  EXPECT_NEAR(found.simulated_time / found.time, 1, 1e-4);
  // If a single swing is faster, it remains the result.
  const PreparedScene strong = prepare_and_choose(spring_plate(), true);
  const LeastTime quick = least_time(strong, {.impact_velocity = 0.01}),
                  both = least_time(strong, {.impact_velocity = 0.01, .start = {{"main", swing}}});
  EXPECT_LE(both.time, quick.time);
  EXPECT_GT(both.time, (1 - 1e-4) * quick.time);
  // A start waveform that does not touch gives no result.
  EXPECT_EQ(least_time(p, {.impact_velocity = 0.01, .start = {{"main", Step{.level = 1}}}}).status, Status::no_contact);
}

TEST(LeastTime, GrowsWhereThereIsLessToPullWith) {
  const PreparedScene p = prepare_and_choose(spring_plate(), true);
  double last = 0;
  for (const double peak : {120.0, 110.0, 100.0}) {
    const LeastTime found = least_time(p, {.impact_velocity = 0.01, .peak = peak});
    ASSERT_EQ(found.status, Status::done) << peak << ": " << found.message;
    EXPECT_GT(found.time, last);
    EXPECT_EQ(found.peak, peak);
    last = found.time;
  }
  const LeastTime none = least_time(p, {.impact_velocity = 0.01, .peak = 50});
  EXPECT_EQ(none.status, Status::no_contact);
  EXPECT_FALSE(none.message.empty());
}

TEST(LeastTime, PullsWithTheSignThatTheDriverHas) {
  SceneFile file = spring_plate();
  for (const char* change : {"driver.main.min_voltage=-120 V", "driver.main.max_voltage=5 V", "waveform.main.level=-100 V"})
    file.set(change);
  const PreparedScene negative = prepare_and_choose(file, true);
  const LeastTime found = least_time(negative, {.impact_velocity = 0.01});
  const LeastTime usual = least_time(prepare_and_choose(spring_plate(), true), {.impact_velocity = 0.01});
  ASSERT_EQ(found.status, Status::done) << found.message;
  EXPECT_NEAR(found.time / usual.time, 1, 1e-6);
  EXPECT_EQ(violation(signal(found.waveforms.at("main")), negative.drives.at("main").limits.value()), "");
}

TEST(LeastTime, KeepsTheSlewOfTheDriver) {
  const PreparedScene jumps = prepare_and_choose(spring_plate(), true);
  SceneFile file = spring_plate();
  file.set("driver.main.max_slew=40 V/us");
  file.set("waveform.main.rise_time=5 us");
  const PreparedScene ramps = prepare_and_choose(file, true);
  const LeastTime fast = least_time(jumps, {.impact_velocity = 0.01}), slow = least_time(ramps, {.impact_velocity = 0.01});
  ASSERT_EQ(fast.status, Status::done) << fast.message;
  ASSERT_EQ(slow.status, Status::done) << slow.message;
  EXPECT_GT(slow.time, fast.time);
  EXPECT_TRUE(violation(signal(slow.waveforms.at("main")), ramps.drives.at("main").limits.value()).empty())
      << violation(signal(slow.waveforms.at("main")), ramps.drives.at("main").limits.value());
}

// The closer all modes are to rest at touch, the lower is the rebound.
TEST(LandingsAtRest, BringAPiezoToRestWithoutJumps_slow) {
  const SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold-pzt.toml");
  const PreparedScene p = prepare_and_choose(file, true);
  const auto found = rest_to_rest_starts(p, Actuator::pzt, 1.3e-3, {});
  ASSERT_GE(found.size(), 4U);
  const DriverLimits& limits = p.drives.at("piezo").limits.value();
  const double period = 2 * pi / p.model.basis().angular_frequencies()[0],
               steepest = (limits.max_voltage - limits.min_voltage) / period * 18;
  std::vector<double> heights;
  for (const auto& landing : found) {
    ASSERT_EQ(landing.size(), 1U);
    const Signal piezo = signal(landing.at("piezo"));
    EXPECT_EQ(violation(piezo, limits), "");
    EXPECT_LE(piezo.peak_slew(), 1.0001 * steepest);
    EXPECT_EQ(piezo.hold_level(), 0);
    DriveWaveforms all = plain_step(p, Actuator::pzt);
    all["piezo"] = landing.at("piezo");
    const PreparedScene scene = read_back(with_waveforms(p, all), "landing.toml", p);
    heights.push_back(
        metrics(simulate_closing(scene.model, scene.signals(), {.duration = 100e-6, .tolerance = 1e-8})).major_bounce_height);
  }
  const double least = *std::min_element(heights.begin(), heights.end());
  EXPECT_LT(least, 1e-9) << "of beams that rebound by up to a micrometre under a step";
  EXPECT_GT(heights.front(), 10 * least) << "far from rest yet";
}
TEST(LandingsAtRest, AreNoneWhereTheFlightIsNotFollowed) {
  const auto of = [](std::initializer_list<const char*> settings) {
    SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold-pzt.toml");
    for (const char* setting : settings) file.set(setting);
    return rest_to_rest_starts(prepare_and_choose(file, true), Actuator::pzt, 1.3e-3, {}).size();
  };
  EXPECT_EQ(of({"structure.modes=5"}), 0U);
  EXPECT_EQ(of({"driver.piezo.bandwidth=2 MHz"}), 0U);
}

PreparedScene ramped_plate(const std::string& level) {
  SceneFile file = spring_plate();
  for (const std::string& setting :
       {"waveform.main.level=" + level, std::string("waveform.main.rise_time=6 us"), std::string("driver.main.max_slew=20 V/us")})
    file.set(setting);
  return prepare_and_choose(file, true);
}

// At the contact the pull equals the spring force: a larger pull would press on a plate that comes to rest there.
TEST(FirstTouchProblem, LandsUnderTheVoltageThatHoldsWithoutPressing) {
  const PreparedScene p = ramped_plate("100 V");
  const auto landing = FirstTouchProblem(p, Actuator::electrostatic).landing();
  ASSERT_TRUE(landing.has_value());
  const Structure& s = p.scene.device.structure;
  const Gap& gap = p.scene.device.gap;
  const double open = gap.electrode - gap.contact;
  const double balance =
      std::sqrt(2 * part_of<Plate>(s).stiffness * gap.contact * open * open / (vacuum_permittivity * s.width * s.length));
  EXPECT_NEAR(landing->controls[0] * 120, balance, 1e-6 * balance);
  EXPECT_NEAR(landing->state[0], 1, 1e-9);
}

// 0.2 um of nitride with a charge for which no field is left at 10 V.
constexpr auto charged_nitride = R"(electrode.main.dielectric={thickness="0.2 um",permittivity=7.6,charge="-3.3646 mC/m^2"})";

TEST(LeastTime, CoastsWhereAChargeLeavesNoField) {
  const PreparedScene p = prepare_and_choose(spring_plate({charged_nitride}), true);
  const double neutral = p.model.neutral_voltage(0), speed = 1e-3;
  ASSERT_NEAR(neutral, 10, 1e-3);
  const LeastTime found = least_time(p, {.impact_velocity = speed});
  ASSERT_EQ(found.status, Status::done) << found.message;
  const auto best = bang_bang(p.model, {120}, {neutral}, {});
  ASSERT_TRUE(best);
  const double stop = 42 / 2.4e-9 * 2.6e-6;  // acceleration by the spring at the contact [m/s^2]
  EXPECT_NEAR(found.time / (best->driven_time + best->coasting_time - speed / stop), 1, 1e-4);
  EXPECT_NEAR(found.simulated_time / found.time, 1, 1e-4);
  EXPECT_NEAR(signal(found.waveforms.at("main")).range(0.99 * found.time).maximum, 120, 1e-6);
  EXPECT_NEAR(signal(found.waveforms.at("main")).voltage(0.99 * found.time), neutral, 0.5);
}

TEST(FirstTouchProblem, HasTheSlopesOfACharge) {
  for (const bool is_ramped : {false, true}) {
    SceneFile file = spring_plate({charged_nitride});
    if (is_ramped) file.set("driver.main.max_slew=20 V/us"), file.set("waveform.main.rise_time=6 us");
    const PreparedScene p = prepare_and_choose(file, true);
    FirstTouchProblem flight(p, Actuator::electrostatic);
    ASSERT_EQ(flight.ramps(), is_ramped);
    const Eigen::VectorXd x = Eigen::VectorXd::Constant(2, 0.3), c = Eigen::VectorXd::Constant(1, 0.4),
                          multipliers = Eigen::VectorXd::Constant(2, 0.7), step = Eigen::VectorXd::Constant(1, 1e-4);
    const auto rate = [&](const Eigen::VectorXd& control) { return flight.rates(x, control).value[1]; };
    EXPECT_NEAR(flight.rates(x, c).slope(1, 2), (rate(c + step) - rate(c - step)) / 2e-4, 1e-7 * std::abs(rate(c)));
    EXPECT_NEAR(flight.curvature(x, c, multipliers)(2, 2), 0.7 * (rate(c + step) - 2 * rate(c) + rate(c - step)) / 1e-8,
                1e-5 * std::abs(rate(c)));
    const double volts = flight.volts(c).at("main");
    if (is_ramped) {
      EXPECT_DOUBLE_EQ(volts, 0.4 * 120);
    } else {
      EXPECT_NEAR(p.model.strength(0, volts), 0.4 * std::pow(120 - p.model.neutral_voltage(0), 2), 1e-8);
    }
  }
}

TEST(Limit, LogsEverySearchInTheOrderOfTheWork) {
  const Pulse swing{.levels = {120, 0, 70}, .times = {16e-6, 25e-6}, .edge = 1e-8};
  const Limit found = limit(spring_plate(), {.start = {{"main", swing}}});
  using enum LimitGoal;
  const std::vector<LimitGoal> goals{touch,         quicker_landing, quicker_landing, rest,      over_velocity,
                                     over_velocity, over_velocity,   over_peak,       over_peak, over_peak,
                                     over_peak,     over_peak,       over_peak,       over_peak};
  ASSERT_EQ(found.attempts.size(), 2 * goals.size()) << "one from the swing and one from the waveform for each";
  for (std::size_t k = 0; k < goals.size(); ++k) {
    const LimitAttempt &swung = found.attempts[2 * k], &started = found.attempts[2 * k + 1];
    EXPECT_EQ(swung.goal, goals[k]) << k;
    EXPECT_EQ(started.goal, goals[k]) << k;
    EXPECT_FALSE(swung.found.from_start);
    EXPECT_TRUE(started.found.from_start);
    EXPECT_LE(swung.accepted + started.accepted, 1);
    for (const LimitAttempt* one : {&swung, &started}) {
      const LeastTime& own = one->found;
      EXPECT_EQ(own.iterations > 0, own.stage != SearchStage::start) << own.message;
      EXPECT_EQ(own.message.empty(), own.status == Status::done) << own.message;
      EXPECT_TRUE(!one->accepted || own.status == Status::done);
    }
  }
  const auto accepted = std::ranges::find_if(found.attempts, &LimitAttempt::accepted);
  ASSERT_NE(accepted, found.attempts.end());
  EXPECT_EQ(accepted->found.time, found.touch.time);
  EXPECT_EQ(accepted->found.from_start, found.touch.from_start);
}

TEST(Limit, LogsWhyAStartWasOfNoUse) {
  const Limit found = limit(spring_plate(), {.impact_velocity = 0.01, .start = {{"main", Step{.level = 1}}}, .curves = false});
  ASSERT_EQ(found.attempts.size(), 4U) << "touch and rest";
  EXPECT_TRUE(found.attempts[0].accepted);
  const LimitAttempt& started = found.attempts[1];
  EXPECT_FALSE(started.accepted);
  EXPECT_EQ(started.found.status, Status::no_contact);
  EXPECT_EQ(started.found.message, "the waveform to start with does not bring the switch to its contact");
}

TEST(Limit, LandsAPlateAtRestWhereTheSlewIsLimited_optimized) {
  for (const char* level : {"80 V", "115 V"}) {
    const PreparedScene p = ramped_plate(level);
    const LeastTime touch = least_time(p, {.impact_velocity = 5e-3});
    const LeastTime rest = least_time(p, {.impact_velocity = 5e-3, .at_rest = true});
    ASSERT_EQ(rest.status, Status::done) << level << ": " << rest.message;
    EXPECT_GT(rest.time, touch.time);
    EXPECT_LT(rest.time, 1.2 * touch.time);
    EXPECT_EQ(violation(signal(rest.waveforms.at("main")), p.drives.at("main").limits.value()), "");
  }
}

TEST(LeastTime, RefusesWhatItDoesNotFit) {
  EXPECT_NE(refusal([] {
              (void)limit(spring_plate(), {.start = {{"upper", Step{.level = 1}}}});
            }).find("\"upper\""),
            std::string::npos);
  EXPECT_NE(refusal([] { (void)least_time(prepare_and_choose(scene("hung-senturia.toml"), true), {}); }).find("compressible"),
            std::string::npos);
  EXPECT_NE(refusal([] { (void)least_time(prepare_and_choose(gold(), true), {.actuator = Actuator::pzt}); }).find("[piezo]"),
            std::string::npos);
  EXPECT_NE(refusal([] {
              (void)least_time(prepare_and_choose(gold({"driver.main.bandwidth=1 MHz"}), true), {});
            }).find("driver.main.sample_rate"),
            std::string::npos);
  EXPECT_NE(refusal([] { (void)least_time(prepare_and_choose(gold(), true), {.impact_velocity = 0}); }).find("positive"),
            std::string::npos);
}

TEST(Limit, LandsTheGoldCantileverWithoutAReboundInTheLeastTime_slow) {
  const Limit found = limit(gold(), {.impact_velocity = 1e-3, .curves = false});
  ASSERT_TRUE(found.landing.has_value());
  EXPECT_TRUE(found.landing->bounce_free);
  EXPECT_LE(found.landing->closing.metrics.permanent_contact_time, 1.02 * found.touch.time);
  EXPECT_EQ(found.rest.status, Status::done) << found.rest.message;
  EXPECT_GT(found.rest.time, found.touch.time);
}

// An independent calculation gave 0 V until just after the touch, then full voltage until 75 us.
TEST(Limit, LandsTheGoldCantileverByACatchThatBeginsLater_slow) {
  const Limit found = limit(gold(), {.impact_velocity = 10e-3, .curves = false});
  ASSERT_TRUE(found.landing.has_value());
  EXPECT_TRUE(found.landing->bounce_free);
  EXPECT_GT(found.landing->catch_delay, 0);
  EXPECT_GT(found.landing->catch_time, found.landing->catch_delay);
  EXPECT_LE(found.landing->closing.metrics.initial_contact_time, 31.1e-6);
}

TEST(Limit, RejectsALandingThatMoreModesUndo_slow) {
  // Jumps of the piezo excite modes beyond the four of the scene.
  const Limit found = limit(gold_pzt(), {.actuator = Actuator::both, .curves = false});
  ASSERT_TRUE(found.landing.has_value());
  EXPECT_EQ(found.landing->closing.metrics.bounce_count, 0);
  EXPECT_FALSE(found.landing->bounce_free);
}

}  // namespace
}  // namespace softland
