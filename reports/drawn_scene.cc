#include "reports/drawn_scene.h"

#include <cmath>
#include <initializer_list>
#include <string_view>
#include <type_traits>
#include <variant>

#include "base/require.h"
#include "config/units.h"
#include "model/structure/structure.h"

namespace softland {
namespace {

using nlohmann::json;

// Returns the value in JSON at this path of keys; null if any key is missing.
const json& at(const json& value, std::initializer_list<std::string_view> path) {
  static const json nothing;
  const json* here = &value;
  for (const std::string_view key : path) {
    if (!here->is_object()) return nothing;
    const auto found = here->find(key);
    if (found == here->end()) return nothing;
    here = &*found;
  }
  return *here;
}

double number(const json& value) { return value.is_number() ? value.get<double>() : Metrics::unset; }

std::string text(const json& value) { return value.is_string() ? value.get<std::string>() : std::string(); }
std::string text(const json& value, std::initializer_list<std::string_view> path) { return text(at(value, path)); }

// Returns a quantity of a resolved scene, such as "2 um", in SI units. A number without a unit is returned as it is.
double quantity(const json& value) {
  if (!value.is_string()) return number(value);
  try {
    return parse_quantity(value.get<std::string>()).value;
  } catch (const InvalidInput&) {
    return Metrics::unset;
  }
}

std::vector<double> quantities(const json& list) {
  std::vector<double> all;
  for (const json& one : list.is_array() ? list : json::array()) all.push_back(quantity(one));
  return all;
}

// Returns the members of a JSON object by name, each converted by the function `read`.
template <class Read>
auto members_of(const json& object, const Read& read) {
  std::map<std::string, decltype(read(object))> all;
  if (!object.is_object()) return all;
  for (const auto& [name, value] : object.items()) all.emplace(name, read(value));
  return all;
}

// Returns a place on a beam [m] that is given as a length, as a percentage of the length of the beam, or as its tip.
double place_on(double length, const json& place) {
  const std::string written = text(place);
  if (written == "tip") return length;
  return written.ends_with('%') ? quantity(place) * length : quantity(place);
}

std::optional<std::array<double, 2>> span_on(double length, const json& span) {
  if (!span.is_array() || span.size() != 2) return std::nullopt;
  const std::array<double, 2> ends{place_on(length, span[0]), place_on(length, span[1])};
  return std::isfinite(ends[0]) && std::isfinite(ends[1]) ? std::optional(ends) : std::nullopt;
}

// Returns the length of the structure in a scene, or the sum of the lengths of its sections.
double length_of(const json& structure) {
  const double length = quantity(at(structure, {"length"}));
  const json& sections = at(structure, {"sections"});
  if (std::isfinite(length) || !sections.is_array() || sections.empty()) return length;
  double sum = 0;
  for (const json& section : sections) sum += quantity(at(section, {"length"}));
  return sum;
}

template <class Kind>
constexpr SideOfStructure side_of_kind() {
  constexpr bool is_rigid = requires { Kind::is_rigid; };
  constexpr bool has_far_clamp = requires { Kind::has_far_clamp; };
  if (is_rigid) return SideOfStructure::on_springs;
  if (!std::is_base_of_v<Beam, Kind>) return SideOfStructure::unknown;
  return has_far_clamp ? SideOfStructure::held_at_both_ends : SideOfStructure::held_at_one_end;
}

template <class... Kinds>
SideOfStructure side_of_named(std::string_view kind, const std::variant<Kinds...>*) {
  SideOfStructure side = SideOfStructure::unknown;
  ((side = Kinds::name == kind ? side_of_kind<Kinds>() : side), ...);
  return side;
}

}  // namespace

SideOfStructure side_of_structure(std::string_view kind) {
  return side_of_named(kind, static_cast<const StructureKind*>(nullptr));
}

DrawnScene read_drawn_scene(const json& scene) {
  DrawnScene s{.structure = side_of_structure(text(scene, {"structure", "kind"})),
               .length = length_of(at(scene, {"structure"})),
               .electrode_gap = quantity(at(scene, {"gap", "electrode"})),
               .contact_gap = quantity(at(scene, {"gap", "contact"})),
               .pad_length = quantity(at(scene, {"contact", "pad_length"}))};
  if (at(scene, {"piezo"}).is_object()) s.piezo = DrawnScene::Piezo{span_on(s.length, at(scene, {"piezo", "span"}))};
  for (const auto& [name, electrode] : members_of(at(scene, {"electrode"}), [](const json& one) { return &one; })) {
    const json& spans = at(*electrode, {"span"});
    const bool is_nested = spans.is_array() && !spans.empty() && spans[0].is_array();
    for (const json& span : is_nested ? spans : json::array({spans}))
      s.electrodes.push_back({.name = name,
                              .span = span_on(s.length, span),
                              .far_side = text(*electrode, {"side"}) == "far",
                              .gap = quantity(at(*electrode, {"gap"}))});
  }
  for (const auto& [name, contact] : members_of(at(scene, {"contact"}), [](const json& one) { return &one; })) {
    if (!contact->is_object()) continue;
    s.contacts.push_back({.name = name,
                          .at = place_on(s.length, at(*contact, {"at"})),
                          .gap = quantity(at(*contact, {"gap"})),
                          .far_side = text(*contact, {"side"}) == "far"});
  }
  s.waveforms = members_of(at(scene, {"waveform"}), [](const json& one) {
    return DrawnScene::Waveform{.family = text(one, {"family"}),
                                .times = quantities(at(one, {"times"})),
                                .edge = quantity(at(one, {"edge"})),
                                .start = quantity(at(one, {"start"})),
                                .end = quantity(at(one, {"end"}))};
  });
  s.drivers = members_of(at(scene, {"driver"}), [](const json& one) {
    return DriveLimits{.lowest = quantity(at(one, {"min_voltage"})),
                       .highest = quantity(at(one, {"max_voltage"})),
                       .slew = quantity(at(one, {"max_slew"}))};
  });
  if (const double height = quantity(at(scene, {"metrics", "significant_rebound"})); height > 0) s.significant_rebound = height;
  return s;
}

}  // namespace softland
