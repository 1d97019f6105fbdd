// The results of `softland release`, which opens a closed switch without residual vibration: JSON with SI units in the names, a
// table for a terminal, the drive waveforms as CSV, and a picture.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reports/closing_record.h"
#include "reports/origin.h"
#include "studies/search/opening.h"

namespace softland {

struct ReleaseRecord {
  struct Run {
    OpeningFigures figures;
    std::string message;
    double drives_end = Metrics::unset;  ///< time from which all electrodes and piezos stay at 0 V in the opening [s]
    /// Waveforms of the opening by electrode or piezo, beginning at the hold levels: time [s] and level [V].
    std::map<std::string, Points> waveforms;
  };
  struct Gap {
    std::vector<double> time, gap;  ///< time [s], and gap of the contact [m], during an opening
  };
  /// The openings of simulated devices under process variation, and the process variation in words.
  struct Devices {
    std::uint64_t count = 0;
    bool spread_assumed = false;
    std::string spread;
    DeviceOpenings plain, best;
  };
  Origin origin;
  std::string status;
  Actuator actuator = Actuator::electrostatic;
  std::map<std::string, double> hold_levels;  ///< hold levels before the opening, by electrode or piezo [V]
  /// Contact force before opening [N]; open rest position, and largest distance from it at which the switch is at rest [m].
  double contact_force = Metrics::unset, open_position = Metrics::unset, band = Metrics::unset;
  /// Largest distance from the open rest position at which the switch is at rest, as a share of the contact gap.
  double band_share = Metrics::unset;
  Run plain;
  std::optional<Run> best;
  std::map<std::string, double> parameters;
  std::vector<ConfirmingOpening> checks;
  std::optional<Devices> devices;
  bool goal_met = false, confirmed = false;
  long evaluations = 0;
  std::uint64_t seed = 1;
  std::string termination;
  std::vector<std::string> warnings;  ///< warnings of the scene, and about a contact force that few asperities carry
  std::map<std::string, Gap> gaps;    ///< gap over time in each opening, "plain" or "best"; --json leaves it out
};
[[nodiscard]] ReleaseRecord record_of(const OpeningResult& release, const std::string& command);

/// Names the members of the JSON.
void members(internal::Archive& a, ReleaseRecord& record);
[[nodiscard]] nlohmann::json json_of(const ReleaseRecord& record);
[[nodiscard]] ReleaseRecord read_release(const nlohmann::json& from);
[[nodiscard]] std::string text_of(const ReleaseRecord& record);
/// Draws the gap over time in the plain opening (all electrodes and piezos drop to 0 V at once) and in the best opening, and
/// the drive waveforms; ReleaseRecord::gaps must not be empty.
[[nodiscard]] std::string svg_of(const ReleaseRecord& record);
/// Returns the drive waveforms of the best opening, or else of the plain opening, as CSV that begins at the hold levels. A
/// header `time_s,<drive>,...` is followed by rows [s, V] with straight lines between them; rows of the same time are a jump.
[[nodiscard]] std::string release_csv(const OpeningResult& release);

}  // namespace softland
