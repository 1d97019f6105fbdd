#include <algorithm>
#include <utility>

#include "base/decompositions.h"
#include "model/switch.h"

namespace softland {

std::vector<double> Switch::share_of(double share, std::span<const double> values) const {
  std::vector<double> part(values.begin(), values.end());
  for (std::size_t k = 0; k < part.size(); ++k)
    part[k] = drive_kind(k) == DriveKind::piezo ? share * values[k] : value_of_strength(k, share * strength(k, values[k]));
  return part;
}

std::optional<Eigen::VectorXd> Switch::open_equilibrium(std::span<const double> values) const {
  if (std::all_of(values.begin(), values.end(), [](double value) { return value == 0; })) return rest_;
  return loaded_equilibrium(values);
}

// Finds the open equilibrium with one run of Newton's method if possible, otherwise with a run for each increment of the load.
// Increments are necessary because a bent beam that stretches is far stiffer than the straight beam, from which Newton's first
// step extrapolates.
std::optional<Eigen::VectorXd> Switch::loaded_equilibrium(std::span<const double> values) const {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(modes());
  if (std::optional<Eigen::VectorXd> found = equilibrium_from(q, values)) return found;
  constexpr double shortest = 1e-3;
  double step = 0.25;
  for (double share = 0; share < 1 && step > shortest;) {
    const double next = std::min(1.0, share + step);
    if (std::optional<Eigen::VectorXd> found = equilibrium_from(q, share_of(next, values))) {
      q = std::move(*found);
      share = next;
    } else {
      step /= 2;
    }
  }
  return step > shortest ? std::optional(q) : std::nullopt;
}

// Finds the open equilibrium by Newton's method from the modal coordinates q. The load grows ever faster as the gap closes, so
// Newton's steps fall short, unless stretching dominates: every iterate deflects less than the equilibrium. If the tangent
// stiffness at an iterate is not positive definite, no stable equilibrium exists.
std::optional<Eigen::VectorXd> Switch::equilibrium_from(Eigen::VectorXd q, std::span<const double> values) const {
  constexpr int most_iterations = 200;  // near the pull-in voltage an iteration halves the distance to the equilibrium at best
  constexpr double rounding = 1e-14;    // change of the deflection that counts as rounding, as a share of the gap
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(modes());
  Workspace work = workspace();
  Eigen::VectorXd force(modes());
  Eigen::MatrixXd by_q(modes(), modes()), by_v(modes(), modes());
  for (int i = 0; i < most_iterations; ++i) {
    accelerations(q.data(), zero.data(), values, false, work, force.data());
    jacobian(q.data(), zero.data(), values, false, work, by_q, by_v);
    if (!(smallest_gap(work) > gap_floor())) return std::nullopt;
    // Each equation is divided by its mode's stiffness: the stiffnesses differ by decades.
    const std::optional<Eigen::VectorXd> moved =
        solve_definite(-(basis_.angular_frequencies().cwiseInverse().asDiagonal() * by_q *
                         basis_.angular_frequencies().cwiseInverse().asDiagonal()),
                       force.cwiseQuotient(basis_.angular_frequencies()));
    if (!moved) return std::nullopt;
    const Eigen::VectorXd step = moved->cwiseQuotient(basis_.angular_frequencies());
    q += step;
    if (step.cwiseProduct(basis_.contact_shape()).cwiseAbs().sum() < rounding * device_.gap.electrode) {
      return contact_deflection(q.data()) < contact_gap_ ? std::optional(q) : std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace softland
