// Explorations of the design space under Python.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/require.h"
#include "python/scene.h"
#include "reports/origin.h"
#include "studies/exploration/exploring.h"
#include "studies/exploration/front_search.h"
#include "verbs/points.h"

namespace softland::python {

namespace py = pybind11;

namespace {

struct ExploreRequest {
  PlanRequest plan;
  std::string out, shard, command;
  bool resume = false;
  int jobs = 1;
};

ExploreRequest request_of(const SceneFile& file, const py::dict& given) {
  const auto text = [&](const char* key) { return given[key].cast<std::string>(); };
  ExploreRequest request{.plan = {.scene = file,
                                  .vary = given["vary"].cast<std::vector<std::string>>(),
                                  .sample = text("sample"),
                                  .pareto = text("pareto"),
                                  .study = text("study"),
                                  .options = given["options"].cast<std::map<std::string, std::string>>(),
                                  .seed = given["seed"].cast<std::uint64_t>()},
                         .out = text("out"),
                         .shard = text("shard"),
                         .command = text("command"),
                         .resume = given["resume"].cast<bool>(),
                         .jobs = given["jobs"].cast<int>()};
  PlanRequest& plan = request.plan;
  if (!plan.pareto.empty() && plan.sample.empty()) plan.sample = usual_front_sample;
  require(!plan.vary.empty(), "vary: nothing varies: give {\"gap.contact\": \"1.6 um:2.4 um:7\"}");
  plan.place = [all = plan.vary, options = plan.options, study = plan.study, sample = plan.sample](std::string_view key,
                                                                                                   std::size_t number) {
    const auto option = options.find(std::string(key));
    const std::string value = key == "vary" && number < all.size() ? all[number]
                              : key == "study"                     ? study
                              : key == "sample"                    ? sample
                              : option != options.end()            ? option->second
                                                                   : "";
    return value.empty() ? std::string(key) : fmt::format("{} {}", key, value);
  };
  complete(plan, verbs::studies_of_points());
  return request;
}

void search_the_front(Exploration& exploration, const ExploreRequest& request, const std::vector<ExploredAim>& aims,
                      StudyStore& store, KnownRows known, Run& run) {
  static_cast<void>(search_front(exploration, store, std::move(known), aims,
                                 {.jobs = request.jobs, .stop = run.stop(), .on_point = [&run](const FrontFound& found) {
                                    run.watch().tell("searching the front",
                                                     static_cast<double>(found.asked) / static_cast<double>(found.points));
                                  }}));
}

void explore_part(Exploration& exploration, const ExploreRequest& request, const Shard& shard, StudyStore& store, Run& run) {
  Exploring(exploration, store,
            {.shard = shard,
             .jobs = request.jobs,
             .stop = run.stop(),
             .on_point =
                 [&run](const Explored& e) {
                   run.watch().tell("exploring", static_cast<double>(e.there()) / static_cast<double>(e.points));
                 }})
      .run();
}

// Into a store, which has the rows that are done also where Ctrl-C ends it.
void explore(const PyScene& scene, const py::dict& given) {
  const ExploreRequest request = request_of(scene.file, given);
  Run run(given["progress"]);
  run([&](const Watch& watch) {
    Exploration exploration(Plan(request.plan), watch, verbs::studies_of_points());
    const bool is_search = exploration.plan().is_search();
    const Shard shard = request.shard.empty() ? Shard{} : shard_from(request.shard);
    require_part(exploration, shard);
    std::vector<ExploredAim> aims;
    if (is_search) aims = aims_of(exploration);
    KnownRows known = is_search && request.resume ? known_rows(request.out) : KnownRows{};
    StudyStore store(request.out, stored_plan(exploration, shard), stored_origin(request.command),
                     request.resume ? StudyStore::Opening::resume : StudyStore::Opening::fresh);
    if (is_search) {
      search_the_front(exploration, request, aims, store, std::move(known), run);
    } else {
      explore_part(exploration, request, shard, store, run);
    }
    store.close();
    watch.throw_if_stopped();
    return true;
  });
}

}  // namespace

void bind_exploration(py::module_& m) { m.def("explore", &explore); }

}  // namespace softland::python
