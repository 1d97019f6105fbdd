// Compares the requested accuracy of scenes with the true error of their figures, on random scenes: bench_accuracy [COUNT [SEED
// [film]]]
//
// Every scene is run as by `simulate` at accuracies from 1e-2 to 1e-5. The reference has an integrator tolerance of 1e-12 and
// more quadrature points than the finest setting. A figure is compared if it is known and well conditioned: an imperceptible
// change of the contact gap (1e-9), and a tenfold tolerance of the reference, must change it by less than a tenth of the
// requested accuracy.
//
// The argument `film` gives every scene a compressible film in place of its gas. Its stiff equations take a hundred times
// longer, so the tightest accuracy is 1e-3, and scenes with more than 3000 steps are left out. The reference is explicit, in as
// many steps as the stiffness requires. Prints Markdown.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "bench/figure.h"
#include "studies/closing/prepared.h"
#include "studies/closing/simulate.h"
#include "tests/support/random_scenes.h"

namespace softland {
namespace {

constexpr std::array accuracies{1e-2, 1e-3, 1e-4, 1e-5};
constexpr std::array names{"t_i", "v_i", "B_H", "peak force"};
constexpr double imperceptible = 1e-9;
constexpr long most_film_steps = 3000;
constexpr double looser_by = 10;

struct Task {
  std::uint64_t count = 200, seed = 1;
  bool film = false;
  [[nodiscard]] double reference_tolerance() const { return film ? 1e-10 : 1e-12; }
  [[nodiscard]] SwitchOptions reference_quadrature() const { return {.points_per_length = film ? 64.0 : 128.0}; }
  [[nodiscard]] std::size_t accuracies_asked() const { return accuracies.size() - (film ? 2 : 0); }
  [[nodiscard]] std::optional<SceneFile> scene(std::uint64_t index) const {
    return film ? test::random_film_scene(seed, index) : test::random_scene(seed, index);
  }
};

using Figures = std::array<double, 4>;

struct Outcome {
  Status status = Status::not_run;
  Figures figures{};
};

Figures figures(const Metrics& m) {
  return {m.initial_contact_time, m.impact_velocity, m.major_bounce_height, m.peak_contact_force};
}

Outcome reference(const Task& task, const PreparedScene& p, double perturbation, double looser = 1) {
  Device device = p.scene.device;
  device.gap.contact *= 1 + perturbation;
  const Switch perturbed(device, task.reference_quadrature());
  ClosingOptions options{.duration = p.duration,
                         .tolerance = looser * task.reference_tolerance(),
                         .integrator = task.film ? Integrator::lawson : Integrator::automatic,
                         .max_steps = task.film ? 300'000 : 100'000};
  const Trajectory t = simulate_closing(perturbed, p.signals(), options);
  return {t.status, figures(metrics(t, p.scene.metrics))};
}

struct Miss {
  std::uint64_t index = 0;
  double accuracy = 0;
  std::string figure;
  double error = 0;
};

struct Tally {
  long figures = 0, within = 0, ill = 0;
  std::vector<double> share;  // error over the requested accuracy
  double seconds = 0;
};

struct Result {
  std::array<std::array<Tally, names.size()>, accuracies.size()> tallies;
  std::vector<Miss> misses;
  std::map<std::string, long> scenes;
};

double relative(double value, double truth, double least) {
  if (std::isnan(value) && std::isnan(truth)) return 0;
  const double e = std::abs(value - truth) / std::max(std::abs(truth), least);
  return std::isnan(e) ? std::numeric_limits<double>::infinity() : e;
}

/// The reference values of a scene's figures.
struct Truth {
  Figures value, spread, least;
};

/// Counts the figures of a run at the accuracy with index a.
void count(std::uint64_t index, std::size_t a, const Truth& truth, const Figures& found, double seconds, Result& result) {
  for (std::size_t f = 0; f < names.size(); ++f) {
    if (std::isnan(truth.value[f])) continue;
    Tally& tally = result.tallies[a][f];
    if (!(truth.spread[f] < accuracies[a] / 10)) {
      ++tally.ill;
      continue;
    }
    const double error = relative(found[f], truth.value[f], truth.least[f]);
    ++tally.figures;
    tally.seconds += seconds;
    tally.share.push_back(error / accuracies[a]);
    if (error <= accuracies[a]) {
      ++tally.within;
    } else {
      result.misses.push_back({index, accuracies[a], names[f], error});
    }
  }
}

void judge(const Task& task, std::uint64_t index, Result& result) {
  const std::optional<SceneFile> file = task.scene(index);
  if (!file) {
    ++result.scenes["rigid"];
    return;
  }
  const PreparedScene p = prepare(*file);
  if (!task.film && p.model.film_states() > 0) {
    ++result.scenes["with a compressible film, judged by themselves"];
    return;
  }
  if (task.film) {
    const ClosingOptions options{.duration = p.duration,
                                 .tolerance = tolerance_for(accuracies[task.accuracies_asked() - 1]),
                                 .max_steps = most_film_steps};
    if (simulate_closing(p.model, p.signals(), options).work.steps >= most_film_steps) {
      ++result.scenes[fmt::format("with more than {} steps, left out", most_film_steps)];
      return;
    }
  }
  const Outcome truth = reference(task, p, 0);
  if (truth.status != Status::done && truth.status != Status::no_contact) {
    ++result.scenes[std::string(to_string(truth.status))];
    return;
  }
  ++result.scenes[std::isnan(truth.figures[0]) ? "no touch" : "touches"];
  if (std::isnan(truth.figures[0])) return;
  const Outcome up = reference(task, p, imperceptible), down = reference(task, p, -imperceptible),
                looser = reference(task, p, 0, looser_by);
  Truth known{.value = truth.figures, .spread = {}, .least = {0, 0, p.scene.metrics.significant_rebound, least_peak_force(p)}};
  for (std::size_t f = 0; f < names.size(); ++f) {
    for (const Outcome* other : {&up, &down, &looser})
      known.spread[f] = std::max(known.spread[f], relative(other->figures[f], truth.figures[f], known.least[f]));
  }
  for (std::size_t a = 0; a < task.accuracies_asked(); ++a) {
    SceneFile asked = *file;
    asked.erase("simulate.tolerance");
    asked.set(fmt::format("simulate.accuracy={}", accuracies[a]));
    const PreparedScene with = prepare(asked);
    const auto start = std::chrono::steady_clock::now();
    const Closing closing = simulate(with, true);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    count(index, a, known, figures(closing.metrics), seconds, result);
  }
}

Result merged(const std::vector<Result>& parts) {
  Result all;
  for (const Result& part : parts) {
    for (std::size_t a = 0; a < accuracies.size(); ++a) {
      for (std::size_t f = 0; f < names.size(); ++f) {
        Tally& to = all.tallies[a][f];
        const Tally& from = part.tallies[a][f];
        to.figures += from.figures;
        to.within += from.within;
        to.ill += from.ill;
        to.seconds += from.seconds;
        to.share.insert(to.share.end(), from.share.begin(), from.share.end());
      }
    }
    all.misses.insert(all.misses.end(), part.misses.begin(), part.misses.end());
    for (const auto& [what, n] : part.scenes) all.scenes[what] += n;
  }
  std::sort(all.misses.begin(), all.misses.end(),
            [](const Miss& a, const Miss& b) { return std::pair(a.index, -a.accuracy) < std::pair(b.index, -b.accuracy); });
  return all;
}

void print(const Task& task, const Result& all, unsigned workers) {
  std::vector<std::vector<std::string>> rows{{"accuracy", "figure", "well-conditioned", "within", "share",
                                              "median error / accuracy", "99 % error / accuracy", "ill-conditioned"}};
  long figures = 0, within = 0;
  for (std::size_t a = 0; a < task.accuracies_asked(); ++a) {
    for (std::size_t f = 0; f < names.size(); ++f) {
      Tally t = all.tallies[a][f];
      std::sort(t.share.begin(), t.share.end());
      const auto quantile = [&](double q) {
        return t.share.empty()
                   ? std::string("-")
                   : fmt::format("{:.2g}", t.share[static_cast<std::size_t>(q * static_cast<double>(t.share.size() - 1))]);
      };
      rows.push_back(
          {fmt::format("{:g}", accuracies[a]), names[f], std::to_string(t.figures), std::to_string(t.within),
           fmt::format("{:.2f} %", 100.0 * static_cast<double>(t.within) / static_cast<double>(std::max(1L, t.figures))),
           quantile(0.5), quantile(0.99), std::to_string(t.ill)});
      figures += t.figures;
      within += t.within;
    }
  }
  fmt::print("# Accuracy asked for and delivered{}\n\n", task.film ? ", compressible films" : "");
  std::vector<std::string> kinds;
  for (const auto& [what, n] : all.scenes) kinds.push_back(fmt::format("{} {}", n, what));
  fmt::print(
      "{} random scenes of seed {} ({}). A figure is well-conditioned where a billionth of the contact gap, or a\n"
      "tenfold tolerance of the reference, moves it by less than a tenth of the accuracy. Reference: integrator tolerance {:g}, "
      "{:g} quadrature points per length.\n\n",
      task.count, task.seed, fmt::join(kinds, ", "), task.reference_tolerance(), task.reference_quadrature().points_per_length);
  fmt::print("Within the accuracy asked for: **{} of {} figures, {:.2f} %**.\n\n{}\n", within, figures,
             100.0 * static_cast<double>(within) / static_cast<double>(std::max(1L, figures)), markdown_table(rows));
  fmt::print("Misses:\n\n");
  for (const Miss& m : all.misses) {
    fmt::print("- scene {} ({}), accuracy {:g}, {}: {:.2g}\n", m.index,
               test::scene_families[m.index % test::scene_families.size()], m.accuracy, m.figure, m.error);
  }
  if (all.misses.empty()) fmt::print("- none\n");
  fmt::print(
      "\nMade by `build/bench/bench_accuracy {} {}{}` (configured with `-DSOFTLAND_BENCH=ON`) on {:%Y-%m-%d}, {} threads.\n",
      task.count, task.seed, task.film ? " film" : "", fmt::localtime(std::time(nullptr)), workers);
}

void run(const Task& task) {
  const auto workers = std::max(1U, std::thread::hardware_concurrency());
  std::vector<Result> parts(workers);
  std::atomic<std::uint64_t> next{0};
  std::vector<std::thread> threads;
  for (Result& part : parts) {
    threads.emplace_back([&] {
      for (std::uint64_t i = next++; i < task.count; i = next++) {
        judge(task, i, part);
        if (i % 20 == 19) fmt::print(stderr, "{} of {} scenes\n", i + 1, task.count);
      }
    });
  }
  for (std::thread& t : threads) t.join();
  print(task, merged(parts), workers);
}

}  // namespace
}  // namespace softland

int main(int argc, char** argv) {
  try {
    softland::Task task;
    if (argc > 1) task.count = std::strtoull(argv[1], nullptr, 10);
    if (argc > 2) task.seed = std::strtoull(argv[2], nullptr, 10);
    task.film = argc > 3 && std::string_view(argv[3]) == "film";
    softland::run(task);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_accuracy: " << error.what() << "\n";
    return 2;
  }
}
