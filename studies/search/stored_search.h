// The plan of a search, as its database files contain it: everything on which the result depends, so that the search can be
// continued.
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

/// The text of the scene that the user gave, with the name and the folder of its file.
struct GivenText {
  std::string file, folder, text;  ///< `folder` is the base of relative paths in the scene
};

/// A scene whose waveforms are a start of the search.
struct StartingScene {
  std::string name;  ///< name of the scene as the user gave it
  SceneFile scene;
};

/// The request of a search. A request that continues an earlier search gets its missing parts from that search.
struct AskedSearch {
  SearchRequest request = {};
  std::optional<GivenText> given = {};
  std::optional<SceneFile> scene = {};  ///< scene of `given` with the assignments `set`; none without `given`
  std::vector<std::string> set = {};    ///< assignments to keys of the scene: "structure.length=250 um"
  std::vector<StartingScene> starts = {};
  int jobs = 1;
  const std::atomic<bool>* stop = nullptr;
};

struct StoredSearch : PlannedSearch {
  nlohmann::json plan;
};

/// An earlier search that is continued.
struct KnownSearch {
  std::filesystem::path place;  ///< folder with the search's database files
  nlohmann::json plan;
  std::string command;  ///< command that began the search
};

/// Plans a search. `known` is the plan of a search that is continued; without this plan the request must have a scene. Throws
/// InvalidRequest with field, value and rule, and what reading a scene throws.
[[nodiscard]] StoredSearch stored_search(const AskedSearch& asked, const nlohmann::json& known = {});

/// Plans a search that continues the first search in the database files `stores` that matches the request; this search becomes
/// `known`. Plans a new search if `stores` is empty. Throws what the other stored_search() throws, and InvalidRequest about the
/// field `resume`, with the differences, if no search matches.
[[nodiscard]] StoredSearch stored_search(const AskedSearch& asked, const std::vector<std::filesystem::path>& stores,
                                         std::optional<KnownSearch>& known);

/// Returns the reason why the plan `asked` does not continue the search of the plan `there`, with fields marked as by
/// requested(). Empty if `asked` continues it: the plans differ only in the budget, or `asked` has more seeds.
[[nodiscard]] std::string difference(const nlohmann::json& there, const nlohmann::json& asked);

/// Returns the plan of the search from one seed alone. The evaluations of the search from this seed depend on this plan only.
[[nodiscard]] nlohmann::json plan_of_seed(const nlohmann::json& plan, std::uint64_t seed);

/// Returns the largest number of evaluations of the whole search. Most evaluations over varied devices take at least eight
/// closings.
[[nodiscard]] std::int64_t evaluations_at_most(const PlannedSearch& search);

}  // namespace softland
