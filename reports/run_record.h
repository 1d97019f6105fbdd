// The results of one simulated run of a switch: its figures of merit, its motion and its waveforms.
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
#include "objectives/figure_values.h"
#include "studies/closing/shown_motion.h"

namespace softland {

/// A time span in which a contact is closed in a simulated run.
struct ClosedStretch {
  double begin = 0;  ///< time at which the contact closes [s]
  /// Time at which the contact opens [s]; NaN: still closed at the end of the simulated time.
  double end = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t touches = 1;  ///< number of touches in the span; openings between several touches are not recorded
};

/// The motion of a run at the contact point. A column whose length differs from that of `time` is damaged or missing.
struct CurveRecord {
  std::vector<double> time;      ///< times since the start of the run [s]
  std::vector<double> gap;       ///< distance of the contact point to the contact plane [m]
  std::vector<double> velocity;  ///< velocity of the contact point towards the contact [m/s]
  std::vector<double> force;     ///< contact force on the beam [N]
  /// Resistance of the closed switch between its terminals [Ohm]; NaN while it is open; empty if no contact has a resistivity.
  std::vector<double> resistance = {};
  std::vector<Rebound> rebounds;
  /// Times in which the contact is closed; of several contacts, times in which their electrical connection is closed.
  std::optional<std::vector<ClosedStretch>> closed = {};
  std::map<std::string, std::vector<ClosedStretch>> closed_contacts = {};  ///< times in which each contact is closed, by name
  std::optional<ShownMotion> motion = {};  ///< motion of the whole structure; none if the run stopped early
};

/// The run under the best waveform of a search, the run under the plain step, or the run of a single simulation.
struct RunRecord {
  std::string status;
  std::optional<FigureValues> figures;  ///< figures of merit of the run; none if there was no such run
  FigureValues errors;
  CurveRecord curve;
  /// Waveforms by electrode or piezo: time [s] and level [V]; for the dispersion force, its factor.
  std::map<std::string, Points> waveforms;
  double cost = Metrics::unset;
  double collapse_time = Metrics::unset;  ///< time at which the beam touched the electrode [s]
};

/// Figures of merit of one of several contacts, in the run with the best waveform or in the single run.
struct ContactFigures {
  double gap = Metrics::unset;  ///< rest distance from the contact's position to its contact plane [m]
  FigureValues figures;
};

/// Limits of the numbers of curve rows, rebounds, evaluations of a search and closed time spans in a result, so that the file
/// of a run of any length can be read (base/read_file.h).
inline constexpr std::size_t most_curve_rows = 20'000, most_rebounds = 20'000, most_evaluations = 100'000,
                             most_closed_stretches = 1000;

}  // namespace softland
