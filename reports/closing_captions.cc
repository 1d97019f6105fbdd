#include "reports/closing_captions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "document/axis.h"
#include "document/quantity.h"
#include "reports/closing_prose.h"
#include "reports/devices_report.h"
#include "reports/record.h"
#include "reports/robustness_prose.h"
#include "studies/closing/hold.h"

namespace softland::internal {
namespace {

std::string in_brackets(const Change& change) { return change.words.empty() ? std::string() : " (" + change.words + ")"; }

bool bounces(const RunRecord& run) { return figure_of_run(run, &Metrics::bounce_count) > 0; }

bool is_clean_run(const ConfirmationRecord& check) { return check.figures && is_clean(*check.figures); }

/// Describes the waveform of an electrode, a piezo or the dispersion force: "runs between 0 V and 30 V, with a jump"; `both` is
/// true if two runs have this waveform.
std::string range_prose(const Points& waveform, const DriveScale& scale, bool both) {
  const DriveDemand demand = drive_demand(waveform, scale.rest);
  if (!std::isfinite(demand.lowest)) return {};
  if (demand.lowest == demand.highest)
    return fmt::format("{} at {}", both ? "stay" : "stays", quantity(demand.lowest, scale.unit));
  const std::string slew = scale.unit.empty()        ? ""
                           : std::isinf(demand.slew) ? ", with a jump"
                                                     : ", with a slew rate of at most " + quantity(demand.slew, "V/s");
  return fmt::format("{} between {} and {}{}", both ? "run" : "runs", quantity_beside(demand.lowest, demand.highest, scale.unit),
                     quantity_beside(demand.highest, demand.lowest, scale.unit), slew);
}

// Returns a key that is larger for a worse closing. A closing in which the switch stays open is worst; rebound height, then
// impact velocity order the others.
std::array<double, 3> badness(const ConfirmationRecord& check) {
  if (!check.figures || !touches(*check.figures)) return {2, 0, 0};
  return {is_clean_run(check) ? 0.0 : 1.0, is_clean_run(check) ? 0.0 : rebound_height(*check.figures),
          (*check.figures)[&Metrics::impact_velocity]};
}

std::string impact_velocity_of(const ConfirmationRecord& check) {
  return quantity((*check.figures)[&Metrics::impact_velocity], "m/s");
}

// Describes how the switch closes in a confirmation that fails: "it rebounds by up to 2.16 nm after an impact velocity of 32.5
// mm/s".
std::string course_of(const ConfirmationRecord& check) {
  if (!check.figures || !touches(*check.figures)) return "it does not close";
  const double height = rebound_height(*check.figures);
  return (height > 0 && !is_clean_run(check)
              ? fmt::format("it rebounds by up to {} after an impact velocity of ", quantity(height, "m"))
              : "its impact velocity is ") +
         impact_velocity_of(check);
}

// Returns the settings of the confirmations (re-runs with other numerical settings) as text: "a tolerance of 1e-9 and with 6, 8
// and 10 modes".
std::string names_of(const std::vector<ConfirmationRecord>& numerics) {
  std::string tolerance, modes;
  for (const ConfirmationRecord& check : numerics) {
    const std::size_t space = check.name.find(' ');
    const std::string value = check.name.substr(space + 1);
    if (check.name.starts_with("tolerance ")) {
      tolerance = "a tolerance of " + value;
    } else if (check.name.starts_with("modes ")) {
      modes += (modes.empty() ? "" : &check == &numerics.back() ? " and " : ", ") + value;
    } else {
      return "other settings";  // a file of an earlier version lacks the settings of its confirmations
    }
  }
  return tolerance + (modes.empty() ? "" : (tolerance.empty() ? "" : " and with ") + modes + " modes");
}

// Returns a warning if the best waveform closes without a bounce, but not in all confirmations with other numbers of modes.
std::string of_modes(const ClosingRecord& result) {
  if (!result.best.figures || !is_clean(*result.best.figures)) return {};
  std::vector<ConfirmationRecord> modes;
  std::ranges::copy_if(result.search->checks, std::back_inserter(modes),
                       [](const ConfirmationRecord& check) { return check.name.starts_with("modes "); });
  if (std::ranges::all_of(modes, is_clean_run)) return {};
  const ConfirmationRecord& worst = *worst_check(modes);
  return fmt::format(" This result holds for the number of modes in the scene only: with {} modes {}.",
                     worst.name.substr(worst.name.find(' ') + 1), course_of(worst));
}

// Returns a sentence on the devices that stay open, are not kept closed or are outside the model, for the report of a search
// under process variation.
std::string of_devices_that_fail(const ClosingRecord& result) {
  const std::optional<RobustFindings>& robust = result.search->robust;
  if (!robust || !(robust->failing > 0)) return {};
  std::string words = fmt::format(
      " {} of the new devices stay open, are not kept closed by their hold voltages, or are outside the model; they count as the "
      "worst devices.",
      share_text(robust->failing));
  if (!robust->is_told)
    words +=
        fmt::format(" The statistic {} depends on these devices alone and cannot rank waveforms: the search has gained nothing.",
                    robust->measure);
  return words;
}

// Returns a sentence on where best.toml comes from, if the chart of the search shows the search for the nominal design.
std::string origin_of_best(const ClosingRecord& result) {
  const DevicesFindings* const devices = result.devices();
  if (devices == nullptr) return {};
  if (!devices->better_than_plain_step) return " best.toml is the plain step.";
  return devices->measure == "drawing" ? " best.toml was chosen among its waveforms, by their figures on the devices."
                                       : " best.toml comes from the search over devices, which this chart does not show.";
}

std::string laws_caption(const std::vector<ConfirmationRecord>& laws) {
  std::string names;
  for (const ConfirmationRecord& law : laws) names += (names.empty() ? "" : ", ") + law.name.substr(law.name.find(' ') + 1);
  if (std::ranges::all_of(laws, is_clean_run))
    return fmt::format(
        " It also closes bounce-free under the other gas laws that are valid here ({}), with an impact velocity of at most {}.",
        names, impact_velocity_of(*worst_check(laws)));
  const ConfirmationRecord& worst = *worst_check(laws);
  return fmt::format(" Under the other gas laws that are valid here ({}) this waveform may bounce: {} ({}).", names,
                     course_of(worst), worst.name.substr(worst.name.find(' ') + 1));
}

}  // namespace

double window_end(const ClosingRecord& result) {
  double end = std::numeric_limits<double>::quiet_NaN();
  for (const RunRecord* run : {&result.best, &result.baseline()}) {
    if (!run->curve.time.empty()) end = std::fmax(end, drawable(run->curve.time.back()));
  }
  return end;
}

std::vector<double> evaluation_indices(const SearchCourse& search) {
  std::vector<double> indices;
  for (const auto& [index, value] : search.evaluations) indices.push_back(index);
  std::sort(indices.begin(), indices.end());
  return indices;
}

double evaluations_until(const std::vector<double>& indices, double index) {
  if (indices.empty()) return index;
  return static_cast<double>(std::upper_bound(indices.begin(), indices.end(), index) - indices.begin());
}

const ConfirmationRecord* worst_check(const std::vector<ConfirmationRecord>& checks) {
  const auto worst = std::ranges::max_element(checks, {}, badness);
  return worst == checks.end() ? nullptr : &*worst;
}

std::string_view worst_figure(const ConfirmationRecord& check) {
  const std::array<double, 3> bad = badness(check);
  return bad[0] == 2   ? key_of(&Metrics::initial_contact_time)
         : bad[0] == 1 ? key_of(&Metrics::major_bounce_height)
                       : key_of(&Metrics::impact_velocity);
}

bool all_checks_land(const SearchRecord& search) { return std::ranges::all_of(search.checks, is_clean_run); }

std::string best_label(const ClosingRecord& result) { return result.search ? own_subject : "closing"; }

std::string baseline_label() { return "plain step"; }

Headline headline(const ClosingRecord& result) {
  if (result.devices() != nullptr) return {devices_headline(result), ""};
  const double window = window_end(result);
  const bool leaves = result.closed_state && result.closed_state->stable == false && result.best.figures &&
                      touches(*result.best.figures) && result.best.status != "collapsed_onto_electrode";
  const std::string rest =
      !leaves ? ""
      : result.closed_state->smallest_eigenvalue > 0
          ? " Whether it stays closed depends on the number of modes: with more modes than the scene has, the beam collapses "
            "onto the electrode."
          : " It does not stay closed: under the hold voltages the beam collapses onto the electrode in the end.";
  if (!result.search) {
    if (result.status == "interrupted") return {"The simulation was interrupted.", ""};
    const bool is_held = std::ranges::find(result.warnings, not_held) == result.warnings.end();
    return {capitalised(closing_clause({.subject = "the switch"}, result.best, window, is_held)) + "." + rest, ""};
  }
  if (result.status == "collapsed_at_rest")
    return {"The switch has no stable open equilibrium to start from at the voltages before t = 0.", ""};
  Headline line;
  if (result.status == "interrupted") line.main = "The search was interrupted; this is its best so far. ";
  const bool ended = result.status != "interrupted";
  const SearchRecord& search = *result.search;
  if (ended && search.plain_step_wins == true) {
    return {
        "The plain step does not bounce, and no waveform was found that is better without a harder impact. best.toml is the "
        "plain step.",
        capitalised(closing_clause({.subject = step_subject, .object = "the switch"}, result.baseline(), window)) + "." + rest};
  }
  if (ended && search.goal_met == false) line.main = "The goal was not met. ";
  if (ended && search.harder_than_step > 0)
    line.main += fmt::format(
        "The best waveform hits the contact harder than the plain step: by {} in impact velocity, contact force or impact "
        "energy. ",
        percent(search.harder_than_step));
  line.main += result.best.figures
                   ? capitalised(closing_clause({.subject = own_subject, .object = "the switch"}, result.best, window))
                   : "No feasible waveform was found";
  if (result.baseline().figures)
    line.rest = "; " + closing_clause({.subject = step_subject, .object = "it"}, result.baseline(), window);
  (line.rest.empty() ? line.main : line.rest) += "." + rest + of_devices_that_fail(result) + of_modes(result);
  return line;
}

std::string gap_caption(const ClosingRecord& result) {
  std::string what = "Distance of the contact point from the contact plane (positive: open)";
  if (bounces(result.best) || bounces(result.baseline()))
    what += fmt::format("; dots mark rebounds above {}", quantity(result.scene.significant_rebound, "m", 1));
  what += ".";
  const std::string own = landing_clause(result.search ? own_switch : "the switch", result.best);
  const std::string found = joined(result.search ? landing_clause(step_switch, result.baseline()) : "", own);
  return found.empty() ? what : what + " " + found;
}

std::string contact_caption(const ClosingRecord& result) {
  std::string words = "The bars are filled while the contact point touches.";
  const auto holds_several = [](const RunRecord& run) {
    const auto several = [](const std::vector<ClosedStretch>& all) {
      return std::ranges::any_of(all, [](const ClosedStretch& one) { return one.touches > 1; });
    };
    return (run.curve.closed && several(*run.curve.closed)) ||
           std::ranges::any_of(run.curve.closed_contacts, [&](const auto& one) { return several(one.second); });
  };
  if (holds_several(result.best) || holds_several(result.baseline()))
    words += " A pale bar stands for several touches; the openings between them are too short to be drawn.";
  const nlohmann::json& metrics = value_at(result.origin.scene, "metrics");
  for (const char* rule : {"closed_force", "closed_resistance", "closed_after"}) {
    if (value_at(metrics, rule).is_null()) continue;
    words += fmt::format(" They do not show when the connection is electrically closed, which metrics.{} decides.", rule);
    break;
  }
  return words;
}

std::string landing_caption(const ClosingRecord& result) {
  const auto reach = [&](const char* subject, const RunRecord& run) -> std::string {
    if (!run.figures || !touches(*run.figures)) return {};
    const double height = rebound_height(*run.figures);
    const std::string speed = quantity((*run.figures)[&Metrics::impact_velocity], "m/s");
    if (ends_at_touch(*run.figures)) return fmt::format("{} reaches the plane at {}", subject, speed);
    const std::string after = height > 0 ? "rebounds by up to " + quantity(height, "m") : "does not rebound";
    return fmt::format("{} reaches the plane at {} and {}", subject, speed, after);
  };
  const std::string found = result.search ? joined(reach(step_switch, result.baseline()), reach(own_switch, result.best))
                                          : joined(reach("the switch", result.best), "");
  return "The same gap, enlarged around the contact plane; below the plane the contact is compressed." +
         (found.empty() ? "" : " " + found);
}

std::string velocity_caption(const ClosingRecord& result) {
  const double own = figure_of_run(result.best, &Metrics::impact_velocity);
  const double step = figure_of_run(result.baseline(), &Metrics::impact_velocity);
  const std::string what = "Velocity of the contact point, positive towards the contact.";
  if (!result.search || !std::isfinite(step)) {
    return std::isfinite(own) ? fmt::format("{} The impact velocity is {}.", what, quantity(own, "m/s")) : what;
  }
  if (!std::isfinite(own)) return fmt::format("{} The impact velocity under the plain step is {}.", what, quantity(step, "m/s"));
  return fmt::format("{} The impact velocity is {} under the plain step and {} under softland's waveform{}.", what,
                     quantity(step, "m/s"), quantity(own, "m/s"), in_brackets(change(step, own, true)));
}

std::string force_caption(const ClosingRecord& result) {
  const double own = figure_of_run(result.best, &Metrics::peak_contact_force);
  const double step = figure_of_run(result.baseline(), &Metrics::peak_contact_force);
  const double hold = figure_of_run(result.best, &Metrics::hold_force);
  std::string words = "Force of the contact on the beam.";
  if (result.search && std::isfinite(step) && std::isfinite(own)) {
    words += fmt::format(" Its peak is {} under the plain step and {} under softland's waveform{}.", quantity(step, "N"),
                         quantity(own, "N"), in_brackets(change(step, own, true)));
  } else if (std::isfinite(own)) {
    words += fmt::format(" Its peak is {}.", quantity(own, "N"));
  }
  if (std::isfinite(hold)) words += fmt::format(" Closed and at rest, the contact carries {}.", quantity(hold, "N"));
  return words;
}

std::string waveform_caption(const ClosingRecord& result, const std::string& drive) {
  const Points& shape = waveform(result.best, drive);
  const bool equal = result.search && !shape.empty() && shape == waveform(result.baseline(), drive);
  const DriveScale scale = drive_scale(drive);
  const DriveLimits limits = drive_limits(result, drive);
  const std::string driver =
      !std::isfinite(limits.highest) || scale.unit.empty()
          ? ""
          : fmt::format(" The driver can supply {} to {}{}.",
                        given_quantity(std::isfinite(limits.lowest) ? limits.lowest : 0, "V"),
                        given_quantity(limits.highest, "V"),
                        std::isfinite(limits.slew) ? " with a slew rate of at most " + given_quantity(limits.slew, "V/s") : "");
  const std::string own = range_prose(shape, scale, equal);
  if (equal && !own.empty()) return fmt::format("{} of the drive “{}”. Both waveforms {}.{}", scale.name, drive, own, driver);
  const std::string step = range_prose(waveform(result.baseline(), drive), scale, equal);
  const std::string name = result.search ? own_subject : "the waveform";
  const std::string found =
      joined(own.empty() ? "" : name + " " + own, step.empty() ? "" : std::string(step_subject) + " " + step);
  return fmt::format("{} of the drive “{}”.{}{}", scale.name, drive, found.empty() ? "" : " " + found, driver);
}

std::string search_caption(const ClosingRecord& result, const SearchRecord& search) {
  const std::string whole_name = search.course.value_name.empty() ? "cost" : search.course.value_name;
  // A search over devices records the evaluations of its search for the nominal design: ", on the nominal design" ends the name.
  const std::string name = whole_name.substr(0, whole_name.find(','));
  const bool is_of_nominal = name != whole_name;
  const double own = result.best.cost;
  double first = std::numeric_limits<double>::quiet_NaN();
  double last = first;
  double found_at = first;
  for (const auto& [index, value] : search.course.best_so_far) {
    if (!std::isfinite(value)) continue;
    if (!std::isfinite(first)) first = value;
    if (value >= last) continue;
    last = value;
    // Find the evaluation of the best waveform: the last improvement to a cost not below its own. Lower costs may follow,
    // because a waveform that meets all goals of the search is preferred to a waveform of lower cost.
    if (!(last < own)) found_at = index;
  }
  std::string words = capitalised(name) + " of every waveform tried (dots) and of the best so far (line)";
  const double step = search.baseline.cost;
  words += is_of_nominal         ? " in the search for the nominal design alone."
           : std::isfinite(step) ? fmt::format("; that of the plain step is {}.", plain_number(step))
                                 : ".";
  if (!std::isfinite(first)) return words;
  words += std::isfinite(search.evaluations) ? fmt::format(" In {} evaluations the {}", whole(search.evaluations), name)
                                             : " The " + name;
  words += last < first ? fmt::format(" fell from {} to {}{}", plain_number(first), plain_number(last),
                                      in_brackets(change(first, last, true)))
                        : " stayed at " + plain_number(first);
  if (is_of_nominal) return words + "; its result is drawing.toml." + origin_of_best(result);
  const double number = evaluations_until(evaluation_indices(search.course), found_at);
  return words + fmt::format("; the chosen waveform is number {}.", whole(number));
}

bool checks_agree(const ClosingRecord& result) {
  return figure_of_run(result.best, &Metrics::bounce_count) != 0 || !result.search ||
         std::ranges::all_of(result.search->checks,
                             [](const ConfirmationRecord& check) { return check.is_of_gas() || is_clean_run(check); });
}

std::string checks_caption(const SearchRecord& search) {
  std::vector<ConfirmationRecord> numerics, laws;
  for (const ConfirmationRecord& check : search.checks) (check.is_of_gas() ? laws : numerics).push_back(check);
  if (numerics.empty()) return {};
  const auto clean = static_cast<std::size_t>(std::ranges::count_if(numerics, is_clean_run));
  const ConfirmationRecord& worst = *worst_check(numerics);
  std::string words =
      clean == numerics.size()
          ? fmt::format(
                "Confirmed: simulated again with {}, the switch closes bounce-free, with an impact velocity of at most {}.",
                names_of(numerics), impact_velocity_of(worst))
          : fmt::format(
                "Not confirmed: simulated again with {}, the switch is not bounce-free in {} {} re-runs; at worst {} ({}).",
                names_of(numerics), clean == 0 ? "all" : fmt::format("{} of", numerics.size() - clean), numerics.size(),
                course_of(worst), worst.name);
  if (!laws.empty()) words += laws_caption(laws);
  return words;
}

std::string families_caption(const SearchRecord& search) {
  std::string words;
  for (const SearchedFamilyResult& one : search.families) {
    if (one.evaluations == 0) continue;  // the search was stopped before its turn
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", one.family,
                         std::isfinite(one.cost) ? plain_number(one.cost) : std::string("does not close"));
  }
  return words;
}

std::string robust_caption(const ClosingRecord& result) {
  if (!result.search || !result.search->robust) return {};
  const RobustFindings& r = *result.search->robust;
  const auto whole = [](double value) { return std::isfinite(value) ? fmt::format("{:.0f}", value) : std::string("?"); };
  std::string words = fmt::format("The search used {} devices of the process variation and {} closings; its statistic was {}.",
                                  whole(r.devices), whole(r.closings), r.measure);
  const double own = result.best.cost, step = result.baseline().cost;
  if (std::isfinite(r.fresh_devices) && std::isfinite(own)) {
    words += fmt::format(" The cost is {} on {} new devices (plain step {})", plain_number(own), whole(r.fresh_devices),
                         plain_number(step));
    const double optimism = own / r.cost_on_searched - 1;
    if (std::isfinite(optimism)) {
      words += fmt::format(" and {} on those of the search: {} too {}", plain_number(r.cost_on_searched),
                           percent(std::abs(optimism)), optimism >= 0 ? "low" : "high");
    }
    words += ".";
  }
  if (r.yield) words += fmt::format(" {} of the new devices have {}.", yield_text(r.yield->share), r.yield->text);
  for (const FulfilledCondition& c : r.conditions) {
    words += fmt::format(" The condition {} {}: {} of the new devices fulfil it.", c.text, c.holds ? "holds" : "does not hold",
                         yield_text(c.share));
  }
  return words;
}

std::string limit_prose(const ClosingRecord& result) {
  const double touch = figure_of_run(result.best, &Metrics::initial_contact_time);
  const std::optional<TouchLimit> limit = result.search ? result.search->limit : std::nullopt;
  if (!limit || !std::isfinite(limit->least_time) || !std::isfinite(touch)) return {};
  return fmt::format(
      "The first touch takes {} times as long as the least time of any waveform of these drives, with the modes of the scene and "
      "an impact velocity of at most {} ({}).",
      plain_number(touch / limit->least_time, 4), quantity(limit->impact_velocity, "m/s"), quantity(limit->least_time, "s", 4));
}

}  // namespace softland::internal
