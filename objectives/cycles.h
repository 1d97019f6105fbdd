// Figures of merit of a switch that is closed and opened repeatedly in one run. Every cycle has its own figures and begins in
// the state in which the previous cycle ended.
#pragma once

#include <optional>
#include <vector>

#include "objectives/metrics.h"

namespace softland {

/// Times at which the cycles of closing and opening begin, and at which the switch is commanded to open in each cycle.
struct CycleTimes {
  double period = 0;   ///< duration of a cycle of closing and opening [s]
  double on_time = 0;  ///< time from the start of a cycle to the cycle's command to open [s]
  std::size_t cycles = 1;

  /// Returns the time at which a cycle of closing and opening starts [s].
  [[nodiscard]] double begin(std::size_t cycle) const { return static_cast<double>(cycle) * period; }
  /// Returns the time of a cycle's command to open [s].
  [[nodiscard]] double command(std::size_t cycle) const { return begin(cycle) + on_time; }
};

/// The figures of one cycle of closing and opening.
struct CycleFigures {
  /// Figures of the closing until the command to open, and of the opening after it. Times count from the start of the cycle,
  /// the drive energy is the energy from the sources in this cycle, and first contact is that of the connection, not of one of
  /// its contacts.
  Metrics metrics;
  bool closes = false;  ///< true when the cycle begins open, and the contact closes before the command to open
  bool opens = false;   ///< true when the contact is open at the end of the cycle
  /// Time in the cycle in which the switch is electrically closed [s]; needs a run that calls CycleRecorder::state().
  double on_time = 0;
  /// Largest distance of the contact point from its open position in the last third of the time after the command to open [m].
  double swing = 0;
};

class CycleRecorder final : public ClosingObserver {
 public:
  /// Takes the distance `contact_gap` from rest to the contact plane [m]. `options` define a significant rebound and, in
  /// MetricsOptions::opening, the open position.
  CycleRecorder(double contact_gap, const MetricsOptions& options, const CycleTimes& times);

  void knot(const TrajectoryPoint& point) override;
  void touch(const Touch& touch) override;
  void state(std::optional<std::size_t> contact, bool is_closed, double time) override;
  [[nodiscard]] bool takes_energies() const override { return true; }
  void energies(double time, const EnergyBalance& balance) override;

  /// Returns the number of cycles of closing and opening that have ended.
  [[nodiscard]] std::size_t ended() const { return current_; }
  /// Returns the figures of a cycle of closing and opening that has begun. They use the hold force and the in-contact period of
  /// `run`, which are NaN if unknown.
  [[nodiscard]] CycleFigures figures(std::size_t cycle, const Trajectory& run);

 private:
  struct Cycle {
    MetricsObserver metrics;
    double source_work = Metrics::unset;  // energy that the drives give in the cycle [J]
    bool began_open = false;
    // CycleFigures::swing [m] and CycleFigures::on_time [s] of the cycle so far.
    double swing = 0, on_time = 0;
  };

  // Returns the time for which the switch has been electrically closed in this cycle before `until` [s]; the switch must still
  // be closed then.
  [[nodiscard]] double closed_in(std::size_t cycle, double until) const;

  // Distance from rest to the contact plane, and position of the contact point at rest when open [m].
  double contact_gap_, open_position_;
  CycleTimes times_;
  std::vector<Cycle> cycles_;
  std::size_t current_ = 0;
  double work_before_ = 0;  // energy that the drives give up to the start of the current cycle [J]
  std::size_t counted_ = 0;
  std::optional<double> closed_from_ = {};  // time since which the switch is electrically closed [s]; empty while open
};

}  // namespace softland
