// A record of one closing says when a laboratory saw the contact open and when closed. Where it sees the capacitance instead, the
// contact counts as closed while that is above a threshold.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace softland {

/// How the instruments of a laboratory err: a simulated one has these errors, but for the last, and a belief expects them.
/// Standard deviations, but for `unseen`.
struct LaboratoryErrors {
  double edge_error = 50e-9;  ///< of the time of an edge [s]
  double unseen = 100e-9;     ///< openings shorter than this are not seen [s]
  double gain_error = 0.005;  ///< of the gain of a source, constant but unknown, relative
  double shot_error = 2e-4;   ///< of the gain from shot to shot, relative
  /// Standard deviation of the time by which records begin late, constant but unknown [s]; 0: they begin with the drives. A
  /// simulated laboratory has its own (PracticeOptions).
  double trigger_delay = 2e-6;
  /// Records tell when the capacitance of the electrode that closes the switch is above this [F]; NaN: when its contact is
  /// closed.
  double capacitance = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] bool sees_capacitance() const { return !std::isnan(capacitance); }
};

class SceneFile;

/// Returns the errors of instruments for this scene: those of time are at most a 200th, a 100th and, of the trigger, a 48th of
/// the period of the first mode. Throws InvalidInput for a scene that cannot be read.
[[nodiscard]] LaboratoryErrors usual_errors(const SceneFile& file);

/// An edge of the contact's state.
struct ContactEdge {
  double time = 0;      ///< since the drives began, at t = 0 [s]
  bool closed = false;  ///< from then on
};

/// The answer to one shot: edges, or closing time and number of bounces, or an error. One with none of them says that the contact
/// stayed open.
struct ContactRecord {
  std::vector<ContactEdge> edges = {};      ///< in order of time, by turns closed and open, the first one closed
  std::optional<double> closing_time = {};  ///< of the first touch, where there are no edges [s]
  std::optional<int> bounce_count = {};     ///< openings after it
  std::optional<double> loudness = {};      ///< a number above 0 that rises with the impact, in any unit
  std::string error = {};                   ///< why the shot gave no record; nothing else counts then
};

/// The contact is open again.
struct ContactOpening {
  double begin = 0, end = 0;  ///< [s]; the end is infinite where the record ends open
};

/// Why a record cannot be one of a shot that lasts `duration` [s], as a rule about the key at fault; empty where it can. Times
/// must be above 0, not after the end, and in order, edges alternate from closed on, and a record has edges or a closing time,
/// not both.
[[nodiscard]] std::string record_fault(const ContactRecord& record, double duration = std::numeric_limits<double>::infinity());

/// Of the first touch [s]; none where the contact stayed open.
[[nodiscard]] std::optional<double> first_touch(const ContactRecord& record);
/// The openings that edges tell of, in order.
[[nodiscard]] std::vector<ContactOpening> openings(const ContactRecord& record);
/// Openings as far as they are known: of edges, or as they were counted; none where neither says it.
[[nodiscard]] std::optional<int> bounce_count(const ContactRecord& record);
/// Whether the contact closed, and is known to have stayed closed.
[[nodiscard]] bool is_bounce_free(const ContactRecord& record);

}  // namespace softland
