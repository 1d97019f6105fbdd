// Optimal control by direct collocation: of all controls that take a system from where it begins to where it has to end, the one
// that takes the least time, or ends best.
//
//   minimise T, or e.x(T)    over T, c(.)    subject to  x' = f(x, c) on [0, T],  x(0) = x_0,  lower <= c <= upper,  |c'| <=
//   slew,
//                                                         rows on the way and at the end:  lower <= r.x <= upper
//
// x states, c controls, T the time. Transcription: on each piece of the mesh x is a polynomial of degree three that fulfils the
// differential equations at the three Radau points (Radau IIA, of fifth order at the ends of pieces; Hairer & Wanner, Solving
// Ordinary Differential Equations II, 1996, sec. IV.5). A control is constant between its knots, or linear where its slew is
// bounded; the knots are fractions of T, and a mesh of their own may divide what lies between them. The nonlinear program with
// its sparse, exact first and second derivatives is solved by Ipopt (Betts, Practical Methods for Optimal Control, 2010, ch. 4).
// Knows nothing of switches. All quantities should be of the order of one: the caller scales.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace softland {

/// x' = f(x, c), with derivatives.
class ControlledSystem {
 public:
  virtual ~ControlledSystem() = default;
  [[nodiscard]] virtual Eigen::Index states() const = 0;
  [[nodiscard]] virtual Eigen::Index controls() const = 0;
  /// Whether rate `r` can depend on entry `k` of (x, c): what cannot is left out of the sparse matrices.
  [[nodiscard]] virtual bool depends(Eigen::Index r, Eigen::Index k) const = 0;
  struct Rates {
    Eigen::VectorXd value;  ///< f
    Eigen::MatrixXd slope;  ///< by (x, c): states rows
  };
  [[nodiscard]] virtual Rates rates(const Eigen::VectorXd& x, const Eigen::VectorXd& c) = 0;
  /// Second derivatives of multipliers.f by (x, c): symmetric.
  [[nodiscard]] virtual Eigen::MatrixXd curvature(const Eigen::VectorXd& x, const Eigen::VectorXd& c,
                                                  const Eigen::VectorXd& multipliers) = 0;
};

/// lower <= row.x <= upper
struct StateCondition {
  Eigen::VectorXd row;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

struct ControlBound {
  double lower = 0;
  double upper = 1;
  /// Largest |c'|: the control is linear between its knots and begins at `before`. Infinite: constant between them, with jumps.
  double slew = std::numeric_limits<double>::infinity();
  double before = 0;
  /// What a control with a slew ends on, where that is given.
  std::optional<double> after = {};
};

struct ControlProblem {
  ControlledSystem* system = nullptr;
  Eigen::VectorXd start = {};                   ///< x_0
  std::vector<ControlBound> bounds = {};        ///< one per control; all with jumps, or all with a slew
  std::vector<StateCondition> on_the_way = {};  ///< at the ends of all pieces but the last
  std::vector<StateCondition> at_the_end = {};
  double shortest = 0, longest = 0;               ///< bounds of T
  std::optional<Eigen::VectorXd> ends_best = {};  ///< e; none: the least time
  std::vector<double> knots = {};                 ///< of the controls, fractions of T from 0 to 1
  double longest_piece = 1;                       ///< of the mesh, a fraction of T
  long max_iterations = 500;
  double tolerance = 1e-8;                  ///< of the optimality conditions
  const std::atomic<bool>* stop = nullptr;  ///< set from outside: ends the solve
};

/// A control and the course of the states under it.
struct ControlledCourse {
  bool converged = false;
  bool interrupted = false;
  std::string message = {};  ///< of Ipopt
  int iterations = 0;
  double time = 0;                  ///< T
  std::vector<double> knots = {};   ///< fractions of T
  Eigen::MatrixXd controls = {};    ///< a column per interval between knots, or per knot where a slew is bounded
  std::vector<double> points = {};  ///< fractions of T: 0, then the points of collocation
  Eigen::MatrixXd states = {};      ///< a column per point
  [[nodiscard]] Eigen::VectorXd state_at(double fraction) const;  ///< linear between points
  [[nodiscard]] Eigen::VectorXd control_at(double fraction) const;
};

/// Solves the problem from a guess, any course of the same states and controls; it need not fulfil anything. Throws InvalidInput
/// for a problem whose parts do not fit; numerical trouble is in the result.
[[nodiscard]] ControlledCourse solve(const ControlProblem& problem, const ControlledCourse& guess);

/// Knots with those intervals halved, of at least `shortest`, in which a control is about to change, and their neighbours.
[[nodiscard]] std::vector<double> refined_knots(const ControlledCourse& course, const std::vector<ControlBound>& bounds,
                                                double shortest);

}  // namespace softland
