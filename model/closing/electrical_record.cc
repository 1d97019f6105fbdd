#include "model/closing/electrical_record.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "integrators/roots.h"
#include "model/contact/contact_law.h"

namespace softland {

ElectricalRecord::ElectricalRecord(const Switch& model, ClosingObserver& observer)
    : model_(model),
      observer_(observer),
      closing_(model.device().electrical),
      followed_(model.contacts() > 1 ? 1 + model.contacts() : 1) {
  for (std::size_t c = 0; c < model.contacts(); ++c) resistances_.push_back(contact_resistance(model.device(), c));
}

ElectricalRecord::Instant ElectricalRecord::instant(std::size_t c, const ContactInStep& contact, double time) const {
  const ContactLaw& law = model_.contact(c);
  const TipMotion tip(contact.motion, contact.from, contact.to);
  Instant now{.interference = tip.position(time) - model_.contact_gap(c)};
  if (model_.has_spread_contact(c)) {
    const double length = contact.to.time - contact.from.time, share = length > 0 ? (time - contact.from.time) / length : 1;
    now.force = std::lerp(contact.from.contact_force, contact.to.contact_force, share);
  } else {
    // Where the integrator does not restart at contact, a law without memory may start or stop acting within the step; the
    // position alone says whether it acts. A law with memory keeps its state, since its branch changes between steps only.
    const ContactState state = has_memory(law) ? contact.law : ContactState(now.interference > -model_.contact_reach(c));
    if (state.active) now.force = contact_force(law, now.interference, state, tip.velocity(time));
  }
  if (closing_.resistance > 0) now.conductance = resistances_[c].conductance(now.interference, now.force);
  return now;
}

ElectricalRecord::Instant ElectricalRecord::connected(std::span<const Instant> contacts) const {
  const Device& device = model_.device();
  const bool needs_all = device.connection == Connection::all;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Instant all{.interference = needs_all ? infinity : -infinity, .force = needs_all ? infinity : -infinity};
  std::vector<double> conductances;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    conductances.push_back(contacts[c].conductance);
    if (!device.contacts[c].connects) continue;
    for (double Instant::*const part : {&Instant::interference, &Instant::force})
      all.*part = needs_all ? std::min(all.*part, contacts[c].*part) : std::max(all.*part, contacts[c].*part);
  }
  if (closing_.resistance > 0) all.conductance = connection_conductance(device, conductances);
  return all;
}

// Returns how far the connection is from electrical opening: a number that is positive while it is electrically closed. Only
// the sign has a meaning.
double ElectricalRecord::margin(const Instant& now) const {
  double least = std::numeric_limits<double>::infinity();
  if (closing_.force >= 0) least = now.force - closing_.force;
  if (closing_.resistance > 0) least = std::min(least, now.conductance * closing_.resistance - 1);
  return is_of_touch() ? now.interference : least;
}

void ElectricalRecord::take(double begin, double end, std::span<const ContactInStep> contacts) {
  if (!(end > begin)) return;
  const bool can_close =
      std::ranges::any_of(contacts, [](const ContactInStep& one) { return one.is_in_contact || one.law.active; });
  if (!can_close) {
    for (Followed& followed : followed_) set(followed, false, begin);
    return;
  }
  std::vector<double> times{begin};
  for (const ContactInStep& c : contacts) {
    const TipMotion tip(c.motion, c.from, c.to);
    const auto velocity = [&](double time) { return tip.velocity(time); };
    double last = begin;
    for (int k = 1; k <= c.motion.pieces(); ++k) {
      const double next = k < c.motion.pieces() ? begin + (end - begin) * k / c.motion.pieces() : end;
      if (velocity(last) * velocity(next) < 0) times.push_back(bracketed_zero(velocity, last, next));
      times.push_back(next);
      last = next;
    }
  }
  std::ranges::sort(times);
  times.erase(std::ranges::unique(times).begin(), times.end());
  for (std::size_t f = 0; f < followed_.size(); ++f) {
    const auto at = [&](double time) {
      if (f > 0) return margin(instant(f - 1, contacts[f - 1], time));
      std::vector<Instant> all;
      for (std::size_t c = 0; c < contacts.size(); ++c) all.push_back(instant(c, contacts[c], time));
      return margin(all.size() > 1 ? connected(all) : all.front());
    };
    for (std::size_t k = 0; k + 1 < times.size(); ++k) follow(followed_[f], at, times[k], times[k + 1]);
  }
}

void ElectricalRecord::take_rest(double begin, double end, const std::function<double(double)>& force) {
  if (!(end > begin)) return;
  const auto at = [&](double time) {
    Instant now{.interference = 0, .force = force(time)};
    if (closing_.resistance > 0) now.conductance = resistances_.front().conductance(now.interference, now.force);
    return is_of_touch() ? 1.0 : margin(now);
  };
  follow(followed_.front(), at, begin, end);
}

// Records the changes of the electrical state in an interval. `at` returns the margin to electrical opening at a time, positive
// while closed. If it has the same sign at both ends of the interval, but its slopes there point towards zero, its extremum is
// searched: the sign may change twice.
template <class Margin>
void ElectricalRecord::follow(Followed& followed, const Margin& at, double begin, double end) const {
  // Share of the interval over which the slope of the margin at an end is measured. Closer to the end, rounding would hide the
  // change of a force that grows with a high power of the interference.
  constexpr double beside = 1e-3;
  constexpr int bits = 30;
  const double from = at(begin), to = at(end);
  if ((from > 0) == (to > 0)) {
    const double towards = from > 0 ? 1 : -1;
    const double after = at(begin + beside * (end - begin)) - from, before = at(end - beside * (end - begin)) - to;
    if (towards * after < 0 && towards * before < 0) {
      // The tolerance of the minimiser has an absolute part, too large for times: its argument is a share of the interval.
      const auto time = [&](double share) { return std::lerp(begin, end, share); };
      const double turn = time(
          boost::math::tools::brent_find_minima([&](double share) { return towards * at(time(share)); }, 0.0, 1.0, bits).first);
      const double there = at(turn);
      follow_path(followed, at, begin, from, turn, there);
      return follow_path(followed, at, turn, there, end, to);
    }
  }
  follow_path(followed, at, begin, from, end, to);
}

// Records an interval without an inner extremum of `at`, the margin to electrical opening: the margin changes sign at most
// once.
template <class Margin>
void ElectricalRecord::follow_path(Followed& followed, const Margin& at, double begin, double from, double end, double to) const {
  set(followed, from > 0, begin);
  if ((to > 0) != (from > 0)) set(followed, to > 0, bracketed_zero(at, begin, end));
}

void ElectricalRecord::set(Followed& followed, bool is_closed, double time) const {
  if (followed.is_closed == is_closed) return;
  followed.is_closed = is_closed;
  if (observer_.follows_state()) tell(followed, time);
  if (is_finished_) return;
  if (!is_closed) {
    followed.opened_at = time;
    return;
  }
  ElectricalOutcome& outcome = followed.outcome;
  if (std::isnan(outcome.first_closed)) {
    outcome.first_closed = outcome.closed_from = time;
  } else if (counts(followed, time)) {
    ++outcome.openings;
    outcome.closed_from = time;
  }
}

void ElectricalRecord::tell(const Followed& followed, double time) const {
  const auto place = static_cast<std::size_t>(&followed - followed_.data());
  observer_.state(place > 0 ? std::optional(place - 1) : std::nullopt, followed.is_closed, time);
}

bool ElectricalRecord::counts(const Followed& followed, double until) const {
  constexpr double rounding = 1e-12;  // shorter openings, relative to the time, are rounding errors between two steps
  return until - followed.opened_at > std::max(closing_.shortest_opening(), rounding * until);
}

void ElectricalRecord::finish(double time) {
  is_finished_ = true;
  for (Followed& followed : followed_) {
    if (followed.is_closed || std::isnan(followed.outcome.first_closed)) continue;
    if (counts(followed, time)) ++followed.outcome.openings;
    followed.outcome.closed_from = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace softland
