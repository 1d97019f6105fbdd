#include "model/pull_in.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "integrators/roots.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/equilibrium_branch.h"

namespace softland {

using namespace statics;

namespace {

// Simulations of constant steps of one drive, from rest, that test whether the switch closes.
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
  // Returns true when a step of the drive to `value` reaches the contact plane. Calls tell(share) from time to time with the
  // elapsed share of the simulated time, for progress reports.
  template <class Tell>
  bool reaches(double value, const std::atomic<bool>* stop, Tell&& tell) {
    std::vector<double> all = bias_;
    all[drive_] = value;
    const Pass barrier = pass(value, all);
    if (model_.potential(rest_->data(), all, false, work_) < barrier.potential) return false;
    std::vector<Signal> signals;
    for (const double standing : bias_) signals.push_back(Signal::standing(standing));
    signals[drive_] = Signal::constant(value);
    // Of several contacts, another one than that of the pull-in may touch first, or the connection may stay open.
    const bool is_connection = model_.contacts() > 1;
    ClosingOptions options{.duration = 100 * 2 * pi / model_.basis().angular_frequencies()[0],
                           .tolerance = tolerance_,
                           .after_contact = is_connection ? std::numeric_limits<double>::infinity() : 0,
                           .stop = stop};
    int step = 0;
    bool is_there = false;
    options.observer = [&](double time, const double* q, const double* v) {
      is_there = is_connection && model_.contact_deflection(q) >= (1 - on_the_plane) * model_.contact_gap();
      if (is_there) return true;
      // Compare the energies at every eighth step only: computing the energy more often costs more than an earlier end of the
      // run saves.
      if (++step % 8 != 0) return false;
      tell(time / options.duration);
      return model_.contact_deflection(q) < barrier.deflection && model_.basis().kinetic_energy(v) +
                                                                          model_.potential(q, all, model_.untouched(q), work_) +
                                                                          model_.film_energy(q, work_) <
                                                                      barrier.potential;
    };
    const Trajectory run = simulate_closing(model_, signals, options);
    return is_connection ? is_there : !run.touches.empty();
  }

 private:
  struct Pass {
    double deflection, potential;
  };

  // Returns energy and deflection of the barrier of a step of the drive to `value`. The barrier is the unstable equilibrium
  // between rest and contact plane, or the state held at the plane if the plane comes first. No state with this deflection of
  // the contact point has less energy, and damping only reduces the energy. So a run whose energy falls below that of the
  // barrier before the contact point is there never reaches the plane.
  Pass pass(double value, std::span<const double> all) {
    const double plane = model_.contact_gap(), strength = model_.strength(drive_, value);
    if (static_.kind == StaticKind::fold && branch_(plane) < strength) {
      const double s = bracketed_zero([&](double x) { return branch_(x) - strength; }, static_.deflection, plane);
      branch_(s);
      return {s, statics_.potential(branch_.q(), all)};
    }
    const auto held = statics_.pinned(all, plane);
    return {plane, held ? statics_.potential(held->q, all) : no_equilibrium};
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
  static constexpr double on_the_plane = 1e-12;  // distance at which the contact touches, relative to the contact gap
};

}  // namespace

bool pulls_in(const Device& device, std::size_t drive) {
  return drive >= device.electrodes.size() || device.electrodes[drive].side != Side::far;
}

std::string_view to_string(StaticKind kind) { return kind == StaticKind::fold ? "fold" : "contact"; }

StaticPullIn static_pull_in(const Switch& model, std::size_t drive, Bias bias) {
  if (!pulls_in(model.device(), drive)) return {.status = Status::no_contact};
  // The branch of equilibria of an electrode begins at its neutral voltage, where its field vanishes; the branch of the
  // dispersion force begins at force factor 0.
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
      // The deflection is in units of the gap, because the tolerance of Brent's method is partly absolute. The maximum of
      // the strength is flat, so the error of the deflection hardly changes the voltage.
      const auto [at, value] = boost::math::tools::brent_find_minima([&](double x) { return -branch(x * end); },
                                                                     std::max(1e-6, place(k - 2) / end), s / end, 30);
      // A drive that pulls away from the contact has no pull-in: its strength falls along its branch of equilibria from the
      // start.
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

// Follows the branch of equilibria from the straight beam almost to the contact plane, in small steps of the deflection, so
// that the next search on the branch starts from an equilibrium near the plane.
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
  double last = no_equilibrium;
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
    // Number of depths at which the least voltage is sought first: adhesion may cause a second, lower minimum at larger depth.
    constexpr int looks = 256;
    const double step = largest_interference(model.device().contacts.front().model) / looks;
    double best = branch(plane), at = 0;
    for (int k = 1; k < looks; ++k) {
      const double value = branch(plane + k * step);
      if (value < best) best = value, at = k * step;
    }
    // Depths are in units of the step, because the tolerance of Brent's method is partly absolute.
    const double low = std::max(0.0, at / step - 1);
    const auto [depth, value] =
        boost::math::tools::brent_find_minima([&](double x) { return branch(plane + x * step); }, low, at / step + 1, 30);
    return value < best ? released(value, plane + depth * step) : released(best, plane + at);
  }
  // The contact is soft at first touch, so the least voltage may lie beyond the plane, where the contact force makes it rise.
  const auto lowest = first_minimum([&](double depth) { return branch(plane + depth); }, model.penetration_scale() / 16);
  return lowest ? released(lowest->value, plane + lowest->depth) : ReleasePoint{};
}

double release_voltage(const Switch& model, std::size_t drive, Bias bias) { return release_point(model, drive, bias).voltage; }

std::optional<StablePath> stable_path(const Switch& model, std::size_t drive, Bias bias) {
  constexpr int steps = 32;
  std::vector<double> values = standing(model, drive, bias);
  const std::optional<Eigen::VectorXd> rest = model.open_equilibrium(values);
  if (!rest) return std::nullopt;
  EquilibriumBranch branch(model, drive, bias);
  const double begin = model.contact_deflection(rest->data()), end = model.contact_gap();
  StablePath path{.deflections = {begin}, .values = {0.0}};
  double direction = 0;  // drive's value at the first step; its sign tells whether the values rise or fall along the path
  for (int k = 1; k <= steps; ++k) {
    const double s = begin + (end - begin) * k / steps, strength = branch(s);
    if (!std::isfinite(strength) || (model.drive_kind(drive) == DriveKind::electrode && !(strength > 0))) return std::nullopt;
    const double value = model.value_of_strength(drive, strength);
    if (k == 1) direction = value;
    // At pull-in the value of the drive turns back along the branch of equilibria: beyond it no equilibrium is stable.
    if (!((value - path.values.back()) * direction > 0)) return std::nullopt;
    values[drive] = value;
    if (!(open_tangent_eigenvalue(model, branch.q(), values) > 0)) return std::nullopt;
    path.deflections.push_back(s);
    path.values.push_back(value);
  }
  return path;
}

bool step_closes(const Switch& model, std::size_t drive, double value, Bias bias, const Progress& progress, double tolerance) {
  const StaticPullIn statically = static_pull_in(model, drive, bias);
  if (statically.status != Status::done) return statically.status != Status::no_contact;
  if (value >= statically.voltage) return true;
  return StepTrial(model, drive, statically, bias, tolerance).reaches(value, progress.stop, [](double) {});
}

namespace {

// Returns true when damping prevents oscillation of the first mode, linearised about the open position at rest.
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
                              const Progress& progress, double tolerance, double precision) {
  if (static_result.status != Status::done) return {.status = static_result.status};
  StepTrial steps(model, drive, static_result, bias, tolerance);
  if (!steps.has_rest()) return {.status = Status::collapsed_at_rest};
  // Expected number of simulated voltage steps: the first one, and those that halve the bracket of the dynamic pull-in voltage.
  const double halvings = 1 + std::log2(0.5 / precision);
  double trials = halvings, done = 0, shown = 0;
  const auto reaches = [&](double value) {
    return steps.reaches(value, progress.stop, [&](double part) {
      // Limit the progress to 1: a bracket that has to be extended downwards needs more simulations than expected.
      shown = std::max(shown, std::min(1.0, (done + part) / trials));
      progress.tell("dynamic pull-in voltage", shown);
    });
  };

  double low = 0.5 * static_result.voltage, high = static_result.voltage;
  if (is_overdamped(model)) {
    // If damping prevents every overshoot, one simulation shows that the static pull-in voltage is the smallest that closes the
    // switch.
    trials = 1;
    if (!reaches(high * (1 - precision))) low = high;
    trials = 1 + halvings;
    ++done;
  }
  if (low == high) progress.tell("dynamic pull-in voltage", 1);
  while (low < high && reaches(low)) {
    if (progress.stopped()) break;
    high = low;
    low /= 2;
    if (low < 1e-9 * static_result.voltage) return {.status = Status::numerical_failure};
  }
  ++done;
  while (high - low > precision * high && !progress.stopped()) {
    const double middle = (low + high) / 2;
    (reaches(middle) ? high : low) = middle;
    ++done;
  }
  if (progress.stopped()) return {.status = Status::interrupted};
  return {.status = Status::done, .voltage = high};
}

}  // namespace softland
