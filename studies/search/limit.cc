#include "studies/search/limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "base/require.h"
#include "model/closing.h"
#include "model/constants.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/plain_step.h"
#include "studies/search/first_touch_problem.h"
#include "studies/search/path_waveforms.h"
#include "studies/search/search_setting.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int first_knots = 48;  // number of equal time intervals of the controls in the first solution; some are then divided
constexpr double piece_angle = 0.75;  // phase angle by which the fastest mode turns in one interval of the time mesh [rad]
// Largest difference of the time of first contact at which optimal control and simulation agree: as a share of this time, or,
// multiplied by the impact velocity, as a share of the contact gap.
constexpr double agreement = 1e-4;
constexpr double longest_swing = 3;  // longest time of a swing to the contact, in periods of the first mode
// Largest excess of the simulated impact velocity over that of the optimal control at which both agree, as a share of the
// permitted impact velocity.
constexpr double softness = 0.2;
// Relative tolerance of the integrator in simulations that compare catches (pulls after first contact that keep the switch
// closed).
constexpr double catch_tolerance = 1e-6;
constexpr int refinements = 3;  // number of times that a time interval of the controls may be halved
constexpr int most_meshes = 3;  // number of meshes of the optimal control problem, each with pieces half as long as before

// Permitted distances of the modal coordinates at first contact from the closed equilibrium, in contact gaps. The optimal
// control problem is solved for each, starting from the solution before.
constexpr std::array rest_distances = {0.1, 0.03, 0.01, 0.003, 0.001, 0.0003};
// Largest number of Ipopt iterations for each but the first of rest_distances; about 30 suffice if a solution exists.
constexpr long nearing_iterations = 100;

std::vector<double> uniform_knots(int intervals) {
  std::vector<double> knots;
  for (int k = 0; k <= intervals; ++k) knots.push_back(static_cast<double>(k) / intervals);
  return knots;
}

struct Arrival {
  double time = std::numeric_limits<double>::quiet_NaN(), velocity = time;
};

Arrival arrival(const PreparedScene& prepared, const DriveWaveforms& searched, Actuator actuator, double window) {
  const ClosingOptions options{.duration = window, .tolerance = std::min(prepared.tolerance, 1e-8), .after_contact = 0};
  const Trajectory run = simulate_closing(prepared.model, applied(prepared, searched, plain_step(prepared, actuator)), options);
  const Metrics m = metrics(run);
  return {m.initial_contact_time, m.impact_velocity};
}

// One search for the least time of a first contact: the optimal control problem and its best solution so far.
class LeastTimeSearch {
 public:
  LeastTimeSearch(const PreparedScene& prepared, const LeastTimeOptions& options)
      : prepared_(prepared), options_(options), first_touch_(prepared, options.actuator, options.peak) {
    result_.permitted = options.impact_velocity;
    if (options.actuator == Actuator::pzt) return;
    const DriverLimits& limits = prepared.drives.at(searched_electrode(prepared.scene.device)).limits.value();
    result_.peak = std::min(options.peak, std::max(std::abs(limits.max_voltage), std::abs(limits.min_voltage)));
  }

  LeastTime from_swing() {
    std::optional<ControlledCourse> swing = first_touch_.swing(longest_time());
    if (!swing) return ended(Status::no_contact, "full pull does not bring the switch to its contact");
    return from(std::move(*swing), longest_time(), true);
  }

  // Returns waveforms under which the modes come to rest at first contact, one for each of rest_distances, each closer to rest
  // than the one before. Time intervals and mesh are not refined. After first contact the drives are as in `plain`.
  std::vector<DriveWaveforms> ways_to_rest(const DriveWaveforms& plain) {
    std::vector<DriveWaveforms> all;
    std::optional<ControlledCourse> swing = first_touch_.swing(longest_time());
    const std::optional<FirstTouchProblem::Landing> landing = first_touch_.landing();
    if (!swing || !landing) return all;
    course_ = std::move(*swing);
    pose(longest_time(), landing);
    (void)come_to_rest(landing->state, [&] {
      const LeastTime path{.waveforms = tables_of(first_touch_, course_), .course = course_};
      all.push_back(with_catch(first_touch_, path, {}, plain));
      options_.progress.tell("landings at rest to begin with", static_cast<double>(all.size()) / rest_distances.size());
    });
    return all;
  }

  LeastTime from_start() {
    result_.from_start = true;
    const std::vector<Signal> signals = applied(prepared_, options_.start, plain_step(prepared_, options_.actuator));
    std::optional<ControlledCourse> flown = first_touch_.flown(signals, first_knots, prepared_.duration);
    if (!flown) return ended(Status::no_contact, "the waveform to start with does not bring the switch to its contact");
    const double longest = 2 * flown->time * first_touch_.time_unit();
    return from(std::move(*flown), longest, false);
  }

 private:
  [[nodiscard]] double longest_time() const { return longest_swing * 2 * pi / prepared_.model.basis().angular_frequencies()[0]; }

  LeastTime from(ControlledCourse guess, double longest, bool slows_down) {
    course_ = std::move(guess);
    std::optional<FirstTouchProblem::Landing> landing;
    if (options_.at_rest) {
      landing = first_touch_.landing();
      if (!landing) return ended(Status::no_contact, "the hold levels do not keep the switch closed");
    }
    pose(longest, landing);
    Status status = slows_down ? slow_down() : Status::done;
    if (status == Status::done && landing) status = come_to_rest(landing->state);
    if (status == Status::done) status = improve_with_finer_knots();
    if (status != Status::done) return ended(status, result_.message);
    return refine_until_simulated();
  }

  LeastTime ended(Status status, std::string why) {
    result_.status = status;
    result_.message = std::move(why);
    return result_;
  }

  void pose(double longest, const std::optional<FirstTouchProblem::Landing>& landing) {
    const double speed = options_.impact_velocity / first_touch_.speed_unit();
    const double fastest = prepared_.model.basis().angular_frequencies().maxCoeff() * first_touch_.time_unit();
    problem_ = {.system = &first_touch_,
                .start = first_touch_.start(),
                .bounds = first_touch_.bounds(),
                .on_the_way = {{.row = first_touch_.tip(), .upper = 1}},
                .at_the_end = {{.row = first_touch_.tip(), .lower = 1, .upper = 1},
                               {.row = first_touch_.tip_speed(), .lower = 0, .upper = speed}},
                .shortest = course_.time / 10,
                .longest = longest / first_touch_.time_unit(),
                .knots = uniform_knots(first_knots),
                .longest_piece = piece_angle / (fastest * course_.time),
                .stop = options_.progress.stop};
    // Require that the controls end at the values of the closed equilibrium `landing`: under others a beam would not stay at
    // rest on its contact.
    for (Index k = 0; landing && first_touch_.ramps() && k < first_touch_.controls(); ++k)
      problem_.bounds[static_cast<std::size_t>(k)].after = landing->controls[k];
  }

  // Solves the optimal control problem with the last solution as the guess. If the solver fails, the last solution remains.
  Status improve() {
    ControlledCourse course = solve(problem_, course_);
    result_.message = course.message;
    if (course.interrupted) return Status::interrupted;
    if (!course.converged) return Status::numerical_failure;
    course_ = std::move(course);
    return Status::done;
  }

  // Lowers the permitted speed in steps, by one solution each, where the guess touches far too fast: after full pull through a
  // thick film. Ipopt needs these intermediate solutions, since the drive has to fall within the last nanometres.
  Status slow_down() {
    constexpr double too_fast = 10, step = 3;  // ratios of speeds
    const double permitted = problem_.at_the_end[1].upper;
    double speed = first_touch_.tip_speed().dot(course_.states.rightCols<1>());
    Status status = Status::done;
    for (const bool slows = speed > too_fast * permitted; slows && speed > permitted && status == Status::done; speed /= step) {
      problem_.at_the_end[1].upper = speed;
      status = improve();
    }
    problem_.at_the_end[1].upper = permitted;
    return status;
  }

  Status improve_with_finer_knots() {
    const double finest = 1.0 / (first_knots * std::exp2(refinements));
    for (;;) {
      if (const Status status = improve(); status != Status::done) return status;
      std::vector<double> knots = refined_knots(course_, problem_.bounds, finest);
      if (knots.size() == problem_.knots.size()) return Status::done;
      problem_.knots = std::move(knots);
    }
  }

  // Requires that the modes end ever closer to rest, by one solution for each of rest_distances: Ipopt needs these intermediate
  // solutions to find a motion that ends at rest. Calls `nearer` after each solution.
  Status come_to_rest(const VectorXd& landed, const std::function<void()>& nearer = {}) {
    const Index n = first_touch_.states();
    for (Index r = 0; r < n; ++r) problem_.at_the_end.push_back({.row = VectorXd::Unit(n, r)});
    const auto leave = [&](double distance) {
      for (Index r = 0; r < n; ++r) {
        StateCondition& mode = problem_.at_the_end[static_cast<std::size_t>(r) + 2];
        mode.lower = landed[r] - distance;
        mode.upper = landed[r] + distance;
      }
    };
    const long usual = problem_.max_iterations;
    for (const double distance : rest_distances) {
      leave(distance);
      const Status status = improve();
      if (status == Status::interrupted) return status;
      if (status != Status::done) break;
      result_.distance = distance;
      problem_.max_iterations = nearing_iterations;
      if (nearer) nearer();
    }
    problem_.max_iterations = usual;
    if (std::isnan(result_.distance)) return Status::numerical_failure;
    leave(result_.distance);
    return Status::done;
  }

  // Solves the optimal control problem on finer meshes until time and speed of first contact agree with a simulation of the
  // waveforms.
  LeastTime refine_until_simulated() {
    for (int mesh = 1;; ++mesh) {
      result_.course = course_;
      result_.time = course_.time * first_touch_.time_unit();
      result_.impact_velocity =
          first_touch_.tip_speed().dot(course_.states.col(course_.states.cols() - 1)) * first_touch_.speed_unit();
      result_.waveforms =
          with_catch(first_touch_, {.waveforms = tables_of(first_touch_, course_), .course = course_}, {.end = result_.time}, {});
      const Arrival touch = arrival(prepared_, result_.waveforms, options_.actuator, 2 * result_.time);
      result_.simulated_time = touch.time;
      result_.simulated_velocity = touch.velocity;
      const double apart = std::abs(touch.time - result_.time);
      const double missed = apart * std::max(touch.velocity, result_.impact_velocity);
      bool near = apart <= agreement * result_.time || missed <= agreement * prepared_.scene.device.contact_gap();
      const bool as_soft = touch.velocity <= result_.impact_velocity + softness * options_.impact_velocity;
      // Accept an earlier and equally soft contact, too: a contact point that comes to rest near the contact plane may cross
      // this plane earlier in the simulation than in the optimum.
      near = near || (options_.at_rest && as_soft && touch.time < result_.time);
      if ((near && as_soft) || (near && mesh == most_meshes)) return ended(Status::done, {});
      if (mesh == most_meshes) return ended(Status::numerical_failure, "a simulation of the waveform touches at another time");
      problem_.longest_piece /= 2;
      const Status status = improve();
      if (status != Status::done) return ended(near && status != Status::interrupted ? Status::done : status, {});
    }
  }

  const PreparedScene& prepared_;
  const LeastTimeOptions& options_;
  FirstTouchProblem first_touch_;
  ControlProblem problem_;
  ControlledCourse course_;
  LeastTime result_;
};

}  // namespace

LeastTime least_time(const PreparedScene& prepared, const LeastTimeOptions& options) {
  require(options.impact_velocity > 0 && std::isfinite(options.impact_velocity),
          "the permitted impact velocity must be positive");
  LeastTime swung = LeastTimeSearch(prepared, options).from_swing();
  if (options.start.empty() || options.progress.stopped()) return swung;
  LeastTime started = LeastTimeSearch(prepared, options).from_start();
  const bool better = started.status == Status::done && (swung.status != Status::done || started.time < swung.time);
  return better ? started : swung;
}

std::vector<DriveWaveforms> rest_to_rest_starts(const PreparedScene& prepared, Actuator actuator, double impact_velocity,
                                                const Progress& progress) {
  constexpr int most_modes_followed = 4;
  // Times in which a drive's voltage may go from one end of its range to the other, in periods of the first mode.
  constexpr std::array ramps = {1.0 / 9, 1.0 / 18};
  const double period = 2 * pi / prepared.model.basis().angular_frequencies()[0];
  std::vector<DriveWaveforms> found;
  if (prepared.model.modes() > most_modes_followed) return found;
  for (std::size_t k = 0; k < ramps.size() && !progress.stopped(); ++k) {
    const double ramp = ramps[k];
    const Progress own{.stop = progress.stop, .report = [&](std::string_view what, double part) {
                         progress.tell(what, (static_cast<double>(k) + part) / ramps.size());
                       }};
    own.tell("landings at rest to begin with", 0);
    PreparedScene smooth = prepared;
    for (Drive& drive : smooth.drives) {
      if (std::optional<DriverLimits>& limits = drive.limits; limits)
        limits->max_slew = std::min(limits->max_slew, (limits->max_voltage - limits->min_voltage) / (ramp * period));
    }
    try {
      const LeastTimeOptions options{.actuator = actuator, .impact_velocity = impact_velocity, .progress = own};
      std::ranges::move(LeastTimeSearch(smooth, options).ways_to_rest(plain_step(prepared, actuator)), std::back_inserter(found));
    } catch (const InvalidInput&) {
      return {};  // no starts for a scene that FirstTouchProblem refuses
    }
  }
  return found;
}

namespace {

// Delays between first contact and the pull that then keeps the switch closed (catch), as shares of the time of first contact.
// Without a delay, the drives would pull while the modes still swing back from the contact.
constexpr std::array catch_delays = {0.0, 0.005, 0.01, 0.015, 0.02, 0.03, 0.04};

// The catches (pulls after first contact) that can follow the waveforms of `path`, which end at first contact, and their
// simulated closings.
class AfterTouch {
 public:
  AfterTouch(const PreparedScene& prepared, const LeastTime& path, Actuator actuator)
      : prepared_(prepared),
        first_touch_(prepared, actuator, std::isfinite(path.peak) ? path.peak : std::numeric_limits<double>::infinity()),
        plain_(plain_step(prepared, actuator)),
        path_(path),
        until_touch_(path) {
    until_touch_.waveforms = tables_of(first_touch_, path.course);
  }

  // Returns the catch (pull after first contact) under which the switch rebounds least, among catches that begin `delay` after
  // first contact. `delay` and the durations are multiples of the time of first contact.
  [[nodiscard]] Catch best_catch(double delay, const Progress& progress) const {
    // Longest catch, and difference between two tried durations of a catch, as multiples of the time of first contact.
    constexpr double longest = 3, step = 0.1;
    const double period = 2 * pi / prepared_.model.basis().angular_frequencies()[0];
    Catch best;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k * step <= longest && !progress.stopped() && least > 0; ++k) {
      const Catch other{.begin = delay * path_.time, .end = (delay + k * step) * path_.time};
      const std::vector<Signal> signals = applied(prepared_, with_catch(first_touch_, until_touch_, other, plain_), plain_);
      const ClosingOptions options{.duration = path_.time + other.end + period, .tolerance = catch_tolerance};
      const Metrics m = metrics(simulate_closing(prepared_.model, signals, options), prepared_.scene.metrics);
      if (m.major_bounce_height < least) best = other, least = m.major_bounce_height;
    }
    return best;
  }

  [[nodiscard]] LimitLanding landing(const Catch& pulled) const {
    DriveWaveforms all = with_catch(first_touch_, until_touch_, pulled, plain_);
    all.insert(plain_.begin(), plain_.end());
    PreparedScene scene = read_back(with_waveforms(prepared_, all), "best.toml", prepared_);
    Closing closing = simulate(scene, false);
    const auto soft = [](const Metrics& m) { return m.status == Status::done && m.is_bounce_free(); };
    LimitLanding landing{.path = path_,
                         .catch_delay = pulled.begin,
                         .catch_time = pulled.end,
                         .scene = std::move(scene),
                         .closing = std::move(closing)};
    if (!soft(landing.closing.metrics)) return landing;
    landing.checks = run_checks(landing.scene);
    landing.bounce_free =
        std::ranges::all_of(landing.checks, [&](const CheckingRun& c) { return c.varied == Varied::gas || soft(c.metrics); });
    return landing;
  }

 private:
  const PreparedScene& prepared_;
  FirstTouchProblem first_touch_;
  DriveWaveforms plain_;
  const LeastTime& path_;
  LeastTime until_touch_;  // the solution `path_`, with waveforms that end at first contact
};

bool goes_before(const LimitLanding& a, const std::optional<LimitLanding>& b) {
  if (!b) return true;
  if (a.bounce_free != b->bounce_free) return a.bounce_free;
  const Metrics &own = a.closing.metrics, &other = b->closing.metrics;
  return a.bounce_free ? own.permanent_contact_time < other.permanent_contact_time
                       : own.major_bounce_height < other.major_bounce_height;
}

// All least times and closings of one limit() call; progress is reported as each begins.
class LimitStudy {
 public:
  LimitStudy(Limit& result, const Progress& progress)
      : result_(result),
        progress_(progress),
        usual_{.actuator = result.options.actuator,
               .impact_velocity = result.impact_velocity,
               .start = result.options.start,
               .progress = progress},
        parts_(static_cast<double>(3 + (may_be_quicker() ? quicker.size() : 0) + (result.options.curves ? speeds.size() : 0) +
                                   (has_peaks() ? peaks.size() : 0))) {}

  void run() {
    if (next("least time of a touch")) result_.touch = at_speed(1);
    if (next("a landing after it")) land(result_.touch, true);
    for (const double more : quicker) {
      if (may_be_quicker() && next("quicker landings")) land(at_speed(more), true);
    }
    if (next("least time at rest")) {
      LeastTimeOptions at_rest = usual_;
      at_rest.at_rest = true;
      result_.rest = least_time(result_.given, at_rest);
      land(result_.rest, false);
    }
    if (result_.options.curves) {
      for (const double share : speeds) {
        if (next("over the permitted speed")) result_.over_velocity.push_back(at_speed(share));
      }
    }
    if (has_peaks()) over_peaks();
  }

 private:
  // Multiples of the permitted impact velocity at which least times are computed, too, since a harder first contact may allow a
  // quicker bounce-free closing.
  static constexpr std::array quicker = {10.0, 3.0};
  static constexpr std::array speeds = {0.3, 1.0, 3.0, 10.0, 30.0, 100.0};
  static constexpr std::array peaks = {0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95};

  // True if closings with a faster first contact may be tried: the user gave no permitted impact velocity.
  [[nodiscard]] bool may_be_quicker() const { return !result_.options.impact_velocity; }
  [[nodiscard]] bool has_peaks() const { return result_.options.curves && result_.options.actuator != Actuator::pzt; }

  bool next(std::string_view what) {
    progress_.tell(what, done_++ / parts_);
    return !progress_.stopped();
  }

  const LeastTime& at_speed(double share) {
    const auto found = known_.find(share);
    if (found != known_.end()) return found->second;
    LeastTimeOptions other = usual_;
    other.impact_velocity *= share;
    return known_.emplace(share, least_time(result_.given, other)).first->second;
  }

  // Simulates closings with the waveforms of the least-time solution `path`. If `catches`, pulls after first contact (catches)
  // are tried with several delays until a closing is bounce-free. Stores the best closing in the result.
  void land(const LeastTime& path, bool catches) {
    if (path.status != Status::done) return;
    const AfterTouch after(result_.given, path, result_.options.actuator);
    for (const double delay : catch_delays) {
      if (progress_.stopped()) return;
      LimitLanding landing = after.landing(catches ? after.best_catch(delay, progress_) : Catch{});
      const bool is_last = !catches || landing.bounce_free;
      if (goes_before(landing, result_.landing)) result_.landing = std::move(landing);
      if (is_last) return;
    }
  }

  void over_peaks() {
    for (const double share : peaks) {
      if (!next("over the peak voltage")) return;
      LeastTimeOptions lower = usual_;
      lower.peak = share * result_.touch.peak;
      result_.over_peak.push_back(least_time(result_.given, lower));
    }
    if (!progress_.stopped()) result_.over_peak.push_back(result_.touch);
  }

  Limit& result_;
  const Progress& progress_;
  LeastTimeOptions usual_;
  double parts_, done_ = 0;
  std::map<double, LeastTime> known_;  // least times by permitted impact velocity, as a multiple of the default
};

}  // namespace

namespace {

// Throws InvalidInput for an electrode with faces on both sides of the beam if the far face is nearer: any voltage would pull
// the switch away from its contact.
void refuse_what_pulls_away(const PreparedScene& given, Actuator actuator) {
  if (actuator == Actuator::pzt || !has_pulling_electrode(given.scene.device)) return;
  const std::size_t k = searched_drive(given.scene.device);
  if (static_pull_in(given.model, k, bias_of(given.scene, k)).status != Status::no_contact) return;
  given.scene.file.refuse("electrode." + given.scene.device.electrodes[k].name + ".gap", pulls_away);
}

}  // namespace

Limit limit(const SceneFile& file, const LimitOptions& options, const Progress& progress) {
  PreparedScene given = prepare_and_choose(file, true, progress);
  require_open_start(given.scene, "limit closes the switch");
  require(given.model.has_contact(), "limit needs a [contact] section: without contact there is nothing to land on");
  refuse_what_pulls_away(given, options.actuator);
  const std::vector<std::string> names = given.drive_names();
  for (const auto& [name, waveform] : options.start) {
    require(std::find(names.begin(), names.end(), name) != names.end(),
            fmt::format("the waveform to start with is of a drive \"{}\", which the switch does not have", name));
  }
  const std::string elsewhere = initial_state_difference(options.start, options.before, given);
  require(elsewhere.empty(), [&] { return "the waveform to start with: " + elsewhere; });
  Limit result{.given = std::move(given), .options = options};
  const PreparedScene& prepared = result.given;
  result.closed_state = closed_state(prepared, prepared.signals());
  result.hold_warning = hold_warning(prepared.model, prepared.signals(), result.closed_state);
  result.step = simulate(read_back(with_waveforms(prepared, plain_step(prepared, options.actuator)), "step.toml", prepared),
                         false, progress)
                    .metrics;
  progress.throw_if_stopped();
  if (!prepared.scene.spread.empty()) result.approach = stable_approach(prepared, options.actuator);
  if (result.approach) result.quasi_static = quasi_static_speed(*result.approach, prepared, result.step.steady_force_time);
  constexpr double soft = 0.01;  // default permitted impact velocity, as a share of the plain step's
  require_request(options.impact_velocity || std::isfinite(result.step.impact_velocity),
                  [] { return "the plain step does not touch: give " + requested("impact-velocity"); });
  result.impact_velocity = options.impact_velocity.value_or(soft * result.step.impact_velocity);

  LimitStudy(result, progress).run();
  result.interrupted = progress.stopped();
  return result;
}

}  // namespace softland
