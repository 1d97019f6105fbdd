// Motion of one point of the beam within an integration step. Every mode moves by its exact motion under the force at the start
// of the step (integrators/phase.h). A quintic polynomial is added, so that position, velocity and acceleration agree with
// those of the integrator at the end of the step. The force changes little in a step, so this interpolation is accurate even if
// the phase of the fastest mode advances by a radian and more. A quintic polynomial alone would be inaccurate in such a step.
#pragma once

#include <array>
#include <vector>

#include "integrators/phase.h"

namespace softland {

/// The quintic polynomial in x, 0 <= x <= 1, with position, velocity and acceleration 0 at x = 0, and p, v and a at x = 1.
template <class T>
struct Remainder {
  std::array<T, 3> factors{};  ///< coefficients of the powers 3 to 5; those of lower powers are 0

  Remainder() = default;
  Remainder(const T& p, const T& v, const T& a) : factors{10 * p - 4 * v + a / 2, -15 * p + 7 * v - a, 6 * p - 3 * v + a / 2} {}
  [[nodiscard]] T position(double x) const { return x * x * x * (factors[0] + x * (factors[1] + x * factors[2])); }
  [[nodiscard]] T velocity(double x) const { return x * x * (3 * factors[0] + x * (4 * factors[1] + 5 * x * factors[2])); }
  [[nodiscard]] T acceleration(double x) const { return x * (6 * factors[0] + x * (12 * factors[1] + 20 * x * factors[2])); }
};

class ModalMotion {
 public:
  struct Sample {
    /// Position [m], velocity [m/s] and acceleration [m/s^2] of the point of the beam.
    double position, velocity, acceleration;
  };

  /// Takes angular frequencies [rad/s] of the beam's modes and the values of the mode shapes at the point [kg^(-1/2)].
  ModalMotion(const std::vector<double>& frequencies, const std::vector<double>& shape)
      : modes_(frequencies.size()), omega_(padded_to_lanes(frequencies, 1)), shape_(padded_to_lanes(shape, 0)) {
    pull_.resize(omega_.size());
    push_.resize(omega_.size());
  }

  /// Sets the integration step of duration `length` [s] to interpolate. The step is divided into `pieces` equal intervals, at
  /// whose ends knot() returns the motion. The coordinates q, velocities v and accelerations a of the modes are at the start of
  /// the step, the motion `end` of the point at its end. The phase of a mode must advance by at most largest_phase in the step.
  void set(double length, int pieces, const double* q, const double* v, const double* a, const Sample& end) {
    per_length_ = 1 / length;
    Lane start = Lane::Zero();
    knots_.assign(static_cast<std::size_t>(pieces), {0, 0, 0});
    for (std::size_t b = 0; b < omega_.size(); b += lanes) {
      const Lane shape = lane(shape_, b), omega = lane(omega_, b);
      start += shape * load_lane(q, b, modes_);
      lane(pull_, b) = shape * load_lane(a, b, modes_) / (omega * omega);
      lane(push_, b) = shape * load_lane(v, b, modes_) / omega;
      const Turn piece = turn(omega * (length / pieces));
      Turn turned = piece;
      for (Sample& knot : knots_) {
        add_free(b, turned, knot);
        turned = turned + piece;
      }
    }
    start_ = start.sum();
    for (Sample& knot : knots_) knot.position += start_;
    const Sample& reached = knots_.back();
    rest_ = {end.position - reached.position, length * (end.velocity - reached.velocity),
             length * length * (end.acceleration - reached.acceleration)};
    for (int k = 1; k <= pieces; ++k) add_rest(static_cast<double>(k) / pieces, knots_[static_cast<std::size_t>(k) - 1]);
  }

  /// Returns the motion at the end of the k-th of the equal intervals into which set() divided the step, 1 <= k <= pieces.
  [[nodiscard]] const Sample& knot(int k) const { return knots_[static_cast<std::size_t>(k) - 1]; }

  /// Returns the motion at `time` after the start of the step [s]; `time` is at most the length of the step.
  [[nodiscard]] Sample at(double time) const {
    Sample s{start_, 0, 0};
    for (std::size_t b = 0; b < omega_.size(); b += lanes) add_free(b, turn(lane(omega_, b) * time), s);
    add_rest(time * per_length_, s);
    return s;
  }

 private:
  void add_free(std::size_t begin, const Turn& turned, Sample& s) const {
    const Lane omega = lane(omega_, begin), pull = lane(pull_, begin), push = lane(push_, begin);
    s.position += (pull * turned.slack + push * turned.sine).sum();
    s.velocity += (omega * (pull * turned.sine + push * turned.cosine)).sum();
    s.acceleration += (omega * omega * (pull * turned.cosine - push * turned.sine)).sum();
  }

  // Adds the quintic part of the motion to `s`; `x` is the time as a share of the step.
  void add_rest(double x, Sample& s) const {
    s.position += rest_.position(x);
    s.velocity += per_length_ * rest_.velocity(x);
    s.acceleration += per_length_ * per_length_ * rest_.acceleration(x);
  }

  std::size_t modes_;
  std::vector<double> omega_, shape_, pull_, push_;
  std::vector<Sample> knots_;
  Remainder<double> rest_;  // quintic part of the motion, over the time as a share of the step
  double start_ = 0, per_length_ = 0;
};

}  // namespace softland
