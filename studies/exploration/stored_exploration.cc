#include "studies/exploration/stored_exploration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/require.h"

namespace softland {

StoredPlan stored_plan(const Exploration& exploration, const Shard& shard) {
  const Plan& plan = exploration.plan();
  StoredPlan stored{.text = plan.text(),
                    .points = static_cast<std::int64_t>(plan.points()),
                    .columns = {},
                    .seed = plan.seed(),
                    .shard = shard};
  for (const PlanVariable& v : plan.variables())
    stored.columns.push_back(
        {.key = column_key(v.name, v.unit()), .name = v.name, .unit = v.unit(), .kind = ColumnKind::variable});
  for (const PointFigure& f : exploration.figures())
    stored.columns.push_back({.key = column_key(f.quantity, f.unit), .name = f.name, .unit = f.unit, .kind = ColumnKind::figure});
  return stored;
}

Exploration exploration_for(Plan plan, const std::filesystem::path& store, const Progress& progress, const OtherStudies& others) {
  std::vector<PointFigure> columns;
  if (is_store(store)) {
    const StoredPlan held = StudyReader(store).plan();
    for (const StoredColumn& column : held.text == plan.text() ? held.columns : std::vector<StoredColumn>()) {
      if (column.kind == ColumnKind::figure)
        columns.push_back({.quantity = column.name, .name = column.name, .unit = column.unit});
    }
  }
  return Exploration(std::move(plan), progress, others, std::move(columns));
}

void require_part(const Exploration& exploration, const Shard& shard) {
  const std::uint64_t points = exploration.plan().points();
  require_field(static_cast<std::uint64_t>(shard.count) <= points, "shard", fmt::format("{}/{}", shard.index, shard.count),
                [&] { return fmt::format("a study of {} points has at most {} parts", points, points); });
  require_request(shard.count == 1 || !exploration.plan().is_search(), [] {
    return fmt::format("{}: a search for a front cannot be divided, since each point depends on those before; {} makes it faster",
                       requested("shard"), requested("jobs"));
  });
}

PlanRequest exploration_in(const StudyReader& store) {
  const std::string& text = store.plan().text;
  require(!text.starts_with('{'), [&] {
    return fmt::format("{}: holds a search and no exploration; softland table shows its rows", store.path().string());
  });
  return read_plan(SceneFile::parse(text, store.path().string() + " (plan)"));
}

StoredRow stored_row(std::int64_t point, const ContentKey& content, std::vector<double> values, PointRow row) {
  values.insert(values.end(), row.figures.begin(), row.figures.end());
  return {.point = point,
          .content = content,
          .status = std::move(row.status),
          .reason = std::move(row.reason),
          .values = std::move(values),
          .extra =
              row.scene.empty() ? std::string() : nlohmann::json{{"scene_toml", row.scene}, {"waveforms", row.waveforms}}.dump()};
}

KnownRows known_rows(const std::filesystem::path& store) {
  KnownRows known;
  if (!is_store(store)) return known;
  const StudyReader reader(store);
  const auto variables = std::ranges::count(reader.plan().columns, ColumnKind::variable, &StoredColumn::kind);
  reader.read(
      [&](const StoredRow& row) { known.emplace(std::vector<double>(row.values.begin(), row.values.begin() + variables), row); });
  return known;
}

}  // namespace softland
