// The simulation of several closings at once (ensemble_closings.h), one per lane of a SIMD vector. This header is included once
// for every set of vector instructions.
//
// The vectors are std::experimental::simd. The force laws are the same templates as for a single closing, with vectors of
// parameters. All code here depends on the type of the vectors or belongs to a class that does, so that the linker never merges
// code for different instructions.
//
// Inlining is forced, or prevented, because inlined code decides which products and sums the compiler fuses: the last bits of a
// closing must not depend on how many callers a function has.
//
// A vector must fit into one register: with two registers per vector GCC spills registers and the code is several times slower.
// A force law that is not inlined has the same effect, since its sums over points stay in memory.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <experimental/simd>
#include <limits>

#include "integrators/dormand_prince.h"
#include "model/ensemble/lane_closing.h"
#include "model/ensemble/lane_laws.h"

namespace softland::simd {

/// Simulates closings of switches with up to `room` contacts in SIMD lanes. For room = 1, code for several contacts is not
/// compiled.
template <class V, class Laws, int room = 1>
class SimdClosings {
  using M = typename V::mask_type;
  static constexpr std::size_t width = V::size();
  static constexpr int capacity = Laws::capacity;
  // Number of quintic pieces of the contact point's motion in a step of up to two radians of the fastest mode: the number that
  // StepMotion uses for such a step at tolerances of 1e-5 and larger.
  static constexpr int pieces = 3;
  static constexpr double most_rounds = 100'000;
  static constexpr double infinite = std::numeric_limits<double>::infinity();
  static constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

  static constexpr bool has_several = room > 1;

  using Pair = DormandPrince;
  using Contact = typename Laws::Contact;

 public:
  SimdClosings(const LaneLayout& layout, LaneClosing* closings, std::size_t count)
      : layout_(layout), modes(Laws::modes(layout)), laws_(layout_), closings_(closings), count_(count) {
    for_contacts([&](Number c) { connecting_ += layout_.contact[c].connects; });
  }

  void run() {
    for (std::size_t l = 0; l < width; ++l) fill(l);
    while (busy_ > 0) round();
  }

 private:
  // Type of the number of a contact: a compile-time constant 0 when switches have only one contact.
  using Number = std::conditional_t<has_several, int, std::integral_constant<int, 0>>;

  // Calls f(c) for every contact number c.
  template <class F>
  [[gnu::always_inline]] void for_contacts(F&& f) const {
    if constexpr (has_several) {
      for (int c = 0; c < layout_.contacts; ++c) f(c);
    } else {
      f(Number());
    }
  }

  // The state of one contact of the switch in a SIMD lane.
  struct Followed {
    bool touched = false, touching = false;
    double begin = 0, left = 0, speed = 0;  // begin and end of the touch [s], impact velocity [m/s]
    double extreme = 0;                     // largest depth in this touch, or largest height since the last touch [m]
    double hardest = 0;                     // largest force of a damped contact in this touch [N]
    // Branch of the law of a contact with memory: unloading, or in the dent that it has left (else loading); see
    // contact_phase.h.
    bool unloading = false, in_dent = false;
    bool to_turn = false;  // true when the step should end where the contact point turns back
    double level = 0;      // position at which the step should end if not at a turn [m]
    // Positions between which the present branch of the contact law acts; deepest interference of the contact [m].
    double low = 0, high = 0, deepest = 0;
    double steady = nothing;  // time from which the force has been at or above EnsembleClosing::steady_force [s]
    double least = infinite;  // least interference after the first maximum of the contact force [m]
  };
  // The state of the connection (electrical path) through several contacts.
  struct Connected {
    int touching = 0;  // number of the connection's contacts that are closed
    bool closed = false, was_closed = false;
    double left = 0, highest = 0;  // begin [s] and largest separation [m] of the connection's present opening
  };

  // The state of the closing in one SIMD lane.
  struct Lane {
    LaneClosing* closing = nullptr;  // closing that the lane simulates; null while idle
    const LanePiece* drive[most_drives] = {};
    int count[most_drives] = {};    // number of signal pieces of each drive
    int piece[most_drives] = {};    // index of the current signal piece of each drive
    bool runs[most_drives] = {};    // true in signal pieces that join smoothly: steps may cross their ends
    bool curves[most_drives] = {};  // true when the present voltage is not a single straight line or cubic
    int corrections = 0;            // how often the end of a step was corrected to meet a change of a contact law
    double stop = 0;                // next breakpoint of the drives, or the end of the simulated window [s]
    double longest = 0;             // longest step that resolves the drive voltages [s]
    double gain[most_drives] = {};  // factors on the voltages of the drives
    bool landed = false;            // true after first contact of any contact on the near side
    int at = 0;                     // number of the contact whose change of law ends the lane's step
    Followed contact[room];
    Connected connected;
  };

  void set_drives(V time) {
    for (int k = 0; k < layout_.drives; ++k) {
      volts_[k] = value_[k] + slope_[k] * (time - begin_[k]);
      if (curves_[k]) add_curves(k, time);
    }
  }

  // Adds to the voltage of drive k the parts beyond a straight line: cubic polynomial, exponentials and sine.
  void add_curves(int k, V time) {
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

  // Sets the lane's signal piece of drive k to the piece at time t. Searches from the previous piece.
  static void find_piece(Lane& lane, int k, double t) {
    const LanePiece* const all = lane.drive[k];
    int& at = lane.piece[k];
    while (at + 1 < lane.count[k] && all[at + 1].begin <= t) ++at;
    while (at > 0 && all[at].begin > t) --at;
  }
  [[nodiscard]] static double tails_of(const LanePiece& piece, double elapsed) {
    double sum = piece.tail[0] * std::exp(-piece.decay[0] * elapsed);
    if (piece.tail[1] != 0) sum += piece.tail[1] * std::exp(-piece.decay[1] * elapsed);
    return sum;
  }
  // Returns the voltage of drive k, without its gain, within signal pieces that join smoothly [V].
  [[nodiscard]] double running(int k, std::size_t l, double t) {
    find_piece(lane_[l], k, t);
    const LanePiece& piece = lane_[l].drive[k][lane_[l].piece[k]];
    const double s = t - piece.begin;
    return piece.value + s * (piece.slope + s * (piece.square + s * piece.cube));
  }

  [[nodiscard]] V piezo_power(const V* v) const {
    V power = 0;
    if (!layout_.piezo) return power;
    for (int i = 0; i < modes; ++i) power += piezo_[i] * v[i];
    return power * volts_[layout_.drives - 1];
  }

  // Computes modal accelerations `a`, and sets `least` to the smallest gap along the beam.
  [[gnu::always_inline]] void rates(const V* __restrict q, const V* __restrict v, V* __restrict a, V& least) {
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

  // Returns the force of a contact with memory at this interference [N]; `loading` is the force on the curve of first loading.
  [[nodiscard]] V remembered(Number c, V loading, V depth) const {
    where(unloading_[c], loading) = contact_[c].pull_back(depth - shift_[c]);
    where(in_dent_[c], loading) = V(0);
    return loading;
  }
  [[nodiscard]] bool remembers([[maybe_unused]] Number c) const {
    if constexpr (Contact::has_memory) return layout_.contact[c].remembers;
    return false;
  }

  struct Turn {
    V cosine, sine, slack;
  };
  [[gnu::always_inline]] static Turn turn(V phase) {
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
  [[gnu::always_inline]] static Turn add(const Turn& a, const Turn& b) {
    const V slack = a.slack + b.slack - a.slack * b.slack + a.sine * b.sine;
    return {1.0 - slack, a.sine * b.cosine + a.cosine * b.sine, slack};
  }

  template <int S>
  [[gnu::always_inline]] void stage(V h, V time, const Turn* at) {
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

  // Attempts one integration step in every SIMD lane.
  void round() {
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

  // Computes the contact point's motion at the ends of the step's quintic pieces, as integrators/modal_motion.h does. Marks
  // SIMD lanes whose contact law may change in the step (suspect_), and lanes whose contact point turns back (turns_).
  [[gnu::always_inline]] void follow(Number at, V h) {
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

  struct Reach {
    V least, most;
  };
  // Returns bounds of the contact point's position in piece k of the step, which lasts `g` [s]: the smallest and the largest of
  // the Bernstein coefficients of the quintic.
  [[nodiscard]] [[gnu::always_inline]] Reach reach(Number c, int k, V g) const {
    const V b0 = knot_p_[c][k], b5 = knot_p_[c][k + 1], s0 = g * knot_s_[c][k], s1 = g * knot_s_[c][k + 1];
    const V c0 = g * g * knot_c_[c][k], c1 = g * g * knot_c_[c][k + 1];
    const V b1 = b0 + 0.2 * s0, b2 = b0 + 0.4 * s0 + 0.05 * c0, b4 = b5 - 0.2 * s1, b3 = b5 - 0.4 * s1 + 0.05 * c1;
    return {.least = min(min(min(b0, b1), min(b2, b3)), min(b4, b5)), .most = max(max(max(b0, b1), max(b2, b3)), max(b4, b5))};
  }

  // Returns the SIMD lanes in which a contact with memory may leave the present branch of its law in the step: its point may
  // cross an end of the branch, or turns back while loading.
  [[nodiscard]] M leaves_phase(Number c, V h) const {
    constexpr double share = 1.0 / pieces;
    const V g = h * share;
    M suspect(false);
    for (int k = 0; k < pieces; ++k) {
      const auto [nearest, furthest] = reach(c, k, g);
      suspect = suspect || furthest > high_[c] || nearest < low_[c] || (loading_[c] && knot_s_[c][k + 1] < V(0));
    }
    return suspect;
  }

  // The motion of one contact in one SIMD lane and one piece of the step: a quintic in the share s of the piece, from 0 to 1.
  struct QuinticPath {
    double c[6];
    [[nodiscard]] double position(double s) const { return c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5])))); }
    [[nodiscard]] double speed(double s) const { return c[1] + s * (2 * c[2] + s * (3 * c[3] + s * (4 * c[4] + s * 5 * c[5]))); }
    [[nodiscard]] double bend(double s) const { return 2 * c[2] + s * (6 * c[3] + s * (12 * c[4] + s * 20 * c[5])); }

    // Finds a zero of f in [low, high] by Newton's method, with bisection where a Newton step would leave the interval.
    template <class F, class D>
    [[gnu::always_inline]] static double zero(F f, D slope, double low, double high) {
      const bool rising = f(high) > 0;
      double s = (low + high) / 2;
      for (int i = 0; i < 60; ++i) {
        const double value = f(s);
        ((value > 0) == rising ? high : low) = s;
        double next = s - value / slope(s);
        if (!(next > low && next < high)) next = (low + high) / 2;
        const double moved = next - s;
        s = next;
        if (moved < 1e-14 && moved > -1e-14) break;
      }
      return s;
    }
    [[nodiscard]] double turn() const {
      return zero([this](double s) { return speed(s); }, [this](double s) { return bend(s); }, 0, 1);
    }
    [[nodiscard]] double turn_between(double low, double high) const {
      return zero([this](double s) { return speed(s); }, [this](double s) { return bend(s); }, low, high);
    }
    [[nodiscard]] double meets(double level, double low, double high) const {
      return zero([&](double s) { return position(s) - level; }, [this](double s) { return speed(s); }, low, high);
    }
  };

  [[nodiscard]] [[gnu::always_inline]] QuinticPath quintic_path(Number c, int k, std::size_t l, double length) const {
    const double h = length / pieces;
    const double p0 = knot_p_[c][k][l], p1 = knot_p_[c][k + 1][l], d = p1 - p0;
    const double v0 = knot_s_[c][k][l] * h, v1 = knot_s_[c][k + 1][l] * h;
    const double a0 = knot_c_[c][k][l] * h * h, a1 = knot_c_[c][k + 1][l] * h * h;
    return {{p0, v0, a0 / 2, 10 * d - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1, -15 * d + 8 * v0 + 7 * v1 + 1.5 * a0 - a1,
             6 * d - 3 * (v0 + v1) - 0.5 * (a0 - a1)}};
  }

  // Returns when a SIMD lane's contact point crosses its contact plane, as a share of the step; above 1 when it does not cross.
  [[nodiscard]] double crossing(Number c, std::size_t l, double length) const {
    return crossing(c, l, length, lane_[l].contact[c].touching ? 1 : -1, plane_[c][l]);
  }
  // Returns when a SIMD lane's contact point leaves the region side * (position - level) > 0, as a share of the step; above 1
  // when it does not leave.
  [[nodiscard]] double crossing(Number c, std::size_t l, double length, double side, double level) const {
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

  // Returns when a contact with memory leaves the present branch of its law in a SIMD lane, as a share of the step; above 1
  // when it does not leave. Sets Followed::to_turn and Followed::level.
  [[nodiscard]] double phase_end(Number c, std::size_t l, double length) {
    Followed& one = lane_[l].contact[c];
    const double by_low = one.low > -infinite ? crossing(c, l, length, 1, one.low) : 2;
    const double by_high = one.high < infinite ? crossing(c, l, length, -1, one.high) : 2;
    const double by_turn = loading_[c][l] ? turning(c, l, length) : 2;
    one.to_turn = by_turn < by_low && by_turn < by_high;
    one.level = by_low <= by_high ? one.low : one.high;
    const double edge = by_low < by_high ? by_low : by_high;
    return edge < by_turn ? edge : by_turn;
  }
  // Returns when a SIMD lane's contact point turns back from its deepest point, as a share of the step; above 1 when it does
  // not turn.
  [[nodiscard]] double turning(Number c, std::size_t l, double length) const {
    for (int k = 0; k < pieces; ++k) {
      if (!(knot_s_[c][k + 1][l] < 0)) continue;
      return knot_s_[c][k][l] > 0 ? (k + quintic_path(c, k, l, length).turn()) / pieces : static_cast<double>(k) / pieces;
    }
    return 2;
  }

  // Updates Followed::extreme where the contact point turns back within the step: the largest interference in contact, the
  // largest height out of contact. A turn towards deeper positions in contact also updates Followed::least and
  // Followed::steady.
  [[gnu::noinline]] void update_plastic_depth(Number c, std::size_t l, double length) {
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

  // Returns the interference at which first loading gives the force that the contact now has at the interference `depth` [m];
  // forces of all branches are compared by this number.
  [[nodiscard]] double depth_of_force([[maybe_unused]] Number c, [[maybe_unused]] std::size_t l, double depth) const {
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

  // Sets Followed::steady to the last time in the step at which the contact force rises to EnsembleClosing::steady_force.
  [[gnu::noinline]] void rise(Number c, std::size_t l, double length) {
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

  static void rise_to(Lane& lane, double separation) {
    if (separation > lane.connected.highest) lane.connected.highest = separation;
  }

  // Updates the largest separation of an open connection over the step, for Connection::any. The separation of such a
  // connection is that of the contact nearest to its plane.
  void climb(std::size_t l, double length) {
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

  // Returns the contact of the connection with the smallest separation at the beginning of piece k of the step (k = pieces: at
  // the end of the step).
  [[nodiscard]] int nearest_contact(int k, std::size_t l) const {
    int best = -1;
    double least = infinite;
    for (int c = 0; c < layout_.contacts; ++c) {
      const double separation = plane_[c][l] - knot_p_[c][k][l];
      if (layout_.contact[c].connects && separation < least) best = c, least = separation;
    }
    return best;
  }

  // Opens or closes the connection, if necessary, when one of its contacts begins (`touches`) or ends a touch at this speed
  // [m/s].
  void connect(std::size_t l, bool touches, double speed) {
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

  // Reports the rebound of the connection that has not ended by the end of a run.
  void finish_connection(std::size_t l) {
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

  // Computes the factor of the next step size from the squared error estimate. Logarithm and power have only the digits that a
  // step size needs, and the loops have no branches, so that the compiler uses vector instructions.
  [[gnu::always_inline]] void control(V error) {
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

  [[gnu::always_inline]] void settle(V h, V end, V error) {
    control(error);
    rounds_ += V(1);
    // Lanes with an accepted step without event, breakpoint or failure continue together; consider() treats the others one by
    // one.
    const M plain = error <= V(1) && !special_ && !suspect_ && h < limit_ && end < until_ && smallest_ >= laws_.floor() &&
                    rounds_ < V(most_rounds);
    M rises[room];
    for_contacts([&](Number c) __attribute__((always_inline)) {
      rises[c] = position_[c] < steady_[c] && knot_p_[c][pieces] >= steady_[c];
    });
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

  // Integrates the work of the drives on the modes over the step, with the weights of the Runge-Kutta pair.
  void do_work(const M& taken, V h) {
    V mean = 0;
    for (int j = 0; j < 6; ++j) mean += Pair::tableau[6][j] * powers_[j];
    where(taken, work_) += h * mean;
    where(taken, powers_[0]) = powers_[6];
  }

  // Updates the largest force of a damped contact: the peak of the parabola through the forces at both ends and the middle of
  // the step, as in model/closing/touch_record.h.
  void update_largest_force(Number at, const M& taken, V h) {
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
      if (taken[l] && touching_[at][l] && most_push[l] > lane_[l].contact[at].hardest)
        lane_[l].contact[at].hardest = most_push[l];
  }

  // Returns true when a SIMD lane accepts its step; otherwise sets the length of its next attempt. It is called for lanes that
  // are not `plain`: with too large an error, a possible event or an end of the step at a given time.
  bool consider(std::size_t l, double h, double error) {
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

  // Returns when the first contact law changes in the step, as a share of the step, and stores the number of this contact in
  // Lane::at; above 1 without a change.
  [[nodiscard]] double event(std::size_t l, double length) {
    if constexpr (!has_several) return event(Number(), l, length);
    double first = infinite;
    for_contacts([&](Number c) {
      if (const double at = event(c, l, length); at < first) first = at, lane_[l].at = c;
    });
    return first;
  }
  [[nodiscard]] double event(Number c, std::size_t l, double length) {
    if constexpr (Contact::has_memory) {
      if (remembers(c)) return phase_end(c, l, length);
    }
    return crossing(c, l, length);
  }
  // Returns the number of the contact whose change of law should end the SIMD lane's step.
  [[nodiscard]] Number event_contact([[maybe_unused]] std::size_t l) const {
    if constexpr (has_several) return lane_[l].at;
    return Number();
  }
  // Returns the position of the contact point at which its law changes, where the SIMD lane's step should end [m].
  [[nodiscard]] double event_level(std::size_t l) const {
    const Number c = event_contact(l);
    return remembers(c) ? lane_[l].contact[c].level : plane_[c][l];
  }
  [[nodiscard]] bool goes_to_turn(std::size_t l) const {
    const Number c = event_contact(l);
    return remembers(c) && lane_[l].contact[c].to_turn;
  }

  // Returns true when a step that should end at a change of a contact law does end there. If the step ends close to the change,
  // its end is moved there; otherwise the end time of the step is corrected, the step is repeated, and the result is false.
  [[gnu::always_inline]] bool arrives(std::size_t l, double h) {
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

  // Recomputes position, speed and acceleration of the contacts other than `at`, after the end of a SIMD lane's step has been
  // moved to the event of contact `at`.
  void move_others(int at, std::size_t l) {
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

  // Continues a SIMD lane after an accepted step that did not end normally: at a breakpoint of the drives, at a change of a
  // contact law, at the end of the closing, or with a gap below its limit.
  void go_on(std::size_t l, double h) {
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

  // Handles the end of a step at a change of a contact law, or at a contact plane, in SIMD lane `l`.
  void on_event(std::size_t l) {
    const Number at = event_contact(l);
    on_event(at, l);
    if constexpr (has_several) {
      for (int c = 0; c < layout_.contacts; ++c)
        if (c != at && is_beyond(c, l)) on_event(c, l);
    }
    go_on_after_event(l);
  }
  void on_event(Number c, std::size_t l) {
    if constexpr (Contact::has_memory) {
      if (remembers(c) && pass_within_touch(c, l)) return;
    }
    pass_plane(c, l);
    if constexpr (Contact::has_memory) {
      if (remembers(c)) enter_phase(c, l, false, false);
    }
  }
  // Returns true when contact c has left the present branch of its law by the end of a step that another contact ended; then
  // puts the contact point onto the end of this branch.
  bool is_beyond(int c, std::size_t l) {
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

  // Handles a change between two branches of a contact law during a touch. Returns false when the contact point is at the
  // contact plane, where a touch begins or ends.
  bool pass_within_touch(Number c, std::size_t l) {
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

  // Selects the branch of the law of a contact with memory. Sets the positions between which this branch acts, and the position
  // at which its force is EnsembleClosing::steady_force.
  void enter_phase(Number c, std::size_t l, bool unloading, bool in_dent) {
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

  // Begins or ends a touch of a contact whose point crosses its contact plane.
  void pass_plane(Number c, std::size_t l) {
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
  [[nodiscard]] bool is_near([[maybe_unused]] Number c) const {
    if constexpr (has_several) return layout_.contact[c].near;
    return true;
  }

  void go_on_after_event(std::size_t l) {
    Lane& lane = lane_[l];
    to_event_[l] = special_[l] = false;
    weigh(l);
    begin_anew(l);
    set_step(l);
    aim(l, lane.stop);
  }

  static void tell_rebound(const Lane& lane, double begin, double end, double height) {
    // Lower separations do not count as rebounds; as a share of the contact gap, and equal to that of ReboundFinder.
    constexpr double on_the_plane = 1e-12;
    if (height > on_the_plane * lane.closing->numbers->contact[0].plane) lane.closing->observer->rebound(begin, end, height);
  }

  void begin_anew(std::size_t l) {
    last_error_[l] = 0;
    most_growth_[l] = Pair::first_growth;
  }
  void set_step(std::size_t l) {
    const double last = last_step_[l], longest = lane_[l].longest;
    h_[l] = last < longest ? last : longest;
  }

  void aim(std::size_t l, double target) {
    target_[l] = target;
    limit_[l] = target - t_[l];
  }

  // Selects the signal pieces that are valid from the current time on, and the next breakpoint at which a step must end.
  void enter_stretch(std::size_t l) {
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

  void weigh(std::size_t l) {
    const LaneSwitch& s = *lane_[l].closing->numbers;
    bool touching = false;
    for_contacts([&](Number c) { touching = touching || lane_[l].contact[c].touching; });
    for (int i = 0; i < modes; ++i) {
      q_weight_[i][l] = i < s.modes ? 1 / (touching ? s.touching[i] : s.flying[i]) : 0;
      v_weight_[i][l] = i < s.modes ? 1 / s.speed[i] : 0;
    }
  }

  void finish(std::size_t l, bool followed) {
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
      const double depth = one.touching ? depth_of_force(c, l, position_[c][l] - plane_[c][l]) : 0;
      lane.closing->force[c].steady_force_time = position_[c][l] < steady_[c][l] ? nothing : one.steady;
      lane.closing->least_depth[c] = !one.touched ? nothing : depth < one.least ? depth : one.least;
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

  bool give_up(std::size_t l) {
    finish(l, false);
    return false;
  }

  // Gives a SIMD lane the next closing to simulate; without a next one the lane repeats the last closing as an idle lane.
  void fill(std::size_t l) {
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

  // Sets the parameters of a contact of the SIMD lane's new switch, and its state before first contact.
  void take(const LaneContactNumbers& numbers, Number c, std::size_t l) {
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

  [[gnu::always_inline]] static double clamped(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

  const LaneLayout layout_;
  [[no_unique_address]] const typename Laws::Modes modes;  // number of modes; a constant for UsualLaws
  Laws laws_;
  Contact contact_[room];
  int connecting_ = 0;  // number of contacts of the connection
  LaneClosing* closings_;
  std::size_t count_, next_ = 0;
  int busy_ = 0;
  Lane lane_[width];

  // Parameters of the switches in the SIMD lanes: angular frequency of each mode with its inverse and square, piezo force,
  // damping.
  V omega_[capacity], inverse_[capacity], square_[capacity], piezo_[capacity], friction_[capacity];
  V q_weight_[capacity], v_weight_[capacity], per_unknown_, fastest_, most_turn_;
  V at_contact_[room][capacity], plane_[room], steady_[room];
  // Begin, value and slope of the drives' signal pieces in the SIMD lanes, and the voltages.
  V begin_[most_drives], value_[most_drives], slope_[most_drives], volts_[most_drives];
  V bend_[most_drives], twist_[most_drives];  // coefficients of s^2 and s^3 in a drive's signal piece
  bool curves_[most_drives] = {};             // true once the drive's voltage is curved in some SIMD lane
  // Modal coordinates, velocities and accelerations at the start and the end of a step.
  V q_[capacity], v_[capacity], a_[capacity], trial_q_[capacity], trial_v_[capacity], trial_a_[capacity];
  V slope_q_[7][capacity], slope_v_[7][capacity];
  V t_, h_, max_step_, limit_, target_, smallest_;
  V position_[room], speed_[room], acceleration_[room];
  V knot_p_[room][pieces + 1], knot_s_[room][pieces + 1], knot_c_[room][pieces + 1];
  M touching_[room]{}, touched_[room]{}, turns_[room]{}, suspect_{false};
  M apart_{false};     // SIMD lanes with an open connection of type Connection::any, for climb()
  M starting_{false};  // SIMD lanes whose next round only computes accelerations, with a step of length 0
  M to_event_{false};  // SIMD lanes whose step should end at a change of a contact law
  M special_{false};   // SIMD lanes that are idle, or marked in starting_ or to_event_
  // SIMD lanes in which a contact with memory is loading, is unloading, or is in the dent that it has left.
  M loading_[room]{}, unloading_[room]{}, in_dent_[room]{};
  // Positions between which the present branch of a contact law acts, and residual interference (depth of the dent) [m].
  V low_[room], high_[room], shift_[room];
  V until_;      // a lane's closing ends with the first step that ends at or after this time [s]
  V last_step_;  // length of the last step that ended neither at a breakpoint nor at an event [s]
  V growth_, most_growth_, rounds_;
  V power_, powers_[7], work_{0};  // power of the drives on the modes, now and at a step's stages [W]; work so far [J]
  // Error estimate of this step and of the last accepted step, as binary logarithms.
  float log_error_[width] = {}, last_error_[width] = {};
  double moved_[width] = {};
};

template <class V, template <class> class FringingOf>
void run_with(const LaneLayout& layout, LaneClosing* closings, std::size_t count) {
  if (layout.film >= 0) {
    SimdClosings<V, UsualLaws<V, FringingOf, true>>(layout, closings, count).run();
  } else {
    SimdClosings<V, UsualLaws<V, FringingOf, false>>(layout, closings, count).run();
  }
}

template <class V>
void run_in(const LaneLayout& layout, LaneClosing* closings, std::size_t count) {
  if (layout.contacts > 1) {
    if (!layout.usual) return SimdClosings<V, AnyLaws<V>, most_contacts>(layout, closings, count).run();
    return SimdClosings<V, UsualLaws<V, MeijsFokkemaFringingOf, true, most_points>, most_contacts>(layout, closings, count).run();
  }
  if (!layout.usual) return SimdClosings<V, AnyLaws<V>>(layout, closings, count).run();
  switch (layout.fringing) {
    case LaneFringing::none:
      return run_with<V, NoFringingOf>(layout, closings, count);
    case LaneFringing::linear:
      return run_with<V, LinearFringingOf>(layout, closings, count);
    case LaneFringing::meijs_fokkema:
      return run_with<V, MeijsFokkemaFringingOf>(layout, closings, count);
  }
}

}  // namespace softland::simd
