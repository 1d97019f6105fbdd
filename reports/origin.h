// Where a record of a study comes from, as every JSON and every page says it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/made_with.h"
#include "store/study_store.h"
#include "studies/closing/prepared.h"

namespace softland {

/// What every record of a study begins with; `scene` is null where it has none.
struct Origin {
  std::string kind;  ///< the name of the verb, by which `report` knows the record
  std::string version, command;
  MadeWith made_with;
  nlohmann::json scene = {};    ///< resolved, quantities as text
  std::string scene_toml = {};  ///< the same as a file; empty where no page shows it
};
[[nodiscard]] Origin origin_of(const char* kind, const std::string& command);
[[nodiscard]] Origin origin_of(const char* kind, const PreparedScene& scene, const std::string& command);
/// With the text of the scene.
[[nodiscard]] Origin whole_origin_of(const char* kind, const PreparedScene& scene, const std::string& command);
/// The title of the scene; empty where it has none.
[[nodiscard]] std::string title_of(const Origin& origin);

/// The record with version, made_with and command.
[[nodiscard]] nlohmann::json with_origin(nlohmann::json record, const std::string& command);
/// With the scene, resolved, besides.
[[nodiscard]] nlohmann::json with_origin(nlohmann::json record, const PreparedScene& scene, const std::string& command);

/// Who writes into a store: this program on this machine, for this command.
[[nodiscard]] StoredOrigin stored_origin(const std::string& command);

}  // namespace softland
