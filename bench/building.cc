// Measures the processor time for building a switch, for every scene: its own switch, and that of a device of an ensemble,
// which differs in thickness, gap and modulus only.
//   bench_building [SCENE ...]     (default: every shipped scene)
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "studies/closing/prepared.h"

namespace {

using namespace softland;

template <class Build>
double microseconds(Build&& build) {
  constexpr int runs = 200, rounds = 5;
  double least = 1e9;
  for (int r = 0; r < rounds; ++r) {
    const std::clock_t begin = std::clock();
    for (int i = 0; i < runs; ++i) build(1 + 1e-4 * i);
    least = std::min(least, 1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / runs);
  }
  return least;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> scenes(argv + 1, argv + argc);
  if (scenes.empty()) {
    for (const auto& entry : std::filesystem::directory_iterator(SOFTLAND_SCENES)) {
      if (entry.path().extension() == ".toml") scenes.push_back(entry.path());
    }
    std::sort(scenes.begin(), scenes.end());
  }
  fmt::print("{:<32} {:>11} {:>14}\n", "scene", "alone [us]", "ensemble [us]");
  for (const std::string& scene : scenes) {
    const PreparedScene p = prepare(SceneFile::load(scene));
    const auto microseconds_like = [&](const Switch* like) {
      return microseconds([&](double factor) {
        Device d = p.scene.device;
        d.structure.thickness *= factor, part_of<Beam>(d.structure).youngs_modulus *= factor, d.gap.electrode *= factor;
        const Switch built(d, p.quadrature, like);
      });
    };
    fmt::print("{:<32} {:>11.1f} {:>14.1f}\n", std::filesystem::path(scene).filename().string(), microseconds_like(nullptr),
               microseconds_like(&p.model));
  }
}
