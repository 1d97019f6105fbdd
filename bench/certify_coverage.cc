// How often the errors that --certify gives cover the true ones, and by how much they exceed them, on random scenes.
//
// The truth is a run at a ten-thousandth of the scene's tolerance with four times the quadrature points. A figure whose
// difference from it is below what two such runs differ by counts as covered by any error. Ill-conditioned figures have no truth:
// of them is said how often the run lies in the range of the cloud, which 16 runs alike in distribution would give 15 of 17
// times.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bench/figure.h"
#include "model/closing.h"
#include "studies/certify.h"
#include "tests/support/random_scenes.h"

namespace softland {
namespace {

constexpr double truth_tighter = 1e-4;  // than the scene's tolerance
constexpr double truth_points = 96;
constexpr long most_steps = 3000;         // of the closing itself: eighteen more follow
constexpr double truth_rounding = 1e-11;  // relative: closer to it nothing is told apart

struct Options {
  std::uint64_t seed = 2;
  std::uint64_t scenes = 200;
  double accuracy = 1e-6;
};

struct Tally {
  int covered = 0, missed = 0;
  std::vector<double> excess, needed;  // error over the true one; true one over the difference that the error is a multiple of
  int clouds = 0, in_range = 0;
};

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return Metrics::unset;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

std::string percent(int part, int all) { return all == 0 ? "-" : fmt::format("{:.1f} %", 100.0 * part / all); }

void run(const Options& options) {
  std::map<std::string_view, Tally> tallies;
  int certified = 0, without_touch = 0, failed = 0, long_ones = 0;
  std::vector<std::string> misses;
  for (std::uint64_t index = 0; certified < static_cast<int>(options.scenes); ++index) {
    SceneFile file = test::random_scene(options.seed, index);
    file.set(fmt::format("simulate.accuracy={:g}", options.accuracy));
    const Prepared p = prepare(file);
    const Trajectory first =
        simulate_closing(p.device, p.signals(), {.duration = p.duration, .tolerance = p.tolerance, .max_steps = most_steps});
    if (p.device.film_states() > 0 || first.work.steps >= most_steps) {
      ++long_ones;
      continue;
    }
    const Closing c = certify(p);
    if (!std::isfinite(c.metrics.initial_contact_time)) {
      ++without_touch;
      continue;
    }
    const Switch fine(p.scene.device, {.points_per_length = truth_points});
    const Trajectory best =
        simulate_closing(fine, p.signals(), {.duration = p.duration, .tolerance = std::max(1e-13, truth_tighter * p.tolerance)});
    if (!c.certificate || best.status != Status::done) {
      ++failed;
      continue;
    }
    ++certified;
    if (certified % 20 == 0) fmt::print(stderr, "{} of {} scenes\n", certified, options.scenes);
    Metrics truth = metrics(best, p.scene.metrics);
    Metrics errors = c.errors;
    for (const CertifiedFigure& figure : certified_figures()) {
      if (figure.key == "hold_force_N") continue;  // of an equilibrium, which no run gives
      Tally& tally = tallies[figure.key];
      const double own = figure.value(c.metrics), other = figure.value(truth);
      if (!std::isfinite(own)) continue;
      const auto ill = std::find_if(c.certificate->ill_conditioned.begin(), c.certificate->ill_conditioned.end(),
                                    [&](const IllConditioned& one) { return one.key == figure.key; });
      if (ill != c.certificate->ill_conditioned.end()) {
        ++tally.clouds;
        tally.in_range += other >= ill->spread.low && other <= ill->spread.high;
        continue;
      }
      const double error = figure.error != nullptr ? figure.error(errors) : errors.bounce_count;
      const double difference = std::abs(own - other), least = truth_rounding * std::abs(other);
      const bool covered = difference <= std::max(error, least);
      ++(covered ? tally.covered : tally.missed);
      if (difference > least) {
        tally.excess.push_back(error / difference);
        tally.needed.push_back(error_safety * difference / error);
      }
      if (!covered)
        misses.push_back(fmt::format("{} {}: {:.3g} off, {:.3g} stated, of {:.6g}", index, figure.key, difference, error, own));
    }
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
  for (const CertifiedFigure& figure : certified_figures()) {
    const auto found = tallies.find(figure.key);
    if (found == tallies.end()) continue;
    add(figure.key, found->second);
    all.covered += found->second.covered;
    all.missed += found->second.missed;
    all.clouds += found->second.clouds;
    all.in_range += found->second.in_range;
    all.excess.insert(all.excess.end(), found->second.excess.begin(), found->second.excess.end());
    all.needed.insert(all.needed.end(), found->second.needed.begin(), found->second.needed.end());
  }
  add("all", all);
  fmt::print(
      "Seed {}, accuracy {:g}: {} scenes with a touch; {} more without one, {} that a run could not finish, {} left out (a "
      "compressible "
      "film, or more than {} steps). Factor {:g}.\n\n{}\n",
      options.seed, options.accuracy, certified, without_touch, failed, long_ones, most_steps, error_safety,
      markdown_table(rows));
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
    } else {
      throw std::invalid_argument(fmt::format("unknown option {}: bench_certify [--seed N] [--scenes N] [--accuracy X]", key));
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
