// Optimal control by direct collocation: among all controls that take a system from its start to its required end, find the
// control that takes the least time T, or ends in the best state.
//
//   minimise T, or e.x(T)    over T, c(.)    subject to  x' = f(x, c) on [0, T],  x(0) = x_0,
//                                                         lower <= c <= upper,  |c'| <= slew,
//                                                         state conditions at t <= T:  lower <= r.x <= upper
//
// x are the states, c the controls, T the time. Transcription: on each piece of the mesh x is a polynomial of degree three. It
// fulfils the differential equations at the three Radau points (Radau IIA, of fifth order at the ends of pieces; Hairer &
// Wanner, Solving Ordinary Differential Equations II, 1996, sec. IV.5). A control is constant between its knots, or linear
// where its slew is bounded. The knots are fractions of T; the mesh of the states may divide the intervals between them. Ipopt
// solves the nonlinear program with its sparse, exact first and second derivatives (Betts, Practical Methods for Optimal
// Control, 2010, ch. 4). The code is independent of switches. All quantities should be of the order of one: the caller scales.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace softland {

/// A controlled system x' = f(x, c) with states x and controls c, and the derivatives of f.
class ControlledSystem {
 public:
  virtual ~ControlledSystem() = default;
  [[nodiscard]] virtual Eigen::Index states() const = 0;
  [[nodiscard]] virtual Eigen::Index controls() const = 0;
  /// Returns true when the rate of state `r` can depend on variable `k`, counted through the states x and then the controls c.
  /// Derivatives by other variables are left out of the sparse matrices.
  [[nodiscard]] virtual bool depends(Eigen::Index r, Eigen::Index k) const = 0;
  struct Rates {
    Eigen::VectorXd value;  ///< rates x' = f(x, c) of the states x under the controls c
    Eigen::MatrixXd slope;  ///< derivatives of the rates f: a row per state, a column per state and then per control
  };
  [[nodiscard]] virtual Rates rates(const Eigen::VectorXd& x, const Eigen::VectorXd& c) = 0;
  /// Returns the second derivatives of multipliers.f, a weighted sum of the rates f of the states, as a symmetric matrix over
  /// the states x and then the controls c.
  [[nodiscard]] virtual Eigen::MatrixXd curvature(const Eigen::VectorXd& x, const Eigen::VectorXd& c,
                                                  const Eigen::VectorXd& multipliers) = 0;
};

/// The condition lower <= row.x <= upper on the states x.
struct StateCondition {
  Eigen::VectorXd row;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

struct ControlBound {
  double lower = 0;
  double upper = 1;
  /// Largest |c'| of the control c. If finite, the control is linear between its knots and begins at `before`. If infinite, the
  /// control is constant between its knots, with jumps.
  double slew = std::numeric_limits<double>::infinity();
  double before = 0;
  /// Value at the final time T of a control with a bounded slew; the control may end at any value when absent.
  std::optional<double> after = {};
};

struct ControlProblem {
  ControlledSystem* system = nullptr;
  Eigen::VectorXd start = {};             ///< states at t = 0
  std::vector<ControlBound> bounds = {};  ///< bounds of each control; the slews must be finite for all controls or for none
  /// Conditions on the states at the end of every piece of the mesh except the last.
  std::vector<StateCondition> on_the_way = {};
  std::vector<StateCondition> at_the_end = {};
  double shortest = 0, longest = 0;  ///< bounds of the final time T
  /// If set, the solver minimises e.x(T), a weighted sum of the final states, with these weights e; otherwise the time T.
  std::optional<Eigen::VectorXd> ends_best = {};
  std::vector<double> knots = {};  ///< times at which the controls jump or bend, as fractions of T from 0 to 1
  double longest_piece = 1;        ///< longest piece of the mesh of the states, a fraction of the final time T
  long max_iterations = 500;
  double tolerance = 1e-8;                  ///< tolerance of Ipopt's optimality conditions
  const std::atomic<bool>* stop = nullptr;  ///< set by another thread; ends the solution with Ipopt's last iterate as result
};

/// Controls against time, and the states of the system under these controls.
struct ControlledCourse {
  bool converged = false;
  bool interrupted = false;
  std::string message = {};  ///< message of Ipopt why the solution ended
  int iterations = 0;
  double time = 0;                 ///< final time T [unit of time of the problem]
  std::vector<double> knots = {};  ///< times at which the controls jump or bend, fractions of the final time T
  /// Values of the controls: a column per interval between `knots`, or per knot where a slew is bounded.
  Eigen::MatrixXd controls = {};
  std::vector<double> points = {};  ///< times of the states: 0, then the points of collocation, fractions of the final time T
  Eigen::MatrixXd states = {};      ///< states, a column per time in `points`
  /// States at a fraction of the final time T, linear between points.
  [[nodiscard]] Eigen::VectorXd state_at(double fraction) const;
  [[nodiscard]] Eigen::VectorXd control_at(double fraction) const;
};

/// Solves the control problem from a guess, which must have the numbers of states and controls of the problem but need not
/// fulfil any condition. Throws InvalidInput for a problem or a guess whose sizes or bounds do not fit; a numerical failure is
/// reported in the result.
[[nodiscard]] ControlledCourse solve(const ControlProblem& problem, const ControlledCourse& guess);

/// Returns the knots of `course`, the times at which its controls jump or bend, with further knots in the middle of some
/// intervals: those in which a control is between its bounds, those at whose ends a control jumps, and their neighbours. No
/// interval becomes shorter than `shortest`.
[[nodiscard]] std::vector<double> refined_knots(const ControlledCourse& course, const std::vector<ControlBound>& bounds,
                                                double shortest);

}  // namespace softland
