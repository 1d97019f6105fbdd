#include "apps/search_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "apps/stores.h"
#include "apps/streams.h"
#include "base/require.h"
#include "reports/origin.h"
#include "reports/report_files.h"
#include "studies/search_space.h"

namespace softland::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json plan_in(const fs::path& store) {
  json plan = json::parse(StudyReader(store).plan().text, nullptr, false);
  require(plan.is_object() && plan.contains("kind"), fmt::format("{}: holds no search", store.string()));
  return plan;
}

// Evaluations that a search may ask for: of a robust one each takes eight devices at least, but for those of its scouting.
std::int64_t most_evaluations(const KeptSearch& search) {
  constexpr std::int64_t most = std::int64_t{1} << 24, scouting = 4096;
  const std::int64_t budget = std::min<std::int64_t>(search.options.max_evaluations + search.options.more_evaluations, most);
  const std::int64_t of_race = search.for_devices ? std::min<std::int64_t>(2 * search.for_devices->closings / 8, most) : 0;
  const std::int64_t each = search.robust ? budget / 8 + scouting : budget + of_race;
  const auto seeds = static_cast<std::int64_t>(search.seeds);
  return each > most / seeds ? most : each * seeds;
}

std::vector<std::string> files_of(const KeptSearch& search) {
  std::vector<std::string> files{"best.toml",      "best.csv",        "report.html",    "gap.svg", "result.json",
                                 "trajectory.csv", "evaluations.csv", evaluations_file, seeds_file};
  if (search.robust || search.for_devices) files.insert(files.end(), robustness_files.begin(), robustness_files.end());
  if (search.for_devices) files.insert(files.end(), for_devices_files.begin(), for_devices_files.end());
  return files;
}

std::optional<fs::path> kept_stores(const Common& c, const std::optional<KnownSearch>& known) {
  std::error_code ignored;
  return known && fs::equivalent(known->place, c.out, ignored) ? std::optional(known->place) : std::nullopt;
}

ResultFolder claimed(const Common& c, const KeptSearch& search, const std::optional<KnownSearch>& known) {
  const bool stays = kept_stores(c, known).has_value();
  std::vector<std::string> kept;
  if (stays) kept = {evaluations_file};
  if (stays && search.seeds > 1) kept.emplace_back(seeds_file);
  ResultFolder folder = *claim_places(c, files_of(search), kept);
  // Whoever held the folder until now may have put them elsewhere.
  require(!known || is_store(known->place / evaluations_file),
          [&] { return fmt::format("--resume: {} is gone; try again", (known->place / evaluations_file).string()); });
  if (known && !stays) folder.adopt(known->place);
  return folder;
}

// "knots, dual-pulse or staircase:5"
std::string families_in_words(const std::string& families) {
  const std::vector<std::string> names = families_of(families);
  std::string words = names.front();
  for (std::size_t k = 1; k < names.size(); ++k) words += (k + 1 == names.size() ? " or " : ", ") + names[k];
  return words;
}

// The drives of "knots.main.level_1_V" or "main.level_1_V", each once.
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

KeptSearch kept_or_known(const Common& c, const OptimizeRequest& request, std::optional<KnownSearch>& known) {
  if (!request.resume) return kept_search(c, request, {});
  std::string refusal;
  for (const fs::path& store : ResultFolder::places(c.out, evaluations_file)) {
    const json plan = plan_in(store);
    try {
      KeptSearch search = kept_search(c, request, plan);
      const std::string other = difference(plan, search.plan);
      if (other.empty()) {
        known = KnownSearch{.place = store.parent_path(), .plan = plan, .command = StudyReader(store).sessions().front().command};
        return search;
      }
      if (refusal.empty()) refusal = fmt::format("--resume: {} holds another search: {}", store.string(), other);
    } catch (const json::exception&) {
      throw InvalidInput(fmt::format("{}: holds a search of another version of softland", store.string()));
    }
  }
  require(refusal.empty(), refusal);
  require(!c.scene.empty(), [&] { return fmt::format("--resume: {} holds no search to go on with", c.out); });
  return kept_search(c, request, {});
}

SearchPlaces::SearchPlaces(const Common& c, const KeptSearch& search, const std::optional<KnownSearch>& known,
                           const std::vector<std::string>& variables)
    : kept_(kept_stores(c, known)),
      folder_(claimed(c, search, known)),
      evaluations_(store(evaluations_file), search.plan, most_evaluations(search), search.options.seed, variables,
                   stored_origin(c.command)) {}

fs::path SearchPlaces::store(const std::string& name) { return kept_ ? *kept_ / name : folder_.place(name); }

SearchRun::SearchRun(const Common& c, KeptSearch& search, const std::optional<KnownSearch>& known, SearchPlaces* places)
    : common_(c),
      search_(search),
      known_(known),
      preparation_(std::in_place, c.quiet, c.stop),
      progress_(c.quiet, search.options, search.robust ? "closings" : "evaluations"),
      places_(places) {
  OptimizeOptions& options = search.options;
  options.on_preparation = [this](std::string_view what, double part) {
    if (preparation_) preparation_->watch().tell(what, part);
  };
  options.on_start = [this](const std::vector<std::string>& variables) { begin(variables); };
  options.on_evaluation = [this](const Evaluation& e, const OptimizeProgress& p) {
    places_->evaluations().check();
    log_->evaluated(e);
    progress_.show(p);
  };
  options.on_progress = [this](const OptimizeProgress& p) { progress_.show(p); };
  options.on_improvement = [this](const Evaluation&, const SceneFile& best) { log_->improved(best); };
}

void SearchRun::begin(const std::vector<std::string>& variables) {
  preparation_.emplace(common_.quiet, common_.stop);
  if (places_ == nullptr) places_ = &own_.emplace(common_, search_, known_, variables);
  search_.options.memory = &places_->evaluations();
  std::vector<std::string> of_log = variables;  // that of the race is in the store alone
  std::erase_if(of_log, [](const std::string& name) { return name.starts_with(raced_prefix); });
  log_.emplace(places_->folder(), of_log);
  if (own_ && !common_.quiet)
    say(search_words(common_, search_) +
        fmt::format("; it shapes {}; results go to {}", fmt::join(shaped_in(variables), " and "), common_.out));
}

void SearchRun::close() {
  preparation_.reset();
  progress_.close();
  log_->flush();
  places_->evaluations().close();
}

std::vector<std::string> SearchRun::commands() const {
  if (!known_ || known_->command == common_.command) return {common_.command};
  return {known_->command, common_.command};
}

std::string search_words(const Common& c, const KeptSearch& search) {
  const OptimizeOptions& o = search.options;
  const std::string devices = search.robust ? fmt::format(", over devices of the spread ({})", search.robust->aim.measure.text)
                              : search.for_devices ? std::string(", then one for devices that differ")
                                                   : std::string();
  return fmt::format("{}: searching a {} waveform, actuator {}, target {}{}", c.scene.empty() ? c.out : c.scene,
                     families_in_words(o.family), name_of(actuators, o.actuator), o.target.text(), devices);
}

}  // namespace softland::apps
