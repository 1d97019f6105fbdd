// A record of one closing: the times at which a laboratory saw the contact open and closed. If it sees the capacitance instead,
// the contact counts as closed while that is above a threshold.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace softland {

/// Errors of the instruments of a laboratory, as standard deviations except `unseen`. A simulated laboratory has these errors,
/// except the last, and a belief expects them.
struct LaboratoryErrors {
  double edge_error = 50e-9;  ///< error of the time of an edge [s]
  double unseen = 100e-9;     ///< openings shorter than this are not seen [s]
  double gain_error = 0.005;  ///< error of the gain of a source, constant but unknown, relative
  double shot_error = 2e-4;   ///< scatter of the gain from shot to shot, relative
  /// Standard deviation of the time by which records begin late, constant but unknown [s]; 0: they begin with the drives. A
  /// simulated laboratory has its own delay (PracticeOptions).
  double trigger_delay = 2e-6;
  /// Threshold: records give the times at which the capacitance of the closing electrode is above it [F]; NaN: the times at
  /// which its contact is closed.
  double capacitance = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] bool sees_capacitance() const { return !std::isnan(capacitance); }
};

class SceneFile;

/// Returns the errors of usual instruments for this scene. Those of time are at most a 200th, a 100th and, for the trigger, a
/// 48th of the period of the first mode. Throws InvalidInput for a scene that cannot be read.
[[nodiscard]] LaboratoryErrors usual_errors(const SceneFile& file);

/// An edge of the contact's state.
struct ContactEdge {
  double time = 0;      ///< time since t = 0, when the drives begin [s]
  bool closed = false;  ///< the contact is closed after this edge
};

/// The record of one shot: edges, or closing time and number of bounces, or an error. A record with none of them means that the
/// contact stayed open.
struct ContactRecord {
  std::vector<ContactEdge> edges = {};      ///< edges in order of time, alternately closed and open, the first one closed
  std::optional<double> closing_time = {};  ///< time of the first touch, if there are no edges [s]
  std::optional<int> bounce_count = {};     ///< number of openings after it
  std::optional<double> loudness = {};      ///< a number above 0 that rises with the impact, in any unit
  std::string error = {};                   ///< the reason for a missing record; nothing else counts then
};

/// An opening of the contact after a touch.
struct ContactOpening {
  double begin = 0, end = 0;  ///< [s]; the end is infinite if the record ends open
};

/// The rule that a record of a shot of `duration` [s] breaks, with the key at fault; empty if it breaks none. Times must be
/// above 0, not after the end, and in order. Edges alternate from closed on, and a record has edges or a closing time, not
/// both.
[[nodiscard]] std::string record_fault(const ContactRecord& record, double duration = std::numeric_limits<double>::infinity());

/// Time of the first touch [s]; none if the contact stayed open.
[[nodiscard]] std::optional<double> first_touch(const ContactRecord& record);
/// The openings between the edges, in order.
[[nodiscard]] std::vector<ContactOpening> openings(const ContactRecord& record);
/// Number of openings, from the edges or as they were counted; none if neither is recorded.
[[nodiscard]] std::optional<int> bounce_count(const ContactRecord& record);
/// True if the contact closed, and is known to have stayed closed.
[[nodiscard]] bool is_bounce_free(const ContactRecord& record);

}  // namespace softland
