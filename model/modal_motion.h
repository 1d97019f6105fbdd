// Motion of one point of the beam within a step: every mode as if the force on it stayed what it is at the begin, which is exact
// (model/phase.h), plus a quintic that makes position, velocity and acceleration right at the end. What the force changes in a
// step is small, so this holds where the quintic through both ends does not: over steps of a radian and more of the fastest mode.
#pragma once

#include <array>
#include <vector>

#include "model/phase.h"

namespace softland {

class ModalMotion {
 public:
  struct Sample {
    double position, velocity, acceleration;  ///< [m], [m/s], [m/s^2]
  };

  /// Angular frequencies [rad/s] and values of the modes at the point [kg^(-1/2)].
  ModalMotion(const std::vector<double>& frequencies, const std::vector<double>& shape)
      : modes_(frequencies.size()), omega_(padded_to_lanes(frequencies, 1)), shape_(padded_to_lanes(shape, 0)) {
    pull_.resize(omega_.size());
    push_.resize(omega_.size());
  }

  /// A step of `length` [s] from modal coordinates, velocities and accelerations to what the point does at its end. The fastest
  /// mode's phase must not exceed largest_phase.
  void set(double length, const double* q, const double* v, const double* a, const Sample& end) {
    start_ = 0;
    for (std::size_t i = 0; i < modes_; ++i) {
      start_ += shape_[i] * q[i];
      pull_[i] = shape_[i] * a[i] / (omega_[i] * omega_[i]);
      push_[i] = shape_[i] * v[i] / omega_[i];
    }
    length_ = length;
    const Sample reached = free(length);
    const double p = end.position - reached.position, pv = length * (end.velocity - reached.velocity);
    const double pa = length * length * (end.acceleration - reached.acceleration);
    rest_ = {10 * p - 4 * pv + pa / 2, -15 * p + 7 * pv - pa, 6 * p - 3 * pv + pa / 2};
  }

  /// `time` after the begin, at most the step's length [s].
  [[nodiscard]] Sample at(double time) const {
    Sample s = free(time);
    const double x = time / length_, x2 = x * x;
    s.position += x2 * x * (rest_[0] + x * (rest_[1] + x * rest_[2]));
    s.velocity += x2 / length_ * (3 * rest_[0] + x * (4 * rest_[1] + x * 5 * rest_[2]));
    s.acceleration += x / (length_ * length_) * (6 * rest_[0] + x * (12 * rest_[1] + x * 20 * rest_[2]));
    return s;
  }

 private:
  [[nodiscard]] Sample free(double time) const {
    PhaseLane position = PhaseLane::Zero(), velocity = position, acceleration = position;
    for (std::size_t b = 0; b < omega_.size(); b += phase_lanes) {
      const Eigen::Map<const PhaseLane> omega(omega_.data() + b), pull(pull_.data() + b), push(push_.data() + b);
      const Turn turned = turn(omega * time);
      position += pull * turned.slack + push * turned.sine;
      velocity += omega * (pull * turned.sine + push * turned.cosine);
      acceleration += omega * omega * (pull * turned.cosine - push * turned.sine);
    }
    return {start_ + position.sum(), velocity.sum(), acceleration.sum()};
  }

  std::size_t modes_;
  std::vector<double> omega_, shape_, pull_, push_;
  std::array<double, 3> rest_{};  // of the remainder: powers 3 to 5 of time / length
  double start_ = 0, length_ = 0;
};

}  // namespace softland
