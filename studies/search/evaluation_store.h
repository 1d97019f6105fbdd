// The evaluations of a search in a database file. A continued search does not simulate the stored evaluations again.
#pragma once

#include <cmath>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "objectives/figures.h"
#include "store/study_store.h"
#include "studies/search/evaluation_memory.h"

namespace softland {

/// A column of numbers in a table: a figure of merit or a searched parameter.
struct PointFigure {
  std::string quantity;  ///< key of the figure or parameter: "impact_velocity"
  std::string name;      ///< displayed name of the figure or parameter: "Impact velocity"
  std::string unit;      ///< SI unit of the figure or parameter; empty for a count, a share, and true or false (1 or 0)
};

/// Returns the column of a searched parameter: "main.level_1_V" gives "main.level_1" in V.
[[nodiscard]] PointFigure parameter_figure(const std::string& name);
/// Returns the column of a figure of merit, with the prefix `before` for `quantity` and the suffix `words` for `name`.
[[nodiscard]] PointFigure figure_column(const Figure& figure, const std::string& before = {}, const std::string& words = {});
/// Returns a value as a store keeps it: one that is not finite becomes Metrics::unset.
[[nodiscard]] inline double stored_value(double value) { return std::isfinite(value) ? value : Metrics::unset; }

/// Name of the database file in the folder of a search.
inline constexpr const char* evaluations_file = "evaluations.sqlite";

/// A database file with one row per simulated candidate waveform, in the order in which the simulations ended. A search with a
/// larger or smaller budget than the one before takes over the rows of the earlier search from the same file.
class EvaluationStore : public EvaluationMemory {
 public:
  /// `plan` is the stored request of the search, `columns` are the parameters of all its waveform families. The search makes at
  /// most `points` evaluations; further evaluations are not stored. Throws the exceptions of the constructor of StudyStore.
  EvaluationStore(const std::filesystem::path& file, const nlohmann::json& plan, std::int64_t points, std::uint64_t seed,
                  FamilyColumns columns, const StoredOrigin& origin);

  [[nodiscard]] std::optional<EvaluationValues> recall(const EvaluationKey& key) noexcept override;
  void note(const EvaluationKey& key, const EvaluationValues& values) noexcept override;

  /// Return the number of simulated evaluations, and the number of evaluations that were read from the file.
  [[nodiscard]] std::int64_t computed() const;
  [[nodiscard]] std::int64_t recalled() const;
  /// Rethrows the first exception, if any, that storing or reading an evaluation caused.
  void check();
  /// Waits until all evaluations are on the disk, and closes the database file. Throws the exceptions of check().
  void close();

 private:
  void add(const ContentKey& content, const EvaluationKey& key, std::vector<double> x, const EvaluationValues& values);

  FamilyColumns columns_;
  StudyStore store_;
  std::int64_t points_;
  mutable std::mutex mutex_;
  // Results of the evaluations that the database file held for the same search when it was opened, by their key.
  std::map<ContentKey, EvaluationValues> known_;
  std::int64_t next_ = 0, computed_ = 0, recalled_ = 0;
  std::exception_ptr failure_;
};

}  // namespace softland
