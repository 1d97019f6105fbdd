// Verb `optimize`: searches a waveform for the nominal design, or for devices under process variation.
#include "studies/search/optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
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
#include "apps/studies.h"
#include "apps/verbs/verbs.h"
#include "base/read_file.h"
#include "base/shell_word.h"
#include "config/assumed_spread.h"
#include "document/quantity.h"
#include "document/text.h"
#include "optimizers/problem.h"
#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "reports/origin.h"
#include "reports/record_file.h"
#include "reports/report_files.h"
#include "reports/robustness_prose.h"
#include "reports/search_session.h"
#include "reports/seeds_report.h"
#include "studies/search/least_time.h"
#include "studies/search/robust_optimize.h"
#include "studies/search/seed_study.h"
#include "waveforms/export.h"

namespace softland::apps {
namespace {

namespace fs = std::filesystem;
using internal::quantity;
using internal::share_text;

// Returns a sentence that compares the found waveform with the plain step on devices with the process variation of [spread];
// empty if the scene has no process variation, or after a request to stop.
std::string on_devices(const Common& c, const PreparedScene& winner, int jobs, const fs::path& place) {
  if (winner.scene.spread.empty()) return {};
  constexpr std::uint64_t devices = 200;
  try {
    const ShownWork work(c.quiet, c.stop);
    const Robustness found = robustness(winner, {{.name = "found", .waveforms = winner.drives.waveforms()}},
                                        {.samples = devices, .jobs = jobs}, work.progress());
    if (found.interrupted || found.drives.size() < 2) return {};
    const auto at_95_percent = [](const DriveRobustness& drive, std::string_view key) {
      const Figure& figure = figure_of(key);
      return quantity(drive.figures[figure].quantiles[2].value, figure.unit);
    };
    const auto words = [&](const DriveRobustness& drive) {
      if (drive.closing.value < 0.95) return fmt::format("{} close", share_text(drive.closing.value));
      return fmt::format("95th percentile: highest rebound {}, largest impact velocity {}",
                         at_95_percent(drive, key_of(&Metrics::major_bounce_height)),
                         at_95_percent(drive, key_of(&Metrics::largest_impact_velocity)));
    };
    const DriveRobustness &step = found.drives[0], &own = found.drives[1];
    return "\n" +
           wrapped(fmt::format(
               "On {} devices varied by [spread], with the same waveform: {} bounce-free, {} (plain step: {}, {}).{} More: "
               "softland robustness {}",
               devices, share_text(own.bounce_free.value), words(own), share_text(step.bounce_free.value), words(step),
               internal::outside_prose(found), shell_word((place / "best.toml").string()))) +
           "\n";
  } catch (const Interrupted&) {
    return {};
  }
}

int status_of(const FoundSearch& found) {
  if (found.interrupted()) return exit_interrupted;
  return found.is_success() ? exit_done : exit_no_success;
}

// The search whose result is reported: the only search, or the best of the searches with several seeds.
struct Asked {
  const Common& c;
  StoredSearch& search;
  const std::optional<KnownSearch>& known;
  const SearchOutput& output;
  SearchPlaces* places = nullptr;           // result folders that the searches of all seeds share; null for a single search
  std::optional<SeedsFindings> seeds = {};  // completed searches of all seeds; none if the user requested a single seed
  bool limit = false;                       // true: compute the least closing time of any waveform, even if that takes minutes
};

// Returns true if computing the least closing time (verb `limit`) takes a second or two, which is short beside the search. The
// computation is much longer with a slew limit, and with widely spaced natural frequencies. The ratio of the highest frequency
// to the lowest is 34 for four modes of a cantilever, 57 for five.
bool takes_little(const Asked& asked, const OptimizeResult& result) {
  // Largest ratio of the highest natural frequency to the lowest at which computing the least closing time is quick.
  constexpr double widest_band = 40;
  const Eigen::VectorXd& omega = result.best_scene->model.basis().angular_frequencies();
  return asked.search.options.max_evaluations >= verbs::evaluations_worth_a_limit &&
         omega.maxCoeff() <= widest_band * omega.minCoeff() &&
         std::ranges::none_of(result.best_scene->drives,
                              [](const Drive& one) { return one.limits && std::isfinite(one.limits->max_slew); });
}

// Computes the least closing time that any waveform can reach on the same electrodes and piezos, within the same voltage
// limits, with at most the impact velocity of the found waveform. Returns none if the verb `limit` does not apply to the scene.
std::optional<TouchLimit> limit_of(const Asked& asked, const OptimizeResult& result) {
  if (!result.best || result.search.termination == Termination::interrupted) return std::nullopt;
  if (!asked.limit && !takes_little(asked, result)) return std::nullopt;
  // Least value of the permitted impact velocity in the computation of the limit, as a share of the impact velocity under the
  // plain step: the found waveform may touch at a velocity of nearly 0.
  constexpr double softest = 1e-3;
  const double own = result.best->metrics.impact_velocity, step = result.baseline.metrics.impact_velocity;
  if (!std::isfinite(own)) return std::nullopt;
  const double velocity = std::isfinite(step) ? std::max(own, softest * step) : own;
  const ShownWork work(asked.c.quiet, asked.c.stop);
  work.progress().tell("least time", 0);
  try {
    const LeastTime least =
        least_time(*result.best_scene,
                   {.actuator = asked.search.options.actuator, .impact_velocity = velocity, .progress = work.progress()});
    if (least.status != Status::done) return std::nullopt;
    return TouchLimit{.least_time = least.time, .impact_velocity = velocity};
  } catch (const InvalidInput& error) {
    if (asked.limit) print_note(fmt::format("--limit: {}", error.what()));
    return std::nullopt;
  }
}

// Returns the figures of merit of the found waveform on simulated devices, as the text below the table of a result.
std::string words_on_devices(const Asked& asked, const SearchReport& report, const fs::path& place) {
  const FoundSearch& found = report.found;
  if (asked.search.robust && report.devices) return "\n" + terminal_text(robustness_document(*report.devices));
  const bool judged = found.best().best_scene && !found.interrupted() && asked.c.json != "-";
  if (asked.search.devices() > 0 || !judged) return {};
  return on_devices(asked.c, *found.best().best_scene, asked.search.options.jobs, place);
}

// Shortens a list of written files for the terminal: the names of pages and scenes stay, the others become "and 12 more".
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
  if (search.robust && assume_spread(search.scene) && !c.quiet) print_note(std::string(assumed_prose));
  SearchReport report(run(search));
  const OptimizeResult& best = report.found.best();
  add_devices(report, search, c.command, {.stop = c.stop, .report = search.options.on_preparation});
  searching.close();

  SearchSession& session = searching.session();
  const fs::path place = session.destination(report);
  add_result(report, search, place, c.command);
  ClosingRecord& result = report.result;
  result.search->limit = limit_of(asked, best);
  result.search->seeds = asked.seeds;
  session.add_log(*result.search, report);
  std::vector<std::string> left = session.leave(report);
  if (search.for_devices && !report.found.interrupted()) {
    left = foremost(std::move(left));
  } else {
    for (std::string& name : left) name += name == "best.toml" ? " (run it with `softland simulate`)" : "";
  }
  if (search.devices() == 0 && !c.quiet) {
    for (const std::string& broken : best.broken_conditions)
      print_note(fmt::format("the found waveform violates --constrain \"{}\"", broken));
  }
  print_json_or(c, summary_json(json_of(result)),
                terminal_text(closing_document(result)) + words_on_devices(asked, report, place) + files_written(place, left));
  return status_of(report.found);
}

// Returns the completed searches of all seeds with the index of the best one, by the criteria of rank() (seeds_report.h);
// rebounds below `significant` [m] do not count.
SeedsFindings ranked(const SeedStudy& study, const StoredSearch& search, double significant) {
  SeedsFindings seeds{.planned = search.seeds, .searches = study.searches()};
  if (!seeds.searches.empty()) rank(seeds, search.options.target, significant, search.robust.has_value());
  return seeds;
}

// Reports an interrupted study of several seeds, which --resume continues.
int report_interrupted(const Common& c, SearchPlaces& places, const SeedStudy& study, const SeedsFindings& seeds) {
  const fs::path stores = places.store(evaluations_file).parent_path();
  std::string left = files_written(stores, {evaluations_file, seeds_file});
  const std::string best = seeds.searches.empty() ? std::string() : study.scene_of(seeds.searches[seeds.best].seed);
  if (!best.empty()) {
    places.folder().write("best.toml", best);
    left += files_written(places.folder().place("best.toml").parent_path(), {"best.toml (best waveform of the completed seeds)"});
  }
  const SeedsRecord record{.origin = origin_of("optimize", c.command), .seeds = seeds};
  print_json_or(c, json_of(record),
                text_of(record) + left + "\n" +
                    wrapped(fmt::format("--resume continues with the {} missing seeds.", study.missing())) + "\n");
  return exit_interrupted;
}

std::pair<double, std::string> words_of(const SeedStudy::State& now, const StoredSearch& search, double elapsed) {
  std::string words =
      fmt::format("{} of {} seeds, {} {}", now.done, search.seeds, now.evaluations, search.robust ? "closings" : "evaluations");
  words += std::isfinite(now.best_cost) ? fmt::format(", best cost {:.4f} (plain step {:.4f})", now.best_cost, now.step_cost)
                                        : ", no feasible waveform yet";
  return {now.part, words + fmt::format(", {:.0f} s", elapsed)};
}

// Runs the searches of all seeds, shows their progress, and writes the scene with the best waveform so far to the folder.
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
  std::optional<ShownWork> work(std::in_place, c.quiet, c.stop);
  const SearchedParameters searched =
      searched_parameters(search.scene, search.options, search.robust.has_value(), work->progress());
  work.reset();
  SearchPlaces places(output, search, known, searched.columns);
  if (!c.quiet) {
    print_note(search_prose(c, search) +
               fmt::format(", from seeds {} to {}; results go to {}", search.seed(0), search.seed(search.seeds - 1), c.out));
  }
  SeedStudy study(search, places.evaluations(), places.store(seeds_file), searched.columns.names(), stored_origin(c.command));
  run_shown(study, c, search, places, searched.columns);
  const SeedsFindings seeds = ranked(study, search, searched.significant_rebound);
  if (study.missing() > 0) {
    places.evaluations().close();
    return report_interrupted(c, places, study, seeds);
  }
  // Repeat the best search for the report. All evaluations of the search are stored: nothing is simulated again.
  search.options.seed = seeds.searches.at(seeds.best).seed;
  return run_search(
      {.c = c, .search = search, .known = known, .output = output, .places = &places, .seeds = seeds, .limit = limit});
}

// Warns if the folder holds results of another scene, which the results of this search will replace.
void tell_of_another_scene(const fs::path& folder, const SceneFile& scene) {
  try {
    const fs::path best = folder / "best.toml";
    const std::optional<std::string> held = SceneFile::parse(look_into(best), best.string()).written("title");
    if (held && held != scene.written("title"))
      print_note(
          fmt::format("{} holds results of another scene, \"{}\", which this search will replace; --out names another folder",
                      folder.string(), *held));
  } catch (const InvalidInput&) {  // the folder has no readable result
  }
}

// Runs `softland cycle --search`, which searches the closing and the opening waveform of a cycle together.
int run_cycle_search(const Common& c, const verbs::Arguments& arguments) {
  static const verbs::Study cycle = verbs::cycle_study();
  verbs::Arguments own{{"search", {""}}};
  for (const auto& [name, words] : arguments) {
    const std::string as = name == "cycle" ? "rate" : name;
    require(std::ranges::find(cycle.options, as, &verbs::OptionRow::name) != cycle.options.end(),
            [&] { return fmt::format("--cycle must not be combined with --{}", name); });
    own[as] = words;
  }
  return run_study(cycle, c, own);
}

}  // namespace

int run_optimize(const Common& given, const verbs::Arguments& arguments) {
  const verbs::OptimizeRequest request = verbs::optimize_request(arguments);
  Common c = given;
  if (c.scene.empty() && !request.resume) c.scene = shipped_scene("mem-gold-pzt.toml").string();
  if (!request.cycle.empty()) return run_cycle_search(c, arguments);
  require(request.duty.empty(), "--duty must be given together with --cycle");
  std::optional<KnownSearch> known;
  StoredSearch search = new_or_resumed(c, request, known);
  const SearchOutput output = output_of(c);
  if (!known && !c.quiet) tell_of_another_scene(output.folder, search.scene);
  if (known && !c.quiet) tell_of_other_programs((known->place / evaluations_file).string());
  return search.seeds > 1 ? run_seeds(c, search, known, output, request.limit)
                          : run_search({.c = c, .search = search, .known = known, .output = output, .limit = request.limit});
}

}  // namespace softland::apps
