// A tournament of searches (contenders) over rounds: the best searches of a round continue in the next one. Four searches are
// tournaments, and differ in their contenders and in the measure of comparison:
//
//   optimize.h           waveform families on the nominal device, one after another, compared by their cost
//   family_tournament.h  waveform families by two measures, compared on the devices of the next round
//   robust_optimize.h    distant points of one family, compared by their cost on all devices
//   search_at_pace()     one contender, which goes on in every round
//
// Over varied devices, searches of a round run in parallel, with more devices and smaller steps than in the round before. There
// a contender is a point of a search space, from which CMA-ES searches in a round (search_chain()). The contenders begin at the
// best of many points: the starts of the waveform family, those nearest to given waveforms, and points of the whole search
// space. Contenders of a round do not depend on each other, so that the result depends on the seed and the number of closings
// only.
//
// A chain of CMA-ES tries candidate waveforms on more and more devices. A candidate with a higher cost on the first devices than
// the median of the earlier candidates is given up.
//
// Source for giving up candidates: O. Maron & A. W. Moore, "Hoeffding races", NIPS 1993 (the idea; the test here is the median
// of the earlier candidates). Source for the halving: K. Jamieson & A. Talwalkar, "Non-stochastic best arm identification and
// hyperparameter optimization", AISTATS 2016.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/executor.h"
#include "optimizers/problem.h"
#include "studies/search/evaluation_memory.h"
#include "studies/search/robust_cost.h"
#include "studies/search/search_budget.h"
#include "studies/search/search_setting.h"

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

inline constexpr std::size_t without_bound = std::numeric_limits<std::size_t>::max();

/// A round (stage) of a tournament of searches.
struct Round {
  std::size_t contenders = without_bound;  ///< largest number of searches (contenders) in the round
  /// Number of devices on which a search tries candidate waveforms; all, if there are fewer.
  std::size_t devices = without_bound;
  double closings = 0;  ///< number of closings of each search, or a share of the budget: see Tournament::share
  double step = 0.1;    ///< first step size of a search, as a share of the range of every variable
};

/// The part of the budget for a search (contender) in a round of the tournament.
struct RoundShare {
  long closings = 0;
  double seconds = std::numeric_limits<double>::infinity();  ///< time that the searches of the round may take [s]
};

/// A search in a tournament: the number of the round, and the number of the search (contender) in this round.
struct SearchInRound {
  std::size_t round = 0, number = 0;
};

/// A sequence of rounds (stages) of parallel searches that share a budget. The type Contender holds the state of a search
/// between rounds, at least its best point.
template <class Contender>
struct Tournament {
  SearchBudget& budget;
  int jobs = 1;
  /// Divides the budget: returns the part of each search in a round of `contenders` searches.
  std::function<RoundShare(const Round&, std::size_t contenders)> share;
  /// Runs the search of a contender within `part`, the budget of the round. This function must set start and seed of its copy
  /// of `chain`. It is called from several threads.
  std::function<void(Contender&, SearchInRound turn, const Chain& chain, SearchBudget& part)> search;
  /// Compares the searches (contenders) after a round, whose number counts from 0, and returns those of the next round.
  std::function<std::vector<Contender>(std::vector<Contender> contenders, std::size_t round)> select;

  /// Runs the rounds of the tournament until the budget is spent, no search (contender) continues, or a search would get no
  /// closings.
  void run(std::span<const Round> rounds, std::vector<Contender> contenders) const {
    for (std::size_t k = 0; k < rounds.size() && !contenders.empty() && !budget.over(); ++k) {
      const RoundShare each = share(rounds[k], contenders.size());
      if (each.closings < 1) return;
      SearchBudget part(budget, each.closings * static_cast<long>(contenders.size()), each.seconds);
      const Chain chain{.devices = rounds[k].devices, .closings = each.closings, .step = rounds[k].step, .jobs = jobs};
      run_tasks(
          contenders.size(), jobs,
          [&](std::size_t i) {
            search(contenders[i], {k, i}, chain, part);
          },
          budget.stop());
      contenders = select(std::move(contenders), k);
    }
  }
};

/// Returns the points at which a search begins: the starts of its waveform family, the point of the scene's own waveform, and
/// the points nearest to the waveforms `others`. Waveforms from which the search cannot begin are skipped.
[[nodiscard]] std::vector<std::vector<double>> starting_points(const SearchSetting& setting,
                                                               const std::vector<DriveWaveforms>& others);
/// Returns the first `count` points of a Sobol' sequence over the whole search space.
[[nodiscard]] std::vector<std::vector<double>> points_of_box(const std::vector<Variable>& variables, std::uint64_t seed,
                                                             std::uint64_t count);

/// Numbers of closings of a search that improves a point.
struct ImprovingClosings {
  long before = 0;    ///< closings for the cost of the given point; the budget does not count these
  long searched = 0;  ///< number of closings of the search itself
};
/// Searches from the point `x`, and replaces `x` by the best point of the search if that best point costs less on the chain's
/// devices. Calls `on_candidate` after every candidate waveform.
ImprovingClosings improve(std::vector<double>& x, const StagedCost& cost, Chain chain, SearchBudget& budget,
                          const std::function<void()>& on_candidate);

}  // namespace softland
