// The evaluations of a search in a store, so that a search that is gone on with simulates none of them twice.
#pragma once

#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "store/study_store.h"
#include "studies/search/evaluation_memory.h"

namespace softland {

/// In the folder of a search.
inline constexpr const char* evaluations_file = "evaluations.sqlite";

/// One row per candidate that was simulated, in the order of their ends. What another plan in the store knows, a search with
/// another budget, is taken over when it is asked for.
class EvaluationStore : public EvaluationMemory {
 public:
  /// `columns`: of all families. `points`: how many evaluations the plan asks for at the most; those beyond are not kept. Throws
  /// as StudyStore does.
  EvaluationStore(const std::filesystem::path& file, const nlohmann::json& plan, std::int64_t points, std::uint64_t seed,
                  FamilyColumns columns, const StoredOrigin& origin);

  [[nodiscard]] std::optional<EvaluationValues> recall(const EvaluationKey& key) noexcept override;
  void note(const EvaluationKey& key, const EvaluationValues& values) noexcept override;

  /// How many evaluations were simulated, and how many were there already.
  [[nodiscard]] std::int64_t computed() const;
  [[nodiscard]] std::int64_t recalled() const;
  /// Throws what kept it from keeping an evaluation.
  void check();
  /// Waits until all evaluations are durable, and lets the file go. Throws as check() does.
  void close();

 private:
  void add(const ContentKey& content, const EvaluationKey& key, std::vector<double> x, const EvaluationValues& values);

  FamilyColumns columns_;
  StudyStore store_;
  std::int64_t points_;
  mutable std::mutex mutex_;
  std::map<ContentKey, EvaluationValues> known_;  // of this plan
  std::int64_t next_ = 0, computed_ = 0, recalled_ = 0;
  std::exception_ptr failure_;
};

}  // namespace softland
