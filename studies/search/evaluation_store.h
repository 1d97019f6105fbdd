// The evaluations of a search in a store. A continued search simulates none of them again.
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

/// Name of the store in the folder of a search.
inline constexpr const char* evaluations_file = "evaluations.sqlite";

/// A store with one row per simulated candidate, in the order in which the simulations ended. On request it takes over the rows
/// of another plan in the store: that of the same search with another budget.
class EvaluationStore : public EvaluationMemory {
 public:
  /// `columns` are those of all waveform families. `points` is the largest number of evaluations of the plan; later ones are
  /// not kept. Throws as StudyStore does.
  EvaluationStore(const std::filesystem::path& file, const nlohmann::json& plan, std::int64_t points, std::uint64_t seed,
                  FamilyColumns columns, const StoredOrigin& origin);

  [[nodiscard]] std::optional<EvaluationValues> recall(const EvaluationKey& key) noexcept override;
  void note(const EvaluationKey& key, const EvaluationValues& values) noexcept override;

  /// Return the numbers of evaluations that were simulated, and that were read from the store.
  [[nodiscard]] std::int64_t computed() const;
  [[nodiscard]] std::int64_t recalled() const;
  /// Throws the error that an evaluation met when it was stored, if any did.
  void check();
  /// Waits until all evaluations are durable, and closes the file. Throws as check() does.
  void close();

 private:
  void add(const ContentKey& content, const EvaluationKey& key, std::vector<double> x, const EvaluationValues& values);

  FamilyColumns columns_;
  StudyStore store_;
  std::int64_t points_;
  mutable std::mutex mutex_;
  std::map<ContentKey, EvaluationValues> known_;  // evaluations of this plan that the store held at the beginning
  std::int64_t next_ = 0, computed_ = 0, recalled_ = 0;
  std::exception_ptr failure_;
};

}  // namespace softland
