#include "tests/support/random_scenes.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "studies/closing/prepared.h"

namespace softland::test {
namespace {

constexpr std::uint64_t seed = 1, scenes = 100;

TEST(RandomScenes, CanBePreparedAndSayEverythingThatAScenePossiblyCan) {
  std::map<std::string, std::set<std::string>> seen;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    SCOPED_TRACE(i);
    const SceneFile file = random_scene(seed, i);
    const PreparedScene p = prepare(file);
    EXPECT_GT(p.duration, 0);
    const nlohmann::json scene = file.json();
    seen["structure"].insert(scene["structure"]["kind"]);
    for (const char* section : {"gas", "contact"}) {
      seen[section].insert(scene.contains(section) ? scene[section]["model"].get<std::string>() : "none");
    }
    for (const auto& [name, drive] : scene["waveform"].items()) {
      seen["drive"].insert(name);
      seen["waveform"].insert(drive["family"]);
    }
    if (scene.contains("electrode")) {
      for (const auto& [name, electrode] : scene["electrode"].items()) seen["fringing"].insert(electrode["fringing"]);
    }
    if (p.scene.device.structure.find<Plate>() == nullptr) seen["modes"].insert(std::to_string(p.model.modes()));
  }
  EXPECT_EQ(seen["structure"].size(), 3u);
  EXPECT_GE(seen["gas"].size(), 8u) << "seven laws and none; a compressible film is rare";
  EXPECT_EQ(seen["contact"].size(), 9u) << "eight laws and none";
  EXPECT_EQ(seen["drive"], (std::set<std::string>{"main", "upper", "dispersion", "piezo"}));
  EXPECT_EQ(seen["waveform"].size(), families_of_scenes - 1) << "every family but a table";
  EXPECT_EQ(seen["fringing"].size(), 4u);
  EXPECT_EQ(seen["modes"].size(), 8u);
}

TEST(RandomScenes, AreFunctionsOfSeedAndIndexAndNoTwoAreAlike) {
  std::set<std::string> different;
  for (std::uint64_t i = 20; i-- > 0;) different.insert(random_scene(seed, i).text());
  EXPECT_EQ(different.size(), 20u);
  for (std::uint64_t i = 0; i < 20; ++i) EXPECT_TRUE(different.contains(random_scene(seed, i).text())) << i;
  EXPECT_NE(prepare(random_scene(seed, 3)).duration, prepare(random_scene(seed + 1, 3)).duration);
}

TEST(RandomFilmScenes, AreTheSameSwitchInACompressibleFilm) {
  int rigid = 0;
  for (std::uint64_t i = 0; i < scenes / 2; ++i) {
    SCOPED_TRACE(i);
    const auto file = random_film_scene(seed, i);
    if (!file) {
      ++rigid;
      continue;
    }
    EXPECT_GT(prepare(*file).model.film_states(), 0u);
    EXPECT_EQ(file->json()["structure"], random_scene(seed, i).json()["structure"]);
    EXPECT_EQ(file->text(), random_film_scene(seed, i)->text());
  }
  EXPECT_GT(rigid, 0);
  EXPECT_LT(rigid, 5);
}

}  // namespace
}  // namespace softland::test
