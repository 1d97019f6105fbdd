#include "reports/search_log.h"

#include <fmt/format.h>

#include <utility>

#include "document/csv_cell.h"

namespace softland {

SearchLog::SearchLog(ResultFolder& folder, FamilyColumns columns) : folder_(folder), columns_(std::move(columns)) { flush(); }

void SearchLog::evaluated(const Evaluation& evaluation) {
  const std::scoped_lock lock(mutex_);
  evaluations_[evaluation.index] = evaluation;
  if (pending_ && std::chrono::steady_clock::now() - written_ > std::chrono::seconds(1)) write();
}

void SearchLog::improved(const SceneFile& best) {
  const std::scoped_lock lock(mutex_);
  best_ = best.text();
  pending_ = true;
  if (std::chrono::steady_clock::now() - written_ > std::chrono::seconds(1)) write();
}

void SearchLog::flush() {
  const std::scoped_lock lock(mutex_);
  write();
}

void SearchLog::write() {
  if (!best_.empty()) folder_.write("best.toml", best_);
  std::string log = "index,cost";
  for (const std::string& name : columns_.names()) log += "," + name;
  log += "\n";
  for (const auto& [index, e] : evaluations_) {
    log += fmt::format("{},{}", index, e.value);
    for (const double x : columns_.row(e.problem, e.x)) log += "," + internal::csv_cell(x);
    log += "\n";
  }
  folder_.write("evaluations.csv", log);
  pending_ = false;
  written_ = std::chrono::steady_clock::now();
}

}  // namespace softland
