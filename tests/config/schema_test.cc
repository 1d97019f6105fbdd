// Tests the bindings of the keys of a scene. The list of keys is the schema itself.
#include "config/schema.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "config/scene.h"
#include "tests/config/small_scene.h"

namespace softland::internal {
namespace {

using testing::UnorderedElementsAre;

/// Returns a scene in which every part exists, so that every key has a member.
Scene whole_scene() {
  Scene scene{.title = {},
              .device = {.electrodes = {{.name = "main"}}},
              .simulate = {},
              .metrics = {},
              .need_pull_in = {},
              .warnings = {},
              .file = SceneFile::parse("", "x.toml")};
  scene.device.gas.emplace();
  scene.device.contacts.resize(2);
  scene.device.piezo.emplace();
  scene.device.dispersion.emplace();
  scene.device.surface.emplace();
  return scene;
}

bool is_bound(const Bound& b) {
  return b.number != nullptr || b.flag != nullptr || b.integer != nullptr || b.text != nullptr || b.choose != nullptr ||
         b.place != nullptr || b.element != nullptr;
}

TEST(Schema, EveryKeySetsAMemberOrIsKnownToSetNone) {
  std::vector<std::string> without_member;
  for (const Section& section : schema()) {
    if (section.begin == nullptr) continue;
    for (const Key& key : section.keys) {
      if (!is_bound(key.bound)) without_member.push_back(fmt::format("{}.{}", section.name, key.name));
    }
  }
  // These keys set no member of their own. Areas decide lengths together with a width; models and the kind decide which members
  // exist. Keys of a file of modes make a table; those in sections, layers and a dielectric set members of these. The side of a
  // contact and `closed` decide which contacts make the connection.
  EXPECT_THAT(without_member,
              UnorderedElementsAre("structure.area", "electrode.area", "electrode.dielectric", "contact.model", "contact.side",
                                   "metrics.closed", "gas.model", "structure.kind", "structure.sections", "structure.layers",
                                   "structure.rest_shape", "structure.file", "structure.axis", "structure.direction",
                                   "structure.length_unit", "structure.mass_unit", "structure.mass", "structure.mass_normalised",
                                   "structure.clamp", "structure.positions", "structure.frequencies", "structure.shapes",
                                   "structure.rest_offsets", "structure.widths", "structure.far_anchor"));
}

TEST(Schema, EveryKeySetsAMemberOfTheKindItReads) {
  for (const Section& section : schema()) {
    for (const Key& key : section.keys) {
      if (!is_bound(key.bound)) continue;
      SCOPED_TRACE(fmt::format("{}.{}", section.name, key.name));
      const bool is_one_place = key.bound.place != nullptr && key.count == 0;
      EXPECT_EQ(key.bound.number != nullptr || is_one_place, key.type == KeyType::quantity);
      EXPECT_EQ(key.bound.place != nullptr && !is_one_place, key.type == KeyType::quantities);
      EXPECT_EQ(key.bound.flag != nullptr, key.type == KeyType::flag);
      EXPECT_EQ(key.bound.integer != nullptr, key.type == KeyType::integer);
      EXPECT_EQ(key.bound.text != nullptr, key.type == KeyType::text);
      EXPECT_EQ(key.bound.choose != nullptr, key.type == KeyType::choice || key.type == KeyType::table);
    }
  }
}

/// Returns the number of members of a scene with these laws that the keys set.
int members_set(const ContactModel& contact, const Gas& gas) {
  Scene scene = whole_scene();
  for (Contact& one : scene.device.contacts) one.model = contact;
  scene.device.gas = gas;
  std::map<const void*, std::string> owners;
  for (const Section& section : schema()) {
    std::set<std::string_view> seen;
    for (const Key& key : section.keys) {
      if (!seen.insert(key.name).second) continue;  // the same key for another kind of structure
      if (section.name == "contact" && !key.belongs_to(name_of(contact))) continue;
      if (section.name == "gas" && !key.belongs_to(name_of(gas))) continue;
      const Bound& b = key.bound;
      const std::size_t entry = section.name == "contact" ? 1 : 0;  // the gap of the first contact is in [gap]
      const bool is_span = b.place != nullptr && key.count == 2;
      for (const void* member : {b.number != nullptr ? static_cast<const void*>(&b.number(scene, entry)) : nullptr,
                                 b.place != nullptr ? static_cast<const void*>(&b.place(scene, entry, 0)) : nullptr,
                                 is_span ? static_cast<const void*>(&b.place(scene, entry, 1)) : nullptr,
                                 b.flag != nullptr ? static_cast<const void*>(&b.flag(scene, entry)) : nullptr,
                                 b.integer != nullptr ? static_cast<const void*>(&b.integer(scene, entry)) : nullptr}) {
        if (member == nullptr) continue;
        const auto [owner, is_new] = owners.emplace(member, fmt::format("{}.{}", section.name, key.name));
        EXPECT_TRUE(is_new) << section.name << "." << key.name << " sets the member of " << owner->second;
      }
    }
  }
  return static_cast<int>(owners.size());
}

TEST(Schema, NoTwoKeysSetTheSameMember) {
  for_each_law<ContactModel>([]<class Law>(std::type_identity<Law>) { EXPECT_GT(members_set(Law(), Gas()), 40) << Law::name; });
  for_each_law<Gas>([]<class Law>(std::type_identity<Law>) { EXPECT_GT(members_set(ContactModel(), Law()), 40) << Law::name; });
}

std::string document(const std::string& name) {
  std::ifstream stream(std::string(SOFTLAND_SOURCE_DIR) + "/docs/" + name);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Schema, TheManualTellsOfEveryLawAndItsKeys) {
  const std::string laws = document("theory/contact.md") + document("theory/gas.md"), all = laws + document("reference/keys.md");
  const auto quoted = [](std::string_view word) { return fmt::format("`{}`", word); };
  const auto expect = [&]<class Law>(std::type_identity<Law>) {
    EXPECT_THAT(laws, testing::HasSubstr(quoted(Law::name)));
    for (const Field<Law>& field : fields_of<Law>) EXPECT_THAT(all, testing::HasSubstr(quoted(field.key))) << Law::name;
  };
  for_each_law<ContactModel>(expect);
  for_each_law<Gas>(expect);
}

TEST(Schema, ADefaultIsThatOfTheLawWithoutAScene) {
  constexpr double rounding = 1e-15;
  const auto expect = []<class Law>(std::type_identity<Law>) {
    Law law{};
    for (const Field<Law>& field : fields_of<Law>) {
      if (field.in == nullptr || field.fallback.empty()) continue;
      const bool is_quoted = field.fallback.starts_with('\'');  // a quantity with a unit
      const double given = parse_quantity(is_quoted ? field.fallback.substr(1, field.fallback.size() - 2) : field.fallback).value;
      EXPECT_NEAR(field.in(law), given, rounding * given) << Law::name << ", " << field.key;
    }
  };
  for_each_law<ContactModel>(expect);
  for_each_law<Gas>(expect);
}

TEST(Schema, EveryChoiceHasAKeyOrIsASelectorThatOthersBelongTo) {
  for (const Section& section : schema()) {
    const Key* selector = section.selector.empty() ? nullptr : section.find(section.selector);
    for (const Key& key : section.keys) {
      for (const std::string_view owner : key.only_for) {
        ASSERT_NE(selector, nullptr) << section.name;
        EXPECT_THAT(selector->choices, testing::Contains(owner)) << section.name << "." << key.name;
      }
    }
  }
}

TEST(Assign, GivesANumberInTheUnitOfItsKey) {
  SceneFile file = SceneFile::parse(small_scene, "x.toml");
  const Scene before = read_scene(file);
  file.assign("structure.length", 1.5 * before.device.structure.length);
  file.assign("structure.modes", 2);
  file.assign("structure.damping_ratio", 0.25);
  file.assign("structure.plate_strain", true);
  file.assign("structure.poissons_ratio", 0.3);
  file.assign("electrode.main.fringing", std::string("none"));
  const Scene after = read_scene(file);
  EXPECT_EQ(after.device.structure.length, 1.5 * before.device.structure.length);
  EXPECT_EQ(after.device.structure.modes, 2);
  EXPECT_EQ(after.device.structure.damping_ratio, 0.25);
  EXPECT_TRUE(part_of<Beam>(after.device.structure).plate_strain);
  EXPECT_EQ(after.device.electrodes[0].fringing, Fringing::none);
}

TEST(Assign, TakesThePlaceOfTheOtherWayToSayTheSame) {
  SceneFile file = SceneFile::parse(small_scene, "x.toml");
  file.assign("simulate.accuracy", 1e-3);
  file.assign("simulate.tolerance", 1e-7);
  EXPECT_EQ(read_scene(file).simulate.tolerance, 1e-7);
  EXPECT_EQ(file.json()["simulate"].count("accuracy"), 0U);
}

TEST(Assign, RefusesAKeyThatNoSceneHas) {
  SceneFile file = SceneFile::parse(small_scene, "x.toml");
  EXPECT_THROW(file.assign("structure.colour", 1.0), std::logic_error);
  EXPECT_THROW(file.assign("furniture.length", 1.0), std::logic_error);
}

}  // namespace
}  // namespace softland::internal
