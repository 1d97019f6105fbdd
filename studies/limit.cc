#include "studies/limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/require.h"
#include "model/closing.h"
#include "model/constants.h"
#include "studies/choices.h"
#include "studies/free_flight.h"
#include "studies/plain_step.h"
#include "studies/search_setting.h"

namespace softland {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int first_knots = 48;       // intervals of the controls before they are refined
constexpr double piece_angle = 0.75;  // of the fastest mode in a piece of the mesh
// Of the optimum and a simulation: relative, of the time of the touch, or of the gap as far as one misses it.
constexpr double agreement = 1e-4;
constexpr double longest_swing = 3;        // periods of the first mode
constexpr double grazing = 0.9;            // of the permitted speed: what a landing at rest touches with at least
constexpr double softness = 0.2;           // of the permitted speed: how much faster a simulation may touch
constexpr double search_tolerance = 1e-6;  // of the integrator, where catches are compared
constexpr int refinements = 3;             // of the knots: each halves their shortest interval
constexpr int most_meshes = 3;             // each half as wide as the one before

// Of the gap: how near every mode comes to its place in the closed equilibrium.
constexpr std::array rest_rooms = {0.1, 0.03, 0.01, 0.003, 0.001, 0.0003};

std::vector<double> uniform_knots(int intervals) {
  std::vector<double> knots;
  for (int k = 0; k <= intervals; ++k) knots.push_back(static_cast<double>(k) / intervals);
  return knots;
}

// The controls as tables of volts against time, which pull from the touch on.
std::map<std::string, Waveform> tables_of(const FreeFlight& flight, const ControlledCourse& course) {
  const double end = course.time * flight.time_unit();
  std::map<std::string, Table> tables;
  const auto add = [&](double time, const std::map<std::string, double>& volts) {
    for (const auto& [name, value] : volts) {
      Table& table = tables[name];
      table.time.push_back(time);
      table.voltage.push_back(value);
    }
  };
  const auto columns = course.controls.cols();
  const auto at = [&](Index column) { return flight.volts(course.controls.col(column)); };
  if (flight.ramps()) {
    for (Index k = 0; k < columns; ++k) add(course.knots[static_cast<std::size_t>(k)] * end, at(k));
  } else {
    // What differs by less than the solver's own error is one level.
    constexpr double same = 1e-9;
    Index level = 0;
    add(0, at(0));
    for (Index k = 1; k < columns; ++k) {
      if ((course.controls.col(k) - course.controls.col(level)).cwiseAbs().maxCoeff() < same) continue;
      const double time = course.knots[static_cast<std::size_t>(k)] * end;
      add(time, at(level));
      add(time, at(k));
      level = k;
    }
    add(end, at(level));
  }
  std::map<std::string, Waveform> waveforms;
  for (auto& [name, table] : tables) waveforms.emplace(name, std::move(table));
  return waveforms;
}

// What follows the touch: a pull until `until` [s], then the hold levels.
std::map<std::string, Waveform> with_catch(const FreeFlight& flight, const LeastTime& found, double until,
                                           const std::map<std::string, Waveform>& held) {
  std::map<std::string, Waveform> caught = found.waveforms;
  const std::map<std::string, double> pull = flight.volts(flight.pull());
  const double end = found.course.time * flight.time_unit();
  for (auto& [name, waveform] : caught) {
    Table& table = std::get<Table>(waveform);
    const auto hold_of = held.find(name);
    const double hold = hold_of == held.end() ? 0 : signal(hold_of->second).hold_level();
    const auto pass_to = [&](double time, double volts) {
      const double begin = std::max(time, table.time.back()), from = table.voltage.back();
      table.time.insert(table.time.end(), {begin, begin + std::abs(volts - from) / flight.max_slew(name)});
      table.voltage.insert(table.voltage.end(), {from, volts});
    };
    if (until > end) pass_to(end, pull.at(name));
    pass_to(until, hold);
  }
  return caught;
}

// The drives under searched waveforms; what is not searched is that of the plain step, else of the scene.
std::vector<Signal> driven(const Prepared& prepared, std::map<std::string, Waveform> searched,
                           const std::map<std::string, Waveform>& plain) {
  searched.insert(plain.begin(), plain.end());
  searched.insert(prepared.drives.waveforms.begin(), prepared.drives.waveforms.end());
  return prepared.driven(signals_of(prepared.in_drive_order(searched)));
}

struct Arrival {
  double time = std::numeric_limits<double>::quiet_NaN(), velocity = time;
};

Arrival arrival(const Prepared& prepared, const std::map<std::string, Waveform>& searched, Actuator actuator, double window) {
  const ClosingOptions options{.duration = window, .tolerance = std::min(prepared.tolerance, 1e-8), .after_contact = 0};
  const Trajectory run = simulate_closing(prepared.model, driven(prepared, searched, plain_step(prepared, actuator)), options);
  const Metrics m = metrics(run);
  return {m.initial_contact_time, m.impact_velocity};
}

}  // namespace

LeastTime least_time(const Prepared& prepared, const LeastTimeOptions& options) {
  require(options.impact_velocity > 0 && std::isfinite(options.impact_velocity),
          "the permitted impact velocity must be positive");
  FreeFlight flight(prepared, options.actuator, options.peak);
  LeastTime result;
  result.permitted = options.impact_velocity;
  const auto ended = [&](Status status, std::string why) {
    result.status = status;
    result.message = std::move(why);
    return result;
  };
  if (options.actuator != Actuator::pzt) {
    const DriverLimits& limits = prepared.drives.limits.at(searched_electrode(prepared.scene.device));
    result.peak = std::min(options.peak, std::max(std::abs(limits.max_voltage), std::abs(limits.min_voltage)));
  }
  const double longest = longest_swing * 2 * pi / prepared.model.angular_frequencies()[0];
  std::optional<ControlledCourse> guess = flight.swing(longest);
  if (!guess) return ended(Status::no_contact, "full pull does not bring the switch to its contact");
  std::optional<VectorXd> landed;
  if (options.at_rest) {
    landed = flight.landed();
    if (!landed) return ended(Status::no_contact, "the hold levels do not keep the switch closed");
  }

  const double speed = options.impact_velocity / flight.speed_unit();
  const double fastest = prepared.model.angular_frequencies().maxCoeff() * flight.time_unit();
  ControlProblem problem{
      .system = &flight,
      .start = flight.start(),
      .bounds = flight.bounds(),
      .on_the_way = {{.row = flight.tip(), .upper = 1}},
      .at_the_end = {{.row = flight.tip(), .lower = 1, .upper = 1},
                     {.row = flight.tip_speed(), .lower = (options.at_rest ? grazing : 0) * speed, .upper = speed}},
      .shortest = guess->time / 10,
      .longest = longest / flight.time_unit(),
      .knots = uniform_knots(first_knots),
      .longest_piece = piece_angle / (fastest * guess->time),
      .stop = options.watch.stop};
  // A beam at rest under the hold levels stays so where the drives have come to them.
  for (Index k = 0; landed && flight.ramps() && k < flight.controls(); ++k)
    problem.bounds[static_cast<std::size_t>(k)].after = flight.hold()[k];
  const double finest = 1.0 / (first_knots * std::exp2(refinements));
  // A failure leaves the last course.
  const auto improve = [&] {
    ControlledCourse course = solve(problem, *guess);
    result.message = course.message;
    if (course.interrupted) return Status::interrupted;
    if (!course.converged) return Status::numerical_failure;
    guess = std::move(course);
    return Status::done;
  };
  const auto improve_with_finer_knots = [&] {
    for (;;) {
      if (const Status status = improve(); status != Status::done) return status;
      std::vector<double> knots = refined_knots(*guess, problem.bounds, finest);
      if (knots.size() == problem.knots.size()) return Status::done;
      problem.knots = std::move(knots);
    }
  };
  if (landed) {
    // The modes are brought to rest little by little: at once Ipopt finds no way.
    const Index n = flight.states();
    for (Index r = 0; r < n; ++r) problem.at_the_end.push_back({.row = VectorXd::Unit(n, r)});
    const auto leave = [&](double room) {
      for (Index r = 0; r < n; ++r) {
        StateCondition& mode = problem.at_the_end[static_cast<std::size_t>(r) + 2];
        mode.lower = (*landed)[r] - room;
        mode.upper = (*landed)[r] + room;
      }
    };
    for (const double room : rest_rooms) {
      leave(room);
      const Status status = improve();
      if (status == Status::interrupted) return ended(status, {});
      if (status != Status::done) break;
      result.room = room;
    }
    if (std::isnan(result.room)) return ended(Status::numerical_failure, result.message);
    leave(result.room);
  }
  if (const Status status = improve_with_finer_knots(); status != Status::done) return ended(status, result.message);

  for (int mesh = 1;; ++mesh) {
    result.course = *guess;
    result.time = guess->time * flight.time_unit();
    result.impact_velocity = flight.tip_speed().dot(guess->states.col(guess->states.cols() - 1)) * flight.speed_unit();
    result.waveforms = with_catch(flight, {.waveforms = tables_of(flight, *guess), .course = *guess}, 2 * result.time, {});
    const Arrival touch = arrival(prepared, result.waveforms, options.actuator, 2 * result.time);
    result.simulated_time = touch.time;
    result.simulated_velocity = touch.velocity;
    const double apart = std::abs(touch.time - result.time);
    const double missed = apart * std::max(touch.velocity, result.impact_velocity);
    bool near = apart <= agreement * result.time || missed <= agreement * prepared.scene.device.gap.contact;
    const bool as_soft = touch.velocity <= result.impact_velocity + softness * options.impact_velocity;
    // A contact point that comes to rest beside its plane may graze it before.
    near = near || (options.at_rest && as_soft && touch.time < result.time);
    if ((near && as_soft) || (near && mesh == most_meshes)) return ended(Status::done, {});
    if (mesh == most_meshes) return ended(Status::numerical_failure, "a simulation of the waveform touches at another time");
    problem.longest_piece /= 2;
    const Status status = improve();
    if (status != Status::done) return ended(near && status != Status::interrupted ? Status::done : status, {});
  }
}

namespace {

// The catch that rebounds least, of those that end up to a few times the time of the touch after it.
double best_catch(const Prepared& prepared, const FreeFlight& flight, const LeastTime& found,
                  const std::map<std::string, Waveform>& plain, const Watch& watch) {
  constexpr double longest_catch = 3, step = 0.1;  // times that of the touch
  const double period = 2 * pi / prepared.model.angular_frequencies()[0];
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (int k = 0; k * step <= longest_catch && !watch.stopped(); ++k) {
    const std::vector<Signal> signals = driven(prepared, with_catch(flight, found, (1 + k * step) * found.time, plain), plain);
    const ClosingOptions options{.duration = (1 + k * step) * found.time + period, .tolerance = search_tolerance};
    const Metrics m = metrics(simulate_closing(prepared.model, signals, options), prepared.scene.metrics);
    if (!(m.major_bounce_height < least)) continue;
    least = m.major_bounce_height;
    best = k * step * found.time;
    if (least == 0) break;
  }
  return best;
}

LimitLanding landing_of(const Prepared& prepared, const LeastTime& found, Actuator actuator, bool catches, const Watch& watch) {
  const FreeFlight flight(prepared, actuator, std::isfinite(found.peak) ? found.peak : std::numeric_limits<double>::infinity());
  const std::map<std::string, Waveform> plain = plain_step(prepared, actuator);
  LeastTime until_touch = found;
  until_touch.waveforms = tables_of(flight, found.course);
  const double catch_time = catches ? best_catch(prepared, flight, until_touch, plain, watch) : 0;
  std::map<std::string, Waveform> all = with_catch(flight, until_touch, found.time + catch_time, plain);
  all.insert(plain.begin(), plain.end());
  Prepared scene = read_back(with_waveforms(prepared, all), "best.toml", prepared);
  Closing closing = simulate(scene, false);
  const auto soft = [](const Metrics& m) { return m.status == Status::done && m.settled && m.bounce_count == 0; };
  LimitLanding landing{.way = found, .catch_time = catch_time, .scene = std::move(scene), .closing = std::move(closing)};
  if (!soft(landing.closing.metrics)) return landing;
  landing.checks = confirm(landing.scene);
  landing.bounce_free =
      std::all_of(landing.checks.begin(), landing.checks.end(), [&](const ConfirmingRun& c) { return soft(c.metrics); });
  return landing;
}

bool is_better(const LimitLanding& a, const std::optional<LimitLanding>& b) {
  if (!b) return true;
  if (a.bounce_free != b->bounce_free) return a.bounce_free;
  const Metrics &own = a.closing.metrics, &other = b->closing.metrics;
  return a.bounce_free ? own.permanent_contact_time < other.permanent_contact_time
                       : own.major_bounce_height < other.major_bounce_height;
}

}  // namespace

Limit limit(const SceneFile& file, const LimitOptions& options, const Watch& watch) {
  Prepared given = prepare_and_choose(file, true, watch);
  require(given.model.has_contact(), "limit needs a [contact] section: without contact there is nothing to land on");
  Limit result{.given = std::move(given), .options = options};
  const Prepared& prepared = result.given;
  result.step =
      simulate(read_back(with_waveforms(prepared, plain_step(prepared, options.actuator)), "step.toml", prepared), false, watch)
          .metrics;
  watch.throw_if_stopped();
  constexpr double soft = 0.01;  // of the plain step's impact velocity
  require(options.impact_velocity || std::isfinite(result.step.impact_velocity),
          "the plain step does not touch: give --impact-velocity");
  result.impact_velocity = options.impact_velocity.value_or(soft * result.step.impact_velocity);

  const LeastTimeOptions usual{.actuator = options.actuator, .impact_velocity = result.impact_velocity, .watch = watch};
  std::map<double, LeastTime> known;  // by the speed over the permitted one
  const auto at_speed = [&](double share) -> const LeastTime& {
    const auto found = known.find(share);
    if (found != known.end()) return found->second;
    LeastTimeOptions other = usual;
    other.impact_velocity *= share;
    return known.emplace(share, least_time(prepared, other)).first->second;
  };
  constexpr std::array quicker = {10.0, 3.0};  // times the permitted speed
  constexpr std::array speeds = {0.3, 1.0, 3.0, 10.0, 30.0, 100.0};
  constexpr std::array peaks = {0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95};
  const bool over_peaks = options.curves && options.actuator != Actuator::pzt;
  const auto parts =
      static_cast<double>(3 + quicker.size() + (options.curves ? speeds.size() : 0) + (over_peaks ? peaks.size() : 0));
  double done = 0;
  const auto next = [&](std::string_view what) {
    watch.tell(what, done++ / parts);
    return !watch.stopped();
  };
  const auto land = [&](const LeastTime& way, bool catches) {
    if (way.status != Status::done || watch.stopped()) return;
    LimitLanding landing = landing_of(prepared, way, options.actuator, catches, watch);
    if (is_better(landing, result.landing)) result.landing = std::move(landing);
  };
  if (next("least time of a touch")) result.touch = at_speed(1);
  if (next("a landing after it")) land(result.touch, true);
  for (const double more : quicker) {
    if (next("quicker landings")) land(at_speed(more), true);
  }
  if (next("least time at rest")) {
    LeastTimeOptions at_rest = usual;
    at_rest.at_rest = true;
    result.rest = least_time(prepared, at_rest);
    land(result.rest, false);
  }
  if (options.curves) {
    for (const double share : speeds) {
      if (next("over the permitted speed")) result.over_velocity.push_back(at_speed(share));
    }
  }
  if (over_peaks) {
    for (const double share : peaks) {
      if (!next("over the peak voltage")) break;
      LeastTimeOptions lower = usual;
      lower.peak = share * result.touch.peak;
      result.over_peak.push_back(least_time(prepared, lower));
    }
    if (!watch.stopped()) result.over_peak.push_back(result.touch);
  }
  result.interrupted = watch.stopped();
  return result;
}

}  // namespace softland
