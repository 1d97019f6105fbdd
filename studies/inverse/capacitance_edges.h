// The times at which the capacitance of a switch crosses a threshold. An instrument can record these times for a closing
// without a contact current, such as a closing onto a dielectric.
#pragma once

#include <cstddef>
#include <vector>

#include "model/closing/observer.h"
#include "model/switch.h"
#include "studies/closing/prepared.h"

namespace softland {

/// A time span in which the capacitance is above a threshold.
struct CapacitanceRise {
  double begin = 0;  ///< time at which the capacitance rises above the threshold [s]
  double end = 0;    ///< time at which the capacitance falls below the threshold [s]; NaN if it stays above until the run ends
  double rate = 0;   ///< time derivative of the capacitance at `begin` [F/s]
};

/// Records when the capacitance of one electrode crosses a threshold, in every step of the integrator. A rise and a fall within
/// one step are missed.
class CapacitanceEdges final : public ClosingObserver {
 public:
  /// `drive` is the index of the electrode in Switch::drives(), `threshold` is in F. Keeps a reference to the switch.
  CapacitanceEdges(const Switch& model, std::size_t drive, double threshold);

  [[nodiscard]] bool follows_motion() const override { return true; }
  void step(const Knot& begin, const Knot& end, const ContactState& contact) override;
  /// Returns the time spans with the capacitance above the threshold, in order.
  [[nodiscard]] const std::vector<CapacitanceRise>& rises() const { return rises_; }

 private:
  [[nodiscard]] double above(const double* q);
  [[nodiscard]] double above(const Knot& begin, const Knot& end, double part);

  const Switch& model_;
  std::size_t drive_;
  double threshold_;
  Switch::Workspace work_;
  std::vector<double> between_;  // modal coordinates at a time between two knots (points between integrator steps)
  double last_;                  // capacitance less the threshold after the last integrator step [F]; NaN before the first step
  std::vector<CapacitanceRise> rises_;
};

/// Returns the capacitance of the nominal design in its closed state less that in its open state [F]. Throws InvalidInput if
/// the threshold is not between these capacitances, and if the closed state, the open state or a pulling electrode is missing.
[[nodiscard]] double capacitance_rise(const PreparedScene& nominal, double threshold);

}  // namespace softland
