// The charge that a contact passes while it closes, and while it opens. The contact force is then below the steady force, and
// the current flows through few small spots, which it can melt. The transferred material is proportional to this charge.
//
//   i = V / (R_L + R),   Q = integral of i dt over the times in touch at which the contact force is below F_s
//
// V is the voltage of the source [V] and R_L the resistance in series with it [Ohm] of the load circuit. R is the resistance of
// the contact [Ohm]; when R is not known it counts as 0, and Q is an upper bound of the charge. F_s is the steady force [N].
//
// Limits: the load is a resistance, without inductance or capacitance, which add arcs and surges; nothing flows through a gap;
// the contact does not heat. Q compares waveforms on one contact. How much material it moves depends on the metals, and must be
// measured. Sources: R. Holm, Electric Contacts (1967), on the transfer of material; T. G. Bull & J. W. McBride,
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
  /// F_s [N]; the charge is NaN when F_s is NaN, not known.
  double light_below = std::numeric_limits<double>::quiet_NaN();
  std::optional<ContactResistance> contact = {};  ///< contact resistance; neglected where absent
};

/// Computes the charge during a run.
class TransferredCharge {
 public:
  /// `contact_gap` [m]
  TransferredCharge(const TransferOptions& options, double contact_gap) : options_(options), contact_gap_(contact_gap) {}
  /// Adds the motion between two knots, over which the contact is open or in touch throughout. The contact force between them
  /// is taken as linear.
  void follow(const TrajectoryPoint& from, const TrajectoryPoint& to);
  /// Returns the charge so far [C]; NaN when it is not known.
  [[nodiscard]] double charge() const;

 private:
  TransferOptions options_;
  double contact_gap_;
  double charge_ = 0;
};

}  // namespace softland
