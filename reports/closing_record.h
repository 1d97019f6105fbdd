// The record of a closing, by `simulate`, and of the search that found it, by `optimize`: the typed value that every output is
// made from, JSON too. It is made by record_of() and read again by read_closing(). What is not available is NaN, empty or not
// set.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reports/drawn_scene.h"
#include "reports/origin.h"
#include "reports/run_record.h"
#include "reports/search_record.h"
#include "studies/closing/certify.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/simulate.h"
#include "studies/search/for_devices.h"

namespace softland {

/// The effects that effects = "auto" left out.
struct EffectsLeftOut {
  struct LeftOut {
    std::string effect;
    double influence = Metrics::unset;
  };
  std::vector<LeftOut> left_out;
  double influence = Metrics::unset;  ///< they have together
};

struct PullInOfElectrode {
  double static_pull_in = Metrics::unset, dynamic_pull_in = Metrics::unset;  ///< [V]
  std::optional<ByModes> static_by_modes = {};  ///< none where there are no more modes than the scene has
};

struct ClosingRecord {
  Origin origin;  ///< its kind is "simulate" or "optimize"
  std::string status, message, title;
  RunRecord best;                                  ///< the single run, or the winner of the search
  std::map<std::string, ContactFigures> contacts;  ///< by name, where there are several: the other figures are of the connection
  std::optional<Certificate> certificate;
  std::optional<ClosedState> closed_state;           ///< under the hold levels; none without a contact
  std::map<std::string, PullInOfElectrode> pull_in;  ///< by electrode
  std::vector<double> natural_frequencies;           ///< [rad/s]
  std::optional<Work> work;                          ///< integration work of the shown run
  std::vector<std::string> warnings;
  DrawnScene scene;
  std::optional<EffectsLeftOut> effects;
  double tolerance = Metrics::unset;   ///< of the integrator, in the shown run
  std::optional<SearchRecord> search;  ///< none of a single run

  /// The plain step of a search; of a single run one that is not there.
  [[nodiscard]] const RunRecord& baseline() const;
  /// The findings about the process variation; null where there are none.
  [[nodiscard]] const DevicesFindings* devices() const { return search && search->devices ? &*search->devices : nullptr; }
};

/// The motion of a run: its knots, and points of the interpolant where knots are far apart. A long run keeps the most_curve_rows
/// of them that draw the same picture, with all extremes, and its most_rebounds highest rebounds.
[[nodiscard]] CurveRecord curve_of(const Trajectory& trajectory, const MetricsOptions& options);
/// The same of a course whose rebounds are known. Nothing is drawn between the knots of one that is thinned.
[[nodiscard]] CurveRecord curve_of(const Trajectory& trajectory, const std::vector<Rebound>& rebounds, bool is_thinned,
                                   const MetricsOptions& options);

/// The touches of a run as times in which the contact is closed. Where there are very many, those between the shortest openings
/// are one.
[[nodiscard]] std::vector<ClosedStretch> closed_stretches(const std::vector<Touch>& touches,
                                                          std::size_t most = most_closed_stretches);

/// The evaluations of a long search of which most_evaluations draw the same picture.
[[nodiscard]] Points drawn_evaluations(Points all);

/// The record of simulate; `command` is the command line. Curves have the resolution of the integration, up to most_curve_rows.
[[nodiscard]] ClosingRecord record_of(const PreparedScene& prepared, const Closing& closing, const std::string& command);

/// The record of optimize. It is equal for equal seeds but for the time that it took and the command line. It holds those
/// evaluations that improved.
[[nodiscard]] ClosingRecord record_of(const OptimizeResult& found, const OptimizeOptions& options, const std::string& command);

/// The record of a robust search.
[[nodiscard]] ClosingRecord record_of(const RobustResult& found, const OptimizeOptions& options, const std::string& command);

/// The record of a search for devices: of the waveform that wins.
[[nodiscard]] ClosingRecord record_of(const ForDevicesResult& found, const OptimizeOptions& options, std::string next_command,
                                      const std::string& command);

/// JSON for programs: SI units in the names, non-finite numbers as null.
[[nodiscard]] nlohmann::json json_of(const ClosingRecord& record);
/// The record as --json gives it: without what is large (curves, the text of the scene, the log of the search) or said twice.
[[nodiscard]] nlohmann::json summary_json(nlohmann::json record);
/// Status and figures of a run, but for those of the drives.
[[nodiscard]] nlohmann::json metrics_json(const Metrics& metrics);

/// The JSON that the content of a result.json holds: an object of kind "simulate" or "optimize"; everything else in it may be
/// missing or of another type. `name` stands for the file in messages. Throws InvalidInput for anything else.
[[nodiscard]] nlohmann::json parse_closing(std::string_view content, const std::string& name);
/// Throws InvalidInput unless a report can be made of this record: it has figures and a scene.
void require_reportable(const nlohmann::json& record);
/// The record that the JSON describes. Every part of it is optional: what is missing, null or of another type is not available.
/// Throws InvalidInput when `from` is not an object.
[[nodiscard]] ClosingRecord read_closing(const nlohmann::json& from);

namespace internal {
/// {"5": number, "10": ..., "20": ..., "converged": number}, and back; a number that there is not is null.
[[nodiscard]] nlohmann::json by_modes_json(const ByModes& found);
[[nodiscard]] std::optional<ByModes> read_by_modes(const nlohmann::json& found);
}  // namespace internal

}  // namespace softland
