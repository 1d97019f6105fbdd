#include "reports/box_and_chaos_report.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "reports/escape.h"
#include "reports/json_number.h"
#include "reports/page.h"
#include "reports/quantity.h"
#include "reports/robustness_report.h"
#include "reports/text.h"
#include "reports/text_table.h"

namespace softland::internal {
namespace {

using nlohmann::json;

constexpr double predicted_well = 0.1;  // the largest part of the variance that may be missed

const FigureStatistics& sampled(const DriveRobustness& drive, std::string_view key) { return drive.figures[figure_of(key)]; }

std::string figure_text(double value, std::string_view key) {
  return std::isinf(value) ? "∞" : quantity(value, figure_of(key).unit);
}

// Other devices know better than those that taught.
double missed(const FigureChaos& chaos) { return 1 - (std::isfinite(chaos.q2_unseen) ? chaos.q2_unseen : chaos.q2); }

// Beyond all of the variance a prediction is worse than the mean, by however much.
std::string missed_share(double share) { return share >= 1 ? "all" : percent(std::max(0.0, share)); }
std::string missed_text(double q2) { return std::isfinite(q2) ? missed_share(1 - q2) : "—"; }

/// A line of the comparison: what it is, and its cell for every figure.
struct ComparedRow {
  std::string name;
  std::vector<std::string> cells;
};

std::vector<ComparedRow> compared(const BoxAndChaos& ways, const DriveRobustness& drive) {
  std::vector<ComparedRow> rows;
  const auto add = [&](const char* name, auto&& cell) {
    ComparedRow& row = rows.emplace_back(ComparedRow{.name = name, .cells = {}});
    for (std::size_t i = 0; i < ways.ranges.size(); ++i) row.cells.push_back(cell(ways.ranges[i], ways.chaos[i]));
  };
  add("Mean: sampled", [&](const FigureRange& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).mean, r.key); });
  add("  polynomial chaos", [](const FigureRange&, const FigureChaos& c) { return figure_text(c.mean, c.key); });
  add("Standard deviation: sampled",
      [&](const FigureRange& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).standard_deviation, r.key); });
  add("  polynomial chaos", [](const FigureRange&, const FigureChaos& c) { return figure_text(c.standard_deviation, c.key); });
  add("95 % of devices below: sampled",
      [&](const FigureRange& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).quantiles[2].value, r.key); });
  add("  polynomial chaos", [](const FigureRange&, const FigureChaos& c) { return figure_text(c.quantile_95, c.key); });
  add("Worst in the box: found by search",
      [](const FigureRange& r, const FigureChaos&) { return figure_text(r.most.figure, r.key); });
  add("  sampled", [](const FigureRange& r, const FigureChaos&) { return figure_text(r.of_sample.high, r.key); });
  add("Best in the box: found by search",
      [](const FigureRange& r, const FigureChaos&) { return figure_text(r.least.figure, r.key); });
  add("  sampled", [](const FigureRange& r, const FigureChaos&) { return figure_text(r.of_sample.low, r.key); });
  add("Variance that chaos misses: cross-validated", [](const FigureRange&, const FigureChaos& c) { return missed_text(c.q2); });
  add("  of devices it was not made of", [](const FigureRange&, const FigureChaos& c) { return missed_text(c.q2_unseen); });
  return rows;
}

std::string value_text(const SpreadVariable& variable, double value) {
  return variable.is_factor ? fmt::format("× {:.4f}", value) : quantity(value, variable.keys.front().unit, 5);
}

std::string box_words(const BoxAndChaos& ways, const DriveRobustness& drive) {
  return fmt::format(
      "The box: every quantity within ± {:.2f} standard deviations of the normal number beneath it, which holds {:.0f} % of all "
      "devices, and {} of the {} sampled. So its worst is not below what {:.0f} % of the devices stay below. Worst and best are "
      "what searches found in {} closings: no proof, the true range is at least as wide.",
      ways.half_width, 100 * box_share, ways.sampled_inside, drive.outcomes.size(), 100 * box_share, ways.closings);
}

/// How far chaos can be trusted. `symbol` turns a symbol into words.
template <class Symbol>
std::string chaos_words(const BoxAndChaos& ways, Symbol symbol) {
  std::vector<std::string> good, bad, none;
  for (const FigureChaos& c : ways.chaos) {
    const std::string name = symbol(figure_of(c.key).symbol);
    if (!std::isfinite(c.q2)) {
      none.push_back(name);
    } else if (missed(c) <= predicted_well) {
      good.push_back(name);
    } else {
      bad.push_back(fmt::format("{} ({} of the variance)", name, missed_share(missed(c))));
    }
  }
  std::string words = fmt::format("Polynomial chaos is made of the first {} devices of the sample, without a further closing.",
                                  ways.chaos.front().taught + ways.left_out);
  if (ways.left_out > 0) {
    words +=
        fmt::format(" {} of them do not close; mean, deviation and quantile of chaos go on to such devices as if they closed.",
                    ways.left_out);
  }
  if (!good.empty()) words += fmt::format(" It predicts {}{}.", in_words(good), ways.left_out > 0 ? " of those that close" : "");
  if (!bad.empty()) {
    words += fmt::format(
        " It fails for {}: where a small change of a quantity adds or takes away a touch, a figure jumps, and no sum of "
        "polynomials follows. There the sample is to be believed.",
        in_words(bad));
  }
  if (!none.empty())
    words += fmt::format(" It says nothing of {}: too few of these devices have it, or all the same.", in_words(none));
  return words;
}

// Of the varying quantities, as robustness_report.h shows them.
std::vector<double> shown_values_in_box(const BoxDevice& device, const PreparedScene& nominal) {
  return device.values.empty() ? device.values : DeviceDrives(nominal).shown(device.values);
}

json device_of_box_json(const BoxDevice& device, const PreparedScene& nominal) {
  json values = json::object();
  const std::vector<double> shown = shown_values_in_box(device, nominal);
  for (std::size_t i = 0; i < shown.size(); ++i) values[nominal.scene.spread.variables[i].name] = shown[i];
  json j{
      {"value", json_number(device.figure)}, {"values", std::move(values)}, {"status", to_string(device.outcome.metrics.status)}};
  if (!device.outcome.failure.empty()) j["failure"] = device.outcome.failure;
  return j;
}

}  // namespace

json other_ways_json(const BoxAndChaos& ways, const DriveRobustness& drive, const PreparedScene& nominal) {
  json ranges = json::object(), chaos = json::object();
  for (const FigureRange& r : ways.ranges) {
    ranges[std::string(r.key)] = {{"least", device_of_box_json(r.least, nominal)},
                                  {"most", device_of_box_json(r.most, nominal)},
                                  {"sampled", {json_number(r.of_sample.low), json_number(r.of_sample.high)}}};
  }
  for (const FigureChaos& c : ways.chaos) {
    chaos[std::string(c.key)] = {{"devices", c.taught},
                                 {"other_devices", c.unseen},
                                 {"degree", c.degree},
                                 {"terms", c.terms},
                                 {"q2_cross_validated", json_number(c.q2)},
                                 {"q2_other_devices", json_number(c.q2_unseen)},
                                 {"mean", json_number(c.mean)},
                                 {"standard_deviation", json_number(c.standard_deviation)},
                                 {"quantile_95", json_number(c.quantile_95)}};
  }
  json j{{"drive", drive.name},
         {"box",
          {{"share_of_devices", box_share},
           {"half_width_standard_deviations", json_number(ways.half_width)},
           {"sampled_devices_inside", ways.sampled_inside},
           {"closings", ways.closings},
           {"figures", std::move(ranges)}}},
         {"polynomial_chaos", std::move(chaos)}};
  if (!ways.why_none.empty()) j["why_none"] = ways.why_none;
  return j;
}

std::string other_ways_text(const BoxAndChaos& ways, const DriveRobustness& drive, const PreparedScene& nominal) {
  if (ways.ranges.empty()) return {};
  std::vector<internal::TextColumn> columns{{.head = "Other ways, under " + drive.name, .width = 47, .is_words = true}};
  for (const FigureRange& r : ways.ranges) columns.push_back({.head = std::string(figure_of(r.key).symbol), .width = 16});
  std::vector<internal::TextRow> rows;
  for (const ComparedRow& row : compared(ways, drive)) {
    rows.push_back({row.name});
    rows.back().insert(rows.back().end(), row.cells.begin(), row.cells.end());
  }
  std::string text = "\n" + text_table(columns, rows);
  for (const FigureRange& r : ways.ranges) {
    std::string values;
    const std::vector<double> shown = shown_values_in_box(r.most, nominal);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const SpreadVariable& variable = nominal.scene.spread.variables[i];
      values += fmt::format("{}{} {}", i == 0 ? "" : ", ", variable.name, value_text(variable, shown[i]));
    }
    text += wrapped(fmt::format("Worst {}: {}", figure_of(r.key).symbol, values)) + "\n";
  }
  return text + "\n" + wrapped(box_words(ways, drive)) + "\n" +
         wrapped(chaos_words(ways, [](std::string_view symbol) { return std::string(symbol); })) + "\n";
}

std::string other_ways_html(const BoxAndChaos& ways, const DriveRobustness& drive, const PreparedScene& nominal) {
  if (ways.ranges.empty()) return {};
  TableRow head{"Under " + escaped(drive.name)}, device_head{"In the box", "Found"};
  for (const FigureRange& r : ways.ranges) head.emplace_back(symbol_html(figure_of(r.key).symbol));
  std::vector<TableRow> rows, devices;
  for (const ComparedRow& row : compared(ways, drive)) {
    const bool below = row.name.starts_with("  ");
    TableRow& line = rows.emplace_back(TableRow{Cell(escaped(below ? row.name.substr(2) : row.name), below ? "part" : "")});
    for (const std::string& cell : row.cells) line.emplace_back(escaped(cell));
  }
  const std::vector<SpreadVariable>& variables = nominal.scene.spread.variables;
  for (const SpreadVariable& v : variables) device_head.emplace_back(escaped(v.name));
  for (const FigureRange& r : ways.ranges) {
    for (const auto& [name, device] : {std::pair("Worst ", &r.most), std::pair("Best ", &r.least)}) {
      TableRow& line = devices.emplace_back(
          TableRow{name + symbol_html(figure_of(r.key).symbol), escaped(figure_text(device->figure, r.key))});
      const std::vector<double> shown = shown_values_in_box(*device, nominal);
      for (std::size_t i = 0; i < shown.size(); ++i) line.emplace_back(escaped(value_text(variables[i], shown[i])));
    }
  }
  return section(
      "ways", "Other ways to the same answer",
      fmt::format("<p>{}</p>\n<p>{}</p>\n{}<h3>Worst and best devices of the box</h3>\n{}", escaped(box_words(ways, drive)),
                  chaos_words(ways, symbol_html), table_html(head, rows), table_html(device_head, devices)));
}

}  // namespace softland::internal
