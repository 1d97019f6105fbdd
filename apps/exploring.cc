#include "apps/exploring.h"

#include <fmt/format.h>

#include <optional>

#include "apps/pace.h"
#include "apps/stores.h"
#include "base/executor.h"
#include "base/printable.h"
#include "reports/quantity.h"

namespace softland::apps {
namespace {

using internal::quantity;
using nlohmann::json;

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

Exploring::Exploring(Exploration& exploration, StudyStore& store, const Shard& shard, const Common& c, int jobs)
    : exploration_(exploration),
      store_(store),
      shard_(shard),
      done_(store.done()),
      reuses_(store.has_earlier_plans()),
      jobs_(jobs),
      watch_{.stop = c.stop},
      bar_(c.quiet),
      earlier_(store.earlier_rows()) {
  for (std::int64_t i = 0; i < of_shard(); ++i) known_ += done_[static_cast<std::size_t>(point(i))] ? 1 : 0;
}

std::int64_t Exploring::of_shard() const { return shard_.size(static_cast<std::int64_t>(exploration_.plan().points())); }

void Exploring::run() {
  const std::int64_t missing = remaining();
  if (missing > 0)  // one that has too few points for the threads has more of them for each
    inner_jobs_ = missing < jobs_ ? jobs_ : 1;
  run_tasks(
      static_cast<std::size_t>(of_shard()), jobs_, [this](std::size_t i) { take(point(static_cast<std::int64_t>(i))); },
      watch_.stop);
  bar_.close([this](double elapsed) { return state(elapsed); });
  seconds_ = seconds_since(begin_);
}

json Exploring::data() const {
  const Plan& plan = exploration_.plan();
  return {{"status", remaining() > 0 ? "interrupted" : "done"},
          {"plan", content_key(plan.text()).hexadecimal()},
          {"study", plan.study()},
          {"seed", plan.seed()},
          {"points", plan.points()},
          {"shard", fmt::format("{}/{}", shard_.index, shard_.count)},
          {"rows", {{"known", known_}, {"computed", computed_.load()}, {"reused", reused_.load()}, {"remaining", remaining()}}},
          {"work", {{"wall_s", seconds_}, {"store_s", store_seconds_.load()}, {"jobs", jobs_}}}};
}

std::string Exploring::text(const std::string& out) const {
  std::string words = fmt::format("{} of {} points in {}: {} computed", whole(of_shard() - remaining()), whole(of_shard()),
                                  printable_line(out), whole(computed_));
  if (known_ > 0) words += fmt::format(", {} were there", whole(known_));
  if (reused_ > 0) words += fmt::format(", {} taken over from an earlier plan", whole(reused_));
  return words + fmt::format(", {}\n", quantity(seconds_, "s"));
}

template <class Work>
auto Exploring::timed(Work&& work) {
  const Clock::time_point begin = Clock::now();
  auto result = work();
  store_seconds_ += seconds_since(begin);
  return result;
}

void Exploring::note_first() {
  const std::scoped_lock lock(mutex_);
  if (!first_computed_) first_computed_ = Clock::now();
}

void Exploring::take(std::int64_t k) {
  if (done_[static_cast<std::size_t>(k)]) return;
  const Plan& plan = exploration_.plan();
  StoredRow row{.point = k, .content = {}, .status = {}, .reason = {}, .values = {}, .extra = {}};
  std::vector<double> values = plan.values(static_cast<std::uint64_t>(k));
  const SceneFile scene = plan.scene(values);
  row.content = content_key(exploration_.content(scene));
  std::optional<StoredRow> earlier;
  if (reuses_) earlier = timed([&] { return store_.find(row.content); });
  if (earlier) {
    row.status = std::move(earlier->status);
    row.reason = std::move(earlier->reason);
    row.extra = std::move(earlier->extra);
    values.insert(values.end(), earlier->values.begin() + static_cast<std::ptrdiff_t>(values.size()), earlier->values.end());
  } else {
    note_first();
    PointRow found;
    try {
      found = exploration_.row(scene, inner_jobs_, watch_);
    } catch (const Interrupted&) {
      return;  // the loop ends by itself
    }
    row.status = std::move(found.status);
    row.reason = std::move(found.reason);
    if (!found.scene.empty()) row.extra = json{{"scene_toml", found.scene}, {"waveforms", found.waveforms}}.dump();
    values.insert(values.end(), found.figures.begin(), found.figures.end());
  }
  row.values = std::move(values);
  timed([&] { return store_.add(std::move(row)), 0; });
  const std::scoped_lock lock(mutex_);
  ++(earlier ? reused_ : computed_);
  bar_.show([this](double elapsed) { return state(elapsed); });
}

std::pair<double, std::string> Exploring::state(double elapsed) const {
  const std::int64_t all = of_shard(), there = all - remaining();
  std::string words = fmt::format("{} of {} points", whole(there), whole(all));
  const Pace pace{.remaining = remaining(),
                  .computed = computed_,
                  .reused = reused_,
                  .earlier = earlier_,
                  .seconds = first_computed_ ? seconds_since(*first_computed_) : 0};
  if (pace.computed > 0 && pace.seconds > 0) {
    words += fmt::format(", {} per s", internal::plain_number(static_cast<double>(pace.computed) / pace.seconds));
    if (pace.remaining > 0) words += fmt::format(", {} left", duration_words(pace.seconds_left()));
  }
  return {all > 0 ? static_cast<double>(there) / static_cast<double>(all) : 1, words + fmt::format(", {:.0f} s", elapsed)};
}

}  // namespace softland::apps
