#include "reports/closing_prose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "document/quantity.h"
#include "objectives/figure_values.h"
#include "studies/closing/prepared.h"
#include "studies/search/optimize.h"

namespace softland::internal {
namespace {

/// Estimated errors beyond which a figure of merit is quoted with "about": absolute error of the bounce count, relative error
/// of the settling time. If the error is unknown, "about" stands when the closing has more than `few_rebounds` bounces.
constexpr double doubtful_count = 0.5;
constexpr double doubtful_time = 0.01;
constexpr double few_rebounds = 5;

std::string times_word(double count) { return count == 1 ? "once" : whole(count) + " times"; }

std::string closes(const Actor& actor, const std::string& how) {
  return actor.object.empty() ? fmt::format("{} closes {}", actor.subject, how)
                              : fmt::format("{} closes {} {}", actor.subject, actor.object, how);
}

/// Returns the moving switch as the subject of a clause: "the switch", or "with the plain step it" if the clause is about a
/// waveform.
std::string moving(const Actor& actor) {
  return actor.object.empty() ? actor.subject : fmt::format("with {} {}", actor.subject, actor.object);
}

bool doubtful(const FigureValues& figures, double error, double limit) {
  return std::isfinite(error) ? error > limit : figures[&Metrics::bounce_count] > few_rebounds;
}

/// Describes the number of bounces of a closing: "bounces about 79 times".
std::string bounces(const FigureValues& figures, const FigureValues& errors) {
  const bool about = doubtful(figures, errors[&Metrics::bounce_count], doubtful_count);
  return fmt::format("bounces {}{}", about ? "about " : "", times_word(figures[&Metrics::bounce_count]));
}

/// Returns the settling time of the contact as text; with "about" if its error is large.
std::string settling(const FigureValues& figures, const FigureValues& errors) {
  const double settled = figures[&Metrics::permanent_contact_time];
  const double error = errors[&Metrics::permanent_contact_time];
  return (doubtful(figures, error, doubtful_time * settled) ? "about " : "") + quantity_within(settled, error, "s");
}

std::string first_touch(const FigureValues& figures) { return quantity(figures[&Metrics::initial_contact_time], "s"); }
std::string impact(const FigureValues& figures) {
  return "an impact velocity of " + quantity(figures[&Metrics::impact_velocity], "m/s");
}

/// Returns the smallest distance to the contact plane [m] in a run without contact; NaN without the curve of the run.
double closest(const CurveRecord& curve) {
  double least = std::numeric_limits<double>::quiet_NaN();
  for (const double gap : curve.gap) least = std::fmin(least, gap);
  return least;
}

constexpr int figure_digits = 4;  // significant digits of a figure in tables, unless the error of the figure permits fewer

}  // namespace

bool touches(const FigureValues& figures) { return std::isfinite(figures[&Metrics::initial_contact_time]); }

bool settles(const FigureValues& figures) {
  return figures[&Metrics::settled] != 0 && std::isfinite(figures[&Metrics::permanent_contact_time]);
}

bool ends_at_touch(const FigureValues& figures) { return touches(figures) && !std::isfinite(figures[&Metrics::bounce_count]); }

bool touches_in_part(const RunRecord& run) { return run.figures && run.status == "not_settled" && ends_at_touch(*run.figures); }

bool began_closed(const RunRecord& run) {
  if (!run.figures || touches(*run.figures)) return false;
  return run.status == "not_settled" || (run.status == "done" && std::isfinite((*run.figures)[&Metrics::open_settling_time]));
}

bool is_clean(const FigureValues& figures) {
  return touches(figures) && settles(figures) && figures[&Metrics::bounce_count] == 0;
}

double rebound_height(const FigureValues& figures) {
  const double height = figures[&Metrics::major_bounce_height];
  return height < resolution("m") ? 0 : height;
}

double figure_of_run(const RunRecord& run, Figure::Member member) {
  return run.figures ? (*run.figures)[member] : Metrics::unset;
}

namespace {

std::string open_clause(const Actor& actor, const FigureValues& figures) {
  const double settling = figures[&Metrics::open_settling_time];
  return fmt::format("{} stays open, as commanded, with a static deflection of {}{}", moving(actor),
                     quantity(figures[&Metrics::static_deflection], "m"),
                     std::isfinite(settling) ? ", and comes to rest after " + quantity(settling, "s")
                                             : ", and has not come to rest when the window ends");
}

// Describes the opening in a run that began with a closed contact, so that no first contact follows.
std::string opening_clause(const Actor& actor, const FigureValues& figures, const std::string& end) {
  const double settling = figures[&Metrics::open_settling_time];
  if (!std::isfinite(settling))
    return fmt::format("{} begins closed and has not come to rest in its open position when the window ends{}", moving(actor),
                       end.empty() ? "" : " at " + end);
  return fmt::format("{} begins closed, opens and is at rest from {} on, with a static deflection of {}", moving(actor),
                     quantity(settling, "s"), quantity(figures[&Metrics::static_deflection], "m"));
}

// Describes how the switch opens on command in a run; empty if no waveform has a command to open.
std::string opening_on_command(const FigureValues& figures) {
  const double command = figures[&Metrics::open_command], opening = figures[&Metrics::opening_time];
  if (!std::isfinite(command)) return {};
  const std::string at = "the command to open at " + quantity(command, "s");
  if (!std::isfinite(opening)) return "; it does not open after " + at;
  std::string words = fmt::format("; it opens {} after {}", quantity(opening, "s"), at);
  const auto bounces = static_cast<int>(figures[&Metrics::release_bounces]);
  if (bounces > 0) words += fmt::format(", with {} {}", bounces, bounces > 1 ? "bounces" : "bounce");
  const double rest = figures[&Metrics::release_settling_time];
  return words + (std::isfinite(rest) ? fmt::format(", and is at rest {} after the command", quantity(rest, "s"))
                                      : ", and has not come to rest when the window ends");
}

std::string landing_prose(const Actor& actor, const RunRecord& run, const FigureValues& figures, const std::string& end,
                          bool is_held) {
  const double height = rebound_height(figures);
  if (is_clean(figures)) {
    const std::string words = closes(actor, "bounce-free at " + first_touch(figures));
    return height > 0 ? words + " (highest rebound " + quantity(height, "m") + ")" : words;
  }
  std::string words = fmt::format("{} first touches at {}", moving(actor), first_touch(figures));
  if (figures[&Metrics::bounce_count] > 0) {
    words += ", then " + bounces(figures, run.errors);
    if (height > 0) words += " up to " + quantity(height, "m");
  } else if (height > 0) {
    words += ", then rebounds by up to " + quantity(height, "m");
  }
  if (settles(figures)) return words + " and settles after " + settling(figures, run.errors);
  if (!is_held) return words + " and does not stay closed: its hold voltage is below the release voltage";
  if (std::isfinite(figures[&Metrics::open_command])) return words + " and has not settled when it is commanded to open";
  return words + " and has not settled when the window ends" + (end.empty() ? "" : " at " + end) +
         " (later bounces are not counted)";
}

}  // namespace

std::string closing_clause(const Actor& actor, const RunRecord& run, double window, bool is_held) {
  if (run.status == "collapsed_at_rest")
    return moving(actor) +
           " has no stable equilibrium to start from at the voltages before t = 0 (an open one, unless before_state asks for a "
           "closed one)";
  if (run.status == "collapsed_onto_electrode") {
    const bool through = !run.figures || touches(*run.figures);
    return moving(actor) + (through ? " collapses onto the electrode, past its contact"
                                    : " collapses onto an electrode before it touches its contact");
  }
  if (run.status == "numerical_failure") return moving(actor) + " could not be simulated to the end";
  if (!run.figures) return "there are no figures for " + actor.subject;
  const FigureValues& figures = *run.figures;
  const std::string end = std::isfinite(window) ? quantity(window, "s") : std::string();
  if (run.status == "open") return open_clause(actor, figures);
  if (began_closed(run)) return opening_clause(actor, figures, end);
  if (!touches(figures)) {
    return fmt::format("{} does not close{}{}", actor.subject, actor.object.empty() ? "" : " " + actor.object,
                       end.empty() ? "" : " within " + end);
  }
  if (touches_in_part(run)) {
    return fmt::format("{} first touches at {} with {}; the contacts that make the connection are never closed together{}",
                       moving(actor), first_touch(figures), impact(figures), end.empty() ? "" : " within " + end);
  }
  if (ends_at_touch(figures)) {
    return fmt::format(
        "{} reaches the contact plane at {} with {}; the run ends there, because the scene has no [contact] section",
        moving(actor), first_touch(figures), impact(figures));
  }
  return landing_prose(actor, run, figures, end, is_held) + opening_on_command(figures);
}

std::string landing_clause(const std::string& subject, const RunRecord& run) {
  if (!run.figures) return {};
  const FigureValues& figures = *run.figures;
  if (!touches(figures)) {
    const double least = closest(run.curve), open = figures[&Metrics::open_settling_time];
    if (began_closed(run) || least <= 0)
      return subject + " begins closed" +
             (std::isfinite(open) ? " and is open and at rest from " + quantity(open, "s") + " on" : "");
    return subject + " never touches" + (std::isfinite(least) ? ": the smallest gap is " + quantity(least, "m") : "");
  }
  if (touches_in_part(run)) return fmt::format("{} touches with {} but never closes the connection", subject, impact(figures));
  if (ends_at_touch(figures))
    return fmt::format("{} first touches at {} with {}", subject, first_touch(figures), impact(figures));
  const double height = rebound_height(figures);
  if (is_clean(figures)) {
    const std::string above = height > 0 ? fmt::format(" but for rebounds of at most {}", quantity(height, "m")) : "";
    return fmt::format("{} lands at {} with {} and stays closed{}", subject, first_touch(figures), impact(figures), above);
  }
  std::string words = subject + " ";
  words += figures[&Metrics::bounce_count] > 0 ? bounces(figures, run.errors) : "rebounds";
  if (height > 0) words += fmt::format(", up to {}", quantity(height, "m"));
  return words + (settles(figures) ? ", until " + settling(figures, run.errors) : ", and has not settled when the window ends");
}

std::string capitalised(std::string words) {
  if (!words.empty() && words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
  return words;
}

std::string joined(const std::string& first, const std::string& second) {
  if (first.empty() && second.empty()) return {};
  if (first.empty() || second.empty()) return capitalised(first + second) + ".";
  return capitalised(first) + "; " + second + ".";
}

Change change(double before, double after, bool lower_is_better, ChangeKind kind) {
  if (!std::isfinite(before) || !std::isfinite(after)) return {};
  // Relative change of a figure of merit up to which the report calls it unchanged.
  constexpr double visible = 0.005;
  if (std::abs(after - before) <= visible * std::abs(before)) return {"unchanged", Verdict::same};
  const bool lower = after < before;
  const Verdict verdict = !lower_is_better ? Verdict::neutral : lower ? Verdict::better : Verdict::worse;
  if (after == 0 && before > 0) return {"none left", verdict};
  const char* word = kind == ChangeKind::time    ? (lower ? "shorter" : "longer")
                     : kind == ChangeKind::count ? (lower ? "fewer" : "more")
                     : lower                     ? "lower"
                                                 : "higher";
  if (!(before > 0) || !(after > 0)) return {word, verdict};
  const double ratio = lower ? before / after : after / before;
  if (ratio < 1.095) return {fmt::format("{:.1f} % {}", 100 * std::abs(after / before - 1), word), verdict};
  return {times(ratio) + " " + word, verdict};
}

Change figure_change(const RunRecord& before, const RunRecord& after, const Figure& figure) {
  if (figure.is_yes_or_no()) return {};
  const ChangeKind kind = figure.unit == "s" ? ChangeKind::time : figure.is_count() ? ChangeKind::count : ChangeKind::size;
  return change(figure_of_run(before, figure.member), figure_of_run(after, figure.member), figure.better == Better::lower, kind);
}

std::string figure_text(const Figure& figure, double value, double error, double beside) {
  if (figure.is_yes_or_no()) return std::isnan(value) ? "—" : value != 0 ? "yes" : "no";
  return value == 0 ? quantity_beside(value, beside, figure.unit, figure_digits)
                    : quantity_within(value, error, figure.unit, figure_digits);
}

std::string error_text(const Figure& figure, double value, double error) {
  return error_of(value, error, figure.unit, figure_digits);
}

std::string missing_reason(const RunRecord& run, const Figure& figure) {
  if (!run.figures || std::isfinite((*run.figures)[figure])) return {};
  if (!touches(*run.figures)) return run.status == "open" ? "open" : began_closed(run) ? "begins closed" : "no contact";
  if (ends_at_touch(*run.figures)) return "not known";
  return figure.conditioning == Conditioning::last_rebound && !settles(*run.figures) ? "not settled" : "";
}

std::string cloud_text(const ClosingRecord& result, const Figure& figure) {
  if (!result.certificate) return {};
  const std::vector<IllConditioned>& all = result.certificate->ill_conditioned;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const IllConditioned& one) { return one.figure.member == figure.member; });
  if (found == all.end()) return {};
  const auto value = [&](double one) { return quantity_beside(one, found->spread.high, figure.unit, figure_digits); };
  return fmt::format("median {}, {} to {} in {} runs", value(found->spread.median), value(found->spread.low),
                     value(found->spread.high), found->spread.runs);
}

std::string error_heading(const ClosingRecord& result) { return result.certificate ? "± certified" : "± integration only"; }

std::string certificate_caption(const ClosingRecord& result) {
  if (!result.certificate) {
    return figure_of_run(result.best, &Metrics::bounce_count) > 0
               ? "The settling time and the number of rebounds have no error estimate: after the first large rebound the motion "
                 "is chaotic. softland simulate --certify gives their range."
               : "";
  }
  if (result.certificate->ill_conditioned.empty())
    return "Certified: no figure is ill-conditioned, and the estimated errors cover tolerance, quadrature and pull-in voltages.";
  std::string words = fmt::format(
      "Certified: the figures with a median and a range are ill-conditioned. Their statistics are those of {} runs whose drives "
      "differ by one part in 1e9 to 1e7.",
      result.certificate->runs);
  const std::optional<GrazingRebound>& grazing = result.certificate->grazing;
  if (!grazing) return words;
  words += fmt::format(" The runs diverge at rebound {} ({}, {} high)", grazing->number, quantity(grazing->time, "s", 4),
                       quantity(grazing->height, "m"));
  return words + (grazing->at_threshold
                      ? ", close to the height from which rebounds count."
                      : fmt::format(", after the slowest impact until then ({}).", quantity(grazing->impact_velocity, "m/s")));
}

std::string goal_text(const ClosingRecord& result, const Figure& figure) {
  if (!result.search || result.search->target.empty()) return {};
  if (figure.is_yes_or_no()) return "yes";
  const TargetRow* target = find_named(targets, result.search->target);
  if (!target) return {};
  if (figure.is_count()) return target->has_own_cost ? "" : "0";
  const double step = figure_of_run(result.baseline(), figure.member);
  if (target->value == Target::settling && figure.member == Figure::Member(&Metrics::permanent_contact_time)) {
    const double touch = figure_of_run(result.baseline(), &Metrics::initial_contact_time);
    if (std::isfinite(touch)) return "at most " + quantity(settling_goal * touch, figure.unit, 4);
  }
  const bool wanted = target->has_own_cost && figure_of(target->value).member == figure.member && std::isfinite(step);
  return wanted ? "below " + quantity(step, figure.unit, 4) : "";
}

DriveScale drive_scale(std::string_view drive) {
  if (drive == dispersion_drive) return {.name = "Force factor", .unit = "", .rest = 1};
  return {.name = "Voltage", .unit = "V", .rest = 0};
}

DriveLimits drive_limits(const ClosingRecord& result, const std::string& drive) {
  const auto found = result.scene.drivers.find(drive);
  return found == result.scene.drivers.end() ? DriveLimits{} : found->second;
}

const Points& waveform(const RunRecord& run, const std::string& drive) {
  static const Points none;
  const auto found = run.waveforms.find(drive);
  return found == run.waveforms.end() ? none : found->second;
}

double DriveDemand::peak() const { return std::max(std::abs(lowest), std::abs(highest)); }

DriveDemand drive_demand(const Points& waveform, double rest) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  DriveDemand demand{.lowest = infinity, .highest = -infinity};
  double time = 0, level = rest;
  for (const auto& [next, to] : waveform) {
    if (!std::isfinite(next) || !std::isfinite(to)) continue;
    if (to != level) demand.slew = std::max(demand.slew, next > time ? std::abs(to - level) / (next - time) : infinity);
    demand.lowest = std::min(demand.lowest, to);
    demand.highest = std::max(demand.highest, to);
    time = next;
    level = to;
  }
  if (demand.lowest > demand.highest) demand.lowest = demand.highest = demand.slew = std::numeric_limits<double>::quiet_NaN();
  return demand;
}

}  // namespace softland::internal
