#include "studies/closing/by_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/engineering.h"
#include "studies/closing/actuator.h"
#include "studies/closing/quadrature.h"

namespace softland {
namespace {

constexpr double found_to = 1e-5;  // relative precision to which a static voltage of a switch with more modes is searched

// Returns the limit of a voltage or eigenvalue as the number of modes grows. Values at three successively doubled numbers of
// modes are extrapolated as a geometric series (Aitken). The last value is the limit if it hardly differs from the previous
// value, or if it belongs to the largest number of modes and changed little.
double extrapolated(const std::map<int, double>& values) {
  // The last value is the limit if its relative change is at most `rounding`, or at most `left` with the largest number of
  // modes. Values are extrapolated if the ratio of successive changes is at most `fastest`.
  constexpr double rounding = 3 * found_to, fastest = 0.5, left = 0.02;
  if (values.size() < 2) return std::nan("");
  const auto last = std::prev(values.end()), before = std::prev(last);
  const double change = last->second - before->second, size = std::abs(last->second);
  if (std::abs(change) <= rounding * size) return last->second;
  if (values.size() == 3 && values.begin()->first * 4 == last->first) {
    const double ratio = change / (before->second - values.begin()->second);
    return std::abs(ratio) <= fastest ? last->second + change * ratio / (1 - ratio) : std::nan("");
  }
  return last->first == most_static_modes && std::abs(change) <= left * size ? last->second : std::nan("");
}

// Rounds to ten digits: with many modes further digits are rounding errors, which depend on how a program is linked.
double to_ten_digits(double value) { return std::isfinite(value) ? std::stod(fmt::format("{:.9e}", value)) : value; }

// Computes the value find(switch) for each switch of `ladder` (the scene's switch with rising numbers of modes). If the last
// value still changes by more than `much`, computes the value with the most modes as well.
template <class Find>
ByModes value_by_modes(const ModeLadder& ladder, Find&& find) {
  // Relative change of the last value above which the value is also computed with the most modes.
  constexpr double much = 5e-3;
  std::map<int, double> values;
  double change = 0, last = std::nan("");
  const auto add = [&](const Switch& model) {
    const double here = find(model);
    change = std::abs(here - last) / std::abs(here);
    values[static_cast<int>(model.modes())] = last = here;
  };
  for (const Switch* model : ladder.switches()) add(*model);
  if (change > much && values.size() == 3 && values.rbegin()->first < most_static_modes) add(ladder.finest());
  return by_modes(std::move(values));
}

// Extends an equilibrium of a switch with fewer modes by zeros, as the starting point for a switch with more modes.
ClosedEquilibrium with_modes_of(ClosedEquilibrium closed, const Switch& model) {
  closed.q.conservativeResizeLike(Eigen::VectorXd::Zero(model.modes()));
  return closed;
}

StabilityByModes judged_stability(const std::vector<const Switch*>& switches, const std::vector<double>& eigenvalues) {
  StabilityByModes found;
  std::map<int, double> values;
  bool any = false, all = true;
  for (std::size_t k = 0; k < switches.size(); ++k) {
    const auto modes = static_cast<int>(switches[k]->modes());
    values[modes] = eigenvalues[k];
    if (std::isfinite(eigenvalues[k]) && !judges_stability(*switches[k])) continue;
    const bool yes = eigenvalues[k] > 0;
    found.stable = found.stable.value_or(true) && yes;
    any = any || yes;
    all = all && yes;
  }
  found.eigenvalues = by_modes(std::move(values));
  if (any && all && found.eigenvalues.converged <= 0) found.stable = all = false;
  found.flips = any && !all;
  return found;
}

std::string mode_warning(const Scene& scene, std::size_t electrode, const ByModes& voltage) {
  constexpr int digits = 5;
  return fmt::format(
      "structure.modes = {}: more modes move the static pull-in voltage of electrode {}, {}, by {}; dynamic pull-in "
      "and release are as uncertain",
      scene.device.structure.modes, scene.device.electrodes[electrode].name,
      engineering(voltage.values.begin()->second, "V", digits), shift_prose(voltage));
}

std::string capacitance_warning(const Scene& scene, const ByModes& found) {
  constexpr int digits = 4;
  const std::optional<int> needed = modes_needed(found);
  const std::string enough =
      needed && *needed <= Structure::most_modes
          ? fmt::format("{} modes give it to 1 %", *needed)
          : fmt::format("the {} modes that a closing takes at most do not give it to 1 %", Structure::most_modes);
  return fmt::format("structure.modes = {}: more modes move the capacitance of the closed state, {}, by {}; {}",
                     scene.device.structure.modes, engineering(found.values.begin()->second, "F", digits),
                     shift_prose(found, "F"), enough);
}

}  // namespace

ByModes by_modes(std::map<int, double> values) {
  for (auto one = values.begin(); one != values.end(); ++one) {
    if (one != values.begin()) one->second = to_ten_digits(one->second);
  }
  const double converged = extrapolated(values);
  return {.values = std::move(values), .converged = converged};
}

double ByModes::moved() const {
  if (values.size() < 2) return 0;
  const double own = values.begin()->second, last = values.rbegin()->second;
  if (std::isfinite(own) != std::isfinite(last)) return std::numeric_limits<double>::infinity();
  return (std::isfinite(converged) ? converged : last) / own - 1;
}

bool ByModes::is_worth_telling() const { return std::abs(moved()) > mode_shift_worth_telling; }

ModeLadder::ModeLadder(const Scene& scene, const Switch& own) : scene_(&scene), own_(&own) {
  const Structure& s = own.device().structure;
  if (s.find<Beam>() == nullptr) return;
  for (const int modes : {2 * s.modes, 4 * s.modes}) {
    const int most = richer_.empty() ? s.modes : static_cast<int>(richer_.back().modes());
    if (std::min(modes, most_static_modes) > most) richer_.push_back(with(std::min(modes, most_static_modes)));
  }
}

Switch ModeLadder::with(int modes) const {
  const SimulateOptions& asked = scene_->simulate;
  return resolved_switch(scene_->device, asked.tolerance > 0 ? SimulateOptions{}.accuracy : asked.accuracy, modes).model;
}

std::vector<const Switch*> ModeLadder::switches() const {
  std::vector<const Switch*> all{own_};
  for (const Switch& one : richer_) all.push_back(&one);
  return all;
}

const Switch& ModeLadder::finest() const {
  if (!finest_) finest_ = with(most_static_modes);
  return *finest_;
}

std::vector<std::optional<ClosedEquilibrium>> closed_equilibria(const ModeLadder& ladder, std::span<const double> volts) {
  std::vector<std::optional<ClosedEquilibrium>> all;
  for (const Switch* model : ladder.switches()) {
    const bool has_near = !all.empty() && all.back();
    all.push_back(has_near ? closed_equilibrium_near(*model, volts, with_modes_of(*all.back(), *model))
                           : closed_equilibrium(*model, volts));
  }
  return all;
}

StabilityByModes stability(const ModeLadder& ladder, std::span<const std::optional<ClosedEquilibrium>> closed) {
  std::vector<double> eigenvalues;
  for (const auto& one : closed) eigenvalues.push_back(one ? one->smallest_eigenvalue : std::nan(""));
  return judged_stability(ladder.switches(), eigenvalues);
}

StabilityByModes open_stability(const ModeLadder& ladder, std::span<const double> volts) {
  std::vector<double> eigenvalues;
  for (const Switch* model : ladder.switches()) {
    const std::optional<Eigen::VectorXd> open = model->open_equilibrium(volts);
    eigenvalues.push_back(open ? open_tangent_eigenvalue(*model, *open, volts) : std::nan(""));
  }
  return judged_stability(ladder.switches(), eigenvalues);
}

ByModes static_pull_in_by_modes(const ModeLadder& ladder, const Scene& scene, std::size_t electrode) {
  return value_by_modes(ladder,
                        [&](const Switch& model) { return static_pull_in(model, electrode, bias_of(scene, electrode)).voltage; });
}

ByModes pulled_through_by_modes(const ModeLadder& ladder, std::size_t electrode, std::vector<double> volts, double own) {
  constexpr double below = 0.95;  // the search starts at this ratio to the collapse voltage with fewer modes
  std::optional<ClosedEquilibrium> near;
  double found = own;
  return value_by_modes(ladder, [&](const Switch& model) {
    if (&model != ladder.switches().front()) {
      if (std::isfinite(found)) volts[electrode] = below * found;
      near = near ? closed_equilibrium_near(model, volts, with_modes_of(*near, model)) : closed_equilibrium(model, volts);
      found = near ? pull_through_voltage_near(model, electrode, volts, *near, found_to)
                   : pull_through_voltage(model, electrode, volts, found_to);
    }
    return found;
  });
}

VoltagesByModes voltages_by_modes(const ModeLadder& ladder, const Scene& scene, std::size_t electrode, double pulled_through) {
  VoltagesByModes found{.static_pull_in = static_pull_in_by_modes(ladder, scene, electrode), .release = {}, .pulled_through = {}};
  if (!ladder.switches().front()->has_contact()) return found;
  std::vector<double> levels = bias_of(scene, electrode);
  found.release = value_by_modes(ladder, [&](const Switch& model) { return release_voltage(model, electrode, levels); });
  levels[electrode] = found.release.values.begin()->second;
  if (std::isfinite(levels[electrode])) found.pulled_through = pulled_through_by_modes(ladder, electrode, levels, pulled_through);
  return found;
}

ByModes closed_capacitance_by_modes(const ModeLadder& ladder, std::span<const double> volts) {
  std::optional<ClosedEquilibrium> near;
  const auto capacitance = [&](const Switch& model) {
    near = near ? closed_equilibrium_near(model, volts, with_modes_of(*near, model)) : closed_equilibrium(model, volts);
    if (!near) return std::nan("");
    Switch::Workspace work = model.workspace();
    return model.capacitance(searched_drive(model.device()), near->q.data(), work);
  };
  ByModes found = value_by_modes(ladder, capacitance);
  constexpr int most = Structure::most_modes;
  if (found.is_worth_telling() && !found.values.contains(most)) {
    near.reset();
    found.values[most] = to_ten_digits(capacitance(ladder.with(most)));
  }
  return found;
}

std::optional<int> modes_needed(const ByModes& found) {
  if (!std::isfinite(found.converged)) return std::nullopt;
  std::optional<int> fewest;
  for (const auto& [modes, value] : found.values) {
    const bool holds = std::abs(value - found.converged) <= mode_shift_worth_telling * std::abs(found.converged);
    fewest = !holds ? std::nullopt : fewest ? fewest : modes;
  }
  return fewest;
}

std::string shift_prose(const ByModes& value, std::string_view unit) {
  constexpr int digits = 5;
  constexpr double least = 1e-5;
  const double moved = value.moved();
  if (std::isnan(moved)) return {};
  if (std::isinf(moved)) {
    const auto [modes, last] = *value.values.rbegin();
    return std::isfinite(last)
               ? fmt::format("so much that there is one, {} with {} modes", engineering(last, unit, digits), modes)
               : fmt::format("so much that there is none with {} modes", modes);
  }
  if (std::abs(moved) < least) return "less than 0.001 %";
  const std::string share = (moved < 0 ? "−" : "") + engineering(100 * std::abs(moved), "%", 2);
  if (!value.is_worth_telling()) return share;
  if (std::isfinite(value.converged)) return fmt::format("{}, to {}", share, engineering(value.converged, unit, digits));
  return fmt::format("{} and on, to {} with {} modes", share, engineering(value.values.rbegin()->second, unit, digits),
                     value.values.rbegin()->first);
}

std::vector<std::string> mode_warnings(const PreparedScene& prepared) {
  std::vector<std::string> warnings;
  const ModeLadder ladder(prepared);
  if (!ladder.exists()) return warnings;
  for (std::size_t k = 0; k < prepared.scene.device.electrodes.size(); ++k) {
    if (!pulls_in(prepared.scene.device, k)) continue;
    const ByModes voltage = static_pull_in_by_modes(ladder, prepared.scene, k);
    if (voltage.is_worth_telling()) warnings.push_back(mode_warning(prepared.scene, k, voltage));
  }
  if (prepared.scene.device.closes_along_face()) {
    const ByModes capacitance = closed_capacitance_by_modes(ladder, hold_levels(prepared.signals()));
    const bool closes = std::isfinite(capacitance.values.begin()->second);
    if (closes && capacitance.is_worth_telling()) warnings.push_back(capacitance_warning(prepared.scene, capacitance));
  }
  return warnings;
}

}  // namespace softland
