#include "model/static_slopes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/decompositions.h"

namespace softland {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double no_slope = std::numeric_limits<double>::quiet_NaN();

// Derivatives of the static modal accelerations at an equilibrium.
struct Tangent {
  MatrixXd by_q, by_strength;  // derivatives by modal coordinates [rad^2/s^2], and by the strengths of the drives
  VectorXd scale;              // 1 / omega^2 of each mode, omega its angular frequency

  Tangent(const Switch& model, const VectorXd& q, std::span<const double> volts, const ContactState& contact)
      : by_q(model.modes(), model.modes()),
        by_strength(model.modes(), static_cast<Eigen::Index>(model.drives())),
        scale(model.basis().angular_frequencies().cwiseAbs2().cwiseInverse()) {
    const VectorXd still = VectorXd::Zero(model.modes());
    VectorXd force(model.modes());
    MatrixXd by_v(model.modes(), model.modes());
    Switch::Workspace work = model.workspace();
    model.accelerations(q.data(), still.data(), volts, contact, work, force.data());
    model.jacobian(q.data(), still.data(), volts, contact, work, by_q, by_v);
    model.accelerations(q.data(), still.data(), volts, contact, work, force.data());
    model.drive_forces(work, by_strength);
  }

  // Returns the solution x of F_q x = right, F_q being `by_q`. Each equation is divided by its mode's stiffness.
  [[nodiscard]] VectorXd solved(const VectorXd& right) const {
    return solve_linear(scale.asDiagonal() * by_q, scale.cwiseProduct(right));
  }
};

VectorXd change_of_accelerations(SwitchSlopes& by, std::size_t j, const VectorXd& q, std::span<const double> volts,
                                 const ContactState& contact, const MatrixXd& by_q) {
  const VectorXd still = VectorXd::Zero(q.size());
  VectorXd change(q.size());
  by.accelerations(j, q.data(), still.data(), volts, contact, by_q, change);
  return change;
}

// Returns the derivatives, by device parameters, of the voltage with which a drive holds the contact point at a constant
// interference (deflection less contact gap). `deflection` is the deflection of the contact point in this state.
std::vector<double> held_slopes(const Switch& model, SwitchSlopes& by, std::size_t drive, double deflection, Bias bias) {
  std::vector<double> slopes(by.moving().size(), no_slope);
  const std::optional<HeldEquilibrium> held = held_by_drive(model, drive, deflection, bias);
  if (!held) return slopes;
  std::vector<double> volts(bias.begin(), bias.end());
  volts.resize(model.drives(), 0.0);
  volts[drive] = held->voltage;
  const bool acts = model.has_spread_contact() || (model.has_contact() && model.rigid_contact() == nullptr &&
                                                   deflection > model.contact_gap() - model.contact_reach());
  const ContactState contact = acts;
  const Tangent tangent(model, held->q, volts, contact);
  const Eigen::Index n = model.modes();
  const VectorXd& shape = model.basis().contact_shape();
  const double largest = shape.cwiseAbs().maxCoeff();
  MatrixXd bordered = MatrixXd::Zero(n + 1, n + 1);
  bordered.topLeftCorner(n, n) = tangent.scale.asDiagonal() * tangent.by_q;
  bordered.topRightCorner(n, 1) = tangent.scale.cwiseProduct(tangent.by_strength.col(static_cast<Eigen::Index>(drive)));
  bordered.bottomLeftCorner(1, n) = shape.transpose() / largest;
  for (std::size_t j = 0; j < slopes.size(); ++j) {
    VectorXd right(n + 1);
    right.head(n) = -tangent.scale.cwiseProduct(change_of_accelerations(by, j, held->q, volts, contact, tangent.by_q));
    right[n] = -by.interference(j, held->q.data()) / largest;
    const double by_strength = solve_linear(bordered, right)[n];
    slopes[j] = by_strength / model.strength_slope(drive, held->voltage);
  }
  return slopes;
}

// The open equilibrium of a switch: modal coordinates, and the state of the contact law, which may act above the contact plane.
struct Rest {
  VectorXd q;
  ContactState contact;
};

std::optional<Rest> rest_under(const Switch& model, std::span<const double> values) {
  std::optional<VectorXd> q = model.open_equilibrium(values);
  if (!q) return std::nullopt;
  const ContactState contact = model.untouched(q->data());
  return Rest{.q = std::move(*q), .contact = contact};
}

MatrixXd symmetric_tangent(const Switch& model, const VectorXd& q, std::span<const double> values) {
  const VectorXd still = VectorXd::Zero(q.size());
  VectorXd force(q.size());
  MatrixXd by_q(q.size(), q.size()), by_v(q.size(), q.size());
  const ContactState contact = model.untouched(q.data());
  Switch::Workspace work = model.workspace();
  model.accelerations(q.data(), still.data(), values, contact, work, force.data());
  model.jacobian(q.data(), still.data(), values, contact, work, by_q, by_v);
  return -(by_q + by_q.transpose()) / 2;
}

// Returns true when no drive acts on the switch: all values are 0 and no dielectric is charged.
bool are_zero(const Switch& model, std::span<const double> values) {
  return !model.device().is_charged() && std::all_of(values.begin(), values.end(), [](double v) { return v == 0; });
}

// Returns the derivative of the equilibrium's modal coordinates by the voltage of a drive.
VectorXd motion_by_voltage(const Switch& model, const Tangent& tangent, std::size_t drive, double value) {
  const double by_value = model.strength_slope(drive, value);
  const VectorXd force = model.drive_kind(drive) == DriveKind::piezo
                             ? model.basis().piezo_shape()
                             : VectorXd(tangent.by_strength.col(static_cast<Eigen::Index>(drive)));
  return -tangent.solved(by_value * force);
}

// Returns a step for central differences along a direction of the modal coordinates: small against the contact gap, but far
// above rounding.
double small_step(const Switch& model, const VectorXd& direction) {
  constexpr double share = 1e-5;  // deflection of the contact point by the step, as a share of the contact gap
  const double moved = std::abs(model.contact_deflection(direction.data()));
  return moved > 0 ? share * model.contact_gap() / moved : 1;
}

double capacitance_at(const Switch& model, std::size_t drive, const VectorXd& q) {
  Switch::Workspace work = model.workspace();
  return model.capacitance(drive, q.data(), work);
}

}  // namespace

std::vector<double> static_pull_in_slopes(const Switch& model, SwitchSlopes& by, std::size_t drive, const StaticPullIn& pull_in,
                                          Bias bias) {
  if (pull_in.status != Status::done) return std::vector<double>(by.moving().size(), no_slope);
  return held_slopes(model, by, drive, pull_in.deflection, bias);
}

std::vector<double> release_slopes(const Switch& model, SwitchSlopes& by, std::size_t drive, const ReleasePoint& release,
                                   Bias bias) {
  if (std::isnan(release.voltage) || release.voltage == 0) return std::vector<double>(by.moving().size(), no_slope);
  return held_slopes(model, by, drive, release.deflection, bias);
}

double resonance(const Switch& model, std::size_t mode, std::span<const double> values) {
  if (are_zero(model, values)) return model.basis().angular_frequencies()[static_cast<Eigen::Index>(mode)];
  const std::optional<Rest> rest = rest_under(model, values);
  if (!rest) return no_slope;
  const double square = symmetric_eigen(symmetric_tangent(model, rest->q, values)).values[static_cast<Eigen::Index>(mode)];
  return square > 0 ? std::sqrt(square) : no_slope;
}

std::vector<double> resonance_slopes(const Switch& model, SwitchSlopes& by, std::size_t mode, std::span<const double> values) {
  std::vector<double> slopes(by.moving().size(), no_slope);
  const auto m = static_cast<Eigen::Index>(mode);
  if (are_zero(model, values)) {
    for (std::size_t j = 0; j < slopes.size(); ++j)
      slopes[j] = by.of_switch(j, [&](const Switch& s, double) { return s.basis().angular_frequencies()[m]; });
    return slopes;
  }
  const std::optional<Rest> rest = rest_under(model, values);
  if (!rest) return slopes;
  const SymmetricEigen eigen = symmetric_eigen(symmetric_tangent(model, rest->q, values));
  if (!(eigen.values[m] > 0)) return slopes;
  const VectorXd shape = eigen.vectors.col(m);
  const Tangent tangent(model, rest->q, values, rest->contact);
  for (std::size_t j = 0; j < slopes.size(); ++j) {
    const VectorXd motion = -tangent.solved(change_of_accelerations(by, j, rest->q, values, rest->contact, tangent.by_q));
    const double by_parameter = by.of_switch(j, [&](const Switch& s, double step) {
      return shape.dot(symmetric_tangent(s, rest->q + step * motion, values) * shape);
    });
    slopes[j] = by_parameter / (2 * std::sqrt(eigen.values[m]));
  }
  return slopes;
}

double resonance_by_voltage(const Switch& model, std::size_t mode, std::size_t moved, std::span<const double> values) {
  const std::optional<Rest> rest = rest_under(model, values);
  if (!rest) return no_slope;
  const auto m = static_cast<Eigen::Index>(mode);
  const SymmetricEigen eigen = symmetric_eigen(symmetric_tangent(model, rest->q, values));
  const VectorXd shape = eigen.vectors.col(m);
  const Tangent tangent(model, rest->q, values, rest->contact);
  const VectorXd motion = motion_by_voltage(model, tangent, moved, values[moved]);
  const double step = motion.isZero(0) ? 0 : small_step(model, motion);
  if (step == 0) return 0;
  std::vector<double> above(values.begin(), values.end()), below = above;
  above[moved] += step, below[moved] -= step;
  const double change = shape.dot(
      (symmetric_tangent(model, rest->q + step * motion, above) - symmetric_tangent(model, rest->q - step * motion, below)) *
      shape);
  return change / (2 * step) / (2 * std::sqrt(eigen.values[m]));
}

double open_capacitance(const Switch& model, std::size_t drive, std::span<const double> values) {
  const std::optional<Rest> rest = rest_under(model, values);
  return rest ? capacitance_at(model, drive, rest->q) : no_slope;
}

std::vector<double> open_capacitance_slopes(const Switch& model, SwitchSlopes& by, std::size_t drive,
                                            std::span<const double> values) {
  std::vector<double> slopes(by.moving().size(), no_slope);
  const std::optional<Rest> rest = rest_under(model, values);
  if (!rest) return slopes;
  const Tangent tangent(model, rest->q, values, rest->contact);
  // Column `drive` of by_strength is the force of the electrode at unit strength, so the force is (V - V0)^2 times this column.
  // The force is also the gradient of C (V - V0)^2 / 2, C the capacitance: the gradient of C is twice this column.
  const VectorXd by_q = 2 * tangent.by_strength.col(static_cast<Eigen::Index>(drive));
  for (std::size_t j = 0; j < slopes.size(); ++j) {
    const VectorXd motion = -tangent.solved(change_of_accelerations(by, j, rest->q, values, rest->contact, tangent.by_q));
    slopes[j] = by_q.dot(motion) + by.of_switch(j, [&](const Switch& s, double) { return capacitance_at(s, drive, rest->q); });
  }
  return slopes;
}

double open_capacitance_by_voltage(const Switch& model, std::size_t drive, std::size_t moved, std::span<const double> values) {
  const std::optional<Rest> rest = rest_under(model, values);
  if (!rest) return no_slope;
  const Tangent tangent(model, rest->q, values, rest->contact);
  const VectorXd by_q = 2 * tangent.by_strength.col(static_cast<Eigen::Index>(drive));
  return by_q.dot(motion_by_voltage(model, tangent, moved, values[moved]));
}

}  // namespace softland
