// The search for a waveform, of the nominal device or of devices that differ.
#include "studies/search/optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/scenes.h"
#include "apps/search_run.h"
#include "apps/stores.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "base/read_file.h"
#include "base/shell_word.h"
#include "config/assumed_spread.h"
#include "optimizers/problem.h"
#include "reports/origin.h"
#include "reports/quantity.h"
#include "reports/report_files.h"
#include "reports/result_maker.h"
#include "reports/robustness_words.h"
#include "reports/search_report.h"
#include "reports/seeds_report.h"
#include "reports/text.h"
#include "studies/search/limit.h"
#include "studies/search/robust_optimize.h"
#include "studies/stored_search/seed_study.h"
#include "waveforms/export.h"

namespace softland::apps {
namespace {

namespace fs = std::filesystem;
using internal::percent;
using internal::quantity;
using nlohmann::json;

/// Of a search that the least time of any waveform, a second or two, does not make much longer.
constexpr long evaluations_worth_a_limit = 1000;

// How a winner does on devices of its scene's spread, beside the plain step, in a sentence; empty where nothing varies, or when
// asked to stop.
std::string on_devices(const Common& c, const PreparedScene& winner, int jobs, const fs::path& place) {
  if (winner.scene.spread.empty()) return {};
  constexpr std::uint64_t devices = 200;
  try {
    const WatchedWork work(c.quiet, c.stop);
    const Robustness found = robustness(winner, {{.name = "found", .waveforms = winner.drives.waveforms()}},
                                        {.samples = devices, .jobs = jobs}, work.watch());
    if (found.interrupted || found.drives.size() < 2) return {};
    const auto at_95_percent = [](const DriveRobustness& drive, std::string_view key) {
      const Figure& figure = figure_of(key);
      return quantity(drive.figures[figure].quantiles[2].value, figure.unit);
    };
    const auto words = [&](const DriveRobustness& drive) {
      if (drive.closing.value < 0.95) return fmt::format("{} close", percent(drive.closing.value));
      return fmt::format("95 % have rebounds up to {} and touches at up to {}",
                         at_95_percent(drive, key_of(&Metrics::major_bounce_height)),
                         at_95_percent(drive, key_of(&Metrics::largest_impact_velocity)));
    };
    const DriveRobustness &step = found.drives[0], &own = found.drives[1];
    return "\n" +
           wrapped(fmt::format("On {} devices that differ as [spread] says, with the same volts: {} land without a rebound, and "
                               "{} (plain step: {}, {}).{} "
                               "More: softland robustness {}",
                               devices, percent(own.bounce_free.value), words(own), percent(step.bounce_free.value), words(step),
                               internal::outside_words(found), shell_word((place / "best.toml").string()))) +
           "\n";
  } catch (const Interrupted&) {
    return {};
  }
}

int status_of(const FoundSearch& found) {
  if (found.interrupted()) return exit_interrupted;
  return found.is_success() ? exit_done : exit_no_success;
}

// A search on its way to the result that is reported; of several the best.
struct Asked {
  const Common& c;
  StoredSearch& search;
  const std::optional<KnownSearch>& known;
  const SearchOutput& output;
  SearchPlaces* places = nullptr;         // of a study of seeds
  std::optional<ResultSeeds> seeds = {};  // that are done
  bool limit = false;                     // the least time is told however long it takes
};

// Whether the least time takes a small part of the search's own time: a second or two, but many times that with a slew limit, and
// with more modes than four of a cantilever, whose frequencies are 34 to 1.
bool takes_little(const Asked& asked, const OptimizeResult& result) {
  constexpr double widest_band = 40;  // the highest natural frequency over the lowest
  const Eigen::VectorXd& omega = result.best_scene->model.basis().angular_frequencies();
  return asked.search.options.max_evaluations >= evaluations_worth_a_limit &&
         omega.maxCoeff() <= widest_band * omega.minCoeff() &&
         std::ranges::none_of(result.best_scene->drives,
                              [](const Drive& one) { return one.limits && std::isfinite(one.limits->max_slew); });
}

// The least time of any waveform of the winner's drives at its impact speed; none where the scene does not fit the question.
std::optional<ResultLimit> limit_of(const Asked& asked, const OptimizeResult& result) {
  if (!result.best || result.search.termination == Termination::interrupted) return std::nullopt;
  if (!asked.limit && !takes_little(asked, result)) return std::nullopt;
  constexpr double softest = 1e-3;  // of the plain step's impact speed
  const double own = result.best->metrics.impact_velocity, step = result.baseline.metrics.impact_velocity;
  if (!std::isfinite(own)) return std::nullopt;
  const double velocity = std::isfinite(step) ? std::max(own, softest * step) : own;
  const WatchedWork work(asked.c.quiet, asked.c.stop);
  work.watch().tell("least time", 0);
  try {
    const LeastTime least = least_time(
        *result.best_scene, {.actuator = asked.search.options.actuator, .impact_velocity = velocity, .watch = work.watch()});
    if (least.status != Status::done) return std::nullopt;
    return ResultLimit{.least_time = least.time, .impact_velocity = velocity};
  } catch (const InvalidInput& error) {
    if (asked.limit) say(fmt::format("--limit: {}", error.what()));
    return std::nullopt;
  }
}

// What follows the table of a result: how the winner does on devices.
std::string words_on_devices(const Asked& asked, const SearchReport& report, const fs::path& place) {
  const FoundSearch& found = report.found;
  if (asked.search.robust && report.devices) return "\n" + terminal_text(robustness_document(*report.devices));
  const bool judged = found.best().best_scene && !found.interrupted() && asked.c.json != "-";
  if (asked.search.devices() > 0 || !judged) return {};
  return on_devices(asked.c, *found.best().best_scene, asked.search.options.jobs, place);
}

// Lists the pages and the waveforms of a search over devices, and says how many files there are besides.
std::vector<std::string> foremost(std::vector<std::string> files) {
  const auto others = std::ranges::stable_partition(
      files, [](const std::string& name) { return name.ends_with(".html") || name.ends_with(".toml"); });
  const std::size_t more = others.size();
  files.erase(others.begin(), others.end());
  if (more > 0) files.push_back(fmt::format("and {} more", more));
  return files;
}

int run_search(const Asked& asked) {
  const Common& c = asked.c;
  StoredSearch& search = asked.search;
  SearchRun searching(c, search, asked.known, asked.output, asked.places);
  if (search.robust && assume_spread(search.scene) && !c.quiet) say(std::string(assumed_words));
  SearchReport report(run(search));
  const OptimizeResult& best = report.found.best();
  add_devices(report, search, c.command, {.stop = c.stop, .progress = search.options.on_preparation});
  searching.close();

  SearchSession& session = searching.session();
  const fs::path place = session.destination(report);
  add_result(report, search, place, {.command = c.command});
  Result& result = report.result;
  result.limit = limit_of(asked, best);
  result.seeds = asked.seeds;
  session.add_log(result, report);
  std::vector<std::string> left = session.leave(report);
  if (search.for_devices && !report.found.interrupted()) {
    left = foremost(std::move(left));
  } else {
    for (std::string& name : left) name += name == "best.toml" ? " (run it with `softland simulate`)" : "";
  }
  if (search.devices() == 0 && !c.quiet) {
    for (const std::string& broken : best.broken_conditions) say(fmt::format("the winner breaks --constrain \"{}\"", broken));
  }
  print_result(c, result, words_on_devices(asked, report, place) + left_in(place, left));
  return status_of(report.found);
}

// The searches that are done, ranked.
ResultSeeds ranked(const SeedStudy& study, const StoredSearch& search, double significant) {
  ResultSeeds seeds{.planned = search.seeds, .searches = study.searches()};
  if (!seeds.searches.empty()) rank(seeds, search.options.target, significant, search.robust.has_value());
  return seeds;
}

// Reports a study of several seeds that was interrupted; --resume goes on with it.
int tell_of_part(const Common& c, SearchPlaces& places, const SeedStudy& study, const ResultSeeds& seeds) {
  const fs::path stores = places.store(evaluations_file).parent_path();
  std::string left = left_in(stores, {evaluations_file, seeds_file});
  const std::string best = seeds.searches.empty() ? std::string() : study.scene_of(seeds.searches[seeds.best].seed);
  if (!best.empty()) {
    places.folder().write("best.toml", best);
    left += left_in(places.folder().place("best.toml").parent_path(), {"best.toml (of the best that is done)"});
  }
  const json j = with_origin({{"status", "interrupted"}, {"seeds", seeds_json(seeds)}}, c.command);
  print_json_or(c, j,
                terminal_text({.sections = {internal::seeds_section(seeds)}}) + left + "\n" +
                    wrapped(fmt::format("--resume goes on with the {} that are missing.", study.missing())) + "\n");
  return exit_interrupted;
}

std::pair<double, std::string> words_of(const SeedStudy::State& now, const StoredSearch& search, double elapsed) {
  std::string words =
      fmt::format("{} of {} seeds, {} {}", now.done, search.seeds, now.evaluations, search.robust ? "closings" : "evaluations");
  words += std::isfinite(now.best_cost) ? fmt::format(", best cost {:.4f} (plain step {:.4f})", now.best_cost, now.step_cost)
                                        : ", no feasible waveform yet";
  return {now.part, words + fmt::format(", {:.0f} s", elapsed)};
}

// Shows how far they are, and keeps the best scene in the folder.
void run_shown(SeedStudy& study, const Common& c, const StoredSearch& search, SearchPlaces& places,
               const FamilyColumns& columns) {
  SearchLog log(places.folder(), columns);
  Bar bar(c.quiet);
  std::mutex one_at_a_time;
  study.run({.progress =
                 [&](const SeedStudy::State& now) {
                   const std::scoped_lock lock(one_at_a_time);
                   bar.show([&](double elapsed) { return words_of(now, search, elapsed); });
                 },
             .improvement = [&](const SceneFile& best) { log.improved(best); }});
  bar.close([&](double elapsed) { return words_of(study.state(), search, elapsed); });
  log.flush();
  study.close();
}

int run_seeds(const Common& c, StoredSearch& search, const std::optional<KnownSearch>& known, const SearchOutput& output,
              bool limit) {
  std::optional<WatchedWork> work(std::in_place, c.quiet, c.stop);
  const SearchedParameters searched = searched_parameters(search.scene, search.options, search.robust.has_value(), work->watch());
  work.reset();
  SearchPlaces places(output, search, known, searched.columns);
  if (!c.quiet) {
    say(search_words(c, search) +
        fmt::format(", from seeds {} to {}; results go to {}", search.seed(0), search.seed(search.seeds - 1), c.out));
  }
  SeedStudy study(search, places.evaluations(), places.store(seeds_file), searched.columns.names(), stored_origin(c.command));
  run_shown(study, c, search, places, searched.columns);
  const ResultSeeds seeds = ranked(study, search, searched.significant_rebound);
  if (study.missing() > 0) {
    places.evaluations().close();
    return tell_of_part(c, places, study, seeds);
  }
  // The best once more, all of whose evaluations are known, for the report.
  search.options.seed = seeds.searches.at(seeds.best).seed;
  return run_search(
      {.c = c, .search = search, .known = known, .output = output, .places = &places, .seeds = seeds, .limit = limit});
}

// Says so where the folder holds what was found for another scene: all of it gives way to the results of this search.
void tell_of_another_scene(const fs::path& folder, const SceneFile& scene) {
  try {
    const fs::path best = folder / "best.toml";
    const std::optional<std::string> held = SceneFile::parse(look_into(best), best.string()).written("title");
    if (held && held != scene.written("title"))
      say(fmt::format("{} holds results of another scene, \"{}\": those of this search will replace them", folder.string(),
                      *held));
  } catch (const InvalidInput&) {  // it holds no result
  }
}

int optimize_verb(const Common& given, const OptimizeRequest& request) {
  Common c = given;
  if (c.out.empty()) c.out = "softland-out";
  if (c.scene.empty() && !request.resume) c.scene = shipped_scene("mem-gold-pzt.toml").string();
  std::optional<KnownSearch> known;
  StoredSearch search = asked_or_known(c, request, known);
  const SearchOutput output = output_of(c);
  if (!known && !c.quiet) tell_of_another_scene(output.folder, search.scene);
  if (known && !c.quiet) tell_of_other_programs((known->place / evaluations_file).string());
  return search.seeds > 1 ? run_seeds(c, search, known, output, request.limit)
                          : run_search({.c = c, .search = search, .known = known, .output = output, .limit = request.limit});
}

// "settling, impact and energy"
std::string targets_with_own_cost() {
  std::vector<std::string_view> names;
  for (const TargetRow& row : targets) {
    if (row.has_own_cost) names.push_back(row.name);
  }
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

std::string optimizer_help() {
  std::string text = "\nOptimizers:\n";
  for (const std::string_view name : optimizer_names()) {
    text += "  " + std::string(name) + std::string(14 - std::min<std::size_t>(13, name.size()), ' ') +
            std::string(optimizer_description(name)) + "\n";
  }
  return text;
}

}  // namespace

void add_optimize(Verb& verb) {
  const auto request = std::make_shared<OptimizeRequest>();
  verb.with_scene(false);
  verb.with_json();
  verb.option("--target", request->target, "NAME",
              first_is_default(listed(targets)) +
                  ", or a weighted sum such as \"0.7 bounce + 0.3 energy\"; the goal of each asks for no significant rebound");
  verb.option("--actuator", request->actuator, "NAME",
              "drives that the search may shape: " + listed(actuators) +
                  "; default: all that the scene has, and with --robust none or a measure electrostatic");
  verb.option(
      "--waveform", request->waveform, "NAME",
      "family to search: " + listed_searched_families() +
          ", with a number of levels, knots, pulses or sines: knots:8; for each drive its own: main=step,pzt=pulse; several, "
          "each "
          "begun where those before it ended, of which the best goes on: " +
          fmt::format(
              "{} (default), {} (for both, and electrodes on both sides), {} (for pzt); with a measure of --robust knots, "
              "with --calibrate catch; quasi-static moves all drives and is searched over devices",
              default_families(Shaped::electrode), default_families(Shaped::several), default_families(Shaped::piezo)));
  verb.option(
      "--robust", request->robust, "MEASURE",
      "devices that differ as [spread] says: auto (default, but for --seeds; where the scene has no [spread] one is "
      "assumed) races measures and families over devices and searches for the drawing beside it; none searches for the drawing "
      "alone; one measure alone: yield (as many devices as possible without a rebound), yield:\"bounce_count == 0\", "
      "cvar:0.9 (the mean of the worst tenth), quantile:0.95, mean+2sigma, worst");
  verb.repeated(
      "--constrain", request->constrain, "CONDITION",
      "condition that the winner on the drawing, and 95 % of the devices, have to fulfil: \"permanent_contact_time < 60 us\"; "
      "may be repeated");
  verb.option("--hold-step", request->hold_step, "chosen|fixed",
              "with --actuator pzt, when the plain step of the electrode comes: at an instant that is searched, after a slow "
              "approach by the piezo (chosen, default), or at t = 0 (fixed)");
  verb.option("--calibrate", request->calibrate, "LIST",
              "measured on every device before it is driven, whose waveform is then in its own units: \"Vdp,frequency\" or, with "
              "errors, \"Vdp:1 %,frequency:0.5 %\"; piezo, the deflection per volt on it over the contact gap, as well; "
              "\"Vdp,frequency in 8 classes\": sorted by it, one waveform for each class; none: "
              "not even what [calibration] says");
  verb.with_samples(request->samples,
                    "devices that a search by one measure looks at (default: 128), or fresh ones of the verdict (default: 2000)");
  verb.option("--optimizer", request->optimizer, "NAME", "auto (default), or another of the names below");
  verb.repeated("--start", request->starts, "FILE",
                "begin with the waveform of this scene or result (of softland limit, say), which must be of the searched drives; "
                "from another family, with the nearest waveform of the searched one; it stays the best unless a better one is "
                "found, and without --robust the search never ends worse; may be repeated");
  verb.optional(
      "--budget", request->budget, "N|TIME",
      fmt::format(
          "evaluations, or time (\"90 s\"); default: {} for an electrode, {} for several drives, {} for a "
          "piezo, half as much again for {}; and {} closings of devices, up to twice as many where many land, fewer where "
          "closings take more work than usual, which the first line says; with --robust auto all closings together, with a "
          "measure closings of devices, {}",
          default_budget(Target::bounce, Shaped::electrode), default_budget(Target::bounce, Shaped::several),
          default_budget(Target::bounce, Shaped::piezo), targets_with_own_cost(), race_closings, default_closings));
  verb.with_seed(request->seed, "same result, whatever --jobs is");
  verb.optional("--seeds", request->seeds, "N",
                "search from N seeds, --seed and those after it, as one study: the best is reported, and how the others spread");
  verb.flag(
      "--resume", request->resume,
      "go on with the search in the folder of --out that was interrupted, or ended by its budget; what it has evaluated is not "
      "simulated again, and options that are not given are those it began with");
  verb.flag("--limit", request->limit,
            fmt::format(
                "tell how near the winner's touch comes to the least time of any waveform of these drives also where a "
                "driver has a max_slew or a cantilever more than four modes, which may take minutes, and with a budget below {}",
                evaluations_worth_a_limit));
  verb.with_jobs(request->jobs, "threads (default: one per core)");
  verb.with_out("folder for the report, the waveform found and all data (default: softland-out)");
  verb.footer(
      "Without a scene: scenes/mem-gold-pzt.toml. The hold level is the scene's own; its [driver.*] limits are never left.\n"
      "A scene that holds a landing already (best.toml of an earlier search) is refined and, without --robust, never ends "
      "worse.\n" +
      optimizer_help() +
      "\nExamples:\n  softland optimize --target bounce --actuator pzt\n"
      "  softland optimize scenes/mem-gold.toml --seeds 8 --out seeds\n"
      "  softland optimize --resume --out seeds --budget 5000\n"
      "  softland optimize my.toml --start run1/best.toml --out run2\n"
      "  softland optimize scenes/mem-gold.toml --actuator electrostatic --waveform pulse --seed 3 --out run3\n"
      "  softland optimize scenes/mem-gold.toml --robust cvar:0.9 --constrain \"initial_contact_time < 65 us\"\n"
      "  softland optimize scenes/mem-gold.toml --robust cvar:0.9 --waveform catch --calibrate \"Vdp:1 %,frequency:0.5 %\"");
  verb.runs([request](const Common& common) { return optimize_verb(common, *request); });
}

}  // namespace softland::apps
