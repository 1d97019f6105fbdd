// When the contact of a switch is closed and open in a run, and its resistance while closed, as a circuit or firmware observes
// the contact. The run is that of a scene, or those of devices of its [spread].
//
// Closed means electrically closed (model/closing/electrical_record.h). Without metrics.closed_force and
// metrics.closed_resistance, a contact is closed while it touches. Openings that last no longer than metrics.closed_after are
// ignored. An impact on a rigid contact has no duration, and so is not a closed state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "studies/closing/prepared.h"

namespace softland {

/// Largest resistance of a closed contact that is reported [Ohm]. A larger resistance occurs at the start and the end of a
/// contact, where the contact force is near 0.
inline constexpr double largest_resistance = 1e6;

/// A contact resistance over time, interpolated linearly between the points of this list [s, Ohm].
using ResistanceLine = std::vector<std::pair<double, double>>;

/// A time span in which a contact is closed.
struct ClosedSpan {
  double begin = 0;  ///< time at which the contact closes [s]
  /// Time at which the contact opens [s]; infinite if the contact is closed when the run ends.
  double end = std::numeric_limits<double>::infinity();
  ResistanceLine resistance = {};  ///< contact resistance from `begin` to `end`; empty if unknown
};

/// The closed states of the connection of a switch, or of one of its contacts, over a run from t = 0 on.
struct StateChannel {
  std::optional<std::size_t> device = {};  ///< number of the device in the ensemble, from 0; none for the nominal design
  std::string contact = {};                ///< name of one of several contacts; empty for the connection that the contacts make
  bool has_resistance = false;
  std::vector<ClosedSpan> spans = {};  ///< spans in which the contact is closed, in order of time
};

struct StateRecord {
  double end = 0;  ///< end of the simulated time [s]
  std::vector<StateChannel> channels;
};

/// Receives a message about a run that ended early, or about a device with impossible values.
using NoteSink = std::function<void(const std::string&)>;

/// Returns when the contacts are closed in the run that simulate() makes with error estimates. The channels are the connection
/// and, if there are several contacts, each contact. Throws InvalidInput for a switch without a contact, and Interrupted if
/// `progress` asks to stop.
[[nodiscard]] StateRecord contact_states(const PreparedScene& prepared, const Progress& progress, const NoteSink& note);

/// Returns when the contacts are closed in the closings of the first `devices` devices of the [spread] with this seed, at the
/// tolerance of the scene. The drives have the waveforms of the nominal device, and the errors of each device's own sources.
/// The result does not depend on `jobs`, the number of threads.
[[nodiscard]] StateRecord contact_states_of_devices(const PreparedScene& nominal, std::size_t devices, std::uint64_t seed,
                                                    int jobs, const Progress& progress, const NoteSink& note);

}  // namespace softland
