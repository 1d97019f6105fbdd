#include "model/closing.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "base/engineering.h"
#include "base/require.h"
#include "model/closing/stepping.h"
#include "model/contact/contact_law.h"
#include "model/gas/gas_law.h"
#include "model/piezo_layer.h"

namespace softland {
namespace {

// Residuals of the energy audit above which a run has a warning, and above which it fails, as shares of the energy that bends
// the beam by the contact gap.
constexpr double worth_warning = 0.01, not_credible = 0.2;

class ClosingRun {
 public:
  ClosingRun(const Switch& model, std::span<const Signal> signals, const ClosingOptions& options, ClosingObserver& observer)
      : model_(model),
        options_(options),
        signals_(signals),
        plane_(model.contact_gap()),
        parts_(model, signals, options, observer),
        stepping_(parts_),
        audit_(model, parts_.drives, parts_.phases, parts_.equations, stepping_.here()) {
    out_.contact_gap = plane_;
    out_.in_contact_period = model.basis().in_contact_period();
    out_.smallest_gap = model.device().gap.electrode;
  }

  Trajectory run() {
    const auto begin = std::chrono::steady_clock::now();
    if (parts_.rest) {
      out_.began_closed = begins_closed(options_) && parts_.phases.in_contact();
      go_through_stretches();
      finish();
    } else {
      end(Status::collapsed_at_rest);
      say_why_no_start();
    }
    out_.work = stepping_.work();
    out_.work.rhs_evaluations = parts_.equations.evaluations();
    out_.work.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(out_);
  }

 private:
  void say_why_no_start() {
    const bool asked_open = options_.start == StartState::open;
    ClosingOptions other = options_;
    other.start = asked_open ? StartState::closed : StartState::open;
    if (const auto found = start_of(model_, signals_, other)) out_.other_start = model_.contact_deflection(found->data());
    if (!asked_open) {
      out_.message = "the switch has no stable closed state under the drives' values before t = 0, in which it should begin";
    } else if (model_.rest()) {
      out_.message = "the switch has no stable open state under the drives' values before t = 0: they close it";
    } else {
      const bool has_dispersion = model_.device().dispersion.has_value(), is_charged = model_.device().is_charged();
      out_.message = fmt::format("the switch has no stable open state with all drives at 0: {}",
                                 has_dispersion && is_charged ? "the dispersion force and the charge on a dielectric close it"
                                 : is_charged                 ? "the charge on a dielectric closes it by itself"
                                                              : "the dispersion force closes it by itself");
    }
  }

  void go_through_stretches() {
    const std::vector<double> stops = parts_.drives.stretches(options_.duration, options_.opens_at);
    for (std::size_t i = 0; i + 1 < stops.size() && !ended_; ++i) {
      stop_ = stops[i + 1];
      if (stops[i] >= options_.opens_at) parts_.end_closing(stops[i]);
      if (i > 0 && parts_.observer.takes_energies()) {
        audit_.settle(here());
        parts_.observer.energies(stops[i], audit_.balance());
      }
      audit_.enter_stretch(here(), i == 0);
      restart();
      parts_.push(here());
      parts_.hand_over();
      measure_landing();
      while (!ended_ && here().time < stop_) advance();
    }
    if (!ended_) out_.status = Status::done;
  }

  [[nodiscard]] Knot& here() { return stepping_.here(); }

  void restart() {
    if (!stepping_.restart()) return fail(stepping_.message());
    if (parts_.first().phase.phase() == Phase::rest) parts_.plate.begin(here(), stop_);
  }

  void advance() {
    if (!stepping_.check_work()) return fail(stepping_.message());
    if (parts_.first().phase.phase() == Phase::rest) return stay();
    const std::optional<Stepping::Step> step = stepping_.advance(stop_, audit_);
    if (!step) return fail(stepping_.message());
    if (step->event) on_event(*step->event);
    parts_.hand_over();
    out_.smallest_gap = std::min(out_.smallest_gap, step->field.smallest_gap);
    check_interval(step->field);
  }

  // Handles an event of a contact, such as touch or separation: computes the energies, records the event, and selects the
  // branch of the contact law that acts next.
  void on_event(const Event& event) {
    FollowedContact& c = parts_.contacts[event.contact];
    TrajectoryPoint& p = c.pending_knots.last_waiting();
    // Set the position of the contact point to that of the event, from which the computed position differs by rounding.
    if (event.edge) p.position = event.edge->level;
    if (p.position == c.plane && !model_.has_spread_contact(event.contact)) p.contact_force = 0;
    audit_.settle(here());
    if (c.touches.note(event, p)) {
      if (!model_.has_contact()) {
        out_.warnings.emplace_back("no [contact] section: the run ends at first touch");
        out_.ends_at_touch = true;
        return end(Status::done);
      }
      if (model_.rigid_contact() != nullptr) return strike();
    }
    PhaseChange change{.before = c.phase.law(), .after = {}};
    if (event.edge) {
      change.kind = c.phase.phase() == Phase::rest ? PhaseChange::Kind::leaves : PhaseChange::Kind::edge;
      change.level = event.edge->level;
      c.phase.enter(event.edge->next, event.edge->zone);
    } else {
      change.kind = PhaseChange::Kind::turn;
      // The contact law changes to unloading, which depends on the deepest interference. The event comes slightly before the
      // contact point is at rest, so the remaining distance is added, at constant acceleration.
      c.phase.turn(p.position - c.plane - (p.acceleration < 0 ? p.velocity * p.velocity / (2 * p.acceleration) : 0));
    }
    change.after = c.phase.law();
    if (event.contact == 0) parts_.observer.on_phase(here(), change);
    restart();
  }

  // Handles an impact on a rigid contact: reverses the velocity and multiplies it by the coefficient of restitution, or brings
  // the plate to rest when the rebound would be too low.
  void strike() {
    const RestingPlate::Impact impact = parts_.plate.strike(here());
    Touch& touch = parts_.first().touches.last();
    touch.peak_force = std::numeric_limits<double>::quiet_NaN();
    touch.peak_energy = impact.energy;
    parts_.first().force.pass_maximum();
    if (!impact.rests) parts_.first().touches.end(here().time);
    parts_.observer.on_phase(here(), {.kind = impact.rests ? PhaseChange::Kind::rests : PhaseChange::Kind::impact,
                                      .level = plane_,
                                      .before = parts_.first().phase.law(),
                                      .after = {}});
    parts_.first().phase.enter(impact.rests ? Phase::rest : Phase::flight);
    audit_.impact(impact.lost, model_.damped() ? parts_.equations.dissipation(here().state.data()) : 0);
    restart();
    parts_.push(here());
  }

  // Simulates a rigid plate at rest on its rigid contact until the drives no longer press the plate on the contact.
  void stay() {
    const RestingPlate::Stay stay = parts_.plate.stay(here(), stop_);
    stepping_.count_step();
    audit_.rest(here(), stay.until);
    here().time = stay.until;
    const FieldFigures field = parts_.equations.field(here().state.data());
    const TrajectoryPoint before = parts_.first().pending_knots.last(), now = parts_.point(parts_.first(), here());
    if (now.time > before.time && !parts_.closing_is_over) parts_.first().force.take_line(before, now);
    if (parts_.follows_state())
      parts_.electrical->take_rest(before.time, now.time, [&](double t) { return parts_.plate.load(here(), t); });
    parts_.first().pending_knots.push(now);
    if (stay.leaves) on_event({.time = stay.until, .edge = Edge{.level = plane_, .side = 1, .next = Phase::flight}});
    parts_.hand_over();
    check_interval(field);
  }

  // Returns true when the beam is below the smallest valid gap (Switch::gap_floor()) at a point over an electrode, so that the
  // run fails. A beam that closes on a dielectric's face may swing lower beside the electrodes, where nothing stops it. For all
  // other devices the gap is too small wherever it occurs.
  [[nodiscard]] bool is_over_electrode() {
    const Device& device = model_.device();
    if (!device.closes_along_face() || device.structure.is_rigid()) return true;
    GapField field = model_.workspace().field;
    const double* q = here().state.data();
    model_.quadrature().set_field(q, q + model_.modes(), field);
    const Eigen::ArrayXd& positions = model_.quadrature().positions();
    for (const Electrode& e : device.electrodes) {
      for (const Stretch& pad : e.pads(device.structure.length)) {
        for (Eigen::Index p = 0; p < positions.size(); ++p)
          if (pad.begin <= positions[p] && positions[p] <= pad.end && field.gap[p] < model_.gap_floor()) return true;
      }
    }
    return false;
  }

  // Ends the run after a step when the switch has failed, or an option requires the end; `field` describes the gap between beam
  // and electrodes at the end of the step.
  void check_interval(const FieldFigures& field) {
    if (ended_) return;
    if (field.smallest_gap < model_.gap_floor() && is_over_electrode()) {
      const Device& device = model_.device();
      const double floor = model_.gap_floor();
      if (floor < 0)
        return collapse(fmt::format("the {} sank {} into the dielectric on the electrode",
                                    device.structure.is_rigid() ? "plate" : "beam", engineering(-floor, "m", 4)));
      return collapse(fmt::format("the beam came within {} of {}electrode", engineering(floor, "m"),
                                  device.dielectric_depth() > 0 ? "the dielectric on the " : "the "));
    }
    if (field.at_far_side) return collapse("the beam came within a hundredth of the gap on its far side");
    if (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) return end(Status::interrupted);
    const Knot& now = here();
    if (options_.observer && options_.observer(now.time, now.state.data(), now.state.data() + model_.modes())) {
      return end(Status::done);
    }
    measure_landing();
    const double over = parts_.has_touched() ? std::max(parts_.first_touch() + options_.after_contact, options_.no_end_before)
                                             : options_.no_contact_before;
    if (now.time >= over) {
      return end(Status::done);
    }
  }

  // Computes Trajectory::landing_excess at the first touch or, if that is later, when the drives reach their hold levels.
  void measure_landing() {
    if (ended_ || !parts_.has_touched() || std::isfinite(out_.landing_excess)) return;
    if (!std::isfinite(options_.closed_potential) || !parts_.drives.at_hold()) return;
    out_.landing_excess = audit_.above_rest(here()) - options_.closed_potential;
  }

  void end(Status status) {
    ended_ = true;
    out_.status = status;
  }

  void collapse(const std::string& where) {
    out_.collapse_time = here().time;
    fail(where);
    out_.status = Status::collapsed_onto_electrode;
  }

  void fail(const std::string& why) {
    end(Status::numerical_failure);
    out_.message = fmt::format("at t = {}: {}", engineering(here().time, "s", 4), why);
  }

  void finish() {
    parts_.hand_over();
    for (FollowedContact& c : parts_.contacts) c.touches.finish();
    audit_.settle(here());
    out_.energy = audit_.balance();
    out_.energy_error = audit_.error();
    out_.layer_energy = layer_charging_energy(model_.device(), signals_, here().time);
    gather_contacts();
    const double error = out_.energy_error / model_.bending_energy();
    if (!(error <= not_credible) && out_.status != Status::numerical_failure) {
      fail(fmt::format(
          "the residual of the energy balance is {:.3g} of the bending energy: the tolerance {} is too loose for this closing",
          error, engineering(options_.tolerance, "")));
    } else if (error > worth_warning) {
      out_.warnings.push_back(fmt::format(
          "energy balance: the residual is {:.2g} % of the bending energy: the tolerance {} is too loose for this closing",
          100 * error, engineering(options_.tolerance, "")));
    }
    for (std::string& warning :
         gas_warnings(model_.device(), out_.smallest_gap, parts_.first().pending_knots.largest_squeeze())) {
      out_.warnings.push_back(std::move(warning));
    }
    for (std::size_t c = 0; c < model_.contacts(); ++c) {
      const Contact& contact = model_.device().contacts[c];
      const double deepest = parts_.contacts[c].touches.deepest_penetration();
      if (!(deepest > largest_interference(contact.model))) continue;
      out_.warnings.push_back(fmt::format("contact law {}{}: interference {} exceeds the asperity height {}",
                                          name_of(contact.model), contact.name.empty() ? "" : " of contact." + contact.name,
                                          engineering(deepest, "m", 3),
                                          engineering(largest_interference(contact.model), "m", 3)));
    }
  }

  // Collects the outcomes of the contacts and, if there are several, of the connection that they make.
  void gather_contacts() {
    if (parts_.electrical) {
      if (!parts_.closing_is_over) parts_.electrical->finish(here().time);
      out_.electrical = parts_.electrical->connection();
    }
    std::vector<ForceOutcome> forces;
    for (const FollowedContact& c : parts_.contacts) {
      ContactOutcome own{.name = model_.has_contact() ? model_.device().contacts[c.number].name : std::string(),
                         .gap = c.plane,
                         .deepest_penetration = c.touches.deepest_penetration()};
      if (c.touches.count() > 0) own.force = c.force.outcome();
      forces.push_back(own.force);
      if (parts_.electrical) own.electrical = parts_.electrical->contact(c.number);
      out_.deepest_penetration = std::max(out_.deepest_penetration, own.deepest_penetration);
      if (parts_.connection) out_.contacts.push_back(std::move(own));
    }
    out_.force = force_of_connection(model_.device(), forces);
    if (!parts_.connection) return;
    parts_.connection->finish();
    out_.first_touch = parts_.connection->first_touch();
  }

  const Switch& model_;
  const ClosingOptions& options_;
  std::span<const Signal> signals_;
  double plane_;  // position of the contact plane (plane of first touch) [m]
  ClosingParts parts_;
  Stepping stepping_;
  EnergyAudit audit_;
  double stop_ = 0;  // end of the interval between two waveform breakpoints that is being integrated [s]
  bool ended_ = false;
  Trajectory out_;
};

class Recorder final : public ClosingObserver {
 public:
  void knot(const TrajectoryPoint& p) override { points.push_back(p); }
  void touch(const Touch& t) override { touches.push_back(t); }

  std::vector<TrajectoryPoint> points;
  std::vector<Touch> touches;
};

}  // namespace

Integrator automatic_integrator(const Switch& model) { return model.film_states() > 0 ? Integrator::esdirk : Integrator::lawson; }

std::string why_always_restarted(const Switch& model) {
  if (model.rigid_contact() != nullptr) return "an impact on a rigid contact has no contact force";
  if (model.contacts() > 1) return "there are several contacts";
  if (model.has_contact() && has_memory(model.contact())) return "a contact law with memory turns at the deepest point";
  return {};
}

Trajectory observe_closing(const Switch& model, std::span<const Signal> drives, const ClosingOptions& options,
                           ClosingObserver& observer) {
  require(drives.size() == model.drives(),
          fmt::format("{} signals are given; a switch with {} drives needs one per drive", drives.size(), model.drives()));
  require(options.duration > 0 && options.duration < 1e6,
          fmt::format("duration = {} s: must be greater than 0 s and below 1e6 s", options.duration));
  require(options.tolerance > 0 && options.tolerance <= 0.1,
          fmt::format("tolerance = {}: must be in (0, 0.1]", options.tolerance));
  require(options.begins_closed.empty() ||
              (model.has_contact() && options.begins_closed.size() == static_cast<std::size_t>(model.modes())),
          fmt::format("begins_closed: {} coordinates are given; a closed start needs one per mode and a contact, and the switch "
                      "has {} modes and {} contact",
                      options.begins_closed.size(), model.modes(), model.has_contact() ? "a" : "no"));
  require(options.start == StartState::open || model.has_contact(), "start = closed: the switch has no contact to begin on");
  require(options.restart_at_contact || why_always_restarted(model).empty(),
          fmt::format("restart_at_contact = false: {}", why_always_restarted(model)));
  return ClosingRun(model, drives, options, observer).run();
}

Trajectory simulate_closing(const Switch& model, std::span<const Signal> drives, const ClosingOptions& options) {
  Recorder recorder;
  Trajectory t = observe_closing(model, drives, options, recorder);
  t.points = std::move(recorder.points);
  t.touches = std::move(recorder.touches);
  return t;
}

double first_closing(const Switch& model, std::span<const Signal> drives, ClosingOptions options) {
  Recorder recorder;
  const bool is_connection = model.contacts() > 1;
  // The connection of several contacts may close after the first touch of one of them.
  options.after_contact = is_connection ? std::numeric_limits<double>::infinity() : 0;
  options.observer = [&](double, const double*, const double*) {
    constexpr double on_the_plane = 1e-12;  // separation at which the connection is closed, relative to the contact gap
    return is_connection && recorder.points.back().position >= (1 - on_the_plane) * model.contact_gap();
  };
  static_cast<void>(observe_closing(model, drives, options, recorder));
  return recorder.touches.empty() ? std::numeric_limits<double>::quiet_NaN() : recorder.touches.front().begin;
}

}  // namespace softland
