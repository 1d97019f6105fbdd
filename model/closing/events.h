// Events of the contact point within a step: times at which the equations of motion change.
#pragma once

#include <optional>

#include "model/closing/contact_phase.h"
#include "model/closing/step_motion.h"

namespace softland {

/// The contact point crosses the edge of its contact phase, or, without an edge, turns back while loading a contact with
/// memory.
struct Event {
  double time = 0;  ///< [s]
  std::optional<Edge> edge;
  std::size_t contact = 0;  ///< number of the contact
};

/// Returns the first event in (from, to] of a piece of a step.
[[nodiscard]] std::optional<Event> first_event(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to,
                                               const ContactPhase& phase);

}  // namespace softland
