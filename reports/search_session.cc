#include "reports/search_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/require.h"
#include "base/shell_word.h"
#include "config/scene.h"
#include "document/csv_cell.h"
#include "reports/origin.h"
#include "reports/report_files.h"
#include "store/study_store.h"

namespace softland {
namespace {

// Returns the command line that writes the waveform for a measured device, or, if calibration gains nothing, the waveform for
// all devices; empty if the search found neither.
std::string next_command(const RobustSearchResult& found, const std::filesystem::path& folder) {
  if (!found.calibrated && !found.chosen) return {};
  if (!found.calibrated) return fmt::format("softland export {} --format spice-pwl", shell_word(folder.string()));
  const bool by_time = found.calibrated->written("calibration.time").has_value();
  return fmt::format("softland export {} --measured \"{}\"", shell_word((folder / "calibrated.toml").string()),
                     by_time ? fmt::format("{}={:.4g} us", measured_time, 1e6 * found.closing_time)
                             : fmt::format("{}={:.4g} V", measured_pull_in, found.pull_in));
}

RobustnessOptions options_of(const PlannedSearch& search, std::uint64_t devices) {
  return {.samples = devices, .seed = search.options.seed, .jobs = search.options.jobs};
}

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

SearchLog::SearchLog(ResultFolder& folder, FamilyColumns columns) : folder_(folder), columns_(std::move(columns)) { flush(); }

void SearchLog::evaluated(const Evaluation& evaluation) {
  const std::scoped_lock lock(mutex_);
  evaluations_[evaluation.index] = evaluation;
  if (pending_ && std::chrono::steady_clock::now() - written_ > std::chrono::seconds(1)) write();
}

void SearchLog::improved(const SceneFile& best) {
  const std::scoped_lock lock(mutex_);
  best_ = best.text();
  pending_ = true;
  if (std::chrono::steady_clock::now() - written_ > std::chrono::seconds(1)) write();
}

void SearchLog::flush() {
  const std::scoped_lock lock(mutex_);
  write();
}

void SearchLog::write() {
  if (!best_.empty()) folder_.write("best.toml", best_);
  std::string log = "index,cost";
  for (const std::string& name : columns_.names()) log += "," + name;
  log += "\n";
  for (const auto& [index, e] : evaluations_) {
    log += fmt::format("{},{}", index, e.value);
    for (const double x : columns_.row(e.problem, e.x)) log += "," + internal::csv_cell(x);
    log += "\n";
  }
  folder_.write("evaluations.csv", log);
  pending_ = false;
  written_ = std::chrono::steady_clock::now();
}

void add_devices(SearchReport& report, const PlannedSearch& search, const std::string& command, const Progress& progress) {
  if (const auto* searched = std::get_if<RobustSearchResult>(&report.found.result);
      searched != nullptr && !searched->rows.empty()) {
    report.devices.emplace(RobustnessReport{.nominal = searched->varied,
                                            .found = searched->verdict,
                                            .options = options_of(search, search.for_devices->verdict),
                                            .command = command,
                                            .windows = searched->findings.windows});
  }
  const auto* robust = std::get_if<RobustResult>(&report.found.result);
  if (robust == nullptr || !robust->verdict) return;
  report.devices.emplace(RobustnessReport{.nominal = *robust->found.best_scene,
                                          .found = *robust->verdict,
                                          .options = options_of(search, search.robust->verdict),
                                          .command = command});
  add_details(*report.devices, false, progress);
  if (report.devices->interrupted) report.found.best().search.termination = Termination::interrupted;
}

void add_result(SearchReport& report, const PlannedSearch& search, const std::filesystem::path& folder,
                const std::string& command) {
  const auto& found = report.found.result;
  if (const auto* nominal = std::get_if<OptimizeResult>(&found)) {
    report.result = record_of(*nominal, search.options, command);
  } else if (const auto* robust = std::get_if<RobustResult>(&found)) {
    report.result = record_of(*robust, search.options, command);
  } else {
    const auto& searched = std::get<RobustSearchResult>(found);
    report.result = record_of(searched, search.options, next_command(searched, folder), command);
  }
}

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
