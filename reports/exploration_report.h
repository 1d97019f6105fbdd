// What an exploration found, made ready to be looked at: a document, the map of a figure as a picture, the front of several
// figures as JSON. The points may come from anywhere; the store of `softland explore` is one maker.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reports/closing_record.h"
#include "reports/document.h"
#include "studies/exploration/aims.h"

namespace softland {

struct ExploredPoint {
  std::int64_t number = 0;
  std::string status;  ///< how it ended: "done"
  std::string reason;
  std::vector<double> values;  ///< one per column [SI]; NaN: not known
};

struct ExplorationReport {
  std::string title;
  std::string study;  ///< what was asked of every point: "simulate"
  std::vector<ExploredColumn> columns;
  std::vector<ExploredPoint> points;
  std::int64_t planned = 0;       ///< points of the plan
  std::vector<ExploredAim> aims;  ///< of the front; may be empty
  /// The drives of points, where they are known: by number and drive.
  std::map<std::int64_t, std::map<std::string, Points>> waveforms;
  std::string plan;       ///< its text
  std::string command;    ///< that computed the points
  std::string made_with;  ///< program and processor
};

/// Whether the figures of a point that ended so are what they are: "done", or "not_settled", where the window ended before the
/// last rebound.
[[nodiscard]] bool has_figures(std::string_view status);

/// The front of the aims, of all points that may lead and have the figures of the aims.
struct ExploredFront {
  std::vector<std::size_t> members;     ///< numbers of points in the report, by the first aim
  std::optional<std::size_t> knee;      ///< the member, a number of a point in the report
  std::vector<double> reference;        ///< the worst value of every aim among the points
  double hypervolume = Metrics::unset;  ///< in the units of the aims, of what lies below the reference; NaN: more than three aims
  /// The same as a part of the box between the best and the worst values.
  double share = Metrics::unset;
};
[[nodiscard]] ExploredFront explored_front(const ExplorationReport& report);

/// The page is below 2 MB whatever the number of points: maps of every figure over two variables of a grid, parallel
/// coordinates, a scatter matrix, the front with waveforms, the effect of each variable, failures. Where not all points fit, what
/// is drawn is thinned and the page says how; counts, effects and the front are of all points.
[[nodiscard]] Document exploration_document(const ExplorationReport& report);
[[nodiscard]] nlohmann::json exploration_json(const ExplorationReport& report);

/// The variables of a grid, in their order; none where the points are no grid of at least two.
[[nodiscard]] std::vector<std::size_t> grid_variables(const ExplorationReport& report);

/// The map of a figure over two variables as a picture of its own; the other variables, where there are any, stand at the middle
/// one of their values. Throws InvalidInput where the points are no grid of these variables.
[[nodiscard]] std::string exploration_map_svg(const ExplorationReport& report, std::size_t x, std::size_t y, std::size_t figure);

}  // namespace softland
