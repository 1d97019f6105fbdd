#include "reports/origin.h"

#include <fmt/format.h>

#include <utility>

#include "version.h"

namespace softland {

using nlohmann::json;

Origin origin_of(const char* kind, const std::string& command) {
  return {.kind = kind, .version = std::string(version), .command = command, .made_with = made_with()};
}

Origin origin_of(const char* kind, const PreparedScene& scene, const std::string& command) {
  Origin origin = origin_of(kind, command);
  origin.scene = scene.resolved().json();
  return origin;
}

Origin whole_origin_of(const char* kind, const PreparedScene& scene, const std::string& command) {
  Origin origin = origin_of(kind, scene, command);
  origin.scene_toml = scene.resolved().text();
  return origin;
}

MadeAgain made_again(const Origin& origin, std::optional<std::uint64_t> seed, double tolerance) {
  return {.version = origin.version,
          .command = origin.command,
          .made_with = internal::made_with_text(origin.made_with),
          .scene = origin.scene_toml,
          .seed = seed,
          .tolerance = tolerance};
}

std::string title_of(const Origin& origin) {
  const auto title = origin.scene.find("title");
  return title != origin.scene.end() && title->is_string() ? title->get<std::string>() : std::string();
}

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

}  // namespace softland
