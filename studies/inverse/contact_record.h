// A record of one closing: the times at which a laboratory measured that the contact opens and closes. If the laboratory
// records the capacitance instead, the contact counts as closed while the capacitance is above a threshold.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace softland {

/// Errors of the instruments of a laboratory. All but `unseen` and `capacitance` are standard deviations. A simulated
/// laboratory has these errors, except `trigger_delay`, and the estimate of a device from its records assumes these errors.
struct LaboratoryErrors {
  double edge_error = 50e-9;  ///< error of a recorded time at which the contact closes or opens [s]
  double unseen = 100e-9;     ///< openings of the contact that are shorter than this time are not recorded [s]
  double gain_error = 0.005;  ///< relative error of the gain of a voltage source: constant but unknown
  double shot_error = 2e-4;   ///< relative scatter of a voltage source's gain from one closing to the next
  /// Standard deviation of the delay between drives and record, which is constant but unknown [s]; 0 if records begin with the
  /// drives. A simulated laboratory has PracticeOptions::trigger_delay instead.
  double trigger_delay = 2e-6;
  /// Threshold of the capacitance of the closing electrode [F]. Records contain the times at which the capacitance is above
  /// this threshold; if NaN, the times at which the contact is closed.
  double capacitance = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] bool sees_capacitance() const { return !std::isnan(capacitance); }
};

class SceneFile;

/// Returns the errors of typical instruments for this scene. The error of edges, the shortest recorded opening and the trigger
/// delay are at most a 200th, a 100th and a 48th of the period of the first mode. Throws InvalidInput for a scene that cannot
/// be read.
[[nodiscard]] LaboratoryErrors usual_errors(const SceneFile& file);

/// A change of the contact's state, from open to closed or back.
struct ContactEdge {
  double time = 0;      ///< time since t = 0, when the drive waveforms begin [s]
  bool closed = false;  ///< true if the contact is closed after this change
};

/// The record of one shot (closing): edges, which are the times at which the contact closes and opens, or closing time and
/// number of openings, or an error. A record in which no member is set means that the contact stayed open.
struct ContactRecord {
  std::vector<ContactEdge> edges = {};      ///< changes of the contact's state in order of time; the first one closes the contact
  std::optional<double> closing_time = {};  ///< time of first contact [s], if the record has no `edges`
  std::optional<int> bounce_count = {};     ///< number of openings of the contact after its first contact
  std::optional<double> loudness = {};      ///< loudness of the impact at the contact in any unit, above 0
  std::string error = {};                   ///< reason why the record is missing; all other members are then ignored
};

/// A time span after the first contact in which the contact is open.
struct ContactOpening {
  /// Begin and end of the opening [s]; the end is infinite if the contact is open at the end of the record.
  double begin = 0, end = 0;
};

/// Returns the rule that the record of a shot of `duration` [s] violates, with the invalid key; empty if the record is valid.
/// Times must be above 0, within the record, and in order. Edges must alternate, with a closed contact after the first edge. A
/// record must not have both edges and a closing time.
[[nodiscard]] std::string record_fault(const ContactRecord& record, double duration = std::numeric_limits<double>::infinity());

/// Returns the time of first contact [s]; none if the contact stayed open.
[[nodiscard]] std::optional<double> first_touch(const ContactRecord& record);
/// Returns the time spans in which the contact of a record is open after first contact, in order.
[[nodiscard]] std::vector<ContactOpening> openings(const ContactRecord& record);
/// Returns the number of openings of the contact, from `edges` or from `bounce_count`; none if the record has neither.
[[nodiscard]] std::optional<int> bounce_count(const ContactRecord& record);
/// True if the contact closed and the record shows that it stayed closed.
[[nodiscard]] bool is_bounce_free(const ContactRecord& record);

}  // namespace softland
