// Events of the contact point within a step: times at which the contact law, and so the equations of motion, change.
#pragma once

#include <optional>

#include "model/closing/contact_phase.h"
#include "model/closing/step_motion.h"

namespace softland {

/// A change of a contact law's branch (phase): the contact point crosses an edge (the position at which the branch ends), or
/// turns back while it loads a contact with memory; in the latter case `edge` is empty.
struct Event {
  double time = 0;  ///< time of the change of the contact law [s]
  std::optional<Edge> edge;
  std::size_t contact = 0;  ///< number of the contact whose law changes
};

/// Returns the first change of a contact law's branch in (from, to]; none without a change. `from` and `to` are the ends of a
/// piece of an integration step.
[[nodiscard]] std::optional<Event> first_event(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to,
                                               const ContactPhase& phase);

}  // namespace softland
