// The origin of the record of a study, as every JSON and every page states it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "document/document.h"
#include "reports/made_with.h"
#include "store/study_store.h"
#include "studies/closing/prepared.h"

namespace softland {

/// Every record of a study begins with these members; `scene` is null where it has none.
struct Origin {
  std::string kind;  ///< name of the verb, by which `report` knows the record
  std::string version, command;
  MadeWith made_with;
  nlohmann::json scene = {};    ///< resolved scene, quantities as text
  std::string scene_toml = {};  ///< the same as a file; empty where no page shows it
};
[[nodiscard]] Origin origin_of(const char* kind, const std::string& command);
[[nodiscard]] Origin origin_of(const char* kind, const PreparedScene& scene, const std::string& command);
/// Makes the origin with the text of the scene.
[[nodiscard]] Origin whole_origin_of(const char* kind, const PreparedScene& scene, const std::string& command);
/// Returns what a document says of a record with this origin, but for seed and tolerance.
[[nodiscard]] MadeAgain made_again(const Origin& origin, std::optional<std::uint64_t> seed = {},
                                   double tolerance = std::numeric_limits<double>::quiet_NaN());
/// Returns the title of the scene; empty where it has none.
[[nodiscard]] std::string title_of(const Origin& origin);

/// Returns the record with version, made_with and command.
[[nodiscard]] nlohmann::json with_origin(nlohmann::json record, const std::string& command);
/// Does the same and adds the resolved scene.
[[nodiscard]] nlohmann::json with_origin(nlohmann::json record, const PreparedScene& scene, const std::string& command);

/// Describes the writer of a store: this program on this machine, for this command.
[[nodiscard]] StoredOrigin stored_origin(const std::string& command);

}  // namespace softland
