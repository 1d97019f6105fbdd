// The charge that a contact passes while it is made, and while it breaks: its force is light then, below the steady force, and
// the current goes through few small spots, which it can melt. Material is transferred in proportion to that charge.
//
//   i = V / (R_L + R),   Q = integral of i dt over the times in touch at which the contact force is below F_s
//
// V voltage of the source [V] and R_L resistance in series with it [Ohm] of the load circuit; R resistance of the contact where
// it is known, and there is one [Ohm], else 0: the charge is then at most Q. F_s steady force [N].
//
// Limits: the load is a resistance, without inductance or capacitance, which add arcs and surges; nothing flows through a gap;
// the contact does not heat. The number compares waveforms on one contact; how much material it moves depends on the metals, and
// is to be measured. Sources: R. Holm, Electric Contacts (1967), on the transfer of material; T. G. Bull & J. W. McBride,
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
  double light_below = std::numeric_limits<double>::quiet_NaN();  ///< F_s [N]; NaN: it is not known, nor is the charge
  std::optional<ContactResistance> contact = {};                  ///< none: its resistance is neglected
};

/// Gathers the charge while a run goes on.
class TransferredCharge {
 public:
  /// `contact_gap` [m]
  TransferredCharge(const TransferOptions& options, double contact_gap) : options_(options), contact_gap_(contact_gap) {}
  /// Takes the motion between two knots, over which the contact is open or in touch throughout. Its force goes on a line.
  void follow(const TrajectoryPoint& from, const TrajectoryPoint& to);
  /// The charge so far [C]; NaN where it is not known.
  [[nodiscard]] double charge() const;

 private:
  TransferOptions options_;
  double contact_gap_;
  double charge_ = 0;
};

}  // namespace softland
