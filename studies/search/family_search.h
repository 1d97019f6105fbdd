// The search within one family of waveforms, which may be one of several that share the budget of a search. A point of theirs
// holds the parameters of all families, NaN but for those of its own: so one log and one memory serve them all.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "optimizers/problem.h"
#include "studies/search/guided_search.h"
#include "studies/search/optimize.h"
#include "studies/search/search_setting.h"

namespace softland {

/// The parameters of one family among those of all.
class ParameterBlock {
 public:
  ParameterBlock(std::size_t begin, std::size_t size, std::size_t all) : begin_(begin), size_(size), all_(all) {}

  /// Whether a point of all is one of this family.
  [[nodiscard]] bool holds(std::span<const double> point) const;
  /// This family's parameters of a point of all.
  [[nodiscard]] std::span<const double> own(std::span<const double> point) const { return point.subspan(begin_, size_); }
  /// The point of all that has these parameters of this family.
  [[nodiscard]] std::vector<double> point(std::span<const double> own) const;

 private:
  std::size_t begin_, size_, all_;
};

/// The memory of a search in all its families, as one of these asks it.
class MemoryOfFamily final : public EvaluationMemory {
 public:
  MemoryOfFamily(EvaluationMemory& all, const ParameterBlock& block) : all_(all), block_(block) {}

  std::optional<EvaluationValues> recall(const EvaluationKey& key) noexcept override { return all_.recall(among_all(key)); }
  void note(const EvaluationKey& key, const EvaluationValues& values) noexcept override { all_.note(among_all(key), values); }

 private:
  [[nodiscard]] EvaluationKey among_all(EvaluationKey key) const {
    key.x = block_.point(key.x);
    return key;
  }

  EvaluationMemory& all_;
  const ParameterBlock& block_;
};

/// Evaluations, points and keys of memory are told in the parameters of all families.
class FamilySearch {
 public:
  /// Keeps references to all but `on_evaluation`.
  FamilySearch(const SearchSetting& setting, const ParameterBlock& block, const OptimizeOptions& options,
               std::function<void(const Evaluation&)> on_evaluation);

  /// Begins with these waveforms, or with those of the family that differ least from them, before what it would begin with
  /// by itself. Those that it cannot begin with are passed over.
  void begin_at(const DriveWaveforms& waveforms);
  /// Begins at a point of its own before the others.
  void begin_at_point(const std::vector<double>& own);
  /// The family's own parameters of a point of all.
  [[nodiscard]] std::vector<double> own(const Evaluation& e) const;
  /// See GuidedSearch::run.
  [[nodiscard]] OptimizerResult run(const OptimizerOptions& share, Costs costs, long more, long first_index);
  /// See GuidedSearch::best.
  [[nodiscard]] std::optional<GuidedSearch::Best> best(Costs costs) const;

  [[nodiscard]] bool holds(const Evaluation& e) const { return block_.holds(e.x); }
  /// The point of these waveforms; empty where the family has none.
  [[nodiscard]] std::vector<double> point(const DriveWaveforms& waveforms) const;
  [[nodiscard]] DriveWaveforms waveforms(const Evaluation& e) const;
  /// Ready to run.
  [[nodiscard]] PreparedScene prepared(const Evaluation& e) const { return setting_.prepared(waveforms(e)); }
  /// None where a scene cannot hold the waveforms.
  [[nodiscard]] std::optional<SceneFile> scene(const Evaluation& e) const;
  /// The parameters by drive.name.
  [[nodiscard]] std::map<std::string, double> named(const Evaluation& e) const;
  /// Every evaluation, in order.
  [[nodiscard]] std::vector<Evaluation> log() const;
  /// See GuidedSearch::surest_below.
  [[nodiscard]] std::optional<Evaluation> surest_below(double own, const std::vector<std::vector<double>>& others) const;

 private:
  [[nodiscard]] SearchCosts price(std::span<const double> own) const;
  [[nodiscard]] LastClosing& last_of_thread() const;
  [[nodiscard]] PriceSlopes slopes() const;
  [[nodiscard]] Evaluation among_all(Evaluation e) const;

  const SearchSetting& setting_;
  ParameterBlock block_;
  const OptimizeOptions& options_;
  mutable std::mutex last_mutex_;
  mutable std::map<std::thread::id, LastClosing> last_;
  Problem problem_;
  GuidedSearch stages_;
};

}  // namespace softland
