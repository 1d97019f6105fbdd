#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "document/escape.h"
#include "document/quantity.h"
#include "reports/tuning_lines.h"
#include "reports/tuning_report.h"

namespace softland {
namespace {

using internal::escaped;
using internal::quantity;
using internal::share_text;

std::string bounces_prose(int count) {
  return count == 0 ? "without a bounce" : count == 1 ? "with one bounce" : fmt::format("with {} bounces", count);
}

// Describes the contact record of a closing: "touched at 41.2 µs with 3 bounces".
std::string record_prose(const ContactRecord& record) {
  if (!record.error.empty()) return "gave no record: " + record.error;
  const std::optional<double> touch = first_touch(record);
  if (!touch) return "stayed open";
  const std::optional<int> count = bounce_count(record);
  return fmt::format("touched at {}{}", quantity(*touch, "s", 4), count ? " " + bounces_prose(*count) : "");
}

// Returns a range of times as text: "41.0 to 41.4 µs".
std::string range_prose(double low, double high) {
  if (!std::isfinite(low) || !std::isfinite(high)) return "—";
  const std::string from = quantity(low, "s", 4), to = quantity(high, "s", 4);
  const std::size_t space = from.find("\u00a0");
  const bool same_unit = space != std::string::npos && to.ends_with(from.substr(space));
  return fmt::format("{} to {}", same_unit ? from.substr(0, space) : from, to);
}

std::string rebound_prose(const PredictedRecord& p) {
  if (!std::isfinite(p.rebound_high)) return "rebounds unknown";
  return p.rebound_high > 0 ? fmt::format("95th percentile of the rebound {}", quantity(p.rebound_high, "m", 2)) : "no rebound";
}

std::string expected_prose(const PredictedRecord& p) {
  return fmt::format("touch at {}, {}", range_prose(p.touch_low, p.touch_high), rebound_prose(p));
}

std::size_t learned(const TuningReport& report) {
  return static_cast<std::size_t>(
      std::count_if(report.closings.begin(), report.closings.end(), [](const auto& one) { return one.record.error.empty(); }));
}

std::string closings_prose(std::size_t count) { return count == 1 ? "one closing" : fmt::format("{} closings", count); }

std::pair<std::string, std::string> headline_of(const TuningReport& report) {
  const std::string after = closings_prose(learned(report));
  const bool is_slow = report.approach == Approach::quasi_static;
  if (report.closings.empty()) return {"No closing yet.", ""};
  if (report.bounce_free_in_a_row > 0) {
    const std::string row =
        report.bounce_free_in_a_row == 1 ? "once so far" : fmt::format("{} times in a row", report.bounce_free_in_a_row);
    return {fmt::format("After {} the switch closes bounce-free", after),
            fmt::format(
                ", {}. With the best waveform so far it {}touches at {}; with a plain step the nominal design touches at {}{}.",
                row, is_slow ? "moves slowly through stable equilibria and " : "",
                quantity(report.kept.predicted.touch_median, "s"), quantity(report.step_closing_time, "s"),
                is_slow ? fmt::format(" and bounces until {}", quantity(report.step_permanent_contact, "s")) : "")};
  }
  if (report.ever_bounce_free())
    return {fmt::format("After {} the last one bounced", after), ", but an earlier one was bounce-free."};
  return {fmt::format("After {} none was bounce-free.", after), ""};
}

// The functions from here to keys_of() make the sections and drawings of the web page.

// Width of the drawing of a contact's closed times as bars; a page scales the drawing.
constexpr double strip_width = 1000;

std::string bar(double from, double to, double top, double height, const char* what) {
  constexpr double least = 2;  // least width at which a bar is visible
  const double begin = std::clamp(from, 0.0, strip_width), end = std::clamp(std::max(to, from + least), 0.0, strip_width);
  if (!(end > begin)) return {};
  return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" class=\"{}\"/>", begin, top, end - begin,
                     height, what);
}

std::string strip(const std::string& bars, const std::string& words) {
  return fmt::format(
      "<svg class=\"strip\" viewBox=\"0 0 {} 24\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{}\">{}</svg>",
      strip_width, escaped(words), bars);
}

// Draws the estimate (belief) of a quantity of the tuned device as a bar from -2 to +2 standard deviations, on an axis from -3
// to +3 standard deviations before the tuning.
std::string belief_bar(const BelievedQuantity& q) {
  constexpr double shown = 3, drawn = 2;
  const auto place = [&](double value) { return strip_width * (0.5 + (value - q.prior_mean) / (2 * shown * q.prior_deviation)); };
  return strip(
      bar(place(q.prior_mean - drawn * q.prior_deviation), place(q.prior_mean + drawn * q.prior_deviation), 8, 8, "expected") +
          bar(place(q.mean - drawn * q.deviation), place(q.mean + drawn * q.deviation), 4, 16, "seen"),
      fmt::format("{}: now {}, before {}", q.name, q.mean, q.prior_mean));
}

// Formats the estimate (belief) of a quantity of the tuned device; a factor as the change of the value in the scene.
std::string believed_text(double mean, double deviation, const BelievedQuantity& q) {
  if (!q.unit.empty()) return fmt::format("{} ± {}", quantity(mean, q.unit), quantity(deviation, q.unit, 2));
  return fmt::format("{} ± {}\u00a0%", internal::relative_change(mean - 1), internal::plain_number(100 * deviation, 2));
}

ReportSection belief_section(const BeliefSummary& belief) {
  ReportTable table{.head = {"Quantity", "Before", "Now", ""}, .rows = {}};
  std::vector<BelievedQuantity> shown = belief.quantities;
  if (belief.gap_ratio) shown.push_back(*belief.gap_ratio);
  for (const BelievedQuantity& q : shown)
    table.rows.push_back({q.name,
                          believed_text(q.prior_mean, q.prior_deviation, q),
                          {believed_text(q.mean, q.deviation, q), "own"},
                          drawn_cell(belief_bar(q), "picture")});
  ReportSection section{
      .id = "belief",
      .heading = "Estimated quantities of the device",
      .parts = {std::move(table),
                Paragraph{.text = "Deviations from the values of the scene, with one standard deviation. The bars have two "
                                  "standard deviations to either side, before the tuning (grey) and now. The errors are "
                                  "correlated: a landing may be predicted far better than any single quantity.",
                          .is_note = true}},
      .shown = ShownIn::page};
  for (const std::string& sentence : belief.correlated) section.parts.emplace_back(Paragraph{.text = sentence, .is_note = true});
  return section;
}

// The time range of all pictures of a tuning's contact records [s].
struct Shown {
  double from = std::numeric_limits<double>::infinity(), to = 0;
  void take(double time) {
    if (!std::isfinite(time)) return;
    from = std::min(from, time), to = std::max(to, time);
  }
  [[nodiscard]] double place(double time) const { return strip_width * (time - from) / (to - from); }
};

void take(Shown& shown, const PredictedRecord& p) {
  for (const double time : {p.touch_low, p.touch_high}) shown.take(time);
}

// Returns a time range that covers the touches of the contact and some time after them, from closing number `first` on; the
// touches predicted for an early shot may last much longer.
Shown shown_times(const TuningReport& report, std::size_t first) {
  // Ratio of the begin of the shown time to the first touch, and of its end to the last touch.
  constexpr double before = 0.8, after = 1.6;
  Shown touches;
  take(touches, report.next.predicted);
  for (std::size_t i = first; i < report.closings.size(); ++i) {
    if (const std::optional<double> touch = first_touch(report.closings[i].record)) touches.take(*touch);
  }
  if (!(touches.to > 0)) return {.from = 0, .to = 1};
  return {.from = before * touches.from, .to = after * touches.to};
}

std::string expected_bar(const PredictedRecord& p, const Shown& shown) {
  if (!std::isfinite(p.touch_low) || !std::isfinite(p.touch_high)) return {};
  return bar(shown.place(p.touch_low), shown.place(p.touch_high), 1, 22, "expected");
}

// Draws the contact record of a closing: a thick bar while the contact is closed.
std::string record_bars(const ContactRecord& record, const Shown& shown) {
  std::string bars;
  double closed_since = std::numeric_limits<double>::quiet_NaN();
  for (const ContactEdge& edge : record.edges) {
    if (edge.closed) {
      closed_since = edge.time;
    } else {
      bars += bar(shown.place(closed_since), shown.place(edge.time), 7, 10, "seen");
      closed_since = std::numeric_limits<double>::quiet_NaN();
    }
  }
  if (std::isfinite(closed_since)) bars += bar(shown.place(closed_since), strip_width, 7, 10, "seen");
  // A measured closing time without further times gives no information about the contact after the closing.
  if (record.edges.empty() && record.closing_time) bars += bar(shown.place(*record.closing_time), 0, 3, 18, "seen");
  return bars;
}

TableRow record_row(const TuningReport::Closing& one, const Shown& shown) {
  const std::optional<double> touch = first_touch(one.record);
  const std::optional<int> count = bounce_count(one.record);
  const std::string bounces = !one.record.error.empty() ? "no record"
                              : !touch                  ? "stayed open"
                              : count                   ? fmt::format("{}", *count)
                                                        : "?";
  return {fmt::format("{}", one.shot.number),
          range_prose(one.shot.predicted.touch_low, one.shot.predicted.touch_high),
          {touch ? quantity(*touch, "s", 4) : "—", "own"},
          bounces,
          drawn_cell(strip(expected_bar(one.shot.predicted, shown) + record_bars(one.record, shown),
                           "closing " + std::to_string(one.shot.number) + " " + record_prose(one.record)),
                     "picture")};
}

// Describes the delay between the voltages and the contact records; empty if the delay may be 0.
std::string delay_prose(const BeliefSummary& belief) {
  constexpr double certain = 2;  // least delay that is described, in its standard errors
  const auto delay = std::find_if(belief.quantities.begin(), belief.quantities.end(),
                                  [](const BelievedQuantity& one) { return one.name == trigger_delay_name; });
  if (delay == belief.quantities.end() || !(std::abs(delay->mean) > certain * delay->deviation)) return {};
  return fmt::format(
      "The records begin {} {} the drives, with a standard error of {}: the trigger is {}. Touch times are as recorded.",
      quantity(std::abs(delay->mean), "s", 2), delay->mean > 0 ? "after" : "before", quantity(delay->deviation, "s", 2),
      delay->mean > 0 ? "late" : "early");
}

ReportSection records_section(const TuningReport& report) {
  constexpr std::size_t most = 24;
  const std::size_t first = report.closings.size() > most ? report.closings.size() - most : 0;
  const Shown shown = shown_times(report, first);
  ReportTable table{.head = {"Closing", "Predicted touch", "Touch", "Bounces", ""}, .rows = {}};
  for (std::size_t i = first; i < report.closings.size(); ++i) table.rows.push_back(record_row(report.closings[i], shown));
  table.rows.push_back({fmt::format("{}, next", report.next.number),
                        range_prose(report.next.predicted.touch_low, report.next.predicted.touch_high), "", "",
                        drawn_cell(strip(expected_bar(report.next.predicted, shown), "the next closing"), "picture")});
  return {
      .id = "records",
      .heading = "Closings and their predictions",
      .parts = {std::move(table),
                drawing_of(fmt::format("<p class=\"below\">Grey: predicted time of the touch, with 95 % confidence. Blue: the "
                                       "contact was closed. The bars span {}.</p>\n",
                                       escaped(range_prose(shown.from, shown.to)))),
                Paragraph{.text = delay_prose(report.belief), .is_note = true},
                Paragraph{.text = first > 0 ? fmt::format("The first {} closings are not shown.", first) : "", .is_note = true},
                Paragraph{.text = "Prediction for the best waveform so far: " + expected_prose(report.kept.predicted) + ".",
                          .is_note = true}}};
}

internal::Picture picture_of(const TuningReport& report) {
  internal::Picture drawn;
  const auto &kept = report.kept.waveforms, &next = report.next.waveforms;
  const bool differ = kept != next;
  const double hold = 0.25;  // drawn length of the hold level, as a share of the time before it
  for (const auto& [name, rows] : kept) {
    internal::Chart chart{.id = "drive-" + std::to_string(drawn.charts.size()),
                          .title = kept.size() == 1 ? "Voltage" : "Voltage of " + name,
                          .caption = "The waveform is piecewise linear; its last voltage is held.",
                          .x_column = "time_s",
                          .x_label = "Time",
                          .x_unit = "s",
                          .y_label = "Voltage",
                          .y_unit = "V",
                          .zero_line = true,
                          .group = "drives",
                          .height = 220};
    double last = 0;
    for (const auto* shot : {&kept, &next}) {
      for (const auto& [drive, points] : *shot) last = std::max(last, points.back()[0]);
    }
    const double end = last > 0 ? (1 + hold) * last : 1e-6;
    const auto add = [&](const Points& points, const char* label, internal::Role role) {
      internal::CurveTable& table = drawn.tables[fmt::format("{}-{}", chart.id, chart.series.size())];
      for (const auto& [time, voltage] : points) {
        table["time_s"].push_back(time);
        table["volts"].push_back(voltage);
      }
      table["time_s"].push_back(end);
      table["volts"].push_back(points.back()[1]);
      chart.series.push_back(
          {.table = fmt::format("{}-{}", chart.id, chart.series.size()), .column = "volts", .label = label, .role = role});
    };
    if (differ) add(next.at(name), "proposed next", internal::Role::baseline);
    add(rows, differ ? "best so far" : "best so far, and proposed next", internal::Role::best);
    chart.x_whole = chart.x_home = {0, end};
    drawn.charts.push_back(std::move(chart));
  }
  return drawn;
}

std::vector<KeyNumber> keys_of(const TuningReport& report) {
  const PredictedRecord& p = report.kept.predicted;
  const std::string bounces = share_text(p.bounces);
  return {{.name = "Closings",
           .value = fmt::format("{}", learned(report)),
           .change = report.bounce_free_in_a_row > 0 ? fmt::format("the last {} bounce-free", report.bounce_free_in_a_row)
                                                     : "the last one bounced"},
          {.name = "Predicted touch",
           .value = quantity(p.touch_median, "s"),
           .change = fmt::format("plain step on the nominal design {}", quantity(report.step_closing_time, "s"))},
          {.name = "Predicted rebound, 95th percentile",
           .value = p.rebound_high == 0 ? "none" : quantity(p.rebound_high, "m", 2),
           .change = p.rebound_high == 0
                         ? "by the present estimate"
                         : fmt::format("median {}", internal::quantity_beside(p.rebound_median, p.rebound_high, "m", 2))},
          {.name = "Probability of a bounce", .value = bounces, .change = "over the devices that agree with the records"}};
}

}  // namespace

std::string closing_prose(const TuningReport& report) {
  const TuningReport::Closing& last = report.closings.back();
  return fmt::format("closing {} {}; prediction for the next: {}", last.shot.number, record_prose(last.record),
                     expected_prose(report.next.predicted));
}

Document tuning_document(const TuningReport& report) {
  Document document{.title = title_of(report.origin),
                    .origin = "tune",
                    .doubt = report.broken_assumption.value_or(""),
                    .keys = keys_of(report),
                    .sections = {records_section(report), belief_section(report.belief)},
                    .draw = [&report] { return picture_of(report); },
                    .made = made_again(report.origin, report.seed, report.tolerance)};
  std::tie(document.headline, document.headline_rest) = headline_of(report);
  if (report.end == TuningEnd::interrupted) document.headline = "Interrupted: the results are incomplete. " + document.headline;
  document.sections.push_back(
      {.id = "waveforms", .heading = "Commanded voltage", .parts = {internal::all_charts()}, .shown = ShownIn::page});
  return document;
}

}  // namespace softland
