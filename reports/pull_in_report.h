// The findings of `softland pull-in`: JSON with SI units in the names, words, the points of a sweep as CSV, and a picture of
// them. `check` has the voltages of an electrode and the stable path as well.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "reports/origin.h"
#include "studies/closing/by_modes.h"
#include "studies/closing/prepared.h"
#include "studies/closing/sweep.h"

namespace softland {

inline constexpr const char* no_open_state = "no pull-in voltage: the switch has no open state";

/// The voltages of an electrode under the bias of the other drives (bias_of()) [V].
struct PullInRecord {
  double static_pull_in = Metrics::unset, dynamic_pull_in = Metrics::unset, release = Metrics::unset,
         pulled_through = Metrics::unset;
  std::string static_kind;                  ///< name by to_string(StaticKind); empty where there is no voltage
  double deflection = Metrics::unset;       ///< deflection of the contact point at static pull-in [m]
  double neutral = Metrics::unset;          ///< Switch::neutral_voltage() of a charged dielectric; unset without charge [V]
  std::string dynamic_kind;                 ///< "overshoot", "overdamped", "unstable_rest"; empty where there is no voltage
  std::optional<VoltagesByModes> by_modes;  ///< none where there are no more modes, or the search was interrupted
};
struct ElectrodeRecord {
  Status status = Status::not_run;
  PullInRecord volts;
  std::map<std::string, double> bias;         ///< levels of the other drives that are not at 0 [V]
  std::map<std::string, double> bias_factor;  ///< factor of the dispersion force, where it is not 1
};
[[nodiscard]] ElectrodeRecord record_of(const PreparedScene& prepared, std::size_t k, const ElectrodePullIn& known);

/// Returns "22.469 V" or "none".
[[nodiscard]] std::string volts(double value);
/// Returns "piezo -1.5 V": the other drives that are not at 0; empty where all are.
[[nodiscard]] std::string bias_prose(const ElectrodeRecord& electrode);
/// Returns the dynamic pull-in voltage in words. A step without overshoot, because of damping, needs no less than the static
/// one; nor does one that leaves the switch where it rests.
[[nodiscard]] std::string dynamic_prose(const PullInRecord& found);

/// Tells whether the charge keeps the switch closed at 0 V once it is.
[[nodiscard]] bool sticks_by_charge(const PullInRecord& found);
/// Says how the charge on the dielectric shifts both polarities; empty without charge.
[[nodiscard]] std::string charge_prose(const PullInRecord& found);

/// The path of a drive that alone carries the switch to its contact through stable equilibria.
struct StablePathRecord {
  std::string drive;
  double reaches = Metrics::unset, limit = Metrics::unset;  ///< first touch of the nominal design; limit of the driver [V]
  std::optional<double> share;                              ///< share of the devices of [spread]
};
/// Returns none where no drive does, or there is no contact.
[[nodiscard]] std::optional<StablePathRecord> stable_path_of(const PreparedScene& prepared, const Progress& progress);
/// Returns "the piezo alone reaches the contact at -0.9483 V through stable equilibria; 96.5 % of devices do within -1 V".
[[nodiscard]] std::string words_of(const std::optional<StablePathRecord>& path);

struct PullInsRecord {
  Origin origin;
  std::string status;
  std::map<std::string, ElectrodeRecord> electrodes;
  std::optional<StablePathRecord> stable_path;
  std::string swept;                  ///< the electrode whose voltage was swept; empty where none was
  std::vector<SweepPoint> sweep;      ///< points of the sweep
  std::vector<std::string> left_out;  ///< not found because the verb was asked to stop
};
/// This name goes into left_out when the verb was asked to stop before the path was known.
inline constexpr const char* stable_path_left_out = "the stable path";

[[nodiscard]] nlohmann::json json_of(const PullInsRecord& record);
[[nodiscard]] PullInsRecord read_pull_ins(const nlohmann::json& from);
[[nodiscard]] std::string text_of(const PullInsRecord& record);
/// Returns "voltage_V,deflection_m,capacitance_F,branch,status" and one row per point, every digit; branch is up or down,
/// status that of to_string(SweepState). Deflection and capacitance of a beam that lies on the electrode are not known, and
/// empty.
[[nodiscard]] std::string sweep_csv(const std::vector<SweepPoint>& points);
/// Draws deflection and capacitance against the voltage, up and down, with the pull-in voltage marked where it is in the sweep.
[[nodiscard]] std::string sweep_svg(const PullInsRecord& record);

}  // namespace softland
