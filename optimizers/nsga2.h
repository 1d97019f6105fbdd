// Minimisation of several objectives by NSGA-II. It finds the Pareto front: the points at which no objective can improve unless
// another objective becomes worse.
//
// A population begins at the given starts and at the points of a Sobol' sequence. In every generation pairs of parents have two
// children each, by simulated binary crossover and polynomial mutation; each parent is the better of two random members. The
// best half of parents and children survives, ranked by domination and, within a front, by the distance from their neighbours.
// A point that satisfies all constraints is better than a point that violates some; of two points that violate constraints, the
// point with the smaller violation is better.
//
// Source: K. Deb, A. Pratap, S. Agarwal & T. Meyarivan, "A fast and elitist multiobjective genetic algorithm: NSGA-II", IEEE
// Trans. Evol. Comput. 6 (2002) 182; bounded crossover and mutation as in their own code: K. Deb & R. B. Agrawal, Complex Systems
// 9 (1995) 115, and K. Deb & S. Agrawal, KanGAL report 99001.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "optimizers/pareto.h"
#include "optimizers/problem.h"

namespace softland {

struct ParetoValue {
  Objectives objectives;
  double violation = 0;  ///< sum of the violations of the constraints; 0 where all constraints hold
};

struct ParetoProblem {
  std::vector<Variable> variables = {};
  std::size_t objectives = 2;
  /// Returns the objectives at a point; called from several threads at once when jobs > 1, and must return equal values for
  /// equal x. A value that is not finite, a wrong number of values, or an exception make the point infeasible, and worse than
  /// any violation of constraints; the result has the message of the first exception.
  std::function<ParetoValue(std::span<const double>)> evaluate = {};
  /// Members of the first population; points outside the bounds are moved to the bounds.
  std::vector<std::vector<double>> starts = {};
};

struct ParetoEvaluation {
  long index = 0;  ///< number of the evaluation from 0, in the order of a run on one thread
  std::vector<double> x;
  ParetoValue value;
};

struct ParetoOptions {
  std::size_t population = 100;  ///< number of members of a generation; even, at least 4
  long max_evaluations = 10000;
  double max_seconds = std::numeric_limits<double>::infinity();  ///< time budget of the search [s]
  std::uint64_t seed = 1;
  int jobs = 1;
  double crossover_probability = 0.9;
  /// Distribution index of simulated binary crossover: the larger the index, the closer are children to their parents.
  double crossover_index = 15;
  double mutation_index = 20;  ///< distribution index of polynomial mutation; on average, one variable of each child mutates
  const std::atomic<bool>* stop = nullptr;  ///< set by another thread; ends the search with the Pareto front found so far
  /// Called under a lock after every evaluation, in the order in which evaluations end. An exception of this function ends
  /// minimize_all().
  std::function<void(const ParetoEvaluation&)> on_evaluation = {};
};

struct ParetoResult {
  Termination termination = Termination::not_run;
  long evaluations = 0;
  /// The points that no other evaluated point dominates (Pareto front), among the points without violated constraints, in the
  /// order of the first objective.
  std::vector<ParetoEvaluation> front;
  std::string first_exception;
};

/// Returns the Pareto front. It depends on the problem, max_evaluations, population, the two distribution indices and seed. It
/// does not depend on jobs, and on time only through max_seconds and stop, which are checked before every evaluation. A child
/// that was evaluated before costs nothing; the search has converged when a hundred generations have brought no new children.
/// Throws InvalidInput for an invalid problem or invalid options.
[[nodiscard]] ParetoResult minimize_all(const ParetoProblem& problem, const ParetoOptions& options);

}  // namespace softland
