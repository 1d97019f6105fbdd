// A force law that acts along the beam. One virtual call computes the load at all points in an evaluation of the accelerations.
// A law is a small value type with load(gap, velocity), a template over the scalar type (double for runs, Dual for exact
// derivatives). A conservative law acts by itself or is scaled by a drive (drive_depends): by V^2 of an electrode, or by the
// factor of the dispersion force. A conservative law also has potential(gap), whose slope is the load. All other laws dissipate
// energy.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "base/lanes.h"
#include "model/dual.h"

namespace softland {

/// The beam at the quadrature points, and at idle points that fill the last SIMD vector (base/lanes.h): local gap h [m] and
/// velocity towards the electrode [m/s].
struct GapField {
  Eigen::ArrayXd gap;
  Eigen::ArrayXd velocity;
  double smallest_gap = 0;  ///< smallest local gap of all points [m]
};

class DistributedLaw {
 public:
  virtual ~DistributedLaw() = default;
  /// Adds the load of the force law [N/m] at the points on which the law acts. The load of a law that a drive scales is
  /// multiplied by `drive`, the strength of the drive: V^2, or the factor of the dispersion force. `load` is as long as the
  /// arrays of the gap field.
  virtual void add_load(const GapField& field, double drive, double* load) const = 0;
  /// Adds derivatives of the load with respect to deflection and velocity at the points on which the force law acts. The arrays
  /// are as long as those of the gap field.
  virtual void add_derivatives(const GapField& field, double drive, double* by_deflection, double* by_velocity) const = 0;
  /// Adds second derivatives of the load at the points on which the force law acts: by deflection twice, by deflection and
  /// velocity, by velocity twice. Below the smallest valid gap the load continues by its tangent: only the mixed one is not 0.
  virtual void add_curvatures(const GapField& field, double drive, double* by_deflections, double* by_both,
                              double* by_velocities) const = 0;
  /// Returns the integral of the potential per length over the points on which the force law acts, for drive = 1 [J]; 0 for
  /// laws that dissipate.
  [[nodiscard]] virtual double potential(const GapField& field, const Eigen::ArrayXd& weights) const = 0;
};

template <class Law>
class DistributedLawOf final : public DistributedLaw {
  static constexpr Eigen::Index lanes = softland::lanes;

 public:
  /// The force law acts at the quadrature points [begin, end). Below the gap `floor` [m] the load is continued by its tangent,
  /// the potential by the parabola whose slope is this tangent.
  DistributedLawOf(Law law, Eigen::Index begin, Eigen::Index end, double floor)
      : law_(law), begin_(begin), end_(end), floor_(floor), share_(Eigen::ArrayXd::Zero((end + lanes - 1) / lanes * lanes)) {
    share_.segment(begin, end - begin).setOnes();
  }

  void add_load(const GapField& field, double drive, double* __restrict load) const override {
    const double* gap = field.gap.data();
    const double* velocity = field.velocity.data();
    const double factor = Law::drive_depends ? drive : 1;
    const Law law = law_;  // a local copy lets the compiler keep the law's parameters in registers
    if (field.smallest_gap >= floor_) {
      // Loop over whole SIMD vectors, so that the compiler uses vector instructions: a scalar loop over the points beside the
      // last whole vector would take as long as this.
      const double* share = share_.data();
      for (Eigen::Index p = begin_ / lanes * lanes; p < share_.size(); p += lanes) {
        double sum[lanes];
        for (Eigen::Index k = 0; k < lanes; ++k)
          sum[k] = load[p + k] + factor * share[p + k] * law.load(gap[p + k], velocity[p + k]);
        // Copy by a loop: memcpy would prevent vector instructions.
        for (Eigen::Index k = 0; k < lanes; ++k) load[p + k] = sum[k];
      }
      return;
    }
    for (Eigen::Index p = begin_; p < end_; ++p) {
      if (!Law::drive_depends && gap[p] >= floor_) {  // above floor_ the tangent, and so a derivative, is not needed
        load[p] += law.load(gap[p], velocity[p]);
        continue;
      }
      const Dual at = law.load(Dual(std::max(gap[p], floor_), 1), Dual(velocity[p]));
      load[p] += factor * (at.value + at.slope * below(gap[p]));
    }
  }

  void add_derivatives(const GapField& field, double drive, double* by_deflection, double* by_velocity) const override {
    if (field.smallest_gap < floor_) return add_tangent_derivatives(field, drive, by_deflection, by_velocity);
    const double* gap = field.gap.data();
    const double* velocity = field.velocity.data();
    const double* share = share_.data();
    const double factor = Law::drive_depends ? drive : 1;
    const Law law = law_;
    for (Eigen::Index p = begin_ / lanes * lanes; p < share_.size(); p += lanes) {
      double by_gap[lanes], by_rate[lanes];
      for (Eigen::Index k = 0; k < lanes; ++k) {
        if constexpr (Law::drive_depends) {
          by_gap[k] = law.load(Dual(gap[p + k], 1), Dual(velocity[p + k])).slope;
        } else {
          const auto both = slopes(law, gap[p + k], velocity[p + k]);
          by_gap[k] = both[0], by_rate[k] = both[1];
        }
      }
      for (Eigen::Index k = 0; k < lanes; ++k) {
        by_deflection[p + k] -= factor * share[p + k] * by_gap[k];  // minus sign: the gap shrinks as the beam deflects
        if constexpr (!Law::drive_depends) by_velocity[p + k] += share[p + k] * by_rate[k];
      }
    }
  }

  void add_curvatures(const GapField& field, double drive, double* by_deflections, double* by_both,
                      double* by_velocities) const override {
    const double factor = Law::drive_depends ? drive : 1;
    for (Eigen::Index p = begin_; p < end_; ++p) {
      // Below floor_ the load is its tangent at floor_. It is linear in the gap, and loads that depend on the velocity are
      // proportional to it, so that only the mixed derivative is not 0: that at floor_.
      const bool is_tangent = field.gap[p] < floor_;
      if (is_tangent && Law::drive_depends) continue;
      const double gap = std::max(field.gap[p], floor_), velocity = field.velocity[p];
      // Returns a second derivative of the load: once by the variable of the outer dual numbers and once by that of the inner
      // ones. An argument of 1 chooses the gap as this variable, 0 the velocity.
      const auto mixed = [&](double gap_outer, double gap_inner) {
        return law_
            .load(DualOf<Dual>(Dual(gap, gap_inner), Dual(gap_outer)),
                  DualOf<Dual>(Dual(velocity, 1 - gap_inner), Dual(1 - gap_outer)))
            .slope.slope;
      };
      if (!is_tangent) by_deflections[p] += factor * mixed(1, 1);
      if constexpr (!Law::drive_depends) {
        by_both[p] -= factor * mixed(1, 0);  // minus sign: the gap shrinks as the beam deflects
        by_velocities[p] += factor * mixed(0, 0);
      }
    }
  }

  [[nodiscard]] double potential(const GapField& field, const Eigen::ArrayXd& weights) const override {
    double sum = 0;
    if constexpr (requires { law_.potential(0.0); }) {
      for (Eigen::Index p = begin_; p < end_; ++p) sum += weights[p] * law_.potential(std::max(field.gap[p], floor_));
      if (begin_ == end_ || field.gap.segment(begin_, end_ - begin_).minCoeff() >= floor_) return sum;
      const Dual at = law_.load(Dual(floor_, 1), Dual());
      for (Eigen::Index p = begin_; p < end_; ++p) {
        const double h = below(field.gap[p]);
        sum += weights[p] * (at.value + at.slope * h / 2) * h;
      }
    }
    return sum;
  }

 private:
  /// Returns the slopes of the load by the gap and by the velocity.
  [[gnu::always_inline]] static std::array<double, 2> slopes(const Law& law, double gap, double velocity) {
    using Both = Gradient<2>;
    const auto along = law.load(Both(gap, Directions<2>::unit(0)), Both(velocity, Directions<2>::unit(1))).slope.along;
    return {along[0], along[1]};
  }
  void add_tangent_derivatives(const GapField& field, double drive, double* by_deflection, double* by_velocity) const {
    const double factor = Law::drive_depends ? drive : 1;
    for (Eigen::Index p = begin_; p < end_; ++p) {
      if (!Law::drive_depends && field.gap[p] >= floor_) {
        const auto [by_gap, by_rate] = slopes(law_, field.gap[p], field.velocity[p]);
        by_deflection[p] -= by_gap, by_velocity[p] += by_rate;
        continue;
      }
      // Below floor_ the load is the tangent at the gap floor_, whose slope by the gap depends on the velocity. Its derivative
      // by the velocity needs the mixed derivative: the outer dual numbers vary the gap, the inner ones the velocity.
      const double gap = std::max(field.gap[p], floor_);
      const auto at = law_.load(DualOf<Dual>(gap, 1), DualOf<Dual>(Dual(field.velocity[p], 1)));
      by_deflection[p] -= factor * at.slope.value;
      by_velocity[p] += factor * (at.value.slope + at.slope.slope * below(field.gap[p]));
    }
  }
  [[nodiscard]] double below(double gap) const { return std::min(gap - floor_, 0.0); }

  Law law_;
  Eigen::Index begin_, end_;
  double floor_;
  Eigen::ArrayXd share_;  // 1 at points on which the law acts, 0 at points that fill the last SIMD vector
};

/// One force law on several parts of the beam, such as the pads of an electrode.
class LawOnPads final : public DistributedLaw {
 public:
  explicit LawOnPads(std::vector<std::shared_ptr<const DistributedLaw>> pads) : pads_(std::move(pads)) {}

  void add_load(const GapField& field, double drive, double* load) const override {
    for (const auto& pad : pads_) pad->add_load(field, drive, load);
  }
  void add_derivatives(const GapField& field, double drive, double* by_deflection, double* by_velocity) const override {
    for (const auto& pad : pads_) pad->add_derivatives(field, drive, by_deflection, by_velocity);
  }
  void add_curvatures(const GapField& field, double drive, double* by_deflections, double* by_both,
                      double* by_velocities) const override {
    for (const auto& pad : pads_) pad->add_curvatures(field, drive, by_deflections, by_both, by_velocities);
  }
  [[nodiscard]] double potential(const GapField& field, const Eigen::ArrayXd& weights) const override {
    double sum = 0;
    for (const auto& pad : pads_) sum += pad->potential(field, weights);
    return sum;
  }

 private:
  std::vector<std::shared_ptr<const DistributedLaw>> pads_;
};

}  // namespace softland
