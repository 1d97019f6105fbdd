// The spread that is assumed for a scene without [spread].
#include "config/assumed_spread.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "config/scene.h"

namespace softland {
namespace {

const std::filesystem::path scenes = std::string(SOFTLAND_SOURCE_DIR) + "/scenes";

// Returns the keys of every variable, with its relative standard deviation.
std::map<std::vector<std::string>, double> assumed(SceneFile file) {
  file.erase("spread");
  EXPECT_TRUE(assume_spread(file));
  std::map<std::vector<std::string>, double> all;
  for (const SpreadVariable& v : read_scene(file).spread.variables) {
    std::vector<std::string> keys;
    for (const VariedKey& key : v.keys) keys.push_back(key.name());
    all[keys] = v.distribution.standard_deviation() / v.distribution.mean();
  }
  return all;
}

using testing::DoubleNear;
using testing::Pair;
using testing::UnorderedElementsAre;

TEST(AssumedSpread, OfABeamIsItsThicknessModulusAndGaps) {
  EXPECT_THAT(assumed(SceneFile::load(scenes / "mem-gold.toml")),
              UnorderedElementsAre(Pair(UnorderedElementsAre("gap.electrode", "gap.contact"), DoubleNear(0.02, 1e-12)),
                                   Pair(testing::ElementsAre("structure.thickness"), DoubleNear(0.02, 1e-12)),
                                   Pair(testing::ElementsAre("structure.youngs_modulus"), DoubleNear(0.03, 1e-12))));
}

TEST(AssumedSpread, OfAPlateIsItsStiffnessAndAllItsGaps) {
  EXPECT_THAT(assumed(SceneFile::load(scenes / "gap-closing-actuator.toml")),
              UnorderedElementsAre(
                  Pair(UnorderedElementsAre("gap.electrode", "gap.contact", "electrode.main.gap"), DoubleNear(0.02, 1e-12)),
                  Pair(testing::ElementsAre("structure.stiffness"), DoubleNear(0.067, 1e-12))));
}

TEST(AssumedSpread, OfSeveralContactsHasAllTheirGaps) {
  EXPECT_THAT(
      assumed(SceneFile::load(scenes / "new/two-contacts.toml")),
      testing::Contains(Pair(UnorderedElementsAre("gap.electrode", "contact.left.gap", "contact.right.gap", "contact.stop.gap"),
                             DoubleNear(0.02, 1e-12))));
}

TEST(AssumedSpread, IsReadOfEveryShippedScene) {
  for (const auto& entry : std::filesystem::directory_iterator(scenes)) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_FALSE(assumed(SceneFile::load(entry.path())).empty()) << entry.path();
  }
}

TEST(AssumedSpread, LeavesWhatTheSceneSays) {
  SceneFile file = SceneFile::load(scenes / "mem-gold.toml");
  const std::string before = file.text();
  EXPECT_FALSE(assume_spread(file));
  EXPECT_EQ(file.text(), before);
}

}  // namespace
}  // namespace softland
