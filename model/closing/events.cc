#include "model/closing/events.h"

namespace softland {
namespace {

// Returns the time in [from, to] at which the contact point first leaves the current branch of the contact law across `edge`,
// the position at which the branch ends. The motion is monotone between two successive turning points, so it crosses the edge
// at most once between them.
std::optional<double> crossing(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to, const Edge& edge) {
  const double side = edge.side;
  const Quintic::Bounds reached = tip.bounds();
  if (side > 0 ? reached.least >= edge.level : reached.most <= edge.level) return std::nullopt;
  const auto depth = [&](double t) { return side * (tip.position(t) - edge.level); };
  double inside = from.time;
  const auto leaves = [&](double t, double at) {
    if (at >= 0) inside = t;
    return at < 0;
  };
  const auto found = [&](double outside) {
    // Just after an event the contact point is on the edge of the new branch (depth 0). If the monotone motion from there to
    // `outside` leaves the branch, the branch ends at once: there is no change of sign to bracket.
    return depth(inside) > 0 ? bracketed_zero(depth, inside, outside) : inside;
  };
  for (const double turn : tip.turns()) {
    if (leaves(turn, depth(turn))) return found(turn);
  }
  if (leaves(to.time, side * (to.position - edge.level))) return found(to.time);
  return std::nullopt;
}

}  // namespace

std::optional<Event> first_event(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to,
                                 const ContactPhase& phase) {
  std::optional<Event> first;
  for (const Edge& edge : phase.edges()) {
    const std::optional<double> time = crossing(tip, from, to, edge);
    if (time && *time > 0 && !(first && first->time <= *time)) first = {.time = *time, .edge = edge};
  }
  if (phase.ends_at_turn() && to.velocity < 0) {
    const double time = from.velocity > 0 ? tip.turn() : from.time;
    if (!(first && first->time < time)) first = Event{.time = time, .edge = std::nullopt};
  }
  // Ignore a change of the contact law at time 0: nothing has moved yet.
  return first && first->time > 0 ? first : std::nullopt;
}

}  // namespace softland
