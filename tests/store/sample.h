// Stores of synthetic studies.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "store/study_store.h"
#include "tests/support/temporary_folder.h"

namespace softland::test {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

[[nodiscard]] inline StoredPlan plan_of(std::int64_t points, Shard shard = {}) {
  return {.text = fmt::format("grid of {} points", points),
          .points = points,
          .columns = {{.key = "gap_contact_m", .name = "gap.contact", .unit = "m", .kind = ColumnKind::variable},
                      {.key = "impact_velocity_m_s", .name = "Impact velocity", .unit = "m/s"},
                      {.key = "bounce_count", .name = "Rebounds", .unit = ""},
                      {.key = "bounce_time_s", .name = "Bounce time", .unit = "s"}},
          .seed = 7,
          .shard = shard};
}

[[nodiscard]] inline StoredOrigin origin() {
  return {.program = "softland 0.1.0", .processor = "some, AVX2", .command = "softland explore a.toml"};
}

/// Returns the row of a point at position `at` of a grid. Every figure is a function of `at`.
[[nodiscard]] inline StoredRow row_of(std::int64_t point, double at) {
  const double gap = 1e-6 * (1 + at);
  const bool closes = std::fmod(at * 1000, 7) < 6;
  return {.point = point,
          .content = content_key(fmt::format("contact gap {} m", gap)),
          .status = closes ? "done" : "no_contact",
          .reason = closes ? "" : "the tip stays above, \"open\"",
          .values = {gap, closes ? std::sin(at + 1) / 3 : unknown, closes ? std::floor(40 * at) : unknown,
                     closes ? 1e-5 * std::exp(-at) : unknown},
          .extra = closes ? "" : "{}"};
}
[[nodiscard]] inline StoredRow row_of(std::int64_t point) { return row_of(point, static_cast<double>(point) / 1024); }

[[nodiscard]] inline std::vector<StoredRow> rows_in(const std::filesystem::path& path, const std::string& where = "") {
  std::vector<StoredRow> rows;
  StudyReader(path).read([&](const StoredRow& row) { rows.push_back(row); }, {.where = where});
  return rows;
}

/// Returns every bit of the rows as text for comparison.
[[nodiscard]] inline std::string dump(const std::vector<StoredRow>& rows) {
  std::string text;
  for (const StoredRow& row : rows) {
    text += fmt::format("{} {} {} {} {}", row.point, row.content.hexadecimal(), row.status, row.reason, row.extra);
    for (const double value : row.values) text += fmt::format(" {:a}", value);
    text += '\n';
  }
  return text;
}
[[nodiscard]] inline std::string dump(const std::filesystem::path& path) { return dump(rows_in(path)); }

/// Writes and closes a store with these points.
inline void make_store(const std::filesystem::path& path, std::int64_t points, Shard shard = {}) {
  StudyStore store(path, plan_of(points, shard), origin(), StudyStore::Opening::fresh);
  for (std::int64_t point = 0; point < points; ++point) {
    if (shard.contains(point)) store.add(row_of(point));
  }
  store.close();
}

/// A test with a store in its own folder.
struct WithStore : ::testing::Test, TemporaryFolder {
  std::filesystem::path file = path("study.sqlite");
};

[[nodiscard]] inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace softland::test
