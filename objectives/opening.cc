#include "objectives/opening.h"

#include <algorithm>
#include <cmath>

#include "integrators/roots.h"

namespace softland {

void BandFollower::follow(const TrajectoryPoint& a, const TrajectoryPoint& b) {
  if (!(b.time > a.time)) return;
  const Quintic curve(a.time, a.position, a.velocity, a.acceleration, b.time, b.position, b.velocity, b.acceleration);
  if (band_.drives_end > a.time && band_.drives_end < b.time) reach_end_of_drives(curve.position(band_.drives_end));
  double from = a.time, at_from = a.position;
  const auto advance = [&](double to, double at_to) {
    leave_band(curve, from, at_from, to, at_to);
    from = to, at_from = at_to;
  };
  reach(a.time, a.position);
  for (const double turn : curve.turns()) {
    reach(turn, curve.position(turn));
    advance(turn, curve.position(turn));
  }
  reach(b.time, b.position);
  advance(b.time, b.position);
}

BandFigures BandFollower::figures() const {
  return {
      .settled_from = inside_ ? settled_from_ : OpeningFigures::unset, .below = below_, .above = above_, .residual = residual_};
}

void BandFollower::reach(double time, double position) {
  below_ = std::max(below_, band_.open_position - position);
  above_ = std::max(above_, position - band_.open_position);
  if (time >= band_.drives_end) reach_end_of_drives(position);
}

void BandFollower::reach_end_of_drives(double position) {
  residual_ = std::fmax(residual_, std::abs(position - band_.open_position));
}

// Updates the settling time with a monotone part of the contact point's motion, which may cross the whole band about the open
// position. If the part ends in the band, stores the time at which it enters the band.
void BandFollower::leave_band(const Quintic& curve, double from, double at_from, double to, double at_to) {
  const double middle = band_.open_position;
  const bool begins_inside = std::abs(at_from - middle) <= band_.width;
  inside_ = std::abs(at_to - middle) <= band_.width;
  if (!inside_ || begins_inside) return;
  const double edge = at_from > middle ? middle + band_.width : middle - band_.width;
  settled_from_ = bracketed_zero([&](double t) { return curve.position(t) - edge; }, from, to);
}

BandFigures band_figures(const Trajectory& course, const OpeningBand& band) {
  BandFollower open(band);
  for (std::size_t i = 1; i < course.points.size(); ++i) open.follow(course.points[i - 1], course.points[i]);
  return open.figures();
}

CommandedOpening::CommandedOpening(const OpeningCommand& command, double contact_gap, double significant_rebound)
    : command_(command),
      contact_gap_(contact_gap),
      significant_(significant_rebound),
      band_({.open_position = command.open_position, .width = settled_band * contact_gap}) {}

void CommandedOpening::follow(const TrajectoryPoint& a, const TrajectoryPoint& b) {
  if (!(b.time > a.time)) return;
  band_.follow(a, b);
  const Quintic curve(a.time, a.position, a.velocity, a.acceleration, b.time, b.position, b.velocity, b.acceleration);
  double from = a.position;
  const auto advance = [&](double to) {
    if (to > from) nearest_ = std::fmax(nearest_, to);  // the contact point moves back towards the contact
    if (to >= contact_gap_) nearest_ = OpeningFigures::unset;
    from = to;
  };
  for (const double turn : curve.turns()) advance(curve.position(turn));
  advance(b.position);
}

void CommandedOpening::bounce(const Rebound& rebound) {
  separated_ += rebound.end - std::max(rebound.begin, command_.time);
  if (!(rebound.height > significant_)) return;
  ++bounces_;
  highest_ = std::max(highest_, rebound.height);
}

OpeningOnCommand CommandedOpening::figures(const std::optional<Rebound>& under_way, const TrajectoryPoint& last) const {
  OpeningOnCommand f{.command = command_.time};
  if (!under_way) return f;
  f.opening_time = std::max(0.0, under_way->begin - command_.time);
  f.bounces = bounces_;
  f.separated = separated_;
  f.highest_bounce = highest_;
  f.least_gap = contact_gap_ - (std::isnan(nearest_) ? last.position : nearest_);
  if (!std::isfinite(command_.open_position)) return f;
  const BandFigures band = band_.figures();
  f.overshoot = band.below;
  if (std::isfinite(band.settled_from)) f.settling_time = std::max(0.0, band.settled_from - command_.time);
  return f;
}

OpeningFigures release_figures(const Trajectory& opening, const OpeningBand& band) {
  OpeningFigures figures{.status = opening.status};
  if (opening.status != Status::done) return figures;
  const BandFigures course = band_figures(opening, band);
  if (!opening.touches.empty()) {
    figures.release_time = opening.touches.back().end;
    figures.touches = static_cast<int>(opening.touches.size()) - 1;
  }
  const bool open = std::isfinite(figures.release_time);
  figures.overshoot = course.below;
  if (open) {
    figures.residual_vibration = course.residual;
    figures.settling_time = course.settled_from;
  }
  if (!std::isfinite(figures.settling_time)) figures.status = Status::not_settled;
  return figures;
}

}  // namespace softland
