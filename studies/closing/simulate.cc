#include "studies/closing/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/engineering.h"
#include "model/constants.h"
#include "objectives/course_recorder.h"
#include "objectives/figure_values.h"
#include "studies/closing/closing_progress.h"
#include "studies/closing/judged_by_modes.h"
#include "studies/closing/open_command.h"
#include "studies/closing/open_state.h"
#include "studies/closing/summits_at_hold.h"

namespace softland {
namespace {

// Returns the differences of the figures of two runs of one closing, at least the error that both runs have in common. For
// permanent contact time, bounce time and bounce count, certify() estimates the errors instead.
FigureValues difference(const Metrics& a, const Metrics& b, double tolerance, double contact_gap) {
  // Error that two runs have in common, relative to a figure, per unit of the relative tolerance.
  constexpr double shared = 0.01;
  // Separation in a rebound below which metrics() ignores the rebound, as a share of the contact gap.
  constexpr double lowest_separation = 1e-12;
  FigureValues d;
  for (const Figure& figure : all_figures) {
    if (!figure.error_is_from_two_runs()) continue;
    const double own = figure.value(a);
    d[figure] = std::max(std::abs(own - figure.value(b)), shared * tolerance * std::abs(own));
  }
  // Neither run has a rebound, so that both times of the first rebound are 0. Such a time has no error.
  if (a.first_rebound_time == 0 && b.first_rebound_time == 0) d[&Metrics::first_rebound_time] = Metrics::unset;
  double& height = d[&Metrics::major_bounce_height];
  height = std::max(height, lowest_separation * contact_gap);
  double& force = d[&Metrics::least_force_after_touch];
  force = std::max(force, shared * tolerance * a.hold_force);
  return d;
}

struct EvaluatedRun {
  Trajectory trajectory;
  Metrics metrics;
  std::vector<Rebound> rebounds;
  std::vector<ContactClosing> contacts = {};
  bool is_thinned = false;
  double tolerance = 0;
  SwitchOptions quadrature;
};

// Returns the time at which two runs diverge: the first rebound above `lowest` whose heights in the two runs differ by a tenth.
// Infinite if the runs do not diverge.
double parting_time(const EvaluatedRun& a, const EvaluatedRun& b, double lowest) {
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

// True if chance decides which touch or rebound of a run is the largest: after the runs diverge, another touch or rebound might
// be the largest in another run. Two runs are only two samples of a chaotic closing.
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

// Removes the errors of chaotic figures: after the runs diverge these figures are random, and only many perturbed runs (a
// cloud) give their errors. A figure that depends on every touch counts as chaotic if its relative difference between the runs
// is above a thousand times the tolerance.
void forget_what_is_chaotic(FigureValues& errors, const EvaluatedRun& best, const EvaluatedRun& other,
                            const MetricsOptions& options) {
  constexpr double magnified = 1000;
  const double visible = magnified * std::max(best.tolerance, other.tolerance);
  for (const Figure& figure : all_figures) {
    if (figure.conditioning != Conditioning::every_touch) continue;
    if (errors[figure] > visible * std::abs(figure.value(best.metrics))) errors[figure] = Metrics::unset;
  }
  // Runs may also diverge in insignificant rebounds. From then on their impact energies differ at most by the energy of the
  // later impacts.
  for (const EvaluatedRun* run : {&best, &other}) {
    double& energy = errors[&Metrics::impact_energy];
    energy = std::max(energy, energy_after(run->trajectory.touches, parting_time(best, other, 0)));
  }
  const double parting = parting_time(best, other, options.significant_rebound);
  if (std::isinf(parting)) return;
  errors[&Metrics::impact_energy] = errors[&Metrics::drive_energy] = errors[&Metrics::steady_force_time] = Metrics::unset;
  for (const EvaluatedRun* run : {&best, &other}) {
    const auto force = [](const Touch& t) { return t.peak_force; };
    if (chance_decides(run->trajectory.touches, parting, force)) errors[&Metrics::peak_contact_force] = Metrics::unset;
    const auto height = [](const Rebound& r) { return r.height; };
    if (chance_decides(run->rebounds, parting, height)) errors[&Metrics::major_bounce_height] = Metrics::unset;
  }
}

// Returns the largest relative difference of initial contact time, impact velocity, highest rebound and peak force, the figures
// for which the scene requests an accuracy.
double error(const EvaluatedRun& run, const EvaluatedRun& other, const PreparedScene& prepared) {
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
constexpr double loosest_tolerance = 0.1;  // largest relative tolerance that simulate_closing() accepts
// Smallest relative tolerance, since smaller errors are rounding. A tolerance of 1e-13 that divisions have rounded down is
// still accepted.
constexpr double least_tolerance = 0.99e-13;
// With an integrator of fifth order a hundredth of the tolerance needs 2.5 times the steps. A tighter run is stopped after
// `most_growth` times the steps of the looser run plus `least_steps`.
constexpr long most_growth = 10, least_steps = 100;
// Ratio of the error of a run with tighter tolerance to the previous error; below this ratio tightening helped.
constexpr double helps = 1.0 / 3;
constexpr int most_in_vain = 2;  // number of runs in a row that tightening did not improve after which tightening ends

bool can_tighten(const EvaluatedRun& r) { return r.tolerance / tighter_by >= least_tolerance; }

bool is_back_stop(const Switch& model, std::size_t contact) { return model.device().contacts[contact].side == Side::far; }

// Sets the figures of an opening on command that need the switch: the impacts on its back stops, and whether the switch ends
// open and at rest for at least a period of the first mode.
void set_commanded_opening(Metrics& m, const Trajectory& run, const Switch& model) {
  if (!m.asked.opening) return;
  for (std::size_t c = 0; c < run.contacts.size(); ++c) {
    if (!is_back_stop(model, c)) continue;
    m.back_stop_velocity = std::fmax(m.back_stop_velocity, 0);
    for (const Touch& touch : run.contacts[c].touches)
      if (touch.begin >= m.open_command) m.back_stop_velocity = std::max(m.back_stop_velocity, touch.impact_velocity);
  }
  const double period = 2 * pi / model.basis().angular_frequencies()[0];
  const bool rests = m.end - (m.open_command + m.release_settling_time) >= period;
  if (m.status == Status::done && !rests && !run.began_closed) m.status = Status::not_settled;
}

// Simulates the closing of a scene at different integrator tolerances and reports the progress of each run.
class ClosingRuns {
 public:
  ClosingRuns(const PreparedScene& prepared, const Progress& progress)
      : prepared_(prepared), progress_(progress), signals_(prepared.signals()), command_(open_command(prepared, signals_)) {}

  [[nodiscard]] const std::vector<Signal>& signals() const { return signals_; }
  /// Returns the command to open, if its time is within the simulated time.
  [[nodiscard]] std::optional<OpenCommand> command() const {
    return command_ && command_->time < prepared_.duration ? command_ : std::nullopt;
  }
  /// Returns the drive signals of the closing, which are constant from the command to open on.
  [[nodiscard]] const std::vector<Signal>& held() const {
    return command_ && prepared_.start() == StartState::open ? command_->held : signals_;
  }
  [[nodiscard]] bool was_interrupted() const { return was_interrupted_; }

  EvaluatedRun as_asked() { return run(prepared_.model, prepared_.tolerance, prepared_.quadrature, ClosingOptions{}.max_steps); }

  EvaluatedRun tighter_than(const EvaluatedRun& r) {
    const SwitchOptions finer = finer_than(r.quadrature);
    return run(Switch(prepared_.scene.device, finer), std::max(r.tolerance / tighter_by, least_tolerance), finer,
               most_growth * (least_steps + r.trajectory.work.steps));
  }

  EvaluatedRun judge_of(const EvaluatedRun& r) {
    if (!can_tighten(r)) return looser_than(r);
    EvaluatedRun tighter = tighter_than(r);
    return came_to_its_end(tighter.trajectory) || progress_.stopped() ? std::move(tighter) : looser_than(r);
  }

  EvaluatedRun looser_than(const EvaluatedRun& r) {
    const SwitchOptions finer = finer_than(r.quadrature);
    return run(Switch(prepared_.scene.device, finer), std::min(loosest_tolerance, r.tolerance * tighter_by), finer,
               ClosingOptions{}.max_steps);
  }

 private:
  EvaluatedRun run(const Switch& model, double tolerance, const SwitchOptions& quadrature, long max_steps) {
    EvaluatedRun r{.tolerance = tolerance, .quadrature = quadrature};
    const std::string what =
        count_++ == 0 ? "closing" : fmt::format("closing again at tolerance {}, for its errors", engineering(tolerance, "", 1));
    const Hold hold = hold_of(model, held());
    const std::optional<OpenCommand> opens = command();
    CourseRecorder recorder = recorder_of(model, opens);
    r.trajectory = observe_closing(model, signals_,
                                   {.duration = prepared_.duration,
                                    .tolerance = tolerance,
                                    .max_steps = max_steps,
                                    .steady_force = hold.steady_force(prepared_.scene.metrics),
                                    .start = prepared_.start(),
                                    .opens_at = opens ? opens->time : std::numeric_limits<double>::infinity(),
                                    .stop = progress_.stop,
                                    .observer = observer(progress_, what, prepared_.duration)},
                                   recorder);
    recorder.hand_over(r.trajectory);
    was_interrupted_ = was_interrupted_ || r.trajectory.status == Status::interrupted;
    set_rest(r.trajectory, model, held(), hold);
    r.metrics = recorder.metrics(r.trajectory);
    if (opens && is_before_touch(r, *opens)) {
      command_.reset();
      return run(model, tolerance, quadrature, max_steps);
    }
    r.rebounds = recorder.rebounds();
    for (std::size_t c = 0; c < r.trajectory.contacts.size(); ++c)
      r.contacts.push_back({.metrics = recorder.metrics_of(c, r.trajectory), .rebounds = recorder.rebounds_of(c)});
    r.is_thinned = recorder.is_thinned();
    set_open_figures(r.metrics, r.trajectory, model, signals_);
    if (opens) set_commanded_opening(r.metrics, r.trajectory, model);
    return r;
  }

  // True if the command to open comes before first contact, so that it does not count.
  [[nodiscard]] bool is_before_touch(const EvaluatedRun& r, const OpenCommand& command) const {
    return prepared_.start() == StartState::open && came_to_its_end(r.trajectory) &&
           !(r.metrics.initial_contact_time < command.time);
  }

  // Returns a recorder of the figures of the connection (the electrical path through the contacts), and of each contact if
  // there are several. Contacts on a back stop are recorded to the end of the run, also after the command to open.
  [[nodiscard]] CourseRecorder recorder_of(const Switch& model, const std::optional<OpenCommand>& command) const {
    const MetricsOptions& plain = prepared_.scene.metrics;
    const MetricsOptions options = with_load(with_opening(plain, model, signals_, command), model, prepared_.start(), held());
    const auto open =
        command && model.contacts() > 1 ? model.open_equilibrium(hold_levels(signals_)) : std::optional<Eigen::VectorXd>();
    CourseRecorder recorder(prepared_.scene.device.contact_gap(), options);
    for (std::size_t c = 0; c < model.contacts() && model.contacts() > 1; ++c) {
      MetricsOptions own = is_back_stop(model, c) ? plain : options;
      own.transfer = {};
      if (open) own.opening.open_position = model.contact_deflection(open->data(), c);
      recorder.follow_contact(model.contact_gap(c), own);
    }
    return recorder;
  }

  const PreparedScene& prepared_;
  const Progress& progress_;
  std::vector<Signal> signals_;
  std::optional<OpenCommand> command_;
  int count_ = 0;
  bool was_interrupted_ = false;
};

// A run, its more accurate judge, and their largest relative difference in contact time, impact velocity, rebound and peak
// force.
struct JudgedRun {
  EvaluatedRun own, judge;
  double error;
  const char* why;  // reason why the integration error cannot be reduced further
};

// Returns a run with its judge, a more accurate run from whose difference errors follow. If runs may be tightened, the judge
// replaces the run and gets its own judge, until the error is within the requested accuracy or tightening no longer helps. If
// it does not help, the tightest run is returned, and a looser run is its judge. If rounding forbids a tighter integrator, only
// the quadrature is refined.
JudgedRun with_judge(EvaluatedRun own, ClosingRuns& runs, const PreparedScene& prepared, bool may_tighten) {
  const double accuracy = prepared.scene.simulate.accuracy;
  EvaluatedRun judge = runs.judge_of(own);
  double e = error(own, judge, prepared);
  const char* why = can_tighten(own) ? "and no tighter run comes to its end" : "and rounding forbids a tighter run";
  const auto judge_is_tighter = [&] { return came_to_its_end(judge.trajectory) && judge.tolerance < own.tolerance; };
  for (int vain = 0; may_tighten && e > accuracy && judge_is_tighter();) {
    why = "for so small a change decides it";
    if (vain == most_in_vain) break;
    EvaluatedRun next = runs.tighter_than(judge);
    if (!came_to_its_end(next.trajectory)) break;
    const double less = error(judge, next, prepared);
    vain = less < helps * e ? 0 : vain + 1;
    e = less;
    own = std::move(judge);
    judge = std::move(next);
  }
  constexpr double enough = 0.2;  // runs whose tolerances are closer than this ratio show no integration error
  if (judge_is_tighter() && e > accuracy && may_tighten) std::swap(own, judge);
  const double ratio = judge.tolerance / own.tolerance;
  // Only the quadrature of the two runs differs: take the finer run, and judge it by a run with a looser tolerance.
  if (came_to_its_end(judge.trajectory) && ratio > enough && ratio < 1 / enough) {
    if (ratio <= 1) own = std::move(judge);
    judge = runs.looser_than(own);
    e = error(own, judge, prepared);
    why = "and rounding forbids a tighter run";
  }
  return {.own = std::move(own), .judge = std::move(judge), .error = e, .why = why};
}

// Returns the number `above` as text with as many digits as distinguish it from the smaller number `bound`.
std::string in_telling_digits(double above, double bound) {
  constexpr int most_digits = 12;
  const std::string other = engineering(bound, "");
  std::string text;
  for (int digits = 1; digits <= most_digits && (text.empty() || text == other); ++digits) text = engineering(above, "", digits);
  return text;
}

// Adds to a closing the errors and warnings that follow from the comparison of the run with its judge, a more accurate run.
void add_errors(Closing& c, const JudgedRun& run, const PreparedScene& prepared, bool may_tighten) {
  const EvaluatedRun &own = run.own, &judge = run.judge;
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

// Adds warnings about a run that began with a closed switch, or whose start state does not exist.
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
  } else if (!t.began_closed && c.metrics.asked.opening && c.metrics.settled && c.metrics.status == Status::not_settled) {
    c.warnings.emplace_back(std::isfinite(c.metrics.opening_time)
                                ? "the switch opens on command, and is not at rest in its open state when the window ends: a "
                                  "longer simulate.duration, or a slower waveform, shows it there"
                                : "the switch is commanded to open, and its contact is closed when the window ends");
  } else if (t.began_closed && c.metrics.status == Status::not_settled) {
    c.warnings.emplace_back(
        has_opened(t) ? "the run begins closed, and the switch is not at rest in its open state when the window ends: a longer "
                        "simulate.duration, or a slower waveform, shows it there"
                      : "the run begins closed, and its contact is closed when the window ends");
  }
}

// Marks a closing as interrupted; its errors and warnings are not known.
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

Closing simulate(const PreparedScene& prepared, bool estimate_errors, const Progress& progress) {
  ClosingRuns runs(prepared, progress);
  EvaluatedRun best = runs.as_asked();
  const SimulateOptions& asked = prepared.scene.simulate;
  const bool may_tighten = estimate_errors && asked.tolerance == 0;
  if (may_tighten && best.trajectory.status == Status::numerical_failure && can_tighten(best)) best = runs.tighter_than(best);

  Closing c;
  if (estimate_errors && came_to_its_end(best.trajectory)) {
    JudgedRun run = with_judge(std::move(best), runs, prepared, may_tighten);
    const EvaluatedRun& judge = run.judge;
    c.judge = {.status = judge.trajectory.status,
               .came_to_its_end = came_to_its_end(judge.trajectory),
               .message = judge.trajectory.message,
               .metrics = judge.metrics,
               .tolerance = judge.tolerance,
               .quadrature = judge.quadrature};
    if (c.judge->came_to_its_end) {
      add_errors(c, run, prepared, may_tighten);
    } else if (!progress.stopped()) {
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
    const bool stays = stays_open(prepared.model, runs.signals(), prepared.duration, progress);
    if (progress.stopped()) {
      say_interrupted(c);
    } else if (stays) {
      c.metrics.status = Status::open;
    }
  }
  if (c.trajectory.began_closed) {
    c.rebounds.clear();
    judge_opening_with_more_modes(c, prepared, runs.signals());
  } else {
    judge_with_more_modes(c, prepared, runs.held());
  }
  warn_of_start(c, prepared);
  if (!c.trajectory.began_closed && c.metrics.status != Status::collapsed_at_rest && !c.trajectory.is_held &&
      c.metrics.status != Status::open) {
    const ClosedState state = closed_state(prepared, runs.held());
    c.warnings.push_back(hold_warning(prepared.model, runs.held(), state));
    c.is_pulled_through = !warning(state).empty() || !prepared.model.open_equilibrium(hold_levels(runs.held()));
  }
  if (std::isfinite(c.metrics.hold_force) && !runs.was_interrupted()) {
    if (std::string few = few_summits_warning(prepared.model, runs.held()); !few.empty()) c.warnings.push_back(std::move(few));
  }
  if (runs.was_interrupted()) say_interrupted(c);
  c.command = runs.command();
  c.warnings.insert(c.warnings.begin(), c.trajectory.warnings.begin(), c.trajectory.warnings.end());
  c.warnings.insert(c.warnings.begin(), prepared.scene.warnings.begin(), prepared.scene.warnings.end());
  set_drive_figures(c.metrics, prepared, runs.signals());
  return c;
}

void set_drive_figures(Metrics& metrics, const PreparedScene& prepared, const std::vector<Signal>& signals) {
  metrics.peak_voltage = metrics.peak_slew = 0;
  const bool piezo_only = prepared.scene.device.electrodes.empty();
  for (std::size_t k = 0; k < signals.size(); ++k) {
    const DriveKind kind = prepared.model.drive_kind(k);
    if (kind == DriveKind::dispersion) continue;  // the drive of a dispersion force is a factor on the force, not a voltage
    if (kind == DriveKind::electrode || piezo_only)
      metrics.peak_voltage = std::max(metrics.peak_voltage, signals[k].peak(prepared.duration));
    metrics.peak_slew = std::max(metrics.peak_slew, signals[k].peak_slew(prepared.duration));
  }
}

}  // namespace softland
