#include "studies/exploration/exploration_runner.h"

#include <cstddef>
#include <utility>

#include "base/executor.h"

namespace softland {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

ExplorationRunner::ExplorationRunner(Exploration& exploration, StudyStore& store, const ExplorationRunnerOptions& options)
    : exploration_(exploration),
      store_(store),
      options_(options),
      done_(store.done()),
      reuses_(store.has_earlier_plans()),
      progress_{.stop = options.stop} {
  told_.points = options.shard.size(static_cast<std::int64_t>(exploration.plan().points()));
  told_.earlier = store.earlier_rows();
  for (std::int64_t i = 0; i < told_.points; ++i) told_.known += done_[static_cast<std::size_t>(point(i))] ? 1 : 0;
}

void ExplorationRunner::run() {
  const std::int64_t missing = told_.remaining();
  if (missing > 0)  // with fewer points than threads, several threads work on one point
    inner_jobs_ = missing < options_.jobs ? options_.jobs : 1;
  run_tasks(
      static_cast<std::size_t>(told_.points), options_.jobs, [this](std::size_t i) { take(point(static_cast<std::int64_t>(i))); },
      progress_.stop);
}

ExplorationProgress ExplorationRunner::progress() const {
  const std::scoped_lock lock(mutex_);
  return so_far();
}

ExplorationProgress ExplorationRunner::so_far() const {
  ExplorationProgress all = told_;
  all.seconds = seconds_since(begin_);
  all.computing = first_computed_ ? seconds_since(*first_computed_) : 0;
  all.waited_on_store = store_seconds_;
  return all;
}

template <class Work>
auto ExplorationRunner::timed(Work&& work) {
  const Clock::time_point begin = Clock::now();
  auto result = work();
  store_seconds_ += seconds_since(begin);
  return result;
}

void ExplorationRunner::note_first() {
  const std::scoped_lock lock(mutex_);
  if (!first_computed_) first_computed_ = Clock::now();
}

void ExplorationRunner::take(std::int64_t k) {
  if (done_[static_cast<std::size_t>(k)]) return;
  const Plan& plan = exploration_.plan();
  std::vector<double> values = plan.values(static_cast<std::uint64_t>(k));
  const SceneFile scene = plan.scene(values);
  const ContentKey content = content_key(exploration_.content(scene));
  std::optional<StoredRow> row;
  if (reuses_) row = timed([&] { return store_.find(content); });
  const bool is_reused = row.has_value();
  if (is_reused) {
    row->point = k;
    std::ranges::copy(values, row->values.begin());
  } else {
    note_first();
    try {
      row = stored_row(k, content, std::move(values), exploration_.row(scene, inner_jobs_, progress_));
    } catch (const Interrupted&) {
      return;  // a requested stop ends the loop over the points
    }
  }
  timed([&] { return store_.add(*std::move(row)), 0; });
  const std::scoped_lock lock(mutex_);
  ++(is_reused ? told_.reused : told_.computed);
  if (options_.on_point) options_.on_point(so_far());
}

}  // namespace softland
