// The derivative of a closing with respect to what its drives are made of.
//
//   d' = A(t) d + sum over drives k of b_k(t) dV_k/dp        A = df/dy, b_k = df/dV_k along the closing y' = f(y, V)
//
// d = dy/dp at fixed time. Over a step, whose ends the closing's own integrator found, the transition matrix is the exponential
// of Magnus' series to fourth order (Blanes, Casas, Oteo and Ros 2009, eq. 245), and what the drives add is integrated exactly
// for inputs that are parabolas in it. At an event at which f changes, at a time that the motion decides or the waveform, d jumps
// by (f before - f after) dt/dp; at an impact the velocity's part is reflected too (saltation: Aizerman and Gantmacher 1958,
// Hiskens and Pai 2000, eq. 26). A contact with memory adds its residual interference to the state.
//
// Forward, d is carried along for all parameters at once. Backward (adjoint), the weights that a figure gives to d are carried
// from the end to the beginning: its cost hardly depends on the number of parameters.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/motion_tape.h"
#include "model/switch.h"
#include "waveforms/signal_slopes.h"

namespace softland {

/// The derivative of a figure: weights of d at the end of an arc, before what follows it. What is measured at a time that moves
/// with the beginning of a piece has a rate for it.
struct FigureSlope {
  struct Weights {
    std::size_t arc = 0;  ///< of LinearizedClosing::arcs()
    Eigen::VectorXd by_q, by_v;
    double by_shift = 0;  ///< of the dent of a contact with memory
  };
  struct Moved {
    std::size_t drive = 0, piece = 0;
    double rate = 0;  ///< of the figure [1/s]
  };
  std::vector<Weights> weights = {};
  std::vector<Moved> moved = {};
};

class LinearizedClosing {
 public:
  /// A stretch of a step, short enough for the series; a step in which the contact point turns back ends one there.
  struct Arc {
    double begin = 0, end = 0;      ///< [s]
    Eigen::VectorXd q, v;           ///< at its end
    Eigen::VectorXd accelerations;  ///< at its end
    bool turns = false;             ///< the contact point turns back at its end

    ContactState contact;
    std::vector<std::size_t> pieces;  ///< of the drives
  };
  /// A passage of the tape after so many arcs.
  struct Passage {
    std::size_t arcs = 0;
    PhaseChange change;
  };

  /// Of a closing that was run with restart_at_contact, under these signals. Keeps references to the switch and the signals.
  /// `refinement`: arcs of a step, at the least.
  LinearizedClosing(const Switch& model, std::span<const Signal> signals, const MotionTape& tape, int refinement = 1);

  /// Why there is no derivative, in words; empty where there is.
  [[nodiscard]] static std::string refusal(const Switch& model);

  [[nodiscard]] const std::vector<Arc>& arcs() const { return arcs_; }
  [[nodiscard]] const std::vector<Passage>& passages() const { return passages_; }

  /// Derivatives of figures, a row each, with respect to the parameters: adjoint.
  [[nodiscard]] Eigen::MatrixXd backward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes) const;
  /// The same numbers: forward.
  [[nodiscard]] Eigen::MatrixXd forward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes) const;

 private:
  using Index = Eigen::Index;

  // The equations at one state, in units in which q is times the fastest frequency.
  struct Node {
    Eigen::MatrixXd a;         // 2 modes square
    Eigen::MatrixXd inputs;    // 2 modes x drives
    Eigen::VectorXd by_shift;  // of the dent of a contact with memory; zero where there is none
  };
  struct Transition {
    Eigen::MatrixXd state;   // 2 modes square
    Eigen::MatrixXd inputs;  // 2 modes x 3 drives: dV/dp of drive k at begin, middle and end of the arc
    Eigen::VectorXd shift;
  };
  // d, and the shift's derivative below it, after an event: jump * d + sum over moved pieces.
  struct Jump {
    std::size_t arcs = 0;
    Eigen::MatrixXd matrix;                                             // 2 modes + 1 square
    std::vector<std::pair<FigureSlope::Moved, Eigen::VectorXd>> moved;  // d gains the vector times d(begin)/dp
  };

  [[nodiscard]] Node node(double t, const double* q, const double* v, const std::vector<std::size_t>& pieces,
                          const ContactState& contact);
  [[nodiscard]] Transition transition(double h, const Node& begin, const Node& middle, const Node& end) const;
  [[nodiscard]] Eigen::VectorXd rates(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                      const std::vector<std::size_t>& pieces, const ContactState& contact);
  void add_step(const MotionTape::Arc& arc, bool after_edge, bool before_edge);
  void add_passage(const MotionTape::Passage& passage);
  void enter_pieces(const Knot& here, const ContactState& contact);
  [[nodiscard]] Eigen::VectorXd scaled(const FigureSlope::Weights& weights) const;
  template <class Add>
  void for_inputs(std::size_t arc, const SignalSlopes& slopes, Add&& add) const;

  const Switch& model_;
  std::span<const Signal> signals_;
  Index n_, size_;  // modes, unknowns: 2 modes
  double fastest_;  // [rad/s]
  Switch::Workspace work_;
  int refinement_;
  std::vector<std::size_t> pieces_;  // that hold at present
  std::vector<Arc> arcs_;
  std::vector<Transition> transitions_;
  std::vector<Jump> jumps_;
  std::vector<Passage> passages_;
  std::optional<Node> last_;  // at the end of the last arc, where nothing has changed since
};

}  // namespace softland
