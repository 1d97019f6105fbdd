#include "studies/devices/cycling.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "base/engineering.h"
#include "base/executor.h"
#include "base/require.h"
#include "model/closing.h"
#include "model/constants.h"
#include "studies/closing/hold.h"
#include "studies/closing/open_command.h"
#include "studies/closing/plain_step.h"
#include "studies/devices/ensemble.h"

namespace softland {
namespace {

constexpr double slower = 1.5;  // factor by which the first cycle rate of a scan is lowered if the cycles at this rate differ
constexpr int most_slower = 6;  // largest number of reductions of the first cycle rate
// Number of periods of the first mode within which the switch must come to rest after opening.
constexpr double periods_of_opening = 60;

// Appends the pieces of `signal` that begin before `until`, delayed by `later` [s].
void append(std::vector<SignalPiece>& pieces, const Signal& signal, double until, double later) {
  for (SignalPiece piece : signal.pieces()) {
    if (piece.begin >= until) break;
    piece.begin += later;
    piece.phase -= piece.angular_frequency * later;
    pieces.push_back(std::move(piece));
  }
}

// Records the figures of the cycles of closing and opening, and the motion of the contact point.
class KeptCourse final : public ClosingObserver {
 public:
  explicit KeptCourse(CycleRecorder& recorder, double contact_gap) : recorder_(recorder), contact_gap_(contact_gap) {}
  void knot(const TrajectoryPoint& point) override {
    recorder_.knot(point);
    gap.emplace_back(point.time, contact_gap_ - point.position);
  }
  void touch(const Touch& touch) override {
    recorder_.touch(touch);
    touches.push_back(touch);
  }
  [[nodiscard]] bool follows_state() const override { return true; }
  void state(std::optional<std::size_t> contact, bool is_closed, double time) override {
    recorder_.state(contact, is_closed, time);
  }
  [[nodiscard]] bool takes_energies() const override { return true; }
  void energies(double time, const EnergyBalance& balance) override { recorder_.energies(time, balance); }

  std::vector<std::pair<double, double>> gap;
  std::vector<Touch> touches;

 private:
  CycleRecorder& recorder_;
  double contact_gap_;
};

}  // namespace

std::vector<Signal> cycled(const CycleWaveforms& waveforms, const CycleTimes& times) {
  std::vector<Signal> all;
  for (std::size_t k = 0; k < waveforms.closing.size(); ++k) {
    std::vector<SignalPiece> pieces;
    for (std::size_t n = 0; n < times.cycles; ++n) {
      append(pieces, waveforms.closing[k], times.on_time, times.begin(n));
      append(pieces, waveforms.opening[k], times.begin(n + 1) - times.command(n), times.command(n));
    }
    pieces.push_back({.begin = times.begin(times.cycles), .value = waveforms.opening[k].hold_level()});
    all.emplace_back(std::move(pieces), waveforms.closing[k].before());
  }
  return all;
}

bool closes_alike(const CycleFigures& cycle, const CycleFigures& first, const CycleTolerances& tolerances) {
  if (!cycle.closes || !cycle.opens) return false;
  const auto differs = [&](double own, double of_first, double least) {
    return !(std::abs(own - of_first) <= std::max(tolerances.share * of_first, least));
  };
  const Metrics &own = cycle.metrics, &other = first.metrics;
  return !differs(own.largest_impact_velocity, other.largest_impact_velocity, 0) &&
         !differs(own.major_bounce_height, other.major_bounce_height, tolerances.rebound);
}

CycledSwitch::CycledSwitch(const PreparedScene& driven, const Switch& model, const CycleWaveforms& waveforms)
    : driven_(driven), model_(model), waveforms_(waveforms), options_(driven.scene.metrics) {
  if (const auto open = model.open_equilibrium(hold_levels(waveforms.opening)))
    options_.opening.open_position = connection_deflection(model, *open);
}

Trajectory CycledSwitch::observe(const CycleTimes& times, ClosingObserver& observer, const Progress& progress,
                                 const std::function<bool()>& is_enough) const {
  PreparedScene whole = driven_;
  whole.duration = times.begin(times.cycles);
  const std::vector<Signal> signals = whole.applied(cycled(waveforms_, times));
  ClosingOptions options{.duration = whole.duration, .tolerance = driven_.tolerance, .stop = progress.stop};
  options.max_steps *= static_cast<long>(times.cycles);
  options.observer = [&](double time, const double*, const double*) {
    progress.tell("cycles", time / whole.duration);
    return is_enough && is_enough();
  };
  return observe_closing(model_, signals, options, observer);
}

Cycles CycledSwitch::run(const CycleTimes& times, bool is_told, const Progress& progress) const {
  CycleRecorder recorder(model_.contact_gap(),
                         is_told ? with_load(options_, model_, StartState::open, waveforms_.closing) : options_, times);
  KeptCourse course(recorder, model_.contact_gap());
  const Trajectory run = is_told ? observe(times, course, progress, {}) : observe(times, recorder, progress, {});
  Cycles found{.times = times,
               .status = run.status,
               .message = run.message,
               .cycles = {},
               .gap = std::move(course.gap),
               .touches = std::move(course.touches)};
  for (std::size_t n = 0; n < recorder.ended(); ++n) found.cycles.push_back(recorder.figures(n, run));
  return found;
}

// Returns true if all cycles close and open as the first one does. A touch is reported only at the beginning of the next touch,
// so a cycle is checked when the next cycle has ended.
bool CycledSwitch::is_steady(const CycleTimes& times, const CycleTolerances& tolerances, const Progress& progress) const {
  CycleRecorder recorder(model_.contact_gap(), options_, times);
  Trajectory so_far;
  so_far.in_contact_period = model_.basis().in_contact_period();
  std::size_t judged = 0;
  bool is_steady = true;
  std::optional<CycleFigures> first;
  const auto judge = [&](std::size_t until, const Trajectory& run) {
    for (; judged < until && is_steady; ++judged) {
      const CycleFigures own = recorder.figures(judged, run);
      if (!first) first = own;
      is_steady = closes_alike(own, *first, tolerances);
    }
    return !is_steady;
  };
  const Trajectory run =
      observe(times, recorder, progress, [&] { return recorder.ended() > judged + 1 && judge(recorder.ended() - 1, so_far); });
  if (!is_steady || run.status != Status::done || recorder.ended() < times.cycles) return false;
  judge(times.cycles, run);
  return is_steady;
}

CycledSwitch::PartTimes CycledSwitch::part_times(const Progress& progress) const {
  const double period = 2 * pi / model_.basis().angular_frequencies()[0], in_contact = model_.basis().in_contact_period();
  const double close = last_breakpoint(waveforms_.closing), open = last_breakpoint(waveforms_.opening);
  const double on = std::max(driven_.duration, close + in_contact), off = open + periods_of_opening * period;
  PartTimes times;
  const Cycles one = run({.period = on + off, .on_time = on}, false, progress);
  if (one.cycles.empty()) return times;
  const Metrics& m = one.cycles.front().metrics;
  if (m.touched()) times.least_on = std::max(m.initial_contact_time, close), times.least_off = open;
  if (!m.settled || !std::isfinite(m.release_settling_time)) return times;
  times.rest_on = std::max(m.permanent_contact_time + in_contact, close);
  times.rest_off = std::max(m.release_settling_time, open) + period;
  return times;
}

RateScan scan_rates(const CycledSwitch& cycled, const ScanOptions& options, const Progress& progress) {
  RateScan scan;
  const auto rate_of = [&](double on, double off) { return 1 / std::max(on / options.duty, off / (1 - options.duty)); };
  const auto is_steady_at = [&](double rate) {
    return cycled.is_steady({.period = 1 / rate, .on_time = options.duty / rate, .cycles = options.cycles}, options.tolerances,
                            {.stop = progress.stop});
  };
  const CycledSwitch::PartTimes times = cycled.part_times(progress);
  double lowest = rate_of(times.rest_on, times.rest_off);
  const double highest = rate_of(times.least_on, times.least_off);
  if (!(lowest > 0)) return scan;
  // At the lowest rate a remaining vibration may still affect the next closing: lower the rate until all cycles are alike.
  for (int k = 0; k < most_slower && !progress.stopped() && !is_steady_at(lowest); ++k) lowest /= slower;
  bool is_below = true;  // true for rates below the first rate at which a cycle differs from the first one
  for (double rate = lowest; rate <= highest && !progress.stopped(); rate *= 1 + options.step) {
    const bool is_steady = is_steady_at(rate);
    progress.tell("rates", std::log(rate / lowest) / std::log(highest / lowest));
    scan.rates.push_back({rate, is_steady});
    if (is_below && is_steady) scan.largest = rate;
    if (!is_below && is_steady) {
      const bool goes_on = scan.rates[scan.rates.size() - 2].is_steady;
      if (!goes_on) scan.windows.emplace_back(rate, rate);
      scan.windows.back().second = rate;
    }
    is_below = is_below && is_steady;
    if (!is_below && !options.beyond_first) break;
  }
  return scan;
}

namespace {

Signal step_between(const PreparedScene& given, std::size_t drive, double from, double level) {
  return signal(step_from(given.drives[drive], from, level), from);
}

}  // namespace

void complete(CycleWaveforms& waveforms, const PreparedScene& given) {
  const std::vector<double> before = given.values_before();
  if (waveforms.closing.empty()) {
    for (std::size_t k = 0; k < before.size(); ++k)
      waveforms.closing.push_back(
          step_between(given, k, given.start() == StartState::open ? before[k] : 0, waveforms.opening[k].before()));
  }
  if (!waveforms.opening.empty()) return;
  for (std::size_t k = 0; k < before.size(); ++k)
    waveforms.opening.push_back(step_between(given, k, waveforms.closing[k].hold_level(), 0));
}

CycleWaveforms plain_cycle(const PreparedScene& given, const CycleWaveforms& waveforms) {
  CycleWaveforms plain{.name = "plain", .closing = {}, .opening = {}};
  for (std::size_t k = 0; k < waveforms.closing.size(); ++k) {
    const double held = waveforms.closing[k].hold_level();
    plain.closing.push_back(step_between(given, k, waveforms.closing[k].before(), held));
    plain.opening.push_back(step_between(given, k, held, waveforms.opening[k].hold_level()));
  }
  return plain;
}

namespace {

void require_fits(const CycleWaveforms& waveforms, const CycleTimes& times) {
  const auto check = [&](const char* part, const std::vector<Signal>& signals, double time) {
    const double end = last_breakpoint(signals);
    require(end < time, [&] {
      return fmt::format("at {} the {} has {} of a cycle, and its waveform of \"{}\" lasts {}",
                         engineering(1 / times.period, "Hz", 4), part, engineering(time, "s", 4), waveforms.name,
                         engineering(end, "s", 4));
    });
  };
  check("closing", waveforms.closing, times.on_time);
  check("opening", waveforms.opening, times.period - times.on_time);
}

std::vector<double> rates_of_devices(const PreparedScene& given, const CycleWaveforms& waveforms, const ScanOptions& options,
                                     const CyclingOptions& asked, const Progress& progress) {
  const Ensemble ensemble(given, asked.devices, asked.seed);
  std::vector<double> rates(ensemble.size(), 0);
  std::atomic<std::size_t> done = 0;
  const std::size_t begun = run_tasks(
      ensemble.size(), asked.jobs,
      [&](std::size_t k) {
        const SampledDevice device = DeviceBuilder(ensemble).device(k);
        if (device.model) {
          const RateScan scan = scan_rates(CycledSwitch(given, *device.model, waveforms), options, {.stop = progress.stop});
          if (scan.largest > 0) rates[k] = scan.largest;
        }
        progress.tell(fmt::format("rates of devices, {}", waveforms.name),
                      static_cast<double>(++done) / static_cast<double>(rates.size()));
      },
      progress.stop);
  rates.resize(begun);
  return rates;
}

}  // namespace

Cycling cycling(const PreparedScene& given, const CycleWaveforms& waveforms, const CyclingOptions& options,
                const Progress& progress) {
  require(given.model.has_contact(), "cycle needs a [contact] section: without one nothing closes or opens");
  for (std::size_t k = 0; k < waveforms.closing.size(); ++k) {
    const double held = waveforms.closing[k].hold_level(), begin = waveforms.opening[k].before();
    constexpr double alike = 1e-9;
    require(std::abs(held - begin) <= alike * std::max(std::abs(held), std::abs(begin)), [&] {
      return fmt::format("the closing ends with {} at {}, and the opening begins at {}", given.drive_names()[k],
                         engineering(held, "V", 6), engineering(begin, "V", 6));
    });
  }
  Cycling found{.options = options, .drives = {}};
  CycleWaveforms plain = plain_cycle(given, waveforms);
  const bool is_plain = same_drives(plain.closing, waveforms.closing) && same_drives(plain.opening, waveforms.opening);
  found.drives.push_back({.waveforms = std::move(plain)});
  if (!is_plain) found.drives.push_back({.waveforms = waveforms});
  if (options.rate) {
    found.rate = *options.rate;
    require_fits(waveforms, {.period = 1 / found.rate, .on_time = options.duty / found.rate});
  }
  ScanOptions scan{.duty = options.duty, .cycles = options.cycles};
  scan.tolerances.rebound = given.scene.metrics.significant_rebound;
  for (CycledDrive& drive : found.drives) {
    if (!options.scans || progress.stopped()) break;
    drive.scan = scan_rates(CycledSwitch(given, given.model, drive.waveforms), scan, progress);
    if (!options.rate && drive.scan.largest > 0) found.rate = drive.scan.largest;
  }
  for (CycledDrive& drive : found.drives) {
    if (progress.stopped() || !(found.rate > 0)) break;
    drive.cycles =
        CycledSwitch(given, given.model, drive.waveforms)
            .run({.period = 1 / found.rate, .on_time = options.duty / found.rate, .cycles = options.cycles}, true, progress);
  }
  scan.beyond_first = false;
  for (CycledDrive& drive : found.drives) {
    if (progress.stopped() || options.devices == 0 || !options.scans) break;
    drive.of_devices = rates_of_devices(given, drive.waveforms, scan, options, progress);
  }
  found.interrupted = progress.stopped();
  return found;
}

}  // namespace softland
