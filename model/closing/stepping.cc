#include "model/closing/stepping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "model/pull_in.h"

namespace softland {
namespace {

// An explicit method held back by stability in one look after the other gives way to an implicit one. A thick film in a gap that
// is all but closed makes every step one of these. In other closings they come and go, a dozen in a row at the most; but a damped
// contact that rattles may show ninety in a row, so that some such runs go over without need.
constexpr double held_back = 2;  // Stepper::stiffness()
constexpr long steps_to_look = 100;
constexpr int patience = 50;  // looks
// Of the tolerance: where the explicit method took a hundred times the steps, its errors were far below the tolerance.
constexpr double implicit_care = 0.01;

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

TrajectoryPoint ClosingParts::point(const Knot& knot) const {
  const double *q = knot.state.data(), *v = q + model.modes();
  TrajectoryPoint p{.time = knot.time,
                    .position = model.contact_deflection(q),
                    .velocity = model.contact_deflection(v),
                    .acceleration = model.contact_deflection(knot.rates.data())};
  if (phase.law().active) {
    p.contact_force = model.contact_push(q, v, phase.law());
  } else if (phase.phase() == Phase::rest) {
    p.contact_force = plate.force();
  }
  return p;
}

void ClosingParts::record(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to) {
  touches.take(tip, from, to);
  if (touches.count() == 0) return;
  if (!phase.in_contact()) force.pass_maximum();
  force.take(tip, from, to, phase.law());
}

Stepping::Stepping(ClosingParts& parts)
    : parts_(parts),
      n_(static_cast<std::size_t>(parts.model.modes())),
      plane_(parts.model.contact_gap()),
      fastest_(parts.model.basis().angular_frequencies().maxCoeff()),
      tolerances_(parts.model, parts.options.tolerance),
      motion_(parts.model, parts.options.tolerance),
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

// A law that acts beyond the plane changes over lengths like those of penetration.
const std::vector<double>& Stepping::tolerances() const {
  const bool touching = parts_.phase.in_contact() || parts_.phase.phase() == Phase::near || !parts_.options.restart_at_contact;
  return touching ? tolerances_.touching : tolerances_.in_flight;
}

bool Stepping::restart() {
  parts_.equations.rates(here_);
  if (parts_.phase.phase() == Phase::rest) return true;
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
  const bool stiff = stepper_->stiffness() > held_back && parts_.phase.phase() != Phase::rest;
  stiff_looks_ = stiff ? stiff_looks_ + 1 : 0;
  if (stiff_looks_ < patience) {
    next_look_ = std::min(next_look_, work_.steps + steps_to_look);
    return true;
  }
  work_.integrator = Integrator::bdf;
  const double tolerance = implicit_care * options.tolerance;
  stepper_ = make_stepper(work_.integrator, parts_.equations.system(), tolerance);
  tolerances_ = Tolerances(parts_.model, tolerance);
  return restart();
}

std::optional<Stepping::Step> Stepping::advance(double stop, EnergyAudit& audit) {
  const auto failed = [&](const std::string& why) { return message_ = why, std::nullopt; };
  if (!stepper_->step(stop)) return failed(stepper_->message());
  ++work_.steps;
  take_state();
  if (!std::isfinite(next_.rates[0])) return failed("the motion is no longer finite");
  if (next_.time < stop) last_step_ = next_.time - here_.time;

  consider_step();
  Step step;
  if (!follow(step.event)) return std::nullopt;
  if (step.event) {
    if (!step_again(*step.event)) return std::nullopt;
    consider_step();
    parts_.course.take_back(next_.time, here_.time);  // the event may have moved before knots on the way to it
  }
  step.field = parts_.equations.field(next_.state.data());
  account(step.field, audit);
  if (parts_.observer.follows_motion() && next_.time > here_.time) parts_.observer.step(here_, next_, parts_.phase.law());
  std::swap(here_.state, next_.state);
  std::swap(here_.rates, next_.rates);
  here_.time = next_.time;
  parts_.course.push(end_);
  return step;
}

// Takes the integrator's state as next_.
void Stepping::take_state() {
  next_.time = stepper_->time();
  std::copy_n(stepper_->state(), next_.state.size(), next_.state.begin());
  std::copy_n(stepper_->rates(), next_.rates.size(), next_.rates.begin());
}

// Takes next_ for the end of the step from here_.
void Stepping::consider_step() {
  end_ = parts_.point(next_);
  motion_.set(here_, next_, end_, !implicit());
}

// Peaks and energies over the step from here_ to next_, in whose field these figures were found.
void Stepping::account(const FieldFigures& field, EnergyAudit& audit) {
  if (here_.time == next_.time) return;
  const TrajectoryPoint& from = parts_.course.last();
  if (end_.time > from.time) parts_.record(TipMotion(motion_, from, end_), from, end_);
  parts_.touches.take(here_, next_, motion_);
  audit.step(here_, next_, field.dissipation, motion_, implicit());
}

// The knot after k pieces of the step. The force along a pad, which more than the contact point decides, is drawn on a line.
TrajectoryPoint Stepping::knot(int k) {
  if (k == motion_.pieces()) return end_;
  const ModalMotion::Sample& s = motion_.knot(k);
  TrajectoryPoint p{.time = here_.time + (next_.time - here_.time) * k / motion_.pieces(),
                    .position = s.position,
                    .velocity = s.velocity,
                    .acceleration = s.acceleration};
  const ContactState& law = parts_.phase.law();
  if (parts_.model.has_pad_contact()) {
    p.contact_force = force_on_line(p.time);
  } else if (law.active) {
    p.contact_force = contact_force(parts_.model.contact(), s.position - plane_, law, s.velocity);
  }
  return p;
}

double Stepping::force_on_line(double time) const {
  const TrajectoryPoint& from = parts_.course.last();
  return std::lerp(from.contact_force, end_.contact_force, (time - from.time) / (end_.time - from.time));
}

// Follows the contact point through the step from here_ to next_: knots where the interpolant needs them, up to the first event
// at which to start anew. False: failed.
bool Stepping::follow(std::optional<Event>& event) {
  for (int k = 1; k <= motion_.pieces(); ++k) {
    const TrajectoryPoint from = parts_.course.last(), to = knot(k);
    const TipMotion tip(motion_, from, to);
    event = first_event(tip, from, to, parts_.phase);
    if (event) {
      if (parts_.options.restart_at_contact || !parts_.model.has_contact()) return true;
      if (!go_through(*event, tip)) return false;
      if (event->time < to.time) --k;  // what is left of the piece
      event.reset();
    } else if (k < motion_.pieces()) {
      parts_.record(tip, from, to);
      parts_.course.push(to);
    }
  }
  return true;
}

// An event at which the integrator is not restarted. False: there are too many.
bool Stepping::go_through(const Event& event, const TipMotion& tip) {
  const TrajectoryPoint from = parts_.course.last();
  TrajectoryPoint at{.time = event.time,
                     .position = event.edge->level,
                     .velocity = tip.velocity(event.time),
                     .acceleration = tip.acceleration(event.time)};
  if (parts_.model.has_pad_contact()) at.contact_force = force_on_line(at.time);
  if (at.time > from.time) parts_.record(TipMotion(motion_, from, at), from, at);
  parts_.course.push(at);
  parts_.touches.note(event, at);
  parts_.phase.enter(event.edge->next, event.edge->zone);
  end_ = parts_.point(next_);  // in the new phase
  return parts_.touches.count() <= parts_.options.max_steps ||
         fail(fmt::format("more than {} steps needed", parts_.options.max_steps));
}

// Repeats the last step so that it ends at the event: interpolated velocities would cost an order of accuracy at every touch. The
// interpolant's place is off by more than a stiff contact yields, which would begin or end with an error of energy: Taylor's
// series makes up for it, or where it is off by much Newton's method.
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
    if (!event.edge || i == most_corrections || meet(*event.edge)) return true;
    const double off = model.contact_deflection(next_.state.data()) - event.edge->level;
    if (model.has_contact() && model.rigid_contact() == nullptr &&
        std::abs(contact_energy(model.contact(), std::abs(off))) <= parts_.options.tolerance * model.bending_energy()) {
      return true;
    }
    time -= off / model.contact_deflection(next_.state.data() + n_);
  }
  if (!(time > here_.time)) next_ = here_;
  parts_.equations.rates(next_);  // so that the field belongs to next_ again
  return true;
}

// Moves next_ onto an edge that is less than a thousandth of a radian away.
bool Stepping::meet(const Edge& edge) {
  constexpr double short_of_a_radian = 1e-3;
  const double* v = next_.state.data() + n_;
  double later = (edge.level - parts_.model.contact_deflection(next_.state.data())) / parts_.model.contact_deflection(v);
  if (!(std::abs(later) * fastest_ < short_of_a_radian)) return false;
  later = std::max(later, here_.time - next_.time);  // a step that began beyond the edge, by rounding, ends where it began
  for (std::size_t i = 0; i < n_; ++i) next_.state[i] += later * (v[i] + later / 2 * next_.rates[i]);
  for (std::size_t i = n_; i < next_.state.size(); ++i) next_.state[i] += later * next_.rates[i - n_];
  next_.time += later;
  return true;
}

}  // namespace softland
