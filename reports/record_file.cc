#include "reports/record_file.h"

#include <fmt/format.h>

#include "base/require.h"
#include "base/shortened.h"
#include "version.h"

namespace softland {
namespace {

using nlohmann::json;

std::string text_at(const json& record, const char* key) {
  const json found = record.is_object() && record.contains(key) ? record[key] : json();
  return found.is_string() ? found.get<std::string>() : std::string();
}

}  // namespace

std::string json_text(const json& data, int indent) {
  return data.dump(indent, ' ', false, json::error_handler_t::replace) + "\n";
}

json without_curves(json record) {
  record.erase("curves");
  return record;
}

json parse_record(std::string_view content, const std::string& name) {
  // Deepest nesting of JSON that is read, since reading recurses into the levels; results of the program have 6 levels.
  constexpr int deepest = 64;
  const auto watch_depth = [&](int around, json::parse_event_t event, const json&) {
    const bool opens = event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (opens && around >= deepest) throw InvalidInput(fmt::format("{}: is nested more than {} deep", name, deepest));
    return true;
  };
  json record = json::parse(content, watch_depth, false);
  require(!text_at(record, "kind").empty(), [&] { return fmt::format("{}: is not a result of softland", name); });
  return record;
}

void require_version(const json& record, const std::string& name) {
  const std::string made_by = text_at(record, "version");
  require(!made_by.empty(), fmt::format("{}: does not say of which version of softland it is: \"version\" is missing", name));
  require(made_by == version,
          fmt::format("{}: is a result of softland {}, of which softland {} makes no report", name, shortened(made_by), version));
}

}  // namespace softland
