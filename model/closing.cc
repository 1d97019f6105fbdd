#include "model/closing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <vector>

#include "base/engineering.h"
#include "base/require.h"
#include "model/gas/gas_law.h"
#include "model/modal_motion.h"
#include "model/quintic.h"
#include "model/stepper.h"

namespace softland {
namespace {

// Lengths the tolerance is relative to. The touches that follow the first magnify what flight leaves behind, so flight is held
// tighter than the contact gap itself; with these two numbers a tolerance of 1e-6 holds t_i, v_i and B_H of the reference closing
// to four digits (measured: a tenfold change of the second moves the error of B_H by less than a tenth of itself, of the first in
// proportion).
constexpr double flight_fraction = 1.0 / 30;   // of the contact gap
constexpr double penetrations_in_contact = 1;  // of the static interference that bends the beam by the contact gap

// Of the energy that bends the beam by the contact gap: see closing.h.
constexpr double worth_warning = 0.01, not_credible = 0.2;
constexpr double worth_care = 1e-4;  // from there on dissipation is added up with more points

// An explicit method held back by stability in one look after the other gives way to an implicit one. A thick film in a gap that
// is all but closed makes every step one of these. In other closings they come and go, a dozen in a row at the most; but a damped
// contact that rattles has made ninety, so that some such runs go over without need.
constexpr double held_back = 2;  // Stepper::stiffness()
constexpr long steps_to_look = 100;
constexpr int patience = 50;  // looks
// Of the tolerance: where the explicit method took a hundred times the steps, its errors were far below the tolerance.
constexpr double implicit_care = 0.01;

struct Knot {
  double time = 0;
  std::vector<double> state;  // q, v, then the film where it is compressible
  std::vector<double> rates;  // of all but q: q'', then those of the film
};

// Where the contact point stands: above the plane, or in contact. A law without memory is `loading` all through a touch; one with
// memory turns from loading to unloading at its deepest point, and carries nothing in the dent it has left. See contact/memory.h.
// On a rigid contact the plate rests. See contact/rigid.h.
// A law that reaches beyond the plane is `near` before touch. See contact/adhesive_repulsive.h.
enum class Branch { flight, near, loading, unloading, dent, rest };

// An end of a branch: side * (position - level) is positive inside.
struct Edge {
  double level = 0;  // [m]
  double side = 0;
  Branch next = Branch::flight;
  std::size_t zone = 0;  // of the next branch
};

std::vector<double> as_vector(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }

class Run {
 public:
  Run(const Switch& device, std::span<const Signal> drives, const ClosingOptions& options)
      : device_(device),
        drives_(drives),
        options_(options),
        n_(static_cast<std::size_t>(device.modes())),
        film_(device.film_states()),
        size_(2 * n_ + film_),
        work_(device.workspace()),
        rigid_(device.rigid_contact()),
        volts_(drives.size(), 0.0),
        pieces_(drives.size(), 0),
        plane_(device.device().gap.contact),
        tolerance_(options.tolerance),
        fastest_(device.angular_frequencies().maxCoeff()),
        // The quintic between two knots errs by the tolerance times the fastest mode's amplitude, and by 1e-5 of it at the most.
        knot_phase_(std::pow(46080 * std::min(options.tolerance, 1e-5), 1.0 / 6)),
        omega_(padded_to_lanes(as_vector(device.angular_frequencies()), 1)),
        motion_(as_vector(device.angular_frequencies()), as_vector(device.contact_shape())) {
    system_.size = size_;
    system_.frequencies = as_vector(device.angular_frequencies());
    if (film_ > 0) {
      system_.core = 2 * n_;
      system_.block = ReynoldsFilm::nodes;
    }
    if (options.restart_at_contact) {
      system_.rates = [this](double t, const double* y, double* result) { rates(t, y, law_, result); };
      system_.jacobian = [this](double t, const double* y, double* j) { jacobian(t, y, law_, j); };
    } else {
      system_.rates = [this](double t, const double* y, double* result) { rates(t, y, law_at(y), result); };
      system_.jacobian = [this](double t, const double* y, double* j) { jacobian(t, y, law_at(y), j); };
    }
    out_.work.integrator = options.integrator == Integrator::automatic ? automatic_integrator(device) : options.integrator;
    stepper_ = internal::make_stepper(out_.work.integrator, system_);
    here_ = {.time = 0, .state = std::vector<double>(size_, 0.0), .rates = std::vector<double>(n_ + film_, 0.0)};
    if (device.rest()) std::copy_n(device.rest()->data(), n_, here_.state.begin());
    rest_energy_ = device.potential(here_.state.data(), volts_, false, work_);
    next_ = here_;
    middle_ = here_.state;
    free_ = here_.rates;
    set_tolerances();
    reach_ = device.contact_reach();
    remembers_ = device.has_contact() && has_memory(device.contact());
    if (device.has_contact()) kinks_ = contact_kinks(device.contact());
    enter(Branch::flight);
    out_.contact_gap = plane_;
    out_.in_contact_period = device.in_contact_period();
    out_.smallest_gap = device.device().gap.electrode;
  }

  Trajectory run() {
    const auto start = std::chrono::steady_clock::now();
    if (!device_.rest()) {
      end(Status::collapsed_at_rest);
      out_.message = "with every drive at rest the switch has no stable open state: the dispersion force closes it by itself";
      return std::move(out_);
    }
    const std::vector<double> stops = stretches();
    for (std::size_t i = 0; i + 1 < stops.size() && !ended_; ++i) {
      stop_ = stops[i + 1];
      enter_stretch(i == 0);
      while (!ended_ && here_.time < stop_) advance();
    }
    if (!ended_) out_.status = Status::done;
    finish();
    out_.work.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(out_);
  }

 private:
  // ---- the equations
  // -------------------------------------------------------------------------------------------------------------

  void set_volts(double t) {
    for (std::size_t k = 0; k < drives_.size(); ++k) volts_[k] = volts_at(k, t);
  }

  void rates(double t, const double* y, const ContactState& law, double* result) {
    set_volts(t);
    device_.rates(y, volts_, law, work_, result);
    ++out_.work.rhs_evaluations;
  }

  // Takes the integrator's state as next_.
  void take_state() {
    next_.time = stepper_->time();
    std::copy_n(stepper_->state(), size_, next_.state.begin());
    std::copy_n(stepper_->rates(), n_ + film_, next_.rates.begin());
  }

  // Of a contact without memory in any state.
  [[nodiscard]] ContactState law_at(const double* y) const {
    return device_.has_pad_contact() || (device_.has_contact() && device_.contact_deflection(y) > plane_ - reach_);
  }

  void jacobian(double t, const double* y, const ContactState& law, double* j) {
    set_volts(t);
    const auto n = static_cast<Eigen::Index>(n_);
    const auto size = static_cast<Eigen::Index>(size_);
    Eigen::Map<Eigen::MatrixXd> full(j, size, size);
    full.setZero();
    full.block(0, n, n, n).setIdentity();
    device_.jacobian(y, y + n_, volts_, law, work_, full.block(n, 0, n, n), full.block(n, n, n, n));
    if (film_ > 0) device_.add_film_derivatives(y, work_, full);
  }

  // ---- stretches between breakpoints
  // ---------------------------------------------------------------------------------------------

  [[nodiscard]] std::vector<double> stretches() const {
    std::vector<double> stops{0, options_.duration};
    for (const Signal& signal : drives_) {
      for (const double t : signal.breakpoints()) {
        if (t > 0 && t < options_.duration) stops.push_back(t);
      }
    }
    std::sort(stops.begin(), stops.end());
    stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
    return stops;
  }

  void enter_stretch(bool first) {
    const double t = here_.time;
    if (!first) settle_charges(+1);
    for (std::size_t k = 0; k < drives_.size(); ++k) {
      const double before = first ? 0 : volts_at(k, t);
      pieces_[k] = drives_[k].piece_at(t);
      const double after = volts_at(k, t);
      // A jump charges the electrode at fixed deflection: the limit of ever steeper edges.
      if (before != after) {
        const double work =
            (device_.strength(k, after) - device_.strength(k, before)) * device_.law_potential(k, here_.state.data(), work_);
        source_work_ += holds_charge(k) ? -work : work;
      }
    }
    settle_charges(-1);
    restart();
    record(here_);
  }

  [[nodiscard]] double volts_at(std::size_t k, double t) const { return drives_[k].pieces()[pieces_[k]].voltage(t); }

  void set_tolerances() {
    const Eigen::VectorXd& omega = device_.angular_frequencies();
    const Eigen::VectorXd& shape = device_.contact_shape();
    const double largest = shape.cwiseAbs().maxCoeff();
    const auto fill = [&](std::vector<double>& absolute, double length) {
      absolute.resize(size_, film_ > 0 ? tolerance_ * device_.film_scale() : 0);
      for (std::size_t i = 0; i < n_; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        // A mode that hardly moves the contact point still shakes the rest of the beam: count it as if it moved it by a tenth of
        // the others.
        const double amplitude = std::max(std::abs(shape[k]), largest / 10);
        absolute[i] = tolerance_ * length / amplitude;
        absolute[n_ + i] = tolerance_ * flight_fraction * plane_ / amplitude * omega[k];
      }
    };
    fill(in_flight_, flight_fraction * plane_);
    fill(touching_, std::min(flight_fraction * plane_, penetrations_in_contact * device_.penetration_scale()));
  }

  // A law that acts beyond the plane changes over lengths like those of penetration.
  [[nodiscard]] const std::vector<double>& tolerances() const {
    return in_contact_ || branch_ == Branch::near || !options_.restart_at_contact ? touching_ : in_flight_;
  }

  void restart() {
    rates(here_.time, here_.state.data(), law_, here_.rates.data());
    if (branch_ == Branch::rest) return lie_down();
    double max_step = std::numeric_limits<double>::infinity();
    for (const Signal& signal : drives_) max_step = std::min(max_step, signal.resolving_step(here_.time));
    const double first = last_step_ > 0 ? std::min(last_step_, max_step) : 0.01 / device_.angular_frequencies().maxCoeff();
    if (!stepper_->restart(here_.time, here_.state.data(), here_.rates.data(), tolerances(), first, max_step)) {
      fail(stepper_->message());
    }
  }

  // ---- steps and events
  // ----------------------------------------------------------------------------------------------------------

  void advance() {
    if (out_.work.steps >= next_look_) look_at_work();
    if (ended_) return;
    if (branch_ == Branch::rest) return lie_on();
    if (!stepper_->step(stop_)) return fail(stepper_->message());
    ++out_.work.steps;
    take_state();
    if (!std::isfinite(next_.rates[0])) return fail("the motion is no longer finite");
    if (next_.time < stop_) last_step_ = next_.time - here_.time;

    reach();
    const Event event = follow();
    if (event.time > 0) {
      if (!step_again(event)) return;
      reach();
      // The event may have moved before knots on the way to it.
      while (out_.points.back().time >= next_.time && out_.points.back().time > here_.time) out_.points.pop_back();
    }
    const double gap = Switch::smallest_gap(work_);
    account();
    here_.state.swap(next_.state);
    here_.rates.swap(next_.rates);
    here_.time = next_.time;
    out_.points.push_back(end_);
    if (event.time > 0) pass(event);
    out_.smallest_gap = std::min(out_.smallest_gap, gap);
    look_around(gap);
  }

  // Now and then: whether the work is within its bound, and with the right method.
  void look_at_work() {
    if (out_.work.steps >= options_.max_steps) return fail(too_many_steps());
    next_look_ = options_.max_steps;
    if (options_.integrator != Integrator::automatic || out_.work.integrator != Integrator::lawson) return;
    stiff_looks_ = stepper_->stiffness() > held_back && branch_ != Branch::rest ? stiff_looks_ + 1 : 0;
    if (stiff_looks_ < patience) {
      next_look_ = std::min(next_look_, out_.work.steps + steps_to_look);
      return;
    }
    out_.work.integrator = Integrator::bdf;
    stepper_ = internal::make_stepper(out_.work.integrator, system_);
    tolerance_ *= implicit_care;
    set_tolerances();
    restart();
  }

  // After a step.
  void look_around(double gap) {
    if (ended_) return;
    if (gap < device_.gap_floor()) {
      return fail(fmt::format("the beam came within {} of the electrode", engineering(device_.gap_floor(), "m")));
    }
    if (device_.at_far_side(work_)) return fail("the beam came within a hundredth of the gap on its far side");
    if (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) return end(Status::interrupted);
    if (options_.observer && options_.observer(here_.time, here_.state.data(), here_.state.data() + n_)) return end(Status::done);
    measure_landing();
    if (out_.touches.empty() ? here_.time >= options_.no_contact_before
                             : here_.time >= out_.touches.front().begin + options_.after_contact) {
      return end(Status::done);
    }
  }

  void measure_landing() {
    if (!std::isfinite(options_.closed_potential) || std::isfinite(out_.landing_excess) || out_.touches.empty()) return;
    for (std::size_t k = 0; k < drives_.size(); ++k) {
      if (pieces_[k] + 1 < drives_[k].pieces().size()) return;  // a drive is still on its way
    }
    set_volts(here_.time);
    const double* q = here_.state.data();
    out_.landing_excess = device_.kinetic_energy(q + n_) + device_.potential(q, volts_, law_, work_) + impacts_ +
                          device_.film_energy(q, work_) - options_.closed_potential;
  }

  [[nodiscard]] TrajectoryPoint point(const Knot& knot) const {
    const double *q = knot.state.data(), *v = q + n_;
    return {.time = knot.time,
            .position = device_.contact_deflection(q),
            .velocity = device_.contact_deflection(v),
            .acceleration = device_.contact_deflection(knot.rates.data()),
            .contact_force = law_.active               ? device_.contact_push(q, v, law_)
                             : branch_ == Branch::rest ? std::max(0.0, press_)
                                                       : 0};
  }

  // Takes next_ for the end of the step from here_.
  void reach() {
    end_ = point(next_);
    const double phase = fastest_ * (next_.time - here_.time);
    constexpr double rounding = 1e-9;
    moves_by_modes_ = phase <= (1 + rounding) * largest_phase;
    step_pieces_ = moves_by_modes_ ? std::max(1, static_cast<int>(std::ceil(phase / knot_phase_))) : 1;
    motion_known_ = false;
  }

  // The contact point in the step from here_ to next_; of use where moves_by_modes_: not in the long steps of an implicit method.
  const ModalMotion& motion() {
    if (!motion_known_) {
      const double* q = here_.state.data();
      motion_.set(next_.time - here_.time, step_pieces_, q, q + n_, here_.rates.data(),
                  {end_.position, end_.velocity, end_.acceleration});
      motion_known_ = true;
    }
    return motion_;
  }

  // The knot after k pieces of the step; the force along a pad, which more than the contact point decides, is drawn on a line.
  [[nodiscard]] TrajectoryPoint knot(int k) {
    if (k == step_pieces_) return end_;
    const ModalMotion::Sample& s = motion().knot(k);
    const TrajectoryPoint& from = out_.points.back();
    const double time = here_.time + (next_.time - here_.time) * k / step_pieces_;
    const double force = !law_.active ? 0
                         : device_.has_pad_contact()
                             ? std::lerp(from.contact_force, end_.contact_force, (time - from.time) / (end_.time - from.time))
                             : contact_force(device_.contact(), s.position - plane_, law_, s.velocity);
    return {.time = time, .position = s.position, .velocity = s.velocity, .acceleration = s.acceleration, .contact_force = force};
  }

  // The same in a piece of the step, worked out when something happens in it.
  class Tip : public Quintic {
   public:
    Tip(Run& run, const TrajectoryPoint& from, const TrajectoryPoint& to)
        : Quintic(from.time, from.position, from.velocity, from.acceleration, to.time, to.position, to.velocity, to.acceleration),
          run_(run) {}
    [[nodiscard]] double position(double t) const {
      return run_.moves_by_modes_ ? run_.motion().at(t - run_.here_.time).position : Quintic::position(t);
    }
    [[nodiscard]] double velocity(double t) const {
      return run_.moves_by_modes_ ? run_.motion().at(t - run_.here_.time).velocity : Quintic::velocity(t);
    }
    [[nodiscard]] double acceleration(double t) const {
      return run_.moves_by_modes_ ? run_.motion().at(t - run_.here_.time).acceleration : Quintic::acceleration(t);
    }
    [[nodiscard]] double velocity_zero() const {
      return bracketed_zero([&](double t) { return velocity(t); }, begin(), Quintic::end());
    }

   private:
    Run& run_;
  };

  void record(const Knot& knot) { out_.points.push_back(point(knot)); }

  // The contact point passes an edge of its branch, or turns around while it loads a contact with memory (no edge).
  struct Event {
    double time = 0;  // in (from, to]; 0: there is none
    const Edge* edge = nullptr;
  };

  [[nodiscard]] Event next_event(const Tip& tip, const TrajectoryPoint& from, const TrajectoryPoint& to) const {
    Event first;
    for (std::size_t i = 0; i < edge_count_; ++i) {
      const double time = crossing(tip, from, to, edges_[i]);
      if (time > 0 && !(first.time > 0 && first.time <= time)) first = {.time = time, .edge = &edges_[i]};
    }
    if (remembers_ && branch_ == Branch::loading && to.velocity < 0) {
      const double time = from.velocity > 0 ? tip.velocity_zero() : from.time;
      if (!(first.time > 0 && first.time < time)) first = {.time = time};
    }
    return first;
  }

  // Follows the contact point through the step from here_ to next_: knots where the interpolant needs them, up to the first
  // event at which to start anew.
  Event follow() {
    for (int k = 1; k <= step_pieces_; ++k) {
      const TrajectoryPoint from = out_.points.back(), to = knot(k);
      const Tip tip(*this, from, to);
      const Event event = next_event(tip, from, to);
      if (event.time > 0) {
        if (options_.restart_at_contact || !device_.has_contact()) return event;
        go_through(event, tip);
        if (ended_) return {};
        if (event.time < to.time) --k;  // what is left of the piece
      } else if (k < step_pieces_) {
        deepen(tip, from, to);
        out_.points.push_back(to);
      }
    }
    return {};
  }

  // An event at which the integrator is not restarted.
  void go_through(const Event& event, const Tip& tip) {
    const TrajectoryPoint from = out_.points.back();
    TrajectoryPoint at{.time = event.time,
                       .position = event.edge->level,
                       .velocity = tip.velocity(event.time),
                       .acceleration = tip.acceleration(event.time)};
    if (device_.has_pad_contact()) {
      at.contact_force = std::lerp(from.contact_force, end_.contact_force, (at.time - from.time) / (end_.time - from.time));
    }
    if (at.time > from.time) deepen(Tip(*this, from, at), from, at);
    out_.points.push_back(at);
    note(event);
    enter(event.edge->next, event.edge->zone);
    end_ = point(next_);  // on the new branch
    if (static_cast<long>(out_.touches.size()) > options_.max_steps) fail(too_many_steps());
  }

  // Time in [from, to] at which the contact point first crosses an edge outwards; 0 if it does not. Between its turns the motion
  // is monotone, so that no crossing hides between two others.
  [[nodiscard]] static double crossing(const Tip& tip, const TrajectoryPoint& from, const TrajectoryPoint& to, const Edge& edge) {
    const double side = edge.side;
    const Quintic::Bounds reached = tip.bounds();
    if (side > 0 ? reached.least >= edge.level : reached.most <= edge.level) return 0;
    const auto depth = [&](double t) { return side * (tip.position(t) - edge.level); };
    double inside = from.time;
    const auto leaves = [&](double t, double at) {
      if (at >= 0) inside = t;
      return at < 0;
    };
    const auto found = [&](double outside) {
      // A touch without depth is over before it began. Just after an event the motion starts on the edge.
      return depth(inside) > 0 ? bracketed_zero(depth, inside, outside) : inside;
    };
    for (const double turn : tip.turns()) {
      if (leaves(turn, depth(turn))) return found(turn);
    }
    return leaves(to.time, side * (to.position - edge.level)) ? found(to.time) : 0;
  }

  // Repeats the last step so that it ends at the event: interpolated velocities would cost an order of accuracy at every touch.
  // The interpolant's place is off by more than a stiff contact yields, which would then begin or end with energy from nowhere:
  // Taylor's series makes up for it, or where it is off by much Newton's method.
  bool step_again(const Event& event) {
    constexpr int most_corrections = 8;
    const double latest = next_.time;
    double time = event.time;
    for (int i = 0; time > here_.time && time <= latest; ++i) {
      if (!stepper_->restart(here_.time, here_.state.data(), here_.rates.data(), tolerances(), time - here_.time,
                             std::numeric_limits<double>::infinity())) {
        return fail(stepper_->message()), false;
      }
      do {
        if (out_.work.steps >= options_.max_steps) return fail(too_many_steps()), false;
        if (!stepper_->step(time)) return fail(stepper_->message()), false;
        ++out_.work.steps;
      } while (stepper_->time() < time);
      take_state();
      if (event.edge == nullptr || i == most_corrections || meet(*event.edge)) return true;
      const double off = device_.contact_deflection(next_.state.data()) - event.edge->level;
      if (device_.has_contact() && rigid_ == nullptr &&
          std::abs(contact_energy(device_.contact(), std::abs(off))) <= options_.tolerance * device_.bending_energy())
        return true;
      time -= off / device_.contact_deflection(next_.state.data() + n_);
    }
    if (!(time > here_.time)) next_ = here_;
    rates(next_.time, next_.state.data(), law_, next_.rates.data());  // leaves the field there
    return true;
  }

  // Moves next_ onto an edge that is less than a thousandth of a radian away.
  bool meet(const Edge& edge) {
    constexpr double short_of_a_radian = 1e-3;
    const double* v = next_.state.data() + n_;
    double later = (edge.level - device_.contact_deflection(next_.state.data())) / device_.contact_deflection(v);
    if (!(std::abs(later) * fastest_ < short_of_a_radian)) return false;
    later = std::max(later, here_.time - next_.time);  // a step that began beyond the edge, by rounding, ends where it began
    for (std::size_t i = 0; i < n_; ++i) next_.state[i] += later * (v[i] + later / 2 * next_.rates[i]);
    for (std::size_t i = n_; i < size_; ++i) next_.state[i] += later * next_.rates[i - n_];
    next_.time += later;
    return true;
  }

  [[nodiscard]] std::string too_many_steps() const { return fmt::format("more than {} steps needed", options_.max_steps); }

  // At here_: closes the books, records what the event is, and goes on to the next branch.
  void pass(const Event& event) {
    TrajectoryPoint& p = out_.points.back();
    if (event.edge != nullptr) p.position = event.edge->level;  // to rounding
    if (p.position == plane_ && !device_.has_pad_contact()) p.contact_force = 0;
    balance();
    if (note(event)) {
      if (!device_.has_contact()) {
        out_.warnings.push_back("no [contact] section: the run ends at first touch");
        out_.ends_at_touch = true;
        return end(Status::done);
      }
      if (rigid_ != nullptr) return strike();
    }
    if (event.edge == nullptr) {
      // What is left of the velocity still carries it this much deeper.
      deepest_ = p.position - plane_ - (p.acceleration < 0 ? p.velocity * p.velocity / (2 * p.acceleration) : 0);
      dent_ = dent(device_.contact(), deepest_);
      enter(Branch::unloading);
    } else {
      enter(event.edge->next, event.edge->zone);
    }
    restart();
  }

  // Enters an event that the trajectory has just reached in the list of touches; true when one begins.
  bool note(const Event& event) {
    const TrajectoryPoint& p = out_.points.back();
    const bool begins = !in_contact_ && event.edge->level == plane_;
    if (begins) {
      out_.touches.push_back(
          {.begin = p.time, .end = std::numeric_limits<double>::quiet_NaN(), .impact_velocity = std::abs(p.velocity)});
    } else if (in_contact_ && event.edge != nullptr && event.edge->next == above()) {
      out_.touches.back().end = p.time;
    }
    return begins;
  }

  // At here_, on a rigid contact: reverses the velocity, or ends the motion where the rebound would be too low.
  void strike() {
    double* q = here_.state.data();
    double* v = q + n_;
    const double shape = device_.contact_shape()[0];  // a plate has one mode
    Touch& touch = out_.touches.back();
    touch.peak_force = std::numeric_limits<double>::quiet_NaN();
    touch.peak_energy = device_.kinetic_energy(v);
    const double speed = rigid_->restitution * std::max(0.0, v[0] * shape);
    q[0] = plane_ / shape;  // what the event's place is off would add up over many impacts
    v[0] = 0;
    if (RigidContact::rests(speed, press(here_.time) * shape * shape, plane_)) {
      enter(Branch::rest);
    } else {
      v[0] = -speed / shape;
      touch.end = here_.time;
      enter(Branch::flight);
    }
    impacts_ += touch.peak_energy - device_.kinetic_energy(v);
    if (device_.damped()) power_ = device_.dissipated_power(q, v, work_);
    restart();
    record(here_);
  }

  // Force with which the plate would press on a rigid contact at here_ under the voltages of another time [N]; negative: pull.
  double press(double t) {
    rates(t, here_.state.data(), law_, free_.data());
    return free_[0] / device_.contact_shape()[0];
  }

  void lie_down() {
    constexpr double looks = 32;  // at a stretch without sines
    press_ = here_.rates[0] / device_.contact_shape()[0];
    here_.rates[0] = 0;
    rest_step_ = (stop_ - here_.time) / looks;
    for (const Signal& signal : drives_) rest_step_ = std::min(rest_step_, signal.resolving_step(here_.time));
  }

  // The plate rests until its drives stop pressing it on.
  void lie_on() {
    const Edge leaving{.level = plane_, .side = 1, .next = Branch::flight};
    const bool stays = press_ >= 0;
    double t = stays ? std::min(stop_, here_.time + rest_step_) : here_.time, next = press(t);
    if (stays && next < 0) {
      const double last = t;
      t = bracketed_zero([&](double at) { return press(at); }, here_.time, last);
      // On the side where it pulls: the plate must not be found resting at the moment it leaves.
      for (double more = 1e-15 * last; (next = press(t)) >= 0; more *= 2) t = std::min(last, t + more);
    }
    ++out_.work.steps;
    // Nothing moves, so the sources' work is exact.
    for (std::size_t k = 0; k < drives_.size(); ++k) {
      source_work_ += (device_.strength(k, volts_at(k, t)) - device_.strength(k, volts_at(k, here_.time))) *
                      device_.law_potential(k, here_.state.data(), work_);
    }
    here_.time = t;
    press_ = next;
    record(here_);
    if (next < 0) pass({.time = t, .edge = &leaving});
    look_around(Switch::smallest_gap(work_));
  }

  // Where the contact point goes when it leaves the plane.
  [[nodiscard]] Branch above() const { return reach_ > 0 ? Branch::near : Branch::flight; }

  // `zone`: between which kinks of the law, counted from the plane.
  void enter(Branch branch, std::size_t zone = 0) {
    branch_ = branch;
    in_contact_ = branch != Branch::flight && branch != Branch::near;
    if (!in_contact_ && dent_.heals) {
      healed_ += dent_.lost;
      dent_ = {};
      deepest_ = 0;
    }
    law_ = branch == Branch::near || branch == Branch::loading || branch == Branch::unloading || device_.has_pad_contact();
    law_.unloading = branch == Branch::unloading;
    law_.shift = dent_.shift;
    edge_count_ = 1;
    switch (branch) {
      case Branch::rest:
        edge_count_ = 0;
        return;
      case Branch::near:
        edges_ = {Edge{.level = plane_ - reach_, .side = 1, .next = Branch::flight},
                  Edge{.level = plane_, .side = -1, .next = Branch::loading}};
        break;
      case Branch::flight:
        if (reach_ > 0) {
          edges_[0] = {.level = plane_ - reach_, .side = -1, .next = Branch::near};
          return;
        }
        edges_[0] = {.level = plane_, .side = -1, .next = deepest_ > 0 ? Branch::dent : Branch::loading};
        return;
      case Branch::loading:
        edges_[0] = zone == 0 ? Edge{.level = plane_, .side = 1, .next = above()}
                              : Edge{.level = plane_ + kinks_[zone - 1], .side = 1, .next = Branch::loading, .zone = zone - 1};
        if (zone == kinks_.size()) return;
        edges_[1] = {.level = plane_ + kinks_[zone], .side = -1, .next = Branch::loading, .zone = zone + 1};
        break;
      case Branch::unloading:
        edges_ = {Edge{.level = plane_ + dent_.shift, .side = 1, .next = Branch::dent},
                  Edge{.level = plane_ + deepest_, .side = -1, .next = Branch::loading}};
        break;
      case Branch::dent:
        edges_ = {Edge{.level = plane_, .side = 1, .next = Branch::flight},
                  Edge{.level = plane_ + dent_.shift, .side = -1, .next = Branch::unloading}};
        break;
    }
    edge_count_ = 2;
  }

  // Peaks over a piece of a step.
  void deepen(const Tip& tip, const TrajectoryPoint& from, const TrajectoryPoint& to) {
    if (!in_contact_) return;
    const double deepest =
        from.velocity > 0 && to.velocity < 0 ? tip.position(tip.velocity_zero()) : std::max(from.position, to.position);
    const double d = deepest - plane_;
    Touch& touch = out_.touches.back();
    if (law_.active && !device_.has_pad_contact()) {
      touch.peak_force = std::max(touch.peak_force, contact_force(device_.contact(), d, law_, 0));
      touch.peak_energy = std::max(touch.peak_energy, stored_energy(device_.contact(), d, law_));
    }
    out_.deepest_penetration = std::max(out_.deepest_penetration, d);
  }

  // Energies over the step that ends at next_.
  void account() {
    const double t0 = here_.time, t1 = next_.time;
    if (t0 == t1) return;
    const TrajectoryPoint from = out_.points.back();
    if (end_.time > from.time) deepen(Tip(*this, from, end_), from, end_);
    // The peak of a damped contact comes before the deepest point, that along a pad anywhere about it.
    if (in_contact_ && (device_.has_damped_contact() || device_.has_pad_contact())) {
      halve_step();
      const auto peak = [&](double begin, double middle, double end) {
        const double bend = 2 * middle - begin - end;  // of the parabola through the three
        const bool inside = std::abs(end - begin) < 2 * bend;
        return inside ? middle + (end - begin) * (end - begin) / (8 * bend) : std::max({begin, middle, end});
      };
      const auto push = [&](const std::vector<double>& y) { return device_.contact_push(y.data(), y.data() + n_, law_); };
      const auto stored = [&](const std::vector<double>& y) { return device_.contact_stored(y.data(), law_); };
      Touch& touch = out_.touches.back();
      touch.peak_force = std::max(touch.peak_force, peak(push(here_.state), push(middle_), push(next_.state)));
      if (device_.has_pad_contact()) {
        touch.peak_energy = std::max(touch.peak_energy, peak(stored(here_.state), stored(middle_), stored(next_.state)));
      }
    }

    if (device_.damped()) {
      const double* q = next_.state.data();
      // take_state() left the field there
      const double power = device_.dissipated_power(q + n_, work_, film_of(q)) + contact_power(q);
      dissipated_ += (t1 - t0) * mean_power(power);
      power_ = power;
    }
    // The part of the sources' work that a changing voltage adds: see settle_charges().
    for (std::size_t k = 0; k < drives_.size(); ++k) {
      const SignalPiece& piece = drives_[k].pieces()[pieces_[k]];
      if (piece.slope == 0 && piece.amplitude == 0 && piece.amplitude_slope == 0) continue;
      halve_step();
      const auto flow = [&](double t, const std::vector<double>& state) {
        return piece.rate(t) * charge(k, piece.voltage(t), state.data());
      };
      source_work_ -= (t1 - t0) / 6 * (flow(t0, here_.state) + 4 * flow((t0 + t1) / 2, middle_) + flow(t1, next_.state));
    }
  }

  // Dissipated in the step from here_ to next_, where it is `last`: by Simpson's rule, or where its error may have shown by that
  // of Lobatto with four points, over a motion that is exact for the modes. They may turn by two radians, their power by four. A
  // compressible film has no such motion.
  double mean_power(double last) {
    const auto inside = [&] {
      const double* q = middle_.data();
      return device_.dissipated_power(q, q + n_, work_, film_of(q)) + contact_power(q);
    };
    const bool by_modes = careful_ && moves_by_modes_ && film_ == 0 && !is_implicit();
    if (!by_modes) {
      halve_step();
      return (power_ + 4 * inside() + last) / 6;
    }
    const double place = 0.5 - 0.5 / std::sqrt(5.0);
    double sum = 0;
    for (const double share : {place, 1 - place}) {
      move_to(share);
      sum += inside();
    }
    return (power_ + 5 * sum + last) / 12;
  }

  [[nodiscard]] bool is_implicit() const {
    return out_.work.integrator == Integrator::esdirk || out_.work.integrator == Integrator::bdf;
  }

  [[nodiscard]] const double* film_of(const double* y) const { return film_ > 0 ? y + 2 * n_ : nullptr; }

  // Dissipated by the contact law in state y.
  [[nodiscard]] double contact_power(const double* y) const {
    return law_.active && device_.has_damped_contact() ? device_.contact_dissipation(y, y + n_) : 0;
  }

  // Work of the sources over a stretch: integral of V dQ = [V Q] - integral of Q dV, of which this adds the bracket. Who changes
  // a force factor moves no charge: his work is the integral alone.
  void settle_charges(double sign) {
    for (std::size_t k = 0; k < drives_.size(); ++k) {
      const double v = volts_at(k, here_.time);
      if (v != 0 && holds_charge(k)) source_work_ += sign * v * charge(k, v, here_.state.data());
    }
  }

  [[nodiscard]] bool holds_charge(std::size_t k) const { return device_.drive_kind(k) != DriveKind::dispersion; }

  double charge(std::size_t k, double volts, const double* q) { return device_.charge(k, volts, q, work_); }

  // Where the step's Hermite interpolant stands at half time: the quintic, or, where accelerations may be an implicit method's
  // errors times the stiffness, the cubic.
  void halve_step() {
    const double h = next_.time - here_.time;
    const bool cubic = is_implicit();
    for (std::size_t i = 0; i < n_; ++i) {
      const double p0 = here_.state[i], p1 = next_.state[i], v0 = here_.state[n_ + i], v1 = next_.state[n_ + i];
      const double a0 = here_.rates[i], a1 = next_.rates[i];
      if (cubic) {
        middle_[i] = (p0 + p1) / 2 + h / 8 * (v0 - v1);
        middle_[n_ + i] = 3.0 / 2 * (p1 - p0) / h - (v0 + v1) / 4;
        continue;
      }
      middle_[i] = (p0 + p1) / 2 + h * (5.0 / 32 * (v0 - v1) + h / 64 * (a0 + a1));
      middle_[n_ + i] = 15.0 / 8 * (p1 - p0) / h - 7.0 / 16 * (v0 + v1) + h / 32 * (a1 - a0);
    }
    for (std::size_t i = 0; i < film_; ++i) {
      // A film that follows the motion at once has rates that are its error times its stiffness: they may not bend it far.
      const double p0 = here_.state[2 * n_ + i], p1 = next_.state[2 * n_ + i];
      const double far = std::abs(p1 - p0) + std::max(std::abs(p0), std::abs(p1)) / 20;
      middle_[2 * n_ + i] = (p0 + p1) / 2 + std::clamp(h / 8 * (here_.rates[n_ + i] - next_.rates[n_ + i]), -far, far);
    }
  }

  // Where the modes stand after a share of the step: as if the forces on them stayed what they were, and a quintic that makes
  // them right at the end (model/modal_motion.h).
  void move_to(double share) {
    const double h = next_.time - here_.time;
    const double *q = here_.state.data(), *q_end = next_.state.data();
    for (std::size_t b = 0; b < n_; b += lanes) {
      const Lane omega = lane(omega_, b), start = load_lane(q, b, n_), a = load_lane(here_.rates.data(), b, n_);
      const Lane pull = a / (omega * omega), push = load_lane(q + n_, b, n_) / omega;
      const Turn end = turn(omega * h), at = turn(omega * (share * h));
      const auto place = [&](const Turn& t) -> Lane { return start + pull * t.slack + push * t.sine; };
      const auto speed = [&](const Turn& t) -> Lane { return omega * (pull * t.sine + push * t.cosine); };
      const Lane end_acceleration = omega * omega * (pull * end.cosine - push * end.sine);
      const Remainder<Lane> rest(load_lane(q_end, b, n_) - place(end), h * (load_lane(q_end + n_, b, n_) - speed(end)),
                                 h * h * (load_lane(next_.rates.data(), b, n_) - end_acceleration));
      store_lane(place(at) + rest.position(share), middle_.data(), b, n_);
      store_lane(speed(at) + rest.velocity(share) / h, middle_.data() + n_, b, n_);
    }
  }

  // Closes the books at here_. What is stored is the potential and, where a source holds a charge at its voltage, V Q.
  void balance() {
    const double* q = here_.state.data();
    set_volts(here_.time);
    EnergyBalance& e = out_.energy;
    e = {.source_work = source_work_,
         .stored = device_.kinetic_energy(q + n_) + device_.potential(q, volts_, false, work_) - rest_energy_ +
                   device_.film_energy(q, work_),
         .dissipated = dissipated_ + impacts_};
    for (std::size_t k = 0; k < drives_.size(); ++k) {
      if (volts_[k] == 0 || !holds_charge(k)) continue;
      const double work = volts_[k] * charge(k, volts_[k], q);
      e.source_work += work;
      e.stored += work;
    }
    if (law_.active) e.stored += device_.contact_stored(q, law_);
    if (remembers_) {
      const double d = device_.contact_deflection(q) - plane_;
      e.dissipated += healed_ + (branch_ == Branch::loading ? dent(device_.contact(), d) : dent_).lost;
    }
    if (!(std::abs(e.residual()) <= out_.energy_error)) out_.energy_error = std::abs(e.residual());  // keeps what is not a number
    careful_ = careful_ || out_.energy_error > worth_care * device_.bending_energy();
  }

  void end(Status status) {
    ended_ = true;
    out_.status = status;
  }

  void fail(const std::string& why) {
    end(Status::numerical_failure);
    out_.message = fmt::format("at t = {}: {}", engineering(here_.time, "s", 4), why);
  }

  void finish() {
    balance();
    const double error = out_.energy_error / device_.bending_energy();
    if (!(error <= not_credible) && out_.status != Status::numerical_failure) {
      fail(fmt::format("{:.3g} of the bending energy came from nowhere: the tolerance {} is too loose for this closing", error,
                       engineering(options_.tolerance, "")));
    } else if (error > worth_warning) {
      out_.warnings.push_back(fmt::format(
          "energy balance: {:.2g} % of the bending energy came from nowhere: the tolerance {} is too loose for this closing",
          100 * error, engineering(options_.tolerance, "")));
    }
    for (std::string& warning : gas_warnings(device_.device(), out_)) out_.warnings.push_back(std::move(warning));
    if (const auto& contact = device_.device().contact; contact && out_.deepest_penetration > largest_interference(*contact)) {
      out_.warnings.push_back(fmt::format("contact law {}: interference {} exceeds the asperity height {}",
                                          to_string(contact->model), engineering(out_.deepest_penetration, "m", 3),
                                          engineering(largest_interference(*contact), "m", 3)));
    }
  }

  const Switch& device_;
  std::span<const Signal> drives_;
  const ClosingOptions& options_;
  std::size_t n_, film_, size_;  // modes, states of the film, all states
  Switch::Workspace work_;
  const RigidContact* rigid_;  // null: the contact yields
  std::vector<double> volts_;
  std::vector<std::size_t> pieces_;  // the signal piece of each drive in the present stretch
  double plane_;
  internal::OdeSystem system_;
  std::unique_ptr<internal::Stepper> stepper_;
  double tolerance_;
  std::vector<double> in_flight_, touching_;  // absolute tolerances
  double fastest_;                            // angular frequency of the last mode [rad/s]
  double knot_phase_;                         // of the fastest mode between two knots of the trajectory, at the most
  TrajectoryPoint end_;                       // of the step from here_ to next_
  bool moves_by_modes_ = true;                // whether its phase is within what motion() holds for
  int step_pieces_ = 1;                       // between its knots
  std::vector<double> omega_;                 // angular frequencies, in whole lanes [rad/s]
  ModalMotion motion_;
  bool motion_known_ = false;
  Knot here_, next_;
  std::vector<double> middle_;  // state halfway through a step
  double rest_energy_ = 0;      // potential at the start [J]
  double source_work_ = 0;      // without the charges that stand on the drives now [J]
  double dissipated_ = 0;       // [J]
  double power_ = 0;            // dissipated at here_ [W]
  bool careful_ = false;        // with dissipated_
  double reach_ = 0;            // how far above the plane the contact acts [m]
  std::vector<double> kinks_;   // interferences at which the contact law is not smooth [m]
  bool remembers_ = false;      // the contact law has memory
  Branch branch_ = Branch::flight;
  bool in_contact_ = false;  // not in flight
  ContactState law_;
  std::array<Edge, 2> edges_;
  std::size_t edge_count_ = 0;
  double deepest_ = 0;        // interference that the contact remembers [m]
  Dent dent_;                 // what it has left
  double impacts_ = 0;        // energy lost in impacts on a rigid contact [J]
  double press_ = 0;          // force on a rigid contact at rest [N]
  double rest_step_ = 0;      // [s]
  std::vector<double> free_;  // accelerations without contact
  double healed_ = 0;         // energy lost to dents that are forgotten [J]
  bool ended_ = false;
  long next_look_ = 0;  // at work, in steps
  int stiff_looks_ = 0;
  double stop_ = 0;
  double last_step_ = 0;
  Trajectory out_;
};

}  // namespace

std::string_view to_string(Integrator integrator) {
  switch (integrator) {
    case Integrator::automatic:
      return "automatic";
    case Integrator::lawson:
      return "lawson";
    case Integrator::arkode_erk:
      return "arkode-erk";
    case Integrator::esdirk:
      return "esdirk";
    case Integrator::bdf:
      return "bdf";
    case Integrator::adams:
      return "adams";
  }
  return "unknown";
}

Integrator automatic_integrator(const Switch& device) {
  return device.film_states() > 0 ? Integrator::esdirk : Integrator::lawson;
}

std::string why_always_restarted(const Switch& device) {
  if (device.rigid_contact() != nullptr) return "an impact on a rigid contact is no force";
  if (device.has_contact() && has_memory(device.contact())) return "a contact law with memory turns at the deepest point";
  return {};
}

Trajectory simulate_closing(const Switch& device, std::span<const Signal> drives, const ClosingOptions& options) {
  require(drives.size() == device.drives(),
          fmt::format("{} signals for a switch with {} drives", drives.size(), device.drives()));
  require(options.duration > 0 && options.duration < 1e6,
          fmt::format("duration = {} s: must be greater than 0 s and below 1e6 s", options.duration));
  require(options.tolerance > 0 && options.tolerance <= 0.1,
          fmt::format("tolerance = {}: must be in (0, 0.1]", options.tolerance));
  require(options.restart_at_contact || why_always_restarted(device).empty(),
          fmt::format("restart_at_contact = false: {}", why_always_restarted(device)));
  return Run(device, drives, options).run();
}

}  // namespace softland
