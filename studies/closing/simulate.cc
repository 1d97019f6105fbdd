#include "studies/closing/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/engineering.h"
#include "model/contact/resistance.h"
#include "objectives/course_recorder.h"
#include "studies/closing/actuator.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/closing_progress.h"
#include "studies/closing/open_state.h"
#include "studies/closing/summits_at_hold.h"

namespace softland {
namespace {

// What two runs of one closing differ by, and the rounding that they share. t_p, t_b and N_B are left to clouds.
FigureValues difference(const Metrics& a, const Metrics& b, double tolerance, double contact_gap) {
  constexpr double shared = 0.01;              // of the tolerance, relative to a figure
  constexpr double lowest_separation = 1e-12;  // of the contact gap, below which metrics() sees no rebound
  FigureValues d;
  for (const Figure& figure : all_figures) {
    if (!figure.is_told_by_two_runs()) continue;
    const double own = figure.value(a);
    d[figure] = std::max(std::abs(own - figure.value(b)), shared * tolerance * std::abs(own));
  }
  // A rebound that neither run has lasts for no time that could be wrong.
  if (a.first_rebound_time == 0 && b.first_rebound_time == 0) d[&Metrics::first_rebound_time] = Metrics::unset;
  double& height = d[&Metrics::major_bounce_height];
  height = std::max(height, lowest_separation * contact_gap);
  double& force = d[&Metrics::least_force_after_touch];
  force = std::max(force, shared * tolerance * a.hold_force);
  return d;
}

struct Run {
  Trajectory trajectory;
  Metrics metrics;
  std::vector<Rebound> rebounds;
  std::vector<ContactClosing> contacts = {};
  bool is_thinned = false;
  double tolerance = 0;
  SwitchOptions quadrature;
};

// Where two runs part: the first rebound above a height whose heights differ by a tenth. Infinite where they do not.
double parting_time(const Run& a, const Run& b, double lowest) {
  constexpr double parted = 0.1;
  const std::vector<Rebound>&one = a.rebounds, &two = b.rebounds;
  for (std::size_t k = 0; k < std::max(one.size(), two.size()); ++k) {
    const double own = k < one.size() ? one[k].height : 0, other = k < two.size() ? two[k].height : 0;
    const double higher = std::max(own, other);
    if (higher > lowest && !(std::abs(own - other) <= parted * higher)) {
      return k < one.size() ? one[k].begin : two[k].begin;
    }
  }
  return std::numeric_limits<double>::infinity();
}

// Whether the largest of what comes after the runs part might be the largest of all in another run: what two of them show of it
// is two draws of many.
template <class Part, class Size>
bool chance_decides(const std::vector<Part>& parts, double parting, Size&& size) {
  constexpr double margin = 2;
  double before = 0, after = 0;
  for (const Part& part : parts) {
    double& largest = part.begin < parting ? before : after;
    largest = std::max(largest, size(part));
  }
  return margin * after > before;
}

double energy_after(const std::vector<Touch>& touches, double parting) {
  double sum = 0;
  for (const Touch& touch : touches) sum += touch.begin >= parting ? touch.peak_energy : 0;
  return sum;
}

// What two runs say of anything beyond the point where they part is chance: it has no error but a cloud's. Nor have figures that
// hang on every touch where the runs differ by a thousand times the tolerance.
void forget_what_is_chaotic(FigureValues& errors, const Run& best, const Run& other, const MetricsOptions& options) {
  constexpr double magnified = 1000;
  const double visible = magnified * std::max(best.tolerance, other.tolerance);
  for (const Figure& figure : all_figures) {
    if (figure.conditioning != Conditioning::every_touch) continue;
    if (errors[figure] > visible * std::abs(figure.value(best.metrics))) errors[figure] = Metrics::unset;
  }
  // Rebounds that do not count may part as well: what is left to impacts then is all that they may differ by.
  for (const Run* run : {&best, &other}) {
    double& energy = errors[&Metrics::impact_energy];
    energy = std::max(energy, energy_after(run->trajectory.touches, parting_time(best, other, 0)));
  }
  const double parting = parting_time(best, other, options.significant_rebound);
  if (std::isinf(parting)) return;
  errors[&Metrics::impact_energy] = errors[&Metrics::drive_energy] = errors[&Metrics::steady_force_time] = Metrics::unset;
  for (const Run* run : {&best, &other}) {
    const auto force = [](const Touch& t) { return t.peak_force; };
    if (chance_decides(run->trajectory.touches, parting, force)) errors[&Metrics::peak_contact_force] = Metrics::unset;
    const auto height = [](const Rebound& r) { return r.height; };
    if (chance_decides(run->rebounds, parting, height)) errors[&Metrics::major_bounce_height] = Metrics::unset;
  }
}

// The largest relative difference of the figures that `accuracy` is about.
double error(const Run& run, const Run& other, const PreparedScene& prepared) {
  FigureValues least;
  least[&Metrics::major_bounce_height] = prepared.scene.metrics.significant_rebound;
  least[&Metrics::peak_contact_force] = least_peak_force(prepared);
  double most = 0;
  for (const Figure& figure : studied_figures) {
    const double size = std::fmax(0, least[figure]);
    most = std::max(most, relative_difference(figure.value(run.metrics), figure.value(other.metrics), size));
  }
  return most;
}

constexpr double tighter_by = 100;
constexpr double loosest_tolerance = 0.1;     // that simulate_closing takes
constexpr double least_tolerance = 0.99e-13;  // beyond which rounding decides; 1e-13 itself as quotients give it
// Of a fifth-order method 2.5 times the steps are to be expected; what needs this many more is not waited for.
constexpr long most_growth = 10, least_steps = 100;
constexpr double helps = 1.0 / 3;  // a tighter run that leaves more than this of the error does not
constexpr int most_in_vain = 2;    // in a row

bool can_tighten(const Run& r) { return r.tolerance / tighter_by >= least_tolerance; }

// Runs of a scene's closing, each told to the watch.
class ClosingRuns {
 public:
  ClosingRuns(const PreparedScene& prepared, const Watch& watch)
      : prepared_(prepared), watch_(watch), signals_(prepared.signals()) {}

  [[nodiscard]] const std::vector<Signal>& signals() const { return signals_; }
  [[nodiscard]] bool was_interrupted() const { return was_interrupted_; }

  Run as_asked() { return run(prepared_.model, prepared_.tolerance, prepared_.quadrature, ClosingOptions{}.max_steps); }

  Run tighter_than(const Run& r) {
    const SwitchOptions finer = finer_than(r.quadrature);
    return run(Switch(prepared_.scene.device, finer), std::max(r.tolerance / tighter_by, least_tolerance), finer,
               most_growth * (least_steps + r.trajectory.work.steps));
  }

  Run judge_of(const Run& r) {
    if (!can_tighten(r)) return looser_than(r);
    Run tighter = tighter_than(r);
    return came_to_its_end(tighter.trajectory) || watch_.stopped() ? std::move(tighter) : looser_than(r);
  }

  Run looser_than(const Run& r) {
    const SwitchOptions finer = finer_than(r.quadrature);
    return run(Switch(prepared_.scene.device, finer), std::min(loosest_tolerance, r.tolerance * tighter_by), finer,
               ClosingOptions{}.max_steps);
  }

 private:
  Run run(const Switch& model, double tolerance, const SwitchOptions& quadrature, long max_steps) {
    Run r{.tolerance = tolerance, .quadrature = quadrature};
    const std::string what =
        count_++ == 0 ? "closing" : fmt::format("closing again at tolerance {}, for its errors", engineering(tolerance, "", 1));
    const Hold hold = hold_of(model, signals_);
    CourseRecorder recorder(prepared_.scene.device.contact_gap(), prepared_.scene.metrics);
    if (model.contacts() > 1) {
      std::vector<double> gaps;
      for (std::size_t c = 0; c < model.contacts(); ++c) gaps.push_back(model.contact_gap(c));
      recorder.follow_contacts(gaps);
    }
    r.trajectory = observe_closing(model, signals_,
                                   {.duration = prepared_.duration,
                                    .tolerance = tolerance,
                                    .max_steps = max_steps,
                                    .steady_force = hold.steady_force(prepared_.scene.metrics),
                                    .start = prepared_.start(),
                                    .stop = watch_.stop,
                                    .observer = observer(watch_, what, prepared_.duration)},
                                   recorder);
    recorder.hand_over(r.trajectory);
    was_interrupted_ = was_interrupted_ || r.trajectory.status == Status::interrupted;
    set_rest(r.trajectory, model, signals_, hold);
    r.metrics = recorder.metrics(r.trajectory);
    r.rebounds = recorder.rebounds();
    for (std::size_t c = 0; c < r.trajectory.contacts.size(); ++c)
      r.contacts.push_back({.metrics = recorder.metrics_of(c, r.trajectory), .rebounds = recorder.rebounds_of(c)});
    r.is_thinned = recorder.is_thinned();
    set_open_figures(r.metrics, r.trajectory, model, signals_);
    return r;
  }

  const PreparedScene& prepared_;
  const Watch& watch_;
  std::vector<Signal> signals_;
  int count_ = 0;
  bool was_interrupted_ = false;
};

// A run, the one that judges it, and the largest relative difference of the figures that `accuracy` is about.
struct JudgedRun {
  Run own, judge;
  double error;
  const char* why;  // the error is no less
};

// Finds the judge of a run. Where runs may be tightened the judge takes the place of the run, and has one of its own, until the
// error is within the accuracy asked for or that no longer helps: then the tightest run is delivered, and a looser one judges it.
// Where rounding forbids a tighter integrator the quadrature alone is refined.
JudgedRun with_judge(Run own, ClosingRuns& runs, const PreparedScene& prepared, bool may_tighten) {
  const double accuracy = prepared.scene.simulate.accuracy;
  Run judge = runs.judge_of(own);
  double e = error(own, judge, prepared);
  const char* why = can_tighten(own) ? "and no tighter run comes to its end" : "and rounding forbids a tighter run";
  const auto judge_is_tighter = [&] { return came_to_its_end(judge.trajectory) && judge.tolerance < own.tolerance; };
  for (int vain = 0; may_tighten && e > accuracy && judge_is_tighter();) {
    why = "for so small a change decides it";
    if (vain == most_in_vain) break;
    Run next = runs.tighter_than(judge);
    if (!came_to_its_end(next.trajectory)) break;
    const double less = error(judge, next, prepared);
    vain = less < helps * e ? 0 : vain + 1;
    e = less;
    own = std::move(judge);
    judge = std::move(next);
  }
  constexpr double enough = 0.2;  // of a tolerance, for a run to tell the error that it leaves
  if (judge_is_tighter() && e > accuracy && may_tighten) std::swap(own, judge);
  const double ratio = judge.tolerance / own.tolerance;
  if (came_to_its_end(judge.trajectory) && ratio > enough && ratio < 1 / enough) {  // it judges the quadrature alone
    if (ratio <= 1) own = std::move(judge);
    judge = runs.looser_than(own);
    e = error(own, judge, prepared);
    why = "and rounding forbids a tighter run";
  }
  return {.own = std::move(own), .judge = std::move(judge), .error = e, .why = why};
}

// In one digit, or as many as tell it from a bound that it is above.
std::string in_telling_digits(double above, double bound) {
  constexpr int most_digits = 12;
  const std::string other = engineering(bound, "");
  std::string text;
  for (int digits = 1; digits <= most_digits && (text.empty() || text == other); ++digits) text = engineering(above, "", digits);
  return text;
}

// The errors that a judge finds, and what is to be warned of.
void add_errors(Closing& c, const JudgedRun& run, const PreparedScene& prepared, bool may_tighten) {
  const Run &own = run.own, &judge = run.judge;
  const bool is_tighter = judge.tolerance < own.tolerance;
  c.errors = difference(own.metrics, judge.metrics, own.tolerance, prepared.scene.device.contact_gap());
  forget_what_is_chaotic(c.errors, own, judge, prepared.scene.metrics);
  for (const Figure& figure : all_figures) c.errors[figure] *= stated_safety;
  allow_for_residual(c.errors, own.trajectory);
  const double accuracy = prepared.scene.simulate.accuracy;
  if (may_tighten && run.error > accuracy) {
    c.warnings.push_back(
        fmt::format("accuracy {} is not reached: at an integrator tolerance of {} t_i, v_i, B_H or the peak force is {}, {}",
                    engineering(accuracy, ""), engineering(own.tolerance, "", 1),
                    std::isfinite(run.error) ? fmt::format("still known to {} only", in_telling_digits(run.error, accuracy))
                                             : "not known at all",
                    run.why));
  }
  const double moved = std::abs(own.metrics.bounce_time - judge.metrics.bounce_time);
  if (own.metrics.bounce_count != judge.metrics.bounce_count || moved > 0.01 * std::abs(own.metrics.bounce_time)) {
    c.warnings.push_back(fmt::format(
        "bounce count and permanent contact time are ill-conditioned here: a hundredfold {} run gives {}; past the first "
        "large rebound a closing is chaotic",
        is_tighter ? "tighter" : "looser",
        own.metrics.bounce_count == judge.metrics.bounce_count
            ? fmt::format("another permanent contact time for the same {} rebounds", own.metrics.bounce_count)
            : fmt::format("{} rebounds instead of {}", judge.metrics.bounce_count, own.metrics.bounce_count)));
  }
}

// Tells whether a run that began closed has left its contact for good.
bool has_opened(const Trajectory& run) {
  return run.began_closed && !run.touches.empty() && std::isfinite(run.touches.back().end);
}

// A run that began closed loses the state in which it began, or the one in which it ends, where more modes deny them.
void judge_opening_with_more_modes(Closing& c, const PreparedScene& prepared, const std::vector<Signal>& signals) {
  const ModeLadder ladder(prepared);
  if (!ladder.exists()) return;
  if (stability(ladder, closed_equilibria(ladder, values_before(signals))).stable == false) {
    c.metrics = {.status = Status::collapsed_at_rest};
    c.errors = {};
    c.trajectory.status = Status::collapsed_at_rest;
    c.trajectory.message =
        "whether the switch has a stable closed state to begin in depends on the number of modes: more of them have none";
  } else if (c.metrics.status == Status::done && open_stability(ladder, hold_levels(signals)).flips) {
    c.metrics.status = Status::not_settled;
    c.is_pulled_through = true;
    c.warnings.emplace_back(
        "whether the switch stays open depends on the number of modes: under its hold levels it has no stable open equilibrium "
        "with more of them");
  }
}

// What is to be said of a run that began closed, or had no state to begin in.
void warn_of_start(Closing& c, const PreparedScene& prepared) {
  const Trajectory& t = c.trajectory;
  if (c.metrics.status == Status::collapsed_at_rest) {
    if (std::isfinite(t.other_start)) {
      constexpr int digits = 7;
      c.trajectory.message += fmt::format("; there is a stable {} one, its contact point at {}{}",
                                          prepared.start() == StartState::open ? "closed" : "open",
                                          engineering(t.other_start, "m", digits), other_start_hint(prepared));
    }
    c.warnings.push_back(t.message);
  } else if (t.began_closed && c.metrics.status == Status::not_settled) {
    c.warnings.emplace_back(
        has_opened(t) ? "the run begins closed, and the switch is not at rest in its open state when the window ends: a longer "
                        "simulate.duration, or a slower waveform, shows it there"
                      : "the run begins closed, and its contact is closed when the window ends");
  }
}

// A switch that the modes of its scene hold has not settled where twice or four times as many let it go.
void judge_with_more_modes(Closing& c, const PreparedScene& prepared, const std::vector<Signal>& signals) {
  Metrics& m = c.metrics;
  if (m.status == Status::open) {
    const StabilityByModes open = open_stability(ModeLadder(prepared), hold_levels(signals));
    if (!open.flips) return;
    m.status = Status::no_contact;
    c.warnings.push_back(
        "whether the switch stays open depends on the number of modes: under its hold levels it has no stable open "
        "equilibrium with more of them");
    return;
  }
  if (m.status != Status::done || !m.settled || !hold_of(prepared.model, signals).closed) return;
  const ModeLadder ladder(prepared);
  if (stability(ladder, closed_equilibria(ladder, hold_levels(signals))).stable != false) return;
  c.trajectory.is_held = m.settled = false;
  m.status = Status::not_settled;
  c.trajectory.hold_force = Metrics::unset;
  for (double Metrics::*const figure : {&Metrics::permanent_contact_time, &Metrics::bounce_time, &Metrics::hold_force})
    m.*figure = c.errors[figure] = Metrics::unset;
}

// Errors and warnings of a closing are not known where its runs were interrupted.
void say_interrupted(Closing& c) {
  const bool complete = c.trajectory.status != Status::interrupted;
  c.metrics.status = Status::interrupted;
  c.errors = {};
  c.judge.reset();
  c.warnings = {complete ? fmt::format("interrupted: the figures are those of a complete closing at tolerance {}, but how "
                                       "far they are from the truth was not found out",
                                       engineering(c.tolerance, "", 1))
                         : std::string("interrupted: the figures are those of the part of the closing that was simulated")};
}

}  // namespace

bool came_to_its_end(const Trajectory& run) {
  return run.status == Status::done || (run.status == Status::collapsed_onto_electrode && !run.touches.empty());
}

void allow_for_residual(FigureValues& errors, const Trajectory& run) {
  double& drive_energy = errors[&Metrics::drive_energy];
  if (drive_energy < run.energy_error) drive_energy = run.energy_error;
}

double least_peak_force(const PreparedScene& prepared) {
  constexpr double share = 0.01;
  return share * 2 * prepared.model.bending_energy() / prepared.scene.device.contact_gap();
}

Closing simulate(const PreparedScene& prepared, bool estimate_errors, const Watch& watch) {
  ClosingRuns runs(prepared, watch);
  Run best = runs.as_asked();
  const SimulateOptions& asked = prepared.scene.simulate;
  const bool may_tighten = estimate_errors && asked.tolerance == 0;
  if (may_tighten && best.trajectory.status == Status::numerical_failure && can_tighten(best)) best = runs.tighter_than(best);

  Closing c;
  if (estimate_errors && came_to_its_end(best.trajectory)) {
    JudgedRun run = with_judge(std::move(best), runs, prepared, may_tighten);
    const Run& judge = run.judge;
    c.judge = {.status = judge.trajectory.status,
               .came_to_its_end = came_to_its_end(judge.trajectory),
               .message = judge.trajectory.message,
               .metrics = judge.metrics,
               .tolerance = judge.tolerance,
               .quadrature = judge.quadrature};
    if (c.judge->came_to_its_end) {
      add_errors(c, run, prepared, may_tighten);
    } else if (!watch.stopped()) {
      c.warnings.push_back(fmt::format(
          "the errors are not known, nor whether accuracy {} is reached: no other run to compare with came to its end "
          "({}{}{})",
          engineering(asked.accuracy, ""), to_string(judge.trajectory.status), judge.trajectory.message.empty() ? "" : ": ",
          judge.trajectory.message));
    }
    best = std::move(run.own);
  }
  c.trajectory = std::move(best.trajectory);
  c.rebounds = std::move(best.rebounds);
  c.contacts = std::move(best.contacts);
  c.is_thinned = best.is_thinned;
  c.tolerance = best.tolerance;
  c.quadrature = best.quadrature;
  c.metrics = best.metrics;
  if (best.metrics.status == Status::no_contact) {
    if (std::string unstable = unstable_rest(prepared.model, runs.signals()); !unstable.empty())
      c.warnings.push_back(std::move(unstable));
    const bool stays = stays_open(prepared.model, runs.signals(), prepared.duration, watch);
    if (watch.stopped()) {
      say_interrupted(c);
    } else if (stays) {
      c.metrics.status = Status::open;
    }
  }
  if (c.trajectory.began_closed) {
    c.rebounds.clear();
    judge_opening_with_more_modes(c, prepared, runs.signals());
  } else {
    judge_with_more_modes(c, prepared, runs.signals());
  }
  warn_of_start(c, prepared);
  if (!c.trajectory.began_closed && c.metrics.status != Status::collapsed_at_rest && !c.trajectory.is_held &&
      c.metrics.status != Status::open) {
    const ClosedState state = closed_state(prepared, runs.signals());
    c.warnings.push_back(hold_warning(prepared.model, runs.signals(), state));
    c.is_pulled_through = !warning(state).empty() || !prepared.model.open_equilibrium(hold_levels(runs.signals()));
  }
  if (std::isfinite(c.metrics.hold_force) && !runs.was_interrupted()) {
    if (std::string few = few_summits_warning(prepared.model, runs.signals()); !few.empty()) c.warnings.push_back(std::move(few));
  }
  if (runs.was_interrupted()) say_interrupted(c);
  c.warnings.insert(c.warnings.begin(), c.trajectory.warnings.begin(), c.trajectory.warnings.end());
  c.warnings.insert(c.warnings.begin(), prepared.scene.warnings.begin(), prepared.scene.warnings.end());
  set_drive_figures(c.metrics, prepared, runs.signals());
  return c;
}

std::string hold_warning(const Switch& model, const std::vector<Signal>& signals, const ClosedState& state) {
  if (state.stable != false && hold_of(model, signals).is_held) return {};
  const std::string unstable = warning(state);
  return unstable.empty() ? std::string(not_held) : unstable;
}

namespace {

// The same device, of which another contact is the first.
Device with_first_contact(Device device, std::size_t c) {
  device.contacts.front().gap = device.gap.contact;
  std::swap(device.contacts.front(), device.contacts[c]);
  device.gap.contact = device.contacts.front().gap;
  return device;
}

// Conductance of a contact at rest under this force [S]; NaN where it is not known.
double conductance_at(const Switch& model, const Eigen::VectorXd& q, double force, std::size_t c = 0) {
  const ContactResistance contact = contact_resistance(model.device(), c);
  if (!contact.is_known()) return Metrics::unset;
  return contact.conductance(model.contact_deflection(q.data(), c) - model.contact_gap(c), force);
}

// What several contacts carry where the switch rests under these levels, and what the connection that they make does.
Hold hold_of_connection(const Switch& model, const std::vector<double>& levels, Hold hold) {
  const bool needs_all = model.device().connection == Connection::all;
  std::optional<Eigen::VectorXd> rest;
  if (keeps_closed(model, hold.closed)) rest = hold.closed->q;
  // Another contact than the first one may hold the beam.
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

Hold hold_of(const Switch& model, const std::vector<Signal>& signals, const std::optional<ClosedEquilibrium>& near) {
  const std::vector<double> levels = hold_levels(signals);
  Hold hold{.closed = near ? closed_equilibrium_near(model, levels, *near) : closed_equilibrium(model, levels)};
  const bool stays = keeps_closed(model, hold.closed);
  if (stays) hold.force = hold.closed->contact_force;
  if (stays && model.device().conducts()) hold.resistance = resistance_of(conductance_at(model, hold.closed->q, hold.force));
  if (model.contacts() > 1) return hold_of_connection(model, levels, std::move(hold));
  const bool sticks = model.has_contact() && may_stick(model.device().contacts.front().model);
  hold.is_held = stays || !model.has_contact() || (sticks && !hold.closed);
  return hold;
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

void set_drive_figures(Metrics& metrics, const PreparedScene& prepared, const std::vector<Signal>& signals) {
  metrics.peak_voltage = metrics.peak_slew = 0;
  const bool piezo_only = prepared.scene.device.electrodes.empty();
  for (std::size_t k = 0; k < signals.size(); ++k) {
    const DriveKind kind = prepared.model.drive_kind(k);
    if (kind == DriveKind::dispersion) continue;  // a force factor is no voltage
    if (kind == DriveKind::electrode || piezo_only)
      metrics.peak_voltage = std::max(metrics.peak_voltage, signals[k].peak(prepared.duration));
    metrics.peak_slew = std::max(metrics.peak_slew, signals[k].peak_slew(prepared.duration));
  }
}

}  // namespace softland
