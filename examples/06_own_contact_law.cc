// Example 06: a contact law of your own.
//
// The rough contact of the scene (Hertz asperities whose heights are uniform on [0, H]) is written once more, as a class. The
// plain step closes the switch on softland's law and on this one, which agree to rounding; then the step is judged on 200
// devices.
//
//   06_own_contact_law ../scenes/mem-gold.toml
//
//   of softland   touches at 34.27 us with 85.58 mm/s, highest rebound 495.8 nm, peak force 14.14 uN
//   own           touches at 34.27 us with 85.58 mm/s, highest rebound 495.8 nm, peak force 14.14 uN
//   200 devices touch with 88.61 +- 8.9 mm/s
#include <softland/softland.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <variant>

// Called from several threads at once. The force starts from zero at first touch and has two continuous derivatives beyond it;
// for negative interference it is only continued, where an integrator looks on its way to the event that ends contact.
class RoughContact final : public softland::OwnContactLaw {
 public:
  RoughContact(double strength, double height) : strength_(strength), height_(height) {}
  std::string_view name() const override { return "rough contact"; }
  double force(double interference, double /*rate*/) const override {  // [m], [m/s] -> [N]
    const double depth = std::abs(interference), over = std::max(0.0, depth - height_);
    const double size = strength_ * 8 / 15 * (depth * depth * std::sqrt(depth) - over * over * std::sqrt(over));
    return std::copysign(size, interference);
  }

 private:
  double strength_, height_;  // eta A E* sqrt(R) / H [N/m^2.5], H [m]
};

int main(int argc, char** argv) try {
  using namespace softland;
  if (argc != 2) return std::fputs("usage: 06_own_contact_law SCENE\n", stderr), 2;
  const auto row = [](const char* what, const Metrics& m) {
    std::printf("%-14stouches at %.4g us with %.4g mm/s, highest rebound %.4g nm, peak force %.4g uN\n", what,
                1e6 * m.initial_contact_time, 1e3 * m.impact_velocity, 1e9 * m.major_bounce_height, 1e6 * m.peak_contact_force);
  };

  // 1. Simulate with the law of the scene.
  SceneFile scene = SceneFile::load(argv[1]);
  const PreparedScene given = prepare(scene);
  row("of softland", simulate(given, false).metrics);

  // 2. That law gives way to one with the same numbers: no scene file could say it, so it is added to what was read.
  const Contact& contact = given.scene.device.contacts.front();
  const auto& rough = std::get<UniformAsperities>(contact.model);
  const ContactPad pad{.width = given.scene.device.structure.width, .length = contact.pad_length};
  const double strength = rough.summits.hertz(pad) / rough.height;
  scene.erase("contact");
  scene.add_contact(
      {.model = OwnContact{std::make_shared<const RoughContact>(strength, rough.height)}, .pad_length = pad.length});
  const PreparedScene own = prepare(scene);
  row("own", simulate(own, false).metrics);

  // 3. Simulate varied devices.
  const Robustness found = robustness(own, {}, {.samples = 200});
  const FigureStatistics& impact = found.drives.front().figures[&Metrics::largest_impact_velocity];
  std::printf("%zu devices touch with %.4g +- %.2g mm/s\n", found.devices, 1e3 * impact.mean, 1e3 * impact.standard_deviation);
  return 0;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
