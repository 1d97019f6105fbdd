// Checks every invariant on thousands of random scenes. bench_soak [COUNT] [SEED] [--from N] runs scenes N to N + COUNT - 1 of
// tests/support/random_scenes.h on two threads. It writes a summary in Markdown to standard output and progress to standard
// error. The exit status is 1 if an invariant was violated. bench_soak --print INDEX [SEED] prints a scene.
#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "bench/figure.h"
#include "studies/closing/prepared.h"
#include "tests/support/invariants.h"
#include "tests/support/random_scenes.h"

namespace softland {
namespace {

constexpr long most_steps = 300'000, most_steps_with_film = 10'000;  // largest number of steps of a scene
constexpr int threads = 2;

struct Outcome {
  std::uint64_t index = 0;
  std::string what;  // status of the run, or kind of failure
  long steps = 0;
  double surplus = 0, energy_error = 0;  // energies over the bending energy
  double balance = 0;                    // energy error over the work of the sources, if that exceeds the bending energy
  bool implicit = false;                 // true if the run changed to an implicit method
  double depth = 0;                      // deepest interference over its bound
  double time = 0, velocity = 0;         // relative difference of t_i and v_i to a run with a hundredth of the tolerance
  std::vector<std::string> violations;
};

std::string became(const Trajectory& t, const Metrics& m) {
  if (m.status != Status::numerical_failure) return std::string(to_string(m.status));
  for (const auto& [part, name] :
       std::initializer_list<std::pair<const char*, const char*>>{{"of the electrode", "fails: pulled onto the electrode"},
                                                                  {"far side", "fails: reached the far side"},
                                                                  {"steps needed", "fails: more steps than allowed"},
                                                                  {"energy balance", "fails: energy balance"}}) {
    if (t.message.find(part) != std::string::npos) return name;
  }
  return "fails: " + t.message;
}

Outcome try_scene(std::uint64_t seed, std::uint64_t index) {
  const PreparedScene p = prepare(test::random_scene(seed, index));
  const std::vector<Signal> drives = p.signals();
  const auto run = [&](double tolerance) {
    return test::checked_run(p.model, drives,
                             {.duration = p.duration,
                              .tolerance = tolerance,
                              .max_steps = p.model.film_states() > 0 ? most_steps_with_film : most_steps},
                             1e-3, p.scene.metrics);
  };
  const test::CheckedRun c = run(p.tolerance);
  const Trajectory& t = c.trajectory;
  Outcome o{.index = index,
            .what = became(t, c.metrics),
            .steps = t.work.steps,
            .surplus = c.surplus,
            .energy_error = t.energy_error / p.model.bending_energy(),
            .balance = t.energy_error / std::max(p.model.bending_energy(), std::abs(t.energy.source_work)),
            .implicit = p.model.film_states() == 0 && t.work.integrator != Integrator::lawson,
            .depth = c.largest_penetration > 0 ? t.deepest_penetration / c.largest_penetration : 0,
            .violations = c.violations};
  if (t.status != Status::done || p.model.film_states() > 0) return o;
  const test::CheckedRun tighter = run(p.tolerance / 100);
  for (const std::string& violation : tighter.violations) o.violations.push_back("at a hundredth of the tolerance: " + violation);
  if (tighter.trajectory.status != Status::done) return o;
  if (std::string missed = test::missed_touch(t, tighter.trajectory); !missed.empty()) o.violations.push_back(std::move(missed));
  if (t.touches.empty() || tighter.trajectory.touches.empty()) return o;
  const test::Landing a = test::landing(t), b = test::landing(tighter.trajectory);
  o.time = std::abs(a.time / b.time - 1);
  o.velocity = std::abs(a.velocity / b.velocity - 1);
  constexpr double landing = 1e-3;
  if (!(o.time <= landing && o.velocity <= landing)) {
    o.violations.push_back(fmt::format("lands at {:.8g} s with {:.6g} m/s, in a tighter run at {:.8g} s with {:.6g} m/s", a.time,
                                       a.velocity, b.time, b.velocity));
  }
  return o;
}

std::string percentiles(const std::vector<Outcome>& all, double Outcome::*figure) {
  std::vector<double> values;
  for (const Outcome& o : all) {
    if (std::isfinite(o.*figure)) values.push_back(o.*figure);
  }
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) { return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))]; };
  return fmt::format("{:.1e} | {:.1e} | {:.1e} | {:.1e}", at(0.5), at(0.9), at(0.99), at(1));
}

std::string machine() {
  utsname name{};
  uname(&name);
  std::string processor = "unknown processor", line;
  std::ifstream info("/proc/cpuinfo");
  while (std::getline(info, line)) {
    if (line.starts_with("model name")) processor = line.substr(line.find(':') + 2);
  }
  return fmt::format("{}, {} cores, {} {}", processor, std::thread::hardware_concurrency(), name.sysname, name.release);
}

void report(const std::vector<Outcome>& all, const std::string& command, std::uint64_t seed, double seconds) {
  const std::time_t now = std::time(nullptr);
  char date[16];
  std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
  std::map<std::string, std::array<int, test::scene_families.size()>> counts;
  long steps = 0, implicit = 0, most_implicit = 0;
  std::size_t violated = 0;
  std::vector<Outcome> landed;
  for (const Outcome& o : all) {
    ++counts[o.what][o.index % test::scene_families.size()];
    steps += o.steps;
    if (o.implicit) ++implicit, most_implicit = std::max(most_implicit, o.steps);
    violated += o.violations.empty() ? 0 : 1;
    if (o.time > 0) landed.push_back(o);
  }
  std::vector<std::vector<std::string>> rows{{"outcome", "all"}};
  for (const std::string_view family : test::scene_families) rows[0].emplace_back(family);
  for (const auto& [what, by_family] : counts) {
    rows.push_back({what, std::to_string(std::accumulate(by_family.begin(), by_family.end(), 0))});
    for (const int n : by_family) rows.back().push_back(std::to_string(n));
  }
  fmt::print(
      "# {} random scenes\n\n"
      "Shipped scenes varied in everything a scene can say (`tests/support/random_scenes.h`), each run at its own tolerance and, "
      "where it\n"
      "ends well and has no compressible film, at a hundredth of it. Every run is held to `tests/support/invariants.h`: no "
      "energy without a source, no falling "
      "through,\n"
      "no event missed, no number that is not one, bounded work, and a reason where a run fails; and it lands as the tighter run "
      "does.\n\n"
      "- made by `{}` (configured with `-DSOFTLAND_BENCH=ON`), {}\n- machine: {}\n"
      "- {} scenes of seed {} in {:.0f} s on {} threads, {:.3g} steps; at most {} steps a scene, {} with a compressible film\n"
      "- {} runs went over from the explicit method to BDF, with {} steps at the most\n"
      "- **{} violate an invariant**{}\n\n{}\n"
      "| | median | 90 % | 99 % | worst |\n|---|---|---|---|---|\n"
      "| surplus of energy by an independent balance, over the bending energy | {} |\n"
      "| residual of the run's own balance, over the bending energy | {} |\n"
      "| the same over the sources' work where that is more | {} |\n"
      "| deepest interference over its bound | {} |\n"
      "| t_i against the tighter run, relative | {} |\n| v_i against the tighter run, relative | {} |\n",
      all.size(), command, date, machine(), all.size(), seed, seconds, threads, static_cast<double>(steps), most_steps,
      most_steps_with_film, implicit, most_implicit, violated, violated > 0 ? ", listed below" : "", markdown_table(rows),
      percentiles(all, &Outcome::surplus), percentiles(all, &Outcome::energy_error), percentiles(all, &Outcome::balance),
      percentiles(all, &Outcome::depth), percentiles(landed, &Outcome::time), percentiles(landed, &Outcome::velocity));
  if (violated == 0) return;
  fmt::print("\n## Violations\n\n`build/bench/bench_soak --print INDEX {} > scene.toml` prints a scene.\n\n", seed);
  for (const Outcome& o : all) {
    for (const std::string& violation : o.violations) {
      fmt::print("- {} ({}): {}\n", o.index, test::scene_families[o.index % test::scene_families.size()], violation);
    }
  }
}

int soak(std::uint64_t from, std::uint64_t count, std::uint64_t seed, const std::string& command) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<Outcome> all(count);
  std::atomic<std::uint64_t> next{0}, finished{0};
  std::mutex mutex;
  const auto work = [&] {
    for (std::uint64_t i = next++; i < count; i = next++) {
      try {
        all[i] = try_scene(seed, from + i);
      } catch (const std::exception& error) {
        all[i] = {.index = from + i, .what = "threw", .violations = {error.what()}};
      }
      const std::lock_guard lock(mutex);
      for (const std::string& violation : all[i].violations) fmt::print(stderr, "\r{}: {}\n", from + i, violation);
      if (++finished % 100 == 0) fmt::print(stderr, "\r{} of {}", finished.load(), count);
    }
  };
  std::vector<std::thread> workers;
  for (int i = 0; i < threads; ++i) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  fmt::print(stderr, "\n");
  report(all, command, seed, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return std::any_of(all.begin(), all.end(), [](const Outcome& o) { return !o.violations.empty(); }) ? 1 : 0;
}

}  // namespace
}  // namespace softland

int main(int argc, char** argv) {
  using namespace softland;
  try {
    std::vector<std::uint64_t> numbers;
    std::uint64_t from = 0;
    bool print = false;
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (word == "--print") {
        print = true;
      } else if (word == "--from" && i + 1 < argc) {
        from = std::stoull(argv[++i]);
      } else {
        numbers.push_back(std::stoull(word));
      }
    }
    const auto number = [&](std::size_t i, std::uint64_t otherwise) { return i < numbers.size() ? numbers[i] : otherwise; };
    const std::uint64_t seed = number(1, 1);
    if (print) {
      std::cout << test::random_scene(seed, number(0, 0)).text();
      return 0;
    }
    const std::uint64_t count = number(0, 10'000);
    const std::string command = fmt::format("build/bench/bench_soak {} {}{} > results/soak.md", count, seed,
                                            from > 0 ? fmt::format(" --from {}", from) : "");
    return soak(from, count, seed, command);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\nusage: bench_soak [COUNT] [SEED] [--from N], bench_soak --print INDEX [SEED]\n";
    return 2;
  }
}
