#include "studies/closing/closed_state.h"

#include <fmt/format.h>

#include <cmath>

#include "base/engineering.h"

namespace softland {

ClosedState closed_state(const PreparedScene& prepared, const std::vector<Signal>& signals) {
  const Switch& model = prepared.model;
  const std::vector<double> levels = hold_levels(signals);
  ClosedState state;
  if (const auto closed = closed_equilibrium(model, levels)) {
    state.exists = true;
    state.contact_force = closed->contact_force;
    state.smallest_eigenvalue = closed->smallest_eigenvalue;
    if (judges_stability(model)) state.stable = closed->smallest_eigenvalue > 0;
  }
  const std::vector<Electrode>& electrodes = model.device().electrodes;
  for (std::size_t k = 0; k < electrodes.size(); ++k) {
    if (pulls_in(model.device(), k)) state.pulled_through[electrodes[k].name] = pull_through_voltage(model, k, levels);
  }
  return state;
}

ClosedRange closed_range(const Switch& model, std::size_t electrode, std::vector<double> bias) {
  if (!model.has_contact() || !pulls_in(model.device(), electrode)) return {};
  ClosedRange range{.release = release_voltage(model, electrode, bias)};
  bias[electrode] = range.release;
  if (std::isfinite(range.release)) range.pulled_through = pull_through_voltage(model, electrode, bias);
  return range;
}

namespace {

bool is_equilibrium(const Switch& model, const Eigen::VectorXd& q, const std::vector<double>& levels) {
  constexpr double rounding = 1e-9;  // of the force that bends the beam by the contact gap
  const double left = static_force(model, q, levels).cwiseQuotient(model.basis().angular_frequencies()).squaredNorm();
  return left <= rounding * rounding * model.bending_energy();
}

}  // namespace

bool leaves_at_rest(const Switch& model, const std::vector<double>& before, const std::vector<double>& levels) {
  const std::optional<Eigen::VectorXd> rest = model.open_equilibrium(before);
  return rest && is_equilibrium(model, *rest, levels);
}

std::string unstable_rest(const Switch& model, const std::vector<Signal>& signals) {
  const std::optional<Eigen::VectorXd> rest = model.open_equilibrium(values_before(signals));
  if (!rest) return {};
  const std::vector<double> levels = hold_levels(signals);
  if (!is_equilibrium(model, *rest, levels)) return {};
  const double smallest = open_tangent_eigenvalue(model, *rest, levels);
  if (smallest > 0) return {};
  return fmt::format(
      "the hold levels leave the switch where it rests, in an unstable equilibrium (smallest eigenvalue of the tangent {}): the "
      "least "
      "asymmetry of a device moves it to one side",
      engineering(smallest, "rad^2/s^2", 3));
}

std::string warning(const ClosedState& state) {
  if (!state.exists || state.stable.value_or(true)) return {};
  std::string words =
      "the hold levels do not keep the switch closed: its closed equilibrium is unstable, and the beam is pulled through the "
      "contact "
      "onto the electrode, sooner or later";
  for (const auto& [electrode, volts] : state.pulled_through) {
    if (volts == volts) words += fmt::format(" (electrode {}: from {} on)", electrode, engineering(volts, "V", 4));
  }
  return words;
}

}  // namespace softland
