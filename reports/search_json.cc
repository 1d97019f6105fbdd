// The JSON of the results of a search, which closing_json.cc writes beside those of the closing that the search found.
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reports/closing_record.h"
#include "reports/record.h"
#include "reports/robustness_report.h"
#include "reports/seeds_report.h"
#include "reports/study_members.h"

namespace softland {

using nlohmann::json;

void members(internal::Archive& a, DevicesFindings::Row& row);
void members(internal::Archive& a, DevicesFindings::Choice& choice);

namespace internal {
namespace {

// Writes points of a search as rows [index of an evaluation, minimised value] of JSON, with a whole number as the index.
json counted_json(const Points& points) {
  json all = json::array();
  for (const auto& [index, value] : points) all.push_back({std::llround(index), json_number(value)});
  return all;
}

Points read_points(const json& points) { return read_json<Points>(points); }

// Writes the waveforms among which the user can choose, each with the percentiles of its figures of merit over the devices.
json choices_json(const DevicesFindings& devices) {
  json all = json::array();
  for (const DevicesFindings::Choice& one : devices.choices) {
    json& choice = all.emplace_back(record_json(one));
    const DevicesFindings::Row* const row = devices.row(one.row());
    const json figures = row == nullptr ? json::object() : record_json(*row);
    for (const char* key : {"quantile_95", "quantile_99"}) choice[key] = figures.value(key, json::object());
  }
  return all;
}

}  // namespace

/// The JSON of a choice, which has the quantiles of its row.
struct ChoiceJson {};
void members(Archive& a, ChoiceJson&) {
  DevicesFindings::Choice choice;
  std::map<std::string, double> figures;
  members(a, choice);
  a("quantile_95", OrInfinite{figures}, "95th percentile of each figure");
  a("quantile_99", OrInfinite{figures}, "99th percentile of each figure");
}

}  // namespace internal

void members(internal::Archive& a, FulfilledCondition& condition) {
  a("condition", condition.text, "the condition, as it was given");
  a("share", condition.share.value, "share of the devices that fulfil it");
  a.pair("interval", condition.share.interval.low, condition.share.interval.high, "95 % confidence interval of the share");
  a("holds", condition.holds, "whether enough devices fulfil it");
}

void members(internal::Archive& a, RobustFindings& robust) {
  a("measure", robust.measure, "minimised measure of risk");
  a("devices", robust.devices, "number of devices of the search");
  a("fresh_devices", robust.fresh_devices, "number of devices new to the search");
  a("closings", robust.closings, "number of closings of the search");
  a("cost_on_searched_devices", robust.cost_on_searched, "cost of the best waveform on the devices of the search");
  a("failing_share", robust.failing, "share of the fresh devices that do not close and stay closed");
  a("measure_tells", robust.is_told, "false: the measure would be the same if all devices failed");
  a("yield", robust.yield, "condition of the yield, if the measure is a yield");
  a("conditions", robust.conditions, "conditions of the search");
}

void members(internal::Archive& a, DevicesFindings::Row& row) {
  a("name", row.name, "name of the row, such as `plain step`");
  a.object(
      "knowledge",
      [&](auto& knowledge) {
        knowledge("Vdp", row.pull_in_error, "relative error of the dynamic pull-in voltage");
        knowledge("frequency", row.frequency_error, "relative error of the frequency");
        knowledge("piezo", row.piezo_error, "relative error of the deflection by the piezo");
        knowledge("time_s", row.time_error, "standard deviation of the error of a closing time");
      },
      "errors of the measurements of each device; null: not measured");
  a("searched_for_it", row.searched_for_it, "whether the waveform was searched for these measurements");
  a("bounce_free", row.bounce_free, "share of bounce-free devices");
  a("does_not_close", row.open, "share of devices that stay open");
  a("collapsed_onto_electrode", row.collapsed, "share of devices that collapse onto the electrode");
  a("quantile_50", internal::OrInfinite{row.at_50}, "median of each figure over the devices");
  a("quantile_95", internal::OrInfinite{row.at_95}, "95th percentile of each figure");
  a("quantile_99", internal::OrInfinite{row.at_99}, "99th percentile of each figure");
  a("yield", row.yield, "share of devices whose highest rebound is within a height; the name is the height [m]");
}

void members(internal::Archive& a, DevicesFindings::Choice& choice) {
  a("name", choice.name, "name of the choice; `default` is that of best.toml");
  a("file", choice.file, "file with the waveform");
  a("waveform", choice.waveform, "waveform family");
  a("tau", choice.tau, "time until the contact force is steady, divided by that of the plain step");
}

void members(internal::Archive& a, DevicesFindings::StablePath& path) {
  a("drives", path.drives, "drives of the path; the first moves the switch to its contact");
  a("share_of_devices", path.share, "share of devices with a stable path to the contact");
  a("reaches_V", path.reaches, "voltage of the first drive at which the nominal design touches");
  a("limit_V", path.limit, "limit of that voltage");
  a("touch_places_m", path.touch_places, "width of the range of positions at which 90 % of the devices touch");
  a("rise_s", path.rise, "least time before the first device touches under a slow waveform");
}

void members(internal::Archive& a, DevicesFindings::Courses& courses) {
  a("end_s", courses.end, "last instant of the gaps");
  a("unit_m", courses.unit, "unit of the gaps");
  a("plain_step", courses.step, "gaps under the plain step, by device and instant");
  a("best", courses.own, "gaps under best.toml, by device and instant");
}

void members(internal::Archive& a, FrontPoint& point) {
  a(key_of(&Metrics::initial_contact_time), point.first_touch, "95th percentile of the first contact time");
  a(key_of(&Metrics::largest_impact_velocity), point.impact_speed, "95th percentile of the largest impact velocity");
  a("bounce_free", point.bounce_free, "share of bounce-free devices");
  a("candidate", point.candidate, "waveform family, and measure of risk that was minimised");
}

void members(internal::Archive& a, CalibrationError& known) {
  a("error", known.error, "relative standard deviation of the error of the measured Vdp");
  a("bounce_free", known.bounce_free, "share of bounce-free devices");
  a(key_of(&Metrics::largest_impact_velocity), internal::OrInfinite{known.impact_speed},
    "95th percentile of the largest impact velocity");
}

void members(internal::Archive& a, TournamentEntry& contender) {
  a("measure", contender.measure, "minimised measure of risk; `drawing`: found on the nominal device");
  a("waveform", contender.waveform, "waveform family");
  a("closings", contender.closings, "number of closings of its search");
  a("cost", contender.cost, "its cost on the devices on which the best is chosen");
  a("bounce_free", contender.bounce_free, "share of these devices that are bounce-free");
}

void members(internal::Archive& a, DevicesFindings& devices) {
  a("spread_assumed", devices.spread_assumed, "whether the scene has no [spread] and the usual one was assumed");
  a("spread", devices.spread, "the process variation in words");
  a("count", devices.count, "number of fresh devices");
  a("seed", devices.seed, "seed of the devices");
  a("closings", devices.closings, "number of closings of the search");
  a.object(
      "chosen",
      [&](auto& chosen) {
        chosen("measure", devices.measure, "minimised measure of risk");
        chosen("waveform", devices.waveform, "waveform family");
      },
      "origin of the best waveform; empty texts if the plain step is best");
  a("better_than_plain_step", devices.better_than_plain_step, "whether the best waveform is better than the plain step");
  a("worse_in", devices.worse_in, "figures in which the best candidate is worse than a plain step that is best");
  a("rows", devices.rows, "how waveforms do on the fresh devices");
  a.custom(
      "choices", devices.choices, [&](const auto&) { return internal::choices_json(devices); },
      internal::read_json<std::vector<DevicesFindings::Choice>>,
      internal::Like<std::vector<internal::ChoiceJson>>{"waveforms that are offered, the earliest steady contact first"});
  a("stable_path", internal::OrNull{devices.stable_path}, "path of stable equilibria to the contact");
  a("goal_met", devices.goal_met, "whether the 95th percentile of the rebound height is not significant");
  a("missed_by_m", devices.missed_by, "excess of that percentile over the goal; 0: met");
  a("step_delay_s", devices.step_delay, "delay of the plain step of the electrode, if it was searched");
  a("gaps", devices.courses, "contact gaps of some devices over time");
  a("front", devices.front, "candidate waveforms, by time of first contact");
  a("by_error_of_Vdp", devices.by_error, "results by the error of a measured Vdp");
  a.custom("hold_window_V", devices.windows, internal::windows_json, internal::read_windows,
           internal::Like<std::map<std::string, std::array<double, 2>>>{
               "by electrode, hold voltages between which the devices stay closed"});
  a("hold_window_devices", devices.windows.devices, "number of devices in the hold window");
  a("race", devices.tournament, "candidates for the best waveform, the best first");
  a("conditions", devices.conditions, "conditions of the search");
  a("measured", devices.measured, "row of the waveform in calibrated.toml");
  a("next_command", devices.next_command, "command to run next");
}

void members(internal::Archive& a, TouchLimit& limit) {
  a("least_time_s", limit.least_time, "least closing time of any waveform with at most this impact velocity");
  a(key_of(&Metrics::impact_velocity), limit.impact_velocity, "impact velocity of the best waveform");
}

void members(internal::Archive& a, SearchedFamilyResult& one) {
  a("family", one.family, "waveform family");
  a("evaluations", one.evaluations, "number of its evaluations");
  a("cost", one.cost, "its lowest cost");
}

void members(internal::Archive& a, ConfirmationRecord& check) {
  a("name", check.name, "what differs in the repeated simulation");
  internal::figures_and_status(a, check.figures, check.status, internal::figure_of_no_drive);
}

// The members of a search are at the same level of the JSON as the members of the closing that the search found.
void members_of_search(internal::Archive& a, SearchRecord& search, ClosingRecord& closing) {
  a("target", search.target, "target of the search");
  a("actuator", search.actuator, "drives that were searched");
  a("waveform", search.waveform, "waveform family of the best waveform");
  if (a.has(!search.families.empty())) a("families", search.families, "results by waveform family, if several were searched");
  a("seed", search.seed, "seed of the search");
  a("optimizer", search.optimizer, "optimizer");
  a("evaluations", internal::Count{search.evaluations}, "number of evaluations");
  a("termination", search.termination, "why the search ended");
  a("termination_message", search.termination_message, "the same in words");
  a("goal_met", search.goal_met, "whether the goal of the target is met");
  a("better_than_baseline", search.better_than_baseline, "whether the best waveform is better than the plain step");
  a("plain_step_wins", search.plain_step_wins, "whether the plain step has the lower cost");
  a("harder_than_step", search.harder_than_step,
    "factor by which the waveform exceeds the plain step in voltage or slew, the larger one");
  a.object(
      "baseline",
      [&](auto& baseline) {
        members(baseline, search.baseline);
        internal::figure_errors(baseline, search.baseline.errors);
        baseline("cost", search.baseline.cost, "cost of the run");
      },
      "run under the plain step");
  a.object(
      "curves", [&](auto& curves) { curves("baseline", search.baseline.curve, "run under the plain step"); },
      "curves of the runs, in files only");
  a.object(
      "search",
      [&](auto& course) {
        course("value_name", search.course.value_name, "name of the minimised value");
        course.custom("best_so_far", search.course.best_so_far, internal::counted_json, internal::read_points,
                      internal::Like<std::vector<std::array<double, 2>>>{"evaluation, and least value until then"});
        if (course.has(!search.course.evaluations.empty()))
          course.custom("evaluations", search.course.evaluations, internal::counted_json, internal::read_points,
                        internal::Like<std::vector<std::array<double, 2>>>{"evaluation, and its value; null: infeasible"});
      },
      "course of the search, in files only");
  a("reproduce", search.reproduce, "commands that repeat the result");
  a("robust", search.robust, "findings of a search by one measure of risk");
  a("devices", search.devices, "findings of a search over devices");
  a("seeds", search.seeds, "findings of several searches");
  if (search.devices) {
    a.object(
        "drawing",
        [&](auto& nominal) {
          internal::figures_and_status(nominal, search.devices->nominal, search.devices->nominal_status, internal::every_figure);
          nominal("goal_met", search.devices->nominal_goal_met, "whether the goal of the target is met");
        },
        "waveform for the nominal design, on the nominal device");
  }
  a("limit", search.limit, "least time for the impact velocity that was found");
  if (!a.has(closing.best.figures.has_value())) return;
  a.object(
      "best",
      [&](auto& best) {
        best("parameters", search.parameters, "parameters of the best waveform, by drive and name");
        best("bounds", search.bounds, "bounds of each parameter in the search");
        best("cost", closing.best.cost, "cost of the run");
      },
      "run under the best waveform, or the single run");
  a("checks", search.checks, "repeated simulations that confirm the best waveform");
  if (a.has(!search.checks.empty()))
    a("evaluations_with_more_modes", internal::Count{search.evaluations_of_modes},
      "number of further evaluations with several numbers of modes");
}

}  // namespace softland
