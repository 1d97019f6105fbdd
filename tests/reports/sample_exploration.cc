#include "sample_exploration.h"

#include <cmath>

#include "base/random.h"

namespace softland::test {

ExplorationReport sample_grid(std::size_t columns, std::size_t rows) {
  ExplorationReport report{.title = "Gold cantilever: a map", .study = "simulate"};
  report.columns = {{"structure_length_m", "structure.length", "m", true},
                    {"gap_contact_m", "gap.contact", "m", true},
                    {"initial_contact_time_s", "First contact", "s", false},
                    {"permanent_contact_time_s", "Permanent contact", "s", false},
                    {"bounce_count", "Rebounds", "", false},
                    {"major_bounce_height_m", "Highest rebound", "m", false},
                    {"impact_velocity_m_s", "Impact velocity", "m/s", false},
                    {"peak_voltage_V", "Peak voltage", "V", false}};
  report.planned = static_cast<std::int64_t>(columns * rows);
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t j = 0; j < rows; ++j) {
      const double length = 200e-6 + 100e-6 * static_cast<double>(i) / static_cast<double>(columns - 1);
      const double gap = 1e-6 + 2e-6 * static_cast<double>(j) / static_cast<double>(rows - 1);
      const double a = length / 250e-6, b = gap / 2e-6;
      ExploredPoint point{
          .number = static_cast<std::int64_t>(i * rows + j), .status = "done", .reason = {}, .values = {length, gap}};
      const auto nothing = std::vector<double>(6, Metrics::unset);
      if (a + b > 2.45) {
        point.status = "infeasible";
        point.reason = "gap.contact must be smaller than gap.electrode";
        point.values.insert(point.values.end(), nothing.begin(), nothing.end());
      } else if (a < 0.86 && b > 1.1) {
        point.status = "no_contact";
        point.values.insert(point.values.end(), nothing.begin(), nothing.end());
        point.values.back() = 45;
      } else {
        const double speed = 0.3 * b * std::sqrt(a) * (1 + 0.15 * std::sin(9 * a) * std::cos(5 * b));
        const double noise = random_uniform(1, Stream::scene, static_cast<std::uint64_t>(point.number));
        point.values.insert(point.values.end(), {40e-6 * a * a * std::sqrt(b), (300 + 40 * noise) * 1e-6 * a,
                                                 std::floor(4 + 40 * speed + 6 * noise), 8e-7 * speed * speed, speed, 45});
      }
      report.points.push_back(std::move(point));
    }
  }
  report.plan = "[plan]\nstudy = \"simulate\"\n";
  report.command = "softland explore scenes/mem-gold.toml --vary \"structure.length=200 um:300 um:200\"";
  return report;
}

ExplorationReport sample_cloud(std::size_t points) {
  ExplorationReport report{.title = "PZT cantilever: what can be had", .study = "simulate"};
  report.columns = {{"structure_thickness_m", "structure.thickness", "m", true},
                    {"gap_electrode_m", "gap.electrode", "m", true},
                    {"gap_contact_m", "gap.contact", "m", true},
                    {"waveform_main_levels_1_V", "waveform.main.levels[1]", "V", true},
                    {"waveform_main_times_1_s", "waveform.main.times[1]", "s", true},
                    {"initial_contact_time_s", "First contact", "s", false},
                    {"impact_velocity_m_s", "Impact velocity", "m/s", false},
                    {"impact_energy_J", "Impact energy", "J", false},
                    {"bounce_count", "Rebounds", "", false},
                    {"peak_voltage_V", "Peak voltage", "V", false}};
  report.planned = static_cast<std::int64_t>(points);
  std::uint64_t draw = 0;
  const auto uniform = [&] { return random_uniform(2, Stream::scene, draw++); };
  for (std::size_t k = 0; k < points; ++k) {
    const double thickness = 1.5 + uniform(), electrode = 3 + uniform(), gap = 1.5 + uniform(), level = 30 + 30 * uniform();
    const double time = 5 + 30 * uniform();
    const double closing = 900 / level * std::sqrt(gap) * (1 + 0.3 * (electrode - 3));
    const double speed = 6 / closing * (1 + std::pow(time / 20 - 1, 2)) + 0.05 * thickness;
    ExploredPoint point{.number = static_cast<std::int64_t>(k), .status = "done", .reason = {}, .values = {}};
    point.values = {thickness * 1e-6,
                    electrode * 1e-6,
                    gap * 1e-6,
                    level,
                    time * 1e-6,
                    closing * 1e-6,
                    speed,
                    1e-12 * std::exp(20 * speed),
                    std::floor(60 * speed),
                    level};
    if (level < 33) {
      point.status = "no_contact";
      for (std::size_t c = 5; c < 9; ++c) point.values[c] = Metrics::unset;
    }
    report.points.push_back(std::move(point));
  }
  report.aims = explored_aims(report.columns, "initial_contact_time,impact_velocity,peak_voltage");
  const ExploredFront front = explored_front(report);
  for (const std::size_t k : front.members) {
    const std::vector<double>& v = report.points[k].values;
    report.waveforms[report.points[k].number]["main"] = {{0, 0},     {1e-6, v[3]}, {v[4], v[3]}, {v[4] + 1e-6, 0},
                                                         {40e-6, 0}, {41e-6, 45},  {80e-6, 45}};
  }
  return report;
}

}  // namespace softland::test
