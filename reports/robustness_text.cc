// Table of `softland robustness` for a terminal.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "reports/box_and_chaos_report.h"
#include "reports/derivatives_report.h"
#include "reports/estimates.h"
#include "reports/quantity.h"
#include "reports/robustness_report.h"
#include "reports/robustness_words.h"
#include "reports/text.h"
#include "reports/text_table.h"

namespace softland {
namespace {

using internal::calibration_words;
using internal::error_words;
using internal::is_erring;
using internal::outside_words;
using internal::percent;
using internal::quantile_95;
using internal::quantile_text;
using internal::quantity;
using internal::share_of;
using internal::spread_words;
using internal::text_table;
using internal::TextColumn;
using internal::why_no_indices;
using internal::yield_text;

// Where the spread of the last drive comes from.
std::string sensitivity_text(const Sensitivity& sensitivity) {
  if (sensitivity.figures.empty()) return {};
  std::vector<TextColumn> columns{{.head = "Share of the variance, alone / in all", .width = 37, .is_words = true}};
  for (const FigureSensitivity& f : sensitivity.figures)
    columns.push_back({.head = std::string(figure_of(f.key).symbol), .width = 18});
  std::vector<internal::TextRow> rows;
  for (std::size_t i = 0; i < sensitivity.variables.size(); ++i) {
    rows.push_back({sensitivity.variables[i]});
    for (const FigureSensitivity& f : sensitivity.figures) {
      const auto& indices = f.estimate.indices;
      rows.back().push_back(indices ? percent(share_of(indices->first_order[i].value)) + " / " +
                                          percent(share_of(indices->total[i].value))
                                    : std::string("unknown"));
    }
  }
  std::string text = "\n" + text_table(columns, rows);
  for (const FigureSensitivity& f : sensitivity.figures) {
    if (!f.estimate.indices) text += wrapped(fmt::format("{}: {}", figure_of(f.key).symbol, why_no_indices(f.estimate))) + "\n";
  }
  return text;
}

// What each measurement is worth: the last drive with more and more known of the devices.
std::string knowledge_text(const Robustness& found) {
  if (found.by_knowledge.empty() || found.devices == 0) return {};
  const Calibration& c = found.drives.back().known.calibration();
  const std::string own = calibration_words(c);
  const std::size_t width = std::max<std::size_t>(34, internal::display_width(own) + 2);
  std::vector<internal::TextRow> rows;
  const auto row = [&](const std::string& name, const DriveRobustness& d) {
    rows.push_back({name, yield_text(d.bounce_free),
                    quantile_text(quantile_95(d, key_of(&Metrics::largest_impact_velocity)), "m/s"),
                    quantile_text(quantile_95(d, key_of(&Metrics::major_bounce_height)), "m")});
  };
  for (const DriveRobustness& d : found.by_knowledge) row(d.name, d);
  if (is_erring(c)) row(own, found.drives.back());
  return "\n" + text_table({{.head = "Known of every device", .width = width, .is_words = true},
                            {.head = "without a rebound", .width = 24},
                            {.head = "v_max, 95 % below", .width = 26},
                            {.head = "B_H, 95 % below", .width = 26}},
                           rows);
}

// The end of a name tells more of it: of a folder its own name.
std::string shown_name(const std::string& name, std::size_t columns) {
  if (internal::display_width(name) <= columns) return name;
  std::string end = name;
  while (internal::display_width(end) >= columns) {
    std::size_t first = 1;
    while (first < end.size() && (static_cast<unsigned char>(end[first]) & 0xC0U) == 0x80U) ++first;  // UTF-8
    end.erase(0, first);
  }
  return "…" + end;
}

// Drives side by side, as many as fit on a terminal, and the others below.
std::string figures_text(const Robustness& found) {
  constexpr std::size_t label = 34, screen = 130, widest = 46;
  std::size_t width = 27;
  for (const DriveRobustness& d : found.drives) width = std::max(width, std::min(widest, internal::display_width(d.name) + 2));
  const std::size_t together = (screen - label) / width;
  std::string text;
  for (std::size_t first = 0; first < found.drives.size(); first += together) {
    const std::size_t last = std::min(first + together, found.drives.size());
    std::vector<TextColumn> columns{{.width = label, .is_words = true}};
    for (std::size_t d = first; d < last; ++d)
      columns.push_back({.head = shown_name(found.drives[d].name, width - 2), .width = width});
    std::vector<internal::TextRow> rows;
    const auto row = [&](std::string_view name, const auto& cell) {
      rows.push_back({std::string(name)});
      for (std::size_t d = first; d < last; ++d) rows.back().push_back(cell(found.drives[d]));
    };
    row("devices that close", [](const DriveRobustness& d) { return yield_text(d.closing); });
    if (internal::some_collapse(found))
      row("pulled onto the electrode", [](const DriveRobustness& d) { return yield_text(d.collapsed); });
    row("without a rebound", [](const DriveRobustness& d) { return yield_text(d.bounce_free); });
    for (const Figure& f : device_figures) {
      if (!internal::is_had(found, f)) continue;
      const bool has_symbol = !f.symbol.empty() && f.symbol.find(' ') == std::string_view::npos;
      rows.push_back({fmt::format("{}{}{}", f.name, has_symbol ? ", " : "", has_symbol ? f.symbol : "")});
      for (const std::size_t q : {std::size_t{1}, std::size_t{2}}) {
        row(q == 1 ? "  median" : fmt::format("  {:.0f} % of devices below", 100 * robustness_quantiles[q]),
            [&](const DriveRobustness& d) { return quantile_text(d.figures[f].quantiles[q], f.unit); });
      }
    }
    text += (first > 0 ? "\n" : "") + text_table(columns, rows);
  }
  return text;
}

}  // namespace

std::string robustness_text(const RobustnessReport& report) {
  const auto& [nominal, found, options, command, sensitivity, derivatives, courses, ways, windows, interrupted] = report;
  std::string text;
  if (found.interrupted) text += "Interrupted: these are not all devices.\n\n";
  const Calibration& calibration = found.drives.empty() ? Calibration{} : found.drives.back().known.calibration();
  text += wrapped(fmt::format("{} devices of the spread: {}. {}{}", found.devices, spread_words(nominal.scene.spread),
                              calibration.is_empty()
                                  ? "All have the volts that were designed for the nominal device."
                                  : "The plain step has the volts of the nominal device, every other drive the units of each "
                                    "device, known of it: " +
                                        calibration_words(calibration) + ".",
                              error_words(nominal.scene.spread)) +
                  internal::outside_words(found)) +
          "\n\n";
  if (found.devices == 0) return text;
  text += figures_text(found);
  if (const std::string words = internal::window_words(windows); !words.empty()) text += "\n" + wrapped(words) + "\n";
  text += knowledge_text(found) + sensitivity_text(sensitivity) + internal::derivatives_text(derivatives, found.drives.back());
  if (ways) text += internal::other_ways_text(*ways, found.drives.back(), nominal);
  text += "\n" +
          wrapped(fmt::format("In brackets: 95 % confidence. Seed {}, {} points, window {}, integrator tolerance {}. {}",
                              options.seed, name_of(point_sets, options.points), quantity(found.duration, "s", 4),
                              internal::scientific(found.tolerance), internal::worst_words)) +
          "\n";
  for (const std::string& warning : nominal.scene.warnings) text += "\n" + wrapped("warning: " + warning) + "\n";
  return text;
}

}  // namespace softland
