#include "apps/search_folder.h"

#include <fmt/format.h>

#include <system_error>

#include "base/require.h"
#include "reports/files.h"

namespace softland::apps {

SearchFolder::SearchFolder(std::filesystem::path folder, std::vector<std::string> variables)
    : folder_(std::move(folder)), variables_(std::move(variables)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  require(!error, fmt::format("--out {}: the folder cannot be created: {}", folder_.string(), error.message()));
  // What an earlier search left must not pass for this one's.
  for (const char* name : {"best.toml", "best.csv", "result.json", "report.html", "gap.svg", "trajectory.csv", "evaluations.csv"})
    std::filesystem::remove(folder_ / name, error);
  flush();
}

void SearchFolder::evaluated(const Evaluation& evaluation) {
  evaluations_[evaluation.index] = evaluation;
  if (pending_ && std::chrono::steady_clock::now() - written_ > std::chrono::seconds(1)) flush();
}

void SearchFolder::improved(const SceneFile& best) {
  best_ = best.text();
  pending_ = true;
  if (std::chrono::steady_clock::now() - written_ > std::chrono::seconds(1)) flush();
}

void SearchFolder::flush() {
  if (!best_.empty()) write_whole(folder_ / "best.toml", best_);
  std::string log = "index,cost";
  for (const std::string& name : variables_) log += "," + name;
  log += "\n";
  for (const auto& [index, e] : evaluations_) {
    log += fmt::format("{},{}", index, e.value);
    for (const double x : e.x) log += fmt::format(",{}", x);
    log += "\n";
  }
  write_whole(folder_ / "evaluations.csv", log);
  pending_ = false;
  written_ = std::chrono::steady_clock::now();
}

}  // namespace softland::apps
