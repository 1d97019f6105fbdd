// Compares simulation with measurement: bench_measured FOLDER writes measured-actuators.svg and measured-actuators.md into
// FOLDER.
//
// Gap-closing actuators of Rauf, Contreras, Shih, Schindler & Pister, J. MEMS 31(1) (2022) 29-36, in air; nothing is fitted.
#include "tests/support/measured_actuators.h"

#include <fmt/format.h>

#include <array>
#include <exception>
#include <filesystem>
#include <iostream>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "base/write_whole.h"
#include "bench/figure.h"
#include "model/closing.h"
#include "model/pull_in.h"

namespace softland {
namespace {

using internal::Role;

double pull_in(const Device& d) { return static_pull_in(Switch(d), 0).voltage; }
double pull_out(const Device& d) { return release_voltage(Switch(d), 0); }

double closing_time(const Device& d, double volts) {
  const Trajectory t =
      simulate_closing(Switch(d), std::vector<Signal>{Signal::constant(volts)}, {.duration = 1e-3, .after_contact = 0});
  return t.touches.empty() ? std::numeric_limits<double>::quiet_NaN() : t.touches.front().begin;
}

std::string deviation(double simulated, double measured) { return fmt::format("{:+.1f} %", 100 * (simulated / measured - 1)); }

// Pull-in and pull-out voltages of a series of devices.
struct Voltages {
  Panel panel;
  std::vector<std::vector<std::string>> rows;
  std::array<Curve, 3> curves{{{.label = "pull-in", .points = {}},
                               {.label = "pull-out", .points = {}, .pen = Role::baseline},
                               {.label = "measured", .points = {}, .pen = Role::measured}}};

  Voltages(const std::string& title, const std::string& varied)
      : panel{.title = title, .x_label = varied + " as drawn", .x_unit = "m", .y_label = "voltage", .y_unit = "V"},
        rows{{varied + " [um]", "pull-in [V]", "simulated [V]", "deviation", "pull-out [V]", "simulated [V]", "deviation"}} {}

  void add(double x, const Device& d, const std::vector<double>& measured_in, double measured_out) {
    const double in = pull_in(d), out = pull_out(d);
    const double mean = std::accumulate(measured_in.begin(), measured_in.end(), 0.0) / static_cast<double>(measured_in.size());
    curves[0].points.push_back({x, in});
    curves[1].points.push_back({x, out});
    for (const double chip : measured_in) curves[2].points.push_back({x, chip});
    curves[2].points.push_back({x, measured_out});
    rows.push_back({fmt::format("{:g}", x * 1e6), fmt::format("{}", fmt::join(measured_in, ", ")), fmt::format("{:.2f}", in),
                    deviation(in, mean), fmt::format("{}", measured_out), fmt::format("{:.2f}", out),
                    deviation(out, measured_out)});
  }
  [[nodiscard]] Panel drawn() const {
    Panel p = panel;
    p.curves.assign(curves.begin(), curves.end());
    return p;
  }
};

void write(const std::filesystem::path& folder, const std::string& command) {
  Voltages lengths("Pull-in and pull-out voltage against overlap", "overlap");
  for (const test::MeasuredPullIn& m : test::measured_pull_in) {
    lengths.add(m.overlap, test::gap_closing_actuator(m.overlap), {m.pull_in.begin(), m.pull_in.end()}, m.pull_out);
  }
  Voltages springs("The same against the width of the springs", "spring width");
  for (const test::MeasuredSprings& m : test::measured_springs) {
    springs.add(m.width, test::gap_closing_actuator(76.5e-6, m.width), {m.pull_in}, m.pull_out);
  }

  std::vector<Panel> panels{lengths.drawn(), springs.drawn()};
  std::string tables;
  for (const test::MeasuredTimes& m : test::measured_times) {
    const Device d = test::gap_closing_actuator(m.overlap);
    const double threshold = pull_in(d);
    Panel times{.title = fmt::format("Closing time against voltage, overlap {:g} um", m.overlap * 1e6),
                .x_label = "voltage",
                .x_unit = "V",
                .y_label = "time to the stop",
                .y_unit = "s",
                .curves = {}};
    Curve line{.label = "simulated", .points = {}};
    Curve dots{.label = "measured", .points = {}, .pen = Role::measured};
    const double last = m.times.back().volts;
    for (double v = 1.03 * threshold; v <= last; v *= 1.01) line.points.push_back({v, closing_time(d, v)});
    std::vector<std::vector<std::string>> rows{{"voltage [V]", "over pull-in", "measured [us]", "simulated [us]", ""}};
    for (const test::MeasuredTime& t : m.times) {
      const double simulated = closing_time(d, t.volts);
      dots.points.push_back({t.volts, t.time});
      rows.push_back({fmt::format("{:g}", t.volts), fmt::format("{:.2f}", t.volts / threshold), fmt::format("{:g}", t.time * 1e6),
                      fmt::format("{:.2f}", simulated * 1e6), deviation(simulated, t.time)});
    }
    times.curves = {line, dots};
    panels.push_back(times);
    tables += fmt::format("\n## Closing times, overlap {:g} um\n\n{}", m.overlap * 1e6, markdown_table(rows));
  }
  write_whole(
      folder / "measured-actuators.svg",
      figure("Gap-closing actuators: measured by Rauf et al. (2022), simulated with nothing fitted",
             "Rigid fingers on springs, electrodes on both sides, film over a slit, etch of 0.4 um per edge as published.",
             panels));
  write_whole(folder / "measured-actuators.md",
              fmt::format("# Gap-closing actuators: simulated against measured\n\n"
                          "Made by `{}` (configured with `-DSOFTLAND_BENCH=ON`).\n\n![pull-in voltages and closing "
                          "times](measured-actuators.svg)\n\n"
                          "Measured by Rauf, Contreras, Shih, Schindler & Pister, J. MEMS 31(1) (2022) 29-36, in air at one "
                          "atmosphere; voltages are good to\n"
                          "1 V, times are means of three or four closings that differ by 1 to 9 %. The device is "
                          "`scenes/gap-closing-actuator.toml` with the\n"
                          "overlap and the springs varied: rigid fingers, the published dimensions and the published etch of 0.4 "
                          "um per edge. Nothing is fitted.\n"
                          "Not modelled: bending of the fingers, which lowers the voltages of the long ones, and the field at "
                          "the fingers' ends and roots,\n"
                          "which lowers those of the short ones. Near the threshold a closing creeps past the fold, and its time "
                          "depends on the voltage's\n"
                          "distance to it: 6 % of pull-in voltage is then 20 % of time.\n\n"
                          "## Pull-in and pull-out voltages\n\nThree chips; the deviation is from their mean.\n\n{}\n## Springs "
                          "of other widths, overlap 76.5 um\n\n{}{}",
                          command, markdown_table(lengths.rows), markdown_table(springs.rows), tables));
}

}  // namespace
}  // namespace softland

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: bench_measured FOLDER\n";
    return 2;
  }
  try {
    softland::write(argv[1], "build/bench/bench_measured results");
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
