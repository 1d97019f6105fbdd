// The results of `softland limit`, the least closing time of any waveform: JSON with SI units in the names, a table for a
// terminal, a log of the searches, and a picture.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reports/closing_record.h"
#include "reports/origin.h"
#include "studies/search/limit.h"

namespace softland {

struct LimitRecord {
  struct QuasiStatic {
    std::string drive;
    /// The quasi-static approach to the contact: width of the range of positions at which 90 % of the varied devices touch [m];
    /// time from which the contact force under the plain step is steady [s]; impact velocity [m/s].
    double touch_places = Metrics::unset, steady = Metrics::unset, speed = Metrics::unset;
  };
  struct Check {
    std::string name;
    Metrics metrics;
  };
  struct Landing {
    LeastTime path;
    bool at_rest = false;
    /// The pulse that keeps the switch closed after a touch: times from the first contact to the begin of the pulse, and to its
    /// end, when the drives go to their hold levels [s].
    double catch_delay = Metrics::unset, catch_time = Metrics::unset;
    bool bounce_free = false;
    Metrics metrics;
    std::vector<Check> checks;  ///< confirmations of the closing by a tighter integrator and by a beam with more modes
    nlohmann::json scene;
  };
  Origin origin;
  std::string status;
  Actuator actuator = Actuator::electrostatic;
  double impact_velocity = Metrics::unset;  ///< largest permitted impact velocity [m/s]
  int modes = 0;
  bool has_start = false;  ///< true when the user gave a waveform from which the search for the least time starts
  Metrics step;
  LeastTime touch, rest;
  std::optional<QuasiStatic> quasi_static;
  ClosedState closed_state;
  std::string hold_warning;  ///< warning that the hold levels do not keep the switch closed; may be empty
  /// Warnings of the scene, of its hold levels, and of few summits (asperities) that carry the contact force.
  std::vector<std::string> warnings;
  std::optional<Landing> landing;
  std::vector<LeastTime> over_velocity, over_peak;
  std::vector<LimitAttempt> attempts;   ///< all searches for least times, in the order of the work
  std::optional<ClosingRecord> landed;  ///< simulated run of the closing with the least time; --json leaves it out
};
[[nodiscard]] LimitRecord record_of(const Limit& limit, const std::string& command);

/// Names the members of the JSON.
void members(internal::Archive& a, LimitRecord& record);
[[nodiscard]] nlohmann::json json_of(const LimitRecord& record);
[[nodiscard]] LimitRecord read_limit(const nlohmann::json& from);
[[nodiscard]] std::string text_of(const LimitRecord& record);
/// Returns the log of the searches for least times, a row per attempt.
[[nodiscard]] std::string attempts_csv(const LimitRecord& record);
/// Draws gap and waveforms of the closing with the least time, and the least time against peak voltage and against permitted
/// impact velocity, as far as they were computed.
[[nodiscard]] std::string svg_of(const LimitRecord& record);

}  // namespace softland
