// Example 04: an objective of your own.
//
// softland searches for a bounce-free waveform and, among those, for the one with the lowest value of this class.
// Such a waveform presses the contact as gently as possible, from a source of as few volts as possible.
//
//   04_own_objective ../scenes/mem-gold.toml
//
//                    peak voltage  peak force     contact  rebound  objective
//   plain step            17.77 V     14.1 uN     34.3 us   496 nm          1
//   found                 17.77 V     0.33 uN     50.3 us     0 nm     0.5117
//   ...
#include <softland/softland.h>

#include <cstdio>
#include <exception>
#include <memory>

// The record of a closing comes with that of the plain step: shares of it have no units. It is called from several threads at
// once, and so must not change anything.
class LowAndGentle final : public softland::OwnObjective {
 public:
  std::string_view name() const override { return "low-and-gentle"; }
  double value(const softland::Metrics& closing, const softland::Metrics& step) const override {
    return (closing.peak_voltage / step.peak_voltage + closing.peak_contact_force / step.peak_contact_force) / 2;
  }
};

int main(int argc, char** argv) try {
  using namespace softland;
  if (argc != 2) return std::fputs("usage: 04_own_objective SCENE\n", stderr), 2;
  const auto objective = std::make_shared<LowAndGentle>();

  // An own objective can stand wherever a built-in target could (Target::bounce, parse_aim("0.7 bounce + 0.3 energy")).
  const SceneFile scene = SceneFile::load(argv[1]);
  OptimizeOptions request = usual_options(scene, Aim(objective));
  request.family = "pulse";
  request.max_evaluations = 1500;
  const OptimizeResult found = optimize(scene, request);
  if (!found.best) return std::puts("no waveform closes the switch"), 1;

  std::printf("%-14s%15s%12s%12s%9s%11s\n", "", "peak voltage", "peak force", "contact", "rebound", "objective");
  const auto row = [&](const char* what, const Metrics& m) {
    std::printf("%-14s%13.4g V%9.3g uN%9.3g us%6.3g nm%11.4g\n", what, m.peak_voltage, 1e6 * m.peak_contact_force,
                1e6 * m.initial_contact_time, 1e9 * m.major_bounce_height, objective->value(m, found.baseline.metrics));
  };
  row("plain step", found.baseline.metrics);
  row("found", found.best->metrics);
  for (const auto& [parameter, value] : found.parameters) std::printf("  %-22s %.6g\n", parameter.c_str(), value);

  // The winner is a scene: it can be written, and run by anybody's softland.
  std::puts(found.goal_met ? "without a rebound, and better than the plain step" : "not better than the plain step");
  return found.is_success() ? 0 : 1;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
