// The report on an exploration: a document, the map of a figure of merit as a picture, and the Pareto front as JSON. The points
// come from any source, such as the database file of `softland explore`.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/document.h"
#include "reports/closing_record.h"
#include "store/study_store.h"
#include "studies/exploration/aims.h"

namespace softland {

struct ExploredPoint {
  std::int64_t number = 0;
  std::string status;  ///< status of the point at the end of its computation: "done"
  std::string reason;
  std::vector<double> values;  ///< values of variables and figures of merit, one per column [SI]; NaN: unknown
};

struct ExplorationReport {
  std::string title;
  std::string study;  ///< verb that was run at every point: "simulate"
  std::vector<ExploredColumn> columns;
  std::vector<ExploredPoint> points;
  std::int64_t planned = 0;       ///< number of points in the plan, the list of points to compute
  std::vector<ExploredAim> aims;  ///< figures of merit to minimise or maximise, which define the Pareto front; may be empty
  /// Waveforms by number of the point and name of the electrode or piezo, as far as known.
  std::map<std::int64_t, std::map<std::string, Points>> waveforms;
  std::string plan;       ///< text of the plan, the stored request of the exploration
  std::string command;    ///< command line that computed the points
  std::string made_with;  ///< version of the program, and processor, that computed the points
};

/// Returns true if a point with this status has valid figures of merit: "done", or "not_settled", when the simulation ended
/// before the last rebound.
[[nodiscard]] bool has_figures(std::string_view status);

/// The Pareto front of several figures of merit to minimise or maximise, among all points that have these figures and the
/// status "done". A point whose switch still bounced at the end of the simulation cannot be on the front.
struct ExploredFront {
  /// Indices in the report of the points on the front, sorted by the first aim (figure to minimise or maximise).
  std::vector<std::size_t> members;
  std::optional<std::size_t> knee;  ///< index in the report of the knee, the member of the front that is the best compromise
  std::vector<double> reference;    ///< worst value of every aim (figure to minimise or maximise) among the points
  /// Hypervolume between the front and the point `reference`, in the product of the figures' units; NaN for more than three
  /// aims.
  double hypervolume = Metrics::unset;
  /// `hypervolume` as a share of the box between the best and the worst value of every aim.
  double share = Metrics::unset;
};
[[nodiscard]] ExploredFront explored_front(const ExplorationReport& report);

/// Returns a document with maps of every figure of merit over two variables of a grid, parallel coordinates, a scatter matrix,
/// the Pareto front with waveforms, the effect of each variable, and failures. The page is below 2 MB for any number of points.
/// If not all points fit, the drawn points are thinned, and the page states the rule; counts, effects and the front are of all
/// points.
[[nodiscard]] Document exploration_document(const ExplorationReport& report);
[[nodiscard]] nlohmann::json exploration_json(const ExplorationReport& report);

/// Returns the variables of the grid of points, in their order; none if the points are no grid of at least two variables.
[[nodiscard]] std::vector<std::size_t> grid_variables(const ExplorationReport& report);

/// Draws the map of a figure of merit over two variables as an SVG file; each other variable has the middle one of its values.
/// Throws InvalidInput if the points are no grid of these variables.
[[nodiscard]] std::string exploration_map_svg(const ExplorationReport& report, std::size_t x, std::size_t y, std::size_t figure);

/// Reads all rows of the database file, with the stored waveforms. `pareto` names the figures of merit of the Pareto front, as
/// the option --pareto does; empty: the figures that the plan minimises, if any. Throws InvalidInput as explored_aims() and
/// StudyReader do.
[[nodiscard]] ExplorationReport read_exploration(const StudyReader& store, const std::string& pareto);

/// Adds waveforms that the database file lacks to the points on the Pareto front, by preparing their scenes. A point whose
/// scene cannot be prepared gets no waveform.
void add_front_waveforms(ExplorationReport& report, const StudyReader& store, const Progress& progress);

}  // namespace softland
