#include "apps/search_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "apps/scenes.h"
#include "apps/streams.h"
#include "base/read_file.h"
#include "base/require.h"
#include "document/quantity.h"
#include "document/text.h"
#include "studies/search/search_space.h"

namespace softland::apps {
namespace {

namespace fs = std::filesystem;

AskedSearch asked(const Common& c, const verbs::OptimizeRequest& request) {
  AskedSearch asked{.request = request, .set = c.set, .jobs = request.jobs, .stop = c.stop};
  if (!c.scene.empty()) {
    asked.given = {.file = c.scene, .folder = fs::absolute(c.scene).parent_path(), .text = read_file(c.scene)};
    asked.scene = load_scene(c);
  }
  for (const std::string& name : request.starts) {
    require(!name.empty(), "--start: must not be empty");
    asked.starts.push_back({.name = name, .scene = scene_of_result(name)});
  }
  return asked;
}

// Returns the names of waveform families as words for a message: "knots, dual-pulse or staircase:5".
std::string families_in_words(const std::string& families) {
  const std::vector<std::string> names = families_of(families);
  std::string words = names.front();
  for (std::size_t k = 1; k < names.size(); ++k) words += (k + 1 == names.size() ? " or " : ", ") + names[k];
  return words;
}

// Returns the names of the drives (actuating electrodes or piezos) that occur in names of search variables such as
// "knots.main.level_1_V" or "main.level_1_V"; every drive is named once.
std::vector<std::string> shaped_in(const std::vector<std::string>& variables) {
  std::vector<std::string> drives;
  for (const std::string& name : variables) {
    const std::size_t end = name.rfind('.'), begin = end == 0 ? 0 : name.rfind('.', end - 1) + 1;
    std::string drive = name.substr(begin, end - begin);
    if (std::ranges::find(drives, drive) == drives.end()) drives.push_back(std::move(drive));
  }
  return drives;
}

}  // namespace

StoredSearch new_or_resumed(const Common& c, const verbs::OptimizeRequest& request, std::optional<KnownSearch>& known) {
  const std::vector<fs::path> stores = request.resume ? ResultFolder::places(c.out, evaluations_file) : std::vector<fs::path>();
  require(!stores.empty() || !c.scene.empty(), [&] {
    return fmt::format("--resume: {} holds no search to continue; name its folder by --out, or omit --resume", c.out);
  });
  return stored_search(asked(c, request), stores, known);
}

SearchOutput output_of(const Common& c) {
  return {.folder = c.out,
          .command = c.command,
          .claim = [&c](const std::vector<std::string>& files, const std::vector<std::string>& kept) {
            return *reserve_outputs(c, files, kept);
          }};
}

SearchRun::SearchRun(const Common& c, StoredSearch& search, const std::optional<KnownSearch>& known, const SearchOutput& output,
                     SearchPlaces* places)
    : common_(c),
      preparation_(std::in_place, c.quiet, c.stop),
      progress_(c.quiet, search.options, search.robust ? "closings" : "evaluations",
                search.for_devices ? "nominal design: " : ""),
      session_(search, known, output, places) {
  OptimizeOptions& options = search.options;
  options.on_preparation = [this](std::string_view what, double part) {
    if (preparation_) preparation_->progress().tell(what, part);
  };
  options.on_start = [this, &search, is_told = places == nullptr && !c.quiet](const FamilyColumns& columns) {
    preparation_.emplace(common_.quiet, common_.stop);
    session_.begin(columns);
    if (is_told)
      print_note(search_prose(common_, search) + fmt::format("; shaped drives: {}; results go to {}{}",
                                                             fmt::join(shaped_in(columns.names()), " and "), common_.out,
                                                             duration_prose(search.options.jobs, search.options.max_seconds)));
  };
  options.on_estimate = [this](const SearchEstimate& estimate) { estimate_ = estimate; };
  options.on_evaluation = [this](const Evaluation& e, const OptimizeProgress& p) {
    session_.evaluated(e);
    progress_.show(p);
  };
  options.on_progress = [this](const OptimizeProgress& p) { progress_.show(p); };
  options.on_improvement = [this](const Evaluation&, const SceneFile& best) { session_.improved(best); };
  if (search.for_devices) {
    search.for_devices->on_leading = [this](const Leading& leading) {
      session_.improved(leading.scene);
      if (!common_.quiet) tell(leading);
    };
  }
}

// Returns a sentence with the estimated duration of the search and its number of simulated closings.
std::string SearchRun::duration_prose(int jobs, double max_seconds) const {
  if (!estimate_) return {};
  const SearchEstimate& e = *estimate_;
  std::string text = "; simulating a closing takes " + internal::quantity(e.closing, "s");
  if (std::isfinite(max_seconds)) return text;
  const double seconds = e.seconds / std::max(1, jobs), minute = 60, hour = 3600;
  text += seconds < 2 * minute ? fmt::format(", the whole search about {:.0f} s", std::max(1.0, seconds))
          : seconds < 2 * hour ? fmt::format(", the whole search about {:.0f} min", seconds / minute)
                               : fmt::format(", the whole search about {:.0f} h", seconds / hour);
  if (!e.has_fewer) return text;
  text += e.closings > 0 && e.evaluations > 0
              ? fmt::format(": {} evaluations and {} closings of devices", e.evaluations, e.closings)
          : e.closings > 0 ? fmt::format(": {} closings of devices", e.closings)
                           : fmt::format(": {} evaluations", e.evaluations);
  return text + ", fewer than usual, because its closings are slow to simulate";
}

// Prints a row of the table of the best waveforms so far when the search has found a better waveform; prints the table's head
// before the first row.
void SearchRun::tell(const Leading& leading) {
  const auto row = [&](const std::string& name, const std::vector<DeviceOutcome>& outcomes, const std::string& after) {
    const auto figure = [](double value, std::string_view unit) {
      return std::isfinite(value) ? internal::quantity(value, unit) : "∞";
    };
    std::string text = "  " + internal::left_aligned(name, 16);
    for (const std::string_view key : {key_of(&Metrics::largest_impact_velocity), key_of(&Metrics::major_bounce_height)}) {
      const std::string_view unit = figure_of(key).unit;
      text += internal::right_aligned(
          figure(quantile(outcomes, key, 0.95), unit) + " (" + figure(quantile(outcomes, key, 0.99), unit) + ")", 24);
    }
    print_note(text + internal::right_aligned(figure(waited(outcomes, leading.waited_for), "s"), 14) + after);
  };
  if (!std::exchange(has_table_, true)) {
    print_note(
        fmt::format("Best waveforms so far, on {} simulated devices; the search continues. Columns: 95th (99th) percentile.",
                    leading.own.size()));
    print_note(fmt::format("  {:16}{:>24}{:>24}{:>14}   {}", "waveform", "largest impact velocity", "highest rebound",
                           "settled after", "found after"));
    row("plain step", leading.of_step, "");
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  row(leading.family, leading.own, fmt::format("   {:.0f} s", elapsed.count()));
}

void SearchRun::close() {
  preparation_.reset();
  progress_.close();
  session_.close();
}

std::string search_prose(const Common& c, const StoredSearch& search) {
  const OptimizeOptions& o = search.options;
  const std::string scene = c.scene.empty() ? c.out : c.scene;
  const std::string aim = fmt::format("actuator {}, target {}", name_of(actuators, o.actuator), o.target.text());
  if (search.for_devices)
    return fmt::format("{}: searching waveforms under process variation, and one for the nominal design, {}", scene, aim);
  const std::string devices =
      search.robust ? fmt::format(", over devices of [spread] ({})", search.robust->aim.measure.text) : std::string();
  return fmt::format("{}: searching a {} waveform, {}{}", scene, families_in_words(o.family), aim, devices);
}

}  // namespace softland::apps
