// The motion of a switch until its first contact, as a dimensionless control problem of least time.
//
//   z_i = q_i s_i / g        u_i = q_i' s_i / (g omega_i)        time in 1 / omega_1
//
// The symbols are: q modal coordinates, omega natural frequencies, g contact gap, s_i displacement of the contact point by mode
// i. A mode with a node at the contact point has a tenth of the largest s_i. z_i is the displacement of the contact point by
// mode i, in gaps. A control is the strength of a drive over its largest strength: Switch::strength() of an electrode, the
// voltage of a piezo. The motion is linear in the controls, and the quickest control jumps between its bounds. If the slew of
// the voltage source is limited, the control is the voltage over the largest voltage, and linear between knots (points in
// time).
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
  /// Keeps a reference to `prepared`. The controlled drives are those of the actuator, within their limits and, for electrodes,
  /// up to `peak` [V]. The other drives stay at their values in the plain step. Throws InvalidInput for a scene that lacks the
  /// drive or its limits, whose gas film is compressible, or whose open switch does not rest above its contact.
  FirstTouchProblem(const PreparedScene& prepared, Actuator actuator, double peak = std::numeric_limits<double>::infinity());

  [[nodiscard]] Eigen::Index states() const override { return 2 * modes_; }
  [[nodiscard]] Eigen::Index controls() const override { return static_cast<Eigen::Index>(free_.size()); }
  [[nodiscard]] bool depends(Eigen::Index r, Eigen::Index k) const override { return r >= modes_ || k == modes_ + r; }
  [[nodiscard]] Rates rates(const Eigen::VectorXd& x, const Eigen::VectorXd& c) override;
  [[nodiscard]] Eigen::MatrixXd curvature(const Eigen::VectorXd& x, const Eigen::VectorXd& c,
                                          const Eigen::VectorXd& multipliers) override;

  [[nodiscard]] const std::vector<ControlBound>& bounds() const { return bounds_; }
  [[nodiscard]] bool ramps() const { return ramps_; }
  [[nodiscard]] double time_unit() const { return 1 / omega_[0]; }  ///< unit of the dimensionless time, 1 / omega_1 [s]
  /// Row vectors whose products with a state are position [gap] and velocity [gap per time unit] of the contact point.
  [[nodiscard]] const Eigen::VectorXd& tip() const { return tip_; }
  [[nodiscard]] const Eigen::VectorXd& tip_speed() const { return tip_speed_; }
  /// Unit of the dimensionless velocity, contact gap times omega_1 [m/s].
  [[nodiscard]] double speed_unit() const { return gap_ * omega_[0]; }
  [[nodiscard]] const Eigen::VectorXd& start() const { return start_; }
  struct Landing {
    Eigen::VectorXd state, controls;
  };
  /// Returns the beam at rest on the contact plane under the hold levels of all drives; none if the contact force would have to
  /// be tensile. If the slew is limited, the controlled drives have the smallest share of their hold levels that keeps the
  /// switch closed: with a larger share, the pull would leave no motion that comes to rest on the contact plane from the open
  /// side.
  [[nodiscard]] std::optional<Landing> landing() const;

  /// Returns the quickest single swing to the contact: full pull, then full release, so that the contact point turns back as it
  /// arrives. Full pull alone, up to the touch, where the swing is overdamped. Nothing if full pull does not reach the contact
  /// within `longest` [s].
  [[nodiscard]] std::optional<ControlledCourse> swing(double longest) const;
  /// Simulates the motion until first contact under signals of all drives, and returns it with the controls averaged over
  /// `intervals` equal intervals and clamped to their bounds. Nothing if the switch does not make contact within `longest` [s].
  [[nodiscard]] std::optional<ControlledCourse> flown(std::span<const Signal> signals, int intervals, double longest) const;
  /// Returns the voltages of the controlled drives at the values `c` of the controls, by drive [V].
  [[nodiscard]] std::map<std::string, double> volts(const Eigen::VectorXd& c) const;
  /// Returns the slew limit of a controlled drive's voltage source [V/s].
  [[nodiscard]] double max_slew(const std::string& drive) const;
  /// Returns the values of the controls (dimensionless drive strengths) that pull most towards the contact.
  [[nodiscard]] const Eigen::VectorXd& pull() const { return pull_; }

 private:
  struct Free {
    std::size_t drive;
    std::string name;
    double largest;   ///< largest strength of the drive, or its largest voltage if the slew is limited: the unit of its control
    double sign;      ///< sign of the electrode's voltages, -1 if its limits allow more voltage below 0 V
    double max_slew;  ///< slew limit of the drive's voltage source [V/s]
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
  std::vector<double> held_;  ///< strengths of the drives that are not controlled; other entries have no meaning
  std::vector<double> hold_;  ///< voltages of all drives that hold the closed switch [V]
  std::vector<Free> free_;
  std::vector<ControlBound> bounds_;
  bool ramps_ = false;
  Switch::Workspace work_;
};

}  // namespace softland
