// The SIMD lanes in which closings are simulated (simd_closings.h): the class with its state, and its functions by name.
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
#include <experimental/simd>
#include <limits>
#include <type_traits>

#include "integrators/dormand_prince.h"
#include "model/ensemble/lane_closing.h"
#include "model/ensemble/lane_laws.h"

namespace softland::simd {

/// Simulates closings of switches with up to `room` contacts in SIMD lanes. For room = 1, code for several contacts is not
/// compiled. The functions are defined by what they do: a step of all lanes (simd_step.h), the contacts of one lane
/// (simd_contacts.h), and the course of one lane's closing (simd_course.h).
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

  inline void set_drives(V time);

  // Adds to the voltage of drive k the parts beyond a straight line: cubic polynomial, exponentials and sine.
  inline void add_curves(int k, V time);

  // Sets the lane's signal piece of drive k to the piece at time t. Searches from the previous piece.
  static inline void find_piece(Lane& lane, int k, double t);
  [[nodiscard]] static inline double tails_of(const LanePiece& piece, double elapsed);
  // Returns the voltage of drive k, without its gain, within signal pieces that join smoothly [V].
  [[nodiscard]] inline double running(int k, std::size_t l, double t);

  [[nodiscard]] inline V piezo_power(const V* v) const;

  // Computes modal accelerations `a`, and sets `least` to the smallest gap along the beam.
  [[gnu::always_inline]] inline void rates(const V* __restrict q, const V* __restrict v, V* __restrict a, V& least);

  // Returns the force of a contact with memory at this interference [N]; `loading` is the force on the curve of first loading.
  [[nodiscard]] inline V remembered(Number c, V loading, V depth) const;
  [[nodiscard]] bool remembers([[maybe_unused]] Number c) const {
    if constexpr (Contact::has_memory) return layout_.contact[c].remembers;
    return false;
  }

  struct Turn {
    V cosine, sine, slack;
  };
  [[gnu::always_inline]] static inline Turn turn(V phase);
  [[gnu::always_inline]] static inline Turn add(const Turn& a, const Turn& b);

  template <int S>
  [[gnu::always_inline]] inline void stage(V h, V time, const Turn* at);

  // Attempts one integration step in every SIMD lane.
  inline void round();

  // Computes the contact point's motion at the ends of the step's quintic pieces, as integrators/modal_motion.h does. Marks
  // SIMD lanes whose contact law may change in the step (suspect_), and lanes whose contact point turns back (turns_).
  [[gnu::always_inline]] inline void follow(Number at, V h);

  struct Reach {
    V least, most;
  };
  // Returns bounds of the contact point's position in piece k of the step, which lasts `g` [s]: the smallest and the largest of
  // the Bernstein coefficients of the quintic.
  [[nodiscard]] [[gnu::always_inline]] inline Reach reach(Number c, int k, V g) const;

  // Returns the SIMD lanes in which a contact with memory may leave the present branch of its law in the step: its point may
  // cross an end of the branch, or turns back while loading.
  [[nodiscard]] inline M leaves_phase(Number c, V h) const;

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

  [[nodiscard]] [[gnu::always_inline]] inline QuinticPath quintic_path(Number c, int k, std::size_t l, double length) const;

  // Returns when a SIMD lane's contact point crosses its contact plane, as a share of the step; above 1 when it does not cross.
  [[nodiscard]] double crossing(Number c, std::size_t l, double length) const {
    return crossing(c, l, length, lane_[l].contact[c].touching ? 1 : -1, plane_[c][l]);
  }
  // Returns when a SIMD lane's contact point leaves the region side * (position - level) > 0, as a share of the step; above 1
  // when it does not leave.
  [[nodiscard]] inline double crossing(Number c, std::size_t l, double length, double side, double level) const;

  // Returns when a contact with memory leaves the present branch of its law in a SIMD lane, as a share of the step; above 1
  // when it does not leave. Sets Followed::to_turn and Followed::level.
  [[nodiscard]] inline double phase_end(Number c, std::size_t l, double length);
  // Returns when a SIMD lane's contact point turns back from its deepest point, as a share of the step; above 1 when it does
  // not turn.
  [[nodiscard]] inline double turning(Number c, std::size_t l, double length) const;

  // Updates Followed::extreme where the contact point turns back within the step: the largest interference in contact, the
  // largest height out of contact. A turn towards deeper positions in contact also updates Followed::least and
  // Followed::steady.
  [[gnu::noinline]] inline void update_plastic_depth(Number c, std::size_t l, double length);

  // Returns the interference at which first loading gives the force that the contact now has at the interference `depth` [m];
  // forces of all branches are compared by this number.
  [[nodiscard]] inline double depth_of_force([[maybe_unused]] Number c, [[maybe_unused]] std::size_t l, double depth) const;

  // Records the figures of a contact's force at the end of the closing.
  [[gnu::always_inline]] inline void finish_force(Number c, std::size_t l);

  // Sets Followed::steady to the last time in the step at which the contact force rises to EnsembleClosing::steady_force.
  [[gnu::noinline]] inline void rise(Number c, std::size_t l, double length);

  static void rise_to(Lane& lane, double separation) {
    if (separation > lane.connected.highest) lane.connected.highest = separation;
  }

  // Updates the largest separation of an open connection over the step, for Connection::any. The separation of such a
  // connection is that of the contact nearest to its plane.
  inline void climb(std::size_t l, double length);

  // Returns the contact of the connection with the smallest separation at the beginning of piece k of the step (k = pieces: at
  // the end of the step).
  [[nodiscard]] inline int nearest_contact(int k, std::size_t l) const;

  // Opens or closes the connection, if necessary, when one of its contacts begins (`touches`) or ends a touch at this speed
  // [m/s].
  inline void connect(std::size_t l, bool touches, double speed);

  // Reports the rebound of the connection that has not ended by the end of a run.
  inline void finish_connection(std::size_t l);

  // Computes the factor of the next step size from the squared error estimate. Logarithm and power have only the digits that a
  // step size needs, and the loops have no branches, so that the compiler uses vector instructions.
  [[gnu::always_inline]] inline void control(V error);

  [[gnu::always_inline]] inline void settle(V h, V end, V error);

  // Integrates the work of the drives on the modes over the step, with the weights of the Runge-Kutta pair.
  inline void do_work(const M& taken, V h);

  // Updates the largest force of a damped contact: the peak of the parabola through the forces at both ends and the middle of
  // the step, as in model/closing/touch_record.h.
  inline void update_largest_force(Number at, const M& taken, V h);

  // Returns true when a SIMD lane accepts its step; otherwise sets the length of its next attempt. It is called for lanes that
  // are not `plain`: with too large an error, a possible event or an end of the step at a given time.
  inline bool consider(std::size_t l, double h, double error);

  // Returns when the first contact law changes in the step, as a share of the step, and stores the number of this contact in
  // Lane::at; above 1 without a change.
  [[nodiscard]] inline double event(std::size_t l, double length);
  [[nodiscard]] inline double event(Number c, std::size_t l, double length);
  // Returns the number of the contact whose change of law should end the SIMD lane's step.
  [[nodiscard]] Number event_contact([[maybe_unused]] std::size_t l) const {
    if constexpr (has_several) return lane_[l].at;
    return Number();
  }
  // Returns the position of the contact point at which its law changes, where the SIMD lane's step should end [m].
  [[nodiscard]] inline double event_level(std::size_t l) const;
  [[nodiscard]] bool goes_to_turn(std::size_t l) const {
    const Number c = event_contact(l);
    return remembers(c) && lane_[l].contact[c].to_turn;
  }

  // Returns true when a step that should end at a change of a contact law does end there. If the step ends close to the change,
  // its end is moved there; otherwise the end time of the step is corrected, the step is repeated, and the result is false.
  [[gnu::always_inline]] inline bool arrives(std::size_t l, double h);

  // Recomputes position, speed and acceleration of the contacts other than `at`, after the end of a SIMD lane's step has been
  // moved to the event of contact `at`.
  inline void move_others(int at, std::size_t l);

  // Continues a SIMD lane after an accepted step that did not end normally: at a breakpoint of the drives, at a change of a
  // contact law, at the end of the closing, or with a gap below its limit.
  inline void go_on(std::size_t l, double h);

  // Handles the end of a step at a change of a contact law, or at a contact plane, in SIMD lane `l`.
  inline void on_event(std::size_t l);
  inline void on_event(Number c, std::size_t l);
  // Returns true when contact c has left the present branch of its law by the end of a step that another contact ended; then
  // puts the contact point onto the end of this branch.
  inline bool is_beyond(int c, std::size_t l);

  // Handles a change between two branches of a contact law during a touch. Returns false when the contact point is at the
  // contact plane, where a touch begins or ends.
  inline bool pass_within_touch(Number c, std::size_t l);

  // Selects the branch of the law of a contact with memory. Sets the positions between which this branch acts, and the position
  // at which its force is EnsembleClosing::steady_force.
  inline void enter_phase(Number c, std::size_t l, bool unloading, bool in_dent);

  // Begins or ends a touch of a contact whose point crosses its contact plane.
  inline void pass_plane(Number c, std::size_t l);
  [[nodiscard]] bool is_near([[maybe_unused]] Number c) const {
    if constexpr (has_several) return layout_.contact[c].near;
    return true;
  }

  inline void go_on_after_event(std::size_t l);

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
  inline void enter_stretch(std::size_t l);

  inline void weigh(std::size_t l);

  inline void finish(std::size_t l, bool followed);

  bool give_up(std::size_t l) {
    finish(l, false);
    return false;
  }

  // Gives a SIMD lane the next closing to simulate; without a next one the lane repeats the last closing as an idle lane.
  inline void fill(std::size_t l);

  // Sets the parameters of a contact of the SIMD lane's new switch, and its state before first contact.
  inline void take(const LaneContactNumbers& numbers, Number c, std::size_t l);

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

}  // namespace softland::simd
