// Bending modes of a beam (Euler-Bernoulli) under an axial force. Rigidity and mass of the beam are constant or linear over
// each of its sections. The beam is clamped at x = 0 and free or clamped at its far end, or rests on springs at either end.
//
//   (EI(x) phi'')'' - N phi'' = omega^2 mu(x) phi,   phi(0) = phi'(0) = 0
//   free:     (EI phi'')(L) = (EI phi'')'(L) - N phi'(L) = 0          clamped:  phi(L) = phi'(L) = 0
//   springs:  at either end a force k phi and a moment c phi' instead, k [N/m] and c [N m/rad] from 0 to rigid
//
// EI is the rigidity [N m^2], N the axial force, positive in tension [N], mu the mass per length [kg/m], omega [rad/s]. Modes
// are mass-normalised, integral of mu phi_i phi_j = delta_ij, so phi has the unit kg^(-1/2). They are positive at the free end;
// between two clamps they leave x = 0 towards positive values.
//
// Discretisation: the curvature is a polynomial of degree 7 on each element, written in Legendre polynomials, and integrated
// twice from the clamped end; nodes are at every change of section. These functions are orthonormal in the bending energy, so
// the stiffness is the unit matrix whatever the lengths of the elements, and a handful of long elements gives frequencies to
// 1e-9. A far clamp permits only combinations of the functions without value and slope there. Under an axial force the
// combinations are made orthonormal in the elastic energy, so that the stiffness is the unit matrix again. This fails at the
// buckling load in compression, where the straight beam stops being stable. Springs and linear sections add their energies to
// the unit matrix, and springs at x = 0 add the two motions of a rigid beam to the functions.
//
// Source: textbook Ritz-Galerkin; integrated Legendre shape functions: Szabo & Babuska, Finite Element Analysis, 1991, sec. 6;
// axial force and buckling: Timoshenko & Gere, Theory of Elastic Stability, 1961, sec. 2.1.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/beam_section.h"
#include "model/receptance.h"
#include "model/stretching.h"

namespace softland {

/// Returns the reason why the beam cannot rest straight under its axial stress; empty when it can.
[[nodiscard]] std::string why_buckled(const Structure& structure, const std::optional<Surface>& surface = {});

/// Returns the rule of the beam model that the device violates; empty when it violates none.
[[nodiscard]] std::string why_no_beam(const Device& device);

/// The modes of a beam in units of its length and of the mass and rigidity of its first section. Beams of equal proportions
/// have the same normalised modes, whatever their size and material.
class NormalisedModes {
 public:
  /// The properties of a beam on which its normalised modes depend.
  struct Beam {
    struct Section {
      double begin = 0, end = 0, rigidity = 0, mass = 0, taper = 0;
      [[nodiscard]] bool operator==(const Section&) const = default;
    };
    std::vector<Section> sections;
    int modes = 0;
    bool far_clamp = false;
    double axial_force = 0;                   ///< normalised axial force N L^2 / EI of the beam
    double near_rotation = Anchor::rigid;     ///< rotational stiffness of the support at x = 0, in units of EI / L
    double near_translation = Anchor::rigid;  ///< translational stiffness of the support at x = 0, in units of EI / L^3
    /// Stiffnesses of the support at the far end, in units of EI / L and EI / L^3; not used with far_clamp.
    double far_rotation = 0, far_translation = 0;
    /// Returns true when the rigidity of a beam section changes linearly or an end rests on springs.
    [[nodiscard]] bool is_general() const;
    [[nodiscard]] bool operator==(const Beam&) const = default;
  };
  /// Finds the modes of the beam. The search starts from the modes of a similar beam `near` with as many sections and modes if
  /// this converges quickly, and is a full search otherwise. Both searches give the same modes up to rounding. Throws
  /// InvalidInput for a compression beyond the buckling load.
  explicit NormalisedModes(Beam beam, const NormalisedModes* near = nullptr);

  [[nodiscard]] const Beam& beam() const { return beam_; }
  /// Returns 1 / omega^2 of the modes (omega: angular frequency), in descending order.
  [[nodiscard]] const Eigen::VectorXd& inverse_squares() const { return inverse_squares_; }
  /// Returns the values of all modes at x in [0, 1], in units of the beam's length; slope() returns their slopes.
  [[nodiscard]] Eigen::VectorXd value(double x) const { return (shape(x, 0) * shapes_).transpose(); }
  [[nodiscard]] Eigen::VectorXd slope(double x) const { return (shape(x, 1) * shapes_).transpose(); }
  /// Returns the integrals over the beam of the products of the modes' slopes.
  [[nodiscard]] Eigen::MatrixXd slope_products() const;
  /// Returns 1 / omega^2 of the first mode of the beam that is also held at deflection 0 at x. The search starts from `near`,
  /// the result for a similar beam.
  [[nodiscard]] double pinned_inverse_square(double x, std::optional<double> near = {}) const;

 private:
  // Searches all modes of the beam at once by Ritz's method.
  void search();
  // Iterates Rayleigh quotients from the frequencies of the similar beam `near`. Returns false when the modes found may not be
  // those of lowest frequency.
  [[nodiscard]] bool follow(const NormalisedModes& near);
  // Returns a position on the beam at which every mode moves: the receptance at this position has the frequencies of all modes
  // as poles.
  [[nodiscard]] double moving_place() const;
  // Returns the values (derivative 0) or slopes (derivative 1) of all shape functions at a position: x in units of the beam's
  // length, or xi in [-1, 1] along one element.
  [[nodiscard]] Eigen::RowVectorXd shape(double x, int derivative) const;
  [[nodiscard]] Eigen::RowVectorXd shape(const BeamElement& element, double xi, int derivative) const;
  // Returns combinations of the shape functions that the supports of the beam permit, orthonormal in its elastic energy. The
  // shape functions have the values and slopes `end` at the far end; `slopes` has the integrals of products of their slopes.
  [[nodiscard]] Eigen::MatrixXd permitted_motions(const Eigen::MatrixXd& end, const Eigen::MatrixXd& slopes) const;
  // Makes the mode shapes positive at a free end; between two clamps, positive near x = 0.
  void orient();

  Beam beam_;
  std::vector<BeamElement> elements_;
  Eigen::MatrixXd shapes_;  // coefficients of the shape functions for each mode, one column per mode
  Eigen::VectorXd inverse_squares_;
  double moving_place_ = 1;
  // Deflection of the rigid translation and slope of the rigid rotation, which are shape functions of a beam on springs at x =
  // 0; 0 when the support prevents the motion. They are scaled so that the energy of the spring in the motion is below 1.
  double shift_ = 0, turn_ = 0;
  // All modes that Ritz's method finds for a beam on springs or with linear sections: a column of coefficients for each mode,
  // with unit elastic energy, and 1 / omega^2 of each mode.
  Eigen::MatrixXd all_motions_;
  Eigen::VectorXd all_inverse_squares_;
};

class BeamModes {
 public:
  /// Finds the first `modes` modes of a beam. The normalised modes `known` are used if they belong to this beam; otherwise the
  /// search starts from `known`. Throws InvalidInput unless every section begins where the one before ends, lengths, rigidities
  /// and masses are positive, modes is in [1, most_static_modes], and the axial force is above the buckling load.
  BeamModes(const std::vector<BeamSection>& sections, int modes, const BeamSupport& support = {},
            std::shared_ptr<const NormalisedModes> known = {});

  [[nodiscard]] int count() const { return static_cast<int>(frequencies_.size()); }
  /// Returns the angular frequencies of the modes [rad/s], rising.
  [[nodiscard]] const Eigen::VectorXd& angular_frequencies() const { return frequencies_; }
  /// Returns the shapes phi_i of all modes at x in [0, L] [m] [kg^(-1/2)].
  [[nodiscard]] Eigen::VectorXd value(double x) const { return scale_ * normalised_->value(x / length_); }
  /// Returns the slopes phi_i' of all modes at x [m] [kg^(-1/2)/m].
  [[nodiscard]] Eigen::VectorXd slope(double x) const { return scale_ / length_ * normalised_->slope(x / length_); }
  /// Returns the integrals over the beam of phi_i' phi_j', products of the slopes of the modes [1/(kg m)].
  [[nodiscard]] Eigen::MatrixXd slope_products() const { return scale_ * scale_ / length_ * normalised_->slope_products(); }
  /// Returns the first angular frequency of the beam when it is also held at deflection 0 at x [rad/s]: the frequency of the
  /// closed switch, for a contact at x.
  [[nodiscard]] double pinned_frequency(double x) const {
    return frequency_scale_ / std::sqrt(normalised_->pinned_inverse_square(x / length_));
  }

  [[nodiscard]] const std::shared_ptr<const NormalisedModes>& normalised() const { return normalised_; }
  [[nodiscard]] double length() const { return length_; }  ///< length of the beam [m]
  /// Returns the ratio of a mode shape to the normalised mode shape, which is the same for all modes and positions [kg^(-1/2)].
  [[nodiscard]] double scale() const { return scale_; }
  /// Returns the ratio of a mode's angular frequency to its normalised angular frequency [rad/s].
  [[nodiscard]] double frequency_scale() const { return frequency_scale_; }

 private:
  double length_;
  double scale_;
  double frequency_scale_;
  std::shared_ptr<const NormalisedModes> normalised_;
  Eigen::VectorXd frequencies_;
};

/// Returns the modal forces per volt of the piezo layer on a beam with sections or layers: the integrals over the beam of
/// phi_i'' times the moment of the layer per volt [N kg^(-1/2) / V].
[[nodiscard]] Eigen::VectorXd piezo_forces(const Device& device, const BeamModes& modes);

/// Returns the law of mid-plane stretching of a beam between two clamps.
[[nodiscard]] MidPlaneStretching stretching_of(const BeamModes& modes, const Structure& structure);

/// Returns the modes of a device whose structure is a beam; `known` are normalised modes of an equal or similar beam, which
/// make the search faster.
[[nodiscard]] BeamModes beam_modes(const Device& device, std::shared_ptr<const NormalisedModes> known = {});

}  // namespace softland
