#include "studies/closing/closed_state.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "base/engineering.h"

namespace softland {

ClosedState closed_state(const PreparedScene& prepared, const std::vector<Signal>& signals) {
  const Switch& model = prepared.model;
  const std::vector<double> levels = hold_levels(signals);
  ClosedState state;
  const ModeLadder ladder(prepared);
  const auto closed = closed_equilibria(ladder, levels);
  if (closed.front()) {
    state.exists = true;
    state.contact_force = closed.front()->contact_force;
    state.smallest_eigenvalue = closed.front()->smallest_eigenvalue;
    const StabilityByModes judged = stability(ladder, closed);
    state.stable = judged.stable;
    state.flips = judged.flips;
    if (ladder.exists()) state.by_modes = judged.eigenvalues;
  }
  const std::vector<Electrode>& electrodes = model.device().electrodes;
  for (std::size_t k = 0; k < electrodes.size(); ++k) {
    if (!pulls_in(model.device(), k)) continue;
    const std::string& name = electrodes[k].name;
    state.pulled_through[name] = pull_through_voltage(model, k, levels);
    if (ladder.exists())
      state.pulled_through_by_modes[name] = pulled_through_by_modes(ladder, k, levels, state.pulled_through[name]);
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
  // Ratio of a contact force that counts as zero to the force that bends the beam by the contact gap.
  constexpr double rounding = 1e-9;
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

namespace {

// Returns an eigenvalue or voltage by number of modes as text: "9.97e10 rad^2/s^2 with 5 modes, -6.9e10 with 10, none with 20".
std::string by_modes_prose(const ByModes& found, std::string_view unit, int digits) {
  std::string words;
  for (const auto& [modes, value] : found.values)
    words += fmt::format("{}{} with {}{}", words.empty() ? "" : ", ",
                         std::isfinite(value) ? engineering(value, unit, digits) : "none", modes,
                         !words.empty() ? ""
                         : modes == 1   ? " mode"
                                        : " modes");
  return words;
}

}  // namespace

std::string warning(const ClosedState& state) {
  if (!state.exists || state.stable.value_or(true)) return {};
  std::string words =
      state.flips
          ? fmt::format(
                "whether the hold levels keep the switch closed depends on the number of modes: the smallest eigenvalue of "
                "its closed equilibrium, which must be positive, is {}",
                by_modes_prose(*state.by_modes, "rad^2/s^2", 3))
          : std::string(
                "the hold levels do not keep the switch closed: its closed equilibrium is unstable, and the beam is pulled "
                "through the contact onto the electrode, sooner or later");
  for (const auto& [electrode, volts] : state.pulled_through) {
    const auto more = state.pulled_through_by_modes.find(electrode);
    if (state.flips && more != state.pulled_through_by_modes.end()) {
      words += fmt::format("; electrode {} pulls the beam through the contact from this voltage on: {}", electrode,
                           by_modes_prose(more->second, "V", 4));
    } else if (std::isfinite(volts)) {
      words += fmt::format(" (electrode {}: from {} on)", electrode, engineering(volts, "V", 4));
    }
  }
  return words;
}

}  // namespace softland
