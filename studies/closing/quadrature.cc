#include "studies/closing/quadrature.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/pull_in.h"

namespace softland {
namespace {

// Returns the modal forces of every drive at unit strength, then the modal forces of the gas on the moving beam. Each modal
// force is divided by the frequency of its mode, so that the square of a column is twice its static energy.
Eigen::MatrixXd loads_at(const Switch& model, const Eigen::VectorXd& q) {
  const Eigen::Index n = model.modes(), drives = static_cast<Eigen::Index>(model.drives());
  Switch::Workspace work = model.workspace();
  std::vector<double> none;
  for (std::size_t k = 0; k < model.drives(); ++k)
    none.push_back(model.drive_kind(k) == DriveKind::piezo ? 0 : model.value_of_strength(k, 0));
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd moving(n), resting(n);
  model.accelerations(q.data(), q.data(), none, false, work, moving.data());
  model.accelerations(q.data(), still.data(), none, false, work, resting.data());
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(n, drives + 1);
  model.drive_forces(work, loads.leftCols(drives));
  loads.rightCols<1>() = moving - resting;
  return model.basis().angular_frequencies().cwiseInverse().asDiagonal() * loads;
}

// Returns the states of the beam at first contact: moved to the contact plane by each drive that can do so, else by a force at
// the contact.
std::vector<Eigen::VectorXd> at_touch(const Switch& model) {
  const double plane = model.contact_gap();
  std::vector<Eigen::VectorXd> states;
  for (std::size_t k = 0; k < model.device().electrodes.size(); ++k) {
    if (!pulls_in(model.device(), k)) continue;
    if (auto held = held_by_drive(model, k, plane)) states.push_back(std::move(held->q));
  }
  if (!states.empty()) return states;
  const Eigen::VectorXd& shape = model.basis().contact_shape();
  const Eigen::VectorXd pushed = shape.cwiseQuotient(model.basis().squares());
  return {pushed * (plane / shape.dot(pushed))};
}

}  // namespace

SwitchOptions quadrature_for(double accuracy, int modes) {
  // Quadrature points per decimal digit of accuracy, and least number of points. A mode has as many half waves as its number,
  // and each half wave needs two points.
  constexpr double points_per_digit = 4, fewest = 8;
  return {.points_per_length = std::max({fewest, points_per_digit * -std::log10(accuracy), 2.0 * modes + 4})};
}

SwitchOptions finer_than(const SwitchOptions& q) {
  return {.points_per_length = 2 * q.points_per_length, .points_per_panel = 2 * q.points_per_panel};
}

double load_difference(const Switch& one, const Switch& other, const Eigen::VectorXd& q) {
  const Eigen::MatrixXd a = loads_at(one, q), b = loads_at(other, q);
  double most = 0;
  for (Eigen::Index k = 0; k < b.cols(); ++k)
    if (const double size = b.col(k).norm(); size > 0) most = std::max(most, (a.col(k) - b.col(k)).norm() / size);
  return most;
}

ResolvedSwitch resolved_switch(const Device& device, double accuracy, std::optional<int> modes) {
  constexpr double growth = 1.25, most_growth = 16;
  // Ratio of the loads' error after a refinement to that before; below this ratio the refinement helped.
  constexpr double helps = 0.5;
  // Number of refinements of the quadrature in a row without help after which the loads count as not smooth.
  constexpr int most_in_vain = 4;
  const auto with_modes = [&](SwitchOptions q) {
    q.modes = modes;
    return q;
  };
  const auto switch_with = [&](const SwitchOptions& q) {
    return ResolvedSwitch{.model = Switch(device, with_modes(q)), .quadrature = with_modes(q)};
  };
  ResolvedSwitch best = switch_with(quadrature_for(accuracy, modes.value_or(device.structure.modes)));
  const double most_points = most_growth * best.quadrature.points_per_length;
  for (bool is_checked = false; !is_checked;) {
    is_checked = true;
    const std::vector<Eigen::VectorXd> states = at_touch(best.model);
    const auto set_error = [&](ResolvedSwitch& r) {
      const Switch finer(device, with_modes(finer_than(r.quadrature)), &r.model);
      r.error = 0;
      for (const Eigen::VectorXd& q : states) r.error = std::max(r.error, load_difference(r.model, finer, q));
    };
    set_error(best);
    ResolvedSwitch next = best;
    for (int vain = 0; next.error > accuracy && vain < most_in_vain && next.quadrature.points_per_length < most_points;) {
      SwitchOptions q = next.quadrature;
      ++q.points_per_panel;  // more points in the short panels (intervals of the quadrature) only
      ResolvedSwitch more = switch_with(q);
      if (more.model.quadrature().points() > next.model.quadrature().points()) set_error(more);
      if (!(more.error < helps * next.error) || more.model.quadrature().points() == next.model.quadrature().points()) {
        q = {.points_per_length = growth * next.quadrature.points_per_length,
             .points_per_panel = next.quadrature.points_per_panel};
        more = switch_with(q);
        set_error(more);
      }
      next = std::move(more);
      vain = next.error < helps * best.error ? 0 : vain + 1;
      if (vain == 0 || next.error <= accuracy) best = next, is_checked = false;
    }
  }
  return best;
}

Switch switch_like(const Device& device, const Switch& nominal, const SwitchOptions& quadrature, double accuracy) {
  // Ratio to the nominal switch of the electrode gap that remains at contact; below this ratio loads are steeper, so that the
  // number of quadrature points is checked again.
  constexpr double nearer = 0.95;
  const auto gap_at_touch = [](const Device& d) { return 1 - d.gap.contact / d.gap.electrode; };
  Switch own(device, quadrature, &nominal);
  if (gap_at_touch(own.device()) >= nearer * gap_at_touch(nominal.device())) return own;
  ResolvedSwitch resolved = resolved_switch(device, accuracy);
  return resolved.model.quadrature().points() > own.quadrature().points() ? std::move(resolved.model) : own;
}

}  // namespace softland
