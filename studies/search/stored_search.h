// The stored request (plan) of a search, as in its database files. It contains everything on which the result depends, so that
// the search can be resumed.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "config/scene.h"
#include "studies/search/search_request.h"

namespace softland {

/// The scene as the user gave it.
struct GivenText {
  /// Name of the scene's file, folder to which relative paths in the scene refer, and text of the scene.
  std::string file, folder, text;
};

/// A scene whose waveforms are a starting point of the search.
struct StartingScene {
  std::string name;  ///< name of the starting scene as the user gave it
  SceneFile scene;
};

/// The request of a search. A request that continues an earlier search gets its missing parts from that search.
struct AskedSearch {
  SearchRequest request = {};
  std::optional<GivenText> given = {};
  std::optional<SceneFile> scene = {};  ///< scene of the text `given` with the assignments `set`; none without `given`
  std::vector<std::string> set = {};    ///< assignments of values to keys of the scene: "structure.length=250 um"
  std::vector<StartingScene> starts = {};
  int jobs = 1;
  const std::atomic<bool>* stop = nullptr;
};

struct StoredSearch : PlannedSearch {
  nlohmann::json plan;
};

/// An earlier search that a new run continues.
struct KnownSearch {
  std::filesystem::path place;  ///< folder with the database files of the search
  nlohmann::json plan;
  std::string command;  ///< command line that began the earlier search
};

/// Returns the search that a request describes. `known` is the plan (stored request) of an earlier search that is continued;
/// without it the request must have a scene. Throws InvalidRequest with field, value and rule, and the exceptions of reading a
/// scene.
[[nodiscard]] StoredSearch stored_search(const AskedSearch& asked, const nlohmann::json& known = {});

/// Plans a search that continues an earlier one: the first in the database files `stores` that the request matches, which is
/// returned in `known`. Plans a new search if `stores` is empty. Throws the exceptions of the other stored_search(), and
/// InvalidRequest about the field `resume`, with the differences, if no search matches.
[[nodiscard]] StoredSearch stored_search(const AskedSearch& asked, const std::vector<std::filesystem::path>& stores,
                                         std::optional<KnownSearch>& known);

/// Returns the reason why the search with the stored request (plan) `asked` does not continue that of the plan `there`, with
/// fields marked as by requested(). Empty if `asked` continues it: the plans differ only in the budget, or `asked` has more
/// seeds.
[[nodiscard]] std::string difference(const nlohmann::json& there, const nlohmann::json& asked);

/// Returns the stored request (plan) of the search from one seed alone. The evaluations of the search from this seed depend on
/// this plan only.
[[nodiscard]] nlohmann::json plan_of_seed(const nlohmann::json& plan, std::uint64_t seed);

/// Returns the largest number of evaluations that the whole search can make. An evaluation over varied devices is counted as
/// eight closings, since most take at least as many.
[[nodiscard]] std::int64_t evaluations_at_most(const PlannedSearch& search);

}  // namespace softland
