#include "studies/devices/hold_window.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "base/executor.h"

namespace softland {
namespace {

bool is_held(const ClosedRange& device, double level) { return device.release <= level && !(device.pulled_through < level); }

// Starting point of the search for the collapse voltage of a device: the nominal device at a level below its own collapse
// voltage.
struct Nominal {
  double level = std::numeric_limits<double>::quiet_NaN();  // level of the electrode [V]
  std::optional<ClosedEquilibrium> closed;                  // closed equilibrium of the nominal device at `level`
};

Nominal nominal_of(const Switch& model, std::size_t electrode, std::vector<double> volts) {
  constexpr double below = 0.9;
  const ClosedRange range = closed_range(model, electrode, volts);
  if (!std::isfinite(range.pulled_through)) return {};
  Nominal nominal{.level = std::max(below * range.pulled_through, range.release)};
  volts[electrode] = nominal.level;
  nominal.closed = closed_equilibrium(model, volts);
  return nominal;
}

ClosedRange range_of_device(const Switch& model, std::size_t electrode, std::vector<double> volts, const Nominal& nominal) {
  // Relative precision of release and collapse voltages, which suffices for the digits of reports.
  constexpr double precision = 1e-4;
  ClosedRange range{.release = release_voltage(model, electrode, volts)};
  if (!std::isfinite(range.release)) return range;
  volts[electrode] = nominal.closed ? std::max(nominal.level, range.release) : range.release;
  range.pulled_through = nominal.closed ? pull_through_voltage_near(model, electrode, volts, *nominal.closed, precision)
                                        : pull_through_voltage(model, electrode, volts, precision);
  return range;
}

}  // namespace

HoldWindow hold_window(std::span<const ClosedRange> devices) {
  const double most_lost = (1 - held_share) * static_cast<double>(devices.size()) * (1 + 1e-9);
  const auto holds = [&](double level) {
    const auto lost = std::ranges::count_if(devices, [&](const ClosedRange& one) { return !is_held(one, level); });
    return static_cast<double>(lost) <= most_lost;
  };
  // The share of devices that stay closed changes only at release and collapse voltages. Hence the window begins at the release
  // voltage of one device, and ends at the collapse voltage of another.
  HoldWindow window;
  double beyond_all = 0;
  for (const ClosedRange& one : devices) {
    if (std::isfinite(one.release) && !(one.release >= window.lower) && holds(one.release)) window.lower = one.release;
    if (std::isfinite(one.pulled_through) && !(one.pulled_through <= window.upper) && holds(one.pulled_through))
      window.upper = one.pulled_through;
    beyond_all = std::fmax(beyond_all, 1 + 2 * std::fmax(one.release, one.pulled_through));
  }
  if (std::isfinite(window.lower) && holds(beyond_all)) window.upper = std::numeric_limits<double>::infinity();
  return window;
}

HoldWindows hold_windows(const PreparedScene& nominal, const RobustnessOptions& options, const Progress& progress) {
  constexpr std::size_t together = 8;  // number of devices whose hold windows one task computes
  HoldWindows found;
  const std::vector<Electrode>& electrodes = nominal.scene.device.electrodes;
  if (!nominal.model.has_contact()) return found;
  const std::size_t count = std::min(options.samples, most_held_devices);
  const Ensemble ensemble(nominal, options.samples, options.seed, options.points);
  std::atomic<std::size_t> done = 0;
  std::mutex telling;
  for (std::size_t k = 0; k < electrodes.size(); ++k) {
    if (!pulls_in(nominal.scene.device, k)) continue;
    const std::vector<double> bias = bias_of(nominal.scene, k);
    const Nominal near = nominal_of(nominal.model, k, bias);
    std::vector<ClosedRange> ranges(count);
    const auto task = [&](std::size_t chunk) {
      DeviceBuilder builder(ensemble);
      for (std::size_t i = chunk * together; i < std::min(count, (chunk + 1) * together) && !progress.stopped(); ++i) {
        const SampledDevice device = builder.device(i);
        if (device.model) ranges[i] = range_of_device(*device.model, k, bias, near);
        const std::scoped_lock lock(telling);
        progress.tell("window of hold levels", static_cast<double>(++done) / static_cast<double>(count * electrodes.size()));
      }
    };
    run_tasks((count + together - 1) / together, options.jobs, task, progress.stop);
    if (progress.stopped()) return {};
    found.of_electrodes[electrodes[k].name] = hold_window(ranges);
    found.devices = count;
  }
  return found;
}

}  // namespace softland
