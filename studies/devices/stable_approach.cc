#include "studies/devices/stable_approach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/executor.h"
#include "model/constants.h"
#include "model/pull_in.h"
#include "studies/devices/ensemble.h"

namespace softland {
namespace {

// Levels before contact that the search tries, in this order, for the electrode that holds the closed switch, as shares of its
// hold level.
constexpr std::array low_levels{0.0, 0.12, 0.24, 0.36};
// The search for a stable approach ends if the voltage at which the switch touches its contact is this far from the limit of
// the voltage source [standard deviations of the voltage over devices].
constexpr double enough_deviations = 2.5;
// Coordinates of the unit cube that are one standard deviation of a normal number below and above the median.
constexpr double one_below = 0.15865525393145707, one_above = 1 - one_below;

// Returns the commanded voltage at which the contact point of a device reaches the contact plane.
std::optional<double> touching_voltage(const PreparedScene& nominal, const SampledDevice& device,
                                       const StableApproach& approach) {
  if (!device.model) return std::nullopt;
  std::vector<double> bias = hold_levels(nominal.signals());
  if (!approach.holder.empty()) bias[nominal.drives.place(approach.holder)] = approach.low;
  const std::optional<StablePath> path = stable_path(*device.model, nominal.drives.place(approach.drive), bias);
  if (!path) return std::nullopt;
  SourceErrors errors = nominal.drives.at(approach.drive).errors;
  for (std::size_t i = 0; i < device.values.size(); ++i) {
    const SpreadVariable& variable = nominal.scene.spread.variables[i];
    for (const VariedKey& key : variable.keys) {
      if (!key.drive || key.drive->name != approach.drive) continue;
      if (key.drive->error == DriveError::gain) errors.gain = DeviceSpread::value(variable, key, device.values[i]);
      if (key.drive->error == DriveError::offset) errors.offset = DeviceSpread::value(variable, key, device.values[i]);
    }
  }
  return (path->reaches() - errors.offset) / errors.gain;
}

bool is_within(double voltage, double limit) { return limit < 0 ? voltage >= limit : voltage <= limit; }

class Finder {
 public:
  explicit Finder(const PreparedScene& nominal) : nominal_(nominal) {
    if (!nominal.scene.spread.empty()) ensemble_.emplace(nominal, 1);
  }

  // Returns the stable approach to the contact by this drive; none if the nominal design has no stable path to contact within
  // the limits of the voltage source.
  [[nodiscard]] std::optional<StableApproach> along(const std::string& drive, const std::string& holder, double low) const {
    const Drive& carries = nominal_.drives.at(drive);
    if (!carries.limits) return std::nullopt;
    StableApproach found{.drive = drive, .holder = holder, .low = low};
    std::vector<double> bias = hold_levels(nominal_.signals());
    if (!holder.empty()) bias[nominal_.drives.place(holder)] = low;
    const std::optional<StablePath> path = stable_path(nominal_.model, nominal_.drives.place(drive), bias);
    if (!path) return std::nullopt;
    found.reaches = (path->reaches() - carries.errors.offset) / carries.errors.gain;
    found.slope = path->slope() * carries.errors.gain;
    found.limit = found.reaches < 0 ? carries.limits->min_voltage : carries.limits->max_voltage;
    if (!is_within(found.reaches, found.limit)) return std::nullopt;
    found.deviation = deviation(found);
    return found;
  }

 private:
  // Returns the standard deviation over devices of the voltage at which the switch touches its contact, by differences over one
  // standard deviation of each varied quantity.
  [[nodiscard]] double deviation(const StableApproach& found) const {
    if (!ensemble_) return 0;
    const DeviceSpread& spread = nominal_.scene.spread;
    DeviceBuilder builder(*ensemble_);
    double sum = 0;
    for (std::size_t i = 0; i < spread.variables.size(); ++i) {
      const auto at = [&](double coordinate) {
        std::vector<double> u(spread.variables.size(), 0.5);
        u[i] = coordinate;
        spread.to_values(u);
        return touching_voltage(nominal_, builder.device(std::move(u)), found);
      };
      const std::optional<double> above = at(one_above), below = at(one_below);
      // If one of the two devices has no stable path to contact, use the difference between the other device and the nominal
      // design. If neither has a path, use the distance to the limit of the voltage source.
      const double slope = above && below ? (*above - *below) / 2
                           : above        ? *above - found.reaches
                           : below        ? found.reaches - *below
                                          : found.limit - found.reaches;
      sum += slope * slope;
    }
    return std::sqrt(sum);
  }

  const PreparedScene& nominal_;
  std::optional<Ensemble> ensemble_;
};

// Returns the distance from the voltage at which the switch touches its contact to the limit of the voltage source, in standard
// deviations of that voltage over devices.
double room(const StableApproach& found) { return std::abs(found.limit - found.reaches) / std::max(found.deviation, 1e-300); }

}  // namespace

double StableApproach::touch_places() const {
  // Number of standard deviations of a normal distribution between its 5th and 95th percentile.
  constexpr double of_a_normal = 2 * 1.6448536269514722;
  return of_a_normal * deviation * std::abs(slope);
}

double shortest_rise(const PreparedScene& nominal) {
  // Duration of the shortest rise in periods of the first mode: the sum of two ramps of one period each (the two impulses of
  // the input shaper), the second of which starts half a period later.
  constexpr double periods = 1.5;
  return periods * 2 * pi / nominal.model.basis().angular_frequencies()[0];
}

double quasi_static_speed(const StableApproach& approach, const PreparedScene& nominal, double steady) {
  const double left = steady - shortest_rise(nominal);
  return left > 0 ? approach.touch_places() / left : std::numeric_limits<double>::infinity();
}

std::optional<StableApproach> stable_approach(const PreparedScene& nominal, Actuator actuator) {
  if (!nominal.model.has_contact() || !nominal.rest()) return std::nullopt;
  const Device& device = nominal.scene.device;
  const Finder finder(nominal);
  const std::string electrode = has_pulling_electrode(device) ? searched_electrode(device) : std::string();
  const double hold = electrode.empty() ? 0 : nominal.drives.at(electrode).hold_level();
  std::optional<StableApproach> best;
  const auto consider = [&](std::optional<StableApproach> found) {
    if (found && (!best || room(*found) > room(*best))) best = std::move(found);
    return best && room(*best) >= enough_deviations;
  };
  if (actuator != Actuator::electrostatic && nominal.model.has_piezo()) {
    const std::string piezo(piezo_drive);
    if (hold == 0) {
      (void)consider(finder.along(piezo, {}, 0));
    } else {
      for (const double share : low_levels) {
        if (consider(finder.along(piezo, electrode, share * hold)) || actuator == Actuator::pzt) break;
      }
    }
  }
  const bool is_enough = best && room(*best) >= enough_deviations;
  if (actuator != Actuator::pzt && !is_enough && hold != 0) (void)consider(finder.along(electrode, {}, 0));
  return best;
}

double touching_voltage(const PreparedScene& nominal, const StableApproach& approach, double low) {
  StableApproach at = approach;
  at.low = low;
  const std::optional<double> voltage = touching_voltage(nominal, {.values = {}, .model = nominal.model, .refusal = {}}, at);
  return voltage.value_or(std::numeric_limits<double>::quiet_NaN());
}

double share_with_path(const PreparedScene& nominal, const StableApproach& approach, std::uint64_t devices, std::uint64_t seed,
                       int jobs, const Progress& progress) {
  constexpr std::size_t together = 16;  // number of devices that one task examines
  const Ensemble ensemble(nominal, devices, seed);
  std::vector<char> has(devices, 0);
  run_tasks((devices + together - 1) / together, jobs,
            [&](std::size_t task) {
              DeviceBuilder builder(ensemble);
              for (std::size_t k = task * together; k < std::min<std::size_t>(devices, (task + 1) * together); ++k) {
                if (progress.stopped()) return;
                const std::optional<double> voltage = touching_voltage(nominal, builder.device(k), approach);
                has[k] = voltage && is_within(*voltage, approach.limit) ? 1 : 0;
              }
            },
            progress.stop);
  progress.throw_if_stopped();
  return static_cast<double>(std::ranges::count(has, 1)) / static_cast<double>(devices);
}

}  // namespace softland
