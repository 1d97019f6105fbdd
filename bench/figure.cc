#include "bench/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "document/svg.h"

namespace softland {

std::string figure(const std::string& headline, const std::string& words, const std::vector<Panel>& panels, std::size_t per_row) {
  using namespace internal;
  Picture drawn;
  for (const Panel& panel : panels) {
    Chart chart;
    chart.id = fmt::format("panel-{}", drawn.charts.size());
    chart.title = panel.title;
    chart.x_column = "x";
    chart.x_label = panel.x_label;
    chart.x_unit = panel.x_unit;
    chart.y_label = panel.y_label;
    chart.y_unit = panel.y_unit;
    chart.scale = panel.scale;
    chart.height = 210;
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (const Curve& curve : panel.curves) {
      const std::string name = fmt::format("{}/{}", chart.id, chart.series.size());
      CurveTable& table = drawn.tables[name];
      for (const auto& [x, y] : curve.points) {
        if (!std::isfinite(y)) continue;
        table["x"].push_back(x);
        table["y"].push_back(y);
        first = std::min(first, x);
        last = std::max(last, x);
      }
      if (table.empty()) continue;
      chart.series.push_back({name, "y", curve.label, curve.pen});
    }
    const double margin = 0.02 * (last - first);
    chart.x_home = chart.x_whole = {first - margin, last + margin};
    drawn.charts.push_back(std::move(chart));
  }
  return svg_page(headline, words, drawn, per_row);
}

std::string markdown_table(const std::vector<std::vector<std::string>>& rows) {
  std::string out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out += fmt::format("| {} |\n", fmt::join(rows[i], " | "));
    if (i > 0) continue;
    for (std::size_t k = 0; k < rows[i].size(); ++k) out += "|---";
    out += "|\n";
  }
  return out;
}

}  // namespace softland
