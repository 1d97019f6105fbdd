// The search within one family of waveforms, which may be one of several that share the budget of a search, its log and its
// memory.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "optimizers/problem.h"
#include "studies/search/guided_search.h"
#include "studies/search/optimize.h"
#include "studies/search/search_setting.h"

namespace softland {

/// Evaluation::problem is the number of the family.
class FamilySearch {
 public:
  /// Keeps references to setting and options.
  FamilySearch(const SearchSetting& setting, const OptimizeOptions& options,
               std::function<void(const Evaluation&)> on_evaluation);

  /// Begins with these waveforms, or with those of the family that differ least from them, before its own starts. Waveforms
  /// that it cannot begin with are skipped.
  void begin_at(const DriveWaveforms& waveforms);
  /// Begins at this point before the others.
  void begin_at_point(const std::vector<double>& x);
  /// See GuidedSearch::run.
  [[nodiscard]] OptimizerResult run(const OptimizerOptions& share, Costs costs, long more, long first_index);
  /// See GuidedSearch::best.
  [[nodiscard]] std::optional<GuidedSearch::Best> best(Costs costs) const;

  /// The point of these waveforms; none where the family cannot describe them.
  [[nodiscard]] std::optional<std::vector<double>> point(const DriveWaveforms& waveforms) const {
    return setting_.space.parameters(waveforms);
  }
  [[nodiscard]] DriveWaveforms waveforms(const Evaluation& e) const { return setting_.space.waveforms(e.x); }
  /// The scene of an evaluation, ready to run.
  [[nodiscard]] PreparedScene prepared(const Evaluation& e) const { return setting_.prepared(waveforms(e)); }
  /// The parameters by drive.name.
  [[nodiscard]] std::map<std::string, double> named(const Evaluation& e) const;
  /// See GuidedSearch::surest_below; `others` may be of other families, too.
  [[nodiscard]] std::optional<Evaluation> surest_below(double own, const std::vector<Evaluation>& others) const;

 private:
  [[nodiscard]] LastClosing& last_of_thread() const;
  [[nodiscard]] CostGradients slopes() const;
  [[nodiscard]] Evaluation numbered(Evaluation e) const;

  const SearchSetting& setting_;
  const OptimizeOptions& options_;
  mutable std::mutex last_mutex_;
  mutable std::map<std::thread::id, LastClosing> last_;
  Problem problem_;
  GuidedSearch stages_;
};

}  // namespace softland
