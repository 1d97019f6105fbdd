// The undamped modes of a structure: frequencies, mass-normalised shapes at its contacts and its piezo layer, and quantities
// that depend on modal coordinates alone.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/lanes.h"
#include "model/device.h"
#include "model/modal_projection.h"

namespace softland {

struct SampledModes;

class ModalBasis {
 public:
  /// Factors by which lengths, mode shapes and frequencies of the normalised modes are multiplied for the structure.
  struct Scales {
    double length = 0;     ///< length of the structure [m]
    double shape = 0;      ///< ratio of a mode shape to the normalised mode shape [kg^(-1/2)]
    double frequency = 0;  ///< ratio of an angular frequency to the normalised one [rad/s]
  };
  ModalBasis() = default;
  /// `piezo` has the modal forces per volt of the piezo layer of a beam with sections or layers; none for a uniform beam, for
  /// which a formula gives these forces.
  ModalBasis(Eigen::VectorXd angular_frequencies, const Scales& scales, const SampledModes& sampled, const Device& device,
             const std::optional<Eigen::VectorXd>& piezo = {});

  [[nodiscard]] int modes() const { return static_cast<int>(frequencies_.size()); }
  /// Angular frequencies of the undamped modes [rad/s].
  [[nodiscard]] const Eigen::VectorXd& angular_frequencies() const { return frequencies_; }
  /// Returns the squares of the modes' angular frequencies [rad^2/s^2].
  [[nodiscard]] const Eigen::VectorXd& squares() const { return squares_; }
  /// Returns the mode shapes at the contact point [kg^(-1/2)].
  [[nodiscard]] const Eigen::VectorXd& contact_shape() const { return contact_shape_; }
  /// Returns the mode shapes at each of the contacts after the first [kg^(-1/2)].
  [[nodiscard]] const std::vector<Eigen::VectorXd>& further_contact_shapes() const { return further_contact_shapes_; }
  /// Returns the slopes phi_i' of the modes at the contact point, for a contact that acts along the pad [kg^(-1/2)/m]; 0 for
  /// all other contacts.
  [[nodiscard]] const Eigen::VectorXd& pad_slope() const { return pad_slope_; }
  /// Returns the force on each mode per volt on the piezo layer [N kg^(-1/2) / V]; zero without a layer.
  [[nodiscard]] const Eigen::VectorXd& piezo_shape() const { return piezo_shape_; }
  /// Period of the first mode of the beam held at its contact point [s].
  [[nodiscard]] double in_contact_period() const { return in_contact_period_; }

  /// Returns the deflection of the contact point [m] from modal coordinates, or its velocity [m/s] from modal velocities.
  [[nodiscard]] double contact_deflection(const double* q) const {
    return deflection<double>({contact_shape_.data(), static_cast<std::size_t>(modes())}, q);
  }
  /// Returns the slope of the beam at the contact pad, for a contact along the pad; 0 for all other contacts.
  [[nodiscard]] double pad_tilt(const double* q) const { return at(q).dot(pad_slope_); }
  /// Returns the static deflection of the contact point per volt on the piezo, without any other force and for small
  /// deflections [m/V]; 0 without a layer. The deflection is positive towards the electrodes.
  [[nodiscard]] double piezo_deflection() const { return contact_shape_.cwiseQuotient(squares_).dot(piezo_shape_); }
  /// Returns the charge that the deflection of the beam puts on the piezo's electrodes by the piezoelectric effect [C]; the
  /// charge of the layer's capacitance (piezo_layer.h) is not included.
  [[nodiscard]] double piezo_charge(const double* q) const { return at(q).dot(piezo_shape_); }
  /// Returns the kinetic energy of the modes [J].
  [[nodiscard]] double kinetic_energy(const double* v) const { return at(v).squaredNorm() / 2; }
  /// Returns the elastic energy of the modes [J].
  [[nodiscard]] double bending_energy(const double* q) const { return at(q).cwiseAbs2().dot(squares_) / 2; }
  [[nodiscard]] Eigen::Map<const Eigen::VectorXd> at(const double* q) const {
    return Eigen::Map<const Eigen::VectorXd>(q, modes());
  }

  /// Returns the modal forces of stiffness, of modal damping, of a piezo at the voltage `piezo` [V], and of the force `push` at
  /// the contact point [N], for a SIMD vector of modes that begins with mode i of the n = modes() modes.
  [[gnu::always_inline]] [[nodiscard]] Lane forces(std::size_t i, std::size_t n, const double* q, const double* v, double piezo,
                                                   double push) const {
    return piezo * lane(piezo_lanes_, i) - push * lane(contact_lanes_, i) - lane(stiffness_lanes_, i) * load_lane(q, i, n) -
           lane(friction_lanes_, i) * load_lane(v, i, n);
  }

 private:
  std::vector<Eigen::VectorXd> further_contact_shapes_;
  Eigen::VectorXd frequencies_, squares_, contact_shape_, pad_slope_, piezo_shape_;
  // Squared frequency, damping rate, mode shape at the contact point and piezo force per volt of each mode, padded to whole
  // SIMD vectors.
  std::vector<double> stiffness_lanes_, friction_lanes_, contact_lanes_, piezo_lanes_;
  double in_contact_period_ = 0;
};

}  // namespace softland
