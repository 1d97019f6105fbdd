// Derivatives of a switch by parameters of its device: central differences of two switches with a larger and a smaller
// parameter.
//
//   F_p = [F(q + h r, v; p + h) - F(q - h r, v; p - h)] / 2h - F_q r          at fixed q and v
//
// p is the parameter [its SI unit], h half the step between the two switches, F modal accelerations, F_q their derivative by q
// in the switch itself. r is 0 when no contact acts. An interference is nanometres: a step that moves the contact plane must
// not change it. r is then the shift along the static deflection of the contact point that keeps the interference. The effect
// of the plane's motion on the force comes from F_q, which is exact. So all properties of a device are included: frequencies
// and shapes of the modes, which keep their normalisation and sign, places of electrodes and contact, laws of forces and gas.
//
// Steps of 3e-5 of a parameter give F_p with an error of about 1e-7: the truncation error grows with the square of the step,
// and the effect of rounding errors of the modes with its inverse.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "model/switch.h"

namespace softland {

class SwitchSlopes {
 public:
  /// Recommended step of a device parameter to either side, as a share of the parameter.
  static constexpr double step = 3e-5;

  struct Neighbours {
    Switch above, below;
    double distance = 0;         ///< difference of the parameter between the two switches [its SI unit]
    bool acts_in_flight = true;  ///< true when modal accelerations depend on the parameter while no contact acts
  };
  /// `neighbours` are the two switches for each parameter; none for a parameter on which the switch does not depend. Keeps a
  /// reference to `model`. Throws InvalidInput when a neighbour has another number of modes or drives, or another kind of
  /// contact.
  SwitchSlopes(const Switch& model, std::vector<std::optional<Neighbours>> neighbours);

  [[nodiscard]] std::size_t parameters() const { return parameters_; }
  /// Returns the parameters on which the switch depends. The functions below take the index j in this list.
  [[nodiscard]] const std::vector<std::size_t>& moving() const { return moving_; }

  /// Returns the derivative by parameter j of the interference of the contact point (its deflection less the contact gap) at
  /// fixed modal coordinates q [m per unit].
  [[nodiscard]] double interference(std::size_t j, const double* q) const;
  /// Returns the derivative by parameter j of the contact point's velocity at fixed modal velocities v [m/s per unit].
  [[nodiscard]] double velocity(std::size_t j, const double* v) const;
  /// Returns the derivative by parameter j of the interference at which the contact law changes from one of its curves to
  /// another [m per unit]. It is 0 for the contact plane, and counts as 0 for the end of a residual dent, where no force begins
  /// and so the derivative has no effect. For any other change it is the derivative of the law's reach, or of the interference
  /// at which the force has a kink.
  [[nodiscard]] double edge(std::size_t j, double interference) const;
  /// Returns the derivative by parameter j of a function f(law) of the contact law.
  template <class F>
  [[nodiscard]] double of_contact(std::size_t j, F&& f) const {
    const Neighbours& n = neighbours_[j];
    return (f(n.above.contact()) - f(n.below.contact())) / n.distance;
  }
  /// Returns the derivative by parameter j of a figure of the whole switch, f(switch, step). f receives a neighbouring switch,
  /// and the difference of its parameter to that of `model`.
  template <class F>
  [[nodiscard]] auto of_switch(std::size_t j, F&& f) const {
    const Neighbours& n = neighbours_[j];
    return decltype(f(n.above, n.distance))((f(n.above, n.distance / 2) - f(n.below, -n.distance / 2)) / n.distance);
  }
  /// Computes the derivative by parameter j of the modal accelerations at fixed modal coordinates q and velocities v. `by_q` is
  /// their derivative by q in this state: modes x modes.
  void accelerations(std::size_t j, const double* q, const double* v, std::span<const double> volts, const ContactState& contact,
                     const Eigen::Ref<const Eigen::MatrixXd>& by_q, Eigen::Ref<Eigen::VectorXd> result);

 private:
  const Switch& model_;
  std::size_t parameters_;
  std::vector<std::size_t> moving_;
  // The two switches with a smaller and a larger parameter, for each parameter on which the switch depends.
  std::vector<Neighbours> neighbours_;
  std::vector<Switch::Workspace> above_, below_;
  // Static deflection under a force at the contact point, scaled to 1 m there: the direction r of the shift.
  Eigen::VectorXd deflection_;
};

}  // namespace softland
