// An overview of a database file of a study: the number of points (computed scenes) by status, and the smallest and largest
// value of every figure of merit.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "store/study_store.h"

namespace softland::apps {

struct Overview {
  struct Extent {
    double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
    std::int64_t least_at = 0, most_at = 0;
  };
  std::map<std::string, std::int64_t> by_status;
  std::map<std::string, std::string> first_reasons;  // message of the first failed point of each status
  std::vector<Extent> extents;  // extremes of every figure of merit, in the order of the columns of the database file
  bool has_figures = false;
};

[[nodiscard]] Overview overview_of(const StudyReader& store);
[[nodiscard]] nlohmann::json overview_json(const StoredPlan& plan, const Overview& found);
[[nodiscard]] std::string overview_text(const StoredPlan& plan, const Overview& found);

}  // namespace softland::apps
