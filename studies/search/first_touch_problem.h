// A switch on its way to the first touch, as a dimensionless system that is to be steered in the least time.
//
//   z_i = q_i s_i / g        u_i = q_i' s_i / (g omega_i)        time in 1 / omega_1
//
// The symbols are: q modal coordinates, omega natural frequencies, g contact gap, s_i displacement of the contact point by mode
// i. A mode with a node there has a tenth of the largest s_i. z_i is the part of mode i in the way to the contact. A control is
// the strength of a drive over its largest: that of Switch::strength() for an electrode, the voltage of a piezo. The motion is
// linear in it, and the quickest control jumps between its bounds. If the driver's slew is limited, the control is the voltage
// over its largest, and linear between knots.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/switch.h"
#include "optimizers/collocation.h"
#include "studies/closing/prepared.h"
#include "studies/search/search_space.h"
#include "waveforms/signal.h"

namespace softland {

class FirstTouchProblem final : public ControlledSystem {
 public:
  /// Keeps a reference. The drives that the actuator shapes are free within their limits, electrodes only up to `peak` volts if
  /// the driver gives more. The other drives stand at their values in the plain step. Throws InvalidInput for a scene that
  /// lacks the drive or its limits, whose gas film is compressible, or that does not rest above its contact.
  FirstTouchProblem(const PreparedScene& prepared, Actuator actuator, double peak = std::numeric_limits<double>::infinity());

  [[nodiscard]] Eigen::Index states() const override { return 2 * modes_; }
  [[nodiscard]] Eigen::Index controls() const override { return static_cast<Eigen::Index>(free_.size()); }
  [[nodiscard]] bool depends(Eigen::Index r, Eigen::Index k) const override { return r >= modes_ || k == modes_ + r; }
  [[nodiscard]] Rates rates(const Eigen::VectorXd& x, const Eigen::VectorXd& c) override;
  [[nodiscard]] Eigen::MatrixXd curvature(const Eigen::VectorXd& x, const Eigen::VectorXd& c,
                                          const Eigen::VectorXd& multipliers) override;

  [[nodiscard]] const std::vector<ControlBound>& bounds() const { return bounds_; }
  [[nodiscard]] bool ramps() const { return ramps_; }
  [[nodiscard]] double time_unit() const { return 1 / omega_[0]; }  ///< [s]
  /// Position and velocity of the contact point in gaps and gaps per unit of time, as rows over a state.
  [[nodiscard]] const Eigen::VectorXd& tip() const { return tip_; }
  [[nodiscard]] const Eigen::VectorXd& tip_speed() const { return tip_speed_; }
  [[nodiscard]] double speed_unit() const { return gap_ * omega_[0]; }  ///< [m/s]
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }
  struct Landing {
    Eigen::VectorXd state, controls;
  };
  /// The beam at rest on the contact plane under the hold levels of all drives; none if the contact would have to pull. If the
  /// slew is limited, the free drives hold only the least share that keeps the switch closed. A larger share would bring a
  /// contact point to rest on the plane from behind it.
  [[nodiscard]] std::optional<Landing> landing() const;

  /// The quickest way by a single swing: full pull, and from a time on full release, so that the contact point turns back as it
  /// arrives. None if full pull does not reach the contact within `longest` [s].
  [[nodiscard]] std::optional<ControlledCourse> swing(double longest) const;
  /// The flight under signals of all drives until it first touches, as a course of `intervals` intervals of the controls. The
  /// controls are the signals of the free drives, clamped to their bounds. None if it does not touch within `longest` [s].
  [[nodiscard]] std::optional<ControlledCourse> flown(std::span<const Signal> signals, int intervals, double longest) const;
  /// The voltages of the free drives at a control [V].
  [[nodiscard]] std::map<std::string, double> volts(const Eigen::VectorXd& c) const;
  /// The slew limit of a free drive's driver [V/s].
  [[nodiscard]] double max_slew(const std::string& drive) const;
  /// The controls that pull most, and that release most.
  [[nodiscard]] const Eigen::VectorXd& pull() const { return pull_; }

 private:
  struct Free {
    std::size_t drive;
    std::string name;
    double largest;   ///< strength, or voltage where its slew is limited
    double sign;      ///< sign of the voltage by which an electrode acts: it pulls with either
    double max_slew;  ///< [V/s]
  };
  [[nodiscard]] double strength(std::size_t drive, double value) const;
  [[nodiscard]] std::vector<double> strengths(const Eigen::VectorXd& c) const;
  [[nodiscard]] std::vector<double> held_levels(double share_of_free) const;
  [[nodiscard]] double least_closing_share() const;
  [[nodiscard]] double control(const Free& f, double volts) const;
  [[nodiscard]] double strength_slope(const Free& f, double c) const;
  void add_free(const PreparedScene& prepared, const std::string& name, double peak, bool brakes);

  const Switch& model_;
  Eigen::Index modes_;
  double gap_;
  Eigen::VectorXd omega_, per_q_, per_v_, per_acceleration_, tip_, tip_speed_, start_, pull_, release_;
  std::vector<double> held_;  ///< strengths of all drives; those of free ones do not count
  std::vector<double> hold_;  ///< values of all drives after the landing
  std::vector<Free> free_;
  std::vector<ControlBound> bounds_;
  bool ramps_ = false;
  Switch::Workspace work_;
};

}  // namespace softland
