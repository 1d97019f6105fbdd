#include "reports/result_reader.h"

#include <fmt/format.h>

#include "base/require.h"
#include "base/shortened.h"
#include "reports/result_view.h"
#include "version.h"

namespace softland {

using nlohmann::json;

json parse_result(std::string_view content, const std::string& name) {
  // A result of ours is 6 deep; reports walk through what they show by recursion.
  constexpr int deepest = 64;
  const auto watch_depth = [&](int around, json::parse_event_t event, const json&) {
    const bool opens = event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (opens && around >= deepest) throw InvalidInput(fmt::format("{}: is nested more than {} deep", name, deepest));
    return true;
  };
  json result = json::parse(content, watch_depth, false);
  const bool is_result =
      result.is_object() && result.contains("kind") && (result["kind"] == "simulate" || result["kind"] == "optimize");
  require(is_result, fmt::format("{}: is not a result.json of softland", name));
  return result;
}

void require_reportable(const json& result, const std::string& name) {
  using internal::at;
  const std::string made_by = internal::text(result, {"version"});
  require(!made_by.empty(), fmt::format("{}: does not say of which version of softland it is: \"version\" is missing", name));
  require(made_by == version,
          fmt::format("{}: is a result of softland {}, of which softland {} makes no report", name, shortened(made_by), version));
  for (const char* part : {internal::is_optimize(result) ? "baseline" : "metrics", "curves", "scene"}) {
    require(at(result, {part}).is_object(),
            fmt::format("{}: \"{}\" is missing; name the result.json in the folder that --out named", name, part));
  }
}

}  // namespace softland
