#include "studies/search/usual_room.h"

#include <algorithm>

#include "base/require.h"

namespace softland {
namespace {

// Reduces the limits of an electrode's voltage to the default limit. Returns true if the limits were wider.
bool narrow(DriverLimits& limits, const PullInVoltages& pull_in) {
  const double usual = default_limit(pull_in);
  const DriverLimits before = limits;
  limits.max_voltage = std::min(limits.max_voltage, usual);
  limits.min_voltage = std::max(limits.min_voltage, -usual);
  return limits.max_voltage < before.max_voltage || limits.min_voltage > before.min_voltage;
}

}  // namespace

std::vector<SearchSetting> within_usual_room(const std::vector<SearchSetting>& settings, Actuator actuator,
                                             const std::vector<std::string>& names) {
  std::vector<SearchSetting> all = settings;
  for (std::size_t k = 0; k < all.size(); ++k) {
    SearchSetting& one = all[k];
    const std::map<std::string, PullInVoltages> pull_in = one.given.voltage_units();
    bool is_narrower = false;
    for (const DriveSearch& drive : settings[k].space.drives()) {
      const auto known = pull_in.find(drive.drive);
      if (known != pull_in.end() && narrow(one.limits.at(drive.drive), known->second)) is_narrower = true;
    }
    if (!is_narrower) return {};
    try {
      one.space = SearchSpace(one.within_limits(), actuator, names[k], one.scale.step.initial_contact_time);
    } catch (const InvalidInput&) {  // no settings: the hold level exceeds the default limit
      return {};
    }
  }
  return all;
}

}  // namespace softland
