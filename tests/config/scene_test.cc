#include "config/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace softland {
namespace {

TEST(Scene, ReadsTheReferenceScenes) {
  for (const char* name : {"mem-gold", "mem-gold-pzt"}) {
    const Scene scene = read_scene(SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/" + name + ".toml"));
    EXPECT_EQ(scene.device.structure.length, 250e-6);
    EXPECT_EQ(scene.device.contact->asperity_density, 1e11);
    EXPECT_THAT(scene.need_pull_in, testing::ElementsAre("main"));
    static_cast<void>(resolved(scene, {{"main", {50, 45}}}));
  }
}

}  // namespace
}  // namespace softland
