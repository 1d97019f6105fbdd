// The charge that flows through a contact while it closes and while it opens. The contact force is then below the steady force,
// and the current can melt the few small spots through which it flows. The transferred material is proportional to this charge.
//
//   i = V / (R_L + R),   Q = integral of i dt over the times in contact at which the contact force is below F_s
//
// V is the voltage of the source [V] and R_L the resistance in series with it [Ohm] of the load circuit. R is the resistance of
// the contact [Ohm]; when R is not known it counts as 0, and Q is an upper bound of the charge. F_s is the steady force [N].
//
// Limits: the load is a resistance, without inductance or capacitance, which add arcs and surges; no current flows through a
// gap; the contact does not heat. Q compares waveforms on one contact. The mass of material that Q moves depends on the metals,
// and must be measured. Sources: R. Holm, Electric Contacts (1967), on the transfer of material; T. G. Bull & J. W. McBride,
// Technologies 6 (2018) 47, for gold in a MEMS switch.
#pragma once

#include <limits>
#include <optional>

#include "model/contact/resistance.h"
#include "model/device.h"
#include "model/trajectory.h"

namespace softland {

struct TransferOptions {
  SwitchedLoad load = {};
  /// Steady contact force [N]: charge counts that flows while the contact force is below it. The charge is NaN when this force
  /// is.
  double light_below = std::numeric_limits<double>::quiet_NaN();
  std::optional<ContactResistance> contact = {};  ///< resistance of the contact; counts as 0 if empty
};

/// Computes the charge that flows through a contact during a run.
class TransferredCharge {
 public:
  /// Takes the distance `contact_gap` from rest to the contact plane [m].
  TransferredCharge(const TransferOptions& options, double contact_gap) : options_(options), contact_gap_(contact_gap) {}
  /// Adds the motion between two points of a trajectory, over which the contact is open or closed throughout. The contact force
  /// between the points is taken as linear in time.
  void follow(const TrajectoryPoint& from, const TrajectoryPoint& to);
  /// Returns the charge through the contact up to the last added motion [C]; NaN when the charge is not known.
  [[nodiscard]] double charge() const;

 private:
  TransferOptions options_;
  double contact_gap_;
  double charge_ = 0;
};

}  // namespace softland
