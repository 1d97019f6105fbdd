// One search on its way: the folder it fills, the store of its evaluations, its progress and its log.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/evaluation_store.h"
#include "apps/kept_search.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/search_log.h"

namespace softland::apps {

/// In the folder of searches from several seeds.
inline constexpr const char* seeds_file = "seeds.sqlite";

/// The search that is gone on with.
struct KnownSearch {
  std::filesystem::path place;  ///< the folder with its stores
  nlohmann::json plan;
  std::string command;  ///< that began it
};

/// What the command line asks for, as a search that goes on with one in the folder of --out where it says --resume and there is
/// one, which is then `known`. Throws InvalidInput as kept_search() does, and where no search in the folder is the one that is
/// asked for, with what differs.
[[nodiscard]] KeptSearch kept_or_known(const Common& common, const OptimizeRequest& request, std::optional<KnownSearch>& known);

/// Where a search keeps what it finds.
class SearchPlaces {
 public:
  /// Takes the folder of --out and opens the store of evaluations, for a search of these parameters.
  SearchPlaces(const Common& common, const KeptSearch& search, const std::optional<KnownSearch>& known,
               const std::vector<std::string>& variables);

  [[nodiscard]] ResultFolder& folder() { return folder_; }
  [[nodiscard]] EvaluationStore& evaluations() { return evaluations_; }
  /// Where another store of the search is.
  [[nodiscard]] std::filesystem::path store(const std::string& name);
  /// Whether the stores are, or will be, among results that are put here.
  [[nodiscard]] bool stores_go_to(const std::filesystem::path& place) const { return !kept_ || place == folder_.path(); }

 private:
  std::optional<std::filesystem::path> kept_;  // the stores of the folder itself are gone on with
  ResultFolder folder_;
  EvaluationStore evaluations_;
};

/// Runs a search, tells how far it is, and keeps its log.
class SearchRun {
 public:
  /// `places`: those of a study that it is part of; null: it takes its own when it begins. Sets the callbacks of search.options,
  /// which must outlive it.
  SearchRun(const Common& common, KeptSearch& search, const std::optional<KnownSearch>& known, SearchPlaces* places = nullptr);

  /// When the search has ended: says so, and lets the store go.
  void close();
  [[nodiscard]] ResultFolder& folder() { return places_->folder(); }
  [[nodiscard]] const SearchPlaces& places() const { return *places_; }
  [[nodiscard]] const SearchLog& log() const { return *log_; }
  /// The command lines that make its result again.
  [[nodiscard]] std::vector<std::string> commands() const;

 private:
  void begin(const std::vector<std::string>& variables);

  const Common& common_;
  KeptSearch& search_;
  const std::optional<KnownSearch>& known_;
  std::optional<WatchedWork> preparation_;
  SearchProgress progress_;
  std::optional<SearchPlaces> own_;
  SearchPlaces* places_;
  std::optional<SearchLog> log_;
};

/// "gold.toml: searching a pulse waveform, actuator electrostatic, target bounce"
[[nodiscard]] std::string search_words(const Common& common, const KeptSearch& search);

}  // namespace softland::apps
