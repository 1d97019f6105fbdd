// The search within one waveform family. Several families may share the budget, the log and the memory of one search.
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

/// Searches the waveforms of one waveform family. Evaluation::problem is the number of the family.
class FamilySearch {
 public:
  /// Keeps references to `setting` and `options`. Calls `on_evaluation` with every evaluation.
  FamilySearch(const SearchSetting& setting, const OptimizeOptions& options,
               std::function<void(const Evaluation&)> on_evaluation);

  /// Adds a starting point before the starts of the waveform family: the point of the given waveforms, or of the most similar
  /// waveforms of the family. Waveforms with which no search can begin, for example with another hold level, are skipped.
  void begin_at(const DriveWaveforms& waveforms);
  /// Adds a starting point of the search before all others: the point `x` of the waveform family's parameters.
  void begin_at_point(const std::vector<double>& x);
  /// Searches within the waveform family in one or two stages: see GuidedSearch::run().
  [[nodiscard]] OptimizerResult run(const OptimizerOptions& share, Costs costs, long more, long first_index);
  /// Returns the evaluation with the lowest guide or target cost: see GuidedSearch::best().
  [[nodiscard]] std::optional<GuidedSearch::Best> best(Costs costs) const;

  /// Returns the waveform family's parameters of the given waveforms; none if the family cannot describe them.
  [[nodiscard]] std::optional<std::vector<double>> point(const DriveWaveforms& waveforms) const {
    return setting_.space.parameters(waveforms);
  }
  [[nodiscard]] DriveWaveforms waveforms(const Evaluation& e) const { return setting_.space.waveforms(e.x); }
  /// Returns the scene with the waveforms of an evaluation, ready for simulation.
  [[nodiscard]] PreparedScene prepared(const Evaluation& e) const { return setting_.prepared(waveforms(e)); }
  /// Returns the waveform parameters of an evaluation, by drive.name.
  [[nodiscard]] std::map<std::string, double> named(const Evaluation& e) const;
  /// Returns, among the evaluations with a target cost below `own`, the one that closes without a bounce most reliably: see
  /// GuidedSearch::surest_below(). The evaluations `others`, also of other waveform families, are not returned.
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
