// An overview of a database file of a study: the number of points by status, and the extremes of every figure.
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
  std::map<std::string, std::string> first_reasons;  // message of the first point that failed, by the status of the point
  std::vector<Extent> extents;  // smallest and largest value of every figure, by its column in the database file
  bool has_figures = false;
};

[[nodiscard]] Overview overview_of(const StudyReader& store);
[[nodiscard]] nlohmann::json overview_json(const StoredPlan& plan, const Overview& found);
[[nodiscard]] std::string overview_text(const StoredPlan& plan, const Overview& found);

}  // namespace softland::apps
