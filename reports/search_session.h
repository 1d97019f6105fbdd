// A session runs a search from its first evaluation to its files. The session owns the folder, the log, and the database file
// of evaluations, from which the search can be resumed.
//
//   SearchSession session(search, known, output);
//   search.options.on_start = [&](const auto& columns) { session.begin(columns); };
//   search.options.on_evaluation = [&](const Evaluation& e, const auto&) { session.evaluated(e); };
//   search.options.on_improvement = [&](const Evaluation&, const SceneFile& best) { session.improved(best); };
//   SearchReport report(run(search));
//   session.close();
//   add_result(report, search, session.destination(report), {.command = command});
//   session.add_log(*report.result.search, report);
//   session.leave(report);
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "config/scene.h"
#include "optimizers/problem.h"
#include "reports/closing_record.h"
#include "reports/result_folder.h"
#include "reports/robustness_report.h"
#include "studies/search/evaluation_memory.h"
#include "studies/search/evaluation_store.h"
#include "studies/search/search_request.h"
#include "studies/search/stored_search.h"

namespace softland {

/// Writes best.toml and evaluations.csv to the unfinished results of a folder. Several threads may call the member functions.
class SearchLog {
 public:
  /// Writes evaluations.csv with these columns and no rows, so that a run with a folder that cannot be written ends before its
  /// first evaluation.
  SearchLog(ResultFolder& folder, FamilyColumns columns);

  /// Records an evaluation for evaluations.csv.
  void evaluated(const Evaluation& evaluation);
  /// Records a scene with a better waveform. best.toml and evaluations.csv are then written completely, but at most once a
  /// second.
  void improved(const SceneFile& best);
  /// Writes all evaluations and better scenes that are not yet on the disk.
  void flush();

  /// Returns the evaluations of the search by index; call it only after the last call of evaluated().
  [[nodiscard]] const std::map<long, Evaluation>& evaluations() const { return evaluations_; }

 private:
  void write();

  ResultFolder& folder_;
  FamilyColumns columns_;
  std::mutex mutex_;                        // guards evaluations and best scene, which several threads record
  std::map<long, Evaluation> evaluations_;  // evaluations by index, so that their order is the same for any number of threads
  std::string best_;
  bool pending_ = false;
  std::chrono::steady_clock::time_point written_{};
};

/// The result of a search of any kind, with the data for reports. `result` and `devices` keep references to `found`: a
/// SearchReport must not be moved.
struct SearchReport {
  explicit SearchReport(FoundSearch search) : found(std::move(search)) {}
  SearchReport(const SearchReport&) = delete;
  SearchReport& operator=(const SearchReport&) = delete;

  FoundSearch found;
  /// Report on simulated devices under process variation; none if no devices were simulated.
  std::optional<RobustnessReport> devices = {};
  ClosingRecord result = {};
};

/// Adds the report on devices under process variation. A search that minimises one statistic of the devices needs further
/// simulations for this, which `progress` watches; an interruption marks the search as interrupted.
void add_devices(SearchReport& report, const PlannedSearch& search, const std::string& command, const Progress& progress);

/// Sets `result`, from which reports are made. `folder` is the final folder of the files: a report suggests a command that
/// scales the waveform in the folder for a measured device.
void add_result(SearchReport& report, const PlannedSearch& search, const std::filesystem::path& folder,
                const std::string& command);

/// Name of the database file in the folder of a search with several seeds.
inline constexpr const char* seeds_file = "seeds.sqlite";

/// The place to which a search writes its results.
struct SearchOutput {
  std::filesystem::path folder;
  std::string command;
  /// Locks the result folder for a search that will write `files` and continue the files `kept` of an earlier run: see
  /// ResultFolder.
  std::function<ResultFolder(const std::vector<std::string>& files, const std::vector<std::string>& kept)> claim;
};

class SearchPlaces {
 public:
  /// Locks the result folder and opens the database file of evaluations for a search with these waveform parameters.
  SearchPlaces(const SearchOutput& output, const StoredSearch& search, const std::optional<KnownSearch>& known,
               const FamilyColumns& columns);

  [[nodiscard]] ResultFolder& folder() { return folder_; }
  [[nodiscard]] EvaluationStore& evaluations() { return evaluations_; }
  /// Returns the path of the database file `name` of the search, other than that of the evaluations.
  [[nodiscard]] std::filesystem::path store(const std::string& name);
  /// Returns true if the database files will be in the folder `place` at the end of the run.
  [[nodiscard]] bool stores_go_to(const std::filesystem::path& place) const { return !kept_ || place == folder_.path(); }

 private:
  // Folder of the database files; set when the search continues database files in the result folder itself.
  std::optional<std::filesystem::path> kept_;
  ResultFolder folder_;
  EvaluationStore evaluations_;
};

class SearchSession {
 public:
  /// Keeps references to `search`, `known` (an earlier search to continue), `output` and `places`. `places` are the folders of
  /// a study of several seeds; null: the session claims its own folder in begin().
  SearchSession(StoredSearch& search, const std::optional<KnownSearch>& known, const SearchOutput& output,
                SearchPlaces* places = nullptr);

  /// Opens result folder, database file and log; the search then reuses evaluations that the database file holds. Call it when
  /// the parameters of the searched waveforms are known. Throws the exceptions of ResultFolder, EvaluationStore and SearchLog.
  void begin(const FamilyColumns& columns);
  /// Adds an evaluation to the log. Throws the error if the database file could not be written.
  void evaluated(const Evaluation& evaluation);
  void improved(const SceneFile& best) { log_->improved(best); }
  /// Closes the database file; call it when the search has ended.
  void close();
  /// Returns the final folder of the result files.
  [[nodiscard]] std::filesystem::path destination(const SearchReport& report) const;
  /// Adds the costs of all evaluations, and the command lines that reproduce the result, to the results of the search.
  void add_log(SearchRecord& search, const SearchReport& report) const;
  /// Writes the result files and moves them to their final folder. Returns the names of these files, and of the files written
  /// during the search.
  std::vector<std::string> leave(const SearchReport& report);

 private:
  StoredSearch& search_;
  const std::optional<KnownSearch>& known_;
  const SearchOutput& output_;
  std::optional<SearchPlaces> own_;
  SearchPlaces* places_;
  std::optional<SearchLog> log_;
};

}  // namespace softland
