#include "model/pull_in.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "base/decompositions.h"
#include "base/require.h"
#include "integrators/roots.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/contact/contact_law.h"

namespace softland {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A static equilibrium with the contact point held at a given deflection. `unknown` is the strength of what holds it: that of
// the drive (V^2 of an electrode, the factor of the dispersion force), or the reaction of a holder [N].
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

  // Returns the shape of the beam under a force at the contact point, scaled to the deflection s of this point.
  [[nodiscard]] Eigen::VectorXd pushed(double s) const {
    const Eigen::VectorXd shape = model_.basis().contact_shape().cwiseQuotient(squares_);
    return shape * (s / model_.basis().contact_shape().dot(shape));
  }

  // Finds the equilibrium in which `drive` holds the contact point at s against the contact force P(s - dt), with the other
  // drives at `bias`.
  std::optional<Held> on_branch(std::size_t drive, std::span<const double> bias, double s, Held start) {
    // The force at unit strength is a difference of two evaluations, near the strength sought, where the other forces do not
    // dominate it.
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

  // Finds the equilibrium in which a holder keeps the contact point at s under constant voltages. `unknown` is the force of the
  // beam on the holder, beyond what a contact along the pad carries.
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

  // Finds the equilibrium with a holder from a state near it.
  std::optional<Held> pinned(std::span<const double> volts, double s, Held near) {
    return newton(s, std::move(near),
                  [&](const Held& at, Eigen::VectorXd& residual, Eigen::MatrixXd& by_q, Eigen::VectorXd& by_unknown) {
                    evaluate(at.q, volts, residual, by_q);
                    residual -= at.unknown * model_.basis().contact_shape();
                    by_unknown = -model_.basis().contact_shape();
                  });
  }

  // Finds an equilibrium on the contact from a state near it.
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

  // Computes static modal forces and their derivative, without a contact that acts at the held point.
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
      // Rows are in units of each mode's own stiffness: unscaled they span ten decades.
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
  // Returns true when the state evaluated last is above the floor. Below the floor the laws do not hold, and there is no
  // equilibrium.
  [[nodiscard]] bool is_above_floor() const { return Switch::smallest_gap(work_) > model_.gap_floor(); }

  const Switch& model_;
  Switch::Workspace work_;
  Eigen::VectorXd rest_, squares_;
};

// Returns the values of the drives at a bias, with `drive` itself at 0.
std::vector<double> standing(const Switch& model, std::size_t drive, Bias bias) {
  require(bias.empty() || bias.size() == model.drives(), "a bias needs a value for every drive of the switch");
  std::vector<double> values(bias.begin(), bias.end());
  values.resize(model.drives(), 0.0);
  values[drive] = 0;
  return values;
}

// The static branch of one drive as a function of the contact point's deflection.
class EquilibriumBranch {
 public:
  EquilibriumBranch(const Switch& model, std::size_t drive, Bias bias)
      : statics_(model), drive_(drive), bias_(standing(model, drive, bias)), goes_in_steps_(model.device().lands_along_face()) {}

  // Returns the strength at deflection s; NaN without an equilibrium. The search starts from the last equilibrium found, so
  // call this in small steps.
  double operator()(double s) {
    if (start_.q.size() == 0) start_ = {.q = statics_.pushed(s)};
    if (!reaches(s) && !(goes_in_steps_ && walks(s))) return nan;
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

  // Finds the equilibrium at s in short steps: near the face of a thin dielectric the field grows so fast that Newton's method
  // needs them.
  bool walks(double s) {
    constexpr int most_steps = 100;
    constexpr double shortest = 1e-6;  // share of the way
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
  double here_ = 0;  // deflection of the last equilibrium found [m]
};

constexpr int branch_steps = 64;

// Three depths beyond the contact plane, one step apart [m]; at the start of a walk `before` and `last` are the same.
struct Steps {
  double before, last, next;
};

// Walks from `depth` deeper in growing steps until stop(f at a depth, f one step deeper). The steps are halved where f ends
// (NaN: the beam would reach the electrode); the walk returns nothing when it reaches this end.
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

// Returns the first local minimum of f over the depth beyond the contact plane, at the plane if f rises from there.
template <class F>
std::optional<Minimum> first_minimum(F&& f, double step) {
  const auto around = walk(f, 0, step, [](double value, double here) { return here > value; });
  if (!around) return std::nullopt;
  // Depths are in units of the step, because Brent's tolerance is partly absolute.
  const auto [at, value] = boost::math::tools::brent_find_minima([&](double x) { return f(x * step); }, around->before / step,
                                                                 around->next / step, 30);
  const double known = f(around->last);
  return value < known ? Minimum{at * step, value} : Minimum{around->last, known};
}

// Simulations of constant steps of one drive, from rest.
class StepTrial {
 public:
  StepTrial(const Switch& model, std::size_t drive, const StaticPullIn& static_result, Bias bias, double tolerance)
      : model_(model),
        drive_(drive),
        bias_(standing(model, drive, bias)),
        rest_(model.open_equilibrium(bias_)),
        static_(static_result),
        tolerance_(tolerance),
        statics_(model),
        branch_(model, drive, bias),
        work_(model.workspace()) {}

  [[nodiscard]] bool has_rest() const { return rest_.has_value(); }
  // Returns true when a step reaches the contact plane. Calls tell(part) from time to time with the elapsed share of the time.
  template <class Tell>
  bool reaches(double value, const std::atomic<bool>* stop, Tell&& tell) {
    std::vector<double> all = bias_;
    all[drive_] = value;
    const Pass barrier = pass(value, all);
    if (model_.potential(rest_->data(), all, false, work_) < barrier.potential) return false;
    std::vector<Signal> signals;
    for (const double standing : bias_) signals.push_back(Signal::standing(standing));
    signals[drive_] = Signal::constant(value);
    ClosingOptions options{.duration = 100 * 2 * pi / model_.basis().angular_frequencies()[0],
                           .tolerance = tolerance_,
                           .after_contact = 0,
                           .stop = stop};
    int step = 0;
    options.observer = [&](double time, const double* q, const double* v) {
      if (++step % 8 != 0) return false;  // a more frequent check costs more than it saves
      tell(time / options.duration);
      return model_.contact_deflection(q) < barrier.deflection && model_.basis().kinetic_energy(v) +
                                                                          model_.potential(q, all, model_.untouched(q), work_) +
                                                                          model_.film_energy(q, work_) <
                                                                      barrier.potential;
    };
    return !simulate_closing(model_, signals, options).touches.empty();
  }

 private:
  struct Pass {
    double deflection, potential;
  };

  // Friction only takes energy. So a run that has not crossed the pass between rest and contact plane, and whose energy falls
  // below that of the pass, never reaches the plane. The pass is the unstable equilibrium, or the state held at the plane if
  // that comes first. No shape with the contact point on the pass has less energy, so the deflection of the pass separates the
  // two sides.
  Pass pass(double value, std::span<const double> all) {
    const double plane = model_.contact_gap(), strength = model_.strength(drive_, value);
    if (static_.kind == StaticKind::fold && branch_(plane) < strength) {
      const double s = bracketed_zero([&](double x) { return branch_(x) - strength; }, static_.deflection, plane);
      branch_(s);
      return {s, statics_.potential(branch_.q(), all)};
    }
    const auto held = statics_.pinned(all, plane);
    return {plane, held ? statics_.potential(held->q, all) : nan};
  }

  const Switch& model_;
  std::size_t drive_;
  std::vector<double> bias_;
  std::optional<Eigen::VectorXd> rest_;
  const StaticPullIn& static_;
  double tolerance_;
  Statics statics_;
  EquilibriumBranch branch_;
  Switch::Workspace work_;
};

}  // namespace

bool pulls_in(const Device& device, std::size_t drive) {
  return drive >= device.electrodes.size() || device.electrodes[drive].side != Side::far;
}

std::string_view to_string(StaticKind kind) { return kind == StaticKind::fold ? "fold" : "contact"; }

StaticPullIn static_pull_in(const Switch& model, std::size_t drive, Bias bias) {
  if (!pulls_in(model.device(), drive)) return {.status = Status::no_contact};
  // The branch of an electrode begins at the switch's rest without its field, the branch of the dispersion force at factor 0.
  std::vector<double> at_begin = standing(model, drive, bias);
  if (model.neutral_voltage(drive) != 0 && !model.open_equilibrium(at_begin)) return {.status = Status::collapsed_at_rest};
  at_begin[drive] = model.value_of_strength(drive, 0);
  const std::optional<Eigen::VectorXd> rest = model.open_equilibrium(at_begin);
  if (!rest) return {.status = Status::collapsed_at_rest};
  EquilibriumBranch branch(model, drive, bias);
  const double end = model.contact_gap();
  const double begin = model.contact_deflection(rest->data());
  const auto place = [&](double k) { return begin + (end - begin) * k / branch_steps; };
  double best = 0;
  for (int k = 1; k <= branch_steps; ++k) {
    const double s = place(k), strength = branch(s);
    if (!std::isfinite(strength)) return {.status = Status::numerical_failure};
    if (strength <= best) {
      // The deflection is in units of the gap, because Brent's tolerance is partly absolute. The maximum is flat, so that the
      // tolerance of the deflection is far tighter than the voltage needs.
      const auto [at, value] = boost::math::tools::brent_find_minima([&](double x) { return -branch(x * end); },
                                                                     std::max(1e-6, place(k - 2) / end), s / end, 30);
      // A drive that pulls away from the contact has no pull-in: the strength falls along its branch from the start.
      if (!(-value > 0)) return {.status = Status::no_contact};
      return {.status = Status::done,
              .voltage = model.value_of_strength(drive, -value),
              .deflection = at * end,
              .kind = StaticKind::fold};
    }
    best = strength;
  }
  return {
      .status = Status::done, .voltage = model.value_of_strength(drive, best), .deflection = end, .kind = StaticKind::contact};
}

namespace {

// Computes the branch from the straight beam up to the contact plane, in small steps.
void follow_to_plane(EquilibriumBranch& branch, double plane) {
  for (int k = 1; k < branch_steps; ++k) branch(plane * k / branch_steps);
}

ReleasePoint released_at(const Switch& model, std::size_t drive, double square, double deflection) {
  if (!std::isfinite(square)) return {};
  return {.voltage = square > 0 ? model.neutral_voltage(drive) + std::sqrt(square) : 0, .deflection = deflection};
}

}  // namespace

std::optional<HeldEquilibrium> held_by_drive(const Switch& model, std::size_t drive, double deflection, Bias bias) {
  EquilibriumBranch branch(model, drive, bias);
  const double plane = model.contact_gap();
  double last = nan;
  const auto follow = [&](double from, double to) {
    for (int k = 1; k <= branch_steps; ++k) last = branch(from + (to - from) * k / branch_steps);
  };
  follow(0, std::min(deflection, plane));
  if (deflection > plane) follow(plane, deflection);
  if (!(last > 0)) return std::nullopt;
  return HeldEquilibrium{.q = branch.q(), .voltage = model.value_of_strength(drive, last)};
}

ReleasePoint release_point(const Switch& model, std::size_t drive, Bias bias) {
  if (!model.has_contact() || !pulls_in(model.device(), drive)) return {};
  EquilibriumBranch branch(model, drive, bias);
  const double plane = model.contact_gap();
  const auto released = [&](double square, double deflection) { return released_at(model, drive, square, deflection); };
  follow_to_plane(branch, plane);
  if (model.rigid_contact() != nullptr) return released(branch(plane), plane);
  if (model.contact_reach() > 0) {
    // Adhesion at larger depth may make a lower minimum than the first.
    constexpr int looks = 256;
    const double step = largest_interference(model.device().contacts.front().model) / looks;
    double best = branch(plane), at = 0;
    for (int k = 1; k < looks; ++k) {
      const double value = branch(plane + k * step);
      if (value < best) best = value, at = k * step;
    }
    // Depths are in units of the step, because Brent's tolerance is partly absolute.
    const double low = std::max(0.0, at / step - 1);
    const auto [depth, value] =
        boost::math::tools::brent_find_minima([&](double x) { return branch(plane + x * step); }, low, at / step + 1, 30);
    return value < best ? released(value, plane + depth * step) : released(best, plane + at);
  }
  // The contact is soft at first touch, so the branch may continue to fall beyond the plane before contact turns it up.
  const auto lowest = first_minimum([&](double depth) { return branch(plane + depth); }, model.penetration_scale() / 16);
  return lowest ? released(lowest->value, plane + lowest->depth) : ReleasePoint{};
}

double release_voltage(const Switch& model, std::size_t drive, Bias bias) { return release_point(model, drive, bias).voltage; }

namespace {

// Returns the stiffness of the static forces by the modes: symmetric up to rounding, since contact and fields have potentials.
Eigen::MatrixXd stiffness_at(const Switch& model, const Eigen::VectorXd& q, std::span<const double> volts,
                             const ContactState& contact) {
  const Eigen::Index n = model.modes();
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd by_q(n, n), by_v(n, n), force(n, 1);
  Switch::Workspace work = model.workspace();
  model.accelerations(q.data(), still.data(), volts, contact, work, force.data());  // sets the field
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

std::optional<StablePath> stable_path(const Switch& model, std::size_t drive, Bias bias) {
  constexpr int steps = 32;
  std::vector<double> values = standing(model, drive, bias);
  const std::optional<Eigen::VectorXd> rest = model.open_equilibrium(values);
  if (!rest) return std::nullopt;
  EquilibriumBranch branch(model, drive, bias);
  const double begin = model.contact_deflection(rest->data()), end = model.contact_gap();
  StablePath path{.deflections = {begin}, .values = {0.0}};
  double direction = 0;  // direction in which the value moves
  for (int k = 1; k <= steps; ++k) {
    const double s = begin + (end - begin) * k / steps, strength = branch(s);
    if (!std::isfinite(strength) || (model.drive_kind(drive) == DriveKind::electrode && !(strength > 0))) return std::nullopt;
    const double value = model.value_of_strength(drive, strength);
    if (k == 1) direction = value;
    if (!((value - path.values.back()) * direction > 0)) return std::nullopt;  // a fold
    values[drive] = value;
    if (!(open_tangent_eigenvalue(model, branch.q(), values) > 0)) return std::nullopt;
    path.deflections.push_back(s);
    path.values.push_back(value);
  }
  return path;
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

// Returns the depths between which f first rises to zero from below. Just before a beam collapses onto the electrode f does so
// between two steps, and falls again.
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

// Finds how a beam rests on the face of a dielectric: on its first spot, or with most of its length. Newton's method descends
// the potential from `q`, downhill along every eigenvector. A step shortens no gap of the field by more than a share, so that
// it does not jump over the maximum of the potential before a soft face.
std::optional<ClosedEquilibrium> closed_on_face(const Switch& model, std::span<const double> volts, Eigen::VectorXd q) {
  constexpr int most_steps = 1000;
  constexpr double longest = 0.05, shortest = 1e-9;           // steps, in shares of the gaps of the field
  constexpr double least_gap = 0.25;                          // share of the depth of the dielectric
  constexpr double rounding = 1e-12;                          // share of the bending energy
  constexpr double least_stiffness = 1e-9, at_saddle = 1e-2;  // shares of the stiffness of a mode, and of the longest step
  Statics statics(model);
  Switch::Workspace work = model.workspace();
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(model.modes());
  const Eigen::VectorXd compliance = model.basis().angular_frequencies().cwiseInverse();
  const double depth = model.device().dielectric_depth();
  // A contact at a point exerts no force when the beam does not touch it.
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
    if (along.values[0] < 0 && reach < at_saddle * radius) {  // no force indicates the direction of descent
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
  // Newton's method may oscillate about a point of the quadrature at which the edge of the touching part lies.
  if (const auto found = statics.closed(volts, q)) q = *found;
  const double push = static_push(model, q);
  if (!(push > 0)) return std::nullopt;
  const ClosedEquilibrium found = closed_at(model, q, push, volts);
  return found.smallest_eigenvalue > 0 ? std::optional(found) : std::nullopt;
}

// The search begins where a force holds the beam at the plane of its first contact. It begins on the face when another contact
// closes the switch and the beam moves from the face to that contact.
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
  if (model.device().lands_along_face()) return closed_on_face(model, volts);
  Statics statics(model);
  const double plane = model.contact_gap(), step = model.penetration_scale() / 16;
  if (model.rigid_contact() != nullptr) {
    const auto held = statics.pinned(volts, plane);
    if (!held || !(held->unknown > 0)) return std::nullopt;
    return closed_at(model, held->q, held->unknown, volts);
  }
  // Returns the force of the contact at a depth, less the force with which the beam presses on it.
  const auto excess = [&](double depth) {
    const auto held = statics.pinned(volts, plane + depth);
    if (!held) return nan;
    return (model.has_spread_contact() ? 0 : contact_force(model.contact(), depth)) - held->unknown;
  };
  // The beam must overcome the contact force where the beam presses hardest; the equilibrium lies deeper, where both are equal
  // again.
  const auto hardest = first_minimum(excess, step);
  if (!hardest || !(hardest->value < 0)) return std::nullopt;
  const std::optional<Steps> over = first_enough(excess, hardest->depth, step);
  if (!over) return std::nullopt;
  const double depth = bracketed_zero(excess, over->last, over->next);
  const auto held = statics.pinned(volts, plane + depth);
  if (!held) return std::nullopt;
  return closed_at(model, held->q, static_push(model, held->q), volts);
}

namespace {

// Finds the closed equilibrium by Newton's method from one of slightly different voltages, if this ends on a stable
// equilibrium.
std::optional<ClosedEquilibrium> closed_by_newton(const Switch& model, std::span<const double> volts,
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

}  // namespace

std::optional<ClosedEquilibrium> closed_equilibrium_near(const Switch& model, std::span<const double> volts,
                                                         const ClosedEquilibrium& near) {
  std::optional<ClosedEquilibrium> found = closed_by_newton(model, volts, near);
  return found ? found : closed_equilibrium(model, volts);
}

namespace {

// Step and range of the search for pull_through_voltage(). These functions search for the acting voltage, V - V0 for an
// electrode whose dielectric is charged.
constexpr double pull_through_factor = 1.05, pull_through_range = 10;

// Searches for closed equilibria up or down from `start`, whatever exists at other voltages.
double pull_through_by_walk(const Switch& model, std::size_t drive, std::vector<double> levels, double start, double precision) {
  const auto holds = [&](double v) {
    levels[drive] = model.neutral_voltage(drive) + v;
    return keeps_closed(model, closed_equilibrium(model, levels));
  };
  double low = start, high = start;
  if (holds(start)) {
    do {
      low = high;
      high *= pull_through_factor;
      if (high > pull_through_range * start) return nan;
    } while (holds(high));
  } else {
    do {
      high = low;
      low /= pull_through_factor;
      if (low < start / pull_through_range) return nan;
    } while (!holds(low));
  }
  while (high - low > precision * high) {
    const double middle = low + (high - low) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return high;
}

// Returns the end of a window of voltages with closed equilibria that begins at the release voltage and is narrower than one
// step of the walk above. The steps of the search double from a hundred-thousandth on. Returns NaN when no equilibrium exists
// so near the release voltage.
double pull_through_of_narrow_window(const Switch& model, std::size_t drive, std::vector<double> levels, double release,
                                     double precision) {
  constexpr double first_step = 1e-5;
  const auto holds = [&](double v) {
    levels[drive] = model.neutral_voltage(drive) + v;
    return keeps_closed(model, closed_equilibrium(model, levels));
  };
  double low = nan;
  for (double step = first_step; step < pull_through_factor - 1; step *= 2) {
    const double v = release * (1 + step);
    if (holds(v)) {
      low = v;
    } else if (low > 0) {
      break;
    }
  }
  if (!(low > 0)) return nan;
  double high = std::min(2 * low - release, pull_through_factor * release);
  if (holds(high)) return pull_through_by_walk(model, drive, std::move(levels), high, precision);
  while (high - low > precision * high) {
    const double middle = low + (high - low) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return high;
}

// Searches upwards by Newton's method from a closed equilibrium near that at `start`; returns none where it does not converge.
std::optional<double> pull_through_from(const Switch& model, std::size_t drive, std::vector<double> levels, double start,
                                        const ClosedEquilibrium& near, double precision) {
  std::optional<ClosedEquilibrium> last = near;
  const auto follows = [&](double v) {
    levels[drive] = model.neutral_voltage(drive) + v;
    std::optional<ClosedEquilibrium> next = closed_by_newton(model, levels, *last);
    const bool found = next.has_value();
    if (found) last = std::move(next);
    return found;
  };
  double low = start, high = start;
  if (!follows(start)) return std::nullopt;
  do {
    low = high;
    high *= pull_through_factor;
    if (high > pull_through_range * start) return nan;
  } while (follows(high));
  while (high - low > precision * high) {
    const double middle = low + (high - low) / 2;
    (follows(middle) ? low : high) = middle;
  }
  // Newton's method may have failed although an equilibrium exists.
  levels[drive] = model.neutral_voltage(drive) + high;
  return keeps_closed(model, closed_equilibrium(model, levels)) ? std::nullopt : std::optional(high);
}

double acting_pull_through(const Switch& model, std::size_t drive, std::span<const double> volts, double precision) {
  const double neutral = model.neutral_voltage(drive);
  // No equilibrium keeps the switch closed below its release voltage.
  const double release = release_voltage(model, drive, volts) - neutral, given = std::abs(volts[drive] - neutral);
  const double start = std::fmax(given, pull_through_factor * release);
  if (!(start > 0)) return nan;
  std::vector<double> levels(volts.begin(), volts.end());
  levels[drive] = neutral + start;
  const auto closed = closed_equilibrium(model, levels);
  const auto found =
      keeps_closed(model, closed) ? pull_through_from(model, drive, levels, start, *closed, precision) : std::nullopt;
  if (found) return *found;
  const bool is_above = start > given;  // the given level may still keep the switch closed
  if (is_above && !keeps_closed(model, closed)) {
    const double narrow = pull_through_of_narrow_window(model, drive, levels, release, precision);
    if (std::isfinite(narrow)) return narrow;
  }
  const double walked = pull_through_by_walk(model, drive, levels, start, precision);
  if (std::isfinite(walked) || is_above || !(release > start / pull_through_range)) return walked;
  return pull_through_of_narrow_window(model, drive, std::move(levels), release, precision);
}

// Returns true for a landing on a wall, below whose face the beam does not move.
bool lands_on_wall(const Switch& model, std::size_t drive) {
  const Device& device = model.device();
  if (drive >= device.electrodes.size() || !device.electrodes[drive].dielectric || device.face_contact() != 0) return false;
  return device.landing()->is_wall();
}

}  // namespace

double pull_through_voltage(const Switch& model, std::size_t drive, std::span<const double> volts, double precision) {
  if (lands_on_wall(model, drive)) return nan;
  return model.neutral_voltage(drive) + acting_pull_through(model, drive, volts, precision);
}

double pull_through_voltage_near(const Switch& model, std::size_t drive, std::span<const double> volts,
                                 const ClosedEquilibrium& near, double precision) {
  if (lands_on_wall(model, drive)) return nan;
  const double neutral = model.neutral_voltage(drive);
  const auto found =
      pull_through_from(model, drive, {volts.begin(), volts.end()}, std::abs(volts[drive] - neutral), near, precision);
  return found ? neutral + *found : pull_through_voltage(model, drive, volts, precision);
}

bool step_closes(const Switch& model, std::size_t drive, double value, Bias bias, const Watch& watch, double tolerance) {
  const StaticPullIn statically = static_pull_in(model, drive, bias);
  if (statically.status != Status::done) return statically.status != Status::no_contact;
  if (value >= statically.voltage) return true;
  return StepTrial(model, drive, statically, bias, tolerance).reaches(value, watch.stop, [](double) {});
}

namespace {

// Returns true when damping at rest prevents oscillation of the first mode.
bool is_overdamped(const Switch& model) {
  if (!model.rest()) return false;
  const Eigen::Index n = model.modes();
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(n);
  const std::vector<double> drives(model.drives(), 0.0);
  Eigen::MatrixXd by_q(n, n), by_v(n, n);
  Switch::Workspace work = model.workspace();
  model.jacobian(model.rest()->data(), still.data(), drives, false, work, by_q, by_v);
  return by_v(0, 0) * by_v(0, 0) > -4 * by_q(0, 0);
}

}  // namespace

DynamicPullIn dynamic_pull_in(const Switch& model, std::size_t drive, const StaticPullIn& static_result, Bias bias,
                              const Watch& watch, double tolerance, double precision) {
  if (static_result.status != Status::done) return {.status = static_result.status};
  StepTrial steps(model, drive, static_result, bias, tolerance);
  if (!steps.has_rest()) return {.status = Status::collapsed_at_rest};
  const double halvings = 1 + std::log2(0.5 / precision);  // trials: the first, and those that halve the bracket
  double trials = halvings, done = 0, shown = 0;
  const auto reaches = [&](double value) {
    return steps.reaches(value, watch.stop, [&](double part) {
      // A bracket that has to be extended downwards takes more trials than expected.
      shown = std::max(shown, std::min(1.0, (done + part) / trials));
      watch.tell("dynamic pull-in voltage", shown);
    });
  };

  double low = 0.5 * static_result.voltage, high = static_result.voltage;
  if (is_overdamped(model)) {
    // If no step overshoots because of damping, one trial shows that the static voltage is the smallest.
    trials = 1;
    if (!reaches(high * (1 - precision))) low = high;
    trials = 1 + halvings;
    ++done;
  }
  if (low == high) watch.tell("dynamic pull-in voltage", 1);
  while (low < high && reaches(low)) {
    if (watch.stopped()) break;
    high = low;
    low /= 2;
    if (low < 1e-9 * static_result.voltage) return {.status = Status::numerical_failure};
  }
  ++done;
  while (high - low > precision * high && !watch.stopped()) {
    const double middle = (low + high) / 2;
    (reaches(middle) ? high : low) = middle;
    ++done;
  }
  if (watch.stopped()) return {.status = Status::interrupted};
  return {.status = Status::done, .voltage = high};
}

}  // namespace softland
