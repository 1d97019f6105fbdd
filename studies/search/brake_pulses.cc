#include "studies/search/brake_pulses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/require.h"
#include "model/constants.h"

namespace softland {
namespace {

constexpr int brake_pulses = 2;  // number of voltage pulses of every drive that brakes the opening

}  // namespace

BrakePulses::BrakePulses(const PreparedScene& given, Actuator actuator, std::vector<double> holds, std::string_view asker)
    : given_(given), period_(2 * pi / given.model.basis().angular_frequencies()[0]), holds_(std::move(holds)) {
  const Device& device = given.scene.device;
  const std::vector<std::string> names = given.drive_names();
  const bool electrodes = actuator != Actuator::pzt, piezo = actuator != Actuator::electrostatic;
  const std::string asked = std::string(asker) + " " + requested("actuator");
  require_request(!electrodes || !device.electrodes.empty(),
                  [&] { return asked + " electrostatic|both needs an electrode, and the scene has none"; });
  require_request(!piezo || device.piezo, [&] { return asked + " pzt|both needs a [piezo] section, and the scene has none"; });
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::optional<DriverLimits>& limits = given.drives[k].limits;
    plain_.push_back({{0, holds_[k]}, {limits ? std::abs(holds_[k]) / limits->max_slew : 0, 0}});
    const bool is_electrode = k < device.electrodes.size();
    if (!(is_electrode ? electrodes : piezo && names[k] == piezo_drive)) continue;
    if (is_electrode && !limits) continue;
    require_request(limits.has_value(), [&] {
      return asked + " pzt|both needs limits for the piezo: write min_voltage and max_voltage under [driver.piezo]";
    });
    add_brake(k, names[k], *limits);
  }
  require(!brakes_.empty(), [&] {
    return std::string(asker) + " needs a drive with limits: write max_voltage under [driver.NAME] of an electrode";
  });
}

void BrakePulses::add_brake(std::size_t drive, const std::string& name, const DriverLimits& limits) {
  brakes_.push_back({.drive = drive, .first = variables_.size(), .limits = limits});
  const double span = std::max(std::abs(limits.min_voltage), std::abs(limits.max_voltage));
  const double shortest = std::max(0.005 * period_, std::max(std::abs(holds_[drive]), span) / limits.max_slew);
  variables_.push_back({name + ".edge", shortest, std::max(0.1 * period_, 2 * shortest)});
  for (int k = 1; k <= brake_pulses; ++k) {
    variables_.push_back({fmt::format("{}.wait_{}", name, k), 0, period_});
    variables_.push_back({fmt::format("{}.level_{}", name, k), limits.min_voltage, limits.max_voltage});
    variables_.push_back({fmt::format("{}.duration_{}", name, k), 0.01 * period_, period_});
  }
}

std::vector<std::vector<double>> BrakePulses::starts() const {
  std::vector<std::vector<double>> all;
  for (const Brake& b : brakes_) {
    const double most = b.limits.max_voltage, least = b.limits.min_voltage;
    for (const double duration : {0.1, 0.25}) {
      for (const double level : {most, most / 2, least}) {
        if (level == 0) continue;
        for (const double wait : {0.1, 0.2, 0.3}) all.push_back(start(b, {wait, level, duration, 0.1, 0, 0.1}));
      }
      if (!(least < 0)) continue;
      for (const double first : {0.1, 0.25}) {
        all.push_back(start(b, {0, most, first, 0, least, duration}));
        all.push_back(start(b, {0, least, first, 0, most, duration}));
      }
    }
  }
  return all;
}

// Returns the point of the search at which only the drive `braking` gives its two pulses. The other drives stay at 0 V.
// `pulse_train` has wait, level [V] and duration of each pulse, with times in periods of the first mode.
std::vector<double> BrakePulses::start(const Brake& braking, const std::array<double, 6>& pulse_train) const {
  std::vector<double> x;
  for (const Brake& b : brakes_) {
    const bool brakes = b.drive == braking.drive;
    const auto& [wait, level, duration, next_wait, next_level, next_duration] = pulse_train;
    x.insert(x.end(), {variables_[b.first].lower, wait * period_, brakes ? level : 0, duration * period_, next_wait * period_,
                       brakes ? next_level : 0, next_duration * period_});
  }
  return x;
}

std::vector<Corners> BrakePulses::commanded(std::span<const double> x) const {
  std::vector<Corners> all = plain_;
  for (const Brake& brake : brakes_) all[brake.drive] = corners(brake, x);
  return all;
}

Corners BrakePulses::corners(const Brake& brake, std::span<const double> x) const {
  const double edge = x[brake.first];
  double t = edge;
  Corners all{{0, holds_[brake.drive]}, {t, 0}};
  for (std::size_t k = 0; k < brake_pulses; ++k) {
    const auto own = x.subspan(brake.first + 1 + 3 * k, 3);
    const double level = own[1];
    for (const auto& [lasts, value] : {std::pair{own[0], 0.0}, {edge, level}, {own[2], level}, {edge, 0.0}}) {
      t += lasts;
      all.emplace_back(t, value);
    }
  }
  return all;
}

}  // namespace softland
