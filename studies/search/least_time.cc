#include "studies/search/least_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "base/require.h"
#include "model/constants.h"
#include "studies/closing/plain_step.h"
#include "studies/closing/simulate.h"
#include "studies/search/first_touch_problem.h"
#include "studies/search/path_waveforms.h"

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
    result_.iterations += course.iterations;
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
    result_.stage = SearchStage::slower_touch;
    for (const bool slows = speed > too_fast * permitted; slows && speed > permitted && status == Status::done; speed /= step) {
      problem_.at_the_end[1].upper = speed;
      status = improve();
    }
    problem_.at_the_end[1].upper = permitted;
    return status;
  }

  Status improve_with_finer_knots() {
    result_.stage = SearchStage::finer_controls;
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
    result_.stage = SearchStage::modes_to_rest;
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
    result_.stage = SearchStage::finer_mesh;
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
      if (status != Status::done && near && status != Status::interrupted) return ended(Status::done, {});
      if (status != Status::done) return ended(status, result_.message);
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

std::vector<LeastTime> least_time_by_start(const PreparedScene& prepared, const LeastTimeOptions& options) {
  require(options.impact_velocity > 0 && std::isfinite(options.impact_velocity),
          "the permitted impact velocity must be positive");
  std::vector<LeastTime> found{LeastTimeSearch(prepared, options).from_swing()};
  if (!options.start.empty() && !options.progress.stopped()) found.push_back(LeastTimeSearch(prepared, options).from_start());
  return found;
}

std::size_t place_of_least(const std::vector<LeastTime>& by_start) {
  std::size_t least = 0;
  for (std::size_t k = 1; k < by_start.size(); ++k) {
    const LeastTime &own = by_start[k], &other = by_start[least];
    if (own.status == Status::done && (other.status != Status::done || own.time < other.time)) least = k;
  }
  return least;
}

LeastTime least_time(const PreparedScene& prepared, const LeastTimeOptions& options) {
  std::vector<LeastTime> found = least_time_by_start(prepared, options);
  return std::move(found[place_of_least(found)]);
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

}  // namespace softland
