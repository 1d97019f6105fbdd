// A search as its stores keep it: the plan of everything that decides its result, by which it can be continued.
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

/// The text of a scene as it was given, with its name and folder for messages.
struct GivenText {
  std::string file, folder, text;  ///< `folder`: base of its relative paths
};

/// A scene whose waveforms a search begins with.
struct StartingScene {
  std::string name;  ///< name as given
  SceneFile scene;
};

/// The request of a search. Missing parts are as in the search that is continued, if there is one.
struct AskedSearch {
  SearchRequest request = {};
  std::optional<GivenText> given = {};
  std::optional<SceneFile> scene = {};  ///< scene of that text, with the assignments; none without a text
  std::vector<std::string> set = {};    ///< assignments: "structure.length=250 um"
  std::vector<StartingScene> starts = {};
  int jobs = 1;
  const std::atomic<bool>* stop = nullptr;
};

struct StoredSearch : PlannedSearch {
  nlohmann::json plan;
};

/// The search that is continued.
struct KnownSearch {
  std::filesystem::path place;  ///< folder with its stores
  nlohmann::json plan;
  std::string command;  ///< command that began it
};

/// Plans a search. `known` is the plan of the search that is continued, or null; a scene must be given then. Throws
/// InvalidRequest with field, value and rule, and what a scene throws.
[[nodiscard]] StoredSearch stored_search(const AskedSearch& asked, const nlohmann::json& known = {});

/// Plans a search that continues one in `stores`, the first possible one, which becomes `known`; a new search if there are no
/// stores. Throws as stored_search(), and InvalidRequest of the field `resume` if no store holds the requested search, with the
/// differences.
[[nodiscard]] StoredSearch stored_search(const AskedSearch& asked, const std::vector<std::filesystem::path>& stores,
                                         std::optional<KnownSearch>& known);

/// Why a requested search does not continue one of the plan `there`, in words of fields as requested() marks them. Empty if it
/// does: they differ in nothing but the budget, or the requested one has more seeds.
[[nodiscard]] std::string difference(const nlohmann::json& there, const nlohmann::json& asked);

/// Plan for one of its seeds alone, which decides the bits of that search.
[[nodiscard]] nlohmann::json plan_of_seed(const nlohmann::json& plan, std::uint64_t seed);

/// Most evaluations of the whole search: one over devices takes at least eight devices each, except for those of its scouting.
[[nodiscard]] std::int64_t evaluations_at_most(const PlannedSearch& search);

}  // namespace softland
