#include "model/closing/connection.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrators/quintic.h"
#include "integrators/roots.h"

namespace softland {

ConnectionCourse::ConnectionCourse(const Switch& model, ClosingObserver& observer)
    : observer_(observer), needs_all_(model.device().connection == Connection::all), plane_(model.contact_gap()) {
  followed_.reserve(model.contacts());
  for (std::size_t c = 0; c < model.contacts(); ++c)
    followed_.emplace_back(*this, observer.contact(c), model.contact_gap(c), model.device().contacts[c].connects);
  while (!followed_[deciding_].connects()) ++deciding_;
}

void ConnectionCourse::Followed::knot(const TrajectoryPoint& point) {
  if (own_ != nullptr) own_->knot(point);
  if (connects_) fresh.push_back(point);
}

void ConnectionCourse::Followed::touch(const Touch& touch) {
  if (own_ != nullptr) own_->touch(touch);
  if (connects_) connection_.touches_.take(touch);
}

// Returns the motion of a contact at a time between two knots (points of the simulated motion). The position is the quintic
// with the positions, velocities and accelerations of both knots; the force is linear in time.
TrajectoryPoint ConnectionCourse::Followed::at(double time) const {
  const TrajectoryPoint* from = &*last;
  for (const TrajectoryPoint& to : fresh) {
    if (time == to.time) return to;
    if (time < to.time) {
      if (time == from->time) return *from;
      const Quintic curve(from->time, from->position, from->velocity, from->acceleration, to.time, to.position, to.velocity,
                          to.acceleration);
      return {.time = time,
              .position = curve.position(time),
              .velocity = curve.velocity(time),
              .acceleration = curve.acceleration(time),
              .contact_force = std::lerp(from->contact_force, to.contact_force, (time - from->time) / (to.time - from->time))};
    }
    from = &to;
  }
  return *from;
}

std::size_t ConnectionCourse::decides(double time, std::size_t present) const {
  std::size_t best = present;
  for (std::size_t c = 0; c < followed_.size(); ++c) {
    if (!followed_[c].connects()) continue;
    const double here = followed_[c].separation(time), there = followed_[best].separation(time);
    if (needs_all_ ? here > there : here < there) best = c;
  }
  return best;
}

void ConnectionCourse::hand_over() {
  const Followed& any = followed_[deciding_];
  if (any.fresh.empty()) return;
  // At the first point of the run, and at jumps of velocity or acceleration (two points of equal time), every contact has a new
  // point. Pass on these points at once: there is no motion to interpolate before them.
  while (!any.fresh.empty() && (!any.last || any.fresh.front().time == any.last->time)) {
    for (Followed& c : followed_) {
      if (!c.connects()) continue;
      c.last = c.fresh.front();
      c.fresh.erase(c.fresh.begin());
    }
    here_ = any.last->time;
    deciding_ = decides(here_, deciding_);
    tell(here_);
  }
  std::vector<double> times;
  for (const Followed& c : followed_)
    for (const TrajectoryPoint& p : c.fresh) times.push_back(p.time);
  std::ranges::sort(times);
  times.erase(std::ranges::unique(times).begin(), times.end());
  for (const double time : times) follow_to(time);
  for (Followed& c : followed_) {
    if (c.fresh.empty()) continue;
    c.last = c.fresh.back();
    c.fresh.clear();
  }
}

void ConnectionCourse::follow_to(double time) {
  const std::size_t next = decides(time, deciding_);
  if (next != deciding_) {
    const auto ahead = [&](double t) { return followed_[next].separation(t) - followed_[deciding_].separation(t); };
    const double from = ahead(here_), to = ahead(time);
    const double change = from == 0 || from * to > 0 ? here_ : bracketed_zero(ahead, here_, time);
    if (change > here_) tell(change);
    deciding_ = next;
    tell(change);
  }
  here_ = time;
  tell(time);
}

void ConnectionCourse::tell(double time) {
  constexpr double on_the_plane = 1e-12;  // separation below which the connection counts as closed, relative to the contact gap
  const Followed& decisive = followed_[deciding_];
  TrajectoryPoint point = decisive.at(time);
  const double separation = decisive.gap() - point.position;
  point.position = plane_ - separation;
  for (const Followed& c : followed_) {
    if (!c.connects()) continue;
    const double force = c.at(time).contact_force;
    point.contact_force = needs_all_ ? std::min(point.contact_force, force) : std::max(point.contact_force, force);
  }
  observer_.knot(point);
  const bool closed = separation <= on_the_plane * decisive.gap();
  if (closed) {
    if (!is_closed_) {
      if (const std::optional<Touch> before = touches_.close(time, std::abs(point.velocity))) observer_.touch(*before);
    }
    last_closed_ = time;
  } else if (is_closed_) {
    touches_.open(last_closed_);
  }
  is_closed_ = closed;
}

void ConnectionCourse::finish() {
  if (const std::optional<Touch> last = touches_.finish()) observer_.touch(*last);
}

void ConnectionTouches::take(const Touch& touch) {
  first_touch_.take(touch.begin, touch.impact_velocity);
  pending_.add(touch);
}

std::optional<Touch> ConnectionTouches::close(double time, double speed) {
  std::optional<Touch> before = finish();
  touch_ = Touch{.begin = time, .end = std::numeric_limits<double>::quiet_NaN(), .impact_velocity = speed};
  return before;
}

std::optional<Touch> ConnectionTouches::finish() {
  if (!touch_) return std::nullopt;
  std::optional<Touch> last = std::exchange(touch_, std::nullopt);
  last->add(pending_);
  pending_ = {};
  return last;
}

}  // namespace softland
