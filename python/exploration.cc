// Explorations of a design space for Python.
#include <pybind11/stl.h>

#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/require.h"
#include "python/scene.h"
#include "reports/origin.h"
#include "studies/exploration/exploration_runner.h"
#include "studies/exploration/front_search.h"
#include "verbs/explore.h"
#include "verbs/points.h"

namespace softland::python {

namespace py = pybind11;

namespace {

using verbs::ExploreRequest;

void search_the_front(Exploration& exploration, const ExploreRequest& request, const std::vector<ExploredAim>& aims,
                      StudyStore& store, KnownRows known, InterruptibleRun& run) {
  static_cast<void>(search_front(exploration, store, std::move(known), aims,
                                 {.jobs = request.jobs, .stop = run.stop(), .on_point = [&run](const FrontFound& found) {
                                    run.progress().tell("searching the Pareto front",
                                                        static_cast<double>(found.asked) / static_cast<double>(found.points));
                                  }}));
}

void explore_part(Exploration& exploration, const ExploreRequest& request, const Shard& shard, StudyStore& store,
                  InterruptibleRun& run) {
  ExplorationRunner(exploration, store,
                    {.shard = shard,
                     .jobs = request.jobs,
                     .stop = run.stop(),
                     .on_point =
                         [&run](const ExplorationProgress& e) {
                           run.progress().tell("exploring", static_cast<double>(e.there()) / static_cast<double>(e.points));
                         }})
      .run();
}

// Explores a design space into a database file. After Ctrl-C the file holds the computed rows.
void explore(const PyScene& scene, const verbs::Arguments& arguments, const std::string& command, const py::object& on_progress) {
  const verbs::Study& verb = verbs::study_named("explore");
  const auto [request, shard, plan] = in_keywords("explore", [&] {
    ExploreRequest asked = verbs::explore_request(arguments);
    PlanRequest words = asked.plan(scene.file, [&](std::string_view option) { return verb.keyword(option); });
    complete(words, verbs::studies_of_points());
    return std::tuple(asked, asked.part(), words);
  });
  InterruptibleRun run(on_progress);
  run([&](const Progress& progress) {
    Exploration exploration = exploration_for(Plan(plan), request.out, progress, verbs::studies_of_points());
    const bool is_search = exploration.plan().is_search();
    require_part(exploration, shard);
    std::vector<ExploredAim> aims;
    if (is_search) aims = aims_of(exploration);
    KnownRows known = is_search && request.resume ? known_rows(request.out) : KnownRows{};
    StudyStore store(request.out, stored_plan(exploration, shard), stored_origin(command),
                     request.resume ? StudyStore::Opening::resume : StudyStore::Opening::fresh);
    if (is_search) {
      search_the_front(exploration, request, aims, store, std::move(known), run);
    } else {
      explore_part(exploration, request, shard, store, run);
    }
    store.close();
    progress.throw_if_stopped();
    return true;
  });
}

}  // namespace

void bind_exploration(py::module_& m) { m.def("explore", &explore); }

}  // namespace softland::python
