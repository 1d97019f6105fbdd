#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/exit_status.h"
#include "apps/explore_request.h"
#include "apps/output.h"
#include "apps/overview.h"
#include "apps/pace.h"
#include "apps/progress.h"
#include "apps/stores.h"
#include "apps/streams.h"
#include "apps/values.h"
#include "apps/verbs/verbs.h"
#include "base/companion.h"
#include "base/printable.h"
#include "base/require.h"
#include "base/shell_word.h"
#include "config/plan.h"
#include "reports/exploration_report.h"
#include "reports/explored.h"
#include "reports/files.h"
#include "reports/made_with.h"
#include "reports/origin.h"
#include "reports/quantity.h"
#include "store/study_store.h"
#include "studies/exploration/exploring.h"
#include "studies/exploration/front_search.h"
#include "verbs/points.h"

namespace softland::apps {
namespace {

using nlohmann::json;

int status_of(const Overview& found, bool interrupted) {
  if (interrupted) return exit_interrupted;
  if (found.by_status.contains(std::string(internal_fault))) return exit_internal_error;
  return found.has_figures ? exit_done : exit_no_success;
}

// The scene of one point, as `simulate` takes it.
int print_point(const Common& c, const ExploreRequest& r) {
  const auto k = whole_number<std::uint64_t>("--point", r.point.value(), 0);
  PlanRequest request = plan_request(c, r);
  complete(request, verbs::studies_of_points());
  const Plan plan(request);
  require(k < plan.points(), [&] { return fmt::format("--point {}: the plan has {} points, counted from 0", k, plan.points()); });
  const bool is_optimized = plan.study() == name_of(point_studies, PointStudy::optimize);
  std::optional<StoredRow> found;
  if (is_store(c.scene) && (is_optimized || plan.is_search())) {
    StudyReader(c.scene).read([&](const StoredRow& row) { found = row; }, {.where = fmt::format("point = {}", k)});
    require(found.has_value(), [&] { return fmt::format("--point {}: {} does not hold it yet", k, c.scene); });
  }
  std::string text;
  if (found && is_optimized) {
    require(!found->extra.empty(),
            [&] { return fmt::format("--point {}: its search found no waveform: {} ({})", k, found->reason, found->status); });
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
  require(!is_store(r.out), [&] { return fmt::format("--out {}: is a store; name another file for the scene", r.out); });
  write_whole(r.out, text);
  if (!c.quiet) say(fmt::format("wrote {}: softland simulate {}", r.out, shell_word(r.out)));
  return exit_done;
}

std::pair<double, std::string> state_of(const Explored& e, double elapsed) {
  std::string words = fmt::format("{} of {} points", whole(e.there()), whole(e.points));
  const Pace pace{
      .remaining = e.remaining(), .computed = e.computed, .reused = e.reused, .earlier = e.earlier, .seconds = e.computing};
  if (pace.computed > 0 && pace.seconds > 0) {
    words += fmt::format(", {} per s", internal::plain_number(static_cast<double>(pace.computed) / pace.seconds));
    if (pace.remaining > 0) words += fmt::format(", {} left", duration_words(pace.seconds_left()));
  }
  return {e.points > 0 ? static_cast<double>(e.there()) / static_cast<double>(e.points) : 1,
          words + fmt::format(", {:.0f} s", elapsed)};
}

std::pair<double, std::string> state_of(const FrontFound& f, double elapsed) {
  return {static_cast<double>(f.asked) / static_cast<double>(f.points),
          fmt::format("{} of {} points, {:.0f} s", f.asked, f.points, elapsed)};
}

// Shows how far the work is, at last where it has ended.
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

json explored_json(const Explored& e, const Plan& plan, const ExploringOptions& options) {
  return {{"status", e.remaining() > 0 ? "interrupted" : "done"},
          {"plan", content_key(plan.text()).hexadecimal()},
          {"study", plan.study()},
          {"seed", plan.seed()},
          {"points", plan.points()},
          {"shard", fmt::format("{}/{}", options.shard.index, options.shard.count)},
          {"rows", {{"known", e.known}, {"computed", e.computed}, {"reused", e.reused}, {"remaining", e.remaining()}}},
          {"work", {{"wall_s", e.seconds}, {"store_s", e.waited_on_store}, {"jobs", options.jobs}}}};
}

std::string explored_text(const Explored& e, const std::string& out) {
  std::string words = fmt::format("{} of {} points in {}: {} computed", whole(e.there()), whole(e.points), printable_line(out),
                                  whole(e.computed));
  if (e.known > 0) words += fmt::format(", {} were there", whole(e.known));
  if (e.reused > 0) words += fmt::format(", {} taken over from an earlier plan", whole(e.reused));
  return words + fmt::format(", {}\n", internal::quantity(e.seconds, "s"));
}

StudyStore opened(const std::string& out, const Exploration& exploration, const Shard& shard, const Common& c, bool resume) {
  return {out, stored_plan(exploration, shard), stored_origin(c.command),
          resume ? StudyStore::Opening::resume : StudyStore::Opening::fresh};
}

// A search for a front, whose points are known only as it goes.
int search_the_front(const Common& c, const ExploreRequest& r, Exploration& exploration, const std::string& out) {
  const Plan& plan = exploration.plan();
  const std::vector<ExploredAim> aims = aims_of(exploration);
  KnownRows known = r.resume ? known_rows(out) : KnownRows{};
  StudyStore store = opened(out, exploration, {}, c, r.resume);
  if (!c.quiet) {
    say(fmt::format("{}: searching the front of {} with {} points, {} of them known, study {}; rows go to {}", c.scene,
                    plan.pareto(), whole(static_cast<std::int64_t>(plan.points())),
                    whole(static_cast<std::int64_t>(known.size())), plan.study(), out));
  }
  ShownProgress<FrontFound> progress(c.quiet);
  const FrontFound front = search_front(exploration, store, std::move(known), aims,
                                        {.jobs = job_count(r.jobs), .stop = c.stop, .on_point = std::ref(progress)});
  progress.close(front);
  store.close();

  const bool interrupted = front.termination == Termination::interrupted;
  const StudyReader reader(out);
  const ExplorationReport report = explored(reader, {});
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
                    fmt::format("\n{} computed. The scene of a point: softland explore {} --point K\n"
                                "The page: softland report {}\n",
                                whole(front.computed), shell_word(out), shell_word(out)));
  return status_of(found, interrupted);
}

int explore_verb(const Common& c, const ExploreRequest& r) {
  if (r.point) return print_point(c, r);
  const int jobs = job_count(r.jobs);
  const bool goes_on = is_store(c.scene);
  const Shard shard = shard_of(r, goes_on ? c.scene : std::string());
  PlanRequest request = plan_request(c, r);
  complete(request, verbs::studies_of_points());
  require(!goes_on || (r.resume && r.out.empty()),
          [&] { return fmt::format("{}: is a store already: --resume goes on with it, and --out is not for that", c.scene); });
  const std::string out = goes_on ? c.scene : r.out.empty() ? "softland-out.sqlite" : r.out;
  static_cast<void>(claim_places(c, {}));
  require(c.json.empty() || std::filesystem::weakly_canonical(c.json) != std::filesystem::weakly_canonical(out),
          [&] { return fmt::format("--json {}: is the store; name another file", c.json); });
  require(c.json.empty() || !is_companion(c.json, out),
          [&] { return fmt::format("--json {}: is a file that the store {} has beside it; name another", c.json, out); });
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  Exploration exploration(Plan(request), work->watch(), verbs::studies_of_points());
  work.reset();

  require_part(exploration, shard);
  if (r.resume && !c.quiet) tell_of_other_programs(out);
  if (exploration.plan().is_search()) return search_the_front(c, r, exploration, out);
  StudyStore store = opened(out, exploration, shard, c, r.resume);
  ShownProgress<Explored> progress(c.quiet);
  const ExploringOptions options{.shard = shard, .jobs = jobs, .stop = c.stop, .on_point = std::ref(progress)};
  Exploring exploring(exploration, store, options);
  if (!c.quiet) {
    const Explored before = exploring.explored();
    say(fmt::format("{}: {} of {} points to explore, study {}; rows go to {}", c.scene, whole(before.remaining()),
                    whole(before.points), exploration.plan().study(), out));
  }
  exploring.run();
  const Explored e = exploring.explored();
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

}  // namespace

namespace {

// "simulate (default), pull-in, ... or release"
std::string studies_listed() {
  std::vector<std::string> names;
  for (const std::string_view name : names_of(point_studies)) names.emplace_back(name);
  for (const OtherStudy& one : verbs::studies_of_points()) names.push_back(one.name);
  return first_is_default(in_words(names, " or "));
}

}  // namespace

void add_explore(Verb& verb) {
  const auto request = std::make_shared<ExploreRequest>();
  verb.with_scene();
  verb.repeated("--vary", request->vary, "KEY=VALUES",
                "what varies: KEY=LOW:HIGH:N, with :log in equal ratios, or KEY=A,B,C; KEY*KEY=... by one factor; KEY[2] is an "
                "element of a list; may be repeated: all combinations");
  verb.option("--sample", request->sample, "SET", "sobol:N or lhs:N points in the box of --vary KEY=LOW:HIGH");
  verb.option(
      "--pareto", request->pareto, "FIGURES",
      "search the points that no other one beats in all of these figures, \"initial_contact_time,impact_velocity\", in the box "
      "of --vary KEY=LOW:HIGH by NSGA-II; max:FIGURE is to be large; --sample nsga2:N for N points (default: 2000)");
  verb.option("--list", request->list, "FILE", "points of a CSV file, whose header names keys with units: structure.length [um]");
  verb.option("--study", request->study, "NAME", "study at every point: " + studies_listed());
  verb.repeated("--option", request->options, "NAME=VALUE",
                "option of the study, as its verb has it, where explore has none: \"impact-velocity=1 mm/s\"; may be repeated");
  verb.flag("--certify", request->certify, "simulate: the errors of the figures too");
  verb.with_samples(request->samples, "robustness: devices (default: 500)");
  verb.option("--target", request->target, "NAME", "optimize: as there");
  verb.option("--actuator", request->actuator, "NAME", "optimize: as there");
  verb.option("--waveform", request->waveform, "NAME", "optimize: as there");
  verb.option("--optimizer", request->optimizer, "NAME", "optimize: as there");
  verb.optional("--budget", request->budget, "N", "optimize: evaluations of every search (default: as there)");
  verb.option("--out", request->out, "FILE", "store for the rows (default: softland-out.sqlite); with --point the scene");
  verb.flag("--resume", request->resume,
            "go on with a store: points that it holds are not computed again, nor, of another plan, those of the same content");
  verb.option("--shard", request->shard, "I/N", "part I of N of the points, for as many stores, which softland merge makes one");
  verb.optional("--point", request->point, "K", "print the scene of point K, as simulate takes it, instead of exploring");
  verb.with_seed(request->seed, "same rows, whatever --jobs is");
  verb.with_jobs(request->jobs, "threads (default: one per core)");
  verb.with_json();
  verb.footer(
      "SCENE is a scene, a plan file (docs/explore.md), or with --resume or --point a store, which holds its plan.\n"
      "Ctrl-C ends a run with what there is; --resume goes on, after a power cut too.\n"
      "Examples:\n  softland explore scenes/mem-gold.toml --vary \"structure.length=245 um:275 um:7\" --vary \"gap.contact=1.6 "
      "um:2.4 um:20\"\n"
      "  softland explore scenes/mem-gold.toml --vary \"waveform.main.level=1.05 Vdp:1.6 Vdp:40\" --out level.sqlite\n"
      "  softland explore scenes/mem-gold.toml --vary \"gap.electrode*gap.contact=0.9:1.1\" --sample sobol:256 --study "
      "robustness\n"
      "  softland explore scenes/mem-gold.toml --vary \"gap.contact=1.6 um:2.4 um\" --vary \"waveform.main.level=1.05 Vdp:1.6 "
      "Vdp\" --pareto initial_contact_time,impact_velocity,peak_voltage\n"
      "  softland explore softland-out.sqlite --resume\n"
      "  softland explore softland-out.sqlite --point 17 --out point17.toml");
  verb.runs([request](const Common& common) { return explore_verb(common, *request); });
}

}  // namespace softland::apps
