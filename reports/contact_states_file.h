// Writes the states of contacts for simulators of circuits and firmware: CSV, value change dump (VCD), or sources of SPICE
// (PWL).
//
// The state of a contact is a channel named "closed"; "left_closed" for one of several contacts, "device_12_closed" for a
// device. The channel is 1 while the contact is closed, 0 while it is open. The resistance of the contact, if known, is the
// channel "resistance_ohm".
//
// CSV: two rows of the same time are a jump. The resistance is linear between rows, and empty while the contact is open.
// VCD: times are multiples of 1 ps. The resistance has steps of at most 5 %, and is open_resistance while the contact is open.
// Each device is a module. There is no date: equal contact states give equal bytes.
// PWL: each channel is a source of 0 V and 1 V. An edge takes 1 ns, or half of its shorter neighbouring state if that is less.
// The resistance is a source of one volt per ohm.
#pragma once

#include <string>

#include "studies/devices/contact_states.h"

namespace softland {

/// Resistance that stands for an open contact in VCD and PWL [Ohm].
inline constexpr double open_resistance = 1e12;

/// Returns the contact states over time as CSV. Throws InvalidInput if the table has more than 5e7 numbers.
[[nodiscard]] std::string contact_states_csv(const StateRecord& record);
[[nodiscard]] std::string contact_states_vcd(const StateRecord& record);
[[nodiscard]] std::string contact_states_pwl(const StateRecord& record);

struct ContactStatesRequest {
  std::string format;                         ///< format of the file: csv, vcd or pwl
  std::optional<std::uint64_t> devices = {};  ///< number of simulated devices; not set: the nominal design
  std::optional<std::uint64_t> seed = {};
  int jobs = 1;
};
/// Returns the text of the file with the contact states of a scene. If devices are requested of a scene without [spread], the
/// usual process variation is assumed. `note` receives remarks on the file, in lines. Throws InvalidRequest and Interrupted.
[[nodiscard]] std::string contact_states_text(const SceneFile& file, const ContactStatesRequest& request,
                                              const Progress& progress, const NoteSink& note);

}  // namespace softland
