#include "studies/devices/contact_states.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <utility>

#include "base/engineering.h"
#include "base/executor.h"
#include "base/require.h"
#include "objectives/course_recorder.h"
#include "studies/closing/resistance_course.h"
#include "studies/closing/simulate.h"
#include "studies/devices/device_drives.h"
#include "studies/devices/ensemble.h"

namespace softland {
namespace {

// Records when a contact is closed in a run, and the knots (points between integrator steps) of the motion if the contact
// resistance is known.
class StatesObserver final : public ClosingObserver {
 public:
  explicit StatesObserver(const Switch& model)
      : spans_(model.contacts() > 1 ? 1 + model.contacts() : 1),
        conducts_(std::ranges::any_of(model.device().contacts, [](const Contact& one) { return one.conduction.is_given(); })),
        course_(model.contact_gap()) {
    for (std::size_t c = 0; c < model.contacts() && model.contacts() > 1; ++c) course_.follow_contact(model.contact_gap(c), {});
  }
  [[nodiscard]] bool follows_state() const override { return true; }
  void state(std::optional<std::size_t> contact, bool is_closed, double time) override {
    std::vector<ClosedSpan>& spans = spans_[contact ? *contact + 1 : 0];
    if (is_closed)
      spans.push_back({.begin = time});
    else
      spans.back().end = time;
  }
  void knot(const TrajectoryPoint& point) override {
    if (conducts_) course_.knot(point);
  }
  [[nodiscard]] ClosingObserver* contact(std::size_t number) override { return conducts_ ? course_.contact(number) : nullptr; }
  void hand_over(Trajectory& run) { course_.hand_over(run); }

  /// Returns the time spans in which the connection is closed, then those of each of several contacts.
  [[nodiscard]] std::vector<std::vector<ClosedSpan>>& spans() { return spans_; }

 private:
  std::vector<std::vector<ClosedSpan>> spans_;
  bool conducts_;
  CourseRecorder course_;
};

// Joins time spans with a closed contact that are separated by an opening of at most `shortest_opening` [s].
void join(std::vector<ClosedSpan>& spans, double shortest_opening) {
  constexpr double rounding = 1e-12;  // relative difference below which two times are equal
  std::vector<ClosedSpan> joined;
  for (ClosedSpan& span : spans) {
    if (!joined.empty() && span.begin - joined.back().end <= std::max(shortest_opening, rounding * span.begin))
      joined.back().end = span.end;
    else
      joined.push_back(std::move(span));
  }
  spans = std::move(joined);
}

// Leaves out the points of a resistance over time that linear interpolation between the remaining points reproduces.
ResistanceLine on_lines(const ResistanceLine& points) {
  constexpr double near = 1e-3;  // permitted relative error of the interpolated resistance
  constexpr double any = std::numeric_limits<double>::infinity();
  ResistanceLine kept;
  // Range of slopes from the last retained point that reproduce the points after it within the permitted error.
  double least = -any, most = any;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto slope_to = [&](std::size_t k, double factor) {
      return (factor * points[k].second - kept.back().second) / (points[k].first - kept.back().first);
    };
    if (kept.empty()) {
      kept.push_back(points[i]);
      continue;
    }
    if (const double slope = slope_to(i, 1); slope < least || slope > most) {
      kept.push_back(points[i - 1]);
      least = -any, most = any;
    }
    least = std::max(least, slope_to(i, 1 - near));
    most = std::min(most, slope_to(i, 1 + near));
  }
  if (points.size() > 1) kept.push_back(points.back());
  return kept;
}

struct ResistanceSample {
  // Time [s], and contact resistance at this time [Ohm]; NaN if the resistance is not reported.
  double time = 0, resistance = 0;
  bool ends = false;        // true if the sample is the end of a span in which the contact is closed
  bool is_on_line = false;  // true if linear interpolation from this sample to the next one is accurate enough
};

/// Returns the contact resistances at increasing times [Ohm]; NaN where they are not reported.
using ResistanceCourse = std::function<std::vector<double>(const std::vector<double>&)>;

// Returns samples of the contact resistance while the contact is closed: at the knots of the run (points between integrator
// steps), and between knots until linear interpolation is accurate.
std::vector<ResistanceSample> resistance_samples(const std::vector<ClosedSpan>& spans, const ResistanceCourse& course,
                                                 const std::vector<double>& knots, double end) {
  // Permitted relative error of the interpolated resistance, and shortest interval between samples [s].
  constexpr double near = 1e-2, shortest = 2e-12;
  std::vector<ResistanceSample> samples;
  for (const ClosedSpan& span : spans) {
    const double last = std::min(span.end, end);
    samples.push_back({.time = span.begin});
    for (auto knot = std::ranges::upper_bound(knots, span.begin); knot != knots.end() && *knot < last; ++knot)
      samples.push_back({.time = *knot});
    samples.push_back({.time = std::max(span.begin, last), .ends = true});
  }
  std::vector<double> times;
  for (const ResistanceSample& one : samples) times.push_back(one.time);
  const std::vector<double> at_knots = course(times);
  for (std::size_t i = 0; i < at_knots.size(); ++i) samples[i].resistance = at_knots[i];
  for (bool goes_on = true; goes_on;) {
    const auto is_open = [&](std::size_t i) {
      return !samples[i].ends && !samples[i].is_on_line && samples[i + 1].time - samples[i].time > shortest;
    };
    times.clear();
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (is_open(i)) times.push_back(std::midpoint(samples[i].time, samples[i + 1].time));
    const std::vector<double> between = course(times);
    std::vector<ResistanceSample> finer;
    for (std::size_t i = 0, k = 0; i < samples.size() && k <= between.size(); ++i) {
      finer.push_back(samples[i]);
      if (!is_open(i)) continue;
      const double line = std::midpoint(samples[i].resistance, samples[i + 1].resistance), found = between[k];
      const bool none = std::isnan(found) && std::isnan(samples[i].resistance) && std::isnan(samples[i + 1].resistance);
      finer.back().is_on_line = none || std::abs(line - found) <= near * found;
      if (!finer.back().is_on_line) finer.push_back({.time = times[k], .resistance = found});
      ++k;
    }
    goes_on = finer.size() > samples.size();
    samples = std::move(finer);
  }
  return samples;
}

// Adds the contact resistance to the spans in which the contact is closed. If the resistance at the begin or end of a span is
// not reported, it is set to the resistance at the nearest time with a reported value.
void add_resistance(std::vector<ClosedSpan>& spans, const ResistanceCourse& course, const std::vector<double>& knots,
                    double end) {
  auto span = spans.begin();
  ResistanceLine points;
  for (const ResistanceSample& sample : resistance_samples(spans, course, knots, end)) {
    if (std::isfinite(sample.resistance)) points.emplace_back(sample.time, sample.resistance);
    if (!sample.ends) continue;
    if (!points.empty() && points.front().first > span->begin)
      points.insert(points.begin(), {span->begin, points.front().second});
    if (!points.empty() && points.back().first < sample.time) points.emplace_back(sample.time, points.back().second);
    span->resistance = on_lines(std::exchange(points, {}));
    ++span;
  }
}

std::vector<double> knots_of(const Trajectory& run) {
  std::vector<double> knots;
  const auto add = [&](const std::vector<TrajectoryPoint>& points) {
    for (const TrajectoryPoint& point : points) knots.push_back(point.time);
  };
  add(run.points);
  for (const ContactOutcome& contact : run.contacts) add(contact.points);
  std::ranges::sort(knots);
  knots.erase(std::ranges::unique(knots).begin(), knots.end());
  return knots;
}

struct StatesOfRun {
  std::vector<StateChannel> channels;
  Status status = Status::not_run;
  std::string why_not_done = {};
};

StatesOfRun states_of(const Switch& model, const std::vector<Signal>& signals, const ClosingOptions& options) {
  StatesObserver observer(model);
  Trajectory run = observe_closing(model, signals, options, observer);
  observer.hand_over(run);
  StatesOfRun found{.channels = {}, .status = run.status};
  if (run.status != Status::done) found.why_not_done = run.message.empty() ? std::string(to_string(run.status)) : run.message;
  const Device& device = model.device();
  const std::vector<double> knots = knots_of(run);
  const double end = knots.empty() ? options.duration : knots.back();
  for (std::size_t k = 0; k < observer.spans().size(); ++k) {
    const std::optional<std::size_t> contact = k > 0 ? std::optional(k - 1) : std::nullopt;
    StateChannel one{.contact = contact ? device.contacts[*contact].name : std::string(),
                     .has_resistance = conducts(device, contact),
                     .spans = std::move(observer.spans()[k])};
    join(one.spans, device.electrical.shortest_opening());
    const auto course = [&](const std::vector<double>& times) {
      std::vector<double> resistances = resistance_course(device, run, times, contact);
      for (double& resistance : resistances)
        if (!(resistance <= largest_resistance)) resistance = std::numeric_limits<double>::quiet_NaN();
      return resistances;
    };
    if (one.has_resistance) add_resistance(one.spans, course, knots, end);
    found.channels.push_back(std::move(one));
  }
  return found;
}

void require_contact(const PreparedScene& prepared) {
  if (!prepared.model.has_contact())
    throw InvalidInput(
        fmt::format("{}: needs a [contact] section: without one nothing closes or opens", prepared.scene.file.name()));
}

void note_early_end(const StatesOfRun& run, const std::string& whose, const NoteSink& note) {
  if (!run.why_not_done.empty())
    note(fmt::format("{}the run does not come to its end; its last states are kept from there on: {}", whose, run.why_not_done));
}

}  // namespace

StateRecord contact_states(const PreparedScene& prepared, const Progress& progress, const NoteSink& note) {
  require_contact(prepared);
  const Closing closing = simulate(prepared, true, progress);
  progress.throw_if_stopped();
  // Repeat the run that gave the figures of the closing, with an observer of the contact states.
  const bool is_tighter = closing.tolerance != prepared.tolerance;
  const Switch tighter = is_tighter ? Switch(prepared.scene.device, closing.quadrature) : prepared.model;
  constexpr double never = std::numeric_limits<double>::infinity();
  StatesOfRun run = states_of(tighter, prepared.signals(),
                              {.duration = prepared.duration,
                               .tolerance = closing.tolerance,
                               .start = prepared.start(),
                               .opens_at = closing.command ? closing.command->time : never,
                               .stop = progress.stop});
  progress.throw_if_stopped();
  note_early_end(run, "", note);
  return {.end = prepared.duration, .channels = std::move(run.channels)};
}

StateRecord contact_states_of_devices(const PreparedScene& nominal, std::size_t devices, std::uint64_t seed, int jobs,
                                      const Progress& progress, const NoteSink& note) {
  require_contact(nominal);
  const Ensemble ensemble(nominal, devices, seed);
  const DeviceDrives drives(nominal);
  const std::vector<Waveform> waveforms = nominal.waveforms();
  std::vector<StatesOfRun> runs(devices);
  std::mutex telling;
  std::size_t done = 0;
  const auto task = [&](std::size_t k) {
    const SampledDevice device = DeviceBuilder(ensemble).device(k);
    if (device.model) {
      runs[k] = states_of(
          *device.model, drives.signals(waveforms, {}, device.values),
          {.duration = nominal.duration, .tolerance = nominal.tolerance, .start = nominal.start(), .stop = progress.stop});
    } else {
      runs[k].why_not_done = device.refusal;
    }
    const std::scoped_lock lock(telling);
    progress.tell("devices of the spread", static_cast<double>(++done) / static_cast<double>(devices));
  };
  run_tasks(devices, jobs, task, progress.stop);
  progress.throw_if_stopped();
  StateRecord record{.end = nominal.duration, .channels = {}};
  for (std::size_t k = 0; k < devices; ++k) {
    if (runs[k].channels.empty()) {
      note(fmt::format("device {} is left out: {}", k, runs[k].why_not_done));
      continue;
    }
    note_early_end(runs[k], fmt::format("device {}: ", k), note);
    for (StateChannel& one : runs[k].channels) {
      one.device = k;
      record.channels.push_back(std::move(one));
    }
  }
  return record;
}

}  // namespace softland
