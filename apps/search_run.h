// A search on the command line continues the one in its folder, and shows its progress.
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

/// Returns the search of the command line. With --resume it continues one in the folder of --out, if there is one, which is
/// then `known`. Throws InvalidInput with option, value and rule. Throws it also where no search in the folder is the requested
/// one, with the difference.
[[nodiscard]] StoredSearch asked_or_known(const Common& common, const verbs::OptimizeRequest& request,
                                          std::optional<KnownSearch>& known);

/// Returns the folder of --out.
[[nodiscard]] SearchOutput output_of(const Common& common);

/// A search that is kept in its folder and shows its progress.
class SearchRun {
 public:
  /// `places`: see SearchSession. Sets the callbacks of search.options, which must outlive it.
  SearchRun(const Common& common, StoredSearch& search, const std::optional<KnownSearch>& known, const SearchOutput& output,
            SearchPlaces* places = nullptr);

  /// Call it when the search has ended: reports the end, and closes the store.
  void close();
  [[nodiscard]] SearchSession& session() { return session_; }

 private:
  void tell(const Leading& leading);
  [[nodiscard]] std::string duration_words(int jobs, double max_seconds) const;

  const Common& common_;
  std::optional<WatchedWork> preparation_;
  SearchProgress progress_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  bool has_table_ = false;
  std::optional<SearchEstimate> estimate_;
  SearchSession session_;
};

/// Returns "gold.toml: searching a pulse waveform, actuator electrostatic, target bounce".
[[nodiscard]] std::string search_words(const Common& common, const StoredSearch& search);

}  // namespace softland::apps
