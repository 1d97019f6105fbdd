// The record of one run of a switch: its figures, its motion and its waveforms.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "document/chart.h"
#include "model/closing.h"
#include "objectives/figures.h"
#include "studies/closing/shown_motion.h"

namespace softland {

/// A time in which a contact is closed.
struct ClosedStretch {
  double begin = 0;                                       ///< begin [s]
  double end = std::numeric_limits<double>::quiet_NaN();  ///< end [s]; NaN: the contact is closed at the end of the window
  std::uint64_t touches = 1;  ///< number of touches; more than one: the openings between them are left out
};

/// The motion of a run at the contact point. A column that is not as long as `time` is damaged, or missing.
struct CurveRecord {
  std::vector<double> time;      ///< [s]
  std::vector<double> gap;       ///< distance to the contact plane [m]
  std::vector<double> velocity;  ///< towards the contact [m/s]
  std::vector<double> force;     ///< contact force on the beam [N]
  /// Resistance of the connection, NaN while it is open [Ohm]; empty where the contacts have no resistivity.
  std::vector<double> resistance = {};
  std::vector<Rebound> rebounds;
  std::optional<std::vector<ClosedStretch>> closed = {};  ///< times in which the contact, or the connection of several, is closed
  std::map<std::string, std::vector<ClosedStretch>> closed_contacts = {};  ///< the same for each of several contacts, by name
  std::optional<ShownMotion> motion = {};  ///< motion of all places; none where the run did not come to its end
};

/// The record is that of the winner or the single run, or of the baseline.
struct RunRecord {
  std::string status;
  std::optional<FigureValues> figures;  ///< none: the run is not there
  FigureValues errors;
  CurveRecord curve;
  std::map<std::string, Points> waveforms;  ///< time [s] and level [V] by drive; the dispersion force has its factor
  double cost = Metrics::unset;
  double collapse_time = Metrics::unset;  ///< time at which the beam met the electrode [s]
};

/// One of several contacts in the winner or the single run.
struct ContactFigures {
  double gap = Metrics::unset;  ///< rest distance of its place to its plane [m]
  FigureValues figures;
};

/// A result holds at most this many rows of a curve, rebounds, evaluations of a search and times in which a contact is closed:
/// its file stays readable (base/read_file.h) however long a run is.
inline constexpr std::size_t most_curve_rows = 20'000, most_rebounds = 20'000, most_evaluations = 100'000,
                             most_closed_stretches = 1000;

}  // namespace softland
