#include "reports/figure_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "document/quantity.h"
#include "reports/closing_prose.h"
#include "studies/search/optimize.h"

namespace softland::internal {
namespace {

constexpr int figure_digits = 4;  // significant digits of a figure in tables, unless the error of the figure permits fewer

}  // namespace

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

}  // namespace softland::internal
