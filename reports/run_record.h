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

/// A time span in which a contact is closed.
struct ClosedStretch {
  double begin = 0;                                       ///< begin [s]
  double end = std::numeric_limits<double>::quiet_NaN();  ///< end [s]; NaN: the contact is closed at the end of the window
  std::uint64_t touches = 1;  ///< number of touches; openings between several touches are not recorded
};

/// The motion of a run at the contact point. A column whose length differs from that of `time` is damaged or missing.
struct CurveRecord {
  std::vector<double> time;      ///< [s]
  std::vector<double> gap;       ///< distance to the contact plane [m]
  std::vector<double> velocity;  ///< towards the contact [m/s]
  std::vector<double> force;     ///< contact force on the beam [N]
  /// Resistance of the connection, NaN while the connection is open [Ohm]; empty if the contacts have no resistivity.
  std::vector<double> resistance = {};
  std::vector<Rebound> rebounds;
  std::optional<std::vector<ClosedStretch>> closed = {};  ///< times with closed contact, or connection of several
  std::map<std::string, std::vector<ClosedStretch>> closed_contacts = {};  ///< times with closed contact, by its name
  std::optional<ShownMotion> motion = {};  ///< motion of the whole structure; none if the run stopped early
};

/// A run with the waveforms of the winner, of the baseline, or of a single run.
struct RunRecord {
  std::string status;
  std::optional<FigureValues> figures;  ///< none: there was no such run
  FigureValues errors;
  CurveRecord curve;
  std::map<std::string, Points> waveforms;  ///< time [s] and level [V] by drive; for the dispersion force, its factor
  double cost = Metrics::unset;
  double collapse_time = Metrics::unset;  ///< time at which the beam touched the electrode [s]
};

/// Figures of one of several contacts, for the winner or the single run.
struct ContactFigures {
  double gap = Metrics::unset;  ///< rest distance from the contact's position to its contact plane [m]
  FigureValues figures;
};

/// Largest numbers of rows of a curve, of rebounds, of evaluations of a search and of times with a closed contact in a result:
/// its file stays readable (base/read_file.h) for a run of any length.
inline constexpr std::size_t most_curve_rows = 20'000, most_rebounds = 20'000, most_evaluations = 100'000,
                             most_closed_stretches = 1000;

}  // namespace softland
