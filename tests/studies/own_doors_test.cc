// A user's own objective and waveform in the studies: those that equal a built-in one give the same results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include "objectives/own_objective.h"
#include "studies/closing/simulate.h"
#include "studies/devices/robustness.h"
#include "studies/search/optimize.h"
#include "studies/search/robust_cost.h"
#include "studies/search/robust_search_study.h"
#include "studies/search/search_setting.h"
#include "tests/studies/scenes.h"
#include "waveforms/own_waveform.h"

namespace softland::own_doors_test {
namespace {

using testing::HasSubstr;

class By final : public OwnObjective {
 public:
  using Value = std::function<double(const Metrics&, const Metrics&)>;
  explicit By(Value value, bool lands_first = true) : value_(std::move(value)), lands_first_(lands_first) {}
  [[nodiscard]] std::string_view name() const override { return "by"; }
  [[nodiscard]] double value(const Metrics& closing, const Metrics& step) const override { return value_(closing, step); }
  [[nodiscard]] bool lands_first() const override { return lands_first_; }

 private:
  Value value_;
  bool lands_first_;
};

Aim by(By::Value value, bool lands_first = true) { return Aim(std::make_shared<By>(std::move(value), lands_first)); }

double share_of_drive(const Metrics& m, const Metrics& step) { return m.drive_energy / step.drive_energy; }

// A ramp to a level that is held; its variable is the rise time.
class Ramp final : public OwnWaveform {
 public:
  Ramp(double hold, OwnParameter rise) : hold_(hold), rise_(std::move(rise)) {}
  [[nodiscard]] std::string_view name() const override { return "own-ramp"; }
  [[nodiscard]] std::vector<OwnParameter> parameters() const override { return {rise_}; }
  [[nodiscard]] std::vector<double> breakpoints(std::span<const double> x) const override {
    return x[0] > 0 ? std::vector<double>{x[0]} : std::vector<double>{};
  }
  [[nodiscard]] double voltage(double time, std::span<const double> x) const override {
    return time < x[0] ? hold_ * (time / x[0]) : hold_;
  }

 private:
  double hold_;
  OwnParameter rise_;
};

SceneFile quick_gold() { return gold_at_17_volts({"structure.modes=2"}); }

// A search of the built-in step, and one of an own waveform with the same bounds.
struct SameRamp {
  SceneFile scene = quick_gold();
  SearchSetting built_in = search_setting(scene, Target::bounce, Actuator::electrostatic, "step", {});
  Variable rise = built_in.space.variables().front();
  std::shared_ptr<const OwnWaveform> ramp = std::make_shared<Ramp>(
      built_in.space.drives().front().hold,
      OwnParameter{
          .name = "rise_time_s", .lower = rise.lower, .upper = rise.upper, .start = built_in.space.starts().front().front()});
};

TEST(OwnObjective, OfAFigureIsTheTargetOfThatFigure) {
  SearchSetting built_in = search_setting(quick_gold(), Target::drive, Actuator::electrostatic, "pulse", {});
  built_in.scale.judges_hardness = false;  // an own objective disables that rule
  SearchSetting own = built_in;
  own.target = by(share_of_drive);
  for (const std::vector<double>& x : built_in.space.starts()) {
    const SearchCosts a = built_in.cost_at(x), b = own.cost_at(x);
    EXPECT_EQ(a.target, b.target);
    EXPECT_EQ(a.guide, b.guide);
  }
}

TEST(OwnObjective, IsSearchedAsTheTargetOfItsFigure_long) {
  OptimizeOptions options{.target = Target::drive, .family = "pulse", .max_evaluations = 300};
  const OptimizeResult built_in = optimize(quick_gold(), options);
  options.target = by(share_of_drive);
  const OptimizeResult own = optimize(quick_gold(), options);
  ASSERT_TRUE(own.best);
  EXPECT_EQ(own.parameters, built_in.parameters);
  EXPECT_EQ(own.best_cost, built_in.best_cost);
  EXPECT_EQ(own.goal_met, built_in.goal_met);
}

TEST(OwnObjective, OfAnotherScaleIsSearchedAsWell_long) {
  OptimizeOptions options{.target = by(share_of_drive), .family = "pulse", .max_evaluations = 300};
  const OptimizeResult usual = optimize(quick_gold(), options);
  for (const double scale : {1e6, 1e-9}) {
    options.target = by([scale](const Metrics& m, const Metrics& step) { return scale * share_of_drive(m, step); });
    const OptimizeResult found = optimize(quick_gold(), options);
    ASSERT_TRUE(found.best) << scale;
    EXPECT_NEAR(share_of_drive(found.best->metrics, found.baseline.metrics),
                share_of_drive(usual.best->metrics, usual.baseline.metrics), 1e-3)
        << scale;
  }
}

TEST(OwnObjective, ThatIsNotFiniteForThePlainStepIsRefused) {
  for (const auto& [value, printed] : {std::pair{std::nan(""), "nan"}, std::pair{HUGE_VAL, "inf"}}) {
    EXPECT_THAT(refusal([value = value] {
                  (void)optimize(quick_gold(),
                                 {.target = by([value](const Metrics&, const Metrics&) { return value; }), .family = "pulse"});
                }),
                HasSubstr(std::string("the own objective 'by' gives ") + printed + " for the plain step"));
  }
}

TEST(OwnObjective, TakesTheShareOfASumThatItsWeightSays) {
  const Aim sum({{.target = Target::drive, .weight = 3}, {.weight = 1, .own = std::make_shared<By>(share_of_drive)}});
  EXPECT_EQ(sum.text(), "3 drive + 1 by");
  const SearchSetting one = search_setting(quick_gold(), Target::drive, Actuator::electrostatic, "pulse", {});
  SearchSetting both = one;
  both.target = sum;
  const std::vector<double> x = one.space.starts().front();
  EXPECT_NEAR(both.cost_at(x).target, one.cost_at(x).target, 1e-12 * one.cost_at(x).target);
}

TEST(OwnObjective, ThatDoesNotAskForALandingIsAllThatCounts) {
  const SearchSetting plain = search_setting(quick_gold(), Target::bounce, Actuator::electrostatic, "pulse", {});
  SearchSetting own = plain;
  Metrics seen;
  own.target = by(
      [&](const Metrics& m, const Metrics&) {
        seen = m;
        return 3.0;
      },
      false);
  const SearchCosts prices = own.cost_at(plain.space.starts().front());
  EXPECT_EQ(prices.target, 0.75);
  EXPECT_EQ(prices.guide, prices.target);
  for (const double known : {seen.initial_contact_time, seen.hold_force, seen.capacitance, seen.peak_voltage, seen.peak_slew,
                             seen.drive_energy, seen.landing_excess})
    EXPECT_TRUE(std::isfinite(known));
}

TEST(OwnObjective, ThatIsNegativeIsRefusedAndAnUnknownOneIsInfeasible) {
  SearchSetting own =
      search_setting(quick_gold(), by([](const Metrics&, const Metrics&) { return 1.0; }), Actuator::electrostatic, "pulse", {});
  const std::vector<double> x = own.space.starts().front();
  own.target = by([](const Metrics&, const Metrics&) { return -0.1; });
  EXPECT_EQ(refusal([&] { (void)own.cost_at(x); }), "the own objective 'by' gives -0.1; it must be >= 0");
  own.target = by([](const Metrics&, const Metrics&) { return std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_EQ(own.cost_at(x).target, std::numeric_limits<double>::infinity());
  EXPECT_EQ(own.gradient_refusal(own.target), "an own objective has no gradient");
  EXPECT_EQ(refusal([] { (void)Aim(std::shared_ptr<const OwnObjective>()); }), "an own objective must not be null");
}

TEST(OwnObjective, ThatThrowsEndsNoSearchAndIsReported) {
  const OptimizeResult found = optimize(quick_gold(), {.target = by([](const Metrics& m, const Metrics& step) -> double {
                                                         if (m.impact_velocity != step.impact_velocity)
                                                           throw std::domain_error("no such");
                                                         return 1;
                                                       }),
                                                       .family = "pulse",
                                                       .max_evaluations = 30});
  EXPECT_THAT(found.search.first_exception, HasSubstr("no such"));
  EXPECT_FALSE(found.best);
}

TEST(OwnObjective, ThatDoesNotAskForALandingIsSearchedByAMethodWithAGradientToo) {
  const auto off = [](const Metrics& m, const Metrics& step) {
    const double late = m.initial_contact_time / step.initial_contact_time - 1.2;
    const double fast = m.impact_velocity / step.impact_velocity - 0.6;
    return 100 * (late * late + fast * fast);
  };
  const OptimizeResult found =
      optimize(quick_gold(), {.target = by(off, false), .family = "pulse", .optimizer = "slsqp", .max_evaluations = 250});
  ASSERT_TRUE(found.best);
  const Metrics &best = found.best->metrics, &step = found.baseline.metrics;
  constexpr double near = 2e-3;
  EXPECT_NEAR(best.initial_contact_time, 1.2 * step.initial_contact_time, near * step.initial_contact_time);
  EXPECT_NEAR(best.impact_velocity, 0.6 * step.impact_velocity, near * step.impact_velocity);
  EXPECT_TRUE(found.goal_met) << "better than the plain step, however it bounces";
}

TEST(OwnObjective, OfDevicesIsTheTargetOfItsFigureInLanesAndOneByOne) {
  const SceneFile scene = quick_gold();
  const SearchSetting built_in = search_setting(scene, Target::drive, Actuator::electrostatic, "pulse", {});
  SearchSetting own = built_in;
  own.target = by(share_of_drive);
  const RobustAim aim{.measure = parse_robust_measure("worst", device_figures), .conditions = {}};
  const auto value = [&](const SearchSetting& setting, Vectors vectors) {
    const RobustCost cost(setting, aim, own_devices(setting, {}, 8, 1, 0, 1, {}), vectors);
    return cost.value(cost.close(setting.drives({}), 0, 8, 1));
  };
  EXPECT_EQ(value(own, Vectors::none), value(built_in, Vectors::none));
  EXPECT_EQ(value(own, vectors_in_use()), value(built_in, vectors_in_use()));
}

// An objective that evaluates many closings together, and none alone.
class ByMany final : public OwnObjective {
 public:
  explicit ByMany(double excess) : excess_(excess) {}
  [[nodiscard]] std::string_view name() const override { return "by many"; }
  [[nodiscard]] double value(const Metrics&, const Metrics&) const override { return Metrics::unset; }
  void values(std::span<const Metrics> closings, const Metrics& step, std::span<double> values) const override {
    ++calls_;
    for (std::size_t k = 0; k < closings.size(); ++k) values[k] = share_of_drive(closings[k], step) - excess_;
  }
  [[nodiscard]] int calls() const { return calls_; }

 private:
  double excess_;
  mutable int calls_ = 0;
};

TEST(OwnObjective, IsAskedOnceForAllDevicesOfACandidate) {
  SearchSetting setting = search_setting(quick_gold(), Target::drive, Actuator::electrostatic, "pulse", {});
  const RobustAim aim{.measure = parse_robust_measure("worst", device_figures), .conditions = {}};
  const auto value = [&](const Aim& target) {
    setting.target = target;
    const RobustCost cost(setting, aim, own_devices(setting, {}, 8, 1, 0, 1, {}));
    return cost.value(cost.close(setting.drives({}), 0, 8, 1));
  };
  const auto many = std::make_shared<ByMany>(0);
  EXPECT_EQ(value(Aim(many)), value(Target::drive));
  EXPECT_EQ(many->calls(), 1);
  const Aim sum({{.target = Target::impact, .weight = 1}, {.weight = 3, .own = many}});
  EXPECT_DOUBLE_EQ(value(sum), value(Aim({{.target = Target::impact, .weight = 1}, {.target = Target::drive, .weight = 3}})));
  EXPECT_THROW((void)value(Aim(std::make_shared<ByMany>(100))), InvalidInput);
}

TEST(OwnObjective, ForDevicesIsRacedAsTheTargetOfItsFigure_slow) {
  const RobustSearchOptions devices{.verdict = 64, .families = "pulse", .closings = 2000};
  OptimizeOptions options{.target = Target::drive, .family = "pulse", .max_evaluations = 100, .jobs = 2};
  SceneFile scene = quick_gold();
  const RobustSearchResult built_in = robust_search(scene, options, devices);
  options.target = by(share_of_drive);
  const RobustSearchResult own = robust_search(scene, options, devices);
  EXPECT_EQ(own.nominal.parameters, built_in.nominal.parameters);
  EXPECT_EQ(own.best.plain_step_wins, built_in.best.plain_step_wins);
  ASSERT_EQ(own.rows.size(), built_in.rows.size());
  ASSERT_GE(own.rows.size(), 3U);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(own.rows[k].judged.bounce_free.value, built_in.rows[k].judged.bounce_free.value);
  EXPECT_GT(own.findings.closings, 0);
}

TEST(OwnWaveform, ClosesASwitchAsTheFamilyOfItsVoltages) {
  const PreparedScene given = prepare(gold_at_17_volts());
  const SCurve curve{.levels = {20, 17.771}, .times = {25e-6}, .edge = 6e-6};
  const Signal of_curve = signal(Waveform(curve));
  class Copy final : public OwnWaveform {
   public:
    explicit Copy(Signal signal) : signal_(std::move(signal)) {}
    [[nodiscard]] std::string_view name() const override { return "copy"; }
    [[nodiscard]] std::vector<double> breakpoints(std::span<const double>) const override {
      std::vector<double> times = signal_.breakpoints();
      times.erase(times.begin());
      return times;
    }
    [[nodiscard]] double voltage(double time, std::span<const double>) const override { return signal_.voltage(time); }

   private:
    Signal signal_;
  };
  PreparedScene built_in = given, own_one = given;
  built_in.drives.at("main").waveform = curve;
  own_one.drives.at("main").waveform = own(std::make_shared<Copy>(of_curve));
  const Metrics a = simulate(built_in, false).metrics, b = simulate(own_one, false).metrics;
  constexpr double near = 1e-5;  // an accuracy of 1e-4, and a voltage to 1e-7
  EXPECT_NEAR(b.initial_contact_time, a.initial_contact_time, near * a.initial_contact_time);
  EXPECT_NEAR(b.impact_velocity, a.impact_velocity, near * a.impact_velocity);
  EXPECT_NEAR(b.major_bounce_height, a.major_bounce_height, 1e-3 * a.major_bounce_height);
  EXPECT_NEAR(b.peak_voltage, a.peak_voltage, near * a.peak_voltage);
}

TEST(OwnWaveform, IsSearchedAsTheFamilyOfItsVoltages_long) {
  const SameRamp same;
  OptimizeOptions options{.family = "step", .optimizer = "cma-es", .max_evaluations = 60};
  const OptimizeResult built_in = optimize(same.scene, options);
  options.own_waveforms = {same.ramp};
  options.family = "own-ramp";
  bool is_written = false;
  options.on_improvement = [&](const Evaluation&, const SceneFile&) { is_written = true; };
  const OptimizeResult own = optimize(same.scene, options);
  ASSERT_TRUE(own.best);
  EXPECT_EQ(own.family, "own-ramp");
  EXPECT_FALSE(is_written);
  constexpr double near = 1e-6;  // the built-in waveform is read back from text for its verification, the own one is not
  const double rise = own.parameters.at("main.rise_time_s");
  EXPECT_NEAR(rise, built_in.parameters.at("main.rise_time_s"), near * rise);
  EXPECT_NEAR(own.best_cost, built_in.best_cost, near * built_in.best_cost);
  EXPECT_NEAR(own.best->metrics.impact_velocity, built_in.best->metrics.impact_velocity,
              1e-3 * built_in.best->metrics.impact_velocity);
}

TEST(OwnWaveform, IsSearchedBesideFamilies) {
  const SameRamp same;
  const OptimizeResult found =
      optimize(same.scene, {.family = "own-ramp+pulse", .own_waveforms = {same.ramp}, .max_evaluations = 60, .keep_tried = true});
  std::vector<std::string> names;
  for (const SearchedFamilyResult& one : found.families) names.push_back(one.family);
  EXPECT_EQ(names, (std::vector<std::string>{"own-ramp", "pulse"}));
  for (const SearchedFamilyResult& one : found.families) EXPECT_GT(one.evaluations, 0) << one.family;
}

TEST(OwnWaveform, IsRefusedWhereItDoesNotEndOnTheHoldLevelOrCannotBeWritten) {
  const SameRamp same;
  const auto search = [&](double hold) {
    const auto other = std::make_shared<Ramp>(hold, OwnParameter{"rise_s", 0, 1e-5, 1e-6});
    return refusal([&] { (void)optimize(same.scene, {.family = "own-ramp", .own_waveforms = {other}, .max_evaluations = 1}); });
  };
  EXPECT_THAT(search(12), HasSubstr("the own waveform 'own-ramp', where its search begins: drive 'main' ends on 12 V"));
  EXPECT_THAT(search(26), HasSubstr("'own-ramp'"));
  EXPECT_EQ(search(17.771), "");
  class Fixed final : public OwnWaveform {
   public:
    [[nodiscard]] std::string_view name() const override { return "fixed"; }
    [[nodiscard]] std::vector<double> breakpoints(std::span<const double>) const override { return {}; }
    [[nodiscard]] double voltage(double, std::span<const double>) const override { return 17.771; }
  };
  EXPECT_EQ(refusal([&] { (void)optimize(same.scene, {.family = "fixed", .own_waveforms = {std::make_shared<Fixed>()}}); }),
            "the own waveform 'fixed' has no parameters that a search could vary");
  SceneFile file = same.scene;
  EXPECT_EQ(refusal([&] { file.set_waveform("main", own(same.ramp)); }),
            "waveform.main: the own waveform 'own-ramp' cannot be written into a scene file");
  EXPECT_THAT(refusal([&] { (void)robust_search(same.scene, {.family = "own-ramp", .own_waveforms = {same.ramp}}, {}); }),
              HasSubstr("own waveforms"));
  SearchSetting setting = search_setting(same.scene, Target::bounce, Actuator::electrostatic, "own-ramp", {}, {}, {same.ramp});
  EXPECT_EQ(setting.gradient_refusal(Target::bounce), "the own waveform 'own-ramp' has no gradient");
}

// A half cosine to a level that is held.
class Swell final : public OwnWaveform {
 public:
  [[nodiscard]] std::string_view name() const override { return "swell"; }
  [[nodiscard]] std::vector<double> breakpoints(std::span<const double>) const override { return {12e-6}; }
  [[nodiscard]] double voltage(double time, std::span<const double>) const override {
    return 17.771 / 2 * (1 - std::cos(std::numbers::pi * std::min(1.0, time / 12e-6)));
  }
};

TEST(OwnWaveform, DrivesDevicesAsTheFamilyOfItsVoltagesAndInLanesAsOneByOne) {
  const SameRamp same;
  const PreparedScene nominal = prepare(quick_gold(), true);
  const auto figures = [&](const Waveform& waveform, Vectors vectors = vectors_in_use(), const Calibration& known = {}) {
    return robustness(nominal, {{.name = "judged", .waveforms = {{"main", waveform}}, .calibration = known}},
                      {.samples = 32, .vectors = vectors})
        .drives.back()
        .outcomes;
  };
  const auto expect_alike = [&](const std::vector<DeviceOutcome>& a, const std::vector<DeviceOutcome>& b, double near) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      ASSERT_TRUE(a[k].closed() && b[k].closed()) << k;
      EXPECT_NEAR(a[k].metrics.initial_contact_time / b[k].metrics.initial_contact_time, 1, near) << k;
      EXPECT_NEAR(a[k].metrics.impact_velocity / b[k].metrics.impact_velocity, 1, near) << k;
    }
  };
  constexpr double of_integration = 1e-3;
  const Waveform built_in = Step{.level = 17.771, .rise_time = 9e-6}, own_one = Own{.waveform = same.ramp, .x = {9e-6}},
                 swell = own(std::make_shared<Swell>());
  expect_alike(figures(own_one), figures(built_in), 1e-12);
  expect_alike(figures(swell), figures(swell, Vectors::none), of_integration);
  const Calibration known{.pull_in_error = 0, .frequency_error = 0};
  expect_alike(figures(swell, vectors_in_use(), known), figures(swell, Vectors::none, known), of_integration);
}

}  // namespace
}  // namespace softland::own_doors_test
