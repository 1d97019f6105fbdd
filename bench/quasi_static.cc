// Measures the quasi-static approach of a scene on devices: its closed form, and the result of a search, each at three speeds.
//
//   bench_quasi_static SCENE ACTUATOR [--seed N] [--length SHARE] [--tolerance T] [KEY=VALUE ...]
//
// Prints a row for each: 95th and 99th percentiles over 2000 fresh devices, closings and processor time of the search.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <iterator>
#include <string>
#include <vector>

#include "base/executor.h"
#include "config/assumed_spread.h"
#include "config/condition.h"
#include "studies/search/family_tournament.h"
#include "studies/search/robust_search.h"
#include "studies/search/search_space.h"

namespace {

using namespace softland;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void print_row(const std::string& name, const RobustCost& fresh, const RobustAim& aim, const SearchSetting& setting,
               const DriveWaveforms& waveforms, double of_step, long closings, double seconds) {
  const std::vector<DeviceOutcome> all = fresh.close_until(setting.drives(waveforms), aim.free.until, 2);
  const auto at = [&](Figure::Member member, double probability, double unit) {
    return quantile(all, key_of(member), probability) / unit;
  };
  const double waits = waited(all, aim.free.figure);
  fmt::print("| {} | {:.3g} | {:.3g} | {:.3g} | {:.3g} | {:.3g} | {:.1f} | {:.1f} | {:.3f} | {:.4f} | {} | {:.1f} |\n", name,
             at(&Metrics::largest_impact_velocity, 0.95, 1e-3), at(&Metrics::largest_impact_velocity, 0.99, 1e-3),
             at(&Metrics::major_bounce_height, 0.95, 1e-9), at(&Metrics::major_bounce_height, 0.99, 1e-9),
             at(&Metrics::peak_contact_force, 0.95, 1e-6), 1e6 * quantile(all, key_of(&Metrics::initial_contact_time), 0.95),
             1e6 * waits, waits / of_step, fresh.value(all, aim), closings, seconds);
}

int run(int count, char** arguments) {
  SceneFile file = SceneFile::load(arguments[1]);
  const Actuator actuator = find_named(actuators, std::string(arguments[2]))->value;
  std::uint64_t seed = 1;
  double length = 1;
  for (int i = 3; i < count; ++i) {
    const std::string word = arguments[i];
    if (word == "--seed") {
      seed = std::strtoull(arguments[++i], nullptr, 10);
    } else if (word == "--length") {
      length = std::strtod(arguments[++i], nullptr);
    } else {
      file.set(word);
    }
  }
  (void)assume_spread(file);
  double begin = processor_seconds();
  SearchSetting setting = search_setting(file, Target::bounce, actuator, "quasi-static", {});
  SearchSetting fast = setting;
  fast.space = SearchSpace(setting.given, actuator, "quasi-static:2", setting.scale.step.initial_contact_time);
  const StableApproach& approach = setting.space.quasi_static()->approach();
  fmt::print("{} {}: {} reaches the contact at {:.4g} V, standard deviation {:.3g} V, limit {:.4g} V, {} at {:.3g} V; {:.2f} s\n",
             arguments[1], arguments[2], approach.drive, approach.reaches, approach.deviation, approach.limit, approach.holder,
             approach.low, processor_seconds() - begin);
  begin = processor_seconds();
  fmt::print("{:.1f} % of 512 devices have a stable path; {:.2f} s\n",
             100 * share_with_path(setting.given, approach, 512, seed, 2), processor_seconds() - begin);
  RobustAim aim{.measure = parse_robust_measure("cvar:0.9", device_figures), .conditions = {}};
  const MeasuredUnits unknown;
  const RobustCost cost(setting, aim, own_devices(setting, unknown, 1024, seed, 0, 2, {}));
  begin = processor_seconds();
  aim.free = free_time(cost.close_by_step(2));
  fmt::print("plain step: free until {:.1f} us; {:.2f} s\n", 1e6 * aim.free.until, processor_seconds() - begin);
  const RobustCost fresh(setting, aim, own_devices(setting, unknown, 2000, seed + 1000, 3, 2, {}));
  const double of_step = waited(fresh.close_by_step(2), aim.free.figure);
  fmt::print(
      "| | v95 mm/s | v99 | B95 nm | B99 | F95 uN | t_i us | t_F us | tau | cost | closings | s "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  print_row("plain step", fresh, aim, setting, {}, of_step, 0, 0);
  if (!setting.starts_as_step()) print_row("of the scene", fresh, aim, setting, setting.given.drives.waveforms(), of_step, 0, 0);
  for (const double pace : {0.5, 1.0, 2.0}) {
    const SearchSetting& own = pace < 0.75 ? fast : setting;
    const SearchSpace paced = own.space.paced(pace * aim.free.until);
    print_row(fmt::format("{} closed form", pace), fresh, aim, own, paced.waveforms(paced.starts().front()), of_step, 0, 0);
    begin = processor_seconds();
    SearchBudget budget({});
    const auto found = search_at_pace(own, {.of_step = pace, .family = 0}, cost, aim, budget,
                                      {.closings = std::lround(length * tournament_closings), .seed = seed, .jobs = 2});
    if (!found) continue;
    print_row(fmt::format("{} searched", pace), fresh, aim, own, found->waveforms, of_step, budget.taken(),
              processor_seconds() - begin);
    const std::vector<Variable> variables = paced.variables();
    fmt::print("|");
    for (std::size_t k = 0; k < variables.size(); ++k)
      fmt::print(" {} {:.4g} ({:.4g}, {:.4g} to {:.4g})", variables[k].name, found->x[k], paced.starts().front()[k],
                 variables[k].lower, variables[k].upper);
    fmt::print("\n");
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    fmt::print(stderr, "usage: bench_quasi_static SCENE ACTUATOR [--seed N] [--length SHARE] [KEY=VALUE ...]\n");
    return 2;
  }
  return run(count, arguments);
}
