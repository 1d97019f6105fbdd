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

/// An estimated error beyond which a figure is quoted with "about": half a bounce, one per cent of a time.
constexpr double doubtful_count = 0.5;
constexpr double doubtful_time = 0.01;

std::string times_word(double count) { return count == 1 ? "once" : fmt::format("{:.0f} times", count); }

std::string within(double window) { return std::isfinite(window) ? " within " + quantity(window, "s") : std::string(); }

bool touches(const json& metrics) { return std::isfinite(number(metrics, {"initial_contact_time_s"})); }

bool settles(const json& metrics) {
  return truth(metrics, {"settled"}).value_or(true) && std::isfinite(number(metrics, {"permanent_contact_time_s"}));
}

bool clean(const json& metrics) { return touches(metrics) && settles(metrics) && number(metrics, {"bounce_count"}) == 0; }

std::string closes(const Actor& actor, const std::string& when) {
  return actor.object.empty() ? fmt::format("{} closes {}", actor.subject, when)
                              : fmt::format("{} closes {} {}", actor.subject, actor.object, when);
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
  const double count = number(metrics, {"bounce_count"});
  const double height = number(metrics, {"major_bounce_height_m"});
  if (clean(metrics)) {
    std::string words = closes(actor, "at " + quantity(first, "s")) + " with no rebound";
    if (height > 0) words += " above " + quantity(height, "m");
    return words;
  }
  std::string words = fmt::format("{} first touches at {}", actor.subject, quantity(first, "s"));
  if (count > 0) {
    const bool doubtful = number(errors, {"bounce_count"}) > doubtful_count;
    words += fmt::format(", then bounces {}{}", doubtful ? "about " : "", times_word(count));
    if (height > 0) words += " up to " + quantity(height, "m");
  } else if (height > 0) {
    words += ", then rebounds up to " + quantity(height, "m");
  }
  if (settles(metrics)) {
    const double settled = number(metrics, {"permanent_contact_time_s"});
    const bool doubtful = number(errors, {"permanent_contact_time_s"}) > doubtful_time * settled;
    return words + fmt::format(" and settles after {}{}", doubtful ? "about " : "", quantity(settled, "s"));
  }
  return words + " and has not settled when the window ends" + (std::isfinite(window) ? " at " + quantity(window, "s") : "");
}

std::string capitalised(std::string words) {
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
  return words;
}

/// The status of the winner or single run as far as it is about that run: an interrupted search still has a sound winner.
std::string run_status(const json& result) {
  const std::string own = text(best_metrics(result), {"status"});
  return own.empty() ? text(result, {"status"}) : own;
}

/// What happens after first touch, as a clause.
std::string aftermath(const std::string& subject, const json& metrics) {
  if (!metrics.is_object()) return {};
  if (!touches(metrics)) return subject + " never touches";
  if (!settles(metrics)) return subject + " is still bouncing when the window ends";
  if (number(metrics, {"bounce_count"}) == 0) return subject + " stays closed from its first touch on";
  const double bounce_time = number(metrics, {"bounce_time_s"});
  if (!std::isfinite(bounce_time)) return {};
  return fmt::format("{} bounces for {} after its first touch", subject, quantity(bounce_time, "s"));
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
  return {fmt::format("{} times {}", ratio < 9.95 ? fmt::format("{:.1f}", ratio) : plain_number(std::round(ratio), 3), word),
          verdict};
}

const std::vector<Figure>& figures() {
  static const std::vector<Figure> all{{"initial_contact_time_s", "First contact", "s", false},
                                       {"permanent_contact_time_s", "Permanent contact (settling time)", "s", true},
                                       {"bounce_time_s", "Bounce time", "s", true},
                                       {"bounce_count", "Rebounds", "", true},
                                       {"major_bounce_height_m", "Highest rebound", "m", true},
                                       {"impact_velocity_m_s", "Impact speed", "m/s", true},
                                       {"peak_contact_force_N", "Peak contact force", "N", true},
                                       {"impact_energy_J", "Impact energy", "J", true},
                                       {"hold_force_N", "Hold force", "N", false},
                                       {"drive_energy_J", "Drive energy", "J", false},
                                       {"peak_voltage_V", "Peak voltage", "V", false},
                                       {"peak_slew_V_s", "Peak slew", "V/s", false},
                                       {"settled", "Settled", "bool", false}};
  return all;
}

std::string figure_text(const json& metrics, const json& beside, const Figure& figure) {
  if (figure.unit == "bool") {
    const auto value = truth(metrics, {figure.key});
    return value ? (*value ? "yes" : "no") : "—";
  }
  constexpr int digits = 4;
  return quantity_beside(number(metrics, {figure.key}), number(beside, {figure.key}), figure.unit, digits);
}

std::string missing_reason(const json& metrics, std::string_view key) {
  if (!metrics.is_object() || std::isfinite(number(metrics, {key}))) return {};
  if (!touches(metrics)) return "no contact";
  return key == "permanent_contact_time_s" && !settles(metrics) ? "not settled" : "";
}

Change figure_change(const json& before, const json& after, const Figure& figure) {
  return change(number(before, {figure.key}), number(after, {figure.key}), figure.lower_is_better, figure.kind());
}

std::string gap_caption(const json& result) {
  std::string what = "Distance of the contact point to the contact plane (positive: open)";
  if (number(best_metrics(result), {"bounce_count"}) > 0 || number(baseline_metrics(result), {"bounce_count"}) > 0) {
    what += fmt::format("; dots mark rebounds above {}", quantity(significant_rebound(result), "m", 1));
  }
  what += ".";
  const std::string found = is_optimize(result) ? joined(aftermath(step_subject, baseline_metrics(result)),
                                                         aftermath(own_subject, best_metrics(result)))
                                                : joined(aftermath("the switch", best_metrics(result)), "");
  return found.empty() ? what : what + " " + found;
}

std::string landing_caption(const json& result) {
  return fmt::format(
      "The same gap, enlarged: the scale is logarithmic above {} and linear below, so that rebounds of a few nanometres show "
      "beside the whole travel.",
      quantity(significant_rebound(result), "m", 1));
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
  const auto range = [&](const char* run) -> std::string {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (const json& point : at(result, {run, "waveforms", drive})) {
      if (!point.is_array() || point.size() != 2 || !std::isfinite(number(point[1]))) continue;
      lowest = std::min(lowest, number(point[1]));
      highest = std::max(highest, number(point[1]));
    }
    if (lowest > highest) return {};
    if (lowest == highest) return fmt::format("{} at {}", equal ? "stay" : "stays", quantity(lowest, "V"));
    return fmt::format("{} between {} and {}", equal ? "run" : "runs", quantity_beside(lowest, highest, "V"),
                       quantity_beside(highest, lowest, "V"));
  };
  const std::string own = range("best");
  if (equal && !own.empty()) return fmt::format("Voltage of the drive “{}”. Both waveforms {}.", drive, own);
  const std::string step = range("baseline");
  const std::string name = is_optimize(result) ? own_subject : "the waveform";
  const std::string found =
      joined(own.empty() ? "" : name + " " + own, step.empty() ? "" : std::string(step_subject) + " " + step);
  return fmt::format("Voltage of the drive “{}”.{}", drive, found.empty() ? "" : " " + found);
}

std::string search_caption(const json& result) {
  const json& best = at(result, {"search", "best_so_far"});
  std::string name = text(result, {"search", "value_name"});
  if (name.empty()) name = "cost";
  double first = std::numeric_limits<double>::quiet_NaN();
  double last = first;
  double found_at = first;
  if (best.is_array()) {
    for (const json& point : best) {
      if (!point.is_array() || point.size() != 2 || !std::isfinite(number(point[1]))) continue;
      if (!std::isfinite(first)) first = number(point[1]);
      if (!(number(point[1]) >= last)) {
        last = number(point[1]);
        found_at = number(point[0]);
      }
    }
  }
  std::string words = capitalised(name) + " of every waveform tried (dots) and of the best so far (line).";
  if (!std::isfinite(first)) return words;
  const double evaluations = number(result, {"evaluations"});
  const Change lowered = change(first, last, true);
  words += std::isfinite(evaluations) ? fmt::format(" In {:.0f} evaluations the {} fell", evaluations, name)
                                      : fmt::format(" The {} fell", name);
  return words + fmt::format(" from {} to {}{}; the winner is evaluation {:.0f}.", plain_number(first), plain_number(last),
                             in_brackets(lowered), found_at);
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
    const double height = number(metrics, {"major_bounce_height_m"});
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
