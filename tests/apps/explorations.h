// Fixture for quick explorations and the contents of their stores.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "program.h"
#include "store/study_store.h"

namespace softland::test {

using nlohmann::json;

/// Options for quick closings: few modes, a loose accuracy, a short window, and voltages that need no pull-in voltage.
inline const std::vector<std::string> quick{"--set",  "structure.modes=2",       "--set", "simulate.accuracy=1e-3",
                                            "--set",  "simulate.duration=80 us", "--set", "driver.main.max_voltage=40 V",
                                            "--quiet"};
inline const std::string levels = "waveform.main.level=20 V:24 V:";

inline std::vector<std::string> explore(std::vector<std::string> words) {
  words.insert(words.begin(), {"explore", "gold.toml"});
  words.insert(words.end(), quick.begin(), quick.end());
  return words;
}

inline std::vector<StoredRow> rows_of(const fs::path& store) {
  std::vector<StoredRow> rows;
  StudyReader(store).read([&](const StoredRow& row) { rows.push_back(row); });
  return rows;
}

inline void expect_same_rows(const std::vector<StoredRow>& a, const std::vector<StoredRow>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].point, b[i].point);
    EXPECT_EQ(a[i].content, b[i].content) << a[i].point;
    EXPECT_EQ(a[i].status, b[i].status) << a[i].point;
    EXPECT_EQ(a[i].reason, b[i].reason) << a[i].point;
    EXPECT_EQ(a[i].extra, b[i].extra) << a[i].point;
    ASSERT_EQ(a[i].values.size(), b[i].values.size());
    for (std::size_t n = 0; n < a[i].values.size(); ++n) {
      if (std::isnan(a[i].values[n]) && std::isnan(b[i].values[n])) continue;
      EXPECT_EQ(std::bit_cast<std::uint64_t>(a[i].values[n]), std::bit_cast<std::uint64_t>(b[i].values[n])) << a[i].point;
    }
  }
}

class Explore : public testing::Test {
 protected:
  json done(const std::vector<std::string>& words) const {
    std::vector<std::string> with_json = words;
    with_json.insert(with_json.end(), {"--json", "-"});
    const Outcome o = here.run(with_json);
    EXPECT_EQ(o.status, 0) << o.err;
    return json::parse(o.out, nullptr, false);
  }
  [[nodiscard]] fs::path at(const std::string& name) const { return here.path() / name; }
  /// Expects the row of a point to have the figures that `simulate` gives for the scene of the point.
  void expect_simulated(const std::string& store, std::int64_t point) const {
    const Outcome scene = here.run({"explore", store, "--point", std::to_string(point), "--out", "point.toml", "--quiet"});
    ASSERT_EQ(scene.status, 0) << scene.err;
    const Outcome o = here.run({"simulate", "point.toml", "--json", "-", "--quiet"});
    const json metrics = json::parse(o.out, nullptr, false)["metrics"];
    const StudyReader reader(at(store));
    const std::vector<StoredColumn>& columns = reader.plan().columns;
    const std::vector<StoredRow> rows = rows_of(at(store));
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const StoredRow& r) { return r.point == point; });
    ASSERT_NE(row, rows.end());
    std::size_t compared = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].kind != ColumnKind::figure || !metrics.contains(columns[i].key)) continue;
      const json& value = metrics[columns[i].key];
      ++compared;
      if (value.is_null()) {
        EXPECT_TRUE(std::isnan(row->values[i])) << columns[i].key;
      } else {
        EXPECT_EQ(value.is_boolean() ? static_cast<double>(value.get<bool>()) : value.get<double>(), row->values[i])
            << columns[i].key;
      }
    }
    EXPECT_EQ(compared, metrics.size());
  }
  Workplace here;
};

}  // namespace softland::test
