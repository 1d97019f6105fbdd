#include "studies/search/devices_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "objectives/figure_values.h"
#include "studies/search/robust_cost.h"
#include "studies/search/robust_search_study.h"

namespace softland {
namespace {

constexpr std::size_t most_of_front = 6;
constexpr std::size_t drawn_devices = 50, instants_of_course = 240;
constexpr double units_of_gap = 5000;  // stored contact gaps are integers; this many units make the gap at rest
// The stored contact gaps end at this multiple of the time until the contact force is steady.
constexpr double after_steady = 1.1;

DevicesFindings::Row told(const DevicesRow& row) {
  const DriveRobustness& drive = row.judged;
  DevicesFindings::Row r{.name = row.name,
                         .pull_in_error = row.knowledge.pull_in_error.value_or(Metrics::unset),
                         .frequency_error = row.knowledge.frequency_error.value_or(Metrics::unset),
                         .piezo_error = row.knowledge.piezo_error.value_or(Metrics::unset),
                         .time_error = row.knowledge.time_error.value_or(Metrics::unset),
                         .searched_for_it = row.searched_for_it,
                         .bounce_free = drive.bounce_free.value,
                         .open = std::max(0.0, 1 - drive.closing.value - drive.collapsed.value),
                         .collapsed = drive.collapsed.value};
  for (const Figure& f : device_figures) {
    if (f.asked != nullptr && drive.figures[f].devices == 0) continue;
    const auto& quantiles = drive.figures[f].quantiles;
    const std::string key(f.key);
    r.at_50[key] = quantiles[1].value, r.at_95[key] = quantiles[2].value, r.at_99[key] = quantiles[3].value;
  }
  for (const auto& [height, key] : DevicesFindings::yield_heights) {
    const auto rebounds_less = [most = height](const DeviceOutcome& o) {
      return o.closed() && o.is_held && o.metrics.major_bounce_height <= most;
    };
    if (drive.outcomes.empty()) continue;
    r.yield[key] =
        static_cast<double>(std::ranges::count_if(drive.outcomes, rebounds_less)) / static_cast<double>(drive.outcomes.size());
  }
  return r;
}

}  // namespace

const DevicesFindings::Row* DevicesFindings::row(std::string_view name) const {
  const auto found = std::ranges::find(rows, name, &Row::name);
  return found == rows.end() ? nullptr : &*found;
}

// Computes the contact gaps of some devices over time, under the plain step and the best waveform, until the contact force is
// steady.
void draw_courses(RobustSearchResult& result, const RobustnessOptions& judging, const Progress& progress) {
  if (result.best.plain_step_wins) return;
  const DriveRobustness &step = result.verdict.drives.front(), &own = result.row_of_devices().judged;
  double end = 0;
  for (const DriveRobustness* one : {&step, &own})
    end = std::fmax(end, after_steady * waited(one->outcomes, &Metrics::steady_force_time));
  end = std::fmin(end, result.varied.duration);
  const double unit = result.varied.model.contact_gap() / units_of_gap;
  const auto courses = [&](const DriveRobustness& drive) {
    std::vector<std::vector<int>> all;
    for (const std::vector<double>& gap :
         gap_courses(result.varied, drive, drawn_devices, instants_of_course, end, judging, progress).gaps) {
      std::vector<int>& course = all.emplace_back();
      for (const double g : gap) course.push_back(static_cast<int>(std::lround(g / unit)));
    }
    return all;
  };
  result.findings.courses = {.end = end, .unit = unit, .step = courses(step), .own = courses(own)};
}

// Finds the Pareto front of the candidate waveforms in time of first contact and impact velocity, and evaluates the candidates of
// the front on the fresh devices (new to the search).
void judge_front(RobustSearchResult& result, RobustSearch& search, const Progress& progress) {
  std::vector<const ChosenFrom*> kept;
  for (const ChosenFrom& one : result.candidates) {
    const bool beaten = std::ranges::any_of(result.candidates, [&](const ChosenFrom& other) {
      return other.first_touch <= one.first_touch && other.impact_speed <= one.impact_speed &&
             (other.first_touch < one.first_touch || other.impact_speed < one.impact_speed);
    });
    if (!beaten && std::isfinite(one.first_touch) && kept.size() < most_of_front) kept.push_back(&one);
  }
  const RobustCost fresh = search.verdict_devices(search.known());
  for (const ChosenFrom* one : kept) {
    progress.throw_if_stopped();
    progress.tell("evaluating candidates on new devices",
                  static_cast<double>(result.findings.front.size()) / static_cast<double>(kept.size()));
    const std::vector<DeviceOutcome> outcomes = search.closed(fresh, one->waveforms);
    result.findings.front.push_back({.first_touch = quantile_95(outcomes, key_of(&Metrics::initial_contact_time)),
                                     .impact_speed = quantile_95(outcomes, key_of(&Metrics::largest_impact_velocity)),
                                     .bounce_free = share_of(outcomes, is_bounce_free),
                                     .candidate = fmt::format("{} by {}", one->family, one->measure)});
  }
  std::ranges::stable_sort(result.findings.front, {}, &FrontPoint::first_touch);
}

// Copies the results of the search to the findings, except those that were added during the final evaluation.
void complete_findings(RobustSearchResult& result, RobustSearch& search, std::uint64_t seed) {
  DevicesFindings& d = result.findings;
  const std::optional<Closing>& drawn = result.nominal.best;
  d.spread_assumed = search.spread_assumed();
  d.count = static_cast<double>(result.verdict.devices);
  d.seed = static_cast<double>(seed);
  d.closings = static_cast<double>(search.budget().taken());
  if (result.chosen) d.measure = result.chosen->measure, d.waveform = result.chosen->family;
  d.better_than_plain_step = !result.best.plain_step_wins;
  if (drawn) d.nominal = FigureValues(drawn->metrics), d.nominal_status = to_string(drawn->metrics.status);
  d.nominal_goal_met = result.nominal.goal_met;
  for (const DevicesRow& row : result.rows) d.rows.push_back(told(row));
  for (const DeviceChoice& one : result.choices)
    d.choices.push_back({.name = one.name,
                         .file = one.name == default_choice ? "best.toml" : one.name + ".toml",
                         .waveform = one.candidate.family,
                         .tau = one.tau});
  if (const std::optional<StableApproach>& approach = result.approach) {
    std::vector<std::string> drives{approach->drive};
    if (!approach->holder.empty()) drives.push_back(approach->holder);
    d.stable_path = {.drives = drives,
                     .share = search.share_with_path(),
                     .reaches = approach->reaches,
                     .limit = approach->limit,
                     .touch_places = approach->touch_places(),
                     .rise = shortest_rise(result.varied)};
  }
  if (const DevicesFindings::Row* own = d.row(for_the_devices)) {
    const double height = own->at_95.at(std::string(key_of(&Metrics::major_bounce_height)));
    const double significant = result.varied.scene.metrics.significant_rebound;
    d.goal_met = height <= significant;
    d.missed_by = std::max(0.0, height - significant);
  }
  for (const ChosenFrom& one : result.candidates)
    d.tournament.push_back({.measure = one.measure,
                            .waveform = one.family,
                            .closings = one.closings,
                            .bounce_free = one.bounce_free,
                            .cost = one.tail});
}

}  // namespace softland
