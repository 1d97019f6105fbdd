// The results of `softland pull-in`: JSON with SI units in the names, text, and a voltage sweep as CSV and picture. The verb
// `check` also reports the voltages of an electrode, and the stable path by which one electrode or piezo closes the switch.
#pragma once

#include <cmath>
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

/// The pull-in and release voltages of an electrode [V], while the other electrodes and the piezos have constant voltages: see
/// bias_of().
struct PullInRecord {
  double static_pull_in = Metrics::unset, dynamic_pull_in = Metrics::unset, release = Metrics::unset,
         pulled_through = Metrics::unset;
  /// Name of the kind of static pull-in (how the stable equilibrium ends); empty if there is no static pull-in.
  std::string static_kind;
  double deflection = Metrics::unset;  ///< deflection of the contact point at static pull-in [m]
  double neutral = Metrics::unset;     ///< voltage that cancels the charge of a dielectric [V]; unset without charge
  /// Kind of dynamic pull-in: "overshoot", "overdamped", "unstable_rest"; empty if no voltage was found.
  std::string dynamic_kind;
  /// Static voltages by number of modes; none if no modes could be added to those of the scene, or after an interruption.
  std::optional<VoltagesByModes> by_modes;
};
struct ElectrodeRecord {
  Status status = Status::not_run;
  PullInRecord volts;
  std::map<std::string, double> bias;  ///< voltages of the other electrodes and piezos that are not at 0, by name [V]
  /// Factor of the dispersion force by its name in the scene, if the factor is not 1.
  std::map<std::string, double> bias_factor;
};
[[nodiscard]] ElectrodeRecord record_of(const PreparedScene& prepared, std::size_t k, const ElectrodePullIn& known);

/// Returns a voltage as text, "22.469 V", or "none" if it is NaN.
[[nodiscard]] std::string volts(double value);
/// Returns the constant levels that other electrodes, piezos or the dispersion force have while the voltage of the electrode
/// varies, such as "piezo -1.5 V"; empty if all are at 0.
[[nodiscard]] std::string bias_prose(const ElectrodeRecord& electrode);
/// Describes the dynamic pull-in voltage. This voltage equals the static pull-in voltage if damping prevents an overshoot, or
/// if no lower voltage step moves the beam.
[[nodiscard]] std::string dynamic_prose(const PullInRecord& found);

/// Says between which voltages a step touches the contact and does not keep the switch closed: from the dynamic pull-in voltage
/// up to a higher release voltage. Empty if the release voltage is not higher.
[[nodiscard]] std::string brief_contact_prose(const PullInRecord& found);

/// Returns true if the charge of the dielectric keeps a closed switch closed at 0 V.
[[nodiscard]] bool sticks_by_charge(const PullInRecord& found);
/// Describes how the charge of the dielectric shifts the pull-in and release voltages of both polarities; empty without charge.
[[nodiscard]] std::string charge_prose(const PullInRecord& found);

/// The electrode or piezo that moves the switch to its contact through stable equilibria, with all others at 0 V.
struct StablePathRecord {
  std::string drive;
  /// Voltage at which the nominal design first touches its contact; limit of the voltage source [V].
  double reaches = Metrics::unset, limit = Metrics::unset;
  std::optional<double> share;  ///< share of the varied devices of [spread] that reach the contact in this way
};
/// Returns the electrode or piezo that alone moves the switch to its contact through stable equilibria; none if none of them
/// does, or if there is no contact.
[[nodiscard]] std::optional<StablePathRecord> stable_path_of(const PreparedScene& prepared, const Progress& progress);
/// Describes the stable path to the contact: "the piezo alone reaches the contact at -0.9483 V through stable equilibria; 96.5
/// % of devices do within -1 V".
[[nodiscard]] std::string words_of(const std::optional<StablePathRecord>& path);

struct PullInsRecord {
  Origin origin;
  std::string status;
  std::map<std::string, ElectrodeRecord> electrodes;
  std::optional<StablePathRecord> stable_path;
  std::string swept;                  ///< electrode whose voltage was swept; empty without a sweep
  std::vector<SweepPoint> sweep;      ///< points of the voltage sweep
  std::vector<std::string> left_out;  ///< names of results that are missing after an interruption
};
/// Name in `left_out` of the stable path (through stable equilibria to the contact) when an interruption prevented its
/// computation.
inline constexpr const char* stable_path_left_out = "the stable path";

/// Names the members of the JSON; `check` has the pull-in voltages and the stable path, too.
void members(internal::Archive& a, PullInRecord& found);
void members(internal::Archive& a, StablePathRecord& path);
void members(internal::Archive& a, PullInsRecord& record);
[[nodiscard]] nlohmann::json json_of(const PullInsRecord& record);
[[nodiscard]] PullInsRecord read_pull_ins(const nlohmann::json& from);
[[nodiscard]] std::string text_of(const PullInsRecord& record);
/// Returns the voltage sweep as CSV, "voltage_V,deflection_m,capacitance_F,branch,status" and one row per point, with all
/// digits; branch is up or down, status as by to_string(SweepState). Deflection and capacitance of a beam that lies on the
/// electrode are unknown, and empty.
[[nodiscard]] std::string sweep_csv(const std::vector<SweepPoint>& points);
/// Draws deflection and capacitance against the voltage of a rising and falling sweep. The pull-in voltage is marked if it is
/// within the sweep. A beam that collapses onto the electrode has no falling half.
[[nodiscard]] std::string sweep_svg(const PullInsRecord& record);

}  // namespace softland
