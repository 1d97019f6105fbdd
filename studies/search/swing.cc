#include "studies/search/swing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/require.h"
#include "model/closing.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

struct Flight {
  bool touched = false;
  std::vector<VectorXd> states;  // modal coordinates and rates at the start and after each time step
};

// Simulates the motion from rest under full pull and then under full release, until the switch makes contact, or until its
// contact point moves back.
class PullAndRelease {
 public:
  PullAndRelease(const Switch& model, Eigen::VectorXd rest, std::vector<double> pulling, std::vector<double> releasing,
                 double step, double longest)
      : model_(model),
        rest_(std::move(rest)),
        pulling_(std::move(pulling)),
        releasing_(std::move(releasing)),
        step_(step),
        longest_(longest),
        work_(model.workspace()) {}

  Flight fly(double release_at) {
    const Index n = model_.modes();
    const double gap = model_.contact_gap();
    Flight flight;
    VectorXd x(2 * n), k1(2 * n), k2 = k1, k3 = k1, k4 = k1;
    x << rest_, VectorXd::Zero(n);
    flight.states.push_back(x);
    for (double t = 0; t < longest_;) {
      const bool pulls = t < release_at;
      const double h = pulls ? std::min(step_, release_at - t) : step_;
      const std::vector<double>& drives = pulls ? pulling_ : releasing_;
      rates(x, drives, k1);
      rates(x + h / 2 * k1, drives, k2);
      rates(x + h / 2 * k2, drives, k3);
      rates(x + h * k3, drives, k4);
      x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      t += h;
      flight.states.push_back(x);
      flight.touched = model_.contact_deflection(x.data()) >= gap;
      if (flight.touched || !x.allFinite()) break;
      if (!pulls && model_.contact_deflection(x.data() + n) < 0) break;
    }
    return flight;
  }

 private:
  void rates(const VectorXd& at, const std::vector<double>& drives, VectorXd& result) {
    const Index n = model_.modes();
    result.head(n) = at.tail(n);
    model_.accelerations(at.data(), at.data() + n, drives, false, work_, result.data() + n);
  }

  const Switch& model_;
  Eigen::VectorXd rest_;
  std::vector<double> pulling_, releasing_;  // values of the drives during pull and release [V]
  double step_, longest_;                    // time step and longest duration of the motion [s]
  Switch::Workspace work_;
};

// Returns true if the integrator was unstable, as in a film that damps faster than a time step: the contact point is then
// faster than its whole gap in one step, which is a small part of a period.
bool is_unstable(const Switch& model, const Flight& flight, double step) {
  return std::ranges::any_of(flight.states, [&](const VectorXd& x) {
    return !(step * std::abs(model.contact_deflection(x.data() + model.modes())) <= model.contact_gap());
  });
}

// Returns the swing through a film that stops the beam within less than a time step: the pull lasts until the touch. The
// integrator of closings is implicit in such a film.
std::optional<Swing> overdamped_swing(const Switch& model, const std::vector<double>& pulling, double step, double longest,
                                      std::span<const double> before) {
  constexpr double tolerance = 1e-6;
  std::vector<Signal> signals;
  for (std::size_t k = 0; k < pulling.size(); ++k)
    signals.push_back(Signal::constant(pulling[k], before.empty() ? 0 : before[k]));
  const Trajectory run = simulate_closing(model, signals, {.duration = longest, .tolerance = tolerance, .after_contact = 0});
  if (run.touches.empty()) return std::nullopt;
  return Swing{.driven_time = run.touches.front().begin, .step = step, .is_overdamped = true};
}

}  // namespace

std::optional<Swing> quickest_swing(const Switch& model, const std::vector<double>& pulling, const std::vector<double>& releasing,
                                    double longest, std::span<const double> before) {
  require(pulling.size() == model.drives() && releasing.size() == model.drives(), "a swing needs a value for every drive");
  require(model.film_states() == 0, "the quickest swing is not known where the gas film is compressible");
  const std::optional<VectorXd> rest = model.open_equilibrium(before);
  require(rest.has_value(), "a switch without an open state has no swing");
  constexpr double step_angle = 0.05;  // phase angle by which the fastest mode turns in one time step [rad]
  Swing swing{.step = step_angle / model.basis().angular_frequencies().maxCoeff()};
  PullAndRelease drives(model, *rest, pulling, releasing, swing.step, longest);
  const Flight full = drives.fly(longest);
  if (!full.touched && !is_unstable(model, full, swing.step)) return std::nullopt;
  double low = 0, high = static_cast<double>(full.states.size()) * swing.step;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (drives.fly(middle).touched ? high : low) = middle;
  }
  Flight last = drives.fly(high);
  if (is_unstable(model, last, swing.step)) return overdamped_swing(model, pulling, swing.step, longest, before);
  swing.states = std::move(last.states);
  swing.driven_time = high;
  // The time step that ends at the release is shorter than the others, which is neglected here: the error does not matter for a
  // starting point of a search.
  swing.releasing_time = std::max(0.0, static_cast<double>(swing.states.size() - 1) * swing.step - high);
  return swing;
}

}  // namespace softland
