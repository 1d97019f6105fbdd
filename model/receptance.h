// Receptance of a beam: its deflection at a place under a harmonic unit force there, without damping.
//
//   a(lambda) = sum over modes of phi_i(x)^2 / (lambda_i - lambda),   lambda = omega^2
//
// The poles of the receptance are the natural frequencies, its zeros those of the beam that is also held at x. Units and
// functions are those of NormalisedModes (model/beam.h). The quadratic form of elastic less kinetic energy is eliminated
// element by element from the far end to the clamp at x = 0, as in a linear-quadratic control problem. The part beyond a node
// acts as a stiffness of two by two at the node, so that short elements cost no digits. The time is proportional to the number
// of elements. There are as many negative pivots as natural frequencies below lambda (Sylvester's law of inertia; Wittrick &
// Williams, Q. J. Mech. Appl. Math. 24 (1971) 263). Near a pole the quotient of a and its derivative by lambda is the step from
// lambda to the Rayleigh quotient of the motion.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/lanes.h"

namespace softland {

/// Shape functions of a beam element: curvatures up to degree 7, so deflections up to degree 9.
inline constexpr int element_functions = 8;
using ElementRow = Eigen::Matrix<double, 1, element_functions>;

/// Returns the shape functions of one element, which are 0 left of the element, at xi in [-1, 1]: first (derivative 1) or
/// second (0) integrals of the Legendre polynomials P_m from -1. For m >= 2 both integrals vanish at the right end.
[[nodiscard]] ElementRow element_integrals(double xi, int derivative);

struct BeamElement {
  double begin = 0, end = 0;  // begin and end of the element, in units of the beam's length
  double rigidity = 0, mass = 0;
  double taper = 0;  // growth of rigidity and mass from the element's middle to its end, relative, linear in between

  [[nodiscard]] double half() const { return (end - begin) / 2; }
};

/// Returns integrals over the beam of the products of slopes of its motions. A motion is a column of factors of the shape
/// functions; `first_slopes` are the slopes of the motions at x = 0, or 0 if absent.
[[nodiscard]] Eigen::MatrixXd slope_products(const std::vector<BeamElement>& elements, const Eigen::MatrixXd& motions,
                                             const std::optional<Eigen::RowVectorXd>& first_slopes = {});

/// Computes the receptance for up to four squared frequencies lambda at once, for elements without taper.
class Receptance {
 public:
  /// Takes the elements of the beam, the axial force, positive in tension, and whether the far end is clamped.
  Receptance(const std::vector<BeamElement>& elements, double axial_force, bool far_clamp);

  struct Answer {
    Lane deflection;   ///< receptance: deflection by a unit force
    Lane inertia;      ///< derivative of the receptance by the squared frequency, the integral of mass times squared deflection
    Lane below;        ///< number of natural frequencies of the beam below lambda
    Lane least_pivot;  ///< smallest pivot except the last, which is 0 at a pole: small pivots magnify rounding
  };
  /// Returns the receptance of the beam at the position x in (0, 1], for one squared frequency per SIMD lane.
  [[nodiscard]] Answer at(const Lane& lambda, double x);
  /// Returns the motion of the beam for the squared frequency in a SIMD lane of the last call of at(): factors of the shape
  /// functions, which are orthonormal in bending energy.
  [[nodiscard]] Eigen::VectorXd motion(Eigen::Index lane) const;

 private:
  // Number of motions of an element: deflection and rotation of the rigid element, then its shape functions.
  static constexpr int size = 2 + element_functions;
  static constexpr int kept = 4;  // number of motions of an element that move its right end
  // Elements of equal size and section share their quadratic form of elastic less kinetic energy, a lower triangle, from which
  // the motions from index `kept` on are eliminated.
  struct ElementKind {
    double half = 0, rigidity = 0, mass = 0;
    double reach = 0;  // factor that scales a dimensionless shape function to unit bending energy
    Lane form[size][size];
    Lane inverse[size];          // inverse pivots of this elimination
    Lane negative, least_pivot;  // number of negative pivots, and smallest pivot, of this elimination

    [[nodiscard]] bool holds(const BeamElement& e) const;
  };
  // Quadratic form (elastic less kinetic energy) and load of an element together with all elements towards the far end, for the
  // first `kept` motions of the element.
  struct Stage {
    std::size_t kind = 0;
    Lane form[kept][kept];
    Lane load[kept], inverse[3];
    Lane motion[size];
  };

  void condense(ElementKind& kind, const Lane& lambda) const;
  void load(double x);
  void add_beyond(Stage& stage, const ElementKind& kind, const Lane* stiffness, const Lane* force) const;
  void fix_end(Stage& stage, const ElementKind& kind) const;
  void sweep_to_clamp(Answer& answer);
  void sweep_to_end(Answer& answer);

  double axial_force_;
  bool far_clamp_;
  std::vector<ElementKind> kinds_;
  std::vector<Stage> stages_;
  std::vector<double> nodes_;  // ends of the elements, in units of the beam's length
  std::size_t loaded_ = 0;     // index of the element that contains the loaded position x
  double probe_[size] = {};    // deflections at x of the motions of the loaded element
  Lane load_[size];            // load of a unit force at x, eliminated like the quadratic form
};

}  // namespace softland
