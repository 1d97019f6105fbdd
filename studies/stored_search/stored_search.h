// A search as its stores keep it: the plan of all that decides what it finds, from which it can be gone on with.
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

/// The text of a scene as it was given, with what its name and its lines are in messages.
struct GivenText {
  std::string file, folder, text;  ///< `folder`: where its relative paths begin
};

/// A scene whose waveforms a search begins with.
struct StartingScene {
  std::string name;  ///< as it was given
  SceneFile scene;
};

/// What is asked for. What is not said is as in the search that is gone on with, where there is one.
struct AskedSearch {
  SearchRequest request = {};
  std::optional<GivenText> given = {};
  std::optional<SceneFile> scene = {};  ///< of that text, with what is set; none where there is no text
  std::vector<std::string> set = {};    ///< what is set: "structure.length=250 um"
  std::vector<StartingScene> starts = {};
  int jobs = 1;
  const std::atomic<bool>* stop = nullptr;
};

struct StoredSearch : PlannedSearch {
  nlohmann::json plan;
};

/// The search that is gone on with.
struct KnownSearch {
  std::filesystem::path place;  ///< the folder with its stores
  nlohmann::json plan;
  std::string command;  ///< that began it
};

/// Plans a search. `known` is the plan of the search that is gone on with; a null value where there is none: then a scene must be
/// given. Throws InvalidRequest with field, value and rule, and what a scene throws.
[[nodiscard]] StoredSearch stored_search(const AskedSearch& asked, const nlohmann::json& known = {});

/// As a search that goes on with one in `stores`, the first that it can, which is then `known`; a new one where there is none.
/// Throws as stored_search(), and InvalidRequest of the field `resume` where no store holds the search that is asked for, with
/// what differs.
[[nodiscard]] StoredSearch stored_search(const AskedSearch& asked, const std::vector<std::filesystem::path>& stores,
                                         std::optional<KnownSearch>& known);

/// Why a search that is asked for does not go on with one of the plan `there`, in words of fields as requested() marks them;
/// empty where it does: they differ in nothing but the budget, or the asked one has more seeds.
[[nodiscard]] std::string difference(const nlohmann::json& there, const nlohmann::json& asked);

/// Of a plan for one of its seeds alone, which is what decides the bits of that search.
[[nodiscard]] nlohmann::json plan_of_seed(const nlohmann::json& plan, std::uint64_t seed);

/// Evaluations that all of it may ask for: of a robust one each takes eight devices at least, but for those of its scouting.
[[nodiscard]] std::int64_t evaluations_at_most(const PlannedSearch& search);

}  // namespace softland
