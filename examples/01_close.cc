// Example 01: one closing.
//
// Reads a scene, simulates it under its own waveform and prints the figures of merit with the errors that softland states for
// them; then the ten highest rebounds. `softland simulate SCENE` does the same.
//
//   01_close ../scenes/mem-gold.toml
//
//   status: done
//   First contact                  3.4269e-05 s    +- 1e-13
//   ...
//   rebound of 496 nm at 44.26 us
//   ...
#include <softland/softland.h>

#include <algorithm>
#include <cstdio>
#include <exception>

int main(int argc, char** argv) try {
  using namespace softland;
  if (argc != 2) return std::fputs("usage: 01_close SCENE\n", stderr), 2;

  // 1. A scene file is read and checked: what is wrong with it is an InvalidInput with line, key, value and rule.
  const SceneFile file = SceneFile::load(argv[1]);

  // 2. It is made ready to run: beam modes, forces, pull-in voltages where a unit needs them, every drive in volts.
  const PreparedScene prepared = prepare_and_choose(file);

  // 3. One closing. A second, tighter run measures the errors.
  const Closing closing = simulate(prepared, true);
  std::printf("status: %s\n", std::string(to_string(closing.metrics.status)).c_str());

  // 4. Every figure stands in one table with its name and its unit; what is not known is NaN.
  for (const Figure& figure : asked_among(all_figures, closing.metrics.asked)) {
    const double value = figure.value(closing.metrics), error = closing.errors[figure];
    std::printf("%-28.*s %12.5g %-4.*s +- %.1g\n", static_cast<int>(figure.name.size()), figure.name.data(), value,
                static_cast<int>(figure.unit.size()), figure.unit.data(), error);
  }

  // 5. The motion itself: knots of time, position, velocity and force, touches and rebounds.
  std::vector<Rebound> rebounds = closing.rebounds;
  std::ranges::sort(rebounds, std::ranges::greater(), &Rebound::height);
  rebounds.resize(std::min<std::size_t>(rebounds.size(), 10));
  for (const Rebound& r : rebounds) std::printf("rebound of %.3g nm at %.5g us\n", 1e9 * r.height, 1e6 * r.begin);
  return closing.metrics.status == Status::done ? 0 : 1;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
