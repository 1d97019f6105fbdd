// States of contacts become files that simulators of circuits and of firmware read: CSV, a value change dump, sources of SPICE.
//
// A channel is called "closed"; for one of several contacts "left_closed", for a device "device_12_closed". It is 1 while the
// contact is closed, 0 while it is open. Its resistance, where that is known, stands beside it: "resistance_ohm".
//
// CSV: a jump is two rows of one time; the resistance is linear between rows, and has no number where the contact is open.
// VCD: times are multiples of 1 ps; a resistance is a step of at most 5 %, and open_resistance where the contact is open. Each
// device is a module. There is no date: the same record has the same bytes.
// PWL: a source of 0 V and 1 V per channel has edges of 1 ns about the time of the change, or of half the shortest state beside
// them; for a resistance there is a source of a volt per ohm.
#pragma once

#include <string>

#include "studies/devices/contact_states.h"

namespace softland {

/// This resistance stands for an open contact in VCD and PWL [Ohm].
inline constexpr double open_resistance = 1e12;

/// Throws InvalidInput where the table has more than 5e7 numbers.
[[nodiscard]] std::string contact_states_csv(const StateRecord& record);
[[nodiscard]] std::string contact_states_vcd(const StateRecord& record);
[[nodiscard]] std::string contact_states_pwl(const StateRecord& record);

struct ContactStatesRequest {
  std::string format;                         ///< csv, vcd or pwl
  std::optional<std::uint64_t> devices = {};  ///< devices; not set: the scene itself
  std::optional<std::uint64_t> seed = {};
  int jobs = 1;
};
/// Returns the text of the file for a scene. A scene without [spread] whose devices are asked for gets the usual one. `note`
/// receives remarks about it, in lines. Throws InvalidRequest, Interrupted.
[[nodiscard]] std::string contact_states_text(const SceneFile& file, const ContactStatesRequest& request,
                                              const Progress& progress, const NoteSink& note);

}  // namespace softland
