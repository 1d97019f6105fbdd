// The record of one run of a switch: its figures, its motion and its waveforms.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/closing.h"
#include "objectives/figures.h"

namespace softland {

/// Points [x, y] in order.
using Points = std::vector<std::array<double, 2>>;

/// The motion of a run at the contact point. A column that is not as long as `time` is damaged, or missing.
struct CurveRecord {
  std::vector<double> time;      ///< [s]
  std::vector<double> gap;       ///< distance to the contact plane [m]
  std::vector<double> velocity;  ///< towards the contact [m/s]
  std::vector<double> force;     ///< contact force on the beam [N]
  /// Of the connection, NaN while it is open [Ohm]; empty where the contacts have no resistivity.
  std::vector<double> resistance = {};
  std::vector<Rebound> rebounds;
};

/// The winner or the single run, or the baseline.
struct RunRecord {
  std::string status;
  std::optional<FigureValues> figures;  ///< none: the run is not there
  FigureValues errors;
  CurveRecord curve;
  std::map<std::string, Points> waveforms;  ///< time [s] and level [V] by drive; the dispersion force has its factor
  double cost = Metrics::unset;
  double collapse_time = Metrics::unset;  ///< the time at which the beam met the electrode [s]
};

/// One of several contacts in the winner or the single run.
struct ContactFigures {
  double gap = Metrics::unset;  ///< rest distance of its place to its plane [m]
  FigureValues figures;
};

/// Rows of a curve, rebounds, and evaluations of a search that a result holds at most: its file stays readable (base/read_file.h)
/// however long a run is.
inline constexpr std::size_t most_curve_rows = 20'000, most_rebounds = 20'000, most_evaluations = 100'000;

}  // namespace softland
