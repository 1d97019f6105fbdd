// Runs a search from the command line: stores the search in a folder, resumes a search from there, and shows the progress.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "apps/output.h"
#include "apps/progress.h"
#include "reports/search_session.h"
#include "verbs/optimize.h"

namespace softland::apps {

/// Returns the search that the command line describes. With --resume, the search in the folder of --out is continued, and
/// `known` receives the database files of that earlier search. Throws InvalidInput with option, value and rule, or, if the
/// folder holds another search, with the difference.
[[nodiscard]] StoredSearch new_or_resumed(const Common& common, const verbs::OptimizeRequest& request,
                                          std::optional<KnownSearch>& known);

/// Returns the folder of --out as the place to which a search writes its results.
[[nodiscard]] SearchOutput output_of(const Common& common);

/// A search that stores its evaluations in a folder and shows its progress.
class SearchRun {
 public:
  /// Sets the callbacks of search.options; `search` must outlive this object. `places` are the result folders that are common
  /// to searches with several random seeds; null for a single search.
  SearchRun(const Common& common, StoredSearch& search, const std::optional<KnownSearch>& known, const SearchOutput& output,
            SearchPlaces* places = nullptr);

  /// Reports the end of the search and closes the database file; call it when the search has ended.
  void close();
  [[nodiscard]] SearchSession& session() { return session_; }

 private:
  void tell(const Leading& leading);
  [[nodiscard]] std::string duration_prose(int jobs, double max_seconds) const;

  const Common& common_;
  std::optional<ShownWork> preparation_;
  SearchProgress progress_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  bool has_table_ = false;
  std::optional<SearchEstimate> estimate_;
  SearchSession session_;
};

/// Returns a line that describes a search: "gold.toml: searching a pulse waveform, actuator electrostatic, target bounce".
[[nodiscard]] std::string search_prose(const Common& common, const StoredSearch& search);

}  // namespace softland::apps
