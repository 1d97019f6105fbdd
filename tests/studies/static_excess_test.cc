// How much too high few modes make the pull-in voltage of a bridge, against finite differences of the whole beam.
#include "studies/closing/static_excess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "base/decompositions.h"
#include "model/constants.h"
#include "studies/closing/auto_modes.h"
#include "studies/closing/auto_settings.h"
#include "tests/studies/scenes.h"

namespace softland::static_excess_test {
namespace {

using testing::Contains;
using testing::HasSubstr;

// 500 um x 20 um x 1 um of silicon over an electrode as long; `gap` in thicknesses.
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

// EI y'''' - N y'' = eps0 a V^2 / (2 (g - y)^2), N = EA / (2 L) int y'^2 dx, by central differences, the middle held.
class Differences {
 public:
  Differences(const Device& device, int intervals) : gap_(device.gap.electrode), unknowns_(intervals - 1) {
    const Structure& s = device.structure;
    h_ = s.length / intervals;
    const double area = s.width * s.thickness, rigidity = s.youngs_modulus * area * s.thickness * s.thickness / 12;
    stretch_ = s.youngs_modulus * area / (2 * s.length);
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

  // The fold: the largest V^2 over the deflection of the middle, by a parabola through the three highest.
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
      // Rows in units of the bending stiffness, the unknown in those of the load.
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

// Differences of second order, extrapolated.
double true_pull_in(const Device& device) {
  return (4 * Differences(device, 200).pull_in() - Differences(device, 100).pull_in()) / 3;
}

TEST(StaticExcess, OfABridgeBentByManyThicknessesIsThatAboveFiniteDifferences) {
  constexpr double resolved = 3e-3;  // relative: forty modes at a gap of 33 thicknesses
  for (const int gap : {3, 10, 33}) {
    const PreparedScene p = prepare(bridge(gap, "4"));
    const double own = static_pull_in(p.model, 0).voltage, truth = true_pull_in(p.scene.device);
    EXPECT_NEAR(static_excess(p.scene, 0, own), own / truth - 1, resolved) << gap;
    EXPECT_GT(own / truth - 1, gap == 3 ? 0.009 : 0.055) << gap;
  }
}

TEST(StaticExcess, IsSaidFromOnePercentOn) {
  const std::string said =
      "structure.modes = 4: the static pull-in voltage of electrode main, 271.3 V, is 5.8 % above that with 40 modes";
  EXPECT_THAT(prepare_and_choose(bridge(10, "4")).scene.warnings, Contains(HasSubstr(said)));
  EXPECT_THAT(static_excess_warnings(prepare(bridge(10, "20"))), testing::IsEmpty());
  EXPECT_THAT(static_excess_warnings(prepare(bridge(1, "4"))), testing::IsEmpty());
  EXPECT_TRUE(std::isnan(resolved_pull_in(prepare(gold()).scene, 0))) << "a cantilever does not stretch";
  SceneFile stiff = bridge(10, "4");
  stiff.set("structure.stretching=false");
  EXPECT_TRUE(std::isnan(resolved_pull_in(prepare(stiff).scene, 0)));
}

TEST(StaticExcess, IsWithinTheToleranceOfAutomaticModes) {
  const AutoModes chosen = choose_modes(bridge(20, "auto"));
  EXPECT_TRUE(chosen.settled());
  const PreparedScene p = prepare(bridge(20, std::to_string(chosen.modes)));
  EXPECT_LE(static_pull_in(p.model, 0).voltage, (1 + auto_modes_tolerance + 2e-3) * true_pull_in(p.scene.device));
}

}  // namespace
}  // namespace softland::static_excess_test
