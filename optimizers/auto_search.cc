#include "optimizers/auto_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.h"
#include "optimizers/backends.h"
#include "optimizers/sobol.h"

namespace softland::internal {
namespace {

// Shares of the evaluations of an epoch, which is one cycle of sampling, local searches and refinement. `refining` is for local
// searches from the user's starts. It is spent again if a gradient method continues these searches. `sampling` is for points
// spread over the box.
constexpr double refining = 0.2;
constexpr double sampling = 0.15;
// Share of the remaining evaluations for local searches near the best point (hops), if the search has a gradient and continues
// an earlier search.
constexpr double hopping = 0.6;
constexpr double first_heat = 0.4;
constexpr double later_heat = 0.2;

// Largest budget of one epoch [evaluations]; a further epoch with new starts promises more than longer local searches.
constexpr long longest_epoch = 5000;
constexpr long epochs_with_gradient = 4, shortest_epoch = 600;
constexpr std::size_t searches_at_once = 4;
constexpr std::size_t starts_refined = 2;
constexpr long shortest_refinement = 125;  // least budget for refining the best point [evaluations]
// Least budget of a local search [evaluations]: a first simplex or quadratic model of 7 variables needs about 20 points.
constexpr long shortest_heat = 20;

// Standard deviations of the distance between the best point and the random start of a local search near it (a hop), as
// fractions of the box of the variables.
constexpr std::array hop_sizes = {0.0005, 0.002, 0.008, 0.03};
// Least number of variables from which on local searches near the best point (hops) succeed more often than sampling the box of
// the variables.
constexpr std::size_t fewest_hopping = 16;
// Iterations of one hop (a local search near the best point), added to one iteration per variable: enough for a quasi-Newton
// model of the curvature.
constexpr long iterations_of_hop = 8;
constexpr long evaluations_of_iteration = 1 + evaluations_of_gradient;

// Largest required distance between start points (largest_separation), first step of a local search (first_step), and first
// step of a search that refines a point (polishing_step), as fractions of the box of the variables.
constexpr double largest_separation = 0.15;
constexpr double first_step = 0.25;
constexpr double polishing_step = 0.02;

struct LocalSearch {
  const Method* method;
  RunOptions run;
  Point best_point;
  double best = std::numeric_limits<double>::infinity();
  bool converged = false;

  LocalSearch(const Method& of, const Point& start, double step, std::uint64_t seed)
      : method(&of), run{.start = start, .step = step, .seed = seed}, best_point(start) {}
};

double distance(const Point& a, const Point& b) {
  double farthest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) farthest = std::max(farthest, std::abs(a[i] - b[i]));
  return farthest;
}

/// Returns up to searches_at_once of the best evaluated points that are apart from each other and from the points already
/// explored; the required distance is halved until there are enough points.
std::vector<Point> promising_points(std::vector<EvaluationRecord::Known> known, const std::vector<Point>& explored) {
  std::stable_sort(known.begin(), known.end(), [](const auto& a, const auto& b) { return a.answer.value < b.answer.value; });
  std::vector<Point> chosen;
  const auto apart = [&](const Point& candidate, double separation) {
    const auto far = [&](const Point& other) { return distance(candidate, other) > separation; };
    return std::all_of(chosen.begin(), chosen.end(), far) && std::all_of(explored.begin(), explored.end(), far);
  };
  constexpr int halvings = 10;
  double separation = largest_separation;
  for (int i = 0; i < halvings && chosen.size() < searches_at_once; ++i, separation /= 2) {
    for (const EvaluationRecord::Known& candidate : known) {
      if (chosen.size() == searches_at_once) break;
      if (apart(candidate.point, separation)) chosen.push_back(candidate.point);
    }
  }
  return chosen;
}

/// Returns the best evaluated point; empty when no point was feasible so far.
Point best_point(const EvaluationRecord& record) {
  const auto& known = record.known();
  const auto best =
      std::min_element(known.begin(), known.end(), [](const auto& a, const auto& b) { return a.answer.value < b.answer.value; });
  if (best == known.end() || !best->answer.feasible) return {};
  return best->point;
}

void sample(EvaluationRecord& record, std::uint64_t first, std::size_t count) {
  std::vector<EvaluationRecord::Task> tasks;
  for (const Point& point : sobol_points(record.seed(), record.dimension(), first, count)) {
    tasks.push_back({.budget = 1, .body = [point](BudgetedObjective& budgeted) { budgeted(point); }});
  }
  record.run(tasks);
}

/// Runs each local search that has not converged for `budget` further evaluations.
void advance(EvaluationRecord& record, std::vector<LocalSearch>& searches, long budget) {
  std::vector<EvaluationRecord::Task> tasks;
  for (LocalSearch& search : searches) {
    if (search.converged) continue;
    tasks.push_back({.budget = budget, .body = [&search](BudgetedObjective& budgeted) {
                       search.converged = run_method(*search.method, search.run, budgeted).converged;
                       if (budgeted.best_of_task() < search.best) {
                         search.best = budgeted.best_of_task();
                         search.best_point = budgeted.best_point_of_task();
                       }
                     }});
  }
  record.run(tasks);
}

long share_of(long budget, double share, std::size_t searches) {
  return std::max(shortest_heat, static_cast<long>(share * static_cast<double>(budget) / static_cast<double>(searches)));
}

/// Runs monotonic basin hopping (Leary 2000, J. Glob. Optim. 18, 367) within a budget: local searches start from random points
/// near the best point, and a better result of a search becomes the new best point.
void hop(EvaluationRecord& record, const Method& method, long budget) {
  const long each =
      std::max(shortest_heat, evaluations_of_iteration * (iterations_of_hop + static_cast<long>(record.dimension())));
  const long end = std::max(0L, record.remaining() - budget);
  std::uint64_t hops = 0;
  while (!record.over() && record.remaining() - end >= each) {
    const Point best = best_point(record);
    if (best.empty()) return;
    const auto affordable = static_cast<std::size_t>((record.remaining() - end) / each);
    std::vector<LocalSearch> beside;
    for (const double size : hop_sizes) {
      if (beside.size() == affordable) break;
      Point start = best;
      const std::uint64_t seed = random_bits(record.seed(), Stream::hop, hops++);
      for (std::size_t i = 0; i < start.size(); ++i)
        start[i] = std::clamp(start[i] + size * random_normal(seed, Stream::hop, i), 0.0, 1.0);
      beside.emplace_back(method, start, polishing_step, seed);
    }
    const long before = record.remaining();
    advance(record, beside, each);
    if (record.remaining() == before) return;
  }
}

/// Searches in epochs, which are cycles of sampling, local searches by `methods`, and refinement of the best point by
/// `polisher`. If `finisher` is not null, this gradient method continues the local searches after their first round.
void search(EvaluationRecord& record, const std::array<const Method*, searches_at_once>& methods, const Method* finisher,
            const Method& polisher) {
  std::uint64_t points_sampled = 0;
  std::uint64_t searches_begun = 0;
  const auto begin_search = [&](const Method& method, const Point& start, double step) {
    return LocalSearch(method, start, step, random_bits(record.seed(), Stream::library_seed, searches_begun++));
  };
  std::vector<Point> explored;
  // Local searches with a gradient need fewer evaluations each, so run more searches: more local minima are found.
  const long longest = record.has_gradient()
                           ? std::clamp(record.remaining() / epochs_with_gradient, shortest_epoch, longest_epoch)
                           : longest_epoch;

  // The user chose the starts: search near the starts before the whole box, which would lead away from the starts.
  if (!record.starts().empty()) {
    const long budget = std::min(record.remaining(), longest_epoch);
    std::vector<Point> starts = promising_points(record.known(), explored);
    starts.resize(std::min(starts.size(), starts_refined));
    std::vector<LocalSearch> refined;  // local searches from the user's starts; empty when stopped before the first evaluation
    const auto go_on = [&] {
      if (refined.empty()) return;
      advance(record, refined, std::max(share_of(budget, refining, refined.size()), shortest_refinement));
      for (const LocalSearch& search : refined) explored.push_back(search.best_point);
    };
    const bool by_values = finisher == nullptr || !(record.has_gradient() && record.smooth());
    const Method& first = by_values ? find_method("sbplx") : *finisher;
    for (const Point& start : starts) refined.push_back(begin_search(first, start, polishing_step));
    go_on();
    if (finisher != nullptr) {
      if (by_values) {
        for (LocalSearch& each : refined) each = begin_search(*finisher, each.best_point, polishing_step);
        go_on();
      }
      if (record.has_gradient() && record.goes_on() && record.dimension() >= fewest_hopping)
        hop(record, *finisher, static_cast<long>(hopping * static_cast<double>(record.remaining())));
    }
  }

  while (!record.over()) {
    const long before = record.remaining();
    const long budget = std::min(before, longest);
    const auto samples = static_cast<std::size_t>(std::ceil(sampling * static_cast<double>(budget)));
    sample(record, points_sampled, samples);
    points_sampled += samples;

    std::vector<LocalSearch> running;
    for (const Point& start : promising_points(record.known(), explored)) {
      running.push_back(begin_search(*methods[running.size()], start, first_step));
    }
    double share = first_heat;
    while (!running.empty() && !record.over()) {
      advance(record, running, share_of(budget, share, running.size()));
      for (const LocalSearch& search : running) explored.push_back(search.best_point);
      if (running.size() == 1) break;
      std::stable_sort(running.begin(), running.end(),
                       [](const LocalSearch& a, const LocalSearch& b) { return a.best < b.best; });
      running.erase(running.begin() + static_cast<std::ptrdiff_t>((running.size() + 1) / 2), running.end());
      if (finisher != nullptr && share == first_heat) {
        for (LocalSearch& each : running) each = begin_search(*finisher, each.best_point, polishing_step);
      }
      share = later_heat;
    }

    if (const Point best = best_point(record); !best.empty()) {
      std::vector<LocalSearch> polish{begin_search(polisher, best, polishing_step)};
      advance(record, polish, budget);
    }
    if (record.remaining() == before) return;
  }
}

}  // namespace

void search_auto(EvaluationRecord& record) {
  const Method& polisher = find_method("bobyqa");
  const Method& searcher = find_method("cma-es");
  if (!record.has_gradient()) return search(record, {&searcher, &polisher, &searcher, &searcher}, nullptr, polisher);
  const Method& finisher = find_method("slsqp");
  search(record, {&searcher, &searcher, &searcher, &searcher}, &finisher, finisher);
}

void search_and_finish(EvaluationRecord& record, const Method& finisher) {
  const Method& searcher = find_method("cma-es");
  search(record, {&searcher, &searcher, &searcher, &searcher}, &finisher, finisher);
}

}  // namespace softland::internal
