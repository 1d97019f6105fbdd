// Uses everything that softland/softland.h lists: a simulated device, closed by the waveforms of its scene, and the number of
// times that its contact is seen to close.
#include <softland/softland.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const softland::PracticeDevice device(softland::SceneFile::load(argv[1]), {.seed = 7});
    const softland::PreparedScene& scene = device.nominal();
    const auto closing = device.close(1, scene.waveforms(), scene.duration);
    std::printf("closed %zu times\n", (closing.record.edges.size() + 1) / 2);
  } catch (const softland::InvalidKey& error) {
    std::printf("%s\n", error.place().key.c_str());
  }
  return 0;
}
