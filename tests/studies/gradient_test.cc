// Gradients of a search's costs, and of the figures in them, against differences of tight closings.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "objectives/cost_slope.h"
#include "studies/search/search_setting.h"

namespace softland {
namespace {

SearchSetting setting_of(const std::string& scene, Actuator actuator, const std::string& family, Target target = Target::bounce,
                         const std::vector<std::string>& changes = {}) {
  SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/" + scene);
  for (const std::string& change : changes) file.set(change);
  return search_setting(file, target, actuator, family, {});
}

constexpr double tight = 1e-11;

Metrics figures_at(const SearchSetting& s, std::span<const double> x) {
  const std::vector<Signal> signals = s.given.applied(signals_of(s.drives(s.space.waveforms(x))));
  MetricsObserver observer(s.scale.contact_gap, s.given.scene.metrics);
  ClosingOptions run = s.run_of(signals);
  run.tolerance = tight;
  return observer.metrics(observe_closing(s.given.model, signals, run, observer));
}

constexpr double bound = 1e-5;  // error over the largest slope
constexpr std::array compared{&Metrics::initial_contact_time, &Metrics::largest_impact_velocity, &Metrics::major_bounce_height,
                              &Metrics::last_rebound_end,     &Metrics::impact_energy,           &Metrics::landing_excess,
                              &Metrics::peak_contact_force};

struct Compared {
  int cases = 0, slopes = 0;
  double worst = 0;
};

// Compares slopes of all figures at random points of a search's box with central differences. A case is skipped if a touch
// grazes in it, or appears or disappears between the two points of a difference. The energy of a landing is measured at the end
// of an integrator step, whose length has no derivative: gas takes a thousandth of the energy in a step.
void compare(const SearchSetting& s, int wanted, std::uint64_t seed, Compared& all) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.05, 0.95);
  const std::vector<Variable> variables = s.space.variables();
  std::vector<double> lower, upper;
  for (const Variable& v : variables) lower.push_back(v.lower), upper.push_back(v.upper);
  const auto signals_at = [&](std::span<const double> at) {
    return s.given.applied(signals_of(s.drives(s.space.waveforms(at))));
  };
  for (int tried = 0, done = 0; done < wanted && tried < 40 * wanted; ++tried) {
    std::vector<double> x;
    for (const Variable& v : variables) x.push_back(std::lerp(v.lower, v.upper, uniform(random)));
    if (!s.is_allowed(s.space.waveforms(x))) continue;
    const std::vector<Signal> signals = signals_at(x);
    RecordedMotion tape;
    ClosingOptions run = s.run_of(signals);
    run.tolerance = 1e-11;
    const Trajectory end = observe_closing(s.given.model, signals, run, tape);
    if (end.status != Status::done) continue;
    LinearizedClosing motion(s.given.model, signals, tape, 16);
    const CostSlopes slopes = cost_slopes(s.given.model, signals, motion, s.given.scene.metrics);
    if (slopes.grazing < grazing_share) continue;
    const SignalSlopes by(signals_at, x, lower, upper);
    if (!by.kinks().empty()) continue;
    ++done;
    ++all.cases;
    std::vector<FigureSlope> wanted_slopes;
    for (const auto figure : compared) wanted_slopes.push_back(slopes.of[figure]);
    const Eigen::MatrixXd backward = motion.backward(wanted_slopes, by), forward = motion.forward(wanted_slopes, by);
    const double size = backward.cwiseAbs().maxCoeff();
    for (Eigen::Index f = 0; f < backward.rows(); ++f)
      EXPECT_LT((backward.row(f) - forward.row(f)).cwiseAbs().maxCoeff(), 1e-8 * backward.row(f).cwiseAbs().maxCoeff() + 1e-300)
          << size;
    const auto differences = [&](std::size_t k, double share) {
      const double h = share * (upper[k] - lower[k]);
      std::vector<double> up = x, down = x, all_figures;
      up[k] += h, down[k] -= h;
      const Metrics a = figures_at(s, up), b = figures_at(s, down);
      for (const auto figure : compared) all_figures.push_back((a.*figure - b.*figure) / (2 * h));
      return all_figures;
    };
    for (std::size_t k = 0; k < x.size(); ++k) {
      const std::vector<double> coarse = differences(k, 2e-6), fine = differences(k, 1e-6);
      for (std::size_t f = 0; f < compared.size(); ++f) {
        if (!slopes.why_none[compared[f]].empty()) continue;
        if (compared[f] == &Metrics::last_rebound_end && slopes.ends_above) continue;
        double scale = 0;  // change of the figure over this parameter's range
        for (std::size_t i = 0; i < x.size(); ++i) {
          const double whole =
              std::abs(backward(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(i))) * (upper[i] - lower[i]);
          scale = std::max(scale, whole / (upper[k] - lower[k]));
        }
        // If differences of two widths disagree, the case is undecided: another touch is the fastest, or another rebound the
        // highest.
        if (!(std::abs(coarse[f] - fine[f]) <= 1e-6 * scale)) continue;
        ++all.slopes;
        const double slope = backward(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k));
        const double error = scale > 0 ? std::abs(slope - fine[f]) / scale : std::abs(fine[f]) > 0 ? 1 : 0;
        all.worst = std::max(all.worst, error / bound);
        EXPECT_LT(error, bound) << figure_of(compared[f]).key << " by " << variables[k].name << ": " << slope << ", differences "
                                << fine[f] << " (" << coarse[f] << ")";
      }
    }
  }
}

void expect_agreement(const SearchSetting& s, int cases) {
  Compared all;
  compare(s, cases, 1, all);
  EXPECT_EQ(all.cases, cases);
  EXPECT_GT(all.slopes, 2 * cases);
  std::printf("%d cases, %d slopes, the worst off by %.2g of its bound\n", all.cases, all.slopes, all.worst);
}

TEST(Gradient, OfPulsesOnTheGoldSwitch_slow) {
  expect_agreement(setting_of("mem-gold.toml", Actuator::electrostatic, "pulse"), 40);
}
TEST(Gradient, OfBothDrives_slow) { expect_agreement(setting_of("mem-gold-pzt.toml", Actuator::both, "pulse"), 15); }
TEST(Gradient, OfDithers_slow) { expect_agreement(setting_of("mem-gold-pzt.toml", Actuator::pzt, "dither"), 10); }
TEST(Gradient, OfSplines_optimized) { expect_agreement(setting_of("mem-gold.toml", Actuator::electrostatic, "bspline:6"), 10); }
TEST(Gradient, OfSines_optimized) { expect_agreement(setting_of("mem-gold-pzt.toml", Actuator::pzt, "sines:6"), 5); }
TEST(Gradient, OfTwoElectrodes_optimized) {
  expect_agreement(setting_of("two-electrodes.toml", Actuator::electrostatic, "coast"), 10);
}
TEST(Gradient, OfANanometreSwitch) { expect_agreement(setting_of("nem-tin.toml", Actuator::electrostatic, "pulse"), 5); }
TEST(Gradient, OfAPlasticContact_optimized) {
  expect_agreement(setting_of("mem-gold.toml", Actuator::electrostatic, "pulse", Target::bounce,
                              {"contact.model=elastic-plastic", "contact.hardness=1 GPa"}),
                   5);
}
TEST(Gradient, OfADampedContact_optimized) {
  expect_agreement(setting_of("mem-gold.toml", Actuator::electrostatic, "pulse", Target::bounce, {"contact.damping=0.5 s/m"}), 5);
}

TEST(Gradient, ByTheTimesOfJumps) {
  constexpr double step = 1e-10, differenced = 1e-6;
  const SearchSetting s = setting_of("mem-gold.toml", Actuator::electrostatic, "pulse");
  const std::vector<double> x{20e-6, 25e-6}, lower{19e-6, 24e-6}, upper{21e-6, 26e-6};
  const auto signals_at = [](std::span<const double> times) {
    return std::vector<Signal>{signal(Pulse{.levels = {20, 0, 19}, .times = {times.begin(), times.end()}})};
  };
  const auto closed = [&](std::span<const double> times, ClosingObserver& observer) {
    return observe_closing(s.given.model, signals_at(times), {.duration = 60e-6, .tolerance = tight}, observer);
  };
  RecordedMotion tape;
  (void)closed(x, tape);
  const std::vector<Signal> signals = signals_at(x);
  LinearizedClosing motion(s.given.model, signals, tape, 16);
  const CostSlopes slopes = cost_slopes(s.given.model, signals, motion, s.given.scene.metrics);
  const SignalSlopes by(signals_at, x, lower, upper);
  const std::array figures{&Metrics::initial_contact_time, &Metrics::impact_velocity};
  const std::vector<FigureSlope> wanted{slopes.of[figures[0]], slopes.of[figures[1]]};
  const Eigen::MatrixXd backward = motion.backward(wanted, by), forward = motion.forward(wanted, by);
  for (std::size_t k = 0; k < x.size(); ++k) {
    std::array<Metrics, 2> sides;
    for (const int side : {0, 1}) {
      std::vector<double> moved = x;
      moved[k] += side == 0 ? -step : step;
      MetricsObserver observer(s.scale.contact_gap, s.given.scene.metrics);
      sides[static_cast<std::size_t>(side)] = observer.metrics(closed(moved, observer));
    }
    for (std::size_t f = 0; f < figures.size(); ++f) {
      const auto row = static_cast<Eigen::Index>(f), column = static_cast<Eigen::Index>(k);
      const double expected = (sides[1].*figures[f] - sides[0].*figures[f]) / (2 * step);
      EXPECT_NEAR(backward(row, column), expected, differenced * std::abs(expected)) << f << " by time " << k + 1;
      EXPECT_NEAR(forward(row, column), expected, differenced * std::abs(expected)) << f << " by time " << k + 1;
    }
  }
}

// The motion after the last time on which a figure depends is not linearised, which changes no derivative.
TEST(Gradient, OfOneFigureIsThatOfAll) {
  const SearchSetting s = setting_of("mem-gold.toml", Actuator::electrostatic, "pulse");
  std::vector<double> x;
  for (const Variable& v : s.space.variables()) x.push_back(std::lerp(v.lower, v.upper, 0.4));
  const std::vector<Signal> signals = s.given.applied(signals_of(s.drives(s.space.waveforms(x))));
  RecordedMotion tape;
  (void)observe_closing(s.given.model, signals, s.run_of(signals), tape);
  LinearizedClosing motion(s.given.model, signals, tape);
  const CostSlopes slopes = cost_slopes(s.given.model, signals, motion, s.given.scene.metrics);
  ASSERT_LT(slopes.of[&Metrics::initial_contact_time].weights.front().arc,
            slopes.of[&Metrics::last_rebound_end].weights.front().arc);
  const SignalSlopes by = s.signal_slopes(x);
  const Eigen::MatrixXd first = motion.backward({slopes.of[&Metrics::initial_contact_time]}, by);
  const Eigen::MatrixXd both =
      motion.backward({slopes.of[&Metrics::initial_contact_time], slopes.of[&Metrics::last_rebound_end]}, by);
  const Eigen::MatrixXd again = motion.backward({slopes.of[&Metrics::initial_contact_time]}, by);
  EXPECT_GT(first.cwiseAbs().maxCoeff(), 0);
  EXPECT_TRUE(first == both.topRows(1));
  EXPECT_TRUE(first == again);
  const Eigen::MatrixXd forward =
      LinearizedClosing(s.given.model, signals, tape).forward({slopes.of[&Metrics::initial_contact_time]}, by);
  EXPECT_LT((forward - first).cwiseAbs().maxCoeff(), 1e-8 * first.cwiseAbs().maxCoeff());
}
TEST(Gradient, IsThatOfTheClosingThatWasPricedLast) {
  const SearchSetting s = setting_of("mem-gold-pzt.toml", Actuator::both, "pulse");
  const auto at = [&](double place) {
    std::vector<double> x;
    for (const Variable& v : s.space.variables()) x.push_back(std::lerp(v.lower, v.upper, place));
    return x;
  };
  const std::vector<double> here = at(0.4), elsewhere = at(0.45);
  LastClosing last;
  EXPECT_EQ(s.cost_at(here, nullptr, &last).guide, s.cost_at(here).guide);
  EXPECT_EQ(last.x, here);
  const std::vector<double> alone = s.gradient_at(here, Target::bounce);
  ASSERT_TRUE(std::isfinite(alone[0]));
  EXPECT_EQ(s.gradient_at(here, Target::bounce, {}, &last), alone);
  EXPECT_EQ(s.gradient_at(elsewhere, Target::bounce, {}, &last), s.gradient_at(elsewhere, Target::bounce)) << "of another point";
  const auto known = last.closing;
  std::vector<double> outside = here;
  outside[0] = 1e6;
  (void)s.cost_at(outside, nullptr, &last);
  EXPECT_EQ(last.closing, known) << "nothing was closed";
}
TEST(Gradient, OfConditionsIsThatOfTheirFigures) {
  std::vector<Condition> conditions;
  for (const char* text :
       {"t_i < 30 us", "v_i <= 20 mm/s", "peak force < 50 uN", "impact energy > 1 pJ", "bounce_count == 0", "B_H < 3 nm"})
    conditions.push_back(parse_condition(text, conditioned_figures));
  const SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml");
  SearchSetting s = search_setting(file, Target::bounce, Actuator::electrostatic, "pulse", {}, conditions);
  EXPECT_EQ(s.gradient_refusal(Target::bounce), "");
  ASSERT_EQ(s.followed_conditions().size(), 5U) << "all but the count";
  s.run.tolerance = tight;
  const std::vector<Variable> variables = s.space.variables();
  int compared = 0;
  for (const double place : {0.2, 0.3, 0.4, 0.5, 0.6, 0.7}) {
    std::vector<double> x;
    for (const Variable& v : variables) x.push_back(std::lerp(v.lower, v.upper, place));
    const std::vector<double> gradients = s.gradient_at(x, Target::bounce);
    ASSERT_EQ(gradients.size(), 6 * x.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double h = 1e-6 * (variables[k].upper - variables[k].lower);
      std::vector<double> up = x, down = x;
      up[k] += h, down[k] -= h;
      const SearchCosts above = s.cost_at(up), below = s.cost_at(down);
      for (std::size_t c = 0; c < 3; ++c) {  // rebounds of such waveforms, and sums over all touches, are chaotic
        const double difference = (above.apart->excess[c] - below.apart->excess[c]) / (2 * h);
        double largest = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
          largest = std::max(largest, std::abs(gradients[(1 + c) * x.size() + i]) * (variables[i].upper - variables[i].lower));
        EXPECT_NEAR(gradients[(1 + c) * x.size() + k] * (variables[k].upper - variables[k].lower),
                    difference * (variables[k].upper - variables[k].lower), 1e-3 * largest)
            << conditions[c].text << " by " << variables[k].name << " at " << place;
        compared += std::isfinite(difference) && difference != 0;
      }
    }
  }
  EXPECT_GT(compared, 30);
}
TEST(Gradient, IsRefusedForConditionsWithoutDerivatives) {
  const auto refusal = [](const char* condition) {
    const SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml");
    return search_setting(file, Target::bounce, Actuator::electrostatic, "pulse", {},
                          {parse_condition(condition, conditioned_figures)})
        .gradient_refusal(Target::bounce);
  };
  EXPECT_EQ(refusal("drive energy < 1 pJ"), "the condition drive energy < 1 pJ has no gradient");
  EXPECT_EQ(refusal("t_i == 30 us"), "the condition t_i == 30 us has no gradient");
  EXPECT_EQ(refusal("bounce_count == 0"), "");
}
TEST(Gradient, IsUnknownOfTheEnergyThatIsStoredAlongAPad) {
  const SearchSetting s =
      setting_of("mem-gold.toml", Actuator::electrostatic, "pulse", Target::energy, {"contact.distribution=pad"});
  std::vector<double> x;
  for (const Variable& v : s.space.variables()) x.push_back(std::lerp(v.lower, v.upper, 0.4));
  const auto knows = [&](Target target) { return std::isfinite(s.gradient_at(x, target, s.parameter_groups())[0]); };
  EXPECT_TRUE(knows(Target::bounce));
  EXPECT_FALSE(knows(Target::energy));
}

}  // namespace
}  // namespace softland
