#include "studies/search/seed_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "base/executor.h"
#include "base/progress.h"
#include "studies/devices/row_status.h"
#include "studies/search/evaluation_store.h"
#include "studies/search/robust_optimize.h"

namespace softland {
namespace {

using nlohmann::json;

// Keys and names of the columns with the outcome of each search, between the columns of figures and those of parameters.
constexpr std::array<std::pair<const char*, const char*>, 7> verdict_columns{
    {{"goal_met", "Goal met"},
     {"confirmed", "Confirmed"},
     {"better_than_plain_step", "Better than the plain step"},
     {"cost", "Cost"},
     {"plain_step_cost", "Cost of the plain step"},
     {"evaluations", "Evaluations"},
     {"closings", "Closings of devices"}}};

StoredColumn column_of(const PointFigure& figure) {
  return {.key = column_key(figure.quantity, figure.unit), .name = figure.name, .unit = figure.unit, .kind = ColumnKind::figure};
}

std::vector<Figure> figures_of(const StoredSearch& search) {
  return asked_among(all_figures, read_scene(search.scene).metrics.asked);
}

StoredPlan seed_plan(const StoredSearch& search, const std::vector<std::string>& variables) {
  StoredPlan plan{.text = search.plan.dump(1),
                  .points = static_cast<std::int64_t>(search.seeds),
                  .columns = {{.key = "seed", .name = "seed", .unit = {}, .kind = ColumnKind::variable}},
                  .seed = search.options.seed};
  for (const Figure& figure : figures_of(search)) plan.columns.push_back(column_of(figure_column(figure)));
  for (const auto& [key, name] : verdict_columns)
    plan.columns.push_back({.key = key, .name = name, .unit = {}, .kind = ColumnKind::figure});
  for (const std::string& variable : variables) plan.columns.push_back(column_of(parameter_figure(variable)));
  return plan;
}

SearchOfSeed search_of(const StoredRow& row, std::uint64_t seed, const AskedFigures& asked) {
  SearchOfSeed one{.seed = seed, .status = row.status, .termination = {}};
  std::size_t at = 1;
  one.figures.asked = asked;
  for (const Figure& figure : asked_among(all_figures, asked)) one.figures[figure] = row.values.at(at++);
  one.goal_met = row.values.at(at) == 1;
  one.confirmed = row.values.at(at + 1) == 1;
  one.better_than_baseline = row.values.at(at + 2) == 1;
  one.cost = row.values.at(at + 3);
  one.evaluations = row.values.at(at + 5);
  const json extra = json::parse(row.extra, nullptr, false);
  if (extra.is_object()) one.termination = extra.value("termination", "");
  return one;
}

ContentKey content_of(const StoredSearch& search, std::uint64_t k) {
  return content_key(plan_of_seed(search.plan, search.seed(k)).dump());
}

}  // namespace

SeedStudy::SeedStudy(const StoredSearch& search, EvaluationStore& evaluations, const std::filesystem::path& file,
                     std::vector<std::string> variables, const StoredOrigin& origin)
    : search_(search),
      evaluations_(evaluations),
      variables_(std::move(variables)),
      file_(file),
      store_(file_, seed_plan(search, variables_), origin, StudyStore::Opening::resume),
      made_(search.seeds, 0) {
  const std::vector<bool> done = store_.done();
  for (std::uint64_t k = 0; k < search.seeds; ++k) {
    if (done[k]) continue;
    std::optional<StoredRow> earlier;
    if (store_.has_earlier_plans()) earlier = store_.find(content_of(search, k));
    if (!earlier) {
      to_do_.push_back(k);
      continue;
    }
    earlier->point = static_cast<std::int64_t>(k);
    store_.add(*std::move(earlier));
  }
  store_.flush();
  done_ = search.seeds - to_do_.size();
}

void SeedStudy::run(const Listener& listener) {
  const int jobs = search_.options.jobs;
  const int inner = to_do_.size() < static_cast<std::size_t>(jobs) ? jobs : 1;
  run_tasks(
      to_do_.size(), jobs, [&](std::size_t i) { search(to_do_[i], inner, listener); }, search_.options.stop);
  store_.flush();
}

// Runs the search with seed number k. An interrupted search adds no row; its stored evaluations shorten a later run of the
// study.
void SeedStudy::search(std::uint64_t k, int jobs, const Listener& listener) {
  OptimizeOptions options = search_.options;
  const Progress progress{.stop = search_.options.stop};
  options.seed = search_.seed(k);
  options.jobs = jobs;
  options.memory = &evaluations_;
  options.on_preparation = [&](std::string_view, double) { progress.throw_if_stopped(); };
  options.on_start = {};
  const auto tell = [&] {
    if (listener.progress) listener.progress(state());
  };
  const auto show_progress = [&](const OptimizeProgress& p) {
    {
      const std::scoped_lock lock(mutex_);
      made_[k] = p.evaluations;
      step_cost_ = p.baseline_cost;
    }
    tell();
  };
  options.on_evaluation = [&](const Evaluation&, const OptimizeProgress& p) {
    evaluations_.check();
    show_progress(p);
  };
  options.on_progress = show_progress;
  options.on_improvement = [&](const Evaluation& e, const SceneFile& best) {
    const std::scoped_lock lock(mutex_);
    if (best_cost_ <= e.value) return;
    best_cost_ = e.value;
    if (listener.improvement) listener.improvement(best);
  };
  try {
    double closings = Metrics::unset;
    std::optional<OptimizeResult> found;
    if (search_.robust) {
      RobustResult result = robust_optimize(search_.scene, options, *search_.robust);
      closings = result.findings.closings;
      found.emplace(std::move(result.found));
    } else {
      found.emplace(optimize(search_.scene, options));
    }
    if (found->search.termination == Termination::interrupted || progress.stopped()) return;
    evaluations_.check();
    store_.add(row(k, *found, closings));
  } catch (const Interrupted&) {
    return;
  }
  {
    const std::scoped_lock lock(mutex_);
    ++done_;
  }
  tell();
}

StoredRow SeedStudy::row(std::uint64_t k, const OptimizeResult& result, double closings) const {
  const bool has_best = result.best_scene && result.best;
  StoredRow row{
      .point = static_cast<std::int64_t>(k),
      .content = content_of(search_, k),
      .status = !has_best || !result.is_success() ? std::string(no_success) : std::string(to_string(result.best->metrics.status)),
      .reason = !has_best              ? "no feasible waveform was found"
                : !result.is_success() ? "the search found nothing better than the plain step"
                                       : "",
      .values = {static_cast<double>(search_.seed(k))}};
  const Metrics figures = has_best ? result.best->metrics : Metrics{};
  for (const Figure& figure : figures_of(search_))
    row.values.push_back(has_best ? stored_value(figure.value(figures)) : Metrics::unset);
  const auto truth = [](bool is) { return is ? 1.0 : 0.0; };
  row.values.insert(row.values.end(),
                    {truth(result.goal_met), truth(result.confirmed), truth(result.better_than_baseline),
                     has_best ? stored_value(result.best_cost) : Metrics::unset, stored_value(result.baseline_cost),
                     static_cast<double>(result.search.evaluations), closings});
  for (const std::string& name : variables_) row.values.push_back(stored_value(result.parameter(name)));
  json extra{{"termination", to_string(result.search.termination)}};
  if (has_best) extra["scene_toml"] = result.best_scene->scene.file.text();
  row.extra = extra.dump();
  return row;
}

SeedStudy::State SeedStudy::state() const {
  const std::scoped_lock lock(mutex_);
  State now{.done = done_,
            .evaluations = std::accumulate(made_.begin(), made_.end(), 0L),
            .best_cost = best_cost_,
            .step_cost = step_cost_};
  const auto all = static_cast<double>(search_.options.max_evaluations) * static_cast<double>(search_.seeds);
  const auto there = static_cast<double>(search_.seeds - to_do_.size()) / static_cast<double>(search_.seeds);
  now.part = there + static_cast<double>(now.evaluations) / all;
  return now;
}

std::vector<SearchOfSeed> SeedStudy::searches() const {
  std::vector<SearchOfSeed> all;
  const AskedFigures asked = read_scene(search_.scene).metrics.asked;
  StudyReader(file_).read(
      [&](const StoredRow& row) { all.push_back(search_of(row, search_.seed(static_cast<std::uint64_t>(row.point)), asked)); });
  return all;
}

std::string SeedStudy::scene_of(std::uint64_t seed) const {
  std::string text;
  StudyReader(file_).read([&](const StoredRow& row) { text = json::parse(row.extra).value("scene_toml", ""); },
                          {.where = fmt::format("point = {}", seed - search_.options.seed)});
  return text;
}

}  // namespace softland
