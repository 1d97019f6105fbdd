// Example 03: a search for waveforms, those that open a closed switch without leaving it to swing.
//
// The plain opening of every named scene, all drives to 0 V at once, stands beside the best waveform that a search has found
// within the limits of the drivers. `softland release SCENE` does the same. The lines are those of results/release.md, whose
// searches began with five seeds. The search that closes a switch is called in the same way: example 04.
//
//   03_search ../scenes/mem-gold.toml ../scenes/mem-gold-pzt.toml ../scenes/nem-tin.toml ../scenes/two-electrodes.toml
//
//   scene               plain: open for good  residual vibration  found: open for good  residual vibration  confirmed
//   mem-gold                               -                2 um                 28 us             18.7 nm        yes
//   ...
#include <softland/softland.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>

// Writes "28 us", or "-" for an unknown value. A vibration below a picometre counts as zero.
std::string text(double value, const char* unit) {
  if (!std::isfinite(value)) return "-";
  return softland::engineering(unit == std::string("m") && value < 1e-12 ? 0 : value, unit, 3);
}

int main(int argc, char** argv) try {
  using namespace softland;
  if (argc < 2) return std::fputs("usage: 03_search SCENE...\n", stderr), 2;
  std::printf("%-18s%22s%20s%22s%20s%11s\n", "scene", "plain: open for good", "residual vibration", "found: open for good",
              "residual vibration", "confirmed");
  for (int k = 1; k < argc; ++k) {
    const std::filesystem::path scene = argv[k];
    // The request is a struct: what is not named keeps its default. The result does not depend on the number of threads.
    const OpeningOptions request{.actuator = Actuator::electrostatic,
                                 .max_evaluations = 3000,
                                 .seed = 1,
                                 .jobs = static_cast<int>(std::thread::hardware_concurrency()),
                                 .devices = 0};  // do not ask how varied devices behave
    const OpeningResult found = search_opening(SceneFile::load(scene.string()), request);
    const OpeningFigures &plain = found.plain.figures, best = found.best ? found.best->figures : OpeningFigures{};
    std::printf("%-18s%22s%20s%22s%20s%11s\n", scene.stem().c_str(), text(plain.settling_time, "s").c_str(),
                text(plain.residual_vibration, "m").c_str(), text(best.settling_time, "s").c_str(),
                text(best.residual_vibration, "m").c_str(), found.confirmed ? "yes" : "no");
  }
  return 0;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
