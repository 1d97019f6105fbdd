// Measures what limits the speed of a right-hand side, and how the cost of a closing grows: bench_cost > results/cost.md
//
// The closing is the reference closing (gold cantilever, a step of 17.771 V, 100 us). Operations are counted from the formulas,
// and the rate of each kind of operation on this machine is measured here. The slowest kind is the bound. Exponents are slopes
// of least-squares lines through the logarithms. Prints Markdown.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "bench/figure.h"
#include "model/closing.h"
#include "studies/closing/prepared.h"
#include "studies/closing/timing.h"

namespace softland {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double window = 100e-6, tolerance = 1e-6;
constexpr int repeats = 41;

// Returns operations per second on doubles in independent vectors of four: the limit for a loop over points.
template <class Operation>
double rate(Operation operation) {
  constexpr int vectors = 12, lanes = 4, passes = 20000;
  Eigen::Array<double, lanes, 1> x[vectors];
  std::vector<double> seconds;
  double keep = 0;
  volatile double start_value = 1.5;  // the compiler must not know it
  for (int r = 0; r < repeats; ++r) {
    for (auto& v : x) v.setConstant(static_cast<double>(start_value));
    const auto start = Clock::now();
    for (int p = 0; p < passes; ++p) {
      for (auto& v : x) v = operation(v);
    }
    seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    for (const auto& v : x) keep += v.sum();
  }
  if (!std::isfinite(keep)) throw std::runtime_error("the measured loops have overflowed");
  return vectors * lanes * static_cast<double>(passes) / *std::min_element(seconds.begin(), seconds.end());
}

struct Case {
  int modes = 4;
  double points_per_length = 24, duration = window;
};

struct Cost {
  double closing = 0, right_hand_side = 0;  // [s]
  long evaluations = 0;
  Eigen::Index points = 0;
};

Cost measure(const PreparedScene& prepared, const Case& c) {
  Device device = prepared.scene.device;
  device.structure.modes = c.modes;
  const Switch with(device, {.points_per_length = c.points_per_length});
  std::vector<double> seconds;
  long evaluations = 0;
  for (int i = 0; i < repeats; ++i) {
    const auto start = Clock::now();
    const Trajectory t = simulate_closing(with, prepared.signals(), {.duration = c.duration, .tolerance = tolerance});
    seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    evaluations = t.work.rhs_evaluations;
  }
  return {*std::min_element(seconds.begin(), seconds.end()), right_hand_side_seconds(with, prepared.signals(), window, 1001),
          evaluations, with.quadrature().points()};
}

double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]), b = std::log(y[i]);
    sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void print_bound(const PreparedScene& prepared) {
  const Switch& device = prepared.model;
  const std::vector<Stretch> pads = prepared.scene.device.electrodes[0].pads(prepared.scene.device.structure.length);
  const auto all = static_cast<double>(device.quadrature().points());
  const auto driven = static_cast<double>(std::ranges::count_if(device.quadrature().positions(), [&](double x) {
    return std::ranges::any_of(pads, [&](const Stretch& pad) { return pad.holds(x); });
  }));
  const double modes = device.modes();
  // gap and velocity 2, projection 1 to a point and mode; film 4, electrostatic load 6
  const double multiply_adds = 3 * modes * all + 4 * all + 6 * driven;
  const double divisions = all + driven, roots = 2 * driven;
  const double bytes = 8 * (2 * modes * all + 8 * all);

  volatile double unknown = 0.7;
  const double factor = unknown, term = unknown;
  const double multiply_add_rate = rate([=](const auto& v) { return (v * factor + term).eval(); });
  const double division_rate = rate([=](const auto& v) { return (term / v).eval(); });
  const double root_rate = rate([](const auto& v) { return v.sqrt().eval(); });
  const double arithmetic = multiply_adds / multiply_add_rate, divider = divisions / division_rate + roots / root_rate;
  const double bound = std::max(arithmetic, divider);
  const double measured = right_hand_side_seconds(device, prepared.signals(), window, 4001);
  fmt::print("## What bounds a right-hand side\n\n{}\n",
             markdown_table({{"operation", "count", "the machine does", "takes"},
                             {"multiply-add", fmt::format("{:.0f}", multiply_adds),
                              fmt::format("{:.3g} /ns", multiply_add_rate / 1e9), fmt::format("{:.1f} ns", arithmetic * 1e9)},
                             {"division", fmt::format("{:.0f}", divisions), fmt::format("{:.3g} /ns", division_rate / 1e9),
                              fmt::format("{:.1f} ns", divisions / division_rate * 1e9)},
                             {"square root", fmt::format("{:.0f}", roots), fmt::format("{:.3g} /ns", root_rate / 1e9),
                              fmt::format("{:.1f} ns", roots / root_rate * 1e9)}}));
  fmt::print(
      "{} modes, {} points, {:.0f} of them over the electrode; {:.0f} flops, {:.1f} kB read and written, all of it in the "
      "first-level cache.\nDivisions and roots share a unit, multiply-adds run beside them: the bound is the larger sum, "
      "**{:.1f} ns**. Measured: **{:.1f} ns, {:.0f} % of\n"
      "the bound's speed**.\n\n",
      modes, device.quadrature().points(), driven, 2 * multiply_adds + divisions + roots, bytes / 1e3, bound * 1e9,
      measured * 1e9, 100 * bound / measured);
}

void print_growth(const PreparedScene& prepared) {
  std::vector<std::vector<std::string>> rows{{"modes", "points", "window", "right-hand sides", "one right-hand side", "closing"}};
  std::vector<std::vector<std::string>> slopes{{"cost against", "right-hand sides", "one right-hand side", "closing"}};
  const auto sweep = [&](const std::string& name, const std::vector<double>& values, auto set) {
    std::vector<double> x, evaluations, each, closing;
    for (const double value : values) {
      Case c;
      set(c, value);
      const Cost cost = measure(prepared, c);
      x.push_back(name == "quadrature points" ? static_cast<double>(cost.points) : value);
      evaluations.push_back(static_cast<double>(cost.evaluations));
      each.push_back(cost.right_hand_side);
      closing.push_back(cost.closing);
      rows.push_back({std::to_string(c.modes), std::to_string(cost.points), fmt::format("{:.0f} us", c.duration * 1e6),
                      std::to_string(cost.evaluations), fmt::format("{:.1f} ns", cost.right_hand_side * 1e9),
                      fmt::format("{:.3f} ms", cost.closing * 1e3)});
    }
    slopes.push_back({name, fmt::format("{:.2f}", slope(x, evaluations)), fmt::format("{:.2f}", slope(x, each)),
                      fmt::format("{:.2f}", slope(x, closing))});
  };
  sweep("modes", {1, 2, 4, 8, 16}, [](Case& c, double v) { c.modes = static_cast<int>(v); });
  sweep("quadrature points", {12, 24, 48, 96}, [](Case& c, double v) { c.points_per_length = v; });
  sweep("window", {50e-6, 100e-6, 200e-6, 400e-6}, [](Case& c, double v) { c.duration = v; });
  fmt::print(
      "## How the cost grows\n\nIntegrator tolerance {:g}; the quickest of {} closings. The exponent p of cost = constant "
      "x^p:\n\n{}\nMeasured:\n\n{}\n",
      tolerance, repeats, markdown_table(slopes), markdown_table(rows));
}

void run() {
  SceneFile file = SceneFile::load(SOFTLAND_SCENES "/mem-gold.toml");
  file.set("waveform.main.level=17.771 V");
  file.set("driver.main.max_voltage=25 V");
  const PreparedScene prepared = prepare(file);
  fmt::print("# What a closing costs\n\n");
  print_bound(prepared);
  print_growth(prepared);
  fmt::print(
      "Made by `build/bench/bench_cost > results/cost.md` (configured with `-DSOFTLAND_BENCH=ON`) on {:%Y-%m-%d}, one thread.\n",
      fmt::localtime(std::time(nullptr)));
}

}  // namespace
}  // namespace softland

int main() {
  try {
    softland::run();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_cost: " << error.what() << "\n";
    return 2;
  }
}
