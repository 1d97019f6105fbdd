#include "apps/seed_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "apps/stores.h"
#include "base/executor.h"
#include "base/watch.h"
#include "objectives/figures.h"
#include "reports/origin.h"
#include "reports/seeds_report.h"
#include "studies/exploration/exploration.h"

namespace softland::apps {
namespace {

using nlohmann::json;

// Columns between those of the figures and those of the parameters.
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

StoredPlan seed_plan(const KeptSearch& search, const std::vector<std::string>& variables) {
  StoredPlan plan{.text = search.plan.dump(1),
                  .points = static_cast<std::int64_t>(search.seeds),
                  .columns = {{.key = "seed", .name = "seed", .unit = {}, .kind = ColumnKind::variable}},
                  .seed = search.options.seed};
  for (const Figure& figure : all_figures) plan.columns.push_back(column_of(figure_column(figure)));
  for (const auto& [key, name] : verdict_columns)
    plan.columns.push_back({.key = key, .name = name, .unit = {}, .kind = ColumnKind::figure});
  for (const std::string& variable : variables) plan.columns.push_back(column_of(parameter_figure(variable)));
  return plan;
}

double finite(double value) { return std::isfinite(value) ? value : Metrics::unset; }

// A row as a search of the report.
ResultSeeds::Search search_of(const StoredRow& row, std::uint64_t seed) {
  ResultSeeds::Search one{.seed = seed, .status = row.status, .termination = {}};
  std::size_t at = 1;
  for (const Figure& figure : all_figures) one.figures[figure] = row.values.at(at++);
  one.goal_met = row.values.at(at) == 1;
  one.confirmed = row.values.at(at + 1) == 1;
  one.better_than_baseline = row.values.at(at + 2) == 1;
  one.cost = row.values.at(at + 3);
  one.evaluations = row.values.at(at + 5);
  const json extra = json::parse(row.extra, nullptr, false);
  if (extra.is_object()) one.termination = extra.value("termination", "");
  return one;
}

ContentKey content_of(const KeptSearch& search, std::uint64_t k) {
  return content_key(plan_of_seed(search.plan, search.seed(k)).dump());
}

}  // namespace

SeedStudy::SeedStudy(const Common& c, const KeptSearch& search, SearchPlaces& places, std::vector<std::string> variables)
    : common_(c),
      search_(search),
      places_(places),
      variables_(std::move(variables)),
      file_(places.store(seeds_file)),
      store_(file_, seed_plan(search, variables_), stored_origin(c.command), StudyStore::Opening::resume),
      log_(places.folder(), variables_),
      bar_(c.quiet),
      evaluations_(search.seeds, 0),
      best_cost_(Metrics::unset),
      step_cost_(Metrics::unset) {
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

void SeedStudy::run() {
  const int jobs = search_.options.jobs;
  const int inner = to_do_.size() < static_cast<std::size_t>(jobs) ? jobs : 1;
  run_tasks(
      to_do_.size(), jobs, [&](std::size_t i) { search(to_do_[i], inner); }, common_.stop);
  const std::scoped_lock lock(mutex_);
  bar_.close([this](double elapsed) { return state(elapsed); });
  log_.flush();
}

void SeedStudy::close() { store_.close(); }

// A search that was asked to stop before its end is no row: what it evaluated is kept, and the study goes on with it.
void SeedStudy::search(std::uint64_t k, int jobs) {
  OptimizeOptions options = search_.options;
  const Watch watch{.stop = common_.stop};
  options.seed = search_.seed(k);
  options.jobs = jobs;
  options.memory = &places_.evaluations();
  options.on_preparation = [&](std::string_view, double) { watch.throw_if_stopped(); };
  options.on_start = {};
  const auto progress = [this, k](const OptimizeProgress& p) {
    const std::scoped_lock lock(mutex_);
    evaluations_[k] = p.evaluations;
    step_cost_ = p.baseline_cost;
    show();
  };
  options.on_evaluation = [&](const Evaluation&, const OptimizeProgress& p) {
    places_.evaluations().check();
    progress(p);
  };
  options.on_progress = progress;
  options.on_improvement = [this](const Evaluation& e, const SceneFile& best) { improved(e.value, best); };
  try {
    double closings = Metrics::unset;
    std::optional<OptimizeResult> found;
    if (search_.robust) {
      RobustResult result = robust_optimize(search_.scene, options, *search_.robust);
      closings = static_cast<double>(result.closings);
      found.emplace(std::move(result.found));
    } else {
      found.emplace(optimize(search_.scene, options));
    }
    if (found->search.termination == Termination::interrupted || watch.stopped()) return;
    places_.evaluations().check();
    store_.add(row(k, *found, closings));
  } catch (const Interrupted&) {
    return;
  }
  const std::scoped_lock lock(mutex_);
  ++done_;
  show();
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
  for (const Figure& figure : all_figures) row.values.push_back(has_best ? finite(figure.value(figures)) : Metrics::unset);
  const auto truth = [](bool is) { return is ? 1.0 : 0.0; };
  row.values.insert(row.values.end(), {truth(result.goal_met), truth(result.confirmed), truth(result.better_than_baseline),
                                       has_best ? finite(result.best_cost) : Metrics::unset, finite(result.baseline_cost),
                                       static_cast<double>(result.search.evaluations), closings});
  for (const std::string& name : variables_) row.values.push_back(finite(result.parameter(name)));
  json extra{{"termination", to_string(result.search.termination)}};
  if (has_best) extra["scene_toml"] = result.best_scene->scene.file.text();
  row.extra = extra.dump();
  return row;
}

void SeedStudy::improved(double cost, const SceneFile& best) {
  const std::scoped_lock lock(mutex_);
  if (best_cost_ <= cost) return;
  best_cost_ = cost;
  log_.improved(best);
}

void SeedStudy::show() {
  bar_.show([this](double elapsed) { return state(elapsed); });
}

std::pair<double, std::string> SeedStudy::state(double elapsed) const {
  const long made = std::accumulate(evaluations_.begin(), evaluations_.end(), 0L);
  const auto all = static_cast<double>(search_.options.max_evaluations) * static_cast<double>(search_.seeds);
  const auto there = static_cast<double>(search_.seeds - to_do_.size()) / static_cast<double>(search_.seeds);
  std::string words =
      fmt::format("{} of {} seeds, {} {}", done_, search_.seeds, made, search_.robust ? "closings" : "evaluations");
  words += std::isfinite(best_cost_) ? fmt::format(", best cost {:.4f} (plain step {:.4f})", best_cost_, step_cost_)
                                     : ", no feasible waveform yet";
  return {there + static_cast<double>(made) / all, words + fmt::format(", {:.0f} s", elapsed)};
}

ResultSeeds SeedStudy::found(double significant) const {
  ResultSeeds seeds{.planned = search_.seeds};
  StudyReader(file_).read([&](const StoredRow& row) {
    seeds.searches.push_back(search_of(row, search_.seed(static_cast<std::uint64_t>(row.point))));
  });
  if (!seeds.searches.empty()) rank(seeds, search_.options.target, significant, search_.robust.has_value());
  return seeds;
}

std::string SeedStudy::best_scene(const ResultSeeds& seeds) const {
  if (seeds.searches.empty()) return {};
  const std::uint64_t point = seeds.searches[seeds.best].seed - search_.options.seed;
  std::string text;
  StudyReader(file_).read([&](const StoredRow& row) { text = json::parse(row.extra).value("scene_toml", ""); },
                          {.where = fmt::format("point = {}", point)});
  return text;
}

std::uint64_t SeedStudy::missing() const { return search_.seeds - done_; }

}  // namespace softland::apps
