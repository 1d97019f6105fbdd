#include "optimizers/nsga2.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "base/executor.h"
#include "base/random.h"
#include "base/require.h"
#include "optimizers/sobol.h"

namespace softland {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int idle_generations_allowed = 100;
// Variables of two parents that differ by less than this share of the box are not crossed.
constexpr double least_difference = 1e-14;

using Point = std::vector<double>;  // variables of a candidate, each scaled to [0, 1]

struct Member {
  Point point;
  ParetoValue value;
  std::size_t rank = 0;  // rank of the member's Pareto front; 0: the front that no member dominates
  double crowding = 0;   // crowding distance of the member to its neighbours in its Pareto front
};

bool is_better(const ParetoValue& a, const ParetoValue& b) {
  if (a.violation > 0 || b.violation > 0) return a.violation < b.violation;
  return dominates(a.objectives, b.objectives);
}

/// Random numbers for the two children of one pair of parents.
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint64_t pair) : seed_(random_bits(seed, Stream::offspring, pair)) {}
  double uniform() { return to_unit_interval(split_mix_64(seed_, count_++)); }
  std::size_t below(std::size_t size) {
    return std::min(size - 1, static_cast<std::size_t>(uniform() * static_cast<double>(size)));
  }

 private:
  std::uint64_t seed_;
  std::uint64_t count_ = 0;
};

/// Returns Pareto fronts of rising rank: no member of a front is dominated by a member of the same or of a later front.
std::vector<std::vector<std::size_t>> ranked(std::vector<Member>& members) {
  std::vector<std::size_t> better_than_it(members.size(), 0);
  std::vector<std::vector<std::size_t>> beaten(members.size());
  for (std::size_t a = 0; a < members.size(); ++a) {
    for (std::size_t b = 0; b < members.size(); ++b) {
      if (a == b || !is_better(members[a].value, members[b].value)) continue;
      beaten[a].push_back(b);
      ++better_than_it[b];
    }
  }
  std::vector<std::vector<std::size_t>> fronts(1);
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (better_than_it[k] == 0) fronts.back().push_back(k);
  }
  while (!fronts.back().empty()) {
    std::vector<std::size_t> next;
    for (const std::size_t a : fronts.back()) {
      members[a].rank = fronts.size() - 1;
      for (const std::size_t b : beaten[a]) {
        if (--better_than_it[b] == 0) next.push_back(b);
      }
    }
    std::sort(next.begin(), next.end());
    fronts.push_back(std::move(next));
  }
  fronts.pop_back();
  return fronts;
}

/// Sets the crowding distance of every member of a Pareto front: the sum over the objectives of the distance between its two
/// neighbours, over the range of the front; infinite at the ends of the front.
void measure_crowding(std::vector<Member>& members, std::vector<std::size_t> front) {
  for (const std::size_t k : front) members[k].crowding = 0;
  const std::size_t objectives = members[front.front()].value.objectives.size();
  for (std::size_t i = 0; i < objectives; ++i) {
    const auto value = [&](std::size_t k) { return members[k].value.objectives[i]; };
    std::stable_sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) { return value(a) < value(b); });
    members[front.front()].crowding = members[front.back()].crowding = infinity;
    const double range = value(front.back()) - value(front.front());
    if (!(range > 0)) continue;
    for (std::size_t k = 1; k + 1 < front.size(); ++k)
      members[front[k]].crowding += (value(front[k + 1]) - value(front[k - 1])) / range;
  }
}

/// Returns the best `size` members: whole Pareto fronts, and the least crowded members of the first front that does not fit.
std::vector<Member> survivors(std::vector<Member> members, std::size_t size) {
  std::vector<Member> chosen;
  for (std::vector<std::size_t>& front : ranked(members)) {
    measure_crowding(members, front);
    if (chosen.size() + front.size() > size) {
      std::stable_sort(front.begin(), front.end(),
                       [&](std::size_t a, std::size_t b) { return members[a].crowding > members[b].crowding; });
      front.resize(size - chosen.size());
    }
    for (const std::size_t k : front) chosen.push_back(std::move(members[k]));
    if (chosen.size() == size) break;
  }
  return chosen;
}

const Member& tournament(const std::vector<Member>& members, Draws& draws) {
  const Member& a = members[draws.below(members.size())];
  const Member& b = members[draws.below(members.size())];
  if (a.rank != b.rank) return a.rank < b.rank ? a : b;
  return b.crowding > a.crowding ? b : a;
}

/// Returns the random distance of two children from the middle of their parents, for one variable. The number `u` is uniform,
/// and `index` is the distribution index. The distance `room` is that from the middle to the bound on the child's side. Both
/// distances are in halves of the parents' distance.
double spread_factor(double u, double room, double index) {
  const double all = 2 - std::pow(room, -(index + 1));
  const double part = u * all;
  return std::pow(part <= 1 ? part : 1 / (2 - part), 1 / (index + 1));
}

void cross(Point& a, Point& b, const ParetoOptions& options, Draws& draws) {
  if (draws.uniform() >= options.crossover_probability) return;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool crossed = draws.uniform() < 0.5;
    const double u = draws.uniform();
    const bool swapped = draws.uniform() < 0.5;
    const auto [low, high] = std::minmax(a[i], b[i]);
    const double apart = high - low;
    if (!crossed || apart < least_difference) continue;
    const double middle = (low + high) / 2;
    const double below = middle - 0.5 * apart * spread_factor(u, 1 + 2 * low / apart, options.crossover_index);
    const double above = middle + 0.5 * apart * spread_factor(u, 1 + 2 * (1 - high) / apart, options.crossover_index);
    a[i] = std::clamp(swapped ? above : below, 0.0, 1.0);
    b[i] = std::clamp(swapped ? below : above, 0.0, 1.0);
  }
}

void mutate(Point& point, const ParetoOptions& options, Draws& draws) {
  const double power = options.mutation_index + 1;
  for (double& x : point) {
    const bool mutated = draws.uniform() * static_cast<double>(point.size()) < 1;
    const double u = draws.uniform();
    if (!mutated) continue;
    const double step = u < 0.5 ? std::pow(2 * u + (1 - 2 * u) * std::pow(1 - x, power), 1 / power) - 1
                                : 1 - std::pow(2 * (1 - u) + (2 * u - 1) * std::pow(x, power), 1 / power);
    x = std::clamp(x + step, 0.0, 1.0);
  }
}

/// Evaluates points, each only once, and stores all of them.
class Evaluations {
 public:
  Evaluations(const ParetoProblem& problem, const ParetoOptions& options) : problem_(problem), options_(options) {}

  [[nodiscard]] bool over() const { return ended_ != Termination::not_run; }
  [[nodiscard]] Termination ended() const { return ended_; }

  /// Evaluates the points and returns them as members of a population, without those for which evaluations or time ran out.
  std::vector<Member> members_at(const std::vector<Point>& points) {
    std::vector<std::vector<double>> fresh;
    std::set<std::vector<double>> seen;
    for (const Point& point : points) {
      std::vector<double> x = unscaled(point);
      if (!known_.contains(x) && seen.insert(x).second) fresh.push_back(std::move(x));
    }
    if (const auto left = static_cast<std::size_t>(options_.max_evaluations - count()); fresh.size() > left) fresh.resize(left);
    evaluate(fresh);
    std::vector<Member> members;
    for (const Point& point : points) {
      if (const auto found = known_.find(unscaled(point)); found != known_.end())
        members.push_back({.point = point, .value = log_[found->second].value});
    }
    if (count() == options_.max_evaluations) end(Termination::evaluation_budget);
    return members;
  }

  [[nodiscard]] long count() const { return static_cast<long>(log_.size()); }

  void end(Termination reason) {
    if (ended_ == Termination::not_run) ended_ = reason;
  }

  [[nodiscard]] ParetoResult result() const {
    ParetoResult result{.termination = ended_, .evaluations = count(), .front = {}, .first_exception = first_exception_};
    std::vector<Objectives> feasible;
    std::vector<const ParetoEvaluation*> whose;
    for (const ParetoEvaluation& e : log_) {
      if (e.value.violation > 0) continue;
      feasible.push_back(e.value.objectives);
      whose.push_back(&e);
    }
    for (const std::size_t k : pareto_front(feasible)) result.front.push_back(*whose[k]);
    std::stable_sort(result.front.begin(), result.front.end(), [](const ParetoEvaluation& a, const ParetoEvaluation& b) {
      return a.value.objectives < b.value.objectives;
    });
    const bool went_to_its_end = ended_ == Termination::converged || ended_ == Termination::evaluation_budget;
    if (result.front.empty() && went_to_its_end) result.termination = Termination::no_feasible_point;
    return result;
  }

  [[nodiscard]] Point scaled(const std::vector<double>& x) const {
    Point point;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto& [name, lower, upper] = problem_.variables[i];
      point.push_back(upper > lower ? std::clamp((x[i] - lower) / (upper - lower), 0.0, 1.0) : 0.0);
    }
    return point;
  }

 private:
  [[nodiscard]] std::vector<double> unscaled(const Point& point) const {
    std::vector<double> x;
    for (std::size_t i = 0; i < point.size(); ++i) {
      const auto& [name, lower, upper] = problem_.variables[i];
      x.push_back(std::clamp(std::lerp(lower, upper, point[i]), lower, upper));
    }
    return x;
  }

  // Returns the objectives at a point; an infeasible value when the problem's function `evaluate` fails.
  [[nodiscard]] ParetoValue value_at(const std::vector<double>& x, std::string& exception) const {
    ParetoValue value;
    try {
      value = problem_.evaluate(x);
      const auto finite = [](double v) { return std::isfinite(v); };
      if (value.objectives.size() == problem_.objectives && value.violation >= 0 &&
          std::all_of(value.objectives.begin(), value.objectives.end(), finite))
        return value;
    } catch (const std::exception& e) {
      exception = e.what();
    }
    return {.objectives = Objectives(problem_.objectives, infinity), .violation = infinity};
  }

  void evaluate(const std::vector<std::vector<double>>& points) {
    const long before = count();
    std::vector<ParetoEvaluation> made(points.size());
    std::vector<std::string> exceptions(points.size());
    std::atomic<bool> out_of_time = false;
    std::vector<char> done(points.size(), 0);
    run_tasks(points.size(), options_.jobs, [&](std::size_t k) {
      if (out_of_time || (options_.stop != nullptr && *options_.stop)) return;
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count() >= options_.max_seconds) {
        out_of_time = true;
        return;
      }
      made[k] = {.index = before + static_cast<long>(k), .x = points[k], .value = {}};
      made[k].value = value_at(made[k].x, exceptions[k]);
      done[k] = 1;
      if (!options_.on_evaluation) return;
      const std::scoped_lock lock(mutex_);
      options_.on_evaluation(made[k]);
    });
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (done[k] == 0) continue;
      if (first_exception_.empty()) first_exception_ = exceptions[k];
      known_.emplace(points[k], log_.size());
      log_.push_back(std::move(made[k]));
    }
    if (out_of_time) end(Termination::time_budget);
    if (options_.stop != nullptr && *options_.stop) end(Termination::interrupted);
  }

  const ParetoProblem& problem_;
  const ParetoOptions& options_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::vector<ParetoEvaluation> log_;
  std::map<std::vector<double>, std::size_t> known_;  // index of the evaluation in the log, by variables x
  std::string first_exception_;
  Termination ended_ = Termination::not_run;
  std::mutex mutex_;
};

void check(const ParetoProblem& problem, const ParetoOptions& options) {
  require(!problem.variables.empty(), "a problem needs at least one variable");
  require(problem.objectives >= 1, "a problem needs at least one objective");
  require(static_cast<bool>(problem.evaluate), "a problem needs a function to evaluate");
  for (const auto& [name, lower, upper] : problem.variables) {
    require(std::isfinite(lower) && std::isfinite(upper) && lower <= upper,
            fmt::format("variable \"{}\": bounds [{}, {}] must be finite and in order", name, lower, upper));
  }
  for (const std::vector<double>& start : problem.starts) {
    require(start.size() == problem.variables.size(),
            fmt::format("a start has {} values; it must have {}, one per variable", start.size(), problem.variables.size()));
    require(std::all_of(start.begin(), start.end(), [](double v) { return std::isfinite(v); }), "a start must be finite");
  }
  require(options.population >= 4 && options.population % 2 == 0,
          fmt::format("population = {} must be even and at least 4", options.population));
  require(options.max_evaluations > 0, fmt::format("max_evaluations = {} must be positive", options.max_evaluations));
  require(options.max_seconds > 0, fmt::format("max_seconds = {} must be positive", options.max_seconds));
  require(options.jobs >= 1, fmt::format("jobs = {} must be at least 1", options.jobs));
  require(options.crossover_probability >= 0 && options.crossover_probability <= 1,
          fmt::format("crossover_probability = {} must be in [0, 1]", options.crossover_probability));
  require(options.crossover_index >= 0 && options.mutation_index >= 0, "crossover_index and mutation_index must be at least 0");
}

std::vector<Point> first_population(const ParetoProblem& problem, const ParetoOptions& options, const Evaluations& evaluations) {
  std::vector<Point> points;
  for (const std::vector<double>& start : problem.starts) points.push_back(evaluations.scaled(start));
  if (points.size() < options.population) {
    const std::size_t more = options.population - points.size();
    for (Point& point : internal::sobol_points(options.seed, problem.variables.size(), 0, more))
      points.push_back(std::move(point));
  }
  return points;
}

std::vector<Point> children(const std::vector<Member>& parents, std::uint64_t generation, const ParetoOptions& options) {
  std::vector<Point> points;
  const std::uint64_t pairs = options.population / 2;
  for (std::uint64_t pair = 0; pair < pairs; ++pair) {
    Draws draws(options.seed, generation * pairs + pair);
    Point a = tournament(parents, draws).point;
    Point b = tournament(parents, draws).point;
    cross(a, b, options, draws);
    for (Point* child : {&a, &b}) {
      mutate(*child, options, draws);
      points.push_back(std::move(*child));
    }
  }
  return points;
}

}  // namespace

ParetoResult minimize_all(const ParetoProblem& problem, const ParetoOptions& options) {
  check(problem, options);
  Evaluations evaluations(problem, options);
  std::vector<Member> population =
      survivors(evaluations.members_at(first_population(problem, options, evaluations)), options.population);
  int idle = 0;
  for (std::uint64_t generation = 0; !evaluations.over(); ++generation) {
    const long before = evaluations.count();
    std::vector<Member> all = evaluations.members_at(children(population, generation, options));
    std::move(population.begin(), population.end(), std::back_inserter(all));
    population = survivors(std::move(all), options.population);
    idle = evaluations.count() == before ? idle + 1 : 0;
    if (idle == idle_generations_allowed) evaluations.end(Termination::converged);
  }
  return evaluations.result();
}

}  // namespace softland
