#include "reports/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/quantity.h"
#include "reports/result_view.h"

namespace softland::internal {
namespace {

using nlohmann::json;

/// Of whom a clause speaks, and of what: "Softland's waveform" closes "the switch"; "the plain step" closes "it".
struct Actor {
  std::string subject;
  std::string object;  ///< empty: the subject is the switch itself
};

/// An estimated error beyond which a figure is quoted with "about": half a bounce, one per cent of a time. One that is not known
/// counts as beyond after more than a few rebounds.
constexpr double doubtful_count = 0.5;
constexpr double doubtful_time = 0.01;
constexpr double few_rebounds = 5;

constexpr int figure_digits = 4;  // of the tables, where the error does not allow fewer

std::string times_word(double count) { return count == 1 ? "once" : whole(count) + " times"; }

std::string within(double window) { return std::isfinite(window) ? " within " + quantity(window, "s") : std::string(); }

/// The highest rebound [m], 0 where it is too low to be told from none.
double rebound_height(const json& metrics) {
  const double height = number(metrics, {"major_bounce_height_m"});
  return height < resolution("m") ? 0 : height;
}

bool touches(const json& metrics) { return std::isfinite(number(metrics, {"initial_contact_time_s"})); }

bool settles(const json& metrics) {
  return truth(metrics, {"settled"}).value_or(true) && std::isfinite(number(metrics, {"permanent_contact_time_s"}));
}

bool clean(const json& metrics) { return touches(metrics) && settles(metrics) && number(metrics, {"bounce_count"}) == 0; }

/// Touched, and nothing is known of what followed: the scene has no contact, or the run stopped.
bool ends_at_touch(const json& metrics) { return touches(metrics) && !std::isfinite(number(metrics, {"bounce_count"})); }

std::string closes(const Actor& actor, const std::string& when) {
  return actor.object.empty() ? fmt::format("{} closes {}", actor.subject, when)
                              : fmt::format("{} closes {} {}", actor.subject, actor.object, when);
}

bool doubtful(const json& metrics, double error, double limit) {
  return std::isfinite(error) ? error > limit : number(metrics, {"bounce_count"}) > few_rebounds;
}

/// "bounces about 79 times"; `errors` may be null.
std::string bounces(const json& metrics, const json& errors) {
  const bool about = doubtful(metrics, number(errors, {"bounce_count"}), doubtful_count);
  return fmt::format("bounces {}{}", about ? "about " : "", times_word(number(metrics, {"bounce_count"})));
}

/// The settling time, with "about" where it is doubtful.
std::string settling(const json& metrics, const json& errors) {
  const double settled = number(metrics, {"permanent_contact_time_s"});
  const double error = number(errors, {"permanent_contact_time_s"});
  return (doubtful(metrics, error, doubtful_time * settled) ? "about " : "") + quantity_within(settled, error, "s");
}

/// What one closing does, as a clause without full stop.
std::string clause(const Actor& actor, const json& metrics, const json& errors, const std::string& status, double window) {
  if (status == "collapsed_at_rest") return actor.subject + " has no stable rest position: it collapses before it is driven";
  if (status == "numerical_failure") return actor.subject + " could not be simulated to the end";
  if (!metrics.is_object()) return "there are no figures for " + actor.subject;
  if (!touches(metrics)) {
    return fmt::format("{} does not close{}{}", actor.subject, actor.object.empty() ? "" : " " + actor.object, within(window));
  }
  const double first = number(metrics, {"initial_contact_time_s"});
  if (ends_at_touch(metrics)) {
    return fmt::format("{} reaches the contact plane at {} with {}; without a [contact] section the run ends there",
                       actor.subject, quantity(first, "s"), quantity(number(metrics, {"impact_velocity_m_s"}), "m/s"));
  }
  const double count = number(metrics, {"bounce_count"});
  const double height = rebound_height(metrics);
  if (clean(metrics)) {
    std::string words = closes(actor, "at " + quantity(first, "s")) + " with no rebound";
    if (height > 0) words += " above " + quantity(height, "m");
    return words;
  }
  std::string words = fmt::format("{} first touches at {}", actor.subject, quantity(first, "s"));
  if (count > 0) {
    words += ", then " + bounces(metrics, errors);
    if (height > 0) words += " up to " + quantity(height, "m");
  } else if (height > 0) {
    words += ", then rebounds up to " + quantity(height, "m");
  }
  if (settles(metrics)) return words + " and settles after " + settling(metrics, errors);
  return words + " and has not settled when the window ends" + (std::isfinite(window) ? " at " + quantity(window, "s") : "");
}

/// The status of the winner or single run as far as it is about that run: an interrupted search still has a sound winner.
std::string run_status(const json& result) {
  const std::string own = text(best_metrics(result), {"status"});
  return own.empty() ? text(result, {"status"}) : own;
}

/// The smallest distance to the contact plane [m] of a run that never touched; NaN without its curve.
double closest(const json& result, const char* run) {
  double least = std::numeric_limits<double>::quiet_NaN();
  for (const double gap : numbers(at(result, {"curves", run, "tip_gap_m"}))) least = std::fmin(least, gap);
  return least;
}

/// How a run lands and what follows, as a clause; `run` names its curve.
std::string course(const std::string& subject, const json& result, const char* run, const json& metrics, const json& errors) {
  if (!metrics.is_object()) return {};
  if (!touches(metrics)) {
    const double least = closest(result, run);
    return subject + " never touches" + (std::isfinite(least) ? " (no nearer than " + quantity(least, "m") + ")" : "");
  }
  if (ends_at_touch(metrics)) {
    return fmt::format("{} first touches at {} with {}", subject, quantity(number(metrics, {"initial_contact_time_s"}), "s"),
                       quantity(number(metrics, {"impact_velocity_m_s"}), "m/s"));
  }
  const double height = rebound_height(metrics);
  if (clean(metrics)) {
    const std::string above = height > 0 ? fmt::format(" but for rebounds of {} at most", quantity(height, "m")) : "";
    return fmt::format("{} lands at {} with {} and stays closed{}", subject,
                       quantity(number(metrics, {"initial_contact_time_s"}), "s"),
                       quantity(number(metrics, {"impact_velocity_m_s"}), "m/s"), above);
  }
  std::string words = subject + " ";
  words += number(metrics, {"bounce_count"}) > 0 ? bounces(metrics, errors) : "rebounds";
  if (height > 0) words += fmt::format(", up to {}", quantity(height, "m"));
  return words + (settles(metrics) ? ", until " + settling(metrics, errors) : ", and is still open when the window ends");
}

/// "a; b." with what is empty left out; empty when both are.
std::string joined(const std::string& first, const std::string& second) {
  if (first.empty() && second.empty()) return {};
  if (first.empty() || second.empty()) return capitalised(first + second) + ".";
  return capitalised(first) + "; " + second + ".";
}

std::string in_brackets(const Change& change) { return change.words.empty() ? std::string() : " (" + change.words + ")"; }

constexpr const char* own_subject = "softland's waveform";
constexpr const char* step_subject = "the plain step";

}  // namespace

std::string capitalised(std::string words) {
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
  return words;
}

std::string best_label(const json& result) { return is_optimize(result) ? own_subject : "closing"; }

std::string baseline_label() { return "plain step"; }

Headline headline(const json& result) {
  const double window = window_end(result);
  const std::string status = text(result, {"status"});
  if (!is_optimize(result)) {
    if (status == "interrupted") return {"The simulation was interrupted.", ""};
    return {
        capitalised(clause({"the switch", ""}, best_metrics(result), at(result, {"errors"}), run_status(result), window)) + ".",
        ""};
  }
  if (status == "collapsed_at_rest") return {"The switch has no stable rest position: it collapses before it is driven.", ""};
  Headline line;
  if (status == "interrupted") line.main = "The search was interrupted; this is its best so far. ";
  if (status != "interrupted" && truth(result, {"goal_met"}) == false) line.main = "The goal was not met. ";
  line.main += best_metrics(result).is_object() ? capitalised(clause({own_subject, "the switch"}, best_metrics(result),
                                                                     at(result, {"errors"}), run_status(result), window))
                                                : "No feasible waveform was found";
  const json& baseline = baseline_metrics(result);
  if (baseline.is_object()) {
    line.rest =
        "; " + clause({step_subject, "it"}, baseline, at(result, {"baseline", "errors"}), text(baseline, {"status"}), window);
  }
  (line.rest.empty() ? line.main : line.rest) += ".";
  return line;
}

Change change(double before, double after, bool lower_is_better, Kind kind) {
  if (!std::isfinite(before) || !std::isfinite(after)) return {};
  constexpr double visible = 0.005;  // a ratio nearer to 1 than half a per cent is no change worth a word
  if (std::abs(after - before) <= visible * std::abs(before)) return {"unchanged", Verdict::same};
  const bool lower = after < before;
  const Verdict verdict = !lower_is_better ? Verdict::neutral : lower ? Verdict::better : Verdict::worse;
  if (after == 0 && before > 0) return {"none left", verdict};
  const char* word = kind == Kind::time    ? (lower ? "shorter" : "longer")
                     : kind == Kind::count ? (lower ? "fewer" : "more")
                     : lower               ? "lower"
                                           : "higher";
  if (!(before > 0) || !(after > 0)) return {word, verdict};
  const double ratio = lower ? before / after : after / before;
  if (ratio < 1.095) return {fmt::format("{:.1f} % {}", 100 * std::abs(after / before - 1), word), verdict};
  return {times(ratio) + " " + word, verdict};
}

std::string figure_text(const json& metrics, const json& errors, const json& beside, const Figure& figure) {
  if (figure.is_yes_or_no()) {
    const auto value = truth(metrics, {figure.key});
    return value ? (*value ? "yes" : "no") : "—";
  }
  const double value = number(metrics, {figure.key}), error = number(errors, {figure.key});
  return value == 0 ? quantity_beside(value, number(beside, {figure.key}), figure.unit, figure_digits)
                    : quantity_within(value, error, figure.unit, figure_digits);
}

std::string error_text(const json& metrics, const json& errors, const Figure& figure) {
  return error_of(number(metrics, {figure.key}), number(errors, {figure.key}), figure.unit, figure_digits);
}

std::string cloud_text(const json& result, const Figure& figure) {
  const json& cloud = at(result, {"certified", figure.key});
  if (!cloud.is_object()) return {};
  const auto value = [&](const char* key) {
    return quantity_beside(number(cloud, {key}), number(cloud, {"high"}), figure.unit, figure_digits);
  };
  return fmt::format("median {}, {} to {} in {} runs", value("median"), value("low"), value("high"),
                     whole(number(cloud, {"runs"})));
}

std::string error_heading(const json& result) {
  return at(result, {"certified"}).is_object() ? "± certified" : "± integration only";
}

std::string certificate_caption(const json& result) {
  const json& certified = at(result, {"certified"});
  if (!certified.is_object()) {
    return number(best_metrics(result), {"bounce_count"}) > 0
               ? "The settling time and the number of rebounds have no error here: past the first large rebound a closing is "
                 "chaotic. softland simulate --certify gives their range."
               : "";
  }
  if (certified.empty())
    return "Certified: no figure is ill-conditioned, and the estimated errors cover tolerance, quadrature and pull-in voltages.";
  std::string words = fmt::format(
      "Certified: the figures with a median and a range are ill-conditioned, properties of a cloud of {} runs whose drives "
      "differ by one part in 1e9 to 1e7.",
      whole(number(result, {"cloud", "runs"})));
  const json& grazing = at(result, {"cloud", "grazing_rebound"});
  if (!grazing.is_object()) return words;
  words += fmt::format(" The runs part at rebound {} ({}, {} high)", whole(number(grazing, {"rebound"})),
                       quantity(number(grazing, {"time_s"}), "s", 4), quantity(number(grazing, {"height_m"}), "m"));
  return words + (truth(grazing, {"at_significant_height"}).value_or(false)
                      ? ", near the height from which rebounds count."
                      : fmt::format(", after the gentlest touch until then, {}.",
                                    quantity(number(grazing, {"impact_velocity_m_s"}), "m/s")));
}

std::string missing_reason(const json& metrics, const Figure& figure) {
  if (!metrics.is_object() || std::isfinite(number(metrics, {figure.key}))) return {};
  if (!touches(metrics)) return "no contact";
  if (ends_at_touch(metrics)) return "not known";
  return figure.conditioning == Conditioning::last_rebound && !settles(metrics) ? "not settled" : "";
}

Change figure_change(const json& before, const json& after, const Figure& figure) {
  const Kind kind = figure.unit == "s" ? Kind::time : figure.is_count() ? Kind::count : Kind::size;
  return change(number(before, {figure.key}), number(after, {figure.key}), figure.better == Better::lower, kind);
}

std::string goal_text(const json& result, const Figure& figure) {
  const std::string name = text(result, {"target"});
  if (name.empty()) return {};
  if (figure.is_yes_or_no()) return "yes";
  const std::optional<Target> target = target_from(name);
  if (!target) return {};
  if (figure.is_count()) return has_own_cost(*target) ? "" : "0";
  const double step = number(baseline_metrics(result), {figure.key});
  const bool wanted = has_own_cost(*target) && figure_of(*target).member == figure.member && std::isfinite(step);
  return wanted ? "below " + quantity(step, figure.unit, 4) : "";
}

std::string gap_caption(const json& result) {
  std::string what = "Distance of the contact point to the contact plane (positive: open)";
  if (number(best_metrics(result), {"bounce_count"}) > 0 || number(baseline_metrics(result), {"bounce_count"}) > 0) {
    what += fmt::format("; dots mark rebounds above {}", quantity(significant_rebound(result), "m", 1));
  }
  what += ".";
  const std::string own =
      course(is_optimize(result) ? own_subject : "the switch", result, "best", best_metrics(result), at(result, {"errors"}));
  const std::string found =
      is_optimize(result)
          ? joined(course(step_subject, result, "baseline", baseline_metrics(result), at(result, {"baseline", "errors"})), own)
          : joined(own, "");
  return found.empty() ? what : what + " " + found;
}

std::string landing_caption(const json& result) {
  const auto reach = [&](const char* subject, const json& metrics) -> std::string {
    if (!touches(metrics)) return {};
    const double height = rebound_height(metrics);
    const std::string speed = quantity(number(metrics, {"impact_velocity_m_s"}), "m/s");
    if (ends_at_touch(metrics)) return fmt::format("{} reaches the plane with {}", subject, speed);
    const std::string after = height > 0 ? "rises " + quantity(height, "m") + " above it again" : "does not rise above it again";
    return fmt::format("{} reaches the plane with {} and {}", subject, speed, after);
  };
  const std::string found = is_optimize(result)
                                ? joined(reach(step_subject, baseline_metrics(result)), reach(own_subject, best_metrics(result)))
                                : joined(reach("the switch", best_metrics(result)), "");
  return "The same gap in a narrow band around the contact plane; below it the contact is pressed." +
         (found.empty() ? "" : " " + found);
}

std::string velocity_caption(const json& result) {
  const double own = number(best_metrics(result), {"impact_velocity_m_s"});
  const double step = number(baseline_metrics(result), {"impact_velocity_m_s"});
  const std::string what = "Velocity of the contact point, positive towards the contact.";
  if (!is_optimize(result) || !std::isfinite(step)) {
    return std::isfinite(own) ? fmt::format("{} It lands at {}.", what, quantity(own, "m/s")) : what;
  }
  if (!std::isfinite(own)) return fmt::format("{} The plain step lands at {}.", what, quantity(step, "m/s"));
  return fmt::format("{} The plain step lands at {}, softland's waveform at {}{}.", what, quantity(step, "m/s"),
                     quantity(own, "m/s"), in_brackets(change(step, own, true)));
}

std::string force_caption(const json& result) {
  const double own = number(best_metrics(result), {"peak_contact_force_N"});
  const double step = number(baseline_metrics(result), {"peak_contact_force_N"});
  const double hold = number(best_metrics(result), {"hold_force_N"});
  std::string words = "Force of the contact on the beam.";
  if (is_optimize(result) && std::isfinite(step) && std::isfinite(own)) {
    words += fmt::format(" The plain step peaks at {}, softland's waveform at {}{}.", quantity(step, "N"), quantity(own, "N"),
                         in_brackets(change(step, own, true)));
  } else if (std::isfinite(own)) {
    words += fmt::format(" It peaks at {}.", quantity(own, "N"));
  }
  if (std::isfinite(hold)) words += fmt::format(" Closed and at rest, the contact carries {}.", quantity(hold, "N"));
  return words;
}

std::string waveform_caption(const json& result, const std::string& drive) {
  const json& shape = at(result, {"best", "waveforms", drive});
  const bool equal = is_optimize(result) && !shape.is_null() && shape == at(result, {"baseline", "waveforms", drive});
  const DriveScale scale = drive_scale(drive);
  const auto range = [&](const char* run) -> std::string {
    const json& waveform = at(result, {run, "waveforms", drive});
    const DriveDemand demand = drive_demand(waveform, scale.rest);
    if (!std::isfinite(demand.lowest)) return {};
    if (demand.lowest == demand.highest)
      return fmt::format("{} at {}", equal ? "stay" : "stays", quantity(demand.lowest, scale.unit));
    const std::string slew = scale.unit.empty()        ? ""
                             : std::isinf(demand.slew) ? ", with a jump"
                                                       : ", at most " + quantity(demand.slew, "V/s");
    return fmt::format("{} between {} and {}{}", equal ? "run" : "runs",
                       quantity_beside(demand.lowest, demand.highest, scale.unit),
                       quantity_beside(demand.highest, demand.lowest, scale.unit), slew);
  };
  const DriveLimits limits = drive_limits(result, drive);
  const std::string driver =
      !std::isfinite(limits.highest) || scale.unit.empty()
          ? ""
          : fmt::format(" The driver gives {} to {}{}.", given_quantity(std::isfinite(limits.lowest) ? limits.lowest : 0, "V"),
                        given_quantity(limits.highest, "V"),
                        std::isfinite(limits.slew) ? ", at most " + given_quantity(limits.slew, "V/s") : "");
  const std::string own = range("best");
  if (equal && !own.empty()) return fmt::format("{} of the drive “{}”. Both waveforms {}.{}", scale.name, drive, own, driver);
  const std::string step = range("baseline");
  const std::string name = is_optimize(result) ? own_subject : "the waveform";
  const std::string found =
      joined(own.empty() ? "" : name + " " + own, step.empty() ? "" : std::string(step_subject) + " " + step);
  return fmt::format("{} of the drive “{}”.{}{}", scale.name, drive, found.empty() ? "" : " " + found, driver);
}

std::string search_caption(const json& result) {
  const json& best = at(result, {"search", "best_so_far"});
  std::string name = text(result, {"search", "value_name"});
  if (name.empty()) name = "cost";
  const double own = number(result, {"best", "cost"});
  double first = std::numeric_limits<double>::quiet_NaN();
  double last = first;
  double found_at = first;
  if (best.is_array()) {
    for (const json& point : best) {
      if (!point.is_array() || point.size() != 2 || !std::isfinite(number(point[1]))) continue;
      if (!std::isfinite(first)) first = number(point[1]);
      if (number(point[1]) >= last) continue;
      last = number(point[1]);
      // The winner is not always the lowest: the next best that meets the goal is preferred.
      if (!(last < own)) found_at = number(point[0]);
    }
  }
  std::string words = capitalised(name) + " of every waveform tried (dots) and of the best so far (line)";
  const double step = number(result, {"baseline", "cost"});
  words += std::isfinite(step) ? fmt::format("; the plain step's is {}.", plain_number(step)) : ".";
  if (!std::isfinite(first)) return words;
  const double evaluations = number(result, {"evaluations"});
  words += std::isfinite(evaluations) ? fmt::format(" In {} evaluations the {}", whole(evaluations), name) : " The " + name;
  words += last < first ? fmt::format(" fell from {} to {}{}", plain_number(first), plain_number(last),
                                      in_brackets(change(first, last, true)))
                        : " stayed at " + plain_number(first);
  return words +
         fmt::format("; the winner is number {} of them.", whole(evaluations_until(evaluation_indices(result), found_at)));
}

bool checks_agree(const json& result) {
  const json& checks = at(result, {"checks"});
  if (!checks.is_array()) return true;
  return number(best_metrics(result), {"bounce_count"}) != 0 ||
         std::all_of(checks.begin(), checks.end(), [](const json& check) { return clean(at(check, {"metrics"})); });
}

std::string checks_caption(const json& result) {
  const json& checks = at(result, {"checks"});
  if (!checks.is_array() || checks.empty()) return {};
  std::size_t clean_runs = 0;
  std::string worst;
  double worst_height = -1;
  for (const json& check : checks) {
    const json& metrics = at(check, {"metrics"});
    if (clean(metrics)) {
      ++clean_runs;
      continue;
    }
    const double height = rebound_height(metrics);
    if (std::isfinite(height) && height > worst_height) {
      worst_height = height;
      worst = text(check, {"name"});
    }
  }
  const char* noun = checks.size() == 1 ? "confirmation" : "confirmations";
  if (clean_runs == checks.size()) {
    return checks.size() == 1
               ? "The winner was simulated again another way; that run closes without a rebound too."
               : fmt::format("The winner was simulated again in {} other ways; all of them close without a rebound.",
                             checks.size());
  }
  std::string words = fmt::format("{} of {} {} of the winner {} without a rebound", clean_runs, checks.size(), noun,
                                  clean_runs == 1 ? "closes" : "close");
  if (worst_height > 0) words += fmt::format("; the highest rebound is {} (“{}”)", quantity(worst_height, "m"), worst);
  return words + ".";
}

}  // namespace softland::internal
