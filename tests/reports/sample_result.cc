#include "sample_result.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace softland::test {
namespace {

using nlohmann::json;

constexpr double window = 600e-6;
constexpr double travel = 2e-6;
constexpr double rest_depth = 0.35e-9;
constexpr double stiffness = 6e3;  // contact force per depth [N/m]

struct Sample {
  double gap;
  double velocity;
};

/// Returns a reproducible number in [0, 1).
double random_unit(std::uint64_t& state) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return static_cast<double>(state >> 11) * 0x1p-53;
}

struct Arc {
  double begin, end, height;
};

/// Returns 57 parabolic arcs: five macro-rebounds, each followed by micro-rebounds, from 23.186 us to 374 us.
std::vector<Arc> plain_step_arcs() {
  constexpr double first = 23.186e-6;
  constexpr double last = 374e-6;
  std::vector<std::pair<double, double>> shapes;  // duration (to be scaled), height
  std::uint64_t state = 7;
  double macro = 803.1e-9;
  for (int arc = 0; arc < 57; ++arc) {
    if (arc % 11 == 4) {
      shapes.emplace_back(40 * std::sqrt(macro / 803.1e-9), macro);
      macro *= 0.56;
    } else {
      const double fade = std::pow(0.955, arc);
      shapes.emplace_back(1.2 + 2.2 * random_unit(state), 2e-9 + 95e-9 * fade * random_unit(state));
    }
  }
  double total = 0;
  constexpr double touch_share = 0.4;
  for (const auto& [duration, height] : shapes) total += duration + touch_share;
  const double scale = (last - first) / total;
  std::vector<Arc> arcs;
  double time = first;
  for (const auto& [duration, height] : shapes) {
    time += touch_share * scale;
    arcs.push_back({time, time + duration * scale, height});
    time = arcs.back().end;
  }
  arcs.back().end = last;
  return arcs;
}

Sample plain_step(double time, const std::vector<Arc>& arcs) {
  constexpr double first = 23.186e-6;
  if (time < first) {
    const double share = time / first;
    return {travel * (1 - share * share), 2 * travel * share / first * 0.77};
  }
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const Arc& arc = arcs[i];
    const double before = i == 0 ? first : arcs[i - 1].end;
    if (time < arc.begin) {
      const double share = (time - before) / (arc.begin - before);
      const double depth = 1.2e-9 + 0.06 * arc.height;
      return {-depth * std::sin(share * M_PI), depth * M_PI / (arc.begin - before) * std::cos(share * M_PI)};
    }
    if (time < arc.end) {
      const double length = arc.end - arc.begin;
      const double share = (time - arc.begin) / length;
      return {4 * arc.height * share * (1 - share), -4 * arc.height * (1 - 2 * share) / length};
    }
  }
  const double after = time - arcs.back().end;
  const double wave = std::exp(-after / 30e-6);
  return {-rest_depth * (1 - wave * std::cos(2.4e6 * after)), 0};
}

Sample soft_landing(double time) {
  constexpr double lands = 44.5e-6;
  if (time < lands) {
    const double share = time / lands;
    const double rest = 1 - share * share * (3 - 2 * share);
    return {travel * rest + 40e-9 * (1 - share) * share * share, travel * 6 * share * (1 - share) / lands + 0.9e-3 * share};
  }
  const double after = time - lands;
  return {-rest_depth * (1 - std::exp(-after / 0.5e-6)) - 0.1e-9 * std::exp(-after / 25e-6) * (1 - std::cos(1.6e6 * after)), 0};
}

template <class Motion>
json curve(std::size_t rows, const Motion& motion) {
  json out{{"time_s", json::array()},
           {"tip_gap_m", json::array()},
           {"tip_velocity_m_s", json::array()},
           {"contact_force_N", json::array()},
           {"rebounds", json::array()}};
  for (std::size_t row = 0; row < rows; ++row) {
    const double time = window * static_cast<double>(row) / static_cast<double>(rows - 1);
    const Sample sample = motion(time);
    out["time_s"].push_back(time);
    out["tip_gap_m"].push_back(sample.gap);
    out["tip_velocity_m_s"].push_back(sample.velocity);
    out["contact_force_N"].push_back(std::max(0.0, -stiffness * sample.gap));
  }
  return out;
}

json metrics(double first, double settled, int count, double height, double speed, double force) {
  return {{"initial_contact_time_s", first},
          {"permanent_contact_time_s", settled},
          {"bounce_time_s", settled - first},
          {"bounce_count", count},
          {"major_bounce_height_m", height},
          {"impact_velocity_m_s", speed},
          {"peak_contact_force_N", force},
          {"impact_energy_J", 3e-12 * speed},
          {"hold_force_N", 2.1e-6},
          {"drive_energy_J", 41.3e-12},
          {"peak_voltage_V", 28.087},
          {"peak_slew_V_s", nullptr},
          {"settled", true}};
}

constexpr const char* scene_text = R"(title = "Gold cantilever with a PZT layer: combined switch"

[structure]
kind = "cantilever"
length = "250 um"
width = "20 um"
thickness = "2 um"
youngs_modulus = "78 GPa"
density = "19300 kg/m^3"
modes = 4

[gap]
electrode = "3.5 um"
contact = "2 um"

[simulate]
duration = "600 us"
accuracy = 1e-6
)";

}  // namespace

json sample_optimize_result(std::size_t rows_per_curve) {
  const std::vector<Arc> arcs = plain_step_arcs();
  json result{{"kind", "optimize"},
              {"title", "Gold cantilever with a PZT layer: combined switch"},
              {"version", "0.1.0"},
              {"command", "softland optimize scenes/mem-gold-pzt.toml --target bounce --actuator pzt --seed 1"},
              {"status", "done"},
              {"target", "bounce"},
              {"actuator", "pzt"},
              {"seed", 1},
              {"optimizer", "multi-start Nelder-Mead"},
              {"evaluations", 2500},
              {"budget", "2500 evaluations"},
              {"termination", "budget used"},
              {"goal_met", true},
              {"natural_frequencies_rad_s", {97117.55, 615469.80, 1736866.72, 3424811.84}},
              {"pull_in", {{"static_V", 24.500}, {"dynamic_V", 22.4695}}},
              {"work", {{"integrator", "lawson"}, {"steps", 9120}, {"rhs_evaluations", 21877}, {"wall_s", 74.3}}},
              {"warnings", {"The width exceeds five thicknesses and plate_strain is off: the stiffness may be up to 10 % low."}},
              {"scene_toml", scene_text},
              {"scene", {{"metrics", {{"significant_rebound", "1 nm"}}}}},
              {"reproduce",
               {"softland optimize scenes/mem-gold-pzt.toml --target bounce --actuator pzt --seed 1",
                "softland simulate out/best.toml"}}};
  result["best"]["metrics"] = metrics(44.5e-6, 44.5e-6, 0, 0, 0.9e-3, 2.7e-6);
  result["best"]["parameters"] = {{"piezo.level_1_V", 0.17327},
                                  {"piezo.level_2_V", 0.60281},
                                  {"piezo.time_1_s", 19.74662e-6},
                                  {"piezo.time_2_s", 40.90419e-6}};
  result["metrics"] = result["best"]["metrics"];
  result["errors"] = {{"initial_contact_time_s", 2.1e-9},
                      {"permanent_contact_time_s", 2.1e-9},
                      {"impact_velocity_m_s", 1.4e-4},
                      {"major_bounce_height_m", nullptr}};
  result["baseline"]["metrics"] = metrics(23.186e-6, 374e-6, 57, 803.1e-9, 0.1328, 290e-6);
  result["best"]["waveforms"] = {
      {"main", {{0, 28.087}}},
      {"piezo",
       {{0, 0}, {5e-6, 0.17327}, {19.74662e-6, 0.17327}, {24.74662e-6, 0.60281}, {40.90419e-6, 0.60281}, {45.90419e-6, 0}}}};
  result["baseline"]["waveforms"] = {{"main", {{0, 28.087}}}, {"piezo", {{0, 0}}}};
  result["checks"] = {{{"name", "tolerance 1e-9"}, {"metrics", metrics(44.502e-6, 44.502e-6, 0, 0, 0.88e-3, 2.7e-6)}},
                      {{"name", "modes 6"}, {"metrics", metrics(44.31e-6, 47.92e-6, 1, 3.2e-9, 2.3e-3, 4.1e-6)}}};
  result["curves"]["baseline"] = curve(rows_per_curve, [&](double time) { return plain_step(time, arcs); });
  result["curves"]["best"] = curve(rows_per_curve, soft_landing);
  for (const Arc& arc : arcs)
    result["curves"]["baseline"]["rebounds"].push_back({arc.begin, arc.end, arc.height, (arc.begin + arc.end) / 2});

  json tried = json::array();
  json best_so_far = json::array();
  std::uint64_t state = 11;
  double best = 1e300;
  for (int evaluation = 1; evaluation <= 2500; ++evaluation) {
    const double progress = evaluation / 2500.0;
    const double cost = 1.4 * std::pow(10, -2.7 * progress * random_unit(state)) * std::exp(1.3 * random_unit(state) - 0.4);
    tried.push_back({evaluation, cost});
    if (cost < best) best_so_far.push_back({evaluation, best = cost});
  }
  result["search"] = {{"value_name", "cost"}, {"evaluations", tried}, {"best_so_far", best_so_far}};
  return result;
}

json sample_simulate_result(std::size_t rows_per_curve) {
  json result = sample_optimize_result(rows_per_curve);
  result["kind"] = "simulate";
  result["metrics"] = result["baseline"]["metrics"];
  result["errors"] = {{"initial_contact_time_s", 3e-10},
                      {"permanent_contact_time_s", 21e-6},
                      {"bounce_count", 6},
                      {"major_bounce_height_m", 8e-10}};
  result["curves"]["best"] = result["curves"]["baseline"];
  result["curves"].erase("baseline");
  result["best"] = {{"waveforms", result["baseline"]["waveforms"]}};
  result["command"] = "softland simulate scenes/mem-gold-pzt.toml";
  result["reproduce"] = {"softland simulate scenes/mem-gold-pzt.toml"};
  for (const char* key : {"baseline", "search", "checks", "target", "actuator", "optimizer", "evaluations", "budget",
                          "termination", "goal_met", "seed"}) {
    result.erase(key);
  }
  return result;
}

}  // namespace softland::test
