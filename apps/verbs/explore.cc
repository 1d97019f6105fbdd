#include "verbs/explore.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/overview.h"
#include "apps/pace.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/stores.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "base/companion.h"
#include "base/printable.h"
#include "base/require.h"
#include "base/shell_word.h"
#include "base/write_whole.h"
#include "config/plan.h"
#include "document/quantity.h"
#include "reports/exploration_report.h"
#include "reports/origin.h"
#include "store/study_store.h"
#include "studies/exploration/exploration_runner.h"
#include "studies/exploration/front_search.h"
#include "verbs/points.h"

namespace softland::apps {
namespace {

using nlohmann::json;
using verbs::ExploreRequest;

int status_of(const Overview& found, bool interrupted) {
  if (interrupted) return exit_interrupted;
  if (found.by_status.contains(std::string(internal_fault))) return exit_internal_error;
  return found.has_figures ? exit_done : exit_no_success;
}

// Returns the plan of an exploration, which lists its points: from a scene and options, from a plan file, or from the database
// file of an earlier run.
PlanRequest plan_request(const Common& c, const ExploreRequest& r) {
  const bool of_store = is_store(c.scene);
  if (!of_store && !is_plan(SceneFile::load(c.scene)))
    return r.plan(load_scene(c), [](std::string_view option) { return "--" + std::string(option); });
  const std::map<std::string, std::string> given = r.of_plan();
  require(given.empty() && c.set.empty(), [&] {
    return fmt::format("{}: holds a complete plan: omit --{}", c.scene, given.empty() ? "set" : given.begin()->first);
  });
  return of_store ? exploration_in(StudyReader(c.scene)) : read_plan(SceneFile::load(c.scene));
}

PlanRequest completed_request(const Common& c, const ExploreRequest& r) {
  PlanRequest request = plan_request(c, r);
  complete(request, verbs::studies_of_points());
  return request;
}

// Prints the scene of one point of an exploration as a scene file for the verb `simulate`.
int print_point(const Common& c, const ExploreRequest& r) {
  const std::uint64_t k = r.point.value();
  const Plan plan(completed_request(c, r));
  require(k < plan.points(), [&] {
    return fmt::format("--point {}: must be below {}, the number of points in the plan, which are counted from 0", k,
                       plan.points());
  });
  const bool is_optimized = plan.study() == name_of(point_studies, PointStudy::optimize);
  std::optional<StoredRow> found;
  if (is_store(c.scene) && (is_optimized || plan.is_search())) {
    StudyReader(c.scene).read([&](const StoredRow& row) { found = row; }, {.where = fmt::format("point = {}", k)});
    require(found.has_value(),
            [&] { return fmt::format("--point {}: {} does not hold this point yet; compute it by --resume", k, c.scene); });
  }
  std::string text;
  if (found && is_optimized) {
    require(!found->extra.empty(), [&] {
      return fmt::format("--point {}: the search at this point found no waveform: {} ({})", k, found->reason, found->status);
    });
    text = json::parse(found->extra).at("scene_toml").get<std::string>();
  } else {
    std::vector<double> values = found ? found->values : plan.values(k);
    values.resize(plan.variables().size());
    text = plan.scene(values).text();
  }
  if (r.out.empty()) {
    print(text);
    return exit_done;
  }
  require(!is_store(r.out),
          [&] { return fmt::format("--out {}: is a store and is not replaced; name another file for the scene", r.out); });
  write_whole(r.out, text);
  if (!c.quiet) print_note(fmt::format("wrote {}: softland simulate {}", r.out, shell_word(r.out)));
  return exit_done;
}

std::pair<double, std::string> state_of(const ExplorationProgress& e, double elapsed) {
  std::string words = fmt::format("{} of {} points", whole(e.there()), whole(e.points));
  const Pace pace{
      .remaining = e.remaining(), .computed = e.computed, .reused = e.reused, .earlier = e.earlier, .seconds = e.computing};
  if (pace.computed > 0 && pace.seconds > 0) {
    words += fmt::format(", {} per s", internal::plain_number(static_cast<double>(pace.computed) / pace.seconds));
    if (pace.remaining > 0) words += fmt::format(", {} left", duration_prose(pace.seconds_left()));
  }
  return {e.points > 0 ? static_cast<double>(e.there()) / static_cast<double>(e.points) : 1,
          words + fmt::format(", {:.0f} s", elapsed)};
}

std::pair<double, std::string> state_of(const FrontFound& f, double elapsed) {
  return {static_cast<double>(f.asked) / static_cast<double>(f.points),
          fmt::format("{} of {} points, {:.0f} s", f.asked, f.points, elapsed)};
}

// Shows the progress of an exploration while it runs, and the final state at the end.
template <class State>
class ShownProgress {
 public:
  explicit ShownProgress(bool quiet) : bar_(quiet) {}
  void operator()(const State& state) {
    bar_.show([&](double elapsed) { return state_of(state, elapsed); });
  }
  void close(const State& state) {
    bar_.close([&](double elapsed) { return state_of(state, elapsed); });
  }

 private:
  Bar bar_;
};

json explored_json(const ExplorationProgress& e, const Plan& plan, const ExplorationRunnerOptions& options) {
  return {{"status", e.remaining() > 0 ? "interrupted" : "done"},
          {"plan", content_key(plan.text()).hexadecimal()},
          {"study", plan.study()},
          {"seed", plan.seed()},
          {"points", plan.points()},
          {"shard", fmt::format("{}/{}", options.shard.index, options.shard.count)},
          {"rows", {{"known", e.known}, {"computed", e.computed}, {"reused", e.reused}, {"remaining", e.remaining()}}},
          {"work", {{"wall_s", e.seconds}, {"store_s", e.waited_on_store}, {"jobs", options.jobs}}}};
}

std::string explored_text(const ExplorationProgress& e, const std::string& out) {
  std::string words = fmt::format("{} of {} points in {}: {} computed", whole(e.there()), whole(e.points), printable_line(out),
                                  whole(e.computed));
  if (e.known > 0) words += fmt::format(", {} known before", whole(e.known));
  if (e.reused > 0) words += fmt::format(", {} copied from an earlier plan", whole(e.reused));
  return words + fmt::format(", {}\n", internal::quantity(e.seconds, "s"));
}

StudyStore opened(const std::string& out, const Exploration& exploration, const Shard& shard, const Common& c, bool resume) {
  return {out, stored_plan(exploration, shard), stored_origin(c.command),
          resume ? StudyStore::Opening::resume : StudyStore::Opening::fresh};
}

// Searches the Pareto front of the figures of merit that the plan minimises or maximises; the search chooses the points one
// after another.
int search_the_front(const Common& c, const ExploreRequest& r, Exploration& exploration, const std::string& out) {
  const Plan& plan = exploration.plan();
  const std::vector<ExploredAim> aims = aims_of(exploration);
  KnownRows known = r.resume ? known_rows(out) : KnownRows{};
  StudyStore store = opened(out, exploration, {}, c, r.resume);
  if (!c.quiet) {
    print_note(fmt::format("{}: searching the Pareto front of {} with {} points ({} known), study {}; rows go to {}", c.scene,
                           plan.pareto(), whole(static_cast<std::int64_t>(plan.points())),
                           whole(static_cast<std::int64_t>(known.size())), plan.study(), out));
  }
  ShownProgress<FrontFound> progress(c.quiet);
  const FrontFound front =
      search_front(exploration, store, std::move(known), aims, {.jobs = r.jobs, .stop = c.stop, .on_point = std::ref(progress)});
  progress.close(front);
  store.close();

  const bool interrupted = front.termination == Termination::interrupted;
  const StudyReader reader(out);
  const ExplorationReport report = read_exploration(reader, {});
  const Overview found = overview_of(reader);
  json j = overview_json(reader.plan(), found);
  j.update(exploration_json(report));
  j.update({{"status", interrupted ? "interrupted" : "done"},
            {"termination", to_string(front.termination)},
            {"seed", plan.seed()},
            {"rows", {{"known", front.known}, {"computed", front.computed}}},
            {"store", out},
            {"made_with", made_with_json()}});
  print_json_or(c, j,
                terminal_text(exploration_document(report)) +
                    fmt::format("\n{} computed. To print the scene of a point: softland explore {} --point K\n"
                                "To write the report page: softland report {}\n",
                                whole(front.computed), shell_word(out), shell_word(out)));
  return status_of(found, interrupted);
}

}  // namespace

int run_explore(const Common& c, const verbs::Arguments& arguments) {
  const ExploreRequest r = verbs::explore_request(arguments);
  if (r.point) return print_point(c, r);
  const bool goes_on = is_store(c.scene);
  const Shard shard = goes_on && r.shard.empty() ? StudyReader(c.scene).plan().shard : r.part();
  const Plan plan(completed_request(c, r));
  require(!goes_on || (r.resume && r.out.empty()),
          [&] { return fmt::format("{}: is a store: give --resume to continue it, and omit --out", c.scene); });
  const std::string out = goes_on ? c.scene : r.out.empty() ? "softland-out.sqlite" : r.out;
  static_cast<void>(reserve_outputs(c, {}));
  require(c.json.empty() || std::filesystem::weakly_canonical(c.json) != std::filesystem::weakly_canonical(out),
          [&] { return fmt::format("--json {}: is the store itself; name another file", c.json); });
  require(c.json.empty() || !is_companion(c.json, out),
          [&] { return fmt::format("--json {}: is a companion file of the store {}; name another file", c.json, out); });
  std::optional<ShownWork> work(std::in_place, c.quiet, c.stop);
  Exploration exploration = exploration_for(plan, out, work->progress(), verbs::studies_of_points());
  work.reset();

  require_part(exploration, shard);
  if (r.resume && !c.quiet) tell_of_other_programs(out);
  if (exploration.plan().is_search()) return search_the_front(c, r, exploration, out);
  StudyStore store = opened(out, exploration, shard, c, r.resume);
  ShownProgress<ExplorationProgress> progress(c.quiet);
  const ExplorationRunnerOptions options{.shard = shard, .jobs = r.jobs, .stop = c.stop, .on_point = std::ref(progress)};
  ExplorationRunner runner(exploration, store, options);
  if (!c.quiet) {
    const ExplorationProgress before = runner.progress();
    print_note(fmt::format("{}: {} of {} points to explore, study {}; rows go to {}", c.scene, whole(before.remaining()),
                           whole(before.points), exploration.plan().study(), out));
  }
  runner.run();
  const ExplorationProgress e = runner.progress();
  progress.close(e);
  store.close();

  const StudyReader reader(out);
  const Overview found = overview_of(reader);
  json j = overview_json(reader.plan(), found);
  j.update(explored_json(e, exploration.plan(), options));
  j.update({{"store", out}});
  print_json_or(c, with_origin(std::move(j), c.command), explored_text(e, out) + overview_text(reader.plan(), found));
  return status_of(found, e.remaining() > 0);
}

}  // namespace softland::apps
