// The part of RobustSearch with a per-device calibration: searches on devices whose pull-in voltage and timing are measured,
// and the performance of the found waveforms on fresh devices (new to the search).
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/executor.h"
#include "base/require.h"
#include "studies/search/robust_cost.h"
#include "studies/search/robust_search.h"

namespace softland {
namespace {

constexpr std::uint64_t measured_devices = 128;  // number of devices in a search with a per-device calibration
// Relative errors of the measured dynamic pull-in voltage Vdp and period of each device: the usual error (`coarse_error`), and
// the error that a switch needs whose closing is too quick to be timed (`fine_error`).
constexpr double coarse_error = 0.01, fine_error = 0.002;
constexpr double least_times_of_error = 20;
// Relative errors of the measured dynamic pull-in voltage Vdp, for each of which the performance of the waveforms is computed.
constexpr std::array errors_of_pull_in{0.0005, 0.001, 0.002, 0.005, 0.01, 0.02};
constexpr double most_rows = 4;  // largest number of rows with a calibration in the table of results, for reports of progress
// Number of fresh devices (new to the search) that show the effect of each error of the measured dynamic pull-in voltage Vdp.
constexpr std::size_t devices_by_error = 256;
// The searches with a calibration maximise the bounce-free share of devices if the best uncalibrated waveform reaches at least
// this share. Otherwise they minimise the tail of the cost.
constexpr double ranked_by_share = 0.25;
// Number of the random sample of devices on which searches with a calibration try waveforms. The samples in robust_search.cc
// have other numbers, so that their devices differ.
constexpr std::uint64_t which_measured = 2;

}  // namespace

void DevicesRow::inherit(const DevicesRow& other) {
  const auto includes = [](const std::optional<double>& more, const std::optional<double>& less) {
    return !less || (more && *more <= *less);
  };
  const Calibration& known = other.knowledge;
  const bool knows_more = includes(knowledge.pull_in_error, known.pull_in_error) &&
                          includes(knowledge.frequency_error, known.frequency_error) &&
                          includes(knowledge.piezo_error, known.piezo_error) && includes(knowledge.time_error, known.time_error);
  if (!knows_more || !has_better_yield(other, *this)) return;
  judged = other.judged;
  searched_for_it = false;
}

bool DevicesRow::is_worth_measuring(const DevicesRow& uncalibrated) const {
  const double lands = judged.bounce_free.value, before = uncalibrated.judged.bounce_free.value;
  if (std::max(lands, before) >= half_is_bounce_free) return lands > before;
  const auto speed = [](const DevicesRow& row) {
    return quantile_95(row.judged.outcomes, key_of(&Metrics::largest_impact_velocity));
  };
  return speed(*this) < worth_choosing * speed(uncalibrated);
}

// Computes pull-in voltages and closing times of the fresh devices (new to the search), in parallel with other work: the final
// evaluation with a per-device calibration needs these quantities.
void RobustSearch::measure_ahead() {
  try {
    meter_.emplace(first().given, MeasuredQuantities{.closing_time = true});
  } catch (const InvalidInput&) {
    return;  // devices without a pull-in voltage cannot be calibrated
  }
  (void)calibrated({.pull_in_error = coarse_error});
  if (tells_time()) (void)calibrated({.time_error = usual_time_error});
}

// True if devices are calibrated by the closing time under a slow voltage step: this time must be many times its measurement
// error. For a quicker switch, a precise measurement of pull-in voltage and period replaces the closing time.
bool RobustSearch::tells_time() const { return meter_->closing_time() > least_times_of_error * usual_time_error; }

CalibratedSearch RobustSearch::in_measured_units(const ChosenFrom& winner, const DriveWaveforms& nominal) {
  const Calibration coarse{.pull_in_error = coarse_error};
  const Calibration both{.pull_in_error = coarse_error, .frequency_error = coarse_error};
  const Calibration fine{.pull_in_error = fine_error, .frequency_error = fine_error};
  const Calibration by_time{.time_error = usual_time_error};
  if (!meter_) return {};
  CalibratedSearch all{.pull_in = meter_->pull_in(), .closing_time = meter_->closing_time()};
  const bool times = tells_time();
  const auto found = searched_in(winner, nominal, std::array{coarse, times ? by_time : fine});
  if (!found[0]) return all;
  const auto row = [&](const char* name, const DriveWaveforms& waveforms, const Calibration& knowledge, bool is_searched) {
    progress_.tell("evaluating on measured devices", static_cast<double>(all.rows.size()) / most_rows);
    all.rows.push_back(row_of(name, waveforms, knowledge, is_searched));
  };
  row("Vdp to 1 %", *found[0], coarse, true);
  row("Vdp and period to 1 %", *found[0], both, false);
  if (found[1]) row("Vdp and period to 0.2 %", *found[1], fine, !times);
  if (found[1] && times) row("closing time to 50 ns", *found[1], by_time, true);
  std::vector waveforms{*found[0]};
  if (found[1]) waveforms.push_back(*found[1]);
  all.by_error = judged_by_error(waveforms, winner.waveforms);
  const bool time_wins = found[1] && times && has_better_yield(all.rows.back(), all.rows.front());
  all.best = time_wins ? all.rows.size() - 1 : 0;
  all.best_waveforms = time_wins ? *found[1] : *found[0];
  return all;
}

// Searches a waveform for each of the two `calibrations`, in parallel. An element of the result is empty if the search with
// this calibration found no waveform.
std::array<RobustSearch::Found, 2> RobustSearch::searched_in(const ChosenFrom& winner, const DriveWaveforms& nominal,
                                                             const std::array<Calibration, 2>& calibrations) {
  const auto family = std::ranges::find(names_, winner.family);
  const std::size_t k = family == names_.end() ? 0 : static_cast<std::size_t>(family - names_.begin());
  const std::vector<MeasuredUnits> known = measured_units(first().given, calibrations, options_.jobs, progress_);
  std::array<Found, 2> all;
  std::array<std::atomic<double>, 2> parts{};
  run_tasks(
      all.size(), options_.jobs,
      [&](std::size_t i) {
        const RobustCost cost(
            first(), aims_.tail,
            own_devices(first(), known[i], measured_devices, options_.seed, which_measured, options_.jobs, progress_));
        TournamentOptions own = tournament_options();
        own.memory = nullptr;  // no memory of evaluations: its keys do not contain the calibration
        own.progress = [&, i](double part) {
          parts[i] = part;
          progress_.tell("searching for devices that are measured", (parts[0] + parts[1]) / 2);
        };
        const auto searched = [&](const TournamentAims& aims) {
          if (settings_[k].space.quasi_static() != nullptr) return searched_at_pace(cost, aims, k, own);
          return tournament_of_one(settings_[k], k, cost, aims, winner.bounce_free >= ranked_by_share,
                                   {winner.waveforms, nominal}, *before_verdict_, own);
        };
        TournamentResult found = searched(aims_);
        if (!found.contenders.empty() && is_harder_than_step(cost, found.contenders.front().waveforms))
          found = searched(no_harder());
        if (!found.contenders.empty()) all[i] = found.contenders.front().waveforms;
      },
      options_.stop);
  progress_.throw_if_stopped();
  return all;
}

TournamentResult RobustSearch::searched_at_pace(const RobustCost& cost, const TournamentAims& aims, std::size_t family,
                                                TournamentOptions options) {
  constexpr long shorter = 3;  // a search with a calibration simulates a third of the closings of a search without one
  RobustAim aim = tail_aim_;
  aim.free = free_;
  for (const Condition& one : aims.tail.conditions) {
    if (one.figure.member != Figure::Member(&Metrics::initial_contact_time)) aim.conditions.push_back(one);
  }
  options.closings /= shorter;
  TournamentResult all;
  if (auto found = search_at_pace(settings_[family], {.of_step = 1, .family = family}, cost, aim, *before_verdict_, options))
    all.contenders.push_back(*std::move(found));
  return all;
}

// True if the 95th percentile of impact velocity, rebound or peak force under the waveforms is above that under the plain step,
// on the devices of `cost`.
bool RobustSearch::is_harder_than_step(const RobustCost& cost, const DriveWaveforms& waveforms) const {
  const std::vector<DeviceOutcome> outcomes = cost.close(first().drives(waveforms), 0, cost.devices(), 1);
  return !hold(at_most_step_, outcomes);
}

TournamentAims RobustSearch::no_harder() const {
  TournamentAims aims = aims_;
  for (RobustAim* aim : {&aims.tail, &aims.share}) std::ranges::copy(at_most_step_, std::back_inserter(aim->conditions));
  return aims;
}

DevicesRow RobustSearch::row_of(const char* name, const DriveWaveforms& waveforms, const Calibration& knowledge,
                                bool searched_for_it) {
  const MeasuredUnits known = measured_units(first().given, std::array{knowledge}, options_.jobs, progress_).front();
  const RobustCost fresh = verdict_devices(known);
  budget_.took(static_cast<long>(fresh.devices()));
  std::vector<DeviceOutcome> outcomes = fresh.close_until(first().drives(waveforms), free_.until, options_.jobs);
  progress_.throw_if_stopped();
  return {.name = name,
          .knowledge = knowledge,
          .searched_for_it = searched_for_it,
          .judged = internal::summarised({.name = name, .waveforms = all_drives(waveforms), .calibration = knowledge}, known,
                                         std::move(outcomes))};
}

// Computes the performance on the fresh devices (new to the search) for several measurement errors of the dynamic pull-in
// voltage Vdp. Each result is the best of the calibrated `waveforms` and of the uncalibrated ones, `in_volts`, which the error
// does not affect.
std::vector<CalibrationError> RobustSearch::judged_by_error(const std::vector<DriveWaveforms>& waveforms,
                                                            const DriveWaveforms& in_volts) {
  std::vector<CalibrationError> judged;
  const CalibratedEnsemble& all = calibrated({.pull_in_error = coarse_error});
  const auto end = static_cast<std::ptrdiff_t>(std::min(devices_by_error, all.devices.size()));
  const CalibratedEnsemble few{.devices = {all.devices.begin(), all.devices.begin() + end},
                               .exact = {all.exact.begin(), all.exact.begin() + end}};
  const RobustCost unmeasured(first(), aims_.tail, known_as(few, MeasuredUnits(), options_.seed));
  const std::vector<DeviceOutcome> least = closed(unmeasured, in_volts);
  for (const double error : errors_of_pull_in) {
    const Calibration knowledge{.pull_in_error = error};
    const RobustCost fresh(first(), aims_.tail, known_as(few, MeasuredUnits(knowledge), options_.seed));
    CalibrationError best{
        .error = error, .bounce_free = share_of(least, is_bounce_free), .impact_speed = quantile_95(least, judged_figures[0])};
    for (const auto& waveform : waveforms) {
      const std::vector<DeviceOutcome> outcomes = closed(fresh, waveform);
      best.bounce_free = std::fmax(best.bounce_free, share_of(outcomes, is_bounce_free));
      best.impact_speed = std::fmin(best.impact_speed, quantile_95(outcomes, judged_figures[0]));
    }
    progress_.throw_if_stopped();
    judged.push_back(best);
    progress_.tell("evaluating errors of the measured Vdp", static_cast<double>(judged.size()) / errors_of_pull_in.size());
  }
  return judged;
}

RobustCost RobustSearch::verdict_devices(const MeasuredUnits& known) {
  return {first(), aims_.tail, known_as(calibrated(known.calibration()), known, options_.seed)};
}

// Returns the fresh devices (new to the search) with the quantities that a calibration measures, without measurement errors.
// The quantities are computed at the first call for a calibration by closing time, and at the first call for any other
// calibration.
const CalibratedEnsemble& RobustSearch::calibrated(const Calibration& knowledge) {
  std::optional<CalibratedEnsemble>& all = knowledge.time_error ? calibrated_by_time_ : calibrated_by_pull_in_;
  if (!all)
    all = calibrate_all(Ensemble(first().given, verdict_, options_.seed), MeasuredQuantities::of(knowledge), compared_precision,
                        options_.jobs, progress_);
  return *all;
}

}  // namespace softland
