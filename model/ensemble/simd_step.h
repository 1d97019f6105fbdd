// One step of the closings in all SIMD lanes: forces, stages, error, and the motion of the contact points within the step.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "model/ensemble/simd_lanes.h"

namespace softland::simd {

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::set_drives(V time) {
  for (int k = 0; k < layout_.drives; ++k) {
    volts_[k] = value_[k] + slope_[k] * (time - begin_[k]);
    if (curves_[k]) add_curves(k, time);
  }
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::add_curves(int k, V time) {
  const V s = time - begin_[k];
  volts_[k] += s * s * (bend_[k] + s * twist_[k]);
  for (std::size_t l = 0; l < width; ++l) {
    const Lane& lane = lane_[l];
    if (!lane.curves[k]) continue;
    const double t = time[l], gain = lane.gain[k];
    if (lane.runs[k]) {
      volts_[k][l] = gain * running(k, l, t);
      continue;
    }
    const LanePiece& piece = lane.drive[k][lane.piece[k]];
    if (piece.tail[0] != 0) volts_[k][l] = volts_[k][l] + gain * tails_of(piece, t - piece.begin);
    if (piece.amplitude == 0 && piece.amplitude_slope == 0) continue;
    const double envelope = gain * (piece.amplitude + piece.amplitude_slope * (t - piece.begin));
    volts_[k][l] = volts_[k][l] + envelope * std::sin(piece.angular_frequency * t + piece.phase);
  }
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::find_piece(Lane& lane, int k, double t) {
  const LanePiece* const all = lane.drive[k];
  int& at = lane.piece[k];
  while (at + 1 < lane.count[k] && all[at + 1].begin <= t) ++at;
  while (at > 0 && all[at].begin > t) --at;
}

template <class V, class Laws, int room>
double SimdClosings<V, Laws, room>::tails_of(const LanePiece& piece, double elapsed) {
  double sum = piece.tail[0] * std::exp(-piece.decay[0] * elapsed);
  if (piece.tail[1] != 0) sum += piece.tail[1] * std::exp(-piece.decay[1] * elapsed);
  return sum;
}

template <class V, class Laws, int room>
double SimdClosings<V, Laws, room>::running(int k, std::size_t l, double t) {
  find_piece(lane_[l], k, t);
  const LanePiece& piece = lane_[l].drive[k][lane_[l].piece[k]];
  const double s = t - piece.begin;
  return piece.value + s * (piece.slope + s * (piece.square + s * piece.cube));
}

template <class V, class Laws, int room>
V SimdClosings<V, Laws, room>::piezo_power(const V* v) const {
  V power = 0;
  if (!layout_.piezo) return power;
  for (int i = 0; i < modes; ++i) power += piezo_[i] * v[i];
  return power * volts_[layout_.drives - 1];
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::rates(const V* __restrict q, const V* __restrict v, V* __restrict a, V& least) {
  V sum[capacity];
  for (int i = 0; i < modes; ++i) sum[i] = -(square_[i] * q[i]) - friction_[i] * v[i];
  if (layout_.piezo) {
    for (int i = 0; i < modes; ++i) sum[i] += volts_[layout_.drives - 1] * piezo_[i];
  }
  laws_.add(q, v, volts_, sum, least);
  if (layout_.measures_work) power_ = laws_.power() + piezo_power(v);
  for_contacts([&](Number c) __attribute__((always_inline)) {
    if (any_of(touching_[c])) {
      V d = -plane_[c];
      for (int i = 0; i < modes; ++i) d += at_contact_[c][i] * q[i];
      V push = contact_[c].push(d, [&] {
        V rate = 0;
        for (int i = 0; i < modes; ++i) rate += at_contact_[c][i] * v[i];
        return rate;
      });
      if constexpr (Contact::has_memory) {
        if (remembers(c)) push = remembered(c, push, d);
      }
      where(!touching_[c], push) = V(0);
      for (int i = 0; i < modes; ++i) sum[i] -= push * at_contact_[c][i];
    }
  });
  for (int i = 0; i < modes; ++i) a[i] = sum[i];
}

template <class V, class Laws, int room>
V SimdClosings<V, Laws, room>::remembered(Number c, V loading, V depth) const {
  where(unloading_[c], loading) = contact_[c].pull_back(depth - shift_[c]);
  where(in_dent_[c], loading) = V(0);
  return loading;
}

template <class V, class Laws, int room>
auto SimdClosings<V, Laws, room>::turn(V phase) -> Turn {
  constexpr int degree = 18;
  struct Factors {
    double of[degree + 2];
  };
  constexpr Factors factors = [] {
    Factors f{};
    f.of[0] = f.of[1] = 1;
    for (int k = 2; k < degree + 2; ++k) f.of[k] = -f.of[k - 2] / (k * (k - 1));
    return f;
  }();
  const V x = phase * 0.5, x2 = x * x;
  V cosine = factors.of[degree], over_x = factors.of[degree + 1];
  for (int k = degree - 2; k >= 0; k -= 2) cosine = cosine * x2 + factors.of[k], over_x = over_x * x2 + factors.of[k + 1];
  const V sine = x * over_x, slack = 2.0 * sine * sine;
  return {1.0 - slack, 2.0 * sine * cosine, slack};
}

template <class V, class Laws, int room>
auto SimdClosings<V, Laws, room>::add(const Turn& a, const Turn& b) -> Turn {
  const V slack = a.slack + b.slack - a.slack * b.slack + a.sine * b.sine;
  return {1.0 - slack, a.sine * b.cosine + a.cosine * b.sine, slack};
}

template <class V, class Laws, int room>
template <int S>
void SimdClosings<V, Laws, room>::stage(V h, V time, const Turn* at) {
  for (int i = 0; i < modes; ++i) {
    V kq = 0, kv = 0;
    for (int j = 1; j < S; ++j) {
      if (Pair::tableau[S][j] == 0) continue;
      kq += Pair::tableau[S][j] * slope_q_[j][i];
      kv += Pair::tableau[S][j] * slope_v_[j][i];
    }
    kq *= h;
    kv = kv * h + v_[i];
    const V by_speed = at[i].sine * inverse_[i];
    trial_q_[i] = (q_[i] + a_[i] * (at[i].slack * inverse_[i] * inverse_[i]) + kq * at[i].cosine) + kv * by_speed;
    trial_v_[i] = (a_[i] * by_speed - kq * (at[i].sine * omega_[i])) + kv * at[i].cosine;
  }
  set_drives(time);
  rates(trial_q_, trial_v_, trial_a_, smallest_);
  if (layout_.measures_work) powers_[S] = power_;
  for (int i = 0; i < modes; ++i) {
    const V excess = square_[i] * (trial_q_[i] - q_[i]) - a_[i] + trial_a_[i];
    slope_q_[S][i] = excess * (at[i].sine * -inverse_[i]);
    slope_v_[S][i] = excess * at[i].cosine;
  }
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::round() {
  const V wanted = min(h_, max_step_);
  const V h = min(wanted, limit_);
  Turn node[5][capacity];
  for (int i = 0; i < modes; ++i) {
    const V phase = h * omega_[i];
    node[0][i] = turn(Pair::nodes[1] * phase);
    node[1][i] = turn(Pair::nodes[2] * phase);
    const Turn twice = add(node[0][i], node[0][i]);
    node[2][i] = add(twice, twice);
    node[3][i] = turn(Pair::nodes[4] * phase);
    node[4][i] = add(node[2][i], node[0][i]);
  }
  V end = t_ + h;
  where(h >= limit_, end) = target_;
  stage<1>(h, t_ + Pair::nodes[1] * h, node[0]);
  stage<2>(h, t_ + Pair::nodes[2] * h, node[1]);
  stage<3>(h, t_ + Pair::nodes[3] * h, node[2]);
  stage<4>(h, t_ + Pair::nodes[4] * h, node[3]);
  stage<5>(h, end, node[4]);
  stage<6>(h, end, node[4]);
  V squares = 0;
  for (int i = 0; i < modes; ++i) {
    V q = 0, v = 0;
    for (int j = 2; j < 7; ++j) q += Pair::difference[j] * slope_q_[j][i], v += Pair::difference[j] * slope_v_[j][i];
    q *= q_weight_[i], v *= v_weight_[i];
    squares += q * q + v * v;
  }
  const V error = h * h * squares * per_unknown_;
  suspect_ = M(false);
  for_contacts([&](Number c) __attribute__((always_inline)) {
    V position = 0, speed = 0, acceleration = 0;
    for (int i = 0; i < modes; ++i) {
      position += at_contact_[c][i] * trial_q_[i], speed += at_contact_[c][i] * trial_v_[i];
      acceleration += at_contact_[c][i] * trial_a_[i];
    }
    knot_p_[c][0] = position_[c], knot_s_[c][0] = speed_[c], knot_c_[c][0] = acceleration_[c];
    knot_p_[c][pieces] = position, knot_s_[c][pieces] = speed, knot_c_[c][pieces] = acceleration;
    follow(c, h);
  });
  settle(h, end, error);
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::follow(Number at, V h) {
  constexpr double share = 1.0 / pieces;
  V* const knot_p = knot_p_[at];
  V* const knot_s = knot_s_[at];
  V* const knot_c = knot_c_[at];
  const V* const at_contact = at_contact_[at];
  V p[pieces + 1], s[pieces + 1], c[pieces + 1];
  for (int k = 1; k <= pieces; ++k) p[k] = position_[at], s[k] = 0, c[k] = 0;
  for (int i = 0; i < modes; ++i) {
    const V pull = at_contact[i] * a_[i] * inverse_[i] * inverse_[i], push = at_contact[i] * v_[i] * inverse_[i];
    const Turn piece = turn(omega_[i] * (h * share));
    Turn turned = piece;
    for (int k = 1;; ++k) {
      p[k] += pull * turned.slack + push * turned.sine;
      s[k] += omega_[i] * (pull * turned.sine + push * turned.cosine);
      c[k] += square_[i] * (pull * turned.cosine - push * turned.sine);
      if (k == pieces) break;
      turned = add(turned, piece);
    }
  }
  const V off_p = knot_p[pieces] - p[pieces], off_s = h * (knot_s[pieces] - s[pieces]);
  const V off_c = h * h * (knot_c[pieces] - c[pieces]);
  const V f0 = 10.0 * off_p - 4.0 * off_s + 0.5 * off_c, f1 = -15.0 * off_p + 7.0 * off_s - off_c;
  const V f2 = 6.0 * off_p - 3.0 * off_s + 0.5 * off_c;
  const V per = 1.0 / max(h, V(std::numeric_limits<double>::min()));
  for (int k = 1; k < pieces; ++k) {
    const double x = k * share;
    knot_p[k] = p[k] + x * x * x * (f0 + x * (f1 + x * f2));
    knot_s[k] = s[k] + per * (x * x * (3.0 * f0 + x * (4.0 * f1 + x * 5.0 * f2)));
    knot_c[k] = c[k] + per * per * (x * (6.0 * f0 + x * (12.0 * f1 + x * 20.0 * f2)));
  }
  M suspect(false), turns(false);
  const V g = h * share;
  for (int k = 0; k < pieces; ++k) {
    const auto [nearest, furthest] = reach(at, k, g);
    suspect = suspect || (!touching_[at] && furthest > plane_[at]) || (touching_[at] && nearest < plane_[at]);
    turns = turns || (knot_s[k] * knot_s[k + 1] < V(0));
  }
  if constexpr (Contact::has_memory) {
    if (remembers(at)) suspect = leaves_phase(at, h);
  }
  suspect_ = suspect_ || suspect;
  turns_[at] = turns;
}

template <class V, class Laws, int room>
auto SimdClosings<V, Laws, room>::reach(Number c, int k, V g) const -> Reach {
  const V b0 = knot_p_[c][k], b5 = knot_p_[c][k + 1], s0 = g * knot_s_[c][k], s1 = g * knot_s_[c][k + 1];
  const V c0 = g * g * knot_c_[c][k], c1 = g * g * knot_c_[c][k + 1];
  const V b1 = b0 + 0.2 * s0, b2 = b0 + 0.4 * s0 + 0.05 * c0, b4 = b5 - 0.2 * s1, b3 = b5 - 0.4 * s1 + 0.05 * c1;
  return {.least = min(min(min(b0, b1), min(b2, b3)), min(b4, b5)), .most = max(max(max(b0, b1), max(b2, b3)), max(b4, b5))};
}

template <class V, class Laws, int room>
auto SimdClosings<V, Laws, room>::leaves_phase(Number c, V h) const -> M {
  constexpr double share = 1.0 / pieces;
  const V g = h * share;
  M suspect(false);
  for (int k = 0; k < pieces; ++k) {
    const auto [nearest, furthest] = reach(c, k, g);
    suspect = suspect || furthest > high_[c] || nearest < low_[c] || (loading_[c] && knot_s_[c][k + 1] < V(0));
  }
  return suspect;
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::control(V error) {
  double squared[width];
  error.copy_to(squared, std::experimental::element_aligned);
  double growth[width];
  for (std::size_t l = 0; l < width; ++l) {
    const double above = squared[l] < 1e-36 ? 1e-36 : squared[l];
    const auto x = static_cast<float>(above > 1e36 ? 1e36 : above);
    std::int32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    const float m = static_cast<float>(bits & 0x7FFFFF) * 0x1p-23F;
    const float log_error = 0.5F * (static_cast<float>((bits >> 23) - 127) + m * (1.4227F + m * (-0.5894F + 0.1667F * m)));
    const float exponent = Pair::integral * last_error_[l] - Pair::proportional * log_error;
    const float low = exponent < -60.0F ? -60.0F : exponent, z = low > 60.0F ? 60.0F : low;
    const float n = static_cast<float>(static_cast<std::int32_t>(z + 1000.5F) - 1000), r = z - n;
    const std::int32_t power = (static_cast<std::int32_t>(n) + 127) << 23;
    float two_n;
    std::memcpy(&two_n, &power, sizeof two_n);
    const float two_z = two_n * (1 + r * (0.69315F + r * (0.24023F + r * (0.05550F + r * 0.00962F))));
    log_error_[l] = log_error > Pair::least_error ? log_error : Pair::least_error;
    growth[l] = Pair::safety * static_cast<double>(two_z);
  }
  growth_.copy_from(growth, std::experimental::element_aligned);
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::settle(V h, V end, V error) {
  control(error);
  rounds_ += V(1);
  // Lanes with an accepted step without event, breakpoint or failure continue together; consider() treats the others one by
  // one.
  const M plain = error <= V(1) && !special_ && !suspect_ && h < limit_ && end < until_ && smallest_ >= laws_.floor() &&
                  rounds_ < V(most_rounds);
  M rises[room];
  for_contacts([&](Number c)
                   __attribute__((always_inline)) { rises[c] = position_[c] < steady_[c] && knot_p_[c][pieces] >= steady_[c]; });
  M taken = plain;
  if (!all_of(plain)) {
    for (std::size_t l = 0; l < width; ++l)
      if (!plain[l]) taken[l] = consider(l, h[l], error[l]);
  }
  where(taken, t_) = end;
  for (int i = 0; i < modes; ++i) {
    where(taken, q_[i]) = trial_q_[i];
    where(taken, v_[i]) = trial_v_[i];
    where(taken, a_[i]) = trial_a_[i];
  }
  if (layout_.measures_work) do_work(taken, h);
  for_contacts([&](Number c) __attribute__((always_inline)) {
    if constexpr (Contact::has_damping) {
      if (layout_.contact[c].damped && any_of(taken && touching_[c])) update_largest_force(c, taken, h);
    }
    where(taken, position_[c]) = knot_p_[c][pieces];
    where(taken, speed_[c]) = knot_s_[c][pieces];
    where(taken, acceleration_[c]) = knot_c_[c][pieces];
    if (any_of(taken && turns_[c] && touched_[c])) {
      for (std::size_t l = 0; l < width; ++l)
        if (taken[l] && turns_[c][l] && touched_[c][l]) update_plastic_depth(c, l, h[l]);
    }
    if (any_of(taken && rises[c])) {
      for (std::size_t l = 0; l < width; ++l)
        if (taken[l] && rises[c][l]) rise(c, l, h[l]);
    }
  });
  if constexpr (has_several) {
    if (any_of(taken && apart_)) {
      for (std::size_t l = 0; l < width; ++l)
        if (taken[l] && apart_[l]) climb(l, h[l]);
    }
  }
  where(taken, h_) = h * min(max(growth_, V(Pair::least_growth)), most_growth_);
  where(taken, most_growth_) = V(Pair::most_growth);
  where(taken && h < limit_ && !to_event_, last_step_) = h;
  where(plain, limit_) = target_ - t_;
  for (std::size_t l = 0; l < width; ++l) last_error_[l] = taken[l] ? log_error_[l] : last_error_[l];
  if (all_of(plain)) return;
  for (std::size_t l = 0; l < width; ++l)
    if (taken[l] && !plain[l]) go_on(l, h[l]);
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::do_work(const M& taken, V h) {
  V mean = 0;
  for (int j = 0; j < 6; ++j) mean += Pair::tableau[6][j] * powers_[j];
  where(taken, work_) += h * mean;
  where(taken, powers_[0]) = powers_[6];
}

template <class V, class Laws, int room>
void SimdClosings<V, Laws, room>::update_largest_force(Number at, const M& taken, V h) {
  static_assert(pieces % 2 == 1);
  constexpr int half = pieces / 2;
  V depth = 0, speed = 0;
  for (std::size_t l = 0; l < width; ++l) {
    const QuinticPath c = quintic_path(at, half, l, h[l]);
    depth[l] = c.position(0.5), speed[l] = c.speed(0.5);
  }
  speed *= static_cast<double>(pieces) / max(h, V(std::numeric_limits<double>::min()));
  const auto push = [&](V position, V rate) { return contact_[at].push(position - plane_[at], [&] { return rate; }); };
  const V begin = push(position_[at], speed_[at]), middle = push(depth, speed);
  const V end = push(knot_p_[at][pieces], knot_s_[at][pieces]);
  const V bend = 2.0 * middle - begin - end, rise = end - begin;
  V most_push = max(max(begin, middle), end);
  where(abs(rise) < 2.0 * bend, most_push) = middle + rise * rise / (8.0 * bend);
  for (std::size_t l = 0; l < width; ++l)
    if (taken[l] && touching_[at][l] && most_push[l] > lane_[l].contact[at].hardest) lane_[l].contact[at].hardest = most_push[l];
}

}  // namespace softland::simd
