// Bending modes of a cantilever of piecewise constant rigidity and mass (Euler-Bernoulli).
//
//   (EI(x) phi'')'' = omega^2 mu(x) phi,   phi(0) = phi'(0) = 0,   (EI phi'')(L) = (EI phi'')'(L) = 0
//
// EI rigidity [N m^2], mu mass per length [kg/m], omega [rad/s]. Modes are mass-normalised, integral of mu phi_i phi_j =
// delta_ij, so phi has the unit kg^(-1/2), and positive at the free end. Discretisation: the curvature is a polynomial of degree
// 7 on each element, written in Legendre polynomials, and integrated twice from the clamped end; nodes stand at every change of
// section. These functions are orthonormal in the bending energy, so the stiffness is the unit matrix whatever the lengths of the
// elements, and a handful of long elements reaches 1e-9. Source: textbook Ritz-Galerkin; integrated Legendre shape functions:
// Szabo & Babuska, Finite Element Analysis, 1991, sec. 6.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/device.h"

namespace softland {

/// One stretch of constant section.
struct BeamSection {
  double begin = 0;            ///< [m]
  double end = 0;              ///< [m]
  double rigidity = 0;         ///< EI [N m^2]
  double mass_per_length = 0;  ///< mu [kg/m]
};

/// Bending of a two-layer section about its own neutral axis.
struct CompositeSection {
  double neutral_axis = 0;     ///< z_c, from the free face of the piezo layer [m]; 0 where there is no layer
  double rigidity = 0;         ///< EI [N m^2]
  double mass_per_length = 0;  ///< [kg/m]
};

/// E of the beam [Pa], or E / (1 - nu^2) with plate_strain.
[[nodiscard]] double bending_modulus(const Structure& structure);
/// The bare beam's section.
[[nodiscard]] CompositeSection plain_section(const Structure& structure);
/// Beam with piezo layer (Zheng, Chen & Chen 2017, eqs. 5-6, equal widths).
[[nodiscard]] CompositeSection layered_section(const Structure& structure, const Piezo& piezo);
/// Bending moment of the layer per volt, e31 a (z_c - bp / 2) with e31 = d31 Ep [N m / V]: negative for d31 < 0.
[[nodiscard]] double piezo_moment_per_volt(const Structure& structure, const Piezo& piezo);
/// The beam's sections in order.
[[nodiscard]] std::vector<BeamSection> beam_sections(const Device& device);

class BeamModes {
 public:
  /// The first `modes` modes. Throws InvalidInput unless sections join, are positive, and modes is in [1, 40].
  BeamModes(std::vector<BeamSection> sections, int modes);

  [[nodiscard]] int count() const { return static_cast<int>(frequencies_.size()); }
  [[nodiscard]] const Eigen::VectorXd& angular_frequencies() const { return frequencies_; }  ///< [rad/s], rising
  /// phi_i(x) of all modes [kg^(-1/2)], x in [0, L] [m].
  [[nodiscard]] Eigen::VectorXd value(double x) const;
  /// phi_i'(x) [kg^(-1/2)/m].
  [[nodiscard]] Eigen::VectorXd slope(double x) const;
  /// First angular frequency of the beam held at deflection 0 at x as well [rad/s]: the beam while in contact.
  [[nodiscard]] double pinned_frequency(double x) const;

 private:
  struct Element {
    double begin = 0, end = 0;  // in units of the length
    double rigidity = 0;        // in units of that of the first section
  };
  // All functions, x in units of the length; xi in [-1, 1] over an element.
  [[nodiscard]] Eigen::RowVectorXd shape(double x, int derivative) const;
  [[nodiscard]] Eigen::RowVectorXd shape(const Element& element, double xi, int derivative) const;

  double length_;
  double scale_;            // converts a unit-mass, unit-length shape to kg^(-1/2)
  double frequency_scale_;  // [rad/s]
  std::vector<Element> elements_;
  Eigen::MatrixXd mass_;    // dimensionless
  Eigen::MatrixXd shapes_;  // functions x modes
  Eigen::VectorXd frequencies_;
};

}  // namespace softland
