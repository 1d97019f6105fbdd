// This record holds a closing, by `simulate`, and the search that found it, by `optimize`. Every output is made from it, JSON
// too. The function record_of() makes it and read_closing() reads it again. A member that is not available is NaN, empty or not
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
#include "studies/search/robust_search_study.h"

namespace softland {

/// The effects that effects = "auto" left out.
struct EffectsLeftOut {
  struct LeftOut {
    std::string effect;
    double influence = Metrics::unset;
  };
  std::vector<LeftOut> left_out;
  double influence = Metrics::unset;  ///< influence of all of them together
};

struct PullInOfElectrode {
  double static_pull_in = Metrics::unset, dynamic_pull_in = Metrics::unset;  ///< voltages [V]
  std::optional<ByModes> static_by_modes = {};  ///< none where there are no more modes than the scene has
};

struct ClosingRecord {
  Origin origin;  ///< its kind is "simulate" or "optimize"
  std::string status, message, title;
  RunRecord best;                                  ///< the single run, or the winner of the search
  std::map<std::string, ContactFigures> contacts;  ///< by name, where there are several; other figures: the connection
  std::optional<Certificate> certificate;
  std::optional<ClosedState> closed_state;           ///< closed state under the hold levels; none without a contact
  std::map<std::string, PullInOfElectrode> pull_in;  ///< voltages by electrode
  std::vector<double> natural_frequencies;           ///< natural angular frequencies [rad/s]
  std::optional<Work> work;                          ///< integration work of the shown run
  std::vector<std::string> warnings;
  DrawnScene scene;
  std::optional<EffectsLeftOut> effects;
  double tolerance = Metrics::unset;   ///< tolerance of the integrator in the shown run
  std::optional<SearchRecord> search;  ///< the search; none for a single run

  /// Returns the plain step of a search; for a single run an empty one.
  [[nodiscard]] const RunRecord& baseline() const;
  /// Returns the findings about the process variation; null where there are none.
  [[nodiscard]] const DevicesFindings* devices() const { return search && search->devices ? &*search->devices : nullptr; }
};

/// Returns the motion of a run: its knots, and points of the interpolant where knots are far apart. A long run keeps the
/// most_curve_rows of them that draw the same picture, with all extremes, and its most_rebounds highest rebounds.
[[nodiscard]] CurveRecord curve_of(const Trajectory& trajectory, const MetricsOptions& options);
/// Does the same for a course whose rebounds are known. Nothing is drawn between the knots of a thinned one.
[[nodiscard]] CurveRecord curve_of(const Trajectory& trajectory, const std::vector<Rebound>& rebounds, bool is_thinned,
                                   const MetricsOptions& options);

/// Returns the touches of a run as times in which the contact is closed. Where there are very many, touches are joined across
/// the shortest openings.
[[nodiscard]] std::vector<ClosedStretch> closed_stretches(const std::vector<Touch>& touches,
                                                          std::size_t most = most_closed_stretches);

/// Returns the evaluations of a long search, of which most_evaluations draw the same picture.
[[nodiscard]] Points drawn_evaluations(Points all);

/// Makes the record of simulate; `command` is the command line. Curves have the resolution of the integration, up to
/// most_curve_rows.
[[nodiscard]] ClosingRecord record_of(const PreparedScene& prepared, const Closing& closing, const std::string& command);

/// Makes the record of optimize. Equal seeds give equal records, apart from the elapsed time and the command line. It holds
/// those evaluations that improved.
[[nodiscard]] ClosingRecord record_of(const OptimizeResult& found, const OptimizeOptions& options, const std::string& command);

/// Makes the record of a robust search.
[[nodiscard]] ClosingRecord record_of(const RobustResult& found, const OptimizeOptions& options, const std::string& command);

/// Makes the record of a search for devices: that of the waveform that wins.
[[nodiscard]] ClosingRecord record_of(const RobustSearchResult& found, const OptimizeOptions& options, std::string next_command,
                                      const std::string& command);

/// Returns JSON for programs: SI units in the names, non-finite numbers as null.
[[nodiscard]] nlohmann::json json_of(const ClosingRecord& record);
/// Returns the record as --json gives it: without large parts (curves, the text of the scene, the log of the search) and
/// repetitions.
[[nodiscard]] nlohmann::json summary_json(nlohmann::json record);
/// Returns status and figures of a run, except those of the drives.
[[nodiscard]] nlohmann::json metrics_json(const Metrics& metrics);

/// Parses the content of a result.json: an object of kind "simulate" or "optimize"; everything else in it may be missing or of
/// another type. `name` stands for the file in messages. Throws InvalidInput for anything else.
[[nodiscard]] nlohmann::json parse_closing(std::string_view content, const std::string& name);
/// Throws InvalidInput unless a report can be made of this record: it has figures and a scene.
void require_reportable(const nlohmann::json& record);
/// Returns the record that the JSON describes. Every part of it is optional: a part that is missing, null or of another type is
/// not available. Throws InvalidInput when `from` is not an object.
[[nodiscard]] ClosingRecord read_closing(const nlohmann::json& from);

namespace internal {
/// Writes {"5": number, "10": ..., "20": ..., "converged": number}, and reads it back; a number that is not available is null.
[[nodiscard]] nlohmann::json by_modes_json(const ByModes& found);
[[nodiscard]] std::optional<ByModes> read_by_modes(const nlohmann::json& found);
}  // namespace internal

/// Returns the curve of a run as CSV: header time_s,tip_gap_m,tip_velocity_m_s,contact_force_N,contact_resistance_ohm (those
/// that exist). Each row is one line; a number is the shortest text that reads back to it, a non-finite value an empty field.
[[nodiscard]] std::string trajectory_csv(const CurveRecord& curve);

}  // namespace softland
