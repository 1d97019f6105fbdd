#include "optimizers/auto_search.h"

#include <algorithm>
#include <cmath>

#include "optimizers/backends.h"
#include "optimizers/seeding.h"

namespace softland::internal {
namespace {

struct Search {
  const Method* method;
  Run run;
  double best = std::numeric_limits<double>::infinity();
  bool converged = false;
};

double distance(const Point& a, const Point& b) {
  double farthest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) farthest = std::max(farthest, std::abs(a[i] - b[i]));
  return farthest;
}

std::vector<Point> well_separated(std::vector<Ledger::Known> known, std::size_t count, double separation) {
  std::stable_sort(known.begin(), known.end(), [](const auto& a, const auto& b) { return a.answer.value < b.answer.value; });
  std::vector<Point> chosen;
  for (; chosen.size() < std::min(count, known.size()); separation *= 0.5) {
    for (const Ledger::Known& candidate : known) {
      if (chosen.size() == count) break;
      const bool apart = std::all_of(chosen.begin(), chosen.end(),
                                     [&](const Point& other) { return distance(candidate.point, other) > separation; });
      if (apart) chosen.push_back(candidate.point);
    }
    if (separation < 1e-9) break;
  }
  return chosen;
}

void advance(Ledger& ledger, std::vector<Search>& searches, long budget_each) {
  std::vector<Ledger::Task> tasks;
  for (Search& search : searches) {
    if (search.converged) continue;
    tasks.push_back({.budget = budget_each, .body = [&search](Strand& strand) {
                       search.converged = run_method(*search.method, search.run, strand).converged;
                       search.best = std::min(search.best, strand.best_of_task());
                     }});
  }
  ledger.run(tasks);
}

}  // namespace

void search_auto(Ledger& ledger) {
  const Method* methods[] = {&find_method("sbplx"), &find_method("nelder-mead"), &find_method("bobyqa")};
  std::uint64_t sobol_next = 0;
  std::uint64_t search_id = 0;
  while (!ledger.over()) {
    const long total = ledger.remaining();
    const auto samples = static_cast<std::size_t>(std::max(1.0, 0.25 * static_cast<double>(total)));
    std::vector<Ledger::Task> tasks;
    for (Point& point : sobol_points(ledger.seed(), ledger.dimension(), sobol_next, samples)) {
      tasks.push_back({.budget = 1, .body = [point = std::move(point)](Strand& strand) { strand(point); }});
    }
    sobol_next += samples;
    ledger.run(tasks);

    std::vector<Search> searches;
    for (const Point& start : well_separated(ledger.known(), 6, 0.15)) {
      searches.push_back(
          {.method = methods[searches.size() % 3],
           .run = {.start = start, .step = 0.1, .seed = draw_bits(ledger.seed(), Draw::library_seed, search_id++)}});
    }
    double share = 0.3;
    while (!searches.empty() && !ledger.over()) {
      const long budget =
          std::max<long>(20, static_cast<long>(share * static_cast<double>(total) / static_cast<double>(searches.size())));
      const long before = ledger.remaining();
      advance(ledger, searches, budget);
      if (ledger.remaining() == before) break;
      if (searches.size() == 1) break;
      std::stable_sort(searches.begin(), searches.end(), [](auto& a, auto& b) { return a.best < b.best; });
      searches.resize((searches.size() + 1) / 2);
      share = 0.2;
    }
    if (ledger.over()) break;
    const Search polish{.method = methods[2],
                        .run = {.start = well_separated(ledger.known(), 1, 1).front(), .step = 0.02, .seed = 1}};
    std::vector<Search> last{polish};
    advance(ledger, last, ledger.remaining());
  }
}

}  // namespace softland::internal
