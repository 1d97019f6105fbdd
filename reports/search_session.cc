#include "reports/search_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "base/require.h"
#include "base/shell_word.h"
#include "reports/origin.h"
#include "reports/report_files.h"
#include "store/study_store.h"

namespace softland {
namespace {

namespace fs = std::filesystem;

// Returns the names of all files that any search may write: files of an earlier search must not remain beside the results of a
// new search.
std::vector<std::string> files_of_searches() {
  std::vector<std::string> files{"best.toml",      "best.csv",        "report.html",    "gap.svg", "result.json",
                                 "trajectory.csv", "evaluations.csv", evaluations_file, seeds_file};
  files.insert(files.end(), robustness_files.begin(), robustness_files.end());
  files.insert(files.end(), for_devices_files.begin(), for_devices_files.end());
  return files;
}

std::optional<fs::path> kept_stores(const SearchOutput& output, const std::optional<KnownSearch>& known) {
  std::error_code ignored;
  return known && fs::equivalent(known->place, output.folder, ignored) ? std::optional(known->place) : std::nullopt;
}

ResultFolder claimed(const SearchOutput& output, const StoredSearch& search, const std::optional<KnownSearch>& known) {
  const bool stays = kept_stores(output, known).has_value();
  std::vector<std::string> kept;
  if (stays) kept = {evaluations_file};
  if (stays && search.seeds > 1) kept.emplace_back(seeds_file);
  ResultFolder folder = output.claim(files_of_searches(), kept);
  // The database file of the search to continue was found before this run locked the folder: another run may have moved it
  // since.
  require_request(!known || is_store(known->place / evaluations_file), [&] {
    return fmt::format("{}: {} was removed; try again", requested("resume"), (known->place / evaluations_file).string());
  });
  if (known && !stays) folder.adopt(known->place);
  return folder;
}

}  // namespace

SearchPlaces::SearchPlaces(const SearchOutput& output, const StoredSearch& search, const std::optional<KnownSearch>& known,
                           const FamilyColumns& columns)
    : kept_(kept_stores(output, known)),
      folder_(claimed(output, search, known)),
      evaluations_(store(evaluations_file), search.plan, evaluations_at_most(search), search.options.seed, columns,
                   stored_origin(output.command)) {}

fs::path SearchPlaces::store(const std::string& name) { return kept_ ? *kept_ / name : folder_.place(name); }

SearchSession::SearchSession(StoredSearch& search, const std::optional<KnownSearch>& known, const SearchOutput& output,
                             SearchPlaces* places)
    : search_(search), known_(known), output_(output), places_(places) {}

void SearchSession::begin(const FamilyColumns& columns) {
  if (places_ == nullptr) places_ = &own_.emplace(output_, search_, known_, columns);
  search_.options.memory = &places_->evaluations();
  FamilyColumns of_log = columns;
  // evaluations.csv has only the requested waveform families, not those that a search under process variation adds.
  of_log.families.resize(families_of(search_.options.family).size());
  log_.emplace(places_->folder(), std::move(of_log));
}

void SearchSession::evaluated(const Evaluation& evaluation) {
  places_->evaluations().check();
  log_->evaluated(evaluation);
}

void SearchSession::close() {
  log_->flush();
  places_->evaluations().close();
}

fs::path SearchSession::destination(const SearchReport& report) const {
  return places_->folder().destination(report.found.interrupted());
}

void SearchSession::add_log(SearchRecord& search, const SearchReport& report) const {
  for (const auto& [index, e] : log_->evaluations()) search.course.evaluations.push_back({static_cast<double>(index), e.value});
  search.course.evaluations = drawn_evaluations(std::move(search.course.evaluations));
  if (known_ && known_->command != output_.command) search.reproduce.push_back(known_->command);
  search.reproduce.push_back(output_.command);
  search.reproduce.push_back("softland simulate " + shell_word((destination(report) / "best.toml").string()));
}

std::vector<std::string> SearchSession::leave(const SearchReport& report) {
  std::vector<std::string> left, kept{"evaluations.csv"};
  if (places_->stores_go_to(destination(report))) {
    kept.emplace_back(evaluations_file);
    if (report.result.search->seeds) kept.emplace_back(seeds_file);
  }
  const std::string last = report.found.best().best_scene ? "best.csv" : "result.json";
  for (const ReportFile<SearchReport>& file : softland::files_of(report)) {
    places_->folder().write(file.name, file.text(report));
    left.push_back(file.name);
    if (file.name == last) left.insert(left.end(), kept.begin(), kept.end());
  }
  places_->folder().publish(report.found.interrupted());
  return left;
}

}  // namespace softland
