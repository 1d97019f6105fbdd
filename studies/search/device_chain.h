// A search over devices from one starting point by CMA-ES. Candidate waveforms are tried on more and more devices. A candidate
// with a higher cost on the first devices than the median of the earlier candidates is given up.
//
// Source for giving up candidates: O. Maron & A. W. Moore, "Hoeffding races", NIPS 1993 (the idea; the test here is the median
// of the earlier candidates).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "optimizers/problem.h"
#include "studies/search/evaluation_memory.h"
#include "studies/search/robust_cost.h"
#include "studies/search/search_budget.h"

namespace softland {

/// The cost of a candidate waveform over varied devices, evaluated in stages: on 8 devices, on 32, and on all requested
/// devices.
class StagedCost {
 public:
  /// Keeps references to `setting`, `cost` and `aim` (measure of risk and conditions). `memory`, which stores costs between
  /// runs, may be null. In its keys, `seed` stands for the set of devices and for the aim.
  StagedCost(const SearchSetting& setting, const RobustCost& cost, const RobustAim& aim, EvaluationMemory* memory,
             std::uint64_t seed)
      : setting_(setting), cost_(cost), aim_(aim), memory_(memory), seed_(seed) {}

  struct Tried {
    /// Cost of the candidate; infinite if its waveform exceeds a limit of a voltage source.
    double cost = std::numeric_limits<double>::infinity();
    long closings = 0;
  };
  /// Evaluates the waveform at the point `x` of the search on the first `most` devices. After each number of devices in
  /// `stages` the candidate is given up if its cost on these devices exceeds `hopeless`.
  [[nodiscard]] Tried tried(const std::vector<double>& x, std::size_t most,
                            double hopeless = std::numeric_limits<double>::infinity(), int jobs = 1) const;
  [[nodiscard]] std::vector<Variable> variables() const { return setting_.space.variables(); }

 private:
  const SearchSetting& setting_;
  const RobustCost& cost_;
  const RobustAim& aim_;
  EvaluationMemory* memory_;
  std::uint64_t seed_;
};

/// Numbers of devices after which a candidate waveform is given up if its cost is too high.
inline constexpr std::array<std::size_t, 2> stages{8, 32};

struct Chain {
  std::vector<double> start = {};
  std::size_t devices = 0;  ///< number of devices on which candidate waveforms are tried
  long closings = 0;        ///< largest number of closings that this search may simulate
  double step = 0.1;        ///< first step size of CMA-ES, as a share of the range of every variable
  double population = 1;    ///< number of candidate waveforms of a CMA-ES generation, as a multiple of the default number
  std::uint64_t seed = 1;
  int jobs = 1;  ///< number of threads for one candidate waveform; does not change the result
};
struct ChainEnd {
  std::vector<double> x = {};  ///< parameters of the best candidate waveform; empty if no candidate was feasible
  /// Cost of the best candidate waveform; infinite if no candidate was feasible.
  double cost = std::numeric_limits<double>::infinity();
  long closings = 0;
};
/// Searches a waveform by CMA-ES from one starting point until `chain.closings` closings are simulated or the budget is spent.
/// Calls `on_candidate` with every candidate waveform, after the budget has counted the candidate's closings.
[[nodiscard]] ChainEnd search_chain(const StagedCost& cost, const Chain& chain, SearchBudget& budget,
                                    const std::function<void(const std::vector<double>& x, double cost)>& on_candidate);

}  // namespace softland
