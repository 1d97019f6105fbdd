// The findings of an exploration for people: a document, the map of a figure as a picture, the front of several figures as
// JSON. The points may come from anywhere; the store of `softland explore` is one source.
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
#include "studies/exploration/aims.h"

namespace softland {

struct ExploredPoint {
  std::int64_t number = 0;
  std::string status;  ///< status at its end: "done"
  std::string reason;
  std::vector<double> values;  ///< values, one per column [SI]; NaN: not known
};

struct ExplorationReport {
  std::string title;
  std::string study;  ///< study that ran at every point: "simulate"
  std::vector<ExploredColumn> columns;
  std::vector<ExploredPoint> points;
  std::int64_t planned = 0;       ///< points of the plan
  std::vector<ExploredAim> aims;  ///< aims of the front; may be empty
  /// Waveforms of points by number and drive, where they are known.
  std::map<std::int64_t, std::map<std::string, Points>> waveforms;
  std::string plan;       ///< text of the plan
  std::string command;    ///< command that computed the points
  std::string made_with;  ///< program and processor
};

/// Tells whether a point with this status has valid figures: "done", or "not_settled", where the window ended before the last
/// rebound.
[[nodiscard]] bool has_figures(std::string_view status);

/// The Pareto front of the aims, over all points that may lead and have the figures of the aims.
struct ExploredFront {
  std::vector<std::size_t> members;     ///< indices of points in the report, sorted by the first aim
  std::optional<std::size_t> knee;      ///< index of the knee, a member, in the report
  std::vector<double> reference;        ///< worst value of every aim among the points
  double hypervolume = Metrics::unset;  ///< volume below the reference, in the units of the aims; NaN: more than three aims
  /// The hypervolume as a share of the box between the best and the worst values.
  double share = Metrics::unset;
};
[[nodiscard]] ExploredFront explored_front(const ExplorationReport& report);

/// Shows maps of every figure over two variables of a grid, parallel coordinates, a scatter matrix, the front with waveforms,
/// the effect of each variable, failures. The page is below 2 MB whatever the number of points. Where not all points fit, the
/// drawn ones are thinned and the page says how; counts, effects and the front are of all points.
[[nodiscard]] Document exploration_document(const ExplorationReport& report);
[[nodiscard]] nlohmann::json exploration_json(const ExplorationReport& report);

/// Returns the variables of a grid, in their order; none where the points are not a grid of at least two.
[[nodiscard]] std::vector<std::size_t> grid_variables(const ExplorationReport& report);

/// Draws the map of a figure over two variables as a picture of its own; any other variables stand at the middle one of their
/// values. Throws InvalidInput where the points are not a grid of these variables.
[[nodiscard]] std::string exploration_map_svg(const ExplorationReport& report, std::size_t x, std::size_t y, std::size_t figure);

}  // namespace softland
