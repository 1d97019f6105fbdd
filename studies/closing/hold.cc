#include "studies/closing/hold.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "model/contact/resistance.h"
#include "studies/closing/actuator.h"

namespace softland {

bool has_opened(const Trajectory& run) {
  return run.began_closed && !run.touches.empty() && std::isfinite(run.touches.back().end);
}

std::string hold_warning(const Switch& model, const std::vector<Signal>& signals, const ClosedState& state) {
  if (state.stable != false && hold_of(model, signals).is_held) return {};
  const std::string unstable = warning(state);
  return unstable.empty() ? std::string(not_held) : unstable;
}

namespace {

// Returns the device with contact number `c` in the first place, for closed_equilibrium(), which takes the first contact.
Device with_first_contact(Device device, std::size_t c) {
  device.contacts.front().gap = device.gap.contact;
  std::swap(device.contacts.front(), device.contacts[c]);
  device.gap.contact = device.contacts.front().gap;
  return device;
}

// Returns the conductance of a contact at rest under a contact force [S]; NaN if the conductance is unknown.
double conductance_at(const Switch& model, const Eigen::VectorXd& q, double force, std::size_t c = 0) {
  const ContactResistance contact = contact_resistance(model.device(), c);
  if (!contact.is_known()) return Metrics::unset;
  return contact.conductance(model.contact_deflection(q.data(), c) - model.contact_gap(c), force);
}

// Computes the hold of a switch with several contacts at rest under these levels of its drives: the force and resistance of
// each contact, and of the connection (the electrical path through the contacts).
Hold hold_of_connection(const Switch& model, const std::vector<double>& levels, Hold hold) {
  const bool needs_all = model.device().connection == Connection::all;
  std::optional<Eigen::VectorXd> rest;
  if (keeps_closed(model, hold.closed)) rest = hold.closed->q;
  // If any contact makes the connection, search an equilibrium on each other contact: `hold.closed` is that on the first one.
  for (std::size_t c = 1; c < model.contacts() && !rest && !needs_all; ++c) {
    if (!model.device().contacts[c].connects) continue;
    const Switch other(with_first_contact(model.device(), c));
    const std::optional<ClosedEquilibrium> closed = closed_equilibrium(other, levels);
    if (keeps_closed(other, closed)) rest = closed->q;
  }
  hold.is_held = false;
  hold.force = Metrics::unset;
  if (!rest) return hold;
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(model.modes());
  std::vector<double> conductances;
  double force = needs_all ? std::numeric_limits<double>::infinity() : 0;
  for (std::size_t c = 0; c < model.contacts(); ++c) {
    const bool acts =
        model.has_spread_contact(c) || model.contact_deflection(rest->data(), c) > model.contact_gap(c) - model.contact_reach(c);
    const double own = acts ? model.contact_push(rest->data(), still.data(), true, c) : 0;
    hold.forces.push_back(own);
    conductances.push_back(conductance_at(model, *rest, own, c));
    hold.resistances.push_back(resistance_of(conductances.back()));
    if (!model.device().contacts[c].connects) continue;
    force = needs_all ? std::min(force, own) : std::max(force, own);
  }
  hold.is_held = force > 0;
  if (!hold.is_held) return hold;
  hold.force = force;
  if (model.device().conducts()) hold.resistance = resistance_of(connection_conductance(model.device(), conductances));
  return hold;
}

}  // namespace

Hold hold_under(const Switch& model, const std::vector<double>& levels, const std::optional<ClosedEquilibrium>& near) {
  Hold hold{.closed = near ? closed_equilibrium_near(model, levels, *near) : closed_equilibrium(model, levels)};
  const bool stays = keeps_closed(model, hold.closed);
  if (stays) hold.force = hold.closed->contact_force;
  if (stays && model.device().conducts()) hold.resistance = resistance_of(conductance_at(model, hold.closed->q, hold.force));
  if (model.contacts() > 1) return hold_of_connection(model, levels, std::move(hold));
  const bool sticks = model.has_contact() && may_stick(model.device().contacts.front().model);
  hold.is_held = stays || !model.has_contact() || (sticks && !hold.closed);
  return hold;
}

MetricsOptions with_load(MetricsOptions options, const Switch& model, StartState start, const std::vector<Signal>& held) {
  const Device& device = model.device();
  if (!device.load.is_given()) return options;
  const std::vector<double> holding = start == StartState::closed ? values_before(held) : hold_levels(held);
  options.transfer = {.load = device.load, .light_below = hold_under(model, holding).steady_force(options)};
  const auto made_by = std::ranges::count_if(device.contacts, &Contact::connects);
  if (made_by == 1 && device.conducts()) options.transfer.contact = contact_resistance(device, 0);
  return options;
}

void set_hold(Trajectory& trajectory, const Hold& hold) {
  trajectory.hold_force = hold.force;
  trajectory.is_held = hold.is_held;
  trajectory.hold_resistance = hold.resistance;
  for (std::size_t c = 0; c < std::min(trajectory.contacts.size(), hold.forces.size()); ++c) {
    trajectory.contacts[c].hold_resistance = hold.resistances[c];
    if (hold.forces[c] > 0) trajectory.contacts[c].hold_force = hold.forces[c];
  }
}

void set_rest(Trajectory& trajectory, const Switch& model, const std::vector<Signal>& signals, const Hold& hold) {
  set_hold(trajectory, hold);
  if (!has_pulling_electrode(model.device())) return;
  std::optional<Eigen::VectorXd> q;
  if (trajectory.touches.empty() || has_opened(trajectory)) {
    q = model.open_equilibrium(hold_levels(signals));
  } else if (hold.closed) {
    q = hold.closed->q;
  }
  if (!q) return;
  Switch::Workspace work = model.workspace();
  trajectory.hold_capacitance = model.capacitance(searched_drive(model.device()), q->data(), work);
}

}  // namespace softland
