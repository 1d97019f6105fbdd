#include "reports/box_and_chaos_report.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "reports/json_number.h"
#include "reports/quantity.h"
#include "reports/robustness_report.h"

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

ReportTable compared(const BoxAndChaos& ways, const DriveRobustness& drive) {
  ReportTable table{.head = {"Other ways, under " + drive.name}, .rows = {}};
  for (const FigureRange& r : ways.ranges) table.head.emplace_back(figure_of(r.key).symbol);
  const auto add = [&](TableCell name, auto&& cell) {
    TableRow& row = table.rows.emplace_back(TableRow{std::move(name)});
    for (std::size_t i = 0; i < ways.ranges.size(); ++i) row.emplace_back(cell(ways.ranges[i], ways.chaos[i]));
  };
  const auto part = [](const char* name) { return TableCell(name, "part"); };
  add("Mean: sampled", [&](const FigureRange& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).mean, r.key); });
  add(part("polynomial chaos"), [](const FigureRange&, const FigureChaos& c) { return figure_text(c.mean, c.key); });
  add("Standard deviation: sampled",
      [&](const FigureRange& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).standard_deviation, r.key); });
  add(part("polynomial chaos"),
      [](const FigureRange&, const FigureChaos& c) { return figure_text(c.standard_deviation, c.key); });
  add("95 % of devices below: sampled",
      [&](const FigureRange& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).quantiles[2].value, r.key); });
  add(part("polynomial chaos"), [](const FigureRange&, const FigureChaos& c) { return figure_text(c.quantile_95, c.key); });
  add("Worst in the box: found by search",
      [](const FigureRange& r, const FigureChaos&) { return figure_text(r.most.figure, r.key); });
  add(part("sampled"), [](const FigureRange& r, const FigureChaos&) { return figure_text(r.of_sample.high, r.key); });
  add("Best in the box: found by search",
      [](const FigureRange& r, const FigureChaos&) { return figure_text(r.least.figure, r.key); });
  add(part("sampled"), [](const FigureRange& r, const FigureChaos&) { return figure_text(r.of_sample.low, r.key); });
  add("Variance that chaos misses: cross-validated", [](const FigureRange&, const FigureChaos& c) { return missed_text(c.q2); });
  add(part("of devices it was not made of"), [](const FigureRange&, const FigureChaos& c) { return missed_text(c.q2_unseen); });
  return table;
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

/// How far chaos can be trusted.
std::string chaos_words(const BoxAndChaos& ways) {
  std::vector<std::string> good, bad, none;
  for (const FigureChaos& c : ways.chaos) {
    const std::string name(figure_of(c.key).symbol);
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

ReportSection other_ways_section(const BoxAndChaos& ways, const DriveRobustness& drive, const PreparedScene& nominal) {
  ReportSection section{.id = "ways", .heading = "Other ways to the same answer", .parts = {}};
  if (ways.ranges.empty()) return section;
  ReportTable figures = compared(ways, drive), devices{.head = {"In the box", "Found"}, .rows = {}};
  const std::vector<SpreadVariable>& variables = nominal.scene.spread.variables;
  for (const SpreadVariable& v : variables) devices.head.emplace_back(v.name);
  for (const FigureRange& r : ways.ranges) {
    for (const auto& [name, device] : {std::pair("Worst", &r.most), std::pair("Best", &r.least)}) {
      TableRow& line = devices.rows.emplace_back(
          TableRow{fmt::format("{} {}", name, figure_of(r.key).symbol), figure_text(device->figure, r.key)});
      const std::vector<double> shown = shown_values_in_box(*device, nominal);
      for (std::size_t i = 0; i < shown.size(); ++i) line.emplace_back(value_text(variables[i], shown[i]));
    }
  }
  section.parts = {Paragraph{box_words(ways, drive)}, Paragraph{chaos_words(ways)}, std::move(figures),
                   SubHeading{"Worst and best devices of the box"}, std::move(devices)};
  return section;
}

}  // namespace softland::internal
