// The actuator that closes a switch: the drives that are shaped, in the plain step and in a search.
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

/// True if an electrode pulls towards the contact: one that is not on the far side.
[[nodiscard]] bool has_pulling_electrode(const Device& device);
/// The electrode that closes the switch: `main` if it exists, else the first that pulls in. Throws InvalidInput if no electrode
/// does.
[[nodiscard]] std::string searched_electrode(const Device& device);
/// The index of that electrode among the drives.
[[nodiscard]] std::size_t searched_drive(const Device& device);
/// Electrodes on the far side whose driver has limits: a search brakes with them. The others keep the scene's waveform.
[[nodiscard]] std::vector<std::string> braking_electrodes(const PreparedScene& prepared);

}  // namespace softland
