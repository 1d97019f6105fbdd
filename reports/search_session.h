// A session runs a search from its first evaluation to its files: it has the folder, the log, and the store of evaluations,
// from which the search can be resumed.
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

/// This store lies in the folder of searches from several seeds.
inline constexpr const char* seeds_file = "seeds.sqlite";

/// The destination of the findings of a search.
struct SearchOutput {
  std::filesystem::path folder;
  std::string command;
  /// Takes the folder for these files, of which some are those of an earlier run: see ResultFolder.
  std::function<ResultFolder(const std::vector<std::string>& files, const std::vector<std::string>& kept)> claim;
};

class SearchPlaces {
 public:
  /// Takes the folder and opens the store of evaluations, for a search of these parameters.
  SearchPlaces(const SearchOutput& output, const StoredSearch& search, const std::optional<KnownSearch>& known,
               const FamilyColumns& columns);

  [[nodiscard]] ResultFolder& folder() { return folder_; }
  [[nodiscard]] EvaluationStore& evaluations() { return evaluations_; }
  /// Returns the path of another store of the search.
  [[nodiscard]] std::filesystem::path store(const std::string& name);
  /// Tells whether the stores are, or will be, among results that are put here.
  [[nodiscard]] bool stores_go_to(const std::filesystem::path& place) const { return !kept_ || place == folder_.path(); }

 private:
  std::optional<std::filesystem::path> kept_;  // set when the stores of the folder itself are continued
  ResultFolder folder_;
  EvaluationStore evaluations_;
};

class SearchSession {
 public:
  /// Keeps references to search, known and output, and to `places`, those of a study that it is part of; null: it takes its own
  /// when it begins.
  SearchSession(StoredSearch& search, const std::optional<KnownSearch>& known, const SearchOutput& output,
                SearchPlaces* places = nullptr);

  /// Call it when the parameters are known: opens folder, store and log, and gives the search its memory. Throws what these
  /// throw.
  void begin(const FamilyColumns& columns);
  /// Throws the error that kept the store from keeping an evaluation.
  void evaluated(const Evaluation& evaluation);
  void improved(const SceneFile& best) { log_->improved(best); }
  /// Call it when the search has ended: closes the store.
  void close();
  /// Returns the final place of the files.
  [[nodiscard]] std::filesystem::path destination(const SearchReport& report) const;
  /// Adds the costs of the evaluations, and the command lines that make the result again.
  void add_log(SearchRecord& search, const SearchReport& report) const;
  /// Writes the files, puts them where they belong, and names them with those that were kept on the way.
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
