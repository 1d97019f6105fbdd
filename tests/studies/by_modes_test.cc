// Tests how voltages and closed states change with more modes, against finite differences of the whole beam, and against scenes
// with that number of modes.
#include "studies/closing/by_modes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/decompositions.h"
#include "model/constants.h"
#include "studies/closing/auto_modes.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/simulate.h"
#include "tests/studies/scenes.h"

namespace softland::by_modes_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// A bridge of silicon, 500 um x 20 um x 1 um, over an electrode of its length; `gap` in thicknesses.
SceneFile bridge(int gap, const std::string& modes) {
  SceneFile file = SceneFile::parse(R"(
[structure]
kind = "clamped-clamped"
length = "500 um"
width = "20 um"
thickness = "1 um"
youngs_modulus = "160 GPa"
density = "2330 kg/m^3"
[electrode.main]
span = ["0 um", "500 um"]
fringing = "none"
[waveform.main]
family = "step"
level = "1 V"
[simulate]
duration = "10 us"
)",
                                    "bridge.toml");
  file.set("structure.modes=" + modes);
  file.set("gap.electrode=" + std::to_string(gap) + " um");
  file.set("gap.contact=" + std::to_string(8 * gap) + "00 nm");
  return file;
}

// Solves EI y'''' - N y'' = eps0 a V^2 / (2 (g - y)^2), N = EA / (2 L) int y'^2 dx, by central differences for a given
// deflection of the middle.
class Differences {
 public:
  Differences(const Device& device, int intervals) : gap_(device.gap.electrode), unknowns_(intervals - 1) {
    const Structure& s = device.structure;
    h_ = s.length / intervals;
    const double area = s.width * s.thickness, rigidity = part_of<Beam>(s).youngs_modulus * area * s.thickness * s.thickness / 12;
    stretch_ = part_of<Beam>(s).youngs_modulus * area / (2 * s.length);
    load_ = vacuum_permittivity * s.width / 2;
    second_ = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
    bending_ = second_;
    for (Eigen::Index i = 0; i < unknowns_; ++i) {
      second_(i, i) = -2, bending_(i, i) = i == 0 || i == unknowns_ - 1 ? 7 : 6;  // clamps mirror the beam
      if (i > 0) second_(i, i - 1) = second_(i - 1, i) = 1, bending_(i, i - 1) = bending_(i - 1, i) = -4;
      if (i > 1) bending_(i, i - 2) = bending_(i - 2, i) = 1;
    }
    second_ /= h_ * h_;
    bending_ *= rigidity / std::pow(h_, 4);
    y_ = Eigen::VectorXd::Ones(unknowns_);
    for (Eigen::Index i = 0; i < unknowns_; ++i) y_[i] -= std::cos(2 * pi * static_cast<double>(i + 1) / intervals);
  }

  // Returns the pull-in voltage: the largest V over the deflection of the middle, by a parabola through the three highest
  // values of V^2.
  [[nodiscard]] double pull_in() {
    constexpr int steps = 50;
    double before = 0, last = 0;
    for (int k = 1; k < steps; ++k) {
      const double here = square_of_voltage(gap_ * k / steps);
      if (here < last) {
        const double tilt = (before - here) / 4;
        return std::sqrt(last + tilt * tilt * 2 / (2 * last - before - here));
      }
      before = last, last = here;
    }
    return std::nan("");
  }

 private:
  double square_of_voltage(double deflection) {
    const Eigen::Index n = unknowns_, middle = n / 2;
    y_ *= deflection / y_[middle];
    Eigen::MatrixXd matrix(n + 1, n + 1);
    Eigen::VectorXd right(n + 1), step;
    do {
      const Eigen::VectorXd curvature = second_ * y_, load = load_ * (gap_ - y_.array()).square().inverse();
      const double tension = -stretch_ * h_ * y_.dot(curvature);
      matrix.setZero();
      matrix.topLeftCorner(n, n) = bending_ - tension * second_ + 2 * stretch_ * h_ * curvature * curvature.transpose();
      matrix.topLeftCorner(n, n).diagonal() -= (2 * square_ * load.array() / (gap_ - y_.array())).matrix();
      // Scale the rows by the bending stiffness, and the unknown by the load.
      const double stiff = bending_(0, 0), loaded = load.maxCoeff();
      right.head(n) = -(bending_ * y_ - tension * curvature - square_ * load) / stiff;
      right[n] = deflection - y_[middle];
      matrix.topLeftCorner(n, n) /= stiff;
      matrix.topRightCorner(n, 1) = -load / loaded;
      matrix(n, middle) = 1;
      step = solve_linear(matrix, right);
      y_ += step.head(n);
      square_ += step[n] * stiff / loaded;
    } while (step.head(n).cwiseAbs().maxCoeff() > 1e-9 * gap_);
    return square_;
  }

  double gap_, h_ = 0, stretch_ = 0, load_ = 0, square_ = 0;
  Eigen::Index unknowns_;
  Eigen::MatrixXd second_, bending_;
  Eigen::VectorXd y_;
};

// Extrapolates differences of second order.
double true_pull_in(const Device& device) {
  return (4 * Differences(device, 200).pull_in() - Differences(device, 100).pull_in()) / 3;
}

TEST(ByModes, OfAStronglyBentBridgeConvergeToFiniteDifferences) {
  constexpr double resolved = 4e-3;  // relative error of forty modes at a gap of 33 thicknesses
  for (const int gap : {3, 10, 33}) {
    const PreparedScene p = prepare(bridge(gap, "4"));
    const ByModes found = static_pull_in_by_modes(ModeLadder(p), p.scene, 0);
    const double own = static_pull_in(p.model, 0).voltage, truth = true_pull_in(p.scene.device);
    EXPECT_EQ(found.values.at(4), own) << gap;
    EXPECT_NEAR(found.converged, truth, resolved * truth) << gap;
    EXPECT_NEAR(found.moved(), truth / own - 1, resolved) << gap;
    EXPECT_LT(truth / own - 1, gap == 3 ? -0.009 : -0.05) << gap;
  }
}

TEST(ByModes, AreSaidOfAStaticPullInVoltageFromOnePercentOn) {
  EXPECT_THAT(prepare_and_choose(bridge(10, "4")).scene.warnings,
              Contains(HasSubstr("structure.modes = 4: more modes move the static pull-in voltage of electrode main, 271.28 V, "
                                 "by −5.5 %, to 256.48 V")));
  EXPECT_THAT(mode_warnings(prepare(bridge(10, "20"))), testing::IsEmpty());
  EXPECT_THAT(mode_warnings(prepare(bridge(1, "4"))), testing::IsEmpty());
  EXPECT_THAT(mode_warnings(prepare(gold())), testing::IsEmpty());
}

TEST(ByModes, AreExtrapolatedWhereTheyConverge) {
  // 7 + 3 * 2^-k: Aitken's process is exact for a geometric series.
  EXPECT_NEAR(by_modes({{3, 10}, {6, 8.5}, {12, 7.75}}).converged, 7, 1e-12);
  EXPECT_NEAR(by_modes({{3, 10}, {6, 8.5}, {12, 7.75}}).moved(), -0.3, 1e-12);
  EXPECT_TRUE(std::isnan(by_modes({{3, 10}, {6, 9}, {12, 7.75}}).converged)) << "the steps grow";
  EXPECT_NEAR(by_modes({{3, 10}, {6, 9}, {12, 7.75}}).moved(), -0.225, 1e-12) << "to the value with the most modes";
  EXPECT_TRUE(std::isnan(by_modes({{3, 10}, {6, 9}, {12, std::nan("")}}).converged));
  EXPECT_TRUE(std::isinf(by_modes({{3, 10}, {6, 9}, {12, std::nan("")}}).moved())) << "the value goes";
}

TEST(ByModes, AreWithinTheToleranceOfAutomaticModes) {
  const AutoModes chosen = choose_modes(bridge(20, "auto"));
  EXPECT_TRUE(chosen.settled());
  const PreparedScene p = prepare(bridge(20, std::to_string(chosen.modes)));
  EXPECT_LE(static_pull_in(p.model, 0).voltage, (1 + auto_modes_tolerance + 2e-3) * true_pull_in(p.scene.device));
}

// A bridge with its contact in the middle of a long electrode. It collapses onto the electrode on one side, at a voltage that
// decreases with the number of modes.
SceneFile held_in_the_middle(double volts, int modes) {
  SceneFile file = SceneFile::parse(R"(
[structure]
kind = "clamped-clamped"
length = "350 um"
width = "50 um"
thickness = "1.8 um"
youngs_modulus = "180 GPa"
density = "8900 kg/m^3"
residual_stress = "18 MPa"
[gap]
electrode = "2.3 um"
contact = "1.65 um"
[electrode.main]
span = ["45 um", "305 um"]
[gas]
model = "strip"
[contact]
model = "linear"
pad_length = "9 um"
stiffness = "2e4 N/m"
[waveform.main]
family = "step"
[driver.main]
max_voltage = "200 V"
)",
                                    "middle.toml");
  file.assign("waveform.main.level", volts);
  file.assign("structure.modes", modes);
  return file;
}

// Compares the verdicts of a scene with those of scenes with twice and four times as many modes, as far as possible. The scene
// must report all of them, and must not succeed if they differ. Returns true if they differ.
bool expect_told(const SceneFile& file) {
  constexpr double same = 1e-4;  // error of an eigenvalue by other quadrature points
  const PreparedScene p = prepare(file);
  const std::vector<double> volts = hold_levels(p.signals());
  const ClosedState state = closed_state(p, p.signals());
  if (!p.model.has_contact() || !state.exists) return false;
  const Structure& s = p.scene.device.structure;
  const bool has_more = s.find<Beam>() != nullptr;
  EXPECT_EQ(state.by_modes.has_value(), has_more) << file.name();
  if (!has_more || !state.by_modes) return false;
  bool any = false, all = true;
  for (const int modes : {s.modes, 2 * s.modes, 4 * s.modes}) {
    if (modes > most_modes) continue;
    SceneFile with = file;
    with.assign("structure.modes", modes);
    const PreparedScene more = prepare(with);
    const auto closed = closed_equilibrium(more.model, volts);
    if (!closed) {
      EXPECT_TRUE(std::isnan(state.by_modes->values.at(modes))) << file.name() << " " << modes;
    } else {
      EXPECT_NEAR(state.by_modes->values.at(modes), closed->smallest_eigenvalue, same * std::abs(closed->smallest_eigenvalue));
    }
    const bool is_stable = closed && closed->smallest_eigenvalue > 0;
    if (!judges_stability(more.model)) continue;
    any = any || is_stable;
    all = all && is_stable;
  }
  EXPECT_EQ(state.stable, all) << file.name();
  EXPECT_EQ(state.flips, any && !all) << file.name();
  const Closing c = simulate(p, false);
  EXPECT_TRUE(all || !c.metrics.settled) << file.name();
  EXPECT_TRUE(all || c.is_pulled_through) << file.name();
  if (any && !all) {
    EXPECT_THAT(c.warnings, Contains(HasSubstr("depends on the number of modes"))) << file.name();
    EXPECT_TRUE(std::isnan(c.metrics.hold_force)) << file.name();
  }
  return any && !all;
}

TEST(ByModes, OfEveryVerdictAgreeOrAreReported_optimized) {
  for (const std::string& name : shipped_scenes()) EXPECT_FALSE(expect_told(scene(name.c_str()))) << name;
  const PreparedScene four = prepare(held_in_the_middle(50, 4));
  const ByModes through =
      pulled_through_by_modes(ModeLadder(four), 0, {50.0}, pull_through_voltage(four.model, 0, std::vector{50.0}));
  const double with_four = through.values.at(4), with_sixteen = through.values.at(16);
  ASSERT_LT(with_sixteen, 0.99 * with_four);
  EXPECT_FALSE(expect_told(held_in_the_middle(0.99 * with_sixteen, 4)));
  EXPECT_TRUE(expect_told(held_in_the_middle((with_four + with_sixteen) / 2, 4)));
  EXPECT_FALSE(expect_told(held_in_the_middle(1.01 * with_four, 4)));
}

// The damping is so large that no step overshoots. At 264 V the switch stays open with 4 modes, whose pull-in voltage is 271.3
// V. The converged one is 256.5 V.
TEST(ByModes, OfASwitchThatOnlyFewModesKeepOpenAreReported) {
  SceneFile file = bridge(10, "4");
  file.set("gas={ model = \"linear\", quality_factor = 0.2 }");
  file.set("simulate.accuracy=1e-3");
  const auto at = [&](const char* level) {
    file.set(std::string("waveform.main.level=") + level);
    return simulate(prepare(file), false);
  };
  EXPECT_EQ(at("250 V").metrics.status, Status::open);
  const Closing closing = at("264 V");
  EXPECT_EQ(closing.metrics.status, Status::no_contact);
  EXPECT_THAT(closing.warnings, Contains(HasSubstr("whether the switch stays open depends on the number of modes")));
}

// An aluminium bridge that lands on nitride. The expected capacitances are those of 336 finite elements; 40 modes agree with
// them within 0.8 %.
TEST(ByModes, OfTheCapacitanceOfALandingAreReported) {
  SceneFile file =
      scene("new/capacitive-bridge.toml",
            {"structure.plate_strain=false", "structure.damping_ratio=0", "simulate.duration=10 us",
             "electrode.main.dielectric.landing={ model = \"linear\", stiffness = \"1e15 Pa/m\", from = \"30 nm\" }"});
  file.erase("gas");
  const auto capacitance = [&](const std::string& level, const std::string& modes) {
    file.set("waveform.main.level=" + level);
    file.set("structure.modes=" + modes);
    const PreparedScene p = prepare(file);
    return closed_capacitance_by_modes(ModeLadder(p), hold_levels(p.signals()));
  };
  for (const auto& [level, kept] : {std::pair{"30 V", 1.8445286494032567e-12}, std::pair{"40 V", 1.8833764017721314e-12}}) {
    const ByModes many = capacitance(level, "20"), few = capacitance(level, "2");
    EXPECT_NEAR(many.values.at(40), kept, 8e-3 * kept) << level;
    EXPECT_FALSE(many.is_worth_telling()) << level;
    EXPECT_TRUE(few.is_worth_telling()) << level;
    EXPECT_NEAR(few.values.at(20), many.values.at(20), 1e-6 * kept) << level;
    EXPECT_NE(few.values.at(2), few.values.at(20)) << level;
  }
  file.set("structure.modes=2");
  EXPECT_THAT(prepare_and_choose(file, false).scene.warnings, Contains(HasSubstr("capacitance of the closed state")));
  file.set("waveform.main.level=1 V");
  EXPECT_THAT(prepare_and_choose(file, false).scene.warnings, Not(Contains(HasSubstr("capacitance of the closed state"))))
      << "nothing holds it";
  file.set("waveform.main.level=30 V");
  file.set("structure.modes=20");
  EXPECT_THAT(prepare_and_choose(file, false).scene.warnings, Not(Contains(HasSubstr("capacitance of the closed state"))));
}

TEST(ByModes, CountTheModesThatHoldAValue) {
  EXPECT_EQ(modes_needed({.values = {{4, 1.2}, {8, 1.004}, {16, 1.001}}, .converged = 1}), 8);
  EXPECT_EQ(modes_needed({.values = {{4, 1.005}, {8, 1.02}, {16, 1.001}}, .converged = 1}), 16) << "the first one is an accident";
  EXPECT_EQ(modes_needed({.values = {{4, 1.2}, {8, 1.1}, {16, 1.05}}, .converged = 1}), std::nullopt);
  EXPECT_EQ(modes_needed({.values = {{4, 1.0}, {8, 1.0}}}), std::nullopt) << "converges to nothing";
}

TEST(ByModes, MakeAutomaticModesJudgeEveryClosedState_optimized) {
  SceneFile file = held_in_the_middle(50, 1);
  const PreparedScene one = prepare(file);
  const ByModes through =
      pulled_through_by_modes(ModeLadder(one), 0, {50.0}, pull_through_voltage(one.model, 0, std::vector{50.0}));
  const double last = through.values.rbegin()->second;
  for (const double share : {0.95, 1.02}) {
    file = held_in_the_middle(share * last, 1);
    file.set("structure.modes=auto");
    file.set("simulate.accuracy=1e-3");
    const AutoModes chosen = choose_modes(file);
    EXPECT_GT(chosen.modes, 1) << share;
    const PreparedScene p = prepare(held_in_the_middle(share * last, chosen.modes));
    const ClosedState state = closed_state(p, p.signals());
    EXPECT_FALSE(state.flips) << share;
    EXPECT_TRUE(state.stable.has_value()) << share;
  }
}

}  // namespace
}  // namespace softland::by_modes_test
