// A search over devices from one start: CMA-ES, whose candidates are tried on ever more devices, and given up where they do worse
// on the first of them than the median of the candidates before.
//
// Source for the races: O. Maron & A. W. Moore, "Hoeffding races", NIPS 1993 (the idea; our test is the median of the candidates
// before).
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

namespace softland {

/// What a candidate costs on devices, found in stages: on 8, on 32, on all that are asked for.
class StagedCost {
 public:
  /// Keeps references to `setting`, `cost` and `aim`. `memory` may be null; `seed` tells it which devices and which aim these
  /// are.
  StagedCost(const SearchSetting& setting, const RobustCost& cost, const RobustAim& aim, EvaluationMemory* memory,
             std::uint64_t seed)
      : setting_(setting), cost_(cost), aim_(aim), memory_(memory), seed_(seed) {}

  struct Tried {
    double cost = std::numeric_limits<double>::infinity();  ///< infinite where a driver cannot give the waveform
    long closings = 0;
  };
  /// On the first `devices`, or on as many as it takes to see that it costs more than `hopeless`.
  [[nodiscard]] Tried tried(const std::vector<double>& x, std::size_t devices,
                            double hopeless = std::numeric_limits<double>::infinity(), int jobs = 1) const;

 private:
  const SearchSetting& setting_;
  const RobustCost& cost_;
  const RobustAim& aim_;
  EvaluationMemory* memory_;
  std::uint64_t seed_;
};

/// Devices at which a candidate may be given up.
inline constexpr std::array<std::size_t, 2> stages{8, 32};

struct Chain {
  std::vector<double> start;
  std::size_t devices = 0;
  long closings = 0;      ///< at the most
  double step = 0.1;      ///< first one, of the box
  double population = 1;  ///< of a generation, over the usual number
  std::uint64_t seed = 1;
  int jobs = 1;  ///< for one candidate; does not change the result
};
struct ChainEnd {
  std::vector<double> x = {};                             ///< the best point; empty where none was feasible
  double cost = std::numeric_limits<double>::infinity();  ///< there
  long closings = 0;
};
/// `told` hears of every candidate and the closings that it took; where it answers true, the chain ends.
[[nodiscard]] ChainEnd search_chain(const StagedCost& cost, const std::vector<Variable>& variables, const Chain& chain,
                                    const std::function<bool(const std::vector<double>& x, double cost, long closings)>& told);

}  // namespace softland
