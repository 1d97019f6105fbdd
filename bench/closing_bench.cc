// Measures one closing for each integrator and tolerance, on one core: wall time, steps, right-hand sides and errors.
//
// The closing is the reference closing (gold cantilever, a step of 17.771 V without rise time, 100 us), from the scene file
// that users start from. `--integrator` and `--tolerance` select one row, `--runs` sets the number of repetitions. The time is
// the median over the repetitions.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "objectives/metrics.h"
#include "studies/closing/prepared.h"
#include "studies/closing/timing.h"

namespace softland {
namespace {

using namespace literals;
using Clock = std::chrono::steady_clock;

constexpr double window = 100_us;
constexpr std::string_view drive = "17.771 V";
// At this tolerance two integrators agree to seven digits. Errors are measured against it.
constexpr double reference_tolerance = 1e-12;
constexpr SwitchOptions reference_quadrature{.points_per_length = 48};

struct Options {
  std::string scene = SOFTLAND_SCENES "/mem-gold.toml";
  std::optional<std::string> integrator;
  std::optional<double> tolerance;
  std::optional<double> accuracy;  // requested accuracy of the scene, which chooses tolerance and quadrature
  int runs = 25;
  bool json = false;
};

constexpr double tolerances[] = {1e-4, 1e-5, 1e-6, 1e-8};

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Row {
  std::string_view integrator;
  double tolerance = 0;
  Status status = Status::not_run;
  Work work;
  double wall = 0;  ///< median [s]
  Metrics figures;
  double worst_error = 0;  ///< largest relative error of t_i, v_i and B_H
};

double relative(double value, double reference) { return std::abs(value - reference) / std::abs(reference); }

Row measure(const PreparedScene& prepared, const std::vector<Signal>& signals, Integrator integrator, double tolerance, int runs,
            const Metrics& reference) {
  const ClosingOptions options{.duration = window, .tolerance = tolerance, .integrator = integrator};
  std::vector<double> wall;
  Trajectory last;
  for (int i = 0; i < runs; ++i) {
    const auto start = Clock::now();
    last = simulate_closing(prepared.model, signals, options);
    wall.push_back(seconds_since(start));
  }
  Row row{.integrator = to_string(integrator),
          .tolerance = tolerance,
          .status = last.status,
          .work = last.work,
          .wall = median(wall)};
  row.figures = metrics(last, prepared.scene.metrics);
  row.worst_error = std::max({relative(row.figures.initial_contact_time, reference.initial_contact_time),
                              relative(row.figures.impact_velocity, reference.impact_velocity),
                              relative(row.figures.major_bounce_height, reference.major_bounce_height)});
  return row;
}

nlohmann::json as_json(const Row& row) {
  return {{"integrator", row.integrator},
          {"tolerance", row.tolerance},
          {"status", to_string(row.status)},
          {"initial_contact_time_s", row.figures.initial_contact_time},
          {"impact_velocity_m_s", row.figures.impact_velocity},
          {"major_bounce_height_m", row.figures.major_bounce_height},
          {"bounce_count", row.figures.bounce_count},
          {"worst_relative_error", row.worst_error},
          {"steps", row.work.steps},
          {"rhs_evaluations", row.work.rhs_evaluations},
          {"wall_s", row.wall},
          {"wall_per_rhs_s", row.wall / static_cast<double>(row.work.rhs_evaluations)}};
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view key = argv[i];
    const auto value = [&] {
      if (++i == argc) throw std::invalid_argument(fmt::format("{} needs a value", key));
      return std::string(argv[i]);
    };
    if (key == "--json") {
      options.json = true;
    } else if (key == "--scene") {
      options.scene = value();
    } else if (key == "--integrator") {
      options.integrator = value();
    } else if (key == "--tolerance") {
      options.tolerance = std::stod(value());
    } else if (key == "--accuracy") {
      options.accuracy = std::stod(value());
    } else if (key == "--runs") {
      options.runs = std::max(1, std::stoi(value()));
    } else {
      std::vector<std::string_view> names;
      for (const Integrator one : all_integrators) names.push_back(to_string(one));
      throw std::invalid_argument(fmt::format(
          "unknown option {}: bench_closing [--scene FILE] [--integrator {}] [--tolerance X | --accuracy X] [--runs N] "
          "[--json]",
          key, fmt::join(names, "|")));
    }
  }
  return options;
}

void run(const Options& options) {
  SceneFile file = SceneFile::load(options.scene);
  // Give volts everywhere, so that no pull-in voltage has to be computed.
  file.set(fmt::format("waveform.main.level={}", drive));
  file.set("driver.main.max_voltage=25 V");
  if (options.accuracy) file.set(fmt::format("simulate.accuracy={}", *options.accuracy));
  const PreparedScene prepared = prepare(file);
  const std::optional<double> asked = options.accuracy ? prepared.tolerance : options.tolerance;
  const std::vector<Signal> signals = prepared.signals();

  const Metrics reference = metrics(simulate_closing(Switch(prepared.scene.device, reference_quadrature), signals,
                                                     {.duration = window, .tolerance = reference_tolerance}),
                                    prepared.scene.metrics);
  const double rhs = right_hand_side_seconds(prepared.model, signals, window, options.runs * 20);
  std::vector<Row> rows;
  for (const Integrator which : all_integrators) {
    if (options.integrator && *options.integrator != to_string(which)) continue;
    if (asked) {
      rows.push_back(measure(prepared, signals, which, *asked, options.runs, reference));
      continue;
    }
    for (const double tolerance : tolerances) {
      rows.push_back(measure(prepared, signals, which, tolerance, options.runs, reference));
    }
  }
  if (rows.empty()) throw std::invalid_argument(fmt::format("no integrator is named {}", *options.integrator));

  if (options.json) {
    nlohmann::json out{{"scene", options.scene},
                       {"drive", drive},
                       {"window_s", window},
                       {"quadrature_points", prepared.model.quadrature().points()},
                       {"modes", prepared.model.modes()},
                       {"runs", options.runs},
                       {"rhs_s", rhs},
                       {"reference",
                        {{"tolerance", reference_tolerance},
                         {"initial_contact_time_s", reference.initial_contact_time},
                         {"impact_velocity_m_s", reference.impact_velocity},
                         {"major_bounce_height_m", reference.major_bounce_height}}},
                       {"closings", nlohmann::json::array()}};
    for (const Row& row : rows) out["closings"].push_back(as_json(row));
    std::cout << out.dump(2) << "\n";
    return;
  }
  fmt::print("step of {}, {:g} us, {} modes, {} quadrature points; {:.1f} ns per right-hand side; medians of {} runs\n\n", drive,
             window * 1e6, prepared.model.modes(), prepared.model.quadrature().points(), rhs * 1e9, options.runs);
  fmt::print("{:<15}{:>8}{:>8}{:>9}{:>11}{:>10}{:>10}{:>11}{:>9}{:>11}\n", "integrator", "tol", "steps", "rhs", "ms/closing",
             "ns/rhs", "t_i [us]", "v_i [m/s]", "B_H[nm]", "worst err");
  for (const Row& row : rows) {
    fmt::print("{:<15}{:>8.0e}{:>8}{:>9}{:>11.3f}{:>10.1f}{:>10.4f}{:>11.6f}{:>9.3f}{:>11.1e}\n", row.integrator, row.tolerance,
               row.work.steps, row.work.rhs_evaluations, row.wall * 1e3,
               row.wall / static_cast<double>(row.work.rhs_evaluations) * 1e9, row.figures.initial_contact_time * 1e6,
               row.figures.impact_velocity, row.figures.major_bounce_height * 1e9, row.worst_error);
  }
}

}  // namespace
}  // namespace softland

int main(int argc, char** argv) {
  try {
    softland::run(softland::parse(argc, argv));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_closing: " << error.what() << "\n";
    return 2;
  }
}
