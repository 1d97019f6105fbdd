// Example 05: a waveform of your own.
//
// A swell: half a cosine up to a level, half a cosine down to another and half a cosine to the hold voltage. It is run as it
// stands. Then its five parameters are searched, and the result is judged on 200 varied devices of the scene.
//
//   05_own_waveform ../scenes/mem-gold.toml
//
//   as it stands   touches at 51.86 us with 51.45 mm/s, highest rebound 87.71 nm
//   searched       touches at 46.86 us with 5.489 mm/s, highest rebound 0 nm
//   ...
#include <softland/softland.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <numbers>

// Called from several threads at once. Between its breakpoints the voltage must be smooth; after the last one it stays.
class Swell final : public softland::OwnWaveform {
 public:
  Swell(double hold, double limit) : hold_(hold), limit_(limit) {}
  std::string_view name() const override { return "swell"; }
  std::vector<softland::OwnParameter> parameters() const override {
    return {{"high_V", 0, limit_, 1.1 * hold_},
            {"low_V", 0, limit_, 0.6 * hold_},
            {"up_s", 1e-6, 50e-6, 10e-6},
            {"down_s", 1e-6, 50e-6, 25e-6},
            {"back_s", 1e-6, 50e-6, 10e-6}};
  }
  std::vector<double> breakpoints(std::span<const double> x) const override { return {x[2], x[2] + x[3], x[2] + x[3] + x[4]}; }
  double voltage(double time, std::span<const double> x) const override {
    const double high = x[0], low = x[1], up = x[2], down = x[3], back = x[4];
    if (time < up) return between(0, high, time / up);
    if (time < up + down) return between(high, low, (time - up) / down);
    return between(low, hold_, (time - up - down) / back);
  }

 private:
  // Half a cosine.
  static double between(double from, double to, double part) {
    return from + (to - from) / 2 * (1 - std::cos(std::numbers::pi * std::min(1.0, part)));
  }
  double hold_, limit_;  // [V]
};

int main(int argc, char** argv) try {
  using namespace softland;
  if (argc != 2) return std::fputs("usage: 05_own_waveform SCENE\n", stderr), 2;
  const SceneFile scene = SceneFile::load(argv[1]);
  PreparedScene prepared = prepare_and_choose(scene, true);  // usual driver limits apply where the scene names none
  const double hold = prepared.drives.at("main").hold_level();
  const auto swell = std::make_shared<Swell>(hold, prepared.drives.at("main").limits.value().max_voltage);
  const auto row = [](const char* what, const Metrics& m) {
    std::printf("%-14s touches at %.4g us with %.4g mm/s, highest rebound %.4g nm\n", what, 1e6 * m.initial_contact_time,
                1e3 * m.impact_velocity, 1e9 * m.major_bounce_height);
  };

  // 1. Let it replace the scene's own waveform.
  prepared.drives.at("main").waveform = own(swell);
  row("as it stands", simulate(prepared, false).metrics);

  // 2. Searched: it is named like a family, and could stand beside some, "swell+pulse".
  OptimizeOptions request = usual_options(scene);
  request.own_waveforms = {swell};
  request.family = "swell";
  request.max_evaluations = 1500;
  const OptimizeResult found = optimize(scene, request);
  if (!found.best) return std::puts("no swell closes the switch"), 1;
  row("searched", found.best->metrics);
  for (const auto& [parameter, value] : found.parameters) std::printf("  %-14s %.6g\n", parameter.c_str(), value);

  // 3. On devices. No scene file can hold the waveform: what would write one refuses it by name.
  const Robustness devices =
      robustness(*found.best_scene, {{.name = "swell", .waveforms = found.best_scene->drives.waveforms()}}, {.samples = 200});
  for (const DriveRobustness& drive : devices.drives)
    std::printf("%-14s 95 %% of 200 devices touch at up to %.4g mm/s\n", drive.name.c_str(),
                1e3 * drive.figures[figure_of("impact_velocity_m_s")].quantiles[2].value);
  return 0;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
