// The motion before the first touch, against the right-hand side of closings, and its derivatives, against differences.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/literals.h"
#include "model/forces/electrostatic.h"
#include "model/switch.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<std::pair<std::string, Device>> devices() {
  std::vector<std::pair<std::string, Device>> all;
  const Device gold = test::gold_cantilever();
  all.emplace_back("gold", gold);
  all.emplace_back("with a piezo", test::gold_pzt_cantilever());
  for (const auto& law : fringing_laws) {
    Device d = gold;
    d.electrodes[0].fringing = law.value;
    all.emplace_back("fringing " + std::string(law.name), d);
  }
  Device damped = gold;
  damped.structure.damping_ratio = 0.03;
  damped.gas.reset();
  all.emplace_back("damped", damped);
  const Device held = test::gold_bridge();
  all.emplace_back("stretched", held);
  Device braked = gold;
  braked.electrodes.push_back({.name = "upper", .begin = 60_um, .end = 240_um, .side = Side::far, .gap = 5_um});
  all.emplace_back("with a brake", braked);
  Device attracted = gold;
  attracted.dispersion = Dispersion{.hamaker_constant = 4e-19};
  all.emplace_back("attracted", attracted);
  return all;
}

struct Motion {
  VectorXd q, v;
  std::vector<double> values, strengths;
};

// The moving beam, deflected in several modes by a share of the contact gap, with every drive on.
Motion motion_of(const Switch& model, double share = 0.6) {
  Motion m;
  const Index n = model.modes();
  m.q = model.basis().contact_shape().cwiseQuotient(model.basis().angular_frequencies().cwiseAbs2());
  m.q *= share * model.device().gap.contact / model.basis().contact_shape().dot(m.q);
  m.v = VectorXd(n);
  for (Index i = 0; i < n; ++i) {
    m.q[i] *= 1 + 0.1 * std::sin(3.0 * static_cast<double>(i) + 1);
    m.v[i] = 0.3 * model.basis().angular_frequencies()[0] * m.q[0] * std::cos(2.0 * static_cast<double>(i));
  }
  for (std::size_t k = 0; k < model.drives(); ++k) {
    const bool piezo = model.drive_kind(k) == DriveKind::piezo;
    m.values.push_back(piezo ? 0.4 : 12.0 + static_cast<double>(k));
    if (model.drive_kind(k) == DriveKind::dispersion) m.values.back() = 0.25;
    m.strengths.push_back(piezo ? m.values.back() : model.strength(k, m.values.back()));
  }
  return m;
}

double off(const MatrixXd& a, const MatrixXd& b) { return (a - b).norm() / std::max(a.norm(), b.norm()); }

TEST(FreeMotion, IsThatOfClosingsBeforeTheTouch) {
  constexpr double rounding = 1e-12;
  for (const auto& [name, device] : devices()) {
    const Switch model(device);
    const Motion m = motion_of(model);
    Switch::Workspace work = model.workspace();
    const Index n = model.modes();
    VectorXd accelerations(n);
    MatrixXd by_q(n, n), by_v(n, n);
    model.accelerations(m.q.data(), m.v.data(), m.values, false, work, accelerations.data());
    model.jacobian(m.q.data(), m.v.data(), m.values, false, work, by_q, by_v);
    const Switch::FreeMotion free = model.free_motion(m.q.data(), m.v.data(), m.strengths, work);
    EXPECT_LE(off(free.accelerations, accelerations), rounding) << name;
    EXPECT_LE(off(free.by_q, by_q), rounding) << name;
    EXPECT_LE((free.by_v - by_v).norm(), rounding * by_v.norm()) << name;
  }
}

TEST(FreeMotion, IsLinearInTheStrengths) {
  for (const auto& [name, device] : devices()) {
    const Switch model(device);
    const Motion m = motion_of(model);
    Switch::Workspace work = model.workspace();
    const std::vector<double> none(m.strengths.size(), 0.0);
    const Switch::FreeMotion with = model.free_motion(m.q.data(), m.v.data(), m.strengths, work);
    VectorXd sum = model.free_motion(m.q.data(), m.v.data(), none, work).accelerations;
    for (std::size_t k = 0; k < m.strengths.size(); ++k) sum += m.strengths[k] * with.by_strength.col(static_cast<Index>(k));
    EXPECT_LE(off(with.accelerations, sum), 1e-11) << name;
  }
}

void expect_curvature_of_differences(const std::string& name, const Switch& model, const Motion& m, double relative) {
  Switch::Workspace work = model.workspace();
  const Index n = model.modes(), drives = static_cast<Index>(m.strengths.size());
  VectorXd weights(n), scale(2 * n + drives), at(2 * n + drives);
  for (Index i = 0; i < n; ++i) weights[i] = 1 + 0.5 * std::cos(static_cast<double>(i));
  // Rows with very different units are compared relative to the motion.
  scale << VectorXd::Constant(n, m.q.cwiseAbs().maxCoeff()), VectorXd::Constant(n, m.v.cwiseAbs().maxCoeff()),
      Eigen::Map<const VectorXd>(m.strengths.data(), drives).cwiseAbs();
  at << m.q, m.v, Eigen::Map<const VectorXd>(m.strengths.data(), drives);
  // Returns the derivative of the weighted sum by all parameters.
  const auto slope = [&](const VectorXd& x) {
    const VectorXd q = x.head(n), v = x.segment(n, n);
    const std::vector<double> strengths(x.data() + 2 * n, x.data() + 2 * n + drives);
    const Switch::FreeMotion f = model.free_motion(q.data(), v.data(), strengths, work);
    VectorXd all(2 * n + drives);
    all << f.by_q.transpose() * weights, f.by_v.transpose() * weights, f.by_strength.transpose() * weights;
    return VectorXd(all.cwiseProduct(scale));
  };
  MatrixXd differences(2 * n + drives, 2 * n + drives);
  for (Index k = 0; k < 2 * n + drives; ++k) {
    const double h = 1e-5;
    VectorXd up = at, down = at;
    up[k] += h * scale[k];
    down[k] -= h * scale[k];
    differences.col(k) = (slope(up) - slope(down)) / (2 * h);
  }
  const MatrixXd curvature = scale.asDiagonal() *
                             model.free_motion_curvature(m.q.data(), m.v.data(), m.strengths, weights.data(), work) *
                             scale.asDiagonal();
  EXPECT_LE(off(curvature, differences), relative) << name;
  EXPECT_LE(off(curvature, curvature.transpose()), 1e-13) << name;
}

TEST(FreeMotion, CurvesAsDifferencesOfItsSlopesDo) {
  constexpr double relative = 1e-6;  // error of central differences
  for (const auto& [name, device] : devices()) {
    const Switch model(device);
    expect_curvature_of_differences(name, model, motion_of(model), relative);
  }
}

TEST(FreeMotion, CurvesAsDifferencesOfItsSlopesDoBelowTheGapWhereLawsAreContinued) {
  constexpr double relative = 1e-4;  // error of central differences where the film varies with the cube of a small gap
  const Switch model(test::gold_cantilever());
  const double share = 1.1 * model.device().gap.electrode / model.device().gap.contact;
  expect_curvature_of_differences("gold", model, motion_of(model, share), relative);
}

}  // namespace
}  // namespace softland
