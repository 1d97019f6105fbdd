// Searches for waveforms under Python.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "python/own.h"
#include "python/scene.h"
#include "reports/report_files.h"
#include "reports/result_json.h"
#include "reports/search_report.h"

namespace softland::python {

namespace py = pybind11;

namespace {

// What a search is asked for, as Python has it; what is not given is as in the program.
struct Request {
  SearchRequest words;
  std::shared_ptr<PythonObjective> objective;
  std::vector<std::shared_ptr<PythonWaveform>> own_waveforms;
  std::vector<py::dict> starts;
  int jobs = 1;
  py::object callback, progress;
  std::string command;
};

PlannedSearch planned_search(const Request& request, const SceneFile& file, Run& run) {
  PlannedSearch search =
      planned(completed(request.words, file), file, request.words.waveform,
              {.objective = request.objective, .waveforms = {request.own_waveforms.begin(), request.own_waveforms.end()}});
  require(
      !search.for_devices || request.own_waveforms.empty(),
      "own_waveforms: a search for devices works on scene files, which cannot hold one: ask for robust=\"none\" or a measure");
  search.options.jobs = request.jobs;
  search.options.stop = run.stop();
  for (const py::dict& start : request.starts) {
    search.options.starts.push_back(
        {.name = fmt::format("start {}", search.options.starts.size() + 1), .waveforms = waveforms_of(start, run)});
  }
  return search;
}

// The callbacks: what Python is told, and how it ends a search. Once candidates are tried they throw nothing, which a search
// would take for a bad candidate: run.stop() ends it.
void listen(OptimizeOptions& options, const Request& request, Run& run) {
  options.on_preparation = [&run](std::string_view what, double part) {
    run.throw_if_given_up();
    run.watch().tell(what, part);
  };
  options.on_evaluation = [&request, &run, budget = options.max_evaluations](const Evaluation& evaluation,
                                                                             const OptimizeProgress& progress) {
    const bool failed = (request.objective && request.objective->first_error().is_there()) ||
                        std::any_of(request.own_waveforms.begin(), request.own_waveforms.end(),
                                    [](const auto& one) { return one->first_error().is_there(); });
    if (failed) run.keep(std::make_exception_ptr(Interrupted()));
    run.watch().tell("search", static_cast<double>(progress.evaluations) / static_cast<double>(std::max(1L, budget)));
    if (request.callback.is_none()) return;
    run.call([&] {
      const py::object wish =
          request.callback(progress.evaluations, progress.best_cost, progress.baseline_cost, evaluation.value);
      if (!wish.is_none() && wish.cast<bool>()) run.end_by_wish();
    });
  };
  options.on_progress = [&run](const OptimizeProgress& progress) {
    run.watch().tell(fmt::format("search, {} evaluations", progress.evaluations), 0);
  };
}

std::map<std::string, std::function<std::string()>> files_of(const std::shared_ptr<const SearchReport>& report) {
  std::map<std::string, std::function<std::string()>> files;
  for (ReportFile<SearchReport>& file : softland::files_of(*report))
    files[file.name] = [report, text = std::move(file.text)] { return text(*report); };
  return files;
}

// The first error of a Python function comes before what the library made of it.
template <class Work>
auto searched(const Request& request, Run& run, Work&& work) {
  const auto raise = [&] {
    if (request.objective) request.objective->first_error().rethrow();
    for (const auto& one : request.own_waveforms) one->first_error().rethrow();
  };
  try {
    auto found = run(std::forward<Work>(work));
    raise();
    return found;
  } catch (py::error_already_set&) {
    raise();
    throw;
  } catch (const std::exception&) {
    raise();
    throw;
  }
}

// A result of a waveform that no file can hold: the keys of a result.json that are left.
Outcome outcome_of_own(const OptimizeResult& found) {
  nlohmann::json parameters = nlohmann::json::object();
  for (const auto& [name, value] : found.parameters) parameters[name] = value;
  return {.json = json_text({{"kind", "optimize"},
                             {"status", std::string(to_string(found.best->metrics.status))},
                             {"waveform", found.family},
                             {"evaluations", found.search.evaluations},
                             {"goal_met", found.goal_met},
                             {"confirmed", found.confirmed},
                             {"better_than_baseline", found.better_than_baseline},
                             {"metrics", metrics_json(found.best->metrics)},
                             {"best", {{"parameters", std::move(parameters)}, {"metrics", metrics_json(found.best->metrics)}}},
                             {"baseline", {{"metrics", metrics_json(found.baseline.metrics)}}}})};
}

bool is_own(const OptimizeResult& found) {
  return found.best && found.best_scene && std::ranges::any_of(found.best_scene->drives.waveforms, [](const auto& one) {
           return std::holds_alternative<Own>(one.second);
         });
}

Outcome search(PyScene& scene, const Request& request) {
  Run running(request.progress);
  PlannedSearch search = planned_search(request, scene.file, running);
  listen(search.options, request, running);
  return searched(request, running, [&](const Watch& watch) {
    const auto report = std::make_shared<SearchReport>(run(search));
    running.throw_if_given_up();
    if (is_own(report->found.best())) return outcome_of_own(report->found.best());
    add_devices(*report, search, request.command, watch);
    running.throw_if_given_up();
    add_result(*report, search, "", {.command = request.command});
    return Outcome{.json = json_text(result_json(report->result)), .files = files_of(report)};
  });
}

}  // namespace

void bind_search(py::module_& m) {
  m.def("optimize", [](PyScene& scene, const py::dict& given) {
    Request request{.objective = given["objective"].cast<std::shared_ptr<PythonObjective>>(),
                    .own_waveforms = given["own_waveforms"].cast<std::vector<std::shared_ptr<PythonWaveform>>>(),
                    .starts = given["starts"].cast<std::vector<py::dict>>(),
                    .jobs = given["jobs"].cast<int>(),
                    .callback = given["callback"],
                    .progress = given["progress"],
                    .command = given["command"].cast<std::string>()};
    visit_words(
        [&](std::string_view name, auto& word) {
          const py::str key{std::string(name)};
          if (given.contains(key) && !given[key].is_none()) word = py::str(given[key]).cast<std::string>();
        },
        request.words);
    request.words.constrain = given["constrain"].cast<std::vector<std::string>>();
    return search(scene, request);
  });
}

}  // namespace softland::python
