#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <optional>

#include "integrators/roots.h"
#include "model/equilibrium_branch.h"
#include "model/pull_in.h"

namespace softland {

using namespace statics;

namespace {

// Returns the stiffness matrix: minus the derivative of the static modal forces by the modal coordinates. It is symmetric up to
// rounding, since contact and electric fields have potentials.
Eigen::MatrixXd stiffness_at(const Switch& model, const Eigen::VectorXd& q, std::span<const double> volts,
                             const ContactState& contact) {
  const Eigen::Index n = model.modes();
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd by_q(n, n), by_v(n, n), force(n, 1);
  Switch::Workspace work = model.workspace();
  // Call accelerations() for the gap field in `work`, which jacobian() needs.
  model.accelerations(q.data(), still.data(), volts, contact, work, force.data());
  model.jacobian(q.data(), still.data(), volts, contact, work, by_q, by_v);
  return -(by_q + by_q.transpose()) / 2;
}

double smallest_closed_eigenvalue(const Switch& model, const Eigen::VectorXd& q, std::span<const double> volts) {
  const bool is_rigid = model.rigid_contact() != nullptr;
  Eigen::MatrixXd stiffness = stiffness_at(model, q, volts, !is_rigid);
  if (is_rigid) {
    if (model.modes() == 1) return std::numeric_limits<double>::infinity();
    const Eigen::MatrixXd free = orthogonal_complement(model.basis().contact_shape());
    stiffness = (free.transpose() * stiffness * free).eval();
  }
  return symmetric_eigen(stiffness).values[0];
}

}  // namespace

Eigen::VectorXd static_force(const Switch& model, const Eigen::VectorXd& q, std::span<const double> volts) {
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(model.modes());
  Eigen::VectorXd force(model.modes());
  Switch::Workspace work = model.workspace();
  model.accelerations(q.data(), still.data(), volts, false, work, force.data());
  return force;
}

double open_tangent_eigenvalue(const Switch& model, const Eigen::VectorXd& q, std::span<const double> volts) {
  return symmetric_eigen(stiffness_at(model, q, volts, false)).values[0];
}

bool judges_stability(const Switch& model) { return model.modes() > 1 || !model.device().structure.has_far_clamp(); }

bool keeps_closed(const Switch& model, const std::optional<ClosedEquilibrium>& closed) {
  return closed && (closed->smallest_eigenvalue > 0 || !judges_stability(model));
}

namespace {

ClosedEquilibrium closed_at(const Switch& model, const Eigen::VectorXd& q, double contact_force, std::span<const double> volts) {
  Switch::Workspace work = model.workspace();
  return {.q = q,
          .contact_force = contact_force,
          .potential = model.potential(q.data(), volts, true, work),
          .smallest_eigenvalue = smallest_closed_eigenvalue(model, q, volts)};
}

// Searches deeper from `depth` for the first depth at which f rises to zero, and returns the depths of the steps around it.
// Just before a beam collapses onto the electrode f may rise above zero and fall again within one step: where f has a maximum,
// the maximum is computed and compared with zero.
template <class F>
std::optional<Steps> first_enough(F&& f, double depth, double step) {
  auto turn = walk(f, depth, step, [](double value, double here) { return here >= 0 || here < value; });
  if (!turn || f(turn->next) >= 0) return turn;
  const auto [at, value] =
      boost::math::tools::brent_find_minima([&](double x) { return -f(x * step); }, turn->before / step, turn->next / step, 40);
  if (-value >= 0) return Steps{.before = turn->before, .last = turn->before, .next = at * step};
  return walk(f, turn->next, step, [](double, double here) { return here >= 0; });
}

double static_push(const Switch& model, const Eigen::VectorXd& q) {
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(model.modes());
  return model.contact_push(q.data(), still.data(), true);
}

// Finds how a beam rests on the face of a dielectric: on the spot of first touch, or with most of its length. Newton's method
// minimises the potential from `q`, with steps downhill along every eigenvector of the stiffness. A step changes no electrical
// gap (air gap plus equivalent depth of the dielectric) by more than a share of it, the trust radius. So the search does not
// jump over the maximum of the potential that a beam passes before it reaches the face.
std::optional<ClosedEquilibrium> closed_on_face(const Switch& model, std::span<const double> volts, Eigen::VectorXd q) {
  constexpr int most_steps = 1000;
  constexpr double longest = 0.05, shortest = 1e-9;  // largest trust radius, and the radius at which the search ends
  constexpr double least_gap = 0.25;  // electrical gaps count as at least this share of the dielectric's equivalent depth
  constexpr double rounding = 1e-12;  // relative change of the potential energy that counts as rounding
  // Least eigenvalue of the stiffness, relative to the modes alone, that Newton's step uses. Share of the trust radius below
  // which a step shows, at a negative eigenvalue, that the forces vanish: the state is a saddle.
  constexpr double least_stiffness = 1e-9, at_saddle = 1e-2;
  Statics statics(model);
  Switch::Workspace work = model.workspace();
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(model.modes());
  const Eigen::VectorXd compliance = model.basis().angular_frequencies().cwiseInverse();
  const double depth = model.device().dielectric_depth();
  // A contact at a single point is active only while the beam touches it; a contact along a pad or a face always is.
  const auto contact_at = [&](const Eigen::VectorXd& at) -> ContactState {
    return model.has_spread_contact() || model.contact_deflection(at.data()) > model.contact_gap() - model.contact_reach();
  };
  Eigen::VectorXd force(model.modes());
  double radius = longest, energy = model.potential(q.data(), volts, contact_at(q), work);
  for (int k = 0; k < most_steps && radius > shortest; ++k) {
    const SymmetricEigen along =
        symmetric_eigen(compliance.asDiagonal() * stiffness_at(model, q, volts, contact_at(q)) * compliance.asDiagonal());
    model.accelerations(q.data(), still.data(), volts, contact_at(q), work, force.data());
    const auto reach_of = [&](const Eigen::VectorXd& step) {
      const Eigen::ArrayXd gaps = (work.field.gap + depth).max(least_gap * depth);
      return ((model.quadrature().shapes() * step).array() / gaps).abs().maxCoeff();
    };
    const Eigen::VectorXd parts = (along.vectors.transpose() * force.cwiseProduct(compliance))
                                      .cwiseQuotient(along.values.cwiseAbs().cwiseMax(least_stiffness));
    Eigen::VectorXd step = (along.vectors * parts).cwiseProduct(compliance);
    double reach = reach_of(step);
    if (along.values[0] < 0 && reach < at_saddle * radius) {  // saddle: step along the eigenvector of the negative eigenvalue
      step = along.vectors.col(0).cwiseProduct(compliance);
      step *= radius / reach_of(step);
      reach = radius;
    } else if (reach > radius) {
      step *= radius / reach;
    }
    const Eigen::VectorXd beyond = q + step;
    const double next = model.potential(beyond.data(), volts, contact_at(beyond), work);
    if (!(next < energy)) {
      radius = std::min(radius, reach) / 4;
      continue;
    }
    q = beyond;
    const double gained = energy - next;
    energy = next;
    if (reach < radius && gained < rounding * model.bending_energy() && along.values[0] > 0) break;
    radius = std::min(2 * radius, longest);
  }
  if (!contact_at(q).active) return std::nullopt;
  // Improve q by Newton's method for the equilibrium. When the edge of the touching part of the beam is at a quadrature point,
  // the method may oscillate; q then stays as it is.
  if (const auto found = statics.closed(volts, q)) q = *found;
  const double push = static_push(model, q);
  if (!(push > 0)) return std::nullopt;
  const ClosedEquilibrium found = closed_at(model, q, push, volts);
  return found.smallest_eigenvalue > 0 ? std::optional(found) : std::nullopt;
}

// Finds the closed equilibrium of a switch whose beam may rest on a dielectric's face. The search begins in the state in which
// a force at the first contact holds the beam on the plane of this contact. If the face is not the first contact, and this
// search fails, a second one begins with the beam held on the face: from there the beam may move to the first contact.
std::optional<ClosedEquilibrium> closed_on_face(const Switch& model, std::span<const double> volts) {
  const Eigen::VectorXd squares = model.basis().angular_frequencies().cwiseAbs2();
  const auto held_at = [&](std::size_t c) {
    const Eigen::VectorXd pushed = model.contact_shape(c).cwiseQuotient(squares);
    return Eigen::VectorXd(pushed * (model.contact_gap(c) / model.contact_shape(c).dot(pushed)));
  };
  const std::size_t face = *model.device().face_contact();
  std::optional<ClosedEquilibrium> found = closed_on_face(model, volts, held_at(0));
  return found || face == 0 ? found : closed_on_face(model, volts, held_at(face));
}

}  // namespace

std::optional<ClosedEquilibrium> closed_equilibrium(const Switch& model, std::span<const double> volts) {
  if (!model.has_contact()) return std::nullopt;
  if (model.device().closes_along_face()) return closed_on_face(model, volts);
  Statics statics(model);
  const double plane = model.contact_gap(), step = model.penetration_scale() / 16;
  if (model.rigid_contact() != nullptr) {
    const auto held = statics.pinned(volts, plane);
    if (!held || !(held->unknown > 0)) return std::nullopt;
    return closed_at(model, held->q, held->unknown, volts);
  }
  // Returns the contact force at a depth beyond the contact plane, less the force with which the beam presses on the contact.
  const auto excess = [&](double depth) {
    const auto held = statics.pinned(volts, plane + depth);
    if (!held) return no_equilibrium;
    return (model.has_spread_contact() ? 0 : contact_force(model.contact(), depth)) - held->unknown;
  };
  // The closed equilibrium exists only if, at some depth, the beam presses harder than the contact pushes back: at the minimum
  // of excess(). The equilibrium is deeper, where both forces are equal.
  const auto hardest = first_minimum(excess, step);
  if (!hardest || !(hardest->value < 0)) return std::nullopt;
  const std::optional<Steps> over = first_enough(excess, hardest->depth, step);
  if (!over) return std::nullopt;
  const double depth = bracketed_zero(excess, over->last, over->next);
  const auto held = statics.pinned(volts, plane + depth);
  if (!held) return std::nullopt;
  return closed_at(model, held->q, static_push(model, held->q), volts);
}

std::optional<ClosedEquilibrium> statics::closed_by_newton(const Switch& model, std::span<const double> volts,
                                                           const ClosedEquilibrium& near) {
  Statics statics(model);
  const double plane = model.contact_gap();
  std::optional<ClosedEquilibrium> found;
  if (model.rigid_contact() != nullptr) {
    const auto held = statics.pinned(volts, plane, {.q = near.q, .unknown = near.contact_force});
    if (held) found = closed_at(model, held->q, held->unknown, volts);
  } else if (const auto q = statics.closed(volts, near.q); q && model.contact_deflection(q->data()) > plane) {
    found = closed_at(model, *q, static_push(model, *q), volts);
  }
  const bool is_one = found && found->contact_force > 0 && keeps_closed(model, found);
  return is_one ? found : std::nullopt;
}

std::optional<ClosedEquilibrium> closed_equilibrium_near(const Switch& model, std::span<const double> volts,
                                                         const ClosedEquilibrium& near) {
  std::optional<ClosedEquilibrium> found = closed_by_newton(model, volts, near);
  return found ? found : closed_equilibrium(model, volts);
}

}  // namespace softland
