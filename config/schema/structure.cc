#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/engineering.h"
#include "config/modal_table.h"
#include "config/schema/laws.h"
#include "config/schema/sections.h"
#include "config/section_reader.h"
#include "model/beam.h"
#include "model/built_beam.h"

namespace softland::internal {
namespace {

/// Returns the scene key for field i of a kind of structure, such as beam or plate.
template <class Kind, std::size_t i>
Key key_of_structure() {
  constexpr const Field<Structure>& field = structure_fields<Kind>[i];
  Key key = described(field);
  if constexpr (field.in != nullptr) {
    key.bound.number = [](Scene& scene, std::size_t) -> double& { return structure_fields<Kind>[i].in(scene.device.structure); };
  } else if constexpr (field.count != nullptr) {
    key.bound.integer = [](Scene& scene, std::size_t) -> int& { return structure_fields<Kind>[i].count(scene.device.structure); };
  } else if constexpr (field.flag != nullptr) {
    key.bound.flag = [](Scene& scene, std::size_t) -> bool& { return structure_fields<Kind>[i].flag(scene.device.structure); };
  }
  return key;
}

bool is_same(const Key& a, const Key& b) {
  return a.name == b.name && a.about == b.about && a.required == b.required && a.why_fixed == b.why_fixed && a.words == b.words;
}

/// Returns the keys of a kind of structure that are not in structure_fields, such as lists of sections or modes.
template <class Kind>
std::vector<Key> further_keys() {
  if constexpr (std::is_same_v<Kind, ModalStructure>) return modal_table_keys();
  if constexpr (std::derived_from<Kind, Beam>) return beam_part_keys();
  return {};
}

/// Returns the key `kind`, and the keys of all kinds of structure. Key::only_for lists the kinds that have a key; empty: all.
std::vector<Key> structure_keys() {
  std::vector<Key> keys;
  const auto add = [&](Key key, std::string_view kind) {
    auto same = std::ranges::find_if(keys, [&](const Key& other) { return is_same(key, other); });
    if (same == keys.end()) same = keys.insert(keys.end(), std::move(key));
    same->only_for.push_back(kind);
  };
  for_each_law<StructureKind>([&]<class Kind>(std::type_identity<Kind>) {
    for (Key& key : further_keys<Kind>()) add(std::move(key), Kind::name);
    [&]<std::size_t... i>(std::index_sequence<i...>) { (add(key_of_structure<Kind, i>(), Kind::name), ...); }
    (std::make_index_sequence<structure_fields<Kind>.size()>());
  });
  const std::vector<std::string_view> kinds = names_of_laws<StructureKind>();
  for (Key& key : keys) {
    if (key.only_for == kinds) key.only_for.clear();
  }
  Key kind =
      one_of("kind", kinds,
             "a beam clamped at one end, a beam clamped at both ends, a rigid plate on springs, or the modes of another program");
  keys.insert(keys.begin(), std::move(kind).needed());
  return keys;
}

void check(Plate&, Structure& s, Scene&, const SectionReader& in) {
  const double area = in.number("area");
  // If no law needs the width of a plate, the plate is assumed square.
  if (!in.is_given("width")) s.width = std::sqrt(area);
  s.length = area / s.width;
  s.modes = 1;
}

void check(ModalStructure&, Structure&, Scene& scene, const SectionReader& in) { read_modal_table(scene, in); }

void check(Beam& beam, Structure& s, Scene& scene, const SectionReader& in) {
  if (!beam.sections.empty()) {
    s.length = 0;
    for (const SectionPart& part : beam.sections) s.length += part.length;
  }
  if (const auto conflict = part_conflict(scene.device)) in.file().fail(in.path() + "." + conflict->key, conflict->rule);
  if (beam.rest_shape) {
    constexpr double rounding = 1e-9;
    const double end = beam.rest_shape->places(s.length).back();
    if (!(std::abs(end - s.length) <= rounding * s.length))
      in.file().fail(in.path("rest_shape") + ".positions",
                     fmt::format("must end at the tip, and the beam is {} long: \"tip\" and percentages follow its length",
                                 engineering(s.length, "m")));
  }
  for (const char* key : {"plate_strain", "biaxial"}) {
    if (!in.has_value(key)) continue;
    in.require(!in.flag(key) || in.is_given("poissons_ratio"), key, "needs structure.poissons_ratio");
  }
  // In a scene with [surface], the check of that section tests buckling under the sum of residual and surface stress.
  if (!in.has_value("residual_stress") || in.file().find({"surface"})) return;
  const std::string buckled = why_buckled(s);
  in.require(buckled.empty(), "residual_stress", buckled);
}

void check_structure(Scene& scene, const SectionReader& in, std::size_t) {
  scene.auto_modes = in.is_word("modes");
  Structure& s = scene.device.structure;
  std::visit(
      [&](auto& kind) {
        if constexpr (requires { check(kind, s, scene, in); }) check(kind, s, scene, in);
      },
      s.kind);
}

}  // namespace

Section structure_section() {
  return {.name = "structure",
          .required = true,
          .may_vary = true,
          .selector = "kind",
          .keys = structure_keys(),
          .about = "the moving structure",
          .advice = part_advice(),
          .begin =
              [](Scene& scene, const SectionReader& in, std::string_view) {
                scene.device.structure.kind = *law_named<StructureKind>(in.text("kind"));
                return std::size_t{0};
              },
          .check = check_structure};
}

}  // namespace softland::internal
