// Bending modes of a beam of piecewise constant rigidity and mass (Euler-Bernoulli), clamped at x = 0, its far end free or
// clamped, under an axial force.
//
//   (EI(x) phi'')'' - N phi'' = omega^2 mu(x) phi,   phi(0) = phi'(0) = 0
//   free:     (EI phi'')(L) = (EI phi'')'(L) - N phi'(L) = 0          clamped:  phi(L) = phi'(L) = 0
//
// EI rigidity [N m^2], N axial force, positive in tension [N], mu mass per length [kg/m], omega [rad/s]. Modes are
// mass-normalised, integral of mu phi_i phi_j = delta_ij, so phi has the unit kg^(-1/2), and positive at the free end; between
// two clamps they leave x = 0 towards positive values. Discretisation: the curvature is a polynomial of degree 7 on each element,
// written in Legendre polynomials, and integrated twice from the clamped end; nodes stand at every change of section. These
// functions are orthonormal in the bending energy, so the stiffness is the unit matrix whatever the lengths of the elements, and
// a handful of long elements reaches 1e-9. A far clamp leaves the combinations with no value and no slope there, and an axial
// force makes them orthonormal in the elastic energy anew: what follows sees a unit stiffness again. In compression that fails at
// the buckling load, where the straight beam stops being stable. Source: textbook Ritz-Galerkin; integrated Legendre shape
// functions: Szabo & Babuska, Finite Element Analysis, 1991, sec. 6; axial force and buckling: Timoshenko & Gere, Theory of
// Elastic Stability, 1961, sec. 2.1.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
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
/// The bare beam's section, with the skins it may have.
[[nodiscard]] CompositeSection plain_section(const Structure& structure, const std::optional<Surface>& surface = {});
/// Beam with piezo layer (Zheng, Chen & Chen 2017, eqs. 5-6, equal widths).
[[nodiscard]] CompositeSection layered_section(const Structure& structure, const Piezo& piezo);
/// Bending moment of the layer per volt, e31 a (z_c - bp / 2) with e31 = d31 Ep [N m / V]: negative for d31 < 0.
[[nodiscard]] double piezo_moment_per_volt(const Structure& structure, const Piezo& piezo);
/// The beam's sections in order.
[[nodiscard]] std::vector<BeamSection> beam_sections(const Device& device);
/// What residual_stress leaves in the released beam between two clamps [Pa]: all of a stress along the beam; of the equal biaxial
/// stress of a film, sigma (1 - nu), since the beam's sides are free and its strain along the beam is held.
[[nodiscard]] double axial_stress(const Structure& structure);
/// Compressive stress at which the beam buckles [Pa], E I as plain_section(): 4 pi^2 E I / (A L^2) between two clamps, a
/// sixteenth of that with a free end.
[[nodiscard]] double buckling_stress(const Structure& structure, const std::optional<Surface>& surface = {});

/// Why the beam cannot rest straight under its axial stress; empty when it can.
[[nodiscard]] std::string why_buckled(const Structure& structure, const std::optional<Surface>& surface = {});

struct BeamSupport {
  bool far_clamp = false;  ///< the end at L is clamped as well
  double axial_force = 0;  ///< N, positive in tension [N]
};
/// Clamps, and the axial force that residual stresses of bulk and surfaces leave.
[[nodiscard]] BeamSupport beam_support(const Structure& structure, const std::optional<Surface>& surface = {});

class BeamModes {
 public:
  /// The first `modes` modes. Throws InvalidInput unless sections join, are positive, modes is in [1, 40], and the axial force is
  /// above the buckling load.
  BeamModes(const std::vector<BeamSection>& sections, int modes, const BeamSupport& support = {});

  [[nodiscard]] int count() const { return static_cast<int>(frequencies_.size()); }
  [[nodiscard]] const Eigen::VectorXd& angular_frequencies() const { return frequencies_; }  ///< [rad/s], rising
  /// phi_i(x) of all modes [kg^(-1/2)], x in [0, L] [m].
  [[nodiscard]] Eigen::VectorXd value(double x) const;
  /// phi_i'(x) [kg^(-1/2)/m].
  [[nodiscard]] Eigen::VectorXd slope(double x) const;
  /// Integrals of phi_i' phi_j' over the beam [1/(kg m)].
  [[nodiscard]] const Eigen::MatrixXd& slope_products() const { return slope_products_; }
  /// First angular frequency of the beam held at deflection 0 at x as well [rad/s]: the beam while in contact.
  [[nodiscard]] double pinned_frequency(double x) const;

 private:
  struct Element {
    double begin = 0, end = 0;  // in units of the length
    double rigidity = 0;        // in units of that of the first section
  };
  // Combines the functions to those that the support permits, orthonormal in the elastic energy.
  void support_by(const BeamSupport& support, const Eigen::MatrixXd& slopes);
  // All functions, x in units of the length; xi in [-1, 1] over an element.
  [[nodiscard]] Eigen::RowVectorXd shape(double x, int derivative) const;
  [[nodiscard]] Eigen::RowVectorXd shape(const Element& element, double xi, int derivative) const;
  [[nodiscard]] Eigen::RowVectorXd combined(double x, int derivative) const { return shape(x, derivative) * basis_; }

  double length_;
  double scale_;            // converts a unit-mass, unit-length shape to kg^(-1/2)
  double frequency_scale_;  // [rad/s]
  double rigidity_;         // of the first section [N m^2]
  std::vector<Element> elements_;
  Eigen::MatrixXd basis_;   // functions x combinations
  Eigen::MatrixXd mass_;    // of the combinations, dimensionless
  Eigen::MatrixXd shapes_;  // functions x modes
  Eigen::MatrixXd slope_products_;
  Eigen::VectorXd frequencies_;
};

}  // namespace softland
