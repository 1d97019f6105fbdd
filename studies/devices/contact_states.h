// When the contact of a switch is closed and open along a run, and its resistance while it is closed, as a circuit or a
// firmware sees it: of the run of a scene, and of devices of its [spread].
//
// Closed is electrically closed (model/closing/electrical_record.h): in touch where the scene has neither metrics.closed_force
// nor metrics.closed_resistance. An opening that is not longer than metrics.closed_after is none. An impact on a rigid contact,
// which lasts for no time, is no closed state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/watch.h"
#include "studies/closing/prepared.h"

namespace softland {

/// Above this the resistance of a closed contact is not told: it is at the edge of a touch, where nothing presses yet [Ohm].
inline constexpr double largest_resistance = 1e6;

/// Resistances at times, on straight lines between them [s, Ohm].
using ResistanceLine = std::vector<std::pair<double, double>>;

/// A time in which a contact is closed.
struct ClosedSpan {
  double begin = 0;                                      ///< [s]
  double end = std::numeric_limits<double>::infinity();  ///< [s]; infinite where it is closed when the run ends
  ResistanceLine resistance = {};                        ///< from `begin` to the end; empty where it is not known
};

/// The connection of a switch, or one of its contacts, over a run from t = 0 on.
struct StateChannel {
  std::optional<std::size_t> device = {};  ///< its number in the ensemble, from 0; none: the scene itself
  std::string contact = {};                ///< the name of one of several contacts; empty: the connection
  bool has_resistance = false;
  std::vector<ClosedSpan> spans = {};  ///< increase in time
};

struct StateRecord {
  double end = 0;  ///< the end of the window [s]
  std::vector<StateChannel> channels;
};

/// Takes a line about a run that did not come to its end, or a device that cannot be described.
using SayLine = std::function<void(const std::string&)>;

/// The run of simulate() with errors: its channels are the connection and, of several contacts, each. Throws InvalidInput for a
/// switch without a contact, Interrupted where `watch` asks to stop.
[[nodiscard]] StateRecord contact_states(const PreparedScene& prepared, const Watch& watch, const SayLine& say);

/// The same for the first `devices` devices of the spread with this seed, at the tolerance of the scene. The waveforms of the
/// nominal device drive them, with the errors of their own sources. `jobs`: threads, on which nothing depends.
[[nodiscard]] StateRecord contact_states_of_devices(const PreparedScene& nominal, std::size_t devices, std::uint64_t seed,
                                                    int jobs, const Watch& watch, const SayLine& say);

}  // namespace softland
