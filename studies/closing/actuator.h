// The actuator that closes a switch: the drives (electrodes, piezo) whose waveforms a search replaces. The plain step, with
// which found waveforms are compared, replaces the waveforms of the same drives.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/choice.h"
#include "studies/closing/prepared.h"

namespace softland {

enum class Actuator { electrostatic, pzt, both };
inline constexpr auto actuators = std::to_array<Named<Actuator>>(
    {{Actuator::electrostatic, "electrostatic"}, {Actuator::pzt, "pzt"}, {Actuator::both, "both"}});
static_assert(is_complete<actuators>());

/// True if the device has an electrode that pulls towards the contact, that is, an electrode on the near side.
[[nodiscard]] bool has_pulling_electrode(const Device& device);
/// Returns the electrode that closes the switch: `main` if it exists, else the first electrode that pulls towards the contact.
/// Throws InvalidInput if no electrode pulls towards the contact.
[[nodiscard]] std::string searched_electrode(const Device& device);
/// Returns the index of searched_electrode() in Switch::drives().
[[nodiscard]] std::size_t searched_drive(const Device& device);
/// Returns the electrodes on the far side (away from the contact) whose voltage source has limits: a search uses these
/// electrodes as brakes. Other electrodes on the far side keep the scene's waveform.
[[nodiscard]] std::vector<std::string> braking_electrodes(const PreparedScene& prepared);

}  // namespace softland
