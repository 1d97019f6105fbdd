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

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reports/result_folder.h"
#include "reports/search_log.h"
#include "reports/search_report.h"
#include "studies/search/evaluation_store.h"
#include "studies/search/stored_search.h"

namespace softland {

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
