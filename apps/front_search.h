// A search for the front of an exploration, whose points go into a store as they are found.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <vector>

#include "apps/progress.h"
#include "optimizers/nsga2.h"
#include "reports/exploration_report.h"
#include "store/study_store.h"
#include "studies/exploration.h"

namespace softland::apps {

/// Rows that a store holds, by the values of their variables: what a search that goes on is not asked twice.
using KnownRows = std::map<std::vector<double>, StoredRow>;
[[nodiscard]] KnownRows known_rows(const std::filesystem::path& store);

/// The plan of the exploration is a search. Point k is the k-th that the search asks for; one that is in `known`, or under an
/// earlier plan in the store, is not computed again, so that a search that was interrupted ends with the rows of one that was
/// not.
class FrontSearch {
 public:
  FrontSearch(Exploration& exploration, StudyStore& store, KnownRows known, std::vector<ExploredAim> aims, int jobs, bool quiet,
              const std::atomic<bool>* stop);

  void run();
  [[nodiscard]] std::int64_t computed() const { return computed_; }
  /// Points that the plan has and the search has not asked for.
  [[nodiscard]] std::int64_t remaining() const;
  [[nodiscard]] const ParetoResult& result() const { return result_; }

 private:
  [[nodiscard]] ParetoValue value_of(const StoredRow& row) const;
  [[nodiscard]] ParetoValue evaluate(std::span<const double> place);
  [[nodiscard]] StoredRow row_at(const std::vector<double>& values);
  void evaluated(const ParetoEvaluation& evaluation);
  [[nodiscard]] std::pair<double, std::string> state(double elapsed) const;

  Exploration& exploration_;
  StudyStore& store_;
  KnownRows known_;
  std::vector<ExploredAim> aims_;
  int jobs_;
  Watch watch_;
  Bar bar_;
  std::mutex mutex_;
  std::map<std::vector<double>, StoredRow> fresh_;  // by place in the box, until their number is known
  std::int64_t computed_ = 0, asked_ = 0;
  ParetoResult result_;
};

}  // namespace softland::apps
