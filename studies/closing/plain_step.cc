#include "studies/closing/plain_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace softland {
namespace {

Step step_to(const PreparedScene& given, const std::string& drive, double level) {
  const auto limits = given.drives.limits.find(drive);
  const double slew = limits == given.drives.limits.end() ? std::numeric_limits<double>::infinity() : limits->second.max_slew;
  return {.level = level, .rise_time = std::abs(level - given.before(drive)) / slew};
}

Step step_of(const PreparedScene& given, const std::string& drive) {
  const auto found = given.drives.waveforms.find(drive);
  return step_to(given, drive, found == given.drives.waveforms.end() ? 0.0 : signal(found->second).hold_level());
}

}  // namespace

DriveWaveforms plain_step(const PreparedScene& prepared, Actuator actuator) {
  DriveWaveforms plain;
  if (actuator != Actuator::pzt) {
    const std::string electrode = searched_electrode(prepared.scene.device);
    plain[electrode] = step_of(prepared, electrode);
    for (const std::string& name : braking_electrodes(prepared)) plain[name] = step_to(prepared, name, 0);
  }
  if (prepared.model.has_piezo()) {
    const std::string piezo(piezo_drive);
    const std::vector<std::string> drives = prepared.drive_names();
    // A piezo that nothing else helps has to close the switch itself.
    const bool alone = std::none_of(drives.begin(), drives.end(), [&](const std::string& drive) {
      const auto& waveforms = plain.contains(drive) ? plain : prepared.drives.waveforms;
      const auto found = waveforms.find(drive);
      return drive != piezo && found != waveforms.end() && !signal(found->second).is_zero();
    });
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
