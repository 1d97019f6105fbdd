// Searches for waveforms under Python.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "config/aim.h"
#include "config/assumed_spread.h"
#include "config/criterion.h"
#include "python/own.h"
#include "python/scene.h"
#include "reports/files.h"
#include "reports/html.h"
#include "reports/result_json.h"
#include "reports/result_maker.h"
#include "reports/robustness_report.h"
#include "reports/svg.h"
#include "studies/for_devices.h"
#include "studies/optimize.h"
#include "studies/robust_optimize.h"
#include "waveforms/export.h"

namespace softland::python {

namespace py = pybind11;

namespace {

// What a search is asked for, as Python has it; what is not given is as in the program.
struct Request {
  std::string target = "bounce", actuator = "electrostatic", waveform, robust = "auto";
  std::shared_ptr<PythonObjective> objective;
  std::vector<std::shared_ptr<PythonWaveform>> own_waveforms;
  std::vector<std::string> conditions;
  std::vector<py::dict> starts;
  std::optional<long> budget;
  std::optional<std::uint64_t> samples;
  std::uint64_t seed = 1;
  int jobs = 1;
  py::object callback, progress;
  std::string command;
};

std::vector<Criterion> conditions_of(const Request& request, std::span<const Figure> figures) {
  std::vector<Criterion> all;
  for (const std::string& text : request.conditions) all.push_back(parse_criterion(text, figures));
  return all;
}

OptimizeOptions options_of(const Request& request, const SceneFile& file, Run& run) {
  const Named<Actuator>* actuator = find_named(actuators, request.actuator);
  require(actuator != nullptr, [&] { return fmt::format("actuator {}: must be {}", request.actuator, listed(actuators)); });
  const Aim aim = request.objective ? Aim(request.objective) : parse_aim(request.target);
  OptimizeOptions options = usual_options(file, aim, actuator->value);
  if (!request.waveform.empty()) options.family = request.waveform;
  options.own_waveforms.assign(request.own_waveforms.begin(), request.own_waveforms.end());
  options.seed = request.seed;
  options.jobs = request.jobs;
  options.stop = run.stop();
  if (request.budget) {
    require(*request.budget >= 1, "budget: must be at least 1");
    options.max_evaluations = *request.budget;
    options.more_evaluations = 0;
  }
  for (const py::dict& start : request.starts) {
    options.starts.push_back({.name = fmt::format("start {}", options.starts.size() + 1), .waveforms = waveforms_of(start, run)});
  }
  return options;
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

std::map<std::string, std::function<std::string()>> files_of(const Result& result, const OptimizeResult& found) {
  const auto kept = std::make_shared<const Result>(result);
  std::map<std::string, std::function<std::string()>> files{{"result.json", [kept] { return json_text(result_json(*kept)); }},
                                                            {"report.html", [kept] { return html_report(*kept); }},
                                                            {"gap.svg", [kept] { return svg_gap_chart(*kept); }}};
  if (kept->best.figures) files["trajectory.csv"] = [kept] { return trajectory_csv(kept->best.curve); };
  if (found.best_scene) {
    const auto scene = std::make_shared<const PreparedScene>(*found.best_scene);
    files["best.toml"] = [scene] { return scene->scene.file.text(); };
  }
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
Outcome outcome_of(const Result* result, const OptimizeResult& found) {
  if (result != nullptr) return {.json = json_text(result_json(*result)), .files = files_of(*result, found)};
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
  Run run(request.progress);
  SceneFile file = scene.file;
  if (request.robust == "none") {
    OptimizeOptions options = options_of(request, file, run);
    options.conditions = conditions_of(request, conditioned_figures);
    options.begins_with_half = request.budget.has_value();  // as the program does
    listen(options, request, run);
    return searched(request, run, [&](const Watch&) {
      const OptimizeResult found = optimize(file, options);
      run.throw_if_given_up();
      if (is_own(found)) return outcome_of(nullptr, found);
      const Result result = result_of(found, options, {.command = request.command});
      return outcome_of(&result, found);
    });
  }
  assume_spread(file);
  if (request.robust == "auto") {
    require(
        request.own_waveforms.empty(),
        "own_waveforms: a search for devices works on scene files, which cannot hold one: ask for robust=\"none\" or a measure");
    OptimizeOptions options = options_of(request, scene.file, run);
    ForDevicesOptions devices{.conditions = conditions_of(request, device_figures), .families = request.waveform};
    if (request.samples) devices.verdict = *request.samples;
    if (request.budget) share_budget(options, devices);
    listen(options, request, run);
    return searched(request, run, [&](const Watch&) {
      const auto found = std::make_shared<const ForDevicesResult>(optimize_for_devices(scene.file, options, devices));
      run.throw_if_given_up();
      const Result result = result_of(*found, options, "", {.command = request.command});
      Outcome outcome{.json = json_text(result_json(result)), .files = files_of(result, found->best)};
      if (found->drawing.best_scene)
        outcome.files["drawing.toml"] = [found] { return found->drawing.best_scene->scene.file.text(); };
      if (found->calibrated) outcome.files["calibrated.toml"] = [found] { return found->calibrated->text(); };
      return outcome;
    });
  }
  RobustOptions robust{.aim = {.measure = parse_robust_measure(request.robust, device_figures),
                               .conditions = conditions_of(request, device_figures)}};
  if (request.samples) robust.samples = *request.samples;
  OptimizeOptions options = options_of(request, file, run);
  if (!request.budget) options.max_evaluations = default_closings;
  options.more_evaluations = 0;
  if (request.waveform.empty())
    options.family = read_scene(file).calibration.is_empty() ? default_robust_family : default_calibrated_family;
  listen(options, request, run);
  return searched(request, run, [&](const Watch&) {
    const RobustResult found = robust_optimize(file, options, robust);
    run.throw_if_given_up();
    if (is_own(found.found)) return outcome_of(nullptr, found.found);
    const Result result = result_of(found, options, robust, {.command = request.command});
    return outcome_of(&result, found.found);
  });
}

}  // namespace

void bind_search(py::module_& m) {
  m.def("optimize", [](PyScene& scene, const py::dict& given) {
    const auto text = [&](const char* key) { return given[key].cast<std::string>(); };
    Request request{.target = text("target"),
                    .actuator = text("actuator"),
                    .waveform = text("waveform"),
                    .robust = text("robust"),
                    .objective = given["objective"].cast<std::shared_ptr<PythonObjective>>(),
                    .own_waveforms = given["own_waveforms"].cast<std::vector<std::shared_ptr<PythonWaveform>>>(),
                    .conditions = given["constrain"].cast<std::vector<std::string>>(),
                    .starts = given["starts"].cast<std::vector<py::dict>>(),
                    .budget = given["budget"].cast<std::optional<long>>(),
                    .samples = given["samples"].cast<std::optional<std::uint64_t>>(),
                    .seed = given["seed"].cast<std::uint64_t>(),
                    .jobs = given["jobs"].cast<int>(),
                    .callback = given["callback"],
                    .progress = given["progress"],
                    .command = text("command")};
    return search(scene, request);
  });
}

}  // namespace softland::python
