#include "studies/closing/plain_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace softland {
namespace {

Step step_to(const PreparedScene& given, const std::string& drive, double level) {
  const Drive& own = given.drives.at(drive);
  return step_from(own, own.value_before(), level);
}

// Returns a voltage step of a drive to its hold level, or to the level just before the command to open if the drives give such
// a command.
Step step_of(const PreparedScene& given, const std::string& drive) {
  const Drive& own = given.drives.at(drive);
  const bool opens = std::isfinite(given.held_from) && own.waveform;
  return step_to(given, drive,
                 opens ? signal(*own.waveform, own.value_before()).voltage_before(given.held_from) : own.hold_level());
}

}  // namespace

Step step_from(const Drive& drive, double from, double level) {
  const double slew = drive.limits ? drive.limits->max_slew : std::numeric_limits<double>::infinity();
  return {.level = level, .rise_time = std::abs(level - from) / slew};
}

DriveWaveforms plain_step(const PreparedScene& prepared, Actuator actuator) {
  DriveWaveforms plain;
  if (actuator != Actuator::pzt) {
    const std::string electrode = searched_electrode(prepared.scene.device);
    plain[electrode] = step_of(prepared, electrode);
    for (const std::string& name : braking_electrodes(prepared)) plain[name] = step_to(prepared, name, 0);
  }
  if (prepared.model.has_piezo()) {
    const std::string piezo(piezo_drive);
    DriveWaveforms others = plain;
    others.merge(prepared.drives.waveforms());
    others.erase(piezo);
    // If all other drives stay at 0 V, only the piezo can close the switch.
    const bool alone = std::ranges::all_of(others, [](const auto& one) { return signal(one.second).is_zero(); });
    plain[piezo] = alone ? step_of(prepared, piezo) : step_to(prepared, piezo, 0);
  }
  return plain;
}

bool same_drives(const std::vector<Signal>& a, const std::vector<Signal>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Signal& one, const Signal& other) {
    return one.before() == other.before() && one.pieces() == other.pieces();
  });
}

}  // namespace softland
