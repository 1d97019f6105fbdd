// Several objectives at once: the front of what can be had of one for how much of the others, by NSGA-II.
//
// A population begins at the given starts and at the points of a Sobol' sequence. In every generation each two parents, both the
// better of two random members, have two children by simulated binary crossover and polynomial mutation; of parents and children
// together the best half lives on, ranked by domination and, within a front, by how far from their neighbours they are. A point
// that keeps all constraints is better than one that does not, and of two that do not the one with the smaller violation.
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
  double violation = 0;  ///< 0 where all constraints hold, else by how much they do not, in sum
};

struct ParetoProblem {
  std::vector<Variable> variables = {};
  std::size_t objectives = 2;
  /// Called from several threads at once when jobs > 1. A value that is not finite, a wrong number of them, or an exception make
  /// the point infeasible beyond any violation; the first exception is kept in the result. It must give the same value for the
  /// same x.
  std::function<ParetoValue(std::span<const double>)> evaluate = {};
  /// Members of the first population; moved into the bounds.
  std::vector<std::vector<double>> starts = {};
};

struct ParetoEvaluation {
  long index = 0;  ///< counted from 0, in the order of a run on one thread
  std::vector<double> x;
  ParetoValue value;
};

struct ParetoOptions {
  std::size_t population = 100;  ///< even, at least 4
  long max_evaluations = 10000;
  double max_seconds = std::numeric_limits<double>::infinity();  ///< [s]
  std::uint64_t seed = 1;
  int jobs = 1;
  double crossover_probability = 0.9;
  double crossover_index = 15;              ///< of the distribution of children: the larger, the closer to their parents
  double mutation_index = 20;               ///< the same of mutations, of which there is one per child on average
  const std::atomic<bool>* stop = nullptr;  ///< set from outside: ends the search with what there is
  /// Called (under a lock) after every evaluation, as they happen. If it throws, so does minimize_all().
  std::function<void(const ParetoEvaluation&)> on_evaluation = {};
};

struct ParetoResult {
  Termination termination = Termination::not_run;
  long evaluations = 0;
  std::vector<ParetoEvaluation> front;  ///< of all that was evaluated and keeps the constraints; by the first objective
  std::string first_exception;
};

/// The front depends on the problem, max_evaluations, population, the two indices and seed: not on jobs, and on time only through
/// max_seconds and stop, which are looked at before every evaluation. A child that was evaluated before costs nothing; where a
/// hundred generations have brought nothing else, the search has converged.
/// Throws InvalidInput for a problem or options that make no sense.
[[nodiscard]] ParetoResult minimize_all(const ParetoProblem& problem, const ParetoOptions& options);

}  // namespace softland
