#include "reports/box_and_chaos_report.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "document/quantity.h"
#include "reports/robustness_prose.h"
#include "reports/robustness_report.h"

namespace softland::internal {
namespace {

using DriveRecord = RobustnessRecord::Drive;
using BoxAndChaosRecord = RobustnessRecord::BoxAndChaosRecord;
using RangeRecord = BoxAndChaosRecord::Range;

// Largest share of the variance of a figure of merit that polynomial chaos may leave unexplained if the report says that it
// predicts the figure.
constexpr double predicted_well = 0.1;

const FigureStatistics& sampled(const DriveRecord& drive, std::string_view key) { return drive.figures[figure_of(key)]; }

std::string figure_text(double value, std::string_view key) {
  return std::isinf(value) ? "∞" : quantity(value, figure_of(key).unit);
}

// Prefer the coefficient of determination q2 on devices that were not in the training set: the error on training devices is too
// small.
double missed(const FigureChaos& chaos) { return 1 - (std::isfinite(chaos.q2_unseen) ? chaos.q2_unseen : chaos.q2); }

// A polynomial chaos prediction that misses all of the variance or more is no better than the mean.
std::string missed_share(double share) { return share >= 1 ? "all" : percent(std::max(0.0, share)); }
std::string missed_text(double q2) { return std::isfinite(q2) ? missed_share(1 - q2) : "—"; }

ReportTable compared(const BoxAndChaosRecord& ways, const DriveRecord& drive) {
  ReportTable table{.head = {"Cross-checks, under " + with_article(drive.name)}, .rows = {}};
  for (const RangeRecord& r : ways.ranges) table.head.emplace_back(figure_of(r.key).symbol);
  const auto add = [&](TableCell name, auto&& cell) {
    TableRow& row = table.rows.emplace_back(TableRow{std::move(name)});
    for (std::size_t i = 0; i < ways.ranges.size(); ++i) row.emplace_back(cell(ways.ranges[i], ways.chaos[i]));
  };
  const auto part = [](const char* name) { return TableCell(name, "part"); };
  add("Mean: sampled", [&](const RangeRecord& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).mean, r.key); });
  add(part("polynomial chaos"), [](const RangeRecord&, const FigureChaos& c) { return figure_text(c.mean, c.key); });
  add("Standard deviation: sampled",
      [&](const RangeRecord& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).standard_deviation, r.key); });
  add(part("polynomial chaos"),
      [](const RangeRecord&, const FigureChaos& c) { return figure_text(c.standard_deviation, c.key); });
  add("95th percentile: sampled",
      [&](const RangeRecord& r, const FigureChaos&) { return figure_text(sampled(drive, r.key).quantiles[2].value, r.key); });
  add(part("polynomial chaos"), [](const RangeRecord&, const FigureChaos& c) { return figure_text(c.quantile_95, c.key); });
  add("Worst in the box: found by search",
      [](const RangeRecord& r, const FigureChaos&) { return figure_text(r.most.figure, r.key); });
  add(part("sampled"), [](const RangeRecord& r, const FigureChaos&) { return figure_text(r.of_sample.high, r.key); });
  add("Best in the box: found by search",
      [](const RangeRecord& r, const FigureChaos&) { return figure_text(r.least.figure, r.key); });
  add(part("sampled"), [](const RangeRecord& r, const FigureChaos&) { return figure_text(r.of_sample.low, r.key); });
  add("Unexplained variance: cross-validated", [](const RangeRecord&, const FigureChaos& c) { return missed_text(c.q2); });
  add(part("on devices not used in the fit"), [](const RangeRecord&, const FigureChaos& c) { return missed_text(c.q2_unseen); });
  return table;
}

std::string box_prose(const BoxAndChaosRecord& ways, std::size_t devices) {
  return fmt::format(
      "The box holds every quantity within ± {:.2f} standard deviations of its underlying normal variable. It covers {:.0f} % of "
      "all devices, and {} of the {} sampled ones. Its worst value is therefore at least the {:.0f}th percentile of the devices. "
      "Worst and best values were found by searches with {} closings; the true range is at least as wide.",
      ways.half_width, 100 * ways.share, ways.sampled_inside, devices, 100 * ways.share, ways.closings);
}

/// Returns sentences on how well polynomial chaos describes each figure of merit.
std::string chaos_prose(const BoxAndChaosRecord& ways) {
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
  std::string words = fmt::format("Polynomial chaos is fitted to the first {} devices of the sample, without a further closing.",
                                  ways.chaos.front().fitted + ways.left_out);
  if (ways.left_out > 0) {
    words +=
        fmt::format(" {} of them do not close; its mean, standard deviation and percentile treat such devices as if they closed.",
                    ways.left_out);
  }
  if (!good.empty()) words += fmt::format(" It predicts {}{}.", in_words(good), ways.left_out > 0 ? " of those that close" : "");
  if (!bad.empty()) {
    words += fmt::format(
        " It fails for {}: a figure jumps where a small change of a quantity adds or removes a touch, and polynomials cannot "
        "follow. Trust the sample there.",
        in_words(bad));
  }
  if (!none.empty())
    words += fmt::format(" It cannot describe {}: too few of these devices have the figure, or all have the same value.",
                         in_words(none));
  return words;
}

// Describes the device with the extreme value of a figure of merit in the box of varied quantities. Each quantity is given in
// its SI unit, or as the factor by which it differs from the nominal device.
BoxAndChaosRecord::InBox in_box(const BoxDevice& device, const PreparedScene& nominal) {
  BoxAndChaosRecord::InBox record{.figure = device.figure,
                                  .values = {},
                                  .status = std::string(to_string(device.outcome.metrics.status)),
                                  .failure = device.outcome.failure};
  const std::vector<double> shown = device.values.empty() ? device.values : DeviceDrives(nominal).shown(device.values);
  for (std::size_t i = 0; i < shown.size(); ++i) record.values[nominal.scene.spread.variables[i].name] = shown[i];
  return record;
}

}  // namespace

BoxAndChaosRecord record_of(const BoxAndChaos& ways, const DriveRobustness& drive, const PreparedScene& nominal) {
  BoxAndChaosRecord record{.drive = drive.name,
                           .why_none = ways.why_none,
                           .share = box_share,
                           .half_width = ways.half_width,
                           .sampled_inside = ways.sampled_inside,
                           .left_out = ways.left_out,
                           .closings = ways.closings,
                           .ranges = {},
                           .chaos = ways.chaos};
  for (const FigureRange& r : ways.ranges)
    record.ranges.push_back({r.key, in_box(r.least, nominal), in_box(r.most, nominal), r.of_sample});
  return record;
}

std::string value_text(const RobustnessRecord::Varied& variable, double value) {
  return variable.is_factor ? fmt::format("× {:.4f}", value) : quantity(value, variable.unit, 5);
}

ReportSection box_and_chaos_section(const RobustnessRecord& record) {
  const BoxAndChaosRecord& ways = *record.box_and_chaos;
  ReportSection section{.id = "ways", .heading = "Cross-checks: worst case and polynomial chaos", .parts = {}};
  if (ways.ranges.empty()) return section;
  ReportTable figures = compared(ways, record.drives.back()), devices{.head = {"In the box", "Found"}, .rows = {}};
  for (const RobustnessRecord::Varied& v : record.spread) devices.head.emplace_back(v.name);
  for (const RangeRecord& r : ways.ranges) {
    for (const auto& [name, device] : {std::pair("Worst", &r.most), std::pair("Best", &r.least)}) {
      TableRow& line = devices.rows.emplace_back(
          TableRow{fmt::format("{} {}", name, figure_of(r.key).symbol), figure_text(device->figure, r.key)});
      for (const RobustnessRecord::Varied& v : record.spread) {
        if (const auto value = device->values.find(v.name); value != device->values.end())
          line.emplace_back(value_text(v, value->second));
      }
    }
  }
  section.parts = {Paragraph{box_prose(ways, record.devices)}, Paragraph{chaos_prose(ways)}, std::move(figures),
                   SubHeading{"Worst and best devices of the box"}, std::move(devices)};
  return section;
}

}  // namespace softland::internal
