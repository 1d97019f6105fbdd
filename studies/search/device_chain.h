// A search over devices from one start by CMA-ES. Candidates are tried on ever more devices. One that does worse on the first
// of them than the median of the candidates before is given up.
//
// Source for giving up candidates: O. Maron & A. W. Moore, "Hoeffding races", NIPS 1993 (the idea; our test is the median of the
// candidates before).
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

/// The cost of a candidate on devices, found in stages: on 8, on 32, on all that are asked for.
class StagedCost {
 public:
  /// Keeps references to `setting`, `cost` and `aim`. `memory` may be null; `seed` identifies the devices and the aim in it.
  StagedCost(const SearchSetting& setting, const RobustCost& cost, const RobustAim& aim, EvaluationMemory* memory,
             std::uint64_t seed)
      : setting_(setting), cost_(cost), aim_(aim), memory_(memory), seed_(seed) {}

  struct Tried {
    double cost = std::numeric_limits<double>::infinity();  ///< infinite if a driver cannot give the waveform
    long closings = 0;
  };
  /// Evaluates on the first `most` devices, or on as many as it takes to see that the cost exceeds `hopeless`.
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

/// Numbers of devices after which a candidate may be given up.
inline constexpr std::array<std::size_t, 2> stages{8, 32};

struct Chain {
  std::vector<double> start = {};
  std::size_t devices = 0;  ///< first devices that candidates are tried on
  long closings = 0;        ///< most closings of the chain
  double step = 0.1;        ///< first step size, as a part of the box
  double population = 1;    ///< population of a generation, over the usual number
  std::uint64_t seed = 1;
  int jobs = 1;  ///< threads for one candidate; does not change the result
};
struct ChainEnd {
  std::vector<double> x = {};                             ///< the best point; empty where none was feasible
  double cost = std::numeric_limits<double>::infinity();  ///< cost of the best point
  long closings = 0;
};
/// Searches until the closings of the chain are taken or the budget is over. Calls `told` with every candidate, after its
/// closings have been taken from the budget.
[[nodiscard]] ChainEnd search_chain(const StagedCost& cost, const Chain& chain, SearchBudget& budget,
                                    const std::function<void(const std::vector<double>& x, double cost)>& told);

}  // namespace softland
