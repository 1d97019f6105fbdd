#include "apps/front_search.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace softland::apps {
namespace {

// The same for every number of points, so that a longer search begins with the points of a shorter one.
constexpr std::size_t population = 60;

// How far a point that is not done is from one that is: NSGA-II goes towards what is nearer.
constexpr double not_done = 1, impossible = 2;

}  // namespace

KnownRows known_rows(const std::filesystem::path& store) {
  KnownRows known;
  if (!is_store(store)) return known;
  const StudyReader reader(store);
  std::size_t variables = 0;
  for (const StoredColumn& c : reader.plan().columns) variables += c.kind == ColumnKind::variable ? 1 : 0;
  reader.read([&](const StoredRow& row) {
    known.emplace(std::vector<double>(row.values.begin(), row.values.begin() + static_cast<std::ptrdiff_t>(variables)), row);
  });
  return known;
}

FrontSearch::FrontSearch(Exploration& exploration, StudyStore& store, KnownRows known, std::vector<ExploredAim> aims, int jobs,
                         bool quiet, const std::atomic<bool>* stop)
    : exploration_(exploration),
      store_(store),
      known_(std::move(known)),
      aims_(std::move(aims)),
      jobs_(jobs),
      watch_{.stop = stop},
      bar_(quiet) {}

std::int64_t FrontSearch::remaining() const {
  return static_cast<std::int64_t>(exploration_.plan().points()) - static_cast<std::int64_t>(result_.evaluations);
}

void FrontSearch::run() {
  ParetoProblem problem{.objectives = aims_.size(),
                        .evaluate = [this](std::span<const double> place) { return evaluate(place); }};
  for (const PlanVariable& v : exploration_.plan().variables()) problem.variables.push_back({.name = v.name});
  result_ = minimize_all(problem, {.population = population,
                                   .max_evaluations = static_cast<long>(exploration_.plan().points()),
                                   .seed = exploration_.plan().seed(),
                                   .jobs = jobs_,
                                   .stop = watch_.stop,
                                   .on_evaluation = [this](const ParetoEvaluation& e) { evaluated(e); }});
  bar_.close([this](double elapsed) { return state(elapsed); });
}

ParetoValue FrontSearch::value_of(const StoredRow& row) const {
  ParetoValue value{.objectives = {}, .violation = may_lead(row.status) ? 0 : row.status == infeasible ? impossible : not_done};
  for (const ExploredAim& aim : aims_) value.objectives.push_back((aim.is_largest ? -1 : 1) * row.values[aim.column]);
  for (double& objective : value.objectives) {
    if (std::isfinite(objective)) continue;
    objective = 0;
    value.violation = std::max(value.violation, not_done);
  }
  return value;
}

StoredRow FrontSearch::row_at(const std::vector<double>& values) {
  if (const auto found = known_.find(values); found != known_.end()) return found->second;
  const SceneFile scene = exploration_.plan().scene(values);
  const ContentKey content = content_key(exploration_.content(scene));
  if (auto earlier = store_.find(content)) return *std::move(earlier);
  PointRow found = exploration_.row(scene, 1, watch_);
  StoredRow row{.content = content, .status = std::move(found.status), .reason = std::move(found.reason), .values = values};
  row.values.insert(row.values.end(), found.figures.begin(), found.figures.end());
  if (!found.scene.empty()) row.extra = nlohmann::json{{"scene_toml", found.scene}, {"waveforms", found.waveforms}}.dump();
  const std::scoped_lock lock(mutex_);
  ++computed_;
  return row;
}

ParetoValue FrontSearch::evaluate(std::span<const double> place) {
  StoredRow row = row_at(exploration_.plan().values_in_box({place.begin(), place.end()}));
  ParetoValue value = value_of(row);
  const std::scoped_lock lock(mutex_);
  fresh_.emplace(std::vector<double>(place.begin(), place.end()), std::move(row));
  return value;
}

void FrontSearch::evaluated(const ParetoEvaluation& evaluation) {
  StoredRow row;
  {
    const std::scoped_lock lock(mutex_);
    const auto found = fresh_.find(evaluation.x);
    if (found == fresh_.end()) return;  // the program was asked to stop, or the point failed
    row = std::move(found->second);
    fresh_.erase(found);
    ++asked_;
  }
  row.point = evaluation.index;
  store_.add(std::move(row));
  bar_.show([this](double elapsed) { return state(elapsed); });
}

std::pair<double, std::string> FrontSearch::state(double elapsed) const {
  const auto points = static_cast<double>(exploration_.plan().points());
  return {static_cast<double>(asked_) / points, fmt::format("{} of {} points, {:.0f} s", asked_, points, elapsed)};
}

}  // namespace softland::apps
