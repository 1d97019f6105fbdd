// Functions with the difficulties that soft landing presents to an optimizer: narrow curved valleys, many minima, kinks, small
// jumps. All are of order 1 over most of the box and (nearly) 0 at their minimum.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "optimizers/problem.h"

namespace softland::landscapes {

struct Landscape {
  std::string name;
  Problem problem;
  double solved = 0;  ///< a value at or below this counts as a solution
};

inline Problem box(std::size_t dimension, double lower, double upper, std::function<double(std::span<const double>)> objective) {
  Problem problem{.variables = {}, .objective = std::move(objective), .starts = {}};
  for (std::size_t i = 0; i < dimension; ++i) {
    problem.variables.push_back({.name = fmt::format("x{}", i), .lower = lower, .upper = upper});
  }
  return problem;
}

/// A quadratic bowl with minimum 0 at (0.3, ..., 0.3).
inline double bowl(std::span<const double> x) {
  double sum = 0;
  for (const double coordinate : x) sum += (coordinate - 0.3) * (coordinate - 0.3);
  return sum;
}

/// Rosenbrock's curved valley, divided by 100, with minimum 0 at (1, ..., 1).
inline double rosenbrock(std::span<const double> x) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double across = x[i + 1] - x[i] * x[i];
    sum += 100 * across * across + (1 - x[i]) * (1 - x[i]);
  }
  return sum / 100;
}

/// Rastrigin's function, divided by 10: minima on a grid in a wide bowl, the lowest of them 0 at (0.3, ..., 0.3). The spacing
/// of 1.13 is not a fraction of the box that a first step could match.
inline double rastrigin(std::span<const double> x) {
  double sum = 0;
  for (const double coordinate : x) {
    const double u = coordinate - 0.3;
    sum += u * u + 3 * (1 - std::cos(2 * std::numbers::pi * u / 1.13));
  }
  return sum / 10;
}

/// Ackley's function, divided by 20: a narrow minimum 0 with a kink at (0.7, ..., 0.7) in a nearly flat, rippled plain.
inline double ackley(std::span<const double> x) {
  double squares = 0;
  double waves = 0;
  for (const double coordinate : x) {
    squares += (coordinate - 0.7) * (coordinate - 0.7);
    waves += std::cos(2 * std::numbers::pi * (coordinate - 0.7));
  }
  const auto n = static_cast<double>(x.size());
  return (20 + std::numbers::e - 20 * std::exp(-0.2 * std::sqrt(squares / n)) - std::exp(waves / n)) / 20;
}

/// The maximum of smooth functions, which has a chain of curved creases and the minimum 0 at (0.5, 0.25, 0.0625, ...).
inline double creases(std::span<const double> x) {
  double largest = std::abs(x[0] - 0.5);
  for (std::size_t i = 0; i + 1 < x.size(); ++i) largest = std::max(largest, 2 * std::abs(x[i + 1] - x[i] * x[i]));
  return largest;
}

/// Parallel curved valleys about 0.5 apart. The floor of each is inclined, and only one reaches 0, at (0.3, 0.3, ...).
inline double valleys(std::span<const double> x) {
  double across = x[0] - 0.3;
  double along = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = x[i] - 0.3;
    if (i > 0) across += 0.5 * u * std::sin(2 * u + static_cast<double>(i));
    along += u * u;
  }
  return 1 - std::cos(4 * std::numbers::pi * across) + along / 4;
}

/// A parallel-plate switch: an undamped oscillator pulled by V^2 / (1 - x)^2 towards a contact at x = 0.6. Time is in units of
/// the inverse angular frequency, and V^2 is scaled so that static pull-in is at 4/27. The drive is a sequence of levels of V
/// with durations, then `hold`. An impact halves the speed.
struct Landing {
  double impact_speed = 0;
  double impact_time = 0;
  double rebound = 0;    ///< largest separation after the first touch
  double missed_by = 0;  ///< least distance to the contact if it is not touched
};

inline Landing land(std::span<const double> levels, std::span<const double> durations, double hold) {
  constexpr double kContact = 0.6;
  constexpr double kEnd = 12;
  constexpr double kStep = 0.02;
  using State = std::array<double, 2>;
  const auto step = [](const State& s, double squared, double h) {
    const auto rate = [&](const State& q) {
      const double gap = std::max(1 - q[0], 0.2);
      return State{q[1], -q[0] + squared / (gap * gap)};
    };
    const auto along = [](const State& a, const State& r, double t) { return State{a[0] + t * r[0], a[1] + t * r[1]}; };
    const State k1 = rate(s);
    const State k2 = rate(along(s, k1, h / 2));
    const State k3 = rate(along(s, k2, h / 2));
    const State k4 = rate(along(s, k3, h));
    return State{s[0] + h / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0]), s[1] + h / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])};
  };
  Landing landing{.missed_by = kContact};
  State state{0, 0};
  double time = 0;
  bool touched = false;
  bool resting = false;
  for (std::size_t k = 0; k <= levels.size() && time < kEnd; ++k) {
    const double level = k < levels.size() ? levels[k] : hold;
    const double squared = level * level;
    double left = std::min(k < levels.size() ? durations[k] : kEnd, kEnd - time);
    while (left > 0) {
      const double h = std::min(kStep, left);
      const double pull = squared / ((1 - kContact) * (1 - kContact)) - kContact;
      if (resting && pull < 0) resting = false;
      if (resting) {
        time += h;
        left -= h;
        continue;
      }
      State next = step(state, squared, h);
      double taken = h;
      if (next[0] >= kContact && next[1] > 0) {
        double low = 0;
        double high = h;
        for (int i = 0; i < 50; ++i) {
          const double middle = (low + high) / 2;
          (step(state, squared, middle)[0] >= kContact ? high : low) = middle;
        }
        taken = high;
        next = step(state, squared, taken);
        if (!touched) {
          touched = true;
          landing.impact_speed = next[1];
          landing.impact_time = time + taken;
        }
        next = {kContact, -0.5 * next[1]};
        if (pull > 0 && std::abs(next[1]) < 1e-3) {
          resting = true;
          next[1] = 0;
        }
      }
      state = next;
      time += taken;
      left -= taken;
      if (touched) {
        landing.rebound = std::max(landing.rebound, kContact - state[0]);
      } else {
        landing.missed_by = std::min(landing.missed_by, kContact - state[0]);
      }
    }
  }
  if (touched) landing.missed_by = 0;
  return landing;
}

/// Returns impact energy and rebound relative to those of a step, plus a cost of slowness; 2 or more if the contact is not
/// touched.
inline double landing_cost(const Landing& landing) {
  constexpr double kStepSpeed = 0.43;  // impact velocity of a step to 0.5
  constexpr double kPatience = 4.5;
  if (landing.missed_by > 0) return 2 + landing.missed_by;
  const double speed = landing.impact_speed / kStepSpeed;
  const double late = std::max(0.0, landing.impact_time / kPatience - 1);
  return speed * speed + landing.rebound / 0.1 + late;
}

/// Landing by two levels with durations (accelerate, coast), then a fixed hold voltage.
inline double landing_4(std::span<const double> x) {
  return landing_cost(land(std::array{x[0], x[1]}, std::array{x[2], x[3]}, 0.5));
}

/// Landing by three levels with durations, then a hold voltage that varies as well.
inline double landing_7(std::span<const double> x) {
  return landing_cost(land(std::array{x[0], x[1], x[2]}, std::array{x[3], x[4], x[5]}, x[6]));
}

inline Problem landing_problem(std::size_t pulses) {
  Problem problem{.variables = {}, .objective = pulses == 2 ? landing_4 : landing_7, .starts = {}};
  for (std::size_t k = 0; k < pulses; ++k) problem.variables.push_back({.name = "level", .lower = 0, .upper = 0.75});
  for (std::size_t k = 0; k < pulses; ++k) problem.variables.push_back({.name = "duration", .lower = 0, .upper = 4});
  if (pulses == 3) problem.variables.push_back({.name = "hold", .lower = 0.4, .upper = 0.6});
  return problem;
}

inline std::vector<Landscape> all() {
  return {{"rosenbrock-4", box(4, -2, 2, rosenbrock), 1e-4}, {"rosenbrock-5", box(5, -2, 2, rosenbrock), 1e-4},
          {"rosenbrock-7", box(7, -2, 2, rosenbrock), 1e-3}, {"rastrigin-4", box(4, -4, 4, rastrigin), 1e-3},
          {"rastrigin-6", box(6, -4, 4, rastrigin), 1e-3},   {"ackley-5", box(5, -10, 10, ackley), 1e-2},
          {"creases-4", box(4, -2, 2, creases), 1e-2},       {"creases-6", box(6, -2, 2, creases), 1e-2},
          {"valleys-4", box(4, -2, 2, valleys), 1e-3},       {"valleys-6", box(6, -2, 2, valleys), 1e-3},
          {"landing-4", landing_problem(2), 1e-2},           {"landing-7", landing_problem(3), 1e-2}};
}

}  // namespace softland::landscapes
