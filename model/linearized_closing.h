// The derivative of a closing with respect to the parameters of its drives.
//
//   d' = A(t) d + sum over drives k of b_k(t) dV_k/dp        A = df/dy, b_k = df/dV_k along the closing y' = f(y, V)
//
// d = dy/dp at fixed time. Over a step, whose ends the closing's own integrator found, the transition matrix is the exponential
// of Magnus' series to fourth order (Blanes, Casas, Oteo and Ros 2009, eq. 245). The contribution of the drives is integrated
// exactly for inputs that are parabolas in it. When f changes at an event, at a time that the motion or the waveform decides,
// d jumps by (f before - f after) dt/dp. At an impact the velocity's part is reflected too (saltation: Aizerman and Gantmacher
// 1958, Hiskens and Pai 2000, eq. 26). A contact with memory adds its residual interference to the state.
//
// The motion after the last time on which any of the figures depends is not linearised.
//
// The forward mode integrates d for all parameters at once. The backward (adjoint) mode integrates the weights that a figure
// gives to d from the end to the beginning: its cost hardly depends on the number of parameters. Both modes apply the
// exponential to vectors, by its Taylor series, and never form the exponential itself.
//
// A parameter of the device adds F_p (model/switch_slopes.h) to the inputs of the equations. The parameter also adds the
// derivative of the rest position at the start, and shifts the times of events at fixed q. An edge is crossed at a certain
// interference, which depends on the shape of the modes at the contact and on the contact gap.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/recorded_motion.h"
#include "model/switch.h"
#include "model/switch_slopes.h"
#include "waveforms/signal_slopes.h"

namespace softland {

/// The derivative of a figure by a parameter p: weights of d = dy/dp, y the state, at the end of a step of the recorded motion,
/// before an event at this time. A figure measured at a time that depends on when a waveform piece begins also has `moved`: its
/// derivatives by the beginnings of pieces. A figure that depends on the device at fixed q and v also has derivatives by each
/// of SwitchSlopes::moving().
struct FigureSlope {
  struct Weights {
    std::size_t arc = 0;  ///< index in LinearizedClosing::arcs()
    Eigen::VectorXd by_q, by_v;
    double by_shift = 0;  ///< weight of the residual interference of a contact with memory
  };
  struct Moved {
    std::size_t drive = 0, piece = 0;
    double rate = 0;  ///< derivative of the figure by the time at which the piece begins [1/s]
  };
  std::vector<Weights> weights = {};
  std::vector<Moved> moved = {};
  Eigen::VectorXd by_device = {};  ///< derivatives of the figure at fixed q and v; empty means 0
};

class LinearizedClosing {
 public:
  using Modal = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_modes, 1>;  ///< one number per mode, without an allocation

  /// A step of the recorded motion; a step in which the velocity of the contact point changes sign is split there.
  struct Arc {
    double begin = 0, end = 0;  ///< [s]
    Modal q, v;                 ///< modal coordinates and velocities at `end`
    Modal accelerations;        ///< modal accelerations at `end`
    bool turns = false;         ///< true when the contact point's velocity changes sign at `end`
    ContactState contact;
    std::size_t step = 0;            ///< step of the recorded motion
    std::size_t pieces_entered = 0;  ///< index of the set of waveform pieces that the drives are on: see pieces()
  };
  /// An event of the recorded motion, after the first `arcs` elements of arcs().
  struct PhaseEvent {
    std::size_t arcs = 0;
    PhaseChange change;
  };

  /// Linearises a closing that was run with restart_at_contact, under these signals. Keeps references to its arguments.
  /// `refinement` is the least number of parts of a step. `by_device` gives the derivatives of the switch by the parameters, as
  /// many as those of the signals; null when the parameters do not change the switch.
  LinearizedClosing(const Switch& model, std::span<const Signal> signals, const RecordedMotion& tape, int refinement = 1,
                    SwitchSlopes* by_device = nullptr);

  /// Returns the reason why a closing of this switch has no derivative; empty when it has one.
  [[nodiscard]] static std::string refusal(const Switch& model);

  [[nodiscard]] const std::vector<Arc>& arcs() const { return arcs_; }
  /// Returns the number of the waveform piece on which each drive is during a step of the recorded motion.
  [[nodiscard]] const std::vector<std::size_t>& pieces(const Arc& arc) const { return pieces_[arc.pieces_entered]; }
  [[nodiscard]] const std::vector<PhaseEvent>& passages() const { return passages_; }
  /// Returns the derivatives of the switch by the parameters; null when the parameters do not change the switch.
  [[nodiscard]] const SwitchSlopes* by_device() const { return by_device_; }

  /// Returns derivatives of figures, one row each, with respect to the parameters, in adjoint mode.
  [[nodiscard]] Eigen::MatrixXd backward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes);
  /// Returns the derivatives that backward() returns, in forward mode.
  [[nodiscard]] Eigen::MatrixXd forward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes);

 private:
  using Index = Eigen::Index;

  // The derivatives of the accelerations at one state, in units in which q is multiplied by the fastest frequency.
  struct Node {
    Eigen::MatrixXd by_q, by_v;
    Eigen::MatrixXd inputs;  // inputs: drives, residual interference, parameters of the device
  };
  // A part of a step of the recorded motion, short enough for Magnus' series.
  struct Part {
    double begin = 0, end = 0;  // [s]
    std::size_t arc = 0;
    bool ends_arc = false;
    int terms = 0;  // number of terms in the series of the exponential
  };
  // Magnus' series of a part of a step, and the inputs of drives and of the contact's dent: pointers into numbers_.
  struct Transition {
    const double* magnus;  // rows of whole lanes
    const double* begin;   // inputs at the start of the part, modes x inputs
    const double* middle;  // inputs in the middle of the part
    const double* end;     // inputs at the end of the part
  };
  // The change of d = dy/dp at an event, with the derivative of the contact's residual interference as the last row: d becomes
  // matrix * d + by_device + sum over moved pieces. Without a matrix the first term is d.
  struct Jump {
    std::size_t parts = 0;                                              // number of parts before the event
    std::optional<Eigen::MatrixXd> matrix;                              // square, of size 2 modes + 1
    std::vector<std::pair<FigureSlope::Moved, Eigen::VectorXd>> moved;  // adds vector * d(begin of the piece)/dp to d
    Eigen::MatrixXd by_device = {};                                     // one column per moving parameter, or none
  };

  // Computes the arcs and events of the recorded motion, without derivatives.
  void follow_tape();
  void enter_pieces(double t);
  void add_arcs(std::size_t step);
  void note_passage(const PhaseChange& change);
  // Computes the derivatives of the recorded motion, up to the last time on which the figures depend.
  void linearize_for(const std::vector<FigureSlope>& figures);
  void linearize_step();
  void begin_at_rest();
  void set_node(Node& node, double t, const double* q, const double* v, const ContactState& contact);
  void set_volts(double t);
  [[nodiscard]] Eigen::VectorXd rates(double t, const double* q, const double* v, const ContactState& contact);
  [[nodiscard]] std::vector<double> ends_of_parts(double t0, double t1, bool after_edge, bool before_edge) const;
  void add_parts(std::size_t step, bool after_edge, bool before_edge);
  void add_transition(double begin, double end, std::size_t arc);
  void jump_at_pieces(const RecordedMotion::Motion& here, const ContactState& contact, std::size_t entered);
  void jump_at(const RecordedMotion::PhaseEvent& passage, const Arc& before);
  [[nodiscard]] Jump turned(const Arc& before) const;
  [[nodiscard]] Jump at_rest(const Arc& before) const;
  [[nodiscard]] Jump crossed(const RecordedMotion::PhaseEvent& passage, const Arc& before);
  [[nodiscard]] Transition transition(std::size_t part) const;
  // Returns the column of the gradient for a parameter that changes the switch.
  [[nodiscard]] Index column(Index moving) const {
    return static_cast<Index>(by_device_->moving()[static_cast<std::size_t>(moving)]);
  }
  [[nodiscard]] Eigen::VectorXd scaled(const FigureSlope::Weights& weights) const;
  void add_moved(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes, Eigen::MatrixXd& gradient) const;
  template <class Add>
  void for_inputs(const Part& part, const SignalSlopes& slopes, Add&& add) const;

  const Switch& model_;
  std::span<const Signal> signals_;
  const RecordedMotion& tape_;
  Index n_, size_;  // number of modes; number of unknowns, 2 modes
  Index stride_;    // size_ rounded up to whole lanes
  SwitchSlopes* by_device_;
  Index dent_, moving_, inputs_;  // numbers of drives (index of the residual interference), of moving parameters, of inputs
  double fastest_;                // [rad/s]
  Switch::Workspace work_;
  int refinement_;
  std::vector<std::vector<std::size_t>> pieces_;  // numbers of the present pieces of all drives; a set per breakpoint
  std::vector<Arc> arcs_;
  std::vector<PhaseEvent> passages_;

  std::size_t steps_ = 0;         // number of linearised steps of the recorded motion
  std::size_t next_arc_ = 0;      // index of the first arc after the linearised steps
  std::size_t next_passage_ = 0;  // index of the next event of the recorded motion
  std::size_t on_ = 0;            // index of the current pieces of the drives in pieces_
  std::vector<double> volts_;     // current values of the drives
  std::vector<Part> parts_;
  std::vector<double> numbers_;  // Magnus' series and inputs of the parts
  std::vector<Jump> jumps_;
  Eigen::MatrixXd rest_;  // derivative of the rest position at the start, one column per moving parameter
  Node from_, middle_, to_;
  bool goes_on_ = false;  // true when the next part of a step begins in the state from_
};

}  // namespace softland
