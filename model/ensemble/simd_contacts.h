// The contacts in one SIMD lane: when a contact law changes within a step, and what is recorded of touches and rebounds.
#pragma once

#include <cstddef>

#include "model/ensemble/simd_lanes.h"

namespace softland::simd {

template <class V, class Laws, int room>
auto SimdClosings<V, Laws, room>::quintic_path(Number c, int k, std::size_t l, double length) const -> QuinticPath {
  const double h = length / pieces;
  const double p0 = knot_p_[c][k][l], p1 = knot_p_[c][k + 1][l], d = p1 - p0;
  const double v0 = knot_s_[c][k][l] * h, v1 = knot_s_[c][k + 1][l] * h;
  const double a0 = knot_c_[c][k][l] * h * h, a1 = knot_c_[c][k + 1][l] * h * h;
  return {{p0, v0, a0 / 2, 10 * d - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1, -15 * d + 8 * v0 + 7 * v1 + 1.5 * a0 - a1,
           6 * d - 3 * (v0 + v1) - 0.5 * (a0 - a1)}};
}

template <class V, class Laws, int room>
double SimdClosings<V, Laws, room>::crossing(Number c, std::size_t l, double length, double side, double level) const {
  bool inside = side * (position_[c][l] - level) > 0;
  for (int k = 0; k < pieces; ++k) {
    const double p1 = knot_p_[c][k + 1][l], v0 = knot_s_[c][k][l], v1 = knot_s_[c][k + 1][l];
    const bool ends_inside = side * (p1 - level) >= 0;
    if (side * v0 < 0 && side * v1 > 0 && inside) {  // the point moves outwards, then back: was it outside in between?
      const QuinticPath path = quintic_path(c, k, l, length);
      const double turn = path.turn();
      if (side * (path.position(turn) - level) < 0) return (k + path.meets(level, 0, turn)) / pieces;
    } else if (!ends_inside) {
      const QuinticPath path = quintic_path(c, k, l, length);
      if (inside) return (k + path.meets(level, 0, 1)) / pieces;
      if (side * v0 > 0 && side * v1 < 0) {  // the point moves inwards from the boundary, then back out
        const double turn = path.turn();
        if (side * (path.position(turn) - level) > 0) return (k + path.meets(level, turn, 1)) / pieces;
      }
      return (k + 1.0) / pieces;
    }
    inside = inside || ends_inside;
  }
  return 2;
}

template <class V, class Laws, int room>
double SimdClosings<V, Laws, room>::phase_end(Number c, std::size_t l, double length) {
  Followed& one = lane_[l].contact[c];
  const double by_low = one.low > -infinite ? crossing(c, l, length, 1, one.low) : 2;
  const double by_high = one.high < infinite ? crossing(c, l, length, -1, one.high) : 2;
  const double by_turn = loading_[c][l] ? turning(c, l, length) : 2;
  one.to_turn = by_turn < by_low && by_turn < by_high;
  one.level = by_low <= by_high ? one.low : one.high;
  const double edge = by_low < by_high ? by_low : by_high;
  return edge < by_turn ? edge : by_turn;
}

template <class V, class Laws, int room>
double SimdClosings<V, Laws, room>::turning(Number c, std::size_t l, double length) const {
  for (int k = 0; k < pieces; ++k) {
    if (!(knot_s_[c][k + 1][l] < 0)) continue;
    return knot_s_[c][k][l] > 0 ? (k + quintic_path(c, k, l, length).turn()) / pieces : static_cast<double>(k) / pieces;
  }
  return 2;
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::update_plastic_depth(Number c, std::size_t l, double length) {
  Lane& lane = lane_[l];
  Followed& one = lane.contact[c];
  const double side = one.touching ? 1 : -1;
  for (int k = 0; k < pieces; ++k) {
    const double begin = side * knot_s_[c][k][l], end = side * knot_s_[c][k + 1][l];
    if (begin > 0 && end < 0) {
      const QuinticPath path = quintic_path(c, k, l, length);
      const double far = side * (path.position(path.turn()) - plane_[c][l]);
      if (far > one.extreme) one.extreme = far;
      if constexpr (has_several) {
        if (!one.touching && layout_.contact[c].connects && layout_.needs_all) rise_to(lane, far);
      }
    } else if (one.touching && begin < 0 && end > 0) {
      const QuinticPath path = quintic_path(c, k, l, length);
      const double depth = path.position(path.turn()) - plane_[c][l], carried = depth_of_force(c, l, depth);
      if (carried < one.least) one.least = carried;
      if (depth < steady_[c][l] - plane_[c][l]) rise(c, l, length);
    }
  }
}

template <class V, class Laws, int room>
double SimdClosings<V, Laws, room>::depth_of_force([[maybe_unused]] Number c, [[maybe_unused]] std::size_t l,
                                                   double depth) const {
  if constexpr (Contact::has_memory) {
    const Followed& one = lane_[l].contact[c];
    if (!remembers(c) || !one.touching) return depth;
    if (one.in_dent) return 0;
    if (one.unloading) {
      const LaneContactNumbers& numbers = lane_[l].closing->numbers->contact[c];
      return (depth - shift_[c][l]) * (numbers.unloading_stiffness / numbers.loading_stiffness);
    }
  }
  return depth;
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::finish_force(Number c, std::size_t l) {
  const Followed& one = lane_[l].contact[c];
  LaneClosing& closing = *lane_[l].closing;
  const double depth = one.touching ? depth_of_force(c, l, position_[c][l] - plane_[c][l]) : 0;
  closing.force[c].steady_force_time = position_[c][l] < steady_[c][l] ? nothing : one.steady;
  closing.least_depth[c] = !one.touched ? nothing : depth < one.least ? depth : one.least;
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::rise(Number c, std::size_t l, double length) {
  const double level = steady_[c][l];
  const auto reach = [&](int k, double share) {
    lane_[l].contact[c].steady = (t_[l] - length) + length * ((k + share) / pieces);
  };
  for (int k = 0; k < pieces; ++k) {
    const double p0 = knot_p_[c][k][l], p1 = knot_p_[c][k + 1][l];
    if (!(p1 >= level)) continue;
    if (p0 < level) {
      reach(k, quintic_path(c, k, l, length).meets(level, 0, 1));
    } else if (knot_s_[c][k][l] < 0 && knot_s_[c][k + 1][l] > 0) {
      const QuinticPath path = quintic_path(c, k, l, length);
      const double turn = path.turn();
      if (path.position(turn) < level) reach(k, path.meets(level, turn, 1));
    }
  }
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::climb(std::size_t l, double length) {
  Lane& lane = lane_[l];
  for (int k = 0; k < pieces; ++k) {
    const int first = nearest_contact(k, l), last = nearest_contact(k + 1, l);
    if (!(knot_s_[first][k][l] < 0 && knot_s_[last][k + 1][l] > 0)) continue;
    const QuinticPath path = quintic_path(first, k, l, length);
    double at = 1;
    if (first != last) {
      const QuinticPath other = quintic_path(last, k, l, length);
      QuinticPath ahead = path;
      for (int i = 0; i < 6; ++i) ahead.c[i] -= other.c[i];
      at = ahead.meets(plane_[first][l] - plane_[last][l], 0, 1);
      if (other.speed(at) < 0) {  // the largest separation is reached later, by contact `last`
        rise_to(lane, plane_[last][l] - other.position(other.turn_between(at, 1)));
        continue;
      }
    }
    if (path.speed(at) > 0) at = path.turn_between(0, at);
    rise_to(lane, plane_[first][l] - path.position(at));
  }
}

template <class V, class Laws, int room>
int SimdClosings<V, Laws, room>::nearest_contact(int k, std::size_t l) const {
  int best = -1;
  double least = infinite;
  for (int c = 0; c < layout_.contacts; ++c) {
    const double separation = plane_[c][l] - knot_p_[c][k][l];
    if (layout_.contact[c].connects && separation < least) best = c, least = separation;
  }
  return best;
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::connect(std::size_t l, bool touches, double speed) {
  Lane& lane = lane_[l];
  Connected& all = lane.connected;
  all.touching += touches ? 1 : -1;
  const bool closed = all.touching >= (layout_.needs_all ? connecting_ : 1);
  if (closed == all.closed) return;
  const double t = t_[l];
  all.closed = closed;
  if (closed) {
    if (all.was_closed) tell_rebound(lane, all.left, t, all.highest);
    all.was_closed = true;
    lane.closing->observer->closes(t, speed < 0 ? -speed : speed);
  } else {
    all.left = t, all.highest = 0;
    lane.closing->observer->opens(t);
  }
  apart_[l] = !closed && !layout_.needs_all;
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::finish_connection(std::size_t l) {
  Lane& lane = lane_[l];
  if (!lane.connected.was_closed || lane.connected.closed) return;
  double now = layout_.needs_all ? -infinite : infinite;
  for (int c = 0; c < layout_.contacts; ++c) {
    const double separation = plane_[c][l] - position_[c][l];
    if (layout_.contact[c].connects && (layout_.needs_all ? separation > now : separation < now)) now = separation;
  }
  rise_to(lane, now);
  tell_rebound(lane, lane.connected.left, nothing, lane.connected.highest);
}

template <class V, class Laws, int room>
bool SimdClosings<V, Laws, room>::is_beyond(int c, std::size_t l) {
  Followed& one = lane_[l].contact[c];
  const double low = remembers(c) ? one.low : one.touching ? plane_[c][l] : -infinite;
  const double high = remembers(c) ? one.high : one.touching ? infinite : plane_[c][l];
  const bool below = position_[c][l] < low && speed_[c][l] < 0;
  if (!below && !(position_[c][l] > high && speed_[c][l] > 0)) return false;
  one.to_turn = false;
  one.level = below ? low : high;
  position_[c][l] = one.level;
  return true;
}

template <class V, class Laws, int room>
bool SimdClosings<V, Laws, room>::pass_within_touch(Number c, std::size_t l) {
  Followed& one = lane_[l].contact[c];
  if (!one.touching) return false;
  if (one.to_turn) {
    const double speed = speed_[c][l], acceleration = acceleration_[c][l];
    // Position of the contact point relative to its deepest position, which it reaches a little later at constant
    // deceleration; zero or negative.
    const double left = acceleration < 0 ? speed * speed / (2 * acceleration) : 0;
    const LaneContactNumbers& numbers = lane_[l].closing->numbers->contact[c];
    const double depth = position_[c][l] - plane_[c][l] - left;
    one.deepest = depth;
    if (depth > one.extreme) one.extreme = depth;
    shift_[c][l] = depth * (1 - numbers.loading_stiffness / numbers.unloading_stiffness);
    enter_phase(c, l, true, false);
    return true;
  }
  if (one.unloading) {
    const bool empties = one.level == one.low;
    if (empties) one.least = 0;
    enter_phase(c, l, false, empties);
    return true;
  }
  if (!one.in_dent || one.level == one.low) return false;
  enter_phase(c, l, true, false);
  return true;
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::enter_phase(Number c, std::size_t l, bool unloading, bool in_dent) {
  Followed& one = lane_[l].contact[c];
  const LaneContactNumbers& numbers = lane_[l].closing->numbers->contact[c];
  const double plane = plane_[c][l], shifted = plane + shift_[c][l];
  one.unloading = unloading, one.in_dent = in_dent, one.to_turn = false;
  if (unloading) {
    one.low = shifted, one.high = plane + one.deepest;
  } else if (in_dent) {
    one.low = plane, one.high = shifted;
  } else {
    one.low = one.touching ? plane : -infinite, one.high = one.touching ? infinite : plane;
  }
  low_[c][l] = one.low, high_[c][l] = one.high;
  unloading_[c][l] = unloading, in_dent_[c][l] = in_dent, loading_[c][l] = one.touching && !unloading && !in_dent;
  const double depth = lane_[l].closing->steady_depth[c];
  steady_[c][l] =
      unloading || in_dent ? shifted + depth * (numbers.loading_stiffness / numbers.unloading_stiffness) : plane + depth;
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::pass_plane(Number c, std::size_t l) {
  Lane& lane = lane_[l];
  Followed& one = lane.contact[c];
  const double t = t_[l], speed = speed_[c][l];
  if (!one.touching) {
    if constexpr (!has_several) {
      if (one.touched) tell_rebound(lane, one.left, t, one.extreme);
    }
    if (!lane.landed && is_near(c)) {
      const double over = t + lane.closing->after_contact;
      lane.landed = true;
      until_[l] = over > lane.closing->no_end_before ? over : lane.closing->no_end_before;
    }
    one.touched = true;
    touched_[c][l] = true;
    one.begin = t;
    one.speed = speed < 0 ? -speed : speed;
  } else {
    lane.closing->observer->touch(c, one.begin, t, one.speed, one.extreme, one.hardest);
    one.left = t;
    one.least = 0;
  }
  one.extreme = one.hardest = 0;
  one.touching = !one.touching;
  touching_[c][l] = one.touching;
  if constexpr (has_several) {
    if (layout_.contact[c].connects) connect(l, one.touching, speed);
  }
}

}  // namespace softland::simd
