#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "model/equilibrium_branch.h"
#include "model/pull_in.h"

namespace softland {

using namespace statics;

namespace {

// Factor between two voltages of the search for the collapse voltage, pull_through_voltage(), and largest factor between its
// first and its last voltage. The functions in this namespace count the voltage of the drive from its neutral voltage V0.
constexpr double pull_through_factor = 1.05, pull_through_range = 10;

// Returns the collapse voltage, found upwards or downwards from `start`, with an independent search for the closed equilibrium
// at each voltage. Returns NaN if the collapse is out of range.
double pull_through_by_walk(const Switch& model, std::size_t drive, std::vector<double> levels, double start, double precision) {
  const auto holds = [&](double v) {
    levels[drive] = model.neutral_voltage(drive) + v;
    return keeps_closed(model, closed_equilibrium(model, levels));
  };
  double low = start, high = start;
  if (holds(start)) {
    do {
      low = high;
      high *= pull_through_factor;
      if (high > pull_through_range * start) return no_equilibrium;
    } while (holds(high));
  } else {
    do {
      high = low;
      low /= pull_through_factor;
      if (low < start / pull_through_range) return no_equilibrium;
    } while (!holds(low));
  }
  while (high - low > precision * high) {
    const double middle = low + (high - low) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return high;
}

// Returns the end of a window of voltages with closed equilibria that begins at the release voltage and is narrower than one
// step of pull_through_by_walk(). The steps double, from 1e-5 of the release voltage on. Returns NaN when no closed equilibrium
// is found so near the release voltage.
double pull_through_of_narrow_window(const Switch& model, std::size_t drive, std::vector<double> levels, double release,
                                     double precision) {
  constexpr double first_step = 1e-5;
  const auto holds = [&](double v) {
    levels[drive] = model.neutral_voltage(drive) + v;
    return keeps_closed(model, closed_equilibrium(model, levels));
  };
  double low = no_equilibrium;
  for (double step = first_step; step < pull_through_factor - 1; step *= 2) {
    const double v = release * (1 + step);
    if (holds(v)) {
      low = v;
    } else if (low > 0) {
      break;
    }
  }
  if (!(low > 0)) return no_equilibrium;
  double high = std::min(2 * low - release, pull_through_factor * release);
  if (holds(high)) return pull_through_by_walk(model, drive, std::move(levels), high, precision);
  while (high - low > precision * high) {
    const double middle = low + (high - low) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return high;
}

// Searches the collapse voltage upwards from `start` by Newton's method; `near` is a closed equilibrium at `start` or a similar
// voltage. Returns none when the method does not converge.
std::optional<double> pull_through_from(const Switch& model, std::size_t drive, std::vector<double> levels, double start,
                                        const ClosedEquilibrium& near, double precision) {
  std::optional<ClosedEquilibrium> last = near;
  const auto follows = [&](double v) {
    levels[drive] = model.neutral_voltage(drive) + v;
    std::optional<ClosedEquilibrium> next = closed_by_newton(model, levels, *last);
    const bool found = next.has_value();
    if (found) last = std::move(next);
    return found;
  };
  double low = start, high = start;
  if (!follows(start)) return std::nullopt;
  do {
    low = high;
    high *= pull_through_factor;
    if (high > pull_through_range * start) return no_equilibrium;
  } while (follows(high));
  while (high - low > precision * high) {
    const double middle = low + (high - low) / 2;
    (follows(middle) ? low : high) = middle;
  }
  // Check the collapse voltage with a full search: Newton's method may have failed although a closed equilibrium exists.
  levels[drive] = model.neutral_voltage(drive) + high;
  return keeps_closed(model, closed_equilibrium(model, levels)) ? std::nullopt : std::optional(high);
}

double acting_pull_through(const Switch& model, std::size_t drive, std::span<const double> volts, double precision) {
  const double neutral = model.neutral_voltage(drive);
  // The search must not begin below the release voltage, where no closed equilibrium exists.
  const double release = release_voltage(model, drive, volts) - neutral, given = std::abs(volts[drive] - neutral);
  const double start = std::fmax(given, pull_through_factor * release);
  if (!(start > 0)) return no_equilibrium;
  std::vector<double> levels(volts.begin(), volts.end());
  levels[drive] = neutral + start;
  const auto closed = closed_equilibrium(model, levels);
  const auto found =
      keeps_closed(model, closed) ? pull_through_from(model, drive, levels, start, *closed, precision) : std::nullopt;
  if (found) return *found;
  const bool is_above = start > given;  // true when the search begins above the given voltage, near the release voltage
  if (is_above && !keeps_closed(model, closed)) {
    const double narrow = pull_through_of_narrow_window(model, drive, levels, release, precision);
    if (std::isfinite(narrow)) return narrow;
  }
  const double walked = pull_through_by_walk(model, drive, levels, start, precision);
  if (std::isfinite(walked) || is_above || !(release > start / pull_through_range)) return walked;
  return pull_through_of_narrow_window(model, drive, std::move(levels), release, precision);
}

// Returns true when the beam closes on a rigid dielectric face (wall) of this drive's electrode. The beam then cannot move
// below the face, and the switch has no collapse voltage.
bool lands_on_wall(const Switch& model, std::size_t drive) {
  const Device& device = model.device();
  if (drive >= device.electrodes.size() || !device.electrodes[drive].dielectric || device.face_contact() != 0) return false;
  return device.landing()->is_wall();
}

}  // namespace

double pull_through_voltage(const Switch& model, std::size_t drive, std::span<const double> volts, double precision) {
  if (lands_on_wall(model, drive)) return no_equilibrium;
  return model.neutral_voltage(drive) + acting_pull_through(model, drive, volts, precision);
}

double pull_through_voltage_near(const Switch& model, std::size_t drive, std::span<const double> volts,
                                 const ClosedEquilibrium& near, double precision) {
  if (lands_on_wall(model, drive)) return no_equilibrium;
  const double neutral = model.neutral_voltage(drive);
  const double given = std::abs(volts[drive] - neutral);
  // The search multiplies its first voltage by factors, so it cannot begin at 0.
  if (given == 0) return pull_through_voltage(model, drive, volts, precision);
  const auto found = pull_through_from(model, drive, {volts.begin(), volts.end()}, given, near, precision);
  return found ? neutral + *found : pull_through_voltage(model, drive, volts, precision);
}

}  // namespace softland
