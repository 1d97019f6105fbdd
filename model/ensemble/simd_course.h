// The course of a closing in one SIMD lane: begin, pieces of the drives, steps that end at a change of a contact law, end.
#pragma once

#include <cstddef>

#include "model/ensemble/simd_lanes.h"

namespace softland::simd {

template <class V, class Laws, int room>
bool SimdClosings<V, Laws, room>::consider(std::size_t l, double h, double error) {
  Lane& lane = lane_[l];
  if (lane.closing == nullptr) return false;
  if (rounds_[l] >= most_rounds) return give_up(l);
  if (starting_[l]) {
    for (int i = 0; i < modes; ++i) a_[i][l] = double(trial_a_[i][l]);
    for_contacts([&](Number c) { acceleration_[c][l] = double(knot_c_[c][pieces][l]); });
    if (layout_.measures_work) powers_[0][l] = double(powers_[6][l]);
    starting_[l] = special_[l] = false;
    set_step(l);
    aim(l, lane.stop);
    return false;
  }
  if (!(error <= 1)) {
    h_[l] = h * (error < infinite ? clamped(growth_[l], Pair::least_growth, 0.9) : Pair::not_finite);
    most_growth_[l] = 1;
    return t_[l] + h_[l] > t_[l] ? false : give_up(l);
  }
  if (to_event_[l]) return h < limit_[l] || arrives(l, h);
  if (suspect_[l]) {
    const double at = event(l, h);
    if (at <= 1) {
      to_event_[l] = special_[l] = true;
      lane.corrections = 0;
      if (h < limit_[l]) last_step_[l] = h;
      h_[l] = at * h;
      aim(l, t_[l] + at * h);
      return false;
    }
  }
  return true;
}

template <class V, class Laws, int room>
double SimdClosings<V, Laws, room>::event(std::size_t l, double length) {
  if constexpr (!has_several) return event(Number(), l, length);
  double first = infinite;
  for_contacts([&](Number c) {
    if (const double at = event(c, l, length); at < first) first = at, lane_[l].at = c;
  });
  return first;
}

template <class V, class Laws, int room>
double SimdClosings<V, Laws, room>::event(Number c, std::size_t l, double length) {
  if constexpr (Contact::has_memory) {
    if (remembers(c)) return phase_end(c, l, length);
  }
  return crossing(c, l, length);
}

template <class V, class Laws, int room>
double SimdClosings<V, Laws, room>::event_level(std::size_t l) const {
  const Number c = event_contact(l);
  return remembers(c) ? lane_[l].contact[c].level : plane_[c][l];
}

template <class V, class Laws, int room>
bool SimdClosings<V, Laws, room>::arrives(std::size_t l, double h) {
  constexpr double short_of_a_radian = 1e-3;
  constexpr int most_corrections = 8;
  Lane& lane = lane_[l];
  if (goes_to_turn(l)) return true;
  const Number at = event_contact(l);
  const double off = event_level(l) - knot_p_[at][pieces][l], speed = knot_s_[at][pieces][l];
  double later = off / speed;
  const double turned = later * fastest_[l];
  if (turned < short_of_a_radian && turned > -short_of_a_radian) {
    if (later < -h) later = -h;
    for (int i = 0; i < modes; ++i) {
      const double v = trial_v_[i][l], a = trial_a_[i][l];
      trial_q_[i][l] = trial_q_[i][l] + later * (v + later / 2 * a);
      trial_v_[i][l] = v + later * a;
      trial_a_[i][l] = a - later * square_[i][l] * v;  // other forces than those of stiffness hardly change in this time
    }
    moved_[l] = later;
    if constexpr (has_several) move_others(at, l);
    return true;
  }
  const double depth = off < 0 ? -off : off;
  if (lane.corrections == most_corrections || depth <= lane.closing->numbers->contact[at].negligible_depth) return true;
  ++lane.corrections;
  const double target = target_[l] + later;
  if (!(target > t_[l])) return true;
  if (target > lane.stop) {
    aim(l, lane.stop);
  } else {
    aim(l, target);
  }
  return false;
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::move_others(int at, std::size_t l) {
  for (int c = 0; c < layout_.contacts; ++c) {
    if (c == at) continue;
    double position = 0, speed = 0, acceleration = 0;
    for (int i = 0; i < modes; ++i) {
      const double shape = at_contact_[c][i][l];
      position += shape * trial_q_[i][l], speed += shape * trial_v_[i][l], acceleration += shape * trial_a_[i][l];
    }
    knot_p_[c][pieces][l] = position, knot_s_[c][pieces][l] = speed, knot_c_[c][pieces][l] = acceleration;
  }
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::go_on(std::size_t l, double h) {
  Lane& lane = lane_[l];
  if (smallest_[l] < laws_.floor()[l]) {
    give_up(l);
    return;
  }
  const bool arrived = h >= limit_[l];
  if (!arrived) {
    limit_[l] = target_[l] - t_[l];
  } else if (to_event_[l]) {
    t_[l] = double(t_[l]) + moved_[l];
    moved_[l] = 0;
    if (!goes_to_turn(l)) position_[event_contact(l)][l] = event_level(l);
    on_event(l);
  }
  if (t_[l] >= until_[l]) {
    finish(l, true);
  } else if (arrived && t_[l] >= lane.stop) {
    if (t_[l] >= lane.closing->duration) {
      finish(l, true);
    } else {
      enter_stretch(l);
    }
  }
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::on_event(std::size_t l) {
  const Number at = event_contact(l);
  on_event(at, l);
  if constexpr (has_several) {
    for (int c = 0; c < layout_.contacts; ++c)
      if (c != at && is_beyond(c, l)) on_event(c, l);
  }
  go_on_after_event(l);
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::on_event(Number c, std::size_t l) {
  if constexpr (Contact::has_memory) {
    if (remembers(c) && pass_within_touch(c, l)) return;
  }
  pass_plane(c, l);
  if constexpr (Contact::has_memory) {
    if (remembers(c)) enter_phase(c, l, false, false);
  }
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::go_on_after_event(std::size_t l) {
  Lane& lane = lane_[l];
  to_event_[l] = special_[l] = false;
  weigh(l);
  begin_anew(l);
  set_step(l);
  aim(l, lane.stop);
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::enter_stretch(std::size_t l) {
  Lane& lane = lane_[l];
  const double t = t_[l];
  lane.stop = lane.closing->duration;
  lane.longest = infinite;
  for (int k = 0; k < layout_.drives; ++k) {
    find_piece(lane, k, t);
    const int at = lane.piece[k];
    const LanePiece& piece = lane.drive[k][at];
    const double gain = lane.gain[k];
    begin_[k][l] = piece.begin, value_[k][l] = gain * piece.value, slope_[k][l] = gain * piece.slope;
    bend_[k][l] = gain * piece.square, twist_[k][l] = gain * piece.cube;
    int next = at + 1;
    while (next < lane.count[k] && lane.drive[k][next].joins) ++next;
    lane.runs[k] = next > at + 1;
    lane.curves[k] = lane.runs[k] || piece.tail[0] != 0 || piece.amplitude != 0 || piece.amplitude_slope != 0;
    if (lane.curves[k] || piece.square != 0 || piece.cube != 0) curves_[k] = true;
    if (!lane.runs[k] && piece.longest_step < lane.longest) lane.longest = piece.longest_step;
    if (next < lane.count[k] && lane.drive[k][next].begin < lane.stop) lane.stop = lane.drive[k][next].begin;
  }
  max_step_[l] = lane.longest < most_turn_[l] ? lane.longest : most_turn_[l];
  starting_[l] = special_[l] = true;
  begin_anew(l);
  h_[l] = 0;
  aim(l, t);
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::weigh(std::size_t l) {
  const LaneSwitch& s = *lane_[l].closing->numbers;
  bool touching = false;
  for_contacts([&](Number c) { touching = touching || lane_[l].contact[c].touching; });
  for (int i = 0; i < modes; ++i) {
    q_weight_[i][l] = i < s.modes ? 1 / (touching ? s.touching[i] : s.flying[i]) : 0;
    v_weight_[i][l] = i < s.modes ? 1 / s.speed[i] : 0;
  }
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::finish(std::size_t l, bool followed) {
  Lane& lane = lane_[l];
  for_contacts([&](Number c) {
    Followed& one = lane.contact[c];
    const double side = one.touching ? 1 : -1, far = side * (position_[c][l] - plane_[c][l]);
    if (far > one.extreme) one.extreme = far;
    if (followed && one.touched) {
      if (one.touching) {
        lane.closing->observer->touch(c, one.begin, nothing, one.speed, one.extreme, one.hardest);
      } else if constexpr (!has_several) {
        tell_rebound(lane, one.left, nothing, one.extreme);
      }
    }
    finish_force(c, l);
  });
  if constexpr (has_several) {
    if (followed) finish_connection(l);
  }
  for (int i = 0; i < modes; ++i) lane.closing->final[i] = q_[i][l];
  lane.closing->work = work_[l];
  lane.closing->followed = followed;
  lane.closing->end = t_[l];
  lane.closing = nullptr;
  --busy_;
  fill(l);
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::fill(std::size_t l) {
  Lane& lane = lane_[l];
  const bool idle = next_ == count_;
  LaneClosing* const closing = closings_ + (idle ? count_ - 1 : next_++);
  const LaneSwitch& s = *closing->numbers;
  lane = Lane{};
  lane.closing = closing;
  for (int k = 0; k < layout_.drives; ++k) {
    lane.drive[k] = closing->pieces[k], lane.count[k] = closing->piece_count[k];
    lane.gain[k] = closing->gain[k];
  }
  if (!idle) ++busy_;
  laws_.take(s, l);
  double fastest = 0;
  for (int i = 0; i < modes; ++i) {
    if (i < s.modes && s.omega[i] > fastest) fastest = s.omega[i];
    omega_[i][l] = s.omega[i], inverse_[i][l] = 1 / s.omega[i], square_[i][l] = s.omega[i] * s.omega[i];
    piezo_[i][l] = s.piezo[i], friction_[i][l] = s.friction[i];
    q_[i][l] = closing->start[i];
    v_[i][l] = a_[i][l] = 0;
  }
  per_unknown_[l] = 1.0 / (2 * s.modes);
  fastest_[l] = fastest;
  most_turn_[l] = 2 / fastest;
  to_event_[l] = false;
  weigh(l);
  rounds_[l] = 0;
  t_[l] = 0;
  moved_[l] = 0;
  work_[l] = 0;
  until_[l] = closing->no_contact_before;
  last_step_[l] = 0.01 / fastest;
  for_contacts([&](Number c) { take(s.contact[c], c, l); });
  apart_[l] = false;
  enter_stretch(l);
  if (idle) lane.closing = nullptr;  // special_ stays true for the lane: no step is accepted
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::take(const LaneContactNumbers& numbers, Number c, std::size_t l) {
  contact_[c].take(layout_.contact[c], numbers, l);
  plane_[c][l] = numbers.plane;
  steady_[c][l] = numbers.plane + lane_[l].closing->steady_depth[c];
  touching_[c][l] = touched_[c][l] = false;
  position_[c][l] = speed_[c][l] = acceleration_[c][l] = 0;
  for (int i = 0; i < modes; ++i) {
    at_contact_[c][i][l] = numbers.shape[i];
    position_[c][l] = position_[c][l] + at_contact_[c][i][l] * q_[i][l];
  }
  if constexpr (Contact::has_memory) {
    shift_[c][l] = 0;
    if (remembers(c)) enter_phase(c, l, false, false);
  }
}

}  // namespace softland::simd
