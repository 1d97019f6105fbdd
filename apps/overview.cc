#include "apps/overview.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "apps/stores.h"
#include "base/printable.h"
#include "base/shortened.h"
#include "document/document.h"
#include "document/quantity.h"
#include "document/text.h"
#include "objectives/figures.h"

namespace softland::apps {
namespace {

using internal::quantity;
using nlohmann::json;

constexpr std::string_view settled = key_of(&Metrics::settled);

}  // namespace

Overview overview_of(const StudyReader& store) {
  const std::vector<StoredColumn>& columns = store.plan().columns;
  Overview all{.by_status = store.by_status(), .first_reasons = {}, .extents = {}};
  all.extents.resize(columns.size());
  store.read([&](const StoredRow& row) {
    if (!row.reason.empty()) all.first_reasons.try_emplace(row.status, fmt::format("point {}: {}", row.point, row.reason));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double value = row.values[i];
      if (!std::isfinite(value)) continue;
      all.has_figures = all.has_figures || columns[i].kind == ColumnKind::figure;
      Overview::Extent& extent = all.extents[i];
      if (value < extent.least) extent.least = value, extent.least_at = row.point;
      if (value > extent.most) extent.most = value, extent.most_at = row.point;
    }
  });
  return all;
}

json overview_json(const StoredPlan& plan, const Overview& found) {
  json figures = json::object(), variables = json::array();
  for (std::size_t i = 0; i < plan.columns.size(); ++i) {
    const StoredColumn& column = plan.columns[i];
    if (column.kind == ColumnKind::variable) {
      variables.push_back({{"name", column.name}, {"unit", column.unit}, {"column", column.key}});
      continue;
    }
    const Overview::Extent& e = found.extents[i];
    if (!(e.least <= e.most)) continue;
    figures[column.key] = {{"least", e.least}, {"least_at", e.least_at}, {"most", e.most}, {"most_at", e.most_at}};
  }
  return {{"kind", "exploration"}, {"variables", variables}, {"figures", figures}, {"by_status", found.by_status}};
}

std::string overview_text(const StoredPlan& plan, const Overview& found) {
  std::string text;
  for (const auto& [status, count] : found.by_status) {
    text += fmt::format("  {:<20} {:>9}", status, whole(count));
    const auto reason = found.first_reasons.find(status);
    text += reason == found.first_reasons.end() ? "\n" : fmt::format("   {}\n", shortened(printable_line(reason->second), 140));
  }
  ReportTable table{.head = {"", "least", "at point", "most", "at point"}, .rows = {}};
  for (std::size_t i = 0; i < plan.columns.size(); ++i) {
    const StoredColumn& column = plan.columns[i];
    const Overview::Extent& e = found.extents[i];
    if (column.kind == ColumnKind::variable || !(e.least <= e.most)) continue;
    if (column.key == settled) continue;  // yes or no, as the outcomes above count it
    table.rows.push_back({shortened(column.name, 43), quantity(e.least, column.unit), std::to_string(e.least_at),
                          quantity(e.most, column.unit), std::to_string(e.most_at)});
  }
  return text + "\n" + internal::table_text(table);
}

}  // namespace softland::apps
