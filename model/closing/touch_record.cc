#include "model/closing/touch_record.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/contact/contact_law.h"
#include "model/contact/summit_pressure.h"

namespace softland {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// Returns the peak of the parabola through three equidistant values of a contact force.
double peak(double begin, double middle, double end) {
  const double bend = 2 * middle - begin - end;
  const bool inside = std::abs(end - begin) < 2 * bend;
  return inside ? middle + (end - begin) * (end - begin) / (8 * bend) : std::max({begin, middle, end});
}

}  // namespace

TouchRecord::TouchRecord(const Switch& model, std::size_t contact, const ContactPhase& phase, ClosingObserver& observer)
    : model_(model),
      contact_(contact),
      phase_(phase),
      observer_(observer),
      plane_(model.contact_gap(contact)),
      pressure_scale_(model.has_contact() ? summit_pressure_scale(model.device().contacts[contact]) : none),
      first_begin_(none) {}

void TouchRecord::begin(double time, double velocity) {
  if (count_ > 0) observer_.touch(touch_);
  touch_ = {.begin = time, .end = none, .impact_velocity = std::abs(velocity)};
  if (count_++ == 0) first_begin_ = time;
}

bool TouchRecord::note(const Event& event, const TrajectoryPoint& at) {
  const bool begins = !phase_.in_contact() && event.edge && event.edge->level == plane_;
  if (begins) {
    begin(at.time, at.velocity);
  } else if (phase_.in_contact() && event.edge && event.edge->next == phase_.above()) {
    end(at.time);
  }
  return begins;
}

void TouchRecord::take(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to) {
  if (!phase_.in_contact()) return;
  const double deepest = from.velocity > 0 && to.velocity < 0 ? tip.position(tip.turn()) : std::max(from.position, to.position);
  const double d = deepest - plane_;
  if (phase_.law().active && !model_.has_spread_contact(contact_)) {
    touch_.peak_force = std::max(touch_.peak_force, contact_force(model_.contact(contact_), d, phase_.law(), 0));
    touch_.peak_energy = std::max(touch_.peak_energy, stored_energy(model_.contact(contact_), d, phase_.law()));
  }
  deepest_ = std::max(deepest_, d);
  if (pressure_scale_ > 0) touch_.pressure = std::fmax(touch_.pressure, pressure_scale_ * std::sqrt(std::max(d, 0.0)));
}

void TouchRecord::take(const Knot& begin, const Knot& end, StepMotion& step) {
  if (!phase_.in_contact() || !(model_.has_damped_contact() || model_.has_spread_contact(contact_))) return;
  const std::vector<double>& middle = step.halfway();
  const auto push = [&](const std::vector<double>& y) {
    return model_.contact_push(y.data(), y.data() + model_.modes(), phase_.law(), contact_);
  };
  touch_.peak_force = std::max(touch_.peak_force, peak(push(begin.state), push(middle), push(end.state)));
  if (!model_.has_spread_contact(contact_)) return;
  const auto stored = [&](const std::vector<double>& y) { return model_.contact_stored(y.data(), phase_.law(), contact_); };
  touch_.peak_energy = std::max(touch_.peak_energy, peak(stored(begin.state), stored(middle), stored(end.state)));
}

void TouchRecord::finish() {
  if (count_ > 0) observer_.touch(touch_);
}

}  // namespace softland
