// Measures how often the errors of --certify cover the true errors, and by how much they exceed them, on random scenes.
//
// The true value comes from a run with a ten-thousandth of the tolerance and four times the quadrature points, at least 96. A
// difference that is smaller than the difference between two such runs counts as covered. An ill-conditioned figure has no true
// value. For it the program counts how often the run is in the range of the cloud; of 16 runs with the same distribution that
// would be 15 of 17. With --film yes every scene has a compressible film in place of its gas, which takes a hundred times
// longer.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "bench/figure.h"
#include "model/closing.h"
#include "studies/closing/certify.h"
#include "tests/support/random_scenes.h"

namespace softland {
namespace {

constexpr double truth_tighter = 1e-4;  // tolerance of the true run over that of the run
constexpr double truth_finer = 4;
constexpr double fewest_truth_points = 96;
constexpr double stated_rounding = 1e-9, far_off = 10;
constexpr double truth_rounding = 1e-11;  // relative difference that is not resolved

struct Options {
  std::uint64_t seed = 2;
  std::uint64_t scenes = 200;
  double accuracy = 1e-6;
  long steps = 20000;  // largest number of steps of the closing; seventeen tighter runs follow
  bool film = false;
};

struct Tally {
  int covered = 0, missed = 0;
  std::vector<double> excess,
      needed;  // stated over true error; true error over the difference of which the stated one is a multiple
  int clouds = 0, in_range = 0;

  void add(const Tally& other) {
    covered += other.covered;
    missed += other.missed;
    clouds += other.clouds;
    in_range += other.in_range;
    excess.insert(excess.end(), other.excess.begin(), other.excess.end());
    needed.insert(needed.end(), other.needed.begin(), other.needed.end());
  }
};

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return Metrics::unset;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

std::string percent(int part, int all) { return all == 0 ? "-" : fmt::format("{:.1f} %", 100.0 * part / all); }

enum class Outcome { none, without_touch, failed, too_long, certified };

// Counts of the errors that simulate() states without --certify.
struct Stated {
  int held = 0, missed = 0, none = 0, far_off = 0;  // far_off: the true error is more than ten times the stated one
};

struct Scene {
  Outcome outcome = Outcome::none;
  std::map<std::string_view, Tally> tallies;
  std::map<std::string_view, Stated> stated;
  std::vector<std::string> misses;
};

Scene judge(const Options& options, std::uint64_t index) {
  Scene scene;
  std::optional<SceneFile> file =
      options.film ? test::random_film_scene(options.seed, index) : test::random_scene(options.seed, index);
  if (!file) return scene;
  file->set(fmt::format("simulate.accuracy={:g}", options.accuracy));
  const PreparedScene p = prepare(*file);
  if (!options.film && p.model.film_states() > 0) return scene;  // compressible films are studied with --film
  const Closing plain = simulate(p, true);
  scene.outcome = Outcome::too_long;
  if (plain.trajectory.work.steps >= options.steps) return scene;
  scene.outcome = Outcome::without_touch;
  if (plain.trajectory.status == Status::done && plain.trajectory.touches.empty()) return scene;
  const Closing c = certify(p);
  if (!std::isfinite(c.metrics.initial_contact_time)) return scene;
  scene.outcome = Outcome::failed;
  if (!c.certificate) return scene;
  const Switch fine(p.scene.device,
                    {.points_per_length = std::max(fewest_truth_points, truth_finer * c.quadrature.points_per_length)});
  const Trajectory best = simulate_closing(fine, p.signals(),
                                           {.duration = p.duration,
                                            .tolerance = std::max(1e-13, truth_tighter * c.tolerance),
                                            .steady_force = p.scene.metrics.steady_force * c.trajectory.hold_force});
  if (best.status != Status::done) return scene;
  scene.outcome = Outcome::certified;
  const Metrics truth = metrics(best, p.scene.metrics);
  for (const Figure& figure : all_figures) {
    if (!figure.error_is_from_two_runs() || figure.conditioning == Conditioning::open) continue;
    const double own = figure.value(plain.metrics), other = figure.value(truth), error = plain.errors[figure];
    if (!std::isfinite(own)) continue;
    Stated& stated = scene.stated[figure.key];
    const double difference = std::abs(own - other), least = stated_rounding * std::abs(other);
    if (!std::isfinite(error)) {
      ++stated.none;
    } else if (difference <= std::max(error, least)) {
      ++stated.held;
    } else {
      ++stated.missed;
      if (difference > far_off * error) {
        ++stated.far_off;
        scene.misses.push_back(
            fmt::format("{} {} without --certify: {:.3g} off, {:.3g} stated, of {:.6g}; residual of the energies {:.3g} J", index,
                        figure.key, difference, error, own, plain.trajectory.energy_error));
      }
    }
  }
  for (const Figure& figure : all_figures) {
    if (!figure.has_error() || figure.conditioning == Conditioning::rest || figure.conditioning == Conditioning::open)
      continue;  // no run gives the errors of an equilibrium
    Tally& tally = scene.tallies[figure.key];
    const double own = figure.value(c.metrics), other = figure.value(truth);
    if (!std::isfinite(own)) continue;
    const auto ill = std::find_if(c.certificate->ill_conditioned.begin(), c.certificate->ill_conditioned.end(),
                                  [&](const IllConditioned& one) { return one.figure.key == figure.key; });
    if (ill != c.certificate->ill_conditioned.end()) {
      ++tally.clouds;
      tally.in_range += other >= ill->spread.low && other <= ill->spread.high;
      continue;
    }
    const double error = c.errors[figure], difference = std::abs(own - other), least = truth_rounding * std::abs(other);
    const bool covered = difference <= std::max(error, least);
    ++(covered ? tally.covered : tally.missed);
    if (difference > least) {
      tally.excess.push_back(error / difference);
      tally.needed.push_back(error_safety * difference / error);
    }
    if (!covered) {
      scene.misses.push_back(
          fmt::format("{} {}: {:.3g} off, {:.3g} stated, of {:.6g}", index, figure.key, difference, error, own));
    }
  }
  return scene;
}

void run(const Options& options) {
  std::vector<std::thread> threads;
  std::mutex mutex;
  std::map<std::uint64_t, Scene> scenes;
  std::uint64_t next = 0, certified = 0;
  for (unsigned k = 0; k < std::max(1U, std::thread::hardware_concurrency()); ++k) {
    threads.emplace_back([&] {
      std::unique_lock lock(mutex);
      while (certified < options.scenes) {
        const std::uint64_t index = next++;
        lock.unlock();
        Scene scene = judge(options, index);
        lock.lock();
        certified += scene.outcome == Outcome::certified;
        if (scene.outcome == Outcome::certified && certified % 20 == 0)
          fmt::print(stderr, "{} of {} scenes\n", certified, options.scenes);
        scenes.emplace(index, std::move(scene));
      }
    });
  }
  for (std::thread& t : threads) t.join();

  std::map<std::string_view, Tally> tallies;
  std::map<std::string_view, Stated> stated;
  std::map<Outcome, std::uint64_t> counts;
  std::vector<std::string> misses;
  for (const auto& [index, scene] : scenes) {  // the order makes the result independent of the threads
    if (counts[Outcome::certified] == options.scenes) break;
    ++counts[scene.outcome];
    for (const auto& [key, one] : scene.tallies) tallies[key].add(one);
    for (const auto& [key, one] : scene.stated) {
      Stated& sum = stated[key];
      sum.held += one.held, sum.missed += one.missed, sum.none += one.none, sum.far_off += one.far_off;
    }
    misses.insert(misses.end(), scene.misses.begin(), scene.misses.end());
  }
  std::vector<std::vector<std::string>> rows{{"figure", "well-conditioned", "covered", "median excess", "factor needed by 95 %",
                                              "by 99 %", "ill-conditioned", "in the range of the cloud"}};
  Tally all;
  const auto add = [&](std::string_view name, const Tally& t) {
    const int count = t.covered + t.missed;
    rows.push_back({std::string(name), fmt::format("{}", count), percent(t.covered, count),
                    fmt::format("{:.2g}", quantile(t.excess, 0.5)), fmt::format("{:.2g}", quantile(t.needed, 0.95)),
                    fmt::format("{:.2g}", quantile(t.needed, 0.99)), fmt::format("{}", t.clouds), percent(t.in_range, t.clouds)});
  };
  for (const Figure& figure : all_figures) {
    const auto found = tallies.find(figure.key);
    if (found == tallies.end()) continue;
    add(figure.key, found->second);
    all.add(found->second);
  }
  add("all", all);
  fmt::print(
      "Seed {}, accuracy {:g}{}: {} scenes with a touch; {} more without one, {} that a run could not finish, {} left out (more "
      "than {} steps). Factor {:g}.\n\n{}\n",
      options.seed, options.accuracy, options.film ? ", each with a compressible film in the place of its gas" : "",
      counts[Outcome::certified], counts[Outcome::without_touch], counts[Outcome::failed], counts[Outcome::too_long],
      options.steps, error_safety, markdown_table(rows));
  std::vector<std::vector<std::string>> plain{{"figure", "stated", "hold", "off by more than ten times", "not stated"}};
  for (const Figure& figure : all_figures) {
    const auto found = stated.find(figure.key);
    if (found == stated.end()) continue;
    const Stated& s = found->second;
    plain.push_back({std::string(figure.key), fmt::format("{}", s.held + s.missed), percent(s.held, s.held + s.missed),
                     fmt::format("{}", s.far_off), percent(s.none, s.held + s.missed + s.none)});
  }
  fmt::print("Without --certify, beyond {:g} of the figure:\n\n{}\n", stated_rounding, markdown_table(plain));
  fmt::print("Not covered (scene, figure):\n\n");
  for (const std::string& miss : misses) fmt::print("- {}\n", miss);
  if (misses.empty()) fmt::print("- none\n");
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view key = argv[i];
    if (key == "--seed") {
      options.seed = std::stoull(argv[i + 1]);
    } else if (key == "--scenes") {
      options.scenes = std::stoull(argv[i + 1]);
    } else if (key == "--accuracy") {
      options.accuracy = std::stod(argv[i + 1]);
    } else if (key == "--steps") {
      options.steps = std::stol(argv[i + 1]);
    } else if (key == "--film") {
      options.film = std::string_view(argv[i + 1]) == "yes";
    } else {
      throw std::invalid_argument(fmt::format(
          "unknown option {}: bench_certify [--seed N] [--scenes N] [--accuracy X] [--steps N] [--film yes|no]", key));
    }
  }
  return options;
}

}  // namespace
}  // namespace softland

int main(int argc, char** argv) {
  try {
    softland::run(softland::parse(argc, argv));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_certify: " << error.what() << "\n";
    return 2;
  }
}
