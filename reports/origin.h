// Where a record of a study comes from, as every JSON and every page says it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/result.h"
#include "store/study_store.h"
#include "studies/closing/prepared.h"

namespace softland {

/// The record with version, made_with and command.
[[nodiscard]] nlohmann::json with_origin(nlohmann::json record, const std::string& command);
/// With the scene, resolved, besides.
[[nodiscard]] nlohmann::json with_origin(nlohmann::json record, const PreparedScene& scene, const std::string& command);

/// Who writes into a store: this program on this machine, for this command.
[[nodiscard]] StoredOrigin stored_origin(const std::string& command);

namespace internal {

/// What the foot of a page says of it.
[[nodiscard]] Result origin(const PreparedScene& scene, const std::string& command);

}  // namespace internal
}  // namespace softland
