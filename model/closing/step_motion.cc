#include "model/closing/step_motion.h"

#include <algorithm>
#include <cmath>

#include "integrators/phase.h"

namespace softland {
namespace {

std::vector<double> as_vector(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }

}  // namespace

StepMotion::StepMotion(const Switch& model, double tolerance, std::size_t contact)
    : modes_(static_cast<std::size_t>(model.modes())),
      film_(model.film_states()),
      fastest_(model.basis().angular_frequencies().maxCoeff()),
      knot_phase_(std::pow(46080 * std::min(tolerance, 1e-5), 1.0 / 6)),
      omega_(padded_to_lanes(as_vector(model.basis().angular_frequencies()), 1)),
      motion_(as_vector(model.basis().angular_frequencies()), as_vector(model.contact_shape(contact))),
      between_(2 * modes_ + film_) {}

void StepMotion::set(const Knot& begin, const Knot& end_knot, const TrajectoryPoint& end, bool accurate_rates) {
  constexpr double rounding = 1e-9;
  begin_ = &begin;
  end_ = &end_knot;
  tip_end_ = end;
  accurate_rates_ = accurate_rates;
  const double phase = fastest_ * length();
  moves_by_modes_ = phase <= (1 + rounding) * largest_phase;
  pieces_ = moves_by_modes_ ? std::max(1, static_cast<int>(std::ceil(phase / knot_phase_))) : 1;
  motion_known_ = false;
}

// Computes the pieces of the step at the first call: many steps have only one quintic piece, which needs the ends of the step
// alone.
const ModalMotion& StepMotion::motion() {
  if (!motion_known_) {
    const double* q = begin_->state.data();
    motion_.set(length(), pieces_, q, q + modes_, begin_->rates.data(),
                {tip_end_.position, tip_end_.velocity, tip_end_.acceleration});
    motion_known_ = true;
  }
  return motion_;
}

const std::vector<double>& StepMotion::halfway() {
  const double h = length();
  const std::vector<double>&from = begin_->state, &to = end_->state;
  for (std::size_t i = 0; i < modes_; ++i) {
    const double p0 = from[i], p1 = to[i], v0 = from[modes_ + i], v1 = to[modes_ + i];
    if (!accurate_rates_) {
      between_[i] = (p0 + p1) / 2 + h / 8 * (v0 - v1);
      between_[modes_ + i] = 3.0 / 2 * (p1 - p0) / h - (v0 + v1) / 4;
      continue;
    }
    const double a0 = begin_->rates[i], a1 = end_->rates[i];
    between_[i] = (p0 + p1) / 2 + h * (5.0 / 32 * (v0 - v1) + h / 64 * (a0 + a1));
    between_[modes_ + i] = 15.0 / 8 * (p1 - p0) / h - 7.0 / 16 * (v0 + v1) + h / 32 * (a1 - a0);
  }
  for (std::size_t i = 0; i < film_; ++i) {
    // The pressures of a thin gas film adapt to the motion quickly. Their computed rates may be small errors multiplied by a
    // large stiffness, so limit the effect of the rates on the interpolated pressures.
    const double p0 = from[2 * modes_ + i], p1 = to[2 * modes_ + i];
    const double far = std::abs(p1 - p0) + std::max(std::abs(p0), std::abs(p1)) / 20;
    between_[2 * modes_ + i] =
        (p0 + p1) / 2 + std::clamp(h / 8 * (begin_->rates[modes_ + i] - end_->rates[modes_ + i]), -far, far);
  }
  return between_;
}

const std::vector<double>& StepMotion::state_at(double share) {
  const double h = length();
  const double *q = begin_->state.data(), *q_end = end_->state.data();
  for (std::size_t b = 0; b < modes_; b += lanes) {
    const Lane omega = lane(omega_, b), start = load_lane(q, b, modes_), a = load_lane(begin_->rates.data(), b, modes_);
    const Lane pull = a / (omega * omega), push = load_lane(q + modes_, b, modes_) / omega;
    const Turn end = turn(omega * h), at = turn(omega * (share * h));
    const auto place = [&](const Turn& t) -> Lane { return start + pull * t.slack + push * t.sine; };
    const auto speed = [&](const Turn& t) -> Lane { return omega * (pull * t.sine + push * t.cosine); };
    const Lane end_acceleration = omega * omega * (pull * end.cosine - push * end.sine);
    const Remainder<Lane> rest(load_lane(q_end, b, modes_) - place(end), h * (load_lane(q_end + modes_, b, modes_) - speed(end)),
                               h * h * (load_lane(end_->rates.data(), b, modes_) - end_acceleration));
    store_lane(place(at) + rest.position(share), between_.data(), b, modes_);
    store_lane(speed(at) + rest.velocity(share) / h, between_.data() + modes_, b, modes_);
  }
  return between_;
}

}  // namespace softland
