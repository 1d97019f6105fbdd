// Closings per second and core of devices that differ, one at a time and in lanes, sampling and building included, and how far
// the figures of both are apart.
//   bench_fleet [SCENE [DEVICES [ACCURACY]]]     (default: mem-gold.toml 2000 1e-4)
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "model/ensemble/fleet.h"
#include "sampling/statistics.h"
#include "studies/robustness.h"

namespace {

using namespace softland;

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Landed final : LandingObserver {
  void touch(const Touch& t) override {
    if (touches++ == 0) first = t.begin;
    speed = std::max(speed, t.impact_velocity);
    force = std::max(force, t.peak_force);
  }
  void rebound(double, double, double height) override {
    highest = std::max(highest, height);
    rebounds += height > 1e-9;
  }
  int touches = 0, rebounds = 0;
  double first = NAN, speed = 0, highest = 0, force = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const std::string scene = argc > 1 ? argv[1] : std::string(SOFTLAND_SCENES) + "/mem-gold.toml";
  const std::uint64_t devices = argc > 2 ? std::stoul(argv[2]) : 2000;
  SceneFile file = SceneFile::load(scene);
  file.set(fmt::format("simulate.accuracy={}", argc > 3 ? argv[3] : "1e-4"));
  const Prepared nominal = prepare(file);
  const std::vector<Signal> signals = nominal.signals();
  const double window =
      std::max(0.6 * 2 * M_PI / nominal.model.angular_frequencies()[0], 2.5 * nominal.model.in_contact_period());
  const Ensemble ensemble(nominal, devices);
  if (const std::string why = why_not_in_lanes(nominal.model); !why.empty()) fmt::print("not in lanes: {}\n", why);

  double begin = seconds();
  std::vector<SampledDevice> all;
  DeviceBuilder builder(ensemble);
  for (std::uint64_t k = 0; k < devices; ++k) all.push_back(builder.device(k));
  const double building = seconds() - begin;

  const ClosingOptions options{.duration = nominal.duration, .tolerance = 1e-5, .after_contact = window};
  begin = seconds();
  std::vector<DeviceOutcome> scalar;
  for (const SampledDevice& d : all) scalar.push_back(close_device(d, signals, nominal.scene.metrics, options));
  const double one = seconds() - begin;
  fmt::print("building {:.1f} us, one at a time {:.1f} us\n", 1e6 * building / double(devices), 1e6 * one / double(devices));
  for (const Vectors vectors : {Vectors::avx2, Vectors::avx512}) {
    if (!has(vectors)) continue;
    std::vector<Landed> landed(devices);
    std::vector<FleetEnd> ends;
    begin = seconds();
    for (std::size_t first = 0; first < devices; first += 256) {
      std::vector<FleetClosing> closings;
      for (std::size_t k = first; k < std::min<std::size_t>(first + 256, devices); ++k)
        closings.push_back({.model = &*all[k].model,
                            .drives = signals,
                            .duration = options.duration,
                            .after_contact = options.after_contact,
                            .observer = &landed[k]});
      const auto some = close_in_lanes(closings, options.tolerance, vectors);
      ends.insert(ends.end(), some.begin(), some.end());
    }
    const double lanes = seconds() - begin;
    std::vector<double> off_t, off_v, off_b, off_f;
    int other = 0, lost = 0;
    for (std::size_t k = 0; k < devices; ++k) {
      if (!ends[k].followed) {
        ++lost;
        continue;
      }
      const DeviceOutcome& s = scalar[k];
      if (!s.closed()) continue;
      off_t.push_back(std::abs(landed[k].first / s.metrics.initial_contact_time - 1));
      off_v.push_back(std::abs(landed[k].speed / s.largest_impact_velocity - 1));
      off_b.push_back(std::abs(landed[k].highest / s.metrics.major_bounce_height - 1));
      off_f.push_back(std::abs(landed[k].force / s.metrics.peak_contact_force - 1));
      other += landed[k].rebounds != s.metrics.bounce_count;
    }
    const auto at = [](const std::vector<double>& v, double p) { return v.empty() ? NAN : sample_quantile(v, p); };
    double sum = 0;
    for (const Landed& l : landed) sum += l.speed + l.highest * 1e6;
    fmt::print(
        "{}: {:.1f} us ({:.2f} x), not followed {}, other count {}; off (median, 95 %, largest):\n  t_i {:.1e} {:.1e} {:.1e}  v "
        "{:.1e} {:.1e} {:.1e}  B_H {:.1e} "
        "{:.1e} {:.1e}  force {:.1e} {:.1e}  print {:.17g}\n",
        row_of(vector_instructions, vectors).name, 1e6 * lanes / double(devices), one / lanes, lost, other, at(off_t, .5),
        at(off_t, .95), at(off_t, 1), at(off_v, .5), at(off_v, .95), at(off_v, 1), at(off_b, .5), at(off_b, .95), at(off_b, 1),
        at(off_f, .5), at(off_f, .95), sum);
  }
}
