// A ClosingRecord holds the results of `simulate`, or of a search by `optimize` with the closing that it found. Every output,
// also JSON, is made from it. record_of() makes the record; read_closing() reads it from JSON. A member that is not available
// is NaN, empty or not set.
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

/// The effects that the setting effects = "auto" left out of the model.
struct EffectsLeftOut {
  struct LeftOut {
    std::string effect;
    double influence = Metrics::unset;
  };
  std::vector<LeftOut> left_out;
  double influence = Metrics::unset;  ///< estimated relative influence of all omitted effects together on the figures of merit
};

struct PullInOfElectrode {
  /// Static and dynamic pull-in voltage of one electrode [V].
  double static_pull_in = Metrics::unset, dynamic_pull_in = Metrics::unset;
  /// Static pull-in voltage by number of modes; none if no modes could be added to those of the scene.
  std::optional<ByModes> static_by_modes = {};
};

struct ClosingRecord {
  Origin origin;  ///< verb, program, machine, command line and scene of the result; its kind is "simulate" or "optimize"
  std::string status, message, title;
  RunRecord best;  ///< the single run, or the run under the best waveform of a search
  /// Figures of merit by contact, if there are several; `best` has the figures of the electrical connection they make.
  std::map<std::string, ContactFigures> contacts;
  std::optional<Certificate> certificate;
  std::optional<ClosedState> closed_state;  ///< state of the closed switch under the hold voltages; none without a contact
  std::map<std::string, PullInOfElectrode> pull_in;  ///< pull-in voltages by actuating electrode
  std::vector<double> natural_frequencies;           ///< natural angular frequencies of the structure [rad/s]
  std::optional<Work> work;                          ///< numerical work (steps, evaluations) of the run in `best`
  std::vector<std::string> warnings;
  DrawnScene scene;
  std::optional<EffectsLeftOut> effects;
  double tolerance = Metrics::unset;   ///< relative tolerance of the integrator in the run in `best`
  std::optional<SearchRecord> search;  ///< the search that found the run in `best`; none for a single run

  /// Returns the run under the plain voltage step that a search compares with; an empty run if there was no search.
  [[nodiscard]] const RunRecord& baseline() const;
  /// Returns the findings of a search about devices under process variation; null if there are none.
  [[nodiscard]] const DevicesFindings* devices() const { return search && search->devices ? &*search->devices : nullptr; }
};

/// Returns the motion of a run at the contact point: the end points of the integrator's steps, and interpolated points within
/// long steps. Of a long run, at most most_curve_rows points stay, which draw the same picture with all extremes, and the
/// most_rebounds highest rebounds.
[[nodiscard]] CurveRecord curve_of(const Trajectory& trajectory, const MetricsOptions& options);
/// Returns the motion of a run at the contact point, with `rebounds` that were found during the run. If `is_thinned`, the
/// trajectory keeps only some of the integrator's steps, and no points are interpolated between them.
[[nodiscard]] CurveRecord curve_of(const Trajectory& trajectory, const std::vector<Rebound>& rebounds, bool is_thinned,
                                   const MetricsOptions& options);

/// Returns the touches of a run as times in which the contact is closed. More than `most` touches are joined across the
/// shortest openings.
[[nodiscard]] std::vector<ClosedStretch> closed_stretches(const std::vector<Touch>& touches,
                                                          std::size_t most = most_closed_stretches);

/// Returns the evaluations of a search; of a long search, the most_evaluations that draw the same picture.
[[nodiscard]] Points drawn_evaluations(Points all);

/// Makes the results of `simulate`; `command` is the command line. Curves have the resolution of the integration, up to
/// most_curve_rows. With `shows_motion` the closing is simulated once more for the animation of the page.
[[nodiscard]] ClosingRecord record_of(const PreparedScene& prepared, const Closing& closing, const std::string& command,
                                      bool shows_motion = true);

/// Makes the results of `optimize`. Equal seeds give equal results, apart from the elapsed time and the command line. The
/// results have only the evaluations that improved the best cost.
[[nodiscard]] ClosingRecord record_of(const OptimizeResult& found, const OptimizeOptions& options, const std::string& command);

/// Makes the results of a search that minimises one statistic of the devices under process variation.
[[nodiscard]] ClosingRecord record_of(const RobustResult& found, const OptimizeOptions& options, const std::string& command);

/// Makes the results of a search that offers several waveforms for the devices under process variation, with the best of them.
[[nodiscard]] ClosingRecord record_of(const RobustSearchResult& found, const OptimizeOptions& options, std::string next_command,
                                      const std::string& command);

/// Returns the results of a closing as JSON for programs: SI units in the names, non-finite numbers as null.
[[nodiscard]] nlohmann::json json_of(const ClosingRecord& record);
/// Returns the results of a closing as --json writes them: without large parts (curves, the text of the scene, the log of the
/// search) and without repetitions.
[[nodiscard]] nlohmann::json summary_json(nlohmann::json record);
/// Returns status and figures of merit of a run as JSON, except figures of the drive waveforms themselves, such as the peak
/// voltage.
[[nodiscard]] nlohmann::json metrics_json(const Metrics& metrics);

/// Parses the content of a result.json: an object of kind "simulate" or "optimize"; all other members may be missing or of
/// another type. `name` stands for the file in messages. Throws InvalidInput for anything else.
[[nodiscard]] nlohmann::json parse_closing(std::string_view content, const std::string& name);
/// Throws InvalidInput unless the JSON of a result has figures of merit and a scene, which a report needs.
void require_reportable(const nlohmann::json& record);
/// Returns the results of a closing from their JSON. Every part is optional: a part that is missing, null or of another type is
/// not available. Throws InvalidInput when `from` is not an object.
[[nodiscard]] ClosingRecord read_closing(const nlohmann::json& from);

namespace internal {
/// Returns a number that was computed with several numbers of modes, as JSON: {"5": number, "10": ..., "20": ..., "converged":
/// number}; a number that is not available is null.
[[nodiscard]] nlohmann::json by_modes_json(const ByModes& found);
[[nodiscard]] std::optional<ByModes> read_by_modes(const nlohmann::json& found);
}  // namespace internal

/// Returns the curve of a run as CSV with the header time_s,tip_gap_m,tip_velocity_m_s,contact_force_N,contact_resistance_ohm
/// (the columns that exist). A number is the shortest text that reads back to the same bits; a non-finite value is an empty
/// field.
[[nodiscard]] std::string trajectory_csv(const CurveRecord& curve);

}  // namespace softland
