#include "model/closing/force_record.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "integrators/roots.h"
#include "model/contact/contact_law.h"

namespace softland {
namespace {

bool rises_with_depth(const Switch& model, std::size_t contact) {
  if (!model.has_contact()) return true;
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.grows_with_depth; }) return law.grows_with_depth;
        return false;
      },
      model.contact(contact));
}

}  // namespace

ForceRecord::ForceRecord(const Switch& model, double threshold, std::size_t contact)
    : model_(model), contact_(contact), threshold_(threshold), rises_with_depth_(rises_with_depth(model, contact)) {}

// Adds an interval to the record, for any contact law. If the contact force rises from both ends of the interval towards the
// middle, or falls from both ends, the interval is divided at the extremum of the force.
template <class Force>
void ForceRecord::follow_path(const Force& force, double begin, double from, double end, double to) {
  constexpr double beside = 1e-6;  // the slope at an end is taken over this share of the interval
  constexpr int bits = 30;
  if (rises_with_depth_) return follow(force, begin, from, end, to);
  const double after = force(begin + beside * (end - begin)) - from, before = force(end - beside * (end - begin)) - to;
  if (!(after * before > 0)) return follow(force, begin, from, end, to);
  const double sign = after < 0 ? 1 : -1;
  // The tolerance of the minimiser has an absolute part, too large for times: its argument is a share of the interval.
  const auto at = [&](double share) { return std::lerp(begin, end, share); };
  const double turn =
      at(boost::math::tools::brent_find_minima([&](double share) { return sign * force(at(share)); }, 0.0, 1.0, bits).first);
  const double there = force(turn);
  follow(force, begin, from, turn, there);
  follow(force, turn, there, end, to);
}

// Adds an interval in which the contact force only rises or only falls: updates settling time, largest and least force.
template <class Force>
void ForceRecord::follow(const Force& force, double begin, double from, double end, double to) {
  has_fallen_ = has_fallen_ || (has_risen_ && to < from);
  has_risen_ = has_risen_ || to > from;
  double& least = outcome_.least_force_after_touch;
  if (has_fallen_) least = std::min({least, from, to});
  largest_ = std::max({largest_, from, to});
  last_ = to;
  double& steady = outcome_.steady_force_time;
  if (to < threshold_) {
    steady = std::numeric_limits<double>::quiet_NaN();
  } else if (to >= threshold_ && std::isnan(steady)) {
    const auto above = [&](double t) { return force(t) - threshold_; };
    steady = from < threshold_ ? bracketed_zero(above, begin, end) : begin;
  }
}

ForceOutcome ForceRecord::outcome() const {
  ForceOutcome result = outcome_;
  if (!has_fallen_) result.least_force_after_touch = last_;
  // When a contact opens, rounding of its position may leave a tiny force, which counts as 0.
  constexpr double rounding = 1e-12;
  if (std::abs(result.least_force_after_touch) < rounding * largest_) result.least_force_after_touch = 0;
  return result;
}

void ForceRecord::take(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to, const ContactState& law) {
  if (!law.active || model_.has_spread_contact(contact_)) return take_line(from, to);
  const double plane = model_.contact_gap(contact_);
  const auto force = [&](double t) {
    return contact_force(model_.contact(contact_), tip.position(t) - plane, law, tip.velocity(t));
  };
  if (!(from.velocity * to.velocity < 0)) return follow_path(force, from.time, from.contact_force, to.time, to.contact_force);
  const double turn = tip.turn(), there = force(turn);
  follow_path(force, from.time, from.contact_force, turn, there);
  follow_path(force, turn, there, to.time, to.contact_force);
}

void ForceRecord::take_line(const TrajectoryPoint& from, const TrajectoryPoint& to) {
  const auto force = [&](double t) {
    return std::lerp(from.contact_force, to.contact_force, (t - from.time) / (to.time - from.time));
  };
  follow(force, from.time, from.contact_force, to.time, to.contact_force);
}

ForceOutcome force_of_connection(const Device& device, std::span<const ForceOutcome> contacts) {
  if (contacts.size() == 1) return contacts.front();
  // A connection of all contacts settles with the last of them, and its least force is the smallest of theirs. Each result is
  // NaN if that of one contact is NaN (unknown).
  const auto later = [](double a, double b) { return std::isnan(a) || a > b ? a : b; };
  const auto less = [](double a, double b) { return std::isnan(a) || a < b ? a : b; };
  const bool needs_all = device.connection == Connection::all;
  std::optional<ForceOutcome> all;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!device.contacts[c].connects) continue;
    const ForceOutcome& own = contacts[c];
    if (!all) all = own;
    double& steady = all->steady_force_time;
    steady = needs_all ? later(steady, own.steady_force_time) : std::fmin(steady, own.steady_force_time);
    double& least = all->least_force_after_touch;
    least = needs_all ? less(least, own.least_force_after_touch) : std::fmax(least, own.least_force_after_touch);
  }
  return *all;
}

}  // namespace softland
