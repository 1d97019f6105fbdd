#include "studies/closing/judged_by_modes.h"

#include "studies/closing/by_modes.h"
#include "studies/closing/closed_state.h"
#include "studies/closing/hold.h"
#include "studies/closing/open_state.h"

namespace softland {

void judge_opening_with_more_modes(Closing& c, const PreparedScene& prepared, const std::vector<Signal>& signals) {
  const ModeLadder ladder(prepared);
  if (!ladder.exists()) return;
  if (stability(ladder, closed_equilibria(ladder, values_before(signals))).stable == false) {
    c.metrics = {};
    c.metrics.status = Status::collapsed_at_rest;
    c.errors = {};
    c.trajectory.status = Status::collapsed_at_rest;
    c.trajectory.message =
        "whether the switch has a stable closed state to begin in depends on the number of modes: more of them have none";
  } else if (c.metrics.status == Status::done && open_stability(ladder, hold_levels(signals)).flips) {
    c.metrics.status = Status::not_settled;
    c.is_pulled_through = true;
    c.warnings.emplace_back(
        "whether the switch stays open depends on the number of modes: under its hold levels it has no stable open equilibrium "
        "with more of them");
  }
}

void judge_with_more_modes(Closing& c, const PreparedScene& prepared, const std::vector<Signal>& signals) {
  Metrics& m = c.metrics;
  if (m.status == Status::open) {
    const StabilityByModes open = open_stability(ModeLadder(prepared), hold_levels(signals));
    if (!open.flips) return;
    m.status = Status::no_contact;
    c.warnings.push_back(
        "whether the switch stays open depends on the number of modes: under its hold levels it has no stable open "
        "equilibrium with more of them");
    return;
  }
  if (m.status != Status::done || !m.settled || !hold_of(prepared.model, signals).closed) return;
  const ModeLadder ladder(prepared);
  if (stability(ladder, closed_equilibria(ladder, hold_levels(signals))).stable != false) return;
  c.trajectory.is_held = m.settled = false;
  m.status = Status::not_settled;
  c.trajectory.hold_force = Metrics::unset;
  for (double Metrics::*const figure : {&Metrics::permanent_contact_time, &Metrics::bounce_time, &Metrics::hold_force})
    m.*figure = c.errors[figure] = Metrics::unset;
}

}  // namespace softland
