// Contact resistance and electrical closing in scenes: how they are read, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "config/scene.h"
#include "tests/config/message.h"
#include "tests/config/small_scene.h"

namespace softland {
namespace {

using testing::HasSubstr;

const std::vector<std::string> conducting{"contact.resistivity=22 nOhm m", "contact.hardness=1 GPa"};

Scene read_with(std::vector<std::string> options, const std::vector<std::string>& more = {}) {
  options.insert(options.end(), more.begin(), more.end());
  SceneFile file = SceneFile::parse(small_scene, "x.toml");
  for (const std::string& option : options) file.set(option);
  return read_scene(file);
}

std::string refusal_with(std::vector<std::string> options, const std::vector<std::string>& more = {}) {
  options.insert(options.end(), more.begin(), more.end());
  return softland::message(std::string(small_scene), options);
}

TEST(Electrical, KeysOfAContactAreReadInSI) {
  const Scene scene = read_with(conducting, {"contact.film_resistance=0.2 ohm", "contact.mean_free_path=38 nm"});
  const Conduction& metal = scene.device.contacts.front().conduction;
  EXPECT_DOUBLE_EQ(metal.resistivity, 22e-9);
  EXPECT_DOUBLE_EQ(metal.hardness, 1e9);
  EXPECT_DOUBLE_EQ(metal.film_resistance, 0.2);
  EXPECT_DOUBLE_EQ(metal.mean_free_path, 38e-9);
  EXPECT_TRUE(scene.device.conducts());
  EXPECT_EQ(scene.metrics.asked, (AskedFigures{.resistance = true, .electrical = false}));
}

TEST(Electrical, KeysThatAreAbsentAskForNothing) {
  const Scene scene = read_with({});
  EXPECT_FALSE(scene.device.contacts.front().conduction.is_given());
  EXPECT_FALSE(scene.device.conducts());
  EXPECT_FALSE(scene.device.electrical.is_asked());
  EXPECT_EQ(scene.metrics.asked, AskedFigures());
  EXPECT_EQ(SceneFile::parse(small_scene, "x.toml").text().find("resistivity"), std::string::npos);
}

TEST(Electrical, ClosingIsAskedForByAnyOfItsKeys) {
  const ElectricalClosing both =
      read_with(conducting, {"metrics.closed_force=2 uN", "metrics.closed_resistance=1 Ohm", "metrics.closed_after=3 us"})
          .device.electrical;
  EXPECT_DOUBLE_EQ(both.force, 2e-6);
  EXPECT_DOUBLE_EQ(both.resistance, 1);
  EXPECT_DOUBLE_EQ(both.shortest_opening(), 3e-6);
  for (const char* one : {"metrics.closed_force=0 N", "metrics.closed_after=0 s"}) {
    const Scene scene = read_with({one});
    EXPECT_TRUE(scene.device.electrical.is_asked()) << one;
    EXPECT_EQ(scene.metrics.asked, (AskedFigures{.resistance = false, .electrical = true})) << one;
  }
}

TEST(Electrical, RefusesWhatDoesNotGoTogether) {
  EXPECT_THAT(refusal_with({"metrics.closed_resistance=1 Ohm"}), HasSubstr("contact.resistivity"));
  EXPECT_THAT(refusal_with({"contact.resistivity=22 nOhm m"}), HasSubstr("hardness")) << "a spring has no summits";
  for (const char* alone : {"contact.hardness=1 GPa", "contact.film_resistance=1 ohm", "contact.mean_free_path=38 nm"})
    EXPECT_THAT(refusal_with({alone}), HasSubstr("resistivity")) << alone;
  EXPECT_THAT(refusal_with(conducting, {"contact.distribution=pad"}), HasSubstr("contact.resistivity"));
  EXPECT_THAT(refusal_with({"contact.resistivity=22 nOhm"}), HasSubstr("expected a resistivity"));
  for (const char* broken : {"contact.resistivity=0 ohm m", "metrics.closed_force=-1 N", "metrics.closed_resistance=0 ohm",
                             "metrics.closed_after=-1 s", "contact.film_resistance=-1 ohm"})
    EXPECT_FALSE(refusal_with(conducting, {broken}).empty()) << broken;
  EXPECT_EQ(refusal_with(conducting, {"metrics.closed_resistance=1 Ohm"}), "");
}

TEST(Electrical, AResistanceNeedsEveryContactThatConnects) {
  const auto contact = [](const std::string& name, const std::string& more) {
    return "[contact." + name + "]\nmodel = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"\n" + more + "\n";
  };
  const std::string metal = "resistivity = \"22 nOhm m\"\nhardness = \"1 GPa\"\n";
  const auto with = [&](const std::string& contacts, const std::string& metrics) {
    const std::string one = "[contact]\nmodel = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"\n";
    return edited(edited(small_scene, "contact = \"2 um\"\n", ""), one, contacts) + "[metrics]\n" + metrics;
  };
  const std::string left = contact("left", "gap = \"2 um\"\n" + metal), right = contact("right", "gap = \"2.1 um\"\n");
  EXPECT_THAT(softland::message(with(left + right, "closed_resistance = \"1 ohm\"\n")), HasSubstr("contact.right.resistivity"));
  EXPECT_EQ(softland::message(with(left + right, "closed = [\"left\"]\nclosed_resistance = \"1 ohm\"\n")), "");
  EXPECT_TRUE(read_scene(SceneFile::parse(with(left + right, "closed = [\"left\"]\n"), "x.toml")).metrics.asked.resistance);
  const std::string stop = contact("stop", "gap = \"1 um\"\nside = \"far\"\nat = \"200 um\"\n" + metal);
  EXPECT_THAT(softland::message(with(left + stop, "")), HasSubstr("back stop"));
}

// The law elastic-plastic has its own hardness, which determines the size of its spots under a load.
TEST(Electrical, TheHardnessOfALawIsThatOfItsSpots) {
  const std::string text = edited(
      small_scene, "model = \"linear\"\npad_length = \"5 um\"\nstiffness = \"100 N/m\"\n",
      "model = \"elastic-plastic\"\npad_length = \"5 um\"\nasperity_radius = \"100 nm\"\nasperity_density = \"1e11 1/m^2\"\n"
      "asperity_height = \"100 nm\"\neffective_modulus = \"48 GPa\"\nhardness = \"1 GPa\"\n");
  EXPECT_EQ(softland::message(text), "");
  EXPECT_EQ(softland::message(text, {"contact.resistivity=22 nOhm m"}), "");
}

TEST(Electrical, NumbersMayDifferFromDeviceToDevice) {
  SceneFile file = SceneFile::parse(
      std::string(small_scene) +
          "[spread]\n\"contact.resistivity\" = { distribution = \"normal\", cov = \"5 %\" }\n\"contact.hardness\" = { "
          "distribution = \"normal\", cov = \"20 %\" }\n",
      "x.toml");
  for (const std::string& option : conducting) file.set(option);
  Scene scene = read_scene(file);
  ASSERT_EQ(scene.spread.variables.size(), 2u);
  for (const auto& variable : scene.spread.variables) variable.keys.front().member(scene) *= 2;
  EXPECT_DOUBLE_EQ(scene.device.contacts.front().conduction.resistivity, 44e-9);
  EXPECT_DOUBLE_EQ(scene.device.contacts.front().conduction.hardness, 2e9);
}

}  // namespace
}  // namespace softland
