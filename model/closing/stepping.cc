#include "model/closing/stepping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "model/contact/contact_law.h"
#include "model/pull_in.h"

namespace softland {
namespace {

// An explicit integration method is replaced by an implicit method when stability limits the step length in many checks in a
// row (one check per 100 steps). A thick film in a nearly closed gap limits every step. In most other closings stability limits
// at most a dozen checks in a row. A damped contact with many short rebounds may reach ninety checks, so that the method
// changes without need.
constexpr double held_back = 2;  // value of Stepper::stiffness() above which stability limits the step length
constexpr long steps_to_look = 100;
// Rule that says when an implicit integration method replaces the explicit method, and with which tolerance.
struct TakeOver {
  int looks = 50;  // the method changes when this many checks in a row find steps limited by stability
  // Factor on the tolerance for the implicit method. The explicit method, limited by stability, took a hundred times the steps,
  // so its errors were far below its tolerance; the implicit method's should be as small.
  double tolerance = 0.01;
};

// Returns when an implicit method replaces the explicit one for a device. When a beam closes along the face of a dielectric,
// the gas film makes the equations stiff until the end, so the method changes early. The implicit steps are then limited by
// kinks of the contact pressure, as one point of the beam after the other touches the face, so a tighter tolerance would not
// help.
TakeOver take_over(const Device& device) {
  return device.closes_along_face() && device.gas ? TakeOver{.looks = 2, .tolerance = 1} : TakeOver{};
}

Knot at_rest(const ClosingParts& parts) {
  const Switch& model = parts.model;
  const auto n = static_cast<std::size_t>(model.modes());
  Knot knot{.time = 0,
            .state = std::vector<double>(2 * n + model.film_states(), 0.0),
            .rates = std::vector<double>(n + model.film_states(), 0.0)};
  if (parts.rest) std::copy_n(parts.rest->data(), n, knot.state.begin());
  return knot;
}

}  // namespace

std::optional<Eigen::VectorXd> start_of(const Switch& model, std::span<const Signal> signals, const ClosingOptions& options) {
  if (const std::span<const double> given = options.begins_closed; !given.empty())
    return Eigen::Map<const Eigen::VectorXd>(given.data(), static_cast<Eigen::Index>(given.size()));
  const std::vector<double> before = values_before(signals);
  if (options.start == StartState::open) return model.open_equilibrium(before);
  std::optional<ClosedEquilibrium> closed = closed_equilibrium(model, before);
  return keeps_closed(model, closed) ? std::optional(std::move(closed->q)) : std::nullopt;
}

TrajectoryPoint ClosingParts::point(const FollowedContact& contact, const Knot& knot) const {
  const std::size_t c = contact.number;
  const double *q = knot.state.data(), *v = q + model.modes();
  TrajectoryPoint p{.time = knot.time,
                    .position = model.contact_deflection(q, c),
                    .velocity = model.contact_deflection(v, c),
                    .acceleration = model.contact_deflection(knot.rates.data(), c)};
  if (contact.phase.law().active) {
    p.contact_force = model.contact_push(q, v, contact.phase.law(), c);
  } else if (contact.phase.phase() == Phase::rest) {
    p.contact_force = plate.force();
  }
  return p;
}

void ClosingParts::record(FollowedContact& contact, const TipMotion& tip, const TrajectoryPoint& from,
                          const TrajectoryPoint& to) {
  contact.touches.take(tip, from, to);
  if (contact.touches.count() == 0 || closing_is_over) return;
  if (!contact.phase.in_contact()) contact.force.pass_maximum();
  contact.force.take(tip, from, to, contact.phase.law());
}

double ClosingParts::first_touch() const {
  double first = std::numeric_limits<double>::quiet_NaN();
  for (const FollowedContact& c : contacts)
    if (!model.has_contact() || model.device().contacts[c.number].side == Side::near)
      first = std::fmin(first, c.touches.first_begin());
  return first;
}

Stepping::Stepping(ClosingParts& parts)
    : parts_(parts),
      n_(static_cast<std::size_t>(parts.model.modes())),
      fastest_(parts.model.basis().angular_frequencies().maxCoeff()),
      tolerances_(parts.model, parts.options.tolerance),
      here_(at_rest(parts)),
      next_(here_) {
  const Integrator asked = parts.options.integrator;
  work_.integrator = asked == Integrator::automatic ? automatic_integrator(parts.model) : asked;
  stepper_ = make_stepper(work_.integrator, parts.equations.system(), parts.options.tolerance);
}

bool Stepping::fail(const std::string& why) {
  message_ = why;
  return false;
}

// Tolerances for contact also hold within the reach of a contact law that acts before contact: its force changes over lengths
// as short as a penetration.
const std::vector<double>& Stepping::tolerances() const {
  const bool touching = !parts_.options.restart_at_contact || std::ranges::any_of(parts_.contacts, [](const FollowedContact& c) {
    return c.phase.in_contact() || c.phase.phase() == Phase::near;
  });
  return touching ? tolerances_.touching : tolerances_.in_flight;
}

bool Stepping::restart() {
  parts_.equations.rates(here_);
  if (parts_.first().phase.phase() == Phase::rest) return true;
  const double longest = parts_.drives.resolving_step(here_.time);
  const double first = last_step_ > 0 ? std::min(last_step_, longest) : 0.01 / fastest_;
  return stepper_->restart(here_.time, here_.state.data(), here_.rates.data(), tolerances(), first, longest) ||
         fail(stepper_->message());
}

bool Stepping::check_work() {
  const ClosingOptions& options = parts_.options;
  if (work_.steps < next_look_) return true;
  if (work_.steps >= options.max_steps) return fail(fmt::format("more than {} steps needed", options.max_steps));
  next_look_ = options.max_steps;
  if (options.integrator != Integrator::automatic || work_.integrator != Integrator::lawson) return true;
  const bool stiff = stepper_->stiffness() > held_back && parts_.first().phase.phase() != Phase::rest;
  stiff_looks_ = stiff ? stiff_looks_ + 1 : 0;
  const TakeOver rule = take_over(parts_.model.device());
  if (stiff_looks_ < rule.looks) {
    next_look_ = std::min(next_look_, work_.steps + steps_to_look);
    return true;
  }
  work_.integrator = Integrator::bdf;
  const double tolerance = rule.tolerance * options.tolerance;
  stepper_ = make_stepper(work_.integrator, parts_.equations.system(), tolerance);
  tolerances_ = Tolerances(parts_.model, tolerance);
  return restart();
}

std::optional<Stepping::Step> Stepping::advance(double stop, EnergyAudit& audit) {
  const auto failed = [&](const std::string& why) { return message_ = why, std::nullopt; };
  if (!stepper_->step(stop)) return failed(stepper_->message());
  ++work_.steps;
  take_state();
  if (!std::isfinite(next_.rates[0])) return failed("the computed motion is not finite");
  if (next_.time < stop) last_step_ = next_.time - here_.time;

  consider_step();
  Step step;
  if (!follow(step.event)) return std::nullopt;
  if (step.event) {
    if (!step_again(*step.event)) return std::nullopt;
    consider_step();
    // Remove points of this step's motion that have been added already, if they are later than the event.
    for (FollowedContact& c : parts_.contacts) c.pending_knots.take_back(next_.time, here_.time);
  }
  step.field = parts_.equations.field(next_.state.data());
  account(step.field, audit);
  if (parts_.observer.follows_motion() && next_.time > here_.time) parts_.observer.step(here_, next_, parts_.first().phase.law());
  std::swap(here_.state, next_.state);
  std::swap(here_.rates, next_.rates);
  here_.time = next_.time;
  for (FollowedContact& c : parts_.contacts) c.pending_knots.push(c.end);
  return step;
}

// Copies time, state and rates of the integrator into next_, the end of the step.
void Stepping::take_state() {
  next_.time = stepper_->time();
  std::copy_n(stepper_->state(), next_.state.size(), next_.state.begin());
  std::copy_n(stepper_->rates(), next_.rates.size(), next_.rates.begin());
}

// Sets up the motion of all contacts between here_ and next_, the start and the end of the step.
void Stepping::consider_step() {
  for (FollowedContact& c : parts_.contacts) {
    c.end = parts_.point(c, next_);
    c.motion.set(here_, next_, c.end, !implicit());
  }
}

// Records peak forces, electrical state and energies over the step from here_ to next_; `field` has the gaps at next_.
void Stepping::account(const FieldFigures& field, EnergyAudit& audit) {
  if (here_.time == next_.time) return;
  for (FollowedContact& c : parts_.contacts) {
    const TrajectoryPoint& from = c.pending_knots.last();
    if (c.end.time > from.time) parts_.record(c, TipMotion(c.motion, from, c.end), from, c.end);
    c.touches.take(here_, next_, c.motion);
  }
  if (parts_.follows_state()) {
    std::vector<ContactInStep> contacts;
    for (FollowedContact& c : parts_.contacts)
      contacts.push_back({c.motion, c.pending_knots.last(), c.end, c.phase.law(), c.phase.in_contact()});
    parts_.electrical->take(here_.time, next_.time, contacts);
  }
  audit.step(here_, next_, field.dissipation, parts_.first().motion, implicit());
}

// Returns the point of a contact's motion after k pieces of the step. The force of a contact along a pad depends on more than
// the position of the contact point, so this force is taken as linear in time.
TrajectoryPoint Stepping::knot(FollowedContact& contact, int k) {
  StepMotion& motion = contact.motion;
  if (k == motion.pieces()) return contact.end;
  const ModalMotion::Sample& s = motion.knot(k);
  TrajectoryPoint p{.time = here_.time + (next_.time - here_.time) * k / motion.pieces(),
                    .position = s.position,
                    .velocity = s.velocity,
                    .acceleration = s.acceleration};
  const ContactState& law = contact.phase.law();
  if (parts_.model.has_spread_contact(contact.number)) {
    p.contact_force = force_on_line(contact, p.time);
  } else if (law.active) {
    p.contact_force = contact_force(parts_.model.contact(contact.number), s.position - contact.plane, law, s.velocity);
  }
  return p;
}

double Stepping::force_on_line(const FollowedContact& contact, double time) {
  const TrajectoryPoint &from = contact.pending_knots.last(), &to = contact.end;
  return std::lerp(from.contact_force, to.contact_force, (time - from.time) / (to.time - from.time));
}

// Adds the motion of all contacts from here_ to next_ to their records, up to the first change of a contact law at which the
// integrator must restart. Sets `event` to this change, if there is one. Returns false when the step failed.
bool Stepping::follow(std::optional<Event>& event) {
  const double until = parts_.contacts.size() > 1 ? first_event_time() : next_.time;
  return std::ranges::all_of(parts_.contacts, [&](FollowedContact& c) { return follow(c, until, event); });
}

// Returns the time of the first change of any contact law in the step, or the end of the step. At this time follow() stops: the
// later motion is not valid, since the step is repeated up to this time.
double Stepping::first_event_time() {
  double first = next_.time;
  for (FollowedContact& c : parts_.contacts) {
    TrajectoryPoint from = c.pending_knots.last();
    for (int k = 1; k <= c.motion.pieces() && from.time < first; ++k) {
      const TrajectoryPoint to = knot(c, k);
      if (const auto event = first_event(TipMotion(c.motion, from, to), from, to, c.phase)) {
        first = std::min(first, event->time);
        break;
      }
      from = to;
    }
  }
  return first;
}

// Adds the motion of one contact in the step to its records, with a point at the end of every quintic piece, up to the time
// `until` of the first event of any contact. Sets `event` when this contact's law changes at that time. Returns false when the
// step failed.
bool Stepping::follow(FollowedContact& contact, double until, std::optional<Event>& event) {
  StepMotion& motion = contact.motion;
  for (int k = 1; k <= motion.pieces(); ++k) {
    const TrajectoryPoint from = contact.pending_knots.last(), to = knot(contact, k);
    const TipMotion tip(motion, from, to);
    std::optional<Event> found = first_event(tip, from, to, contact.phase);
    if (found && found->time <= until) {
      if (parts_.options.restart_at_contact || !parts_.model.has_contact()) {
        found->contact = contact.number;
        if (!event) event = found;  // of two events at the same time, the next step handles the second
        return true;
      }
      if (!go_through(contact, *found, tip)) return false;
      if (found->time < to.time) --k;  // next, search the rest of this piece for further changes
    } else if (to.time > until) {
      return true;
    } else if (k < motion.pieces()) {
      parts_.record(contact, tip, from, to);
      contact.pending_knots.push(to);
    }
  }
  return true;
}

// Handles a change of the contact law when the integrator is not restarted at contact (ClosingOptions::restart_at_contact).
// Returns false after too many touches.
bool Stepping::go_through(FollowedContact& contact, const Event& event, const TipMotion& tip) {
  const TrajectoryPoint from = contact.pending_knots.last();
  TrajectoryPoint at{.time = event.time,
                     .position = event.edge->level,
                     .velocity = tip.velocity(event.time),
                     .acceleration = tip.acceleration(event.time)};
  if (parts_.model.has_spread_contact(contact.number)) at.contact_force = force_on_line(contact, at.time);
  if (at.time > from.time) parts_.record(contact, TipMotion(contact.motion, from, at), from, at);
  contact.pending_knots.push(at);
  contact.touches.note(event, at);
  contact.phase.enter(event.edge->next, event.edge->zone);
  contact.end = parts_.point(contact, next_);  // end point with the force of the contact law's new branch
  return contact.touches.count() <= parts_.options.max_steps ||
         fail(fmt::format("more than {} steps needed", parts_.options.max_steps));
}

// Repeats the last step so that it ends at the event (change of a contact law), since an interpolated state is not accurate
// enough. Its velocity would lower the order of accuracy at every touch. Its position may err by more than the interference of
// a stiff contact, so contact would begin or end with a wrong energy. If the repeated step misses the event by little, Taylor's
// series moves its end; otherwise Newton's method corrects the end time.
bool Stepping::step_again(const Event& event) {
  constexpr int most_corrections = 8;
  const Switch& model = parts_.model;
  const double latest = next_.time;
  double time = event.time;
  for (int i = 0; time > here_.time && time <= latest; ++i) {
    if (!stepper_->restart(here_.time, here_.state.data(), here_.rates.data(), tolerances(), time - here_.time,
                           std::numeric_limits<double>::infinity())) {
      return fail(stepper_->message());
    }
    do {
      if (work_.steps >= parts_.options.max_steps) {
        return fail(fmt::format("more than {} steps needed", parts_.options.max_steps));
      }
      if (!stepper_->step(time)) return fail(stepper_->message());
      ++work_.steps;
    } while (stepper_->time() < time);
    take_state();
    if (!event.edge || i == most_corrections || meet(event)) return true;
    const double off = model.contact_deflection(next_.state.data(), event.contact) - event.edge->level;
    if (model.has_contact() && model.rigid_contact() == nullptr &&
        std::abs(contact_energy(model.contact(event.contact), std::abs(off))) <=
            parts_.options.tolerance * model.bending_energy()) {
      return true;
    }
    time -= off / model.contact_deflection(next_.state.data() + n_, event.contact);
  }
  if (!(time > here_.time)) next_ = here_;
  parts_.equations.rates(next_);  // restores the gaps along the beam at next_, for equations.field()
  return true;
}

// Moves the state next_ onto the edge of the event (the position at which the contact law changes) when the fastest mode needs
// less than a thousandth of a radian for this. Returns false when the edge is farther away.
bool Stepping::meet(const Event& event) {
  constexpr double short_of_a_radian = 1e-3;
  const double* v = next_.state.data() + n_;
  const Switch& model = parts_.model;
  double later = (event.edge->level - model.contact_deflection(next_.state.data(), event.contact)) /
                 model.contact_deflection(v, event.contact);
  if (!(std::abs(later) * fastest_ < short_of_a_radian)) return false;
  // Rounding may have put the start of the step beyond the edge: the step must not end before its start.
  later = std::max(later, here_.time - next_.time);
  for (std::size_t i = 0; i < n_; ++i) next_.state[i] += later * (v[i] + later / 2 * next_.rates[i]);
  for (std::size_t i = n_; i < next_.state.size(); ++i) next_.state[i] += later * next_.rates[i - n_];
  next_.time += later;
  return true;
}

}  // namespace softland
