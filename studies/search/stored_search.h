// The plan of a search, as its stores keep it: everything on which the result depends, so that the search can be continued.
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

/// The text of a scene as it was given, with the name and the folder of its file.
struct GivenText {
  std::string file, folder, text;  ///< `folder` is the base of relative paths in the scene
};

/// A scene with whose waveforms a search begins.
struct StartingScene {
  std::string name;  ///< name of the scene as it was given
  SceneFile scene;
};

/// The request of a search. If it continues a search, missing parts are taken from that search.
struct AskedSearch {
  SearchRequest request = {};
  std::optional<GivenText> given = {};
  std::optional<SceneFile> scene = {};  ///< scene of that text with the assignments; none without a text
  std::vector<std::string> set = {};    ///< assignments: "structure.length=250 um"
  std::vector<StartingScene> starts = {};
  int jobs = 1;
  const std::atomic<bool>* stop = nullptr;
};

struct StoredSearch : PlannedSearch {
  nlohmann::json plan;
};

/// The search that is continued, and its stores.
struct KnownSearch {
  std::filesystem::path place;  ///< folder with its stores
  nlohmann::json plan;
  std::string command;  ///< command by which it was begun
};

/// Plans a search. `known` is the plan of the search that is continued; a request without one must have a scene. Throws
/// InvalidRequest with field, value and rule, and what reading a scene throws.
[[nodiscard]] StoredSearch stored_search(const AskedSearch& asked, const nlohmann::json& known = {});

/// Plans a search that continues a search in one of `stores`: the first one that the request fits, which becomes `known`.
/// It plans a new search without stores. Throws as stored_search() does. If no store holds the requested search, it throws
/// InvalidRequest about the field `resume`, with the differences.
[[nodiscard]] StoredSearch stored_search(const AskedSearch& asked, const std::vector<std::filesystem::path>& stores,
                                         std::optional<KnownSearch>& known);

/// Returns the reason why a request does not continue the search of the plan `there`, with fields marked as by requested().
/// Empty if it does: only the budget differs, or the request has more seeds.
[[nodiscard]] std::string difference(const nlohmann::json& there, const nlohmann::json& asked);

/// Returns the plan of the search from one seed alone. The evaluations of that search depend on this plan only.
[[nodiscard]] nlohmann::json plan_of_seed(const nlohmann::json& plan, std::uint64_t seed);

/// Returns the largest number of evaluations of the whole search. Over devices an evaluation takes at least eight of them,
/// except in the scouting.
[[nodiscard]] std::int64_t evaluations_at_most(const PlannedSearch& search);

}  // namespace softland
