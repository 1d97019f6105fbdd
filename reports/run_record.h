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
  double begin = 0;                                       ///< time at which the contact closes [s]
  double end = std::numeric_limits<double>::quiet_NaN();  ///< time at which it opens [s]; NaN: closed at the end of the window
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
  std::optional<std::vector<ClosedStretch>> closed = {};  ///< times in which the contact, or the connection of several
                                                          ///< contacts, is closed
  std::map<std::string, std::vector<ClosedStretch>> closed_contacts = {};  ///< times in which each contact is closed, by name
  std::optional<ShownMotion> motion = {};  ///< motion of the whole structure; none if the run stopped early
};

/// A run with the best waveform of a search, with the plain step, or of a single simulation.
struct RunRecord {
  std::string status;
  std::optional<FigureValues> figures;  ///< figures of merit; none if there was no such run
  FigureValues errors;
  CurveRecord curve;
  std::map<std::string, Points> waveforms;  ///< time [s] and level [V] by drive; for the dispersion force, its factor
  double cost = Metrics::unset;
  double collapse_time = Metrics::unset;  ///< time at which the beam touched the electrode [s]
};

/// Figures of one of several contacts, in the run with the best waveform or in the single run.
struct ContactFigures {
  double gap = Metrics::unset;  ///< rest distance from the contact's position to its contact plane [m]
  FigureValues figures;
};

/// Limits of the numbers of curve rows, rebounds, evaluations of a search and closed time spans in a result, so that the file
/// of a run of any length can be read (base/read_file.h).
inline constexpr std::size_t most_curve_rows = 20'000, most_rebounds = 20'000, most_evaluations = 100'000,
                             most_closed_stretches = 1000;

}  // namespace softland
