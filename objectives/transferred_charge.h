// The charge that a contact passes while it is made, and while it breaks. Its force is then below the steady force, and the
// current flows through few small spots, which it can melt. Material is transferred in proportion to that charge.
//
//   i = V / (R_L + R),   Q = integral of i dt over the times in touch at which the contact force is below F_s
//
// V is the voltage of the source [V] and R_L the resistance in series with it [Ohm] of the load circuit. R is the resistance of
// the contact [Ohm]; it counts as 0 where it is not known, and the charge is then at most Q. F_s is the steady force [N].
//
// Limits: the load is a resistance, without inductance or capacitance, which add arcs and surges; nothing flows through a gap;
// the contact does not heat. The number compares waveforms on one contact. How much material it moves depends on the metals,
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
  /// F_s [N]; NaN where it is not known, and then the charge is not known either.
  double light_below = std::numeric_limits<double>::quiet_NaN();
  std::optional<ContactResistance> contact = {};  ///< contact resistance; neglected where absent
};

/// Gathers the charge while a run goes on.
class TransferredCharge {
 public:
  /// `contact_gap` [m]
  TransferredCharge(const TransferOptions& options, double contact_gap) : options_(options), contact_gap_(contact_gap) {}
  /// Takes the motion between two knots, over which the contact is open or in touch throughout. Its force is taken as linear.
  void follow(const TrajectoryPoint& from, const TrajectoryPoint& to);
  /// Returns the charge so far [C]; NaN where it is not known.
  [[nodiscard]] double charge() const;

 private:
  TransferOptions options_;
  double contact_gap_;
  double charge_ = 0;
};

}  // namespace softland
