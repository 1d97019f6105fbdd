// The times at which the capacitance of a switch passes a threshold. An instrument sees them for a closing without a contact
// current, such as a landing on a dielectric.
#pragma once

#include <cstddef>
#include <vector>

#include "model/closing/observer.h"
#include "model/switch.h"
#include "studies/closing/prepared.h"

namespace softland {

/// A time span with the capacitance above the threshold.
struct CapacitanceRise {
  double begin = 0;  ///< [s]
  double end = 0;    ///< [s]; NaN if it lasts to the end of the run
  double rate = 0;   ///< rate of the capacitance at its begin [F/s]
};

/// Follows the capacitance of one electrode, step by step. A rise and a fall within one step of the integrator are not seen.
class CapacitanceEdges final : public ClosingObserver {
 public:
  /// `drive` is that of the electrode, `threshold` in F. The object keeps a reference to the switch.
  CapacitanceEdges(const Switch& model, std::size_t drive, double threshold);

  [[nodiscard]] bool follows_motion() const override { return true; }
  void step(const Knot& begin, const Knot& end, const ContactState& contact) override;
  /// Rises in order of time.
  [[nodiscard]] const std::vector<CapacitanceRise>& rises() const { return rises_; }

 private:
  [[nodiscard]] double above(const double* q);
  [[nodiscard]] double above(const Knot& begin, const Knot& end, double part);

  const Switch& model_;
  std::size_t drive_;
  double threshold_;
  Switch::Workspace work_;
  std::vector<double> between_;  // modal coordinates between two knots
  double last_;                  // capacitance above the threshold, after the last step [F]; NaN before the first
  std::vector<CapacitanceRise> rises_;
};

/// Returns the capacitance of the closed state of the nominal design less that of the open one [F]. Throws InvalidInput if the
/// threshold does not lie between the two, or if such a state or a pulling electrode is missing.
[[nodiscard]] double capacitance_rise(const PreparedScene& nominal, double threshold);

}  // namespace softland
