#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/exit_status.h"
#include "apps/explored.h"
#include "apps/front_search.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/shell_word.h"
#include "apps/stores.h"
#include "apps/streams.h"
#include "apps/values.h"
#include "apps/verbs/verbs.h"
#include "base/executor.h"
#include "base/printable.h"
#include "base/require.h"
#include "base/shortened.h"
#include "config/plan.h"
#include "reports/exploration_report.h"
#include "reports/files.h"
#include "reports/made_with.h"
#include "reports/quantity.h"
#include "reports/text.h"
#include "store/study_store.h"
#include "studies/exploration.h"
#include "version.h"

namespace softland::apps {
namespace {

using internal::left_aligned;
using internal::quantity;
using internal::right_aligned;
using nlohmann::json;

struct ExploreRequest {
  std::vector<std::string> vary;
  std::string sample, pareto, list, study, target, actuator, waveform, optimizer, shard;
  std::string out;
  std::optional<std::string> samples, budget, seed, jobs, point;
  bool certify = false, resume = false;

  /// What belongs to a plan, by the name of its option.
  [[nodiscard]] std::map<std::string, std::string> of_plan() const {
    std::map<std::string, std::string> given;
    const auto add = [&](const char* name, const std::string& value) {
      if (!value.empty()) given.emplace(name, value);
    };
    if (!vary.empty()) given.emplace("vary", vary.front());
    add("sample", sample);
    add("pareto", pareto);
    add("list", list);
    add("study", study);
    add("target", target);
    add("actuator", actuator);
    add("waveform", waveform);
    add("optimizer", optimizer);
    if (samples) given.emplace("samples", *samples);
    if (budget) given.emplace("budget", *budget);
    if (seed) given.emplace("seed", *seed);
    if (certify) given.emplace("certify", "true");
    return given;
  }
};

// The plan in the words of the options.
PlanRequest plan_of_options(const Common& c, const ExploreRequest& r) {
  PlanRequest plan{.scene = load_scene(c), .vary = r.vary, .sample = r.sample, .pareto = r.pareto};
  if (!r.pareto.empty() && r.sample.empty()) plan.sample = "nsga2:2000";
  const std::map<std::string, std::string> given = r.of_plan();
  plan.place = [given, vary = r.vary](std::string_view key, std::size_t number) {
    const auto found = given.find(std::string(key));
    const std::string value = key == "vary" && number < vary.size() ? vary[number] : found == given.end() ? "" : found->second;
    return key == "certify" ? std::string("--certify") : fmt::format("--{} {}", key, shortened(printable_line(shown(value))));
  };
  if (!r.study.empty()) plan.study = r.study;
  for (const std::string_view name : plan_options) {
    if (const auto value = given.find(std::string(name)); value != given.end()) plan.options[value->first] = value->second;
  }
  plan.seed = seed_of(r.seed, plan.seed);
  if (!r.list.empty()) {
    require(r.vary.empty() && plan.sample.empty(), [&] {
      return fmt::format("--list {}: gives the points: --vary and --sample are not for it, nor is --pareto", r.list);
    });
    read_list(plan, r.list);
  }
  require(!plan.vary.empty() || !plan.columns.empty(),
          "nothing varies: give --vary KEY=LOW:HIGH:N, --sample with --vary KEY=LOW:HIGH, --list FILE.csv, or a plan file");
  return plan;
}

// Of a scene and options, of a plan file, or of a store that is gone on with.
PlanRequest plan_request(const Common& c, const ExploreRequest& r) {
  const bool of_store = is_store(c.scene);
  if (!of_store && !is_plan(SceneFile::load(c.scene))) return plan_of_options(c, r);
  const std::map<std::string, std::string> given = r.of_plan();
  require(given.empty() && c.set.empty(), [&] {
    return fmt::format("{}: holds the whole plan: --{} is not for it", c.scene, given.empty() ? "set" : given.begin()->first);
  });
  if (!of_store) return read_plan(SceneFile::load(c.scene));
  return read_plan(SceneFile::parse(StudyReader(c.scene).plan().text, c.scene + " (plan)"));
}

StoredPlan stored_plan(const Exploration& exploration, const Shard& shard) {
  const Plan& plan = exploration.plan();
  StoredPlan stored{.text = plan.text(),
                    .points = static_cast<std::int64_t>(plan.points()),
                    .columns = {},
                    .seed = plan.seed(),
                    .shard = shard};
  for (const PlanVariable& v : plan.variables())
    stored.columns.push_back(
        {.key = column_key(v.name, v.unit()), .name = v.name, .unit = v.unit(), .kind = ColumnKind::variable});
  for (const PointFigure& f : exploration.figures())
    stored.columns.push_back({.key = column_key(f.quantity, f.unit), .name = f.name, .unit = f.unit, .kind = ColumnKind::figure});
  return stored;
}

std::string whole(std::int64_t count) { return internal::whole(static_cast<double>(count)); }

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// The points of a part of a plan on their way into its store.
class Exploring {
 public:
  Exploring(Exploration& exploration, StudyStore& store, const Shard& shard, const Common& c, int jobs)
      : exploration_(exploration),
        store_(store),
        shard_(shard),
        done_(store.done()),
        reuses_(store.has_earlier_plans()),
        jobs_(jobs),
        watch_{.stop = c.stop},
        bar_(c.quiet) {
    for (std::int64_t i = 0; i < of_shard(); ++i) known_ += done_[static_cast<std::size_t>(point(i))] ? 1 : 0;
  }

  /// How many points the part has, and how many of them the store still lacks.
  [[nodiscard]] std::int64_t of_shard() const { return shard_.size(static_cast<std::int64_t>(exploration_.plan().points())); }
  [[nodiscard]] std::int64_t remaining() const { return of_shard() - known_ - computed_ - reused_; }

  void run() {
    const std::int64_t missing = remaining();
    if (missing > 0)  // one that has too few points for the threads has more of them for each
      inner_jobs_ = missing < jobs_ ? jobs_ : 1;
    run_tasks(
        static_cast<std::size_t>(of_shard()), jobs_, [this](std::size_t i) { take(point(static_cast<std::int64_t>(i))); },
        watch_.stop);
    bar_.close([this](double elapsed) { return state(elapsed); });
    seconds_ = seconds_since(begin_);
  }

  [[nodiscard]] json data() const {
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
  [[nodiscard]] std::string text(const std::string& out) const {
    std::string words = fmt::format("{} of {} points in {}: {} computed", whole(of_shard() - remaining()), whole(of_shard()),
                                    printable_line(out), whole(computed_));
    if (known_ > 0) words += fmt::format(", {} were there", whole(known_));
    if (reused_ > 0) words += fmt::format(", {} taken over from an earlier plan", whole(reused_));
    return words + fmt::format(", {}\n", quantity(seconds_, "s"));
  }

 private:
  [[nodiscard]] std::int64_t point(std::int64_t i) const { return i * shard_.count + shard_.index - 1; }

  template <class Work>
  auto timed(Work&& work) {
    const Clock::time_point begin = Clock::now();
    auto result = work();
    store_seconds_ += seconds_since(begin);
    return result;
  }

  void take(std::int64_t k) {
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

  [[nodiscard]] std::pair<double, std::string> state(double elapsed) const {
    const std::int64_t all = of_shard(), there = all - remaining();
    std::string words = fmt::format("{} of {} points", whole(there), whole(all));
    if (const double rate = static_cast<double>(computed_) / elapsed; computed_ > 0 && elapsed > 0) {
      words += fmt::format(", {} per s", internal::plain_number(rate));
      if (remaining() > 0) words += fmt::format(", {} left", duration_words(static_cast<double>(remaining()) / rate));
    }
    return {all > 0 ? static_cast<double>(there) / static_cast<double>(all) : 1, words + fmt::format(", {:.0f} s", elapsed)};
  }

  Exploration& exploration_;
  StudyStore& store_;
  Shard shard_;
  std::vector<bool> done_;
  bool reuses_;
  int jobs_, inner_jobs_ = 1;
  Watch watch_;
  std::mutex mutex_;  // of the bar
  Bar bar_;
  std::int64_t known_ = 0;
  std::atomic<std::int64_t> computed_ = 0, reused_ = 0;
  std::atomic<double> store_seconds_ = 0;  // spent waiting for the store, by all threads [s]
  Clock::time_point begin_ = Clock::now();
  double seconds_ = 0;  // [s]
};

/// What the rows of a store say together.
struct Overview {
  struct Extent {
    double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
    std::int64_t least_at = 0, most_at = 0;
  };
  std::map<std::string, std::int64_t> by_status;
  std::map<std::string, std::string> first_reasons;  // of each status that has one
  std::vector<Extent> extents;                       // by column
  bool has_figures = false;
};

Overview overview_of(const StudyReader& store) {
  const std::vector<StoredColumn>& columns = store.plan().columns;
  Overview all{.by_status = store.by_status(), .first_reasons = {}, .extents = {}};
  all.extents.resize(columns.size());
  store.read([&](const StoredRow& row) {
    if (!row.reason.empty()) all.first_reasons.try_emplace(row.status, fmt::format("point {}: {}", row.point, row.reason));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double value = row.values[i];
      if (!std::isfinite(value)) continue;
      all.has_figures = all.has_figures || columns[i].kind == ColumnKind::figure;
      Overview::Extent& extent = all.extents[i];
      if (value < extent.least) extent.least = value, extent.least_at = row.point;
      if (value > extent.most) extent.most = value, extent.most_at = row.point;
    }
  });
  return all;
}

json overview_json(const StoredPlan& plan, const Overview& found) {
  json figures = json::object(), variables = json::array();
  for (std::size_t i = 0; i < plan.columns.size(); ++i) {
    const StoredColumn& column = plan.columns[i];
    if (column.kind == ColumnKind::variable) {
      variables.push_back({{"name", column.name}, {"unit", column.unit}, {"column", column.key}});
      continue;
    }
    const Overview::Extent& e = found.extents[i];
    if (!(e.least <= e.most)) continue;
    figures[column.key] = {{"least", e.least}, {"least_at", e.least_at}, {"most", e.most}, {"most_at", e.most_at}};
  }
  return {{"variables", variables}, {"figures", figures}, {"by_status", found.by_status}};
}

std::string overview_text(const StoredPlan& plan, const Overview& found) {
  std::string text;
  for (const auto& [status, count] : found.by_status) {
    text += fmt::format("  {:<20} {:>9}", status, whole(count));
    const auto reason = found.first_reasons.find(status);
    text += reason == found.first_reasons.end() ? "\n" : fmt::format("   {}\n", shortened(printable_line(reason->second), 140));
  }
  text += fmt::format("\n{:<44} {:>12} {:>9}   {:>12} {:>9}\n", "", "least", "at point", "most", "at point");
  for (std::size_t i = 0; i < plan.columns.size(); ++i) {
    const StoredColumn& column = plan.columns[i];
    const Overview::Extent& e = found.extents[i];
    if (column.kind == ColumnKind::variable || !(e.least <= e.most)) continue;
    const auto cell = [&](double value, std::int64_t at) {
      return right_aligned(quantity(value, column.unit), 12) + " " + right_aligned(std::to_string(at), 9);
    };
    text +=
        left_aligned(shortened(column.name, 43), 44) + " " + cell(e.least, e.least_at) + "   " + cell(e.most, e.most_at) + "\n";
  }
  return text;
}

int status_of(const Overview& found, bool interrupted) {
  if (interrupted) return exit_interrupted;
  if (found.by_status.contains(std::string(internal_fault))) return exit_internal_error;
  return found.has_figures ? exit_done : exit_no_success;
}

// What --shard says, else what the store that is gone on with holds.
Shard shard_of(const ExploreRequest& r, const std::string& store) {
  if (r.shard.empty()) return store.empty() ? Shard{} : StudyReader(store).plan().shard;
  try {
    return shard_from(r.shard);
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("--shard: {}", error.what()));
  }
}

// Rows of another program, or of one on another processor, may have other last digits.
void tell_of_other_programs(const std::string& store) {
  if (!is_store(store)) return;
  const std::vector<StoredSession> sessions = StudyReader(store).sessions();
  const StoredOrigin ours = origin_of({});
  const auto is_other = [&](const StoredSession& s) { return s.program != ours.program || s.processor != ours.processor; };
  const auto other = std::find_if(sessions.begin(), sessions.end(), is_other);
  if (other == sessions.end()) return;
  say(fmt::format("{}: some of its rows come from {} on {}: their last digits may differ from those of {}", store, other->program,
                  other->host, ours.program));
}

// The scene of one point, as `simulate` takes it.
int print_point(const Common& c, const ExploreRequest& r) {
  const auto k = whole_number<std::uint64_t>("--point", r.point.value(), 0);
  PlanRequest request = plan_request(c, r);
  complete(request);
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

// A search for a front, whose points are known only as it goes.
int search_front(const Common& c, const ExploreRequest& r, Exploration& exploration, const std::string& out) {
  const StoredPlan plan = stored_plan(exploration, {});
  std::vector<ExploredColumn> columns;
  for (const StoredColumn& column : plan.columns)
    columns.push_back({column.key, column.name, column.unit, column.kind == ColumnKind::variable});
  const std::vector<ExploredAim> aims = explored_aims(columns, exploration.plan().pareto(), "--pareto");
  KnownRows known = r.resume ? known_rows(out) : KnownRows{};
  StudyStore store(out, plan, origin_of(c), r.resume ? StudyStore::Opening::resume : StudyStore::Opening::fresh);
  const auto there = static_cast<std::int64_t>(known.size());
  if (!c.quiet) {
    say(fmt::format("{}: searching the front of {} with {} points, {} of them known, study {}; rows go to {}", c.scene,
                    exploration.plan().pareto(), whole(plan.points), whole(there), exploration.plan().study(), out));
  }
  FrontSearch search(exploration, store, std::move(known), aims, job_count(r.jobs), c.quiet, c.stop);
  search.run();
  store.close();

  const bool interrupted = search.result().termination == Termination::interrupted;
  const StudyReader reader(out);
  const ExplorationReport report = explored(reader, {});
  const Overview found = overview_of(reader);
  json j = overview_json(reader.plan(), found);
  j.update(exploration_json(report));
  j.update({{"status", interrupted ? "interrupted" : "done"},
            {"termination", to_string(search.result().termination)},
            {"seed", exploration.plan().seed()},
            {"rows", {{"known", there}, {"computed", search.computed()}}},
            {"store", out},
            {"made_with", made_with_json()}});
  print_json_or(c, j,
                exploration_text(report) + fmt::format("\n{} computed. The scene of a point: softland explore {} --point K\n"
                                                       "The page: softland report {}\n",
                                                       whole(search.computed()), shell_word(out), shell_word(out)));
  return status_of(found, interrupted);
}

int explore_verb(const Common& c, const ExploreRequest& r) {
  if (r.point) return print_point(c, r);
  const int jobs = job_count(r.jobs);
  const bool goes_on = is_store(c.scene);
  const Shard shard = shard_of(r, goes_on ? c.scene : std::string());
  PlanRequest request = plan_request(c, r);
  complete(request);
  require(!goes_on || (r.resume && r.out.empty()),
          [&] { return fmt::format("{}: is a store already: --resume goes on with it, and --out is not for that", c.scene); });
  const std::string out = goes_on ? c.scene : r.out.empty() ? "softland-out.sqlite" : r.out;
  static_cast<void>(claim_places(c, {}));
  require(c.json.empty() || std::filesystem::weakly_canonical(c.json) != std::filesystem::weakly_canonical(out),
          [&] { return fmt::format("--json {}: is the store; name another file", c.json); });
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  Exploration exploration(Plan(request), work->watch());
  work.reset();

  if (r.resume && !c.quiet) tell_of_other_programs(out);
  if (exploration.plan().is_search()) {
    require(shard.count == 1,
            "--shard: a search for a front goes from point to point and cannot be divided; --jobs makes it faster");
    return search_front(c, r, exploration, out);
  }
  StudyStore store(out, stored_plan(exploration, shard), origin_of(c),
                   r.resume ? StudyStore::Opening::resume : StudyStore::Opening::fresh);
  Exploring exploring(exploration, store, shard, c, jobs);
  if (!c.quiet) {
    say(fmt::format("{}: {} of {} points to explore, study {}; rows go to {}", c.scene, whole(exploring.remaining()),
                    whole(exploring.of_shard()), exploration.plan().study(), out));
  }
  exploring.run();
  store.close();

  const StudyReader reader(out);
  const Overview found = overview_of(reader);
  json j = overview_json(reader.plan(), found);
  j.update(exploring.data());
  j.update({{"store", out}, {"version", version}, {"command", c.command}, {"made_with", made_with_json()}});
  print_json_or(c, j, exploring.text(out) + overview_text(reader.plan(), found));
  return status_of(found, exploring.remaining() > 0);
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
  verb.option("--study", request->study, "NAME", "at every point: " + first_is_default(listed(point_studies)));
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
