#include "reports/origin.h"

#include <fmt/format.h>

#include <utility>

#include "reports/made_with.h"
#include "version.h"

namespace softland {

using nlohmann::json;

json with_origin(json record, const std::string& command) {
  record.update({{"version", version}, {"made_with", made_with_json()}, {"command", command}});
  return record;
}

json with_origin(json record, const PreparedScene& scene, const std::string& command) {
  record["scene"] = scene.resolved().json();
  return with_origin(std::move(record), command);
}

StoredOrigin stored_origin(const std::string& command) {
  const MadeWith& m = made_with();
  return {.program = m.program,
          .processor = fmt::format("{}, {}, {}, {}", m.processor, m.instruction_set, m.vectors, m.c_library),
          .command = command};
}

Result internal::origin(const PreparedScene& scene, const std::string& command) {
  Result result{.command = command, .version = std::string(version), .made_with = made_with()};
  result.scene.text = scene.resolved().text();
  return result;
}

}  // namespace softland
