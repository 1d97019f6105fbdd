// Searches for waveforms, for Python.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "python/own.h"
#include "python/scene.h"
#include "reports/record_file.h"
#include "reports/search_session.h"
#include "verbs/optimize.h"
#include "verbs/report_outcome.h"

namespace softland::python {

namespace py = pybind11;

namespace {

// The request of a search: the options as texts, and the Python functions, start waveforms and callbacks.
struct Request {
  verbs::OptimizeRequest words;
  std::shared_ptr<PythonObjective> objective;
  std::vector<std::shared_ptr<PythonWaveform>> own_waveforms;
  std::vector<py::dict> starts;
  py::object callback, on_progress;
  std::string command;
  std::string out;  // folder in which the search is stored; empty: nothing is stored
};

PlannedSearch planned_search(const Request& request, const SceneFile& file, InterruptibleRun& run) {
  PlannedSearch search =
      planned(completed(request.words, file), file, request.words.waveform,
              {.objective = request.objective, .waveforms = {request.own_waveforms.begin(), request.own_waveforms.end()}});
  require(!search.for_devices || request.own_waveforms.empty(),
          "own_waveforms: must not be given with a search for devices, which needs scene files; "
          "give robust=\"none\" or one statistic");
  search.options.jobs = request.words.jobs;
  search.options.stop = run.stop();
  for (const py::dict& start : request.starts) {
    search.options.starts.push_back(
        {.name = fmt::format("start {}", search.options.starts.size() + 1), .waveforms = waveforms_of(start, run)});
  }
  return search;
}

// Returns a search that is stored in a folder. Its stored request includes the start waveforms. Throws InvalidInput for Python
// functions, also as start waveforms: a file cannot express them.
StoredSearch kept_search(const Request& request, const PyScene& scene, std::optional<KnownSearch>& known, InterruptibleRun& run) {
  require(!request.objective && request.own_waveforms.empty(),
          "out: must not be given for a search with Python functions, which cannot be stored in a file");
  AskedSearch asked{.request = request.words,
                    .given = GivenText{.file = scene.file.name(), .folder = scene.directory, .text = scene.file.text()},
                    .scene = scene.file,
                    .jobs = request.words.jobs,
                    .stop = run.stop()};
  for (const py::dict& start : request.starts) {
    SceneFile begun = scene.file;
    for (const auto& [drive, waveform] : waveforms_of(start, run)) begun.set_waveform(drive, waveform);
    asked.starts.push_back({.name = fmt::format("start {}", asked.starts.size() + 1), .scene = std::move(begun)});
  }
  const auto stores =
      request.words.resume ? ResultFolder::places(request.out, evaluations_file) : std::vector<std::filesystem::path>();
  return stored_search(asked, stores, known);
}

// Sets callbacks that report to Python, which may end the search by run.stop(). Callbacks during the search throw nothing,
// because the search would treat an exception as an infeasible waveform.
void listen(PlannedSearch& search, const Request& request, InterruptibleRun& run, SearchSession* session = nullptr) {
  OptimizeOptions& options = search.options;
  options.on_preparation = [&run](std::string_view what, double part) {
    run.throw_if_given_up();
    run.progress().tell(what, part);
  };
  if (session != nullptr) {
    options.on_start = [session](const FamilyColumns& columns) { session->begin(columns); };
    options.on_improvement = [session](const Evaluation&, const SceneFile& best) { session->improved(best); };
    if (search.for_devices) search.for_devices->on_leading = [session](const Leading& one) { session->improved(one.scene); };
  }
  options.on_evaluation = [&request, &run, session, budget = options.max_evaluations](const Evaluation& evaluation,
                                                                                      const OptimizeProgress& progress) {
    if (session != nullptr) session->evaluated(evaluation);
    const bool failed = (request.objective && request.objective->first_error().is_there()) ||
                        std::any_of(request.own_waveforms.begin(), request.own_waveforms.end(),
                                    [](const auto& one) { return one->first_error().is_there(); });
    if (failed) run.keep(std::make_exception_ptr(Interrupted()));
    const long planned = std::max(1L, progress.planned > 0 ? progress.planned : budget);
    run.progress().tell("search", static_cast<double>(progress.evaluations) / static_cast<double>(planned));
    if (request.callback.is_none()) return;
    run.call([&] {
      const py::object wish =
          request.callback(progress.evaluations, progress.best_cost, progress.baseline_cost, evaluation.value);
      if (!wish.is_none() && wish.cast<bool>()) run.end_by_wish();
    });
  };
  options.on_progress = [&run](const OptimizeProgress& progress) {
    run.progress().tell(fmt::format("search, {} evaluations", progress.evaluations), 0);
  };
}

// Calls work(); an error of a Python function takes precedence over the error that the library reports as a consequence.
template <class Work>
auto searched(const Request& request, InterruptibleRun& run, Work&& work) {
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

// Returns the result of a search for a waveform that is a Python function, which no file can hold: the keys of result.json
// without the waveform.
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
  return found.best && found.best_scene && std::ranges::any_of(found.best_scene->drives, [](const Drive& one) {
           return one.waveform && std::holds_alternative<Own>(*one.waveform);
         });
}

// Runs a search; the session, if it is not null, stores the search in a folder.
Outcome run_search(PlannedSearch& search, const Request& request, InterruptibleRun& running, SearchSession* session = nullptr) {
  listen(search, request, running, session);
  return searched(request, running, [&](const Progress& progress) {
    const auto report = std::make_shared<SearchReport>(run(search));
    const bool own = is_own(report->found.best());
    if (!own && !running.given_up()) add_devices(*report, search, request.command, progress);
    if (session != nullptr) session->close();
    running.throw_if_given_up();
    if (own) return outcome_of_own(report->found.best());
    add_result(*report, search, session != nullptr ? session->destination(*report) : "", {.command = request.command});
    if (session != nullptr) {
      session->add_log(*report->result.search, *report);
      session->leave(*report);
    }
    return python_outcome(json_of(report->result), verbs::files_of_report<SearchReport>(report));
  });
}

Outcome search(PyScene& scene, const Request& request) {
  InterruptibleRun running(request.on_progress);
  PlannedSearch search = planned_search(request, scene.file, running);
  return run_search(search, request, running);
}

Outcome search_in_folder(PyScene& scene, const Request& request) {
  InterruptibleRun running(request.on_progress);
  std::optional<KnownSearch> known;
  StoredSearch search = kept_search(request, scene, known, running);
  const SearchOutput output{.folder = request.out,
                            .command = request.command,
                            .claim = [&](const std::vector<std::string>& files, const std::vector<std::string>& kept) {
                              return ResultFolder(request.out, "out " + request.out, request.command, files, kept);
                            }};
  SearchSession session(search, known, output);
  return run_search(search, request, running, &session);
}

}  // namespace

void bind_search(py::module_& m) {
  m.def("optimize", [](PyScene& scene, const verbs::Arguments& arguments, const py::dict& given) {
    return in_keywords("optimize", [&] {
      const Request request{.words = verbs::optimize_request(arguments),
                            .objective = given["objective"].cast<std::shared_ptr<PythonObjective>>(),
                            .own_waveforms = given["own_waveforms"].cast<std::vector<std::shared_ptr<PythonWaveform>>>(),
                            .starts = given["starts"].cast<std::vector<py::dict>>(),
                            .callback = given["callback"],
                            .on_progress = given["progress"],
                            .command = given["command"].cast<std::string>(),
                            .out = given["out"].cast<std::string>()};
      require(!request.words.resume || !request.out.empty(), "resume: requires `out`, the folder of the search to continue");
      return request.out.empty() ? search(scene, request) : search_in_folder(scene, request);
    });
  });
}

}  // namespace softland::python
