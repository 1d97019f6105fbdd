#include "studies/devices/evaluator_keys.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <variant>

#include "base/require.h"
#include "config/schema.h"

namespace softland {
namespace {

std::string spread_entry(const std::string& key) { return fmt::format("spread.\"{}\"", key); }

}  // namespace

std::pair<std::string, std::size_t> key_and_element(const std::string& key) {
  const std::size_t open = key.rfind('[');
  if (open == std::string::npos || !key.ends_with("]")) return {key, 0};
  const std::string inside = key.substr(open + 1, key.size() - open - 2);
  const bool is_number = !inside.empty() && inside.size() < 6 && inside.find_first_not_of("0123456789") == std::string::npos;
  return is_number ? std::pair(key.substr(0, open), std::stoul(inside)) : std::pair(key, std::size_t{0});
}

std::optional<std::pair<std::string, std::string>> waveform_key(const std::string& path) {
  constexpr std::string_view before = "waveform.";
  if (!path.starts_with(before)) return std::nullopt;
  const std::size_t dot = path.rfind('.');
  if (dot < before.size()) return std::nullopt;
  return std::pair(path.substr(before.size(), dot - before.size()), path.substr(dot + 1));
}

double* waveform_parameter(Waveform& waveform, const std::string& name, std::size_t element, std::vector<std::string_view>& names,
                           ParameterKind& kind) {
  return std::visit(
      [&]<class Family>(Family& family) -> double* {
        for (const Parameter<Family>& one : FamilyOf<Family>::parameters) {
          names.push_back(one.name);
          if (one.name != name) continue;
          kind = one.kind;
          if (const auto* number = std::get_if<double Family::*>(&one.member)) return element == 0 ? &(family.**number) : nullptr;
          auto& list = family.*std::get<std::vector<double> Family::*>(one.member);
          return element >= 1 && element <= list.size() ? &list[element - 1] : nullptr;
        }
        return nullptr;
      },
      waveform);
}

std::string unit_of_parameter(ParameterKind kind, const std::string& drive) {
  switch (kind) {
    case ParameterKind::level:
    case ParameterKind::swing:
      return drive == dispersion_drive ? "" : "V";
    case ParameterKind::time:
    case ParameterKind::end_time:
      return "s";
    case ParameterKind::angular_frequency:
      return "rad/s";
    case ParameterKind::angle:
      return "rad";
    case ParameterKind::ratio:
      break;
  }
  return "";
}

std::optional<Quantity> written_quantity(const SceneFile& file, const std::string& path, std::size_t element) {
  std::optional<std::string> text = file.written(path);
  if (!text) return std::nullopt;
  if (element > 0) {
    const nlohmann::json list = nlohmann::json::parse(*text, nullptr, false);
    if (!list.is_array() || element > list.size()) return std::nullopt;
    const nlohmann::json& one = list[element - 1];
    text = one.is_string() ? one.get<std::string>() : one.dump();
  }
  try {
    return parse_quantity(*text);
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

SceneFile scene_that_varies(SceneFile file, const std::vector<std::string>& keys) {
  file.erase("spread");
  file.erase("calibration");
  for (const std::string& key : keys) file.set(spread_entry(key) + R"(={distribution="normal",cov="1 %"})");
  for (const SpreadVariable& variable : read_scene(file).spread.variables) {
    const VariedKey& key = variable.keys.front();
    if (key.measured_in == dimension::none) continue;
    const double width = key.nominal == 0 ? 1e-9 : std::abs(key.nominal) / 100;
    file.set(spread_entry(variable.name) +
             fmt::format(R"(={{distribution="normal",standard_deviation="{}"}})", quantity_text(width, key.measured_in)));
  }
  return file;
}

}  // namespace softland
