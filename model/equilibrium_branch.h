// Static equilibria of a switch whose contact point is held at a given deflection: the branch of equilibria from rest to the
// contact plane and beyond, past the fold at pull-in. See model/pull_in.h.
#pragma once

#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/decompositions.h"
#include "base/require.h"
#include "model/contact/contact_law.h"
#include "model/pull_in.h"

namespace softland::statics {

inline constexpr double no_equilibrium = std::numeric_limits<double>::quiet_NaN();

// A static equilibrium with the contact point held at a given deflection. `unknown` is what holds the contact point: the
// strength of a drive (V^2 of an electrode, the factor of the dispersion force), or the force of a rigid support at this point
// [N].
struct Held {
  Eigen::VectorXd q;
  double unknown = 0;
};

class Statics {
 public:
  explicit Statics(const Switch& model)
      : model_(model),
        work_(model.workspace()),
        rest_(Eigen::VectorXd::Zero(model.modes())),
        squares_(model.basis().angular_frequencies().cwiseAbs2()) {}

  // Returns the modal coordinates of the beam under a force at the contact point that deflects this point by s [m].
  [[nodiscard]] Eigen::VectorXd pushed(double s) const {
    const Eigen::VectorXd shape = model_.basis().contact_shape().cwiseQuotient(squares_);
    return shape * (s / model_.basis().contact_shape().dot(shape));
  }

  // Finds the equilibrium in which `drive` holds the contact point at deflection s [m] against the contact force, with the
  // other drives at `bias`.
  std::optional<Held> on_branch(std::size_t drive, std::span<const double> bias, double s, Held start) {
    // Compute the force of the drive at unit strength as a difference of static forces: at strength `scale`, near the result,
    // less that at strength 0, over `scale`. At a small `scale` rounding of the other forces would dominate the difference.
    const double scale = start.unknown > 0 ? start.unknown : 1;
    std::vector<double> some(bias.begin(), bias.end()), none = some;
    some[drive] = model_.value_of_strength(drive, scale);
    none[drive] = model_.value_of_strength(drive, 0);
    const Eigen::VectorXd& shape = model_.basis().contact_shape();
    const double d = s - model_.contact_gap();
    const bool acts = model_.has_contact() && !model_.has_spread_contact() && d > -model_.contact_reach();
    const double push = acts ? contact_force(model_.contact(), d) : 0;
    Eigen::VectorXd others;
    Eigen::MatrixXd others_by_q;
    return newton(s, std::move(start),
                  [&](const Held& h, Eigen::VectorXd& residual, Eigen::MatrixXd& by_q, Eigen::VectorXd& by_unknown) {
                    evaluate(h.q, none, others, others_by_q);
                    evaluate(h.q, some, by_unknown, by_q);
                    by_unknown = (by_unknown - others) / scale;
                    by_q = others_by_q + h.unknown / scale * (by_q - others_by_q);
                    residual = others + h.unknown * by_unknown - push * shape;
                  });
  }

  // Finds the equilibrium in which a support keeps the contact point at deflection s [m] under constant voltages. `unknown` is
  // the force of the beam on the support; a contact along the pad carries its own force in addition.
  std::optional<Held> pinned(std::span<const double> volts, double s) {
    std::optional<Held> h = Held{.q = pushed(s)};
    std::vector<double> part(volts.begin(), volts.end());
    for (const double load : {0.25, 0.5, 0.75, 1.0}) {
      for (std::size_t k = 0; k < part.size(); ++k) {
        const double neutral = model_.neutral_voltage(k);
        part[k] = neutral + (volts[k] - neutral) * std::sqrt(load);
      }
      h = pinned(part, s, std::move(*h));
      if (!h) break;
    }
    return h;
  }

  // Finds the equilibrium of pinned(volts, s) by Newton's method from a state near this equilibrium.
  std::optional<Held> pinned(std::span<const double> volts, double s, Held near) {
    return newton(s, std::move(near),
                  [&](const Held& at, Eigen::VectorXd& residual, Eigen::MatrixXd& by_q, Eigen::VectorXd& by_unknown) {
                    evaluate(at.q, volts, residual, by_q);
                    residual -= at.unknown * model_.basis().contact_shape();
                    by_unknown = -model_.basis().contact_shape();
                  });
  }

  // Finds an equilibrium of the beam on the contact by Newton's method from a state near this equilibrium.
  std::optional<Eigen::VectorXd> closed(std::span<const double> volts, Eigen::VectorXd near) {
    Eigen::VectorXd force;
    Eigen::MatrixXd by_q;
    for (int i = 0; i < most_iterations; ++i) {
      evaluate(near, volts, true, force, by_q);
      const Eigen::VectorXd step = -solve_linear(squares_.cwiseInverse().asDiagonal() * by_q, force.cwiseQuotient(squares_));
      if (!step.allFinite()) return std::nullopt;
      near += step;
      if (has_converged(step)) return is_above_floor() ? std::optional(std::move(near)) : std::nullopt;
    }
    return std::nullopt;
  }

  double potential(const Eigen::VectorXd& q, std::span<const double> volts) {
    return model_.potential(q.data(), volts, model_.untouched(q.data()), work_);
  }

 private:
  static constexpr int most_iterations = 60;

  // Computes static modal forces and their derivative by the modal coordinates. A contact at a single point is left out: its
  // force at the given deflection is known, or part of `unknown`.
  void evaluate(const Eigen::VectorXd& q, std::span<const double> volts, Eigen::VectorXd& force, Eigen::MatrixXd& by_q) {
    evaluate(q, volts, model_.has_spread_contact(), force, by_q);
  }

  void evaluate(const Eigen::VectorXd& q, std::span<const double> volts, const ContactState& contact, Eigen::VectorXd& force,
                Eigen::MatrixXd& by_q) {
    const auto n = model_.modes();
    force.resize(n);
    by_q.resize(n, n);
    Eigen::MatrixXd by_v(n, n);
    model_.accelerations(q.data(), rest_.data(), volts, contact, work_, force.data());
    model_.jacobian(q.data(), rest_.data(), volts, contact, work_, by_q, by_v);
  }

  template <class Equations>
  std::optional<Held> newton(double s, Held h, Equations&& equations) {
    const Eigen::Index n = model_.modes();
    const Eigen::VectorXd& shape = model_.basis().contact_shape();
    const double largest = shape.cwiseAbs().maxCoeff();
    Eigen::VectorXd residual, by_unknown;
    Eigen::MatrixXd by_q, bordered(n + 1, n + 1);
    Eigen::VectorXd right(n + 1);
    for (int i = 0; i < most_iterations; ++i) {
      equations(h, residual, by_q, by_unknown);
      // Rows of the matrix are in units of each mode's stiffness: in common units the rows span ten decades.
      bordered.topLeftCorner(n, n) = squares_.cwiseInverse().asDiagonal() * by_q;
      bordered.topRightCorner(n, 1) = by_unknown.cwiseQuotient(squares_);
      bordered.bottomLeftCorner(1, n) = shape.transpose() / largest;
      bordered(n, n) = 0;
      right.head(n) = -residual.cwiseQuotient(squares_);
      right[n] = (s - shape.dot(h.q)) / largest;
      const Eigen::VectorXd step = solve_linear(bordered, right);
      if (!step.allFinite()) return std::nullopt;
      h.q += step.head(n);
      h.unknown += step[n];
      if (has_converged(step.head(n))) return is_above_floor() ? std::optional(h) : std::nullopt;
    }
    return std::nullopt;
  }

  [[nodiscard]] bool has_converged(const Eigen::VectorXd& step) const {
    return step.cwiseProduct(model_.basis().contact_shape()).cwiseAbs().sum() < 1e-13 * model_.device().gap.electrode;
  }
  // Returns true when the last evaluated state of the beam is above the smallest valid gap. Below this gap the force laws do
  // not hold, and no equilibrium is accepted.
  [[nodiscard]] bool is_above_floor() const { return Switch::smallest_gap(work_) > model_.gap_floor(); }

  const Switch& model_;
  Switch::Workspace work_;
  Eigen::VectorXd rest_, squares_;
};

// Returns the values of all drives under a bias: the constant voltages of the other drives, and 0 for `drive` itself.
std::vector<double> standing(const Switch& model, std::size_t drive, Bias bias) {
  require(bias.empty() || bias.size() == model.drives(), "a bias needs a value for every drive of the switch");
  std::vector<double> values(bias.begin(), bias.end());
  values.resize(model.drives(), 0.0);
  values[drive] = 0;
  return values;
}

// The strength of one drive on its branch of static equilibria, as a function of the contact point's deflection.
class EquilibriumBranch {
 public:
  EquilibriumBranch(const Switch& model, std::size_t drive, Bias bias)
      : statics_(model), drive_(drive), bias_(standing(model, drive, bias)), goes_in_steps_(model.device().closes_along_face()) {}

  // Returns the strength (Held::unknown) of the drive in the equilibrium at deflection s [m]; NaN without an equilibrium. The
  // search starts from the last equilibrium found, so call this operator in small steps of s.
  double operator()(double s) {
    if (start_.q.size() == 0) start_ = {.q = statics_.pushed(s)};
    if (!reaches(s) && !(goes_in_steps_ && walks(s))) return no_equilibrium;
    return start_.unknown;
  }
  [[nodiscard]] const Eigen::VectorXd& q() const { return start_.q; }

 private:
  bool reaches(double s) {
    auto found = statics_.on_branch(drive_, bias_, s, start_);
    if (!found) found = statics_.on_branch(drive_, bias_, s, {.q = statics_.pushed(s), .unknown = start_.unknown});
    if (!found) return false;
    start_ = *found;
    here_ = s;
    return true;
  }

  // Finds the equilibrium at deflection s [m] in shorter steps of the deflection, from the last equilibrium found. Near the
  // face of a thin dielectric the field grows so fast that Newton's method fails for long steps.
  bool walks(double s) {
    constexpr int most_steps = 100;
    constexpr double shortest = 1e-6;  // shortest step of the deflection, as a share of the distance to s
    const double least = shortest * std::abs(s - here_);
    double step = (s - here_) / 2;
    for (int k = 0; k < most_steps && std::abs(step) > least; ++k) {
      const bool is_last = std::abs(s - here_) <= std::abs(step);
      if (!reaches(is_last ? s : here_ + step)) {
        step = (is_last ? s - here_ : step) / 2;
      } else if (is_last) {
        return true;
      } else {
        step *= 1.5;
      }
    }
    return false;
  }

  Statics statics_;
  std::size_t drive_;
  std::vector<double> bias_;
  bool goes_in_steps_;
  Held start_;
  double here_ = 0;  // deflection of the contact point in the last equilibrium found [m]
};

inline constexpr int branch_steps = 64;

// The last three of the depths beyond the contact plane that a search has tried [m]: the search stopped because of the values
// at `last` and `next`. `before` equals `last` if it stopped at its first step.
struct Steps {
  double before, last, next;
};

// Evaluates f at `depth` and deeper, in growing steps, until stop(f at a depth, f one step deeper) is true. Halves the step
// where f becomes NaN (the beam would reach the electrode); returns nothing when the step becomes too short.
template <class F, class Stop>
std::optional<Steps> walk(F&& f, double depth, double step, Stop&& stop) {
  constexpr double growth = 1.2;
  constexpr int most_halvings = 20;
  double before = depth, value = f(depth);
  for (int halvings = 0; std::isfinite(value) && halvings < most_halvings;) {
    const double here = f(depth + step);
    if (!std::isfinite(here)) {
      step /= 2;
      ++halvings;
    } else if (stop(value, here)) {
      return Steps{.before = before, .last = depth, .next = depth + step};
    } else {
      before = depth;
      depth += step;
      value = here;
      step *= growth;
    }
  }
  return std::nullopt;
}

struct Minimum {
  double depth, value;
};

// Returns the first local minimum of f over the depth beyond the contact plane; the plane itself if f rises from there.
template <class F>
std::optional<Minimum> first_minimum(F&& f, double step) {
  const auto around = walk(f, 0, step, [](double value, double here) { return here > value; });
  if (!around) return std::nullopt;
  // Depths are in units of the step, because the tolerance of Brent's method is partly absolute.
  const auto [at, value] = boost::math::tools::brent_find_minima([&](double x) { return f(x * step); }, around->before / step,
                                                                 around->next / step, 30);
  const double known = f(around->last);
  return value < known ? Minimum{at * step, value} : Minimum{around->last, known};
}

/// Finds the closed equilibrium by Newton's method from the closed equilibrium at slightly different voltages, if the method
/// ends on a stable equilibrium.
std::optional<ClosedEquilibrium> closed_by_newton(const Switch& model, std::span<const double> volts,
                                                  const ClosedEquilibrium& near);

}  // namespace softland::statics
