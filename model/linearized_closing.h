// The derivative of a simulated closing with respect to the parameters of its drives.
//
//   d' = A(t) d + sum over drives k of b_k(t) dV_k/dp        A = df/dy, b_k = df/dV_k along the closing y' = f(y, V)
//
// d = dy/dp at fixed time. Over a step, whose ends the closing's own integrator found, the transition matrix is the exponential
// of Magnus' series to fourth order (Blanes, Casas, Oteo and Ros 2009, eq. 245). The contribution of the drives is integrated
// exactly for inputs that are parabolas in time within the step. When f changes at an event, d jumps by (f before - f after)
// dt/dp, since the time t of the event depends on the motion or the waveform. At an impact the velocity's part is reflected too
// (saltation: Aizerman and Gantmacher 1958, Hiskens and Pai 2000, eq. 26). A contact with memory adds its residual interference
// (the dent that it keeps) to the state.
//
// The motion after the last time on which any of the figures depends is not linearised.
//
// The forward mode integrates d for all parameters at once. The backward (adjoint) mode integrates the weights that a figure
// gives to d from the end to the beginning: its cost hardly depends on the number of parameters. Both modes apply the
// exponential to vectors, by its Taylor series, and never form the exponential itself.
//
// A parameter of the device adds F_p (model/switch_slopes.h) to the inputs of the equations. The parameter also adds the
// derivative of the rest position at the start. It shifts the times of events at fixed q: the contact law changes at a certain
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

/// The derivative of a figure of merit by a parameter p, as weights of d = dy/dp, the derivative of the state y. d is taken at
/// the ends of arcs (steps of the recorded motion), before any jump of d there. A figure that is measured at a breakpoint of a
/// drive also has `moved`, its derivative by the time of the breakpoint. A figure that depends on the device at fixed q and v
/// also has derivatives by each of SwitchSlopes::moving().
struct FigureSlope {
  struct Weights {
    std::size_t arc = 0;  ///< index of an arc (step of the motion) in LinearizedClosing::arcs()
    Eigen::VectorXd by_q, by_v;
    double by_shift = 0;  ///< weight of the derivative of a contact's residual interference (dent)
  };
  struct Moved {
    std::size_t drive = 0, piece = 0;
    double rate = 0;  ///< derivative of the figure by the time at which this piece of the signal begins [per s]
  };
  std::vector<Weights> weights = {};
  std::vector<Moved> moved = {};
  Eigen::VectorXd by_device = {};  ///< derivatives of the figure by device parameters at fixed q and v; empty means 0
};

class LinearizedClosing {
 public:
  /// One number per mode, stored without an allocation.
  using Modal = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_modes, 1>;

  /// A step of the recorded motion. A step within which the velocity of the contact point changes its sign is split into two
  /// arcs at that time.
  struct Arc {
    double begin = 0, end = 0;  ///< begin and end of the arc (step of the motion) [s]
    Modal q, v;                 ///< modal coordinates and velocities at the end of the arc (step of the motion)
    Modal accelerations;        ///< modal accelerations at the end of the arc (step of the motion)
    bool turns = false;         ///< true when the contact point's velocity changes sign at the end of the arc
    ContactState contact;
    std::size_t step = 0;            ///< index of the step of the recorded motion to which the arc belongs
    std::size_t pieces_entered = 0;  ///< index in pieces_ of the signal pieces in use in the arc, see pieces()
  };
  /// A change of the contact law from one of its curves to another, in the order of time: `arcs` is the number of arcs before
  /// it.
  struct PhaseEvent {
    std::size_t arcs = 0;
    PhaseChange change;
  };

  /// Linearises a closing under these drive signals that was simulated with restart_at_contact and recorded in `tape`. Keeps
  /// references to its arguments. An integration step is divided into at least `refinement` parts. `by_device` gives the
  /// derivatives of the switch by the parameters, the same ones as those of the signals; null when no parameter changes the
  /// switch.
  LinearizedClosing(const Switch& model, std::span<const Signal> signals, const RecordedMotion& tape, int refinement = 1,
                    SwitchSlopes* by_device = nullptr);

  /// Returns the reason why a closing of this switch has no derivative; empty when it has one.
  [[nodiscard]] static std::string refusal(const Switch& model);

  [[nodiscard]] const std::vector<Arc>& arcs() const { return arcs_; }
  /// Returns, for each drive, the index of its signal piece (between two breakpoints) during an arc of the recorded motion.
  [[nodiscard]] const std::vector<std::size_t>& pieces(const Arc& arc) const { return pieces_[arc.pieces_entered]; }
  [[nodiscard]] const std::vector<PhaseEvent>& passages() const { return passages_; }
  /// Returns the derivatives of the switch by the parameters; null when the parameters do not change the switch.
  [[nodiscard]] const SwitchSlopes* by_device() const { return by_device_; }

  /// Returns derivatives of figures of merit, one row each, with respect to the parameters, in adjoint mode.
  [[nodiscard]] Eigen::MatrixXd backward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes);
  /// Returns the derivatives that backward() returns, in forward mode.
  [[nodiscard]] Eigen::MatrixXd forward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes);

 private:
  using Index = Eigen::Index;

  // The derivatives of the modal accelerations at one time of the motion: by the scaled modal coordinates (q times the fastest
  // angular frequency), by the velocities v, and by the inputs.
  struct Node {
    Eigen::MatrixXd by_q, by_v;
    Eigen::MatrixXd inputs;  // derivatives by drive voltages, residual interference and device parameters, the inputs
  };
  // A part of an integration step of the recorded motion, short enough for Magnus' series.
  struct Part {
    double begin = 0, end = 0;  // begin and end of the part [s]
    std::size_t arc = 0;
    bool ends_arc = false;
    int terms = 0;  // number of terms in the Taylor series of the matrix exponential
  };
  // The coefficients of the linearised equations over a part of a step, as pointers into numbers_: the matrix of Magnus'
  // series, and the derivatives of the modal accelerations by the inputs.
  struct Transition {
    const double* magnus;  // matrix of Magnus' series; rows are padded to whole SIMD vectors
    const double* begin;   // derivatives of accelerations by the inputs at the begin of the part, modes x inputs
    const double* middle;  // derivatives of accelerations by the inputs in the middle of the part, modes x inputs
    const double* end;     // derivatives of accelerations by the inputs at the end of the part, modes x inputs
  };
  // The jump of d = dy/dp at an event; the last row of d is the derivative of the contact's residual interference. After the
  // jump d is matrix * d + by_device + the terms of `moved`.
  struct Jump {
    std::size_t parts = 0;                  // number of parts (of all steps) before the event
    std::optional<Eigen::MatrixXd> matrix;  // square matrix of size 2 modes + 1; unit matrix if none
    // Each pair adds its vector times the derivative dt/dp of the time t at which the signal piece begins.
    std::vector<std::pair<FigureSlope::Moved, Eigen::VectorXd>> moved;
    Eigen::MatrixXd by_device = {};  // derivatives by device parameters that change the switch, one column each, or none
  };

  // Computes the arcs of the recorded motion and the changes of the contact law, without derivatives.
  void follow_tape();
  void enter_pieces(double t);
  void add_arcs(std::size_t step);
  void note_passage(const PhaseChange& change);
  // Computes the derivatives of the recorded motion, up to the last time on which the figures of merit depend.
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
  // Returns the column of the gradient for a device parameter, given by its index in SwitchSlopes::moving().
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
  Index stride_;    // size_ rounded up to whole SIMD vectors
  SwitchSlopes* by_device_;
  // Number of drives, and so the index of the residual interference, which follows the voltages among the inputs; number of
  // device parameters that change the switch; number of all inputs.
  Index dent_, moving_, inputs_;
  double fastest_;  // angular frequency of the fastest mode [rad/s]
  Switch::Workspace work_;
  int refinement_;
  // Index of the signal piece in use for each drive; a new entry for every breakpoint.
  std::vector<std::vector<std::size_t>> pieces_;
  std::vector<Arc> arcs_;
  std::vector<PhaseEvent> passages_;

  std::size_t steps_ = 0;         // number of linearised steps of the recorded motion
  std::size_t next_arc_ = 0;      // index in arcs_ of the first arc after the linearised steps
  std::size_t next_passage_ = 0;  // index of the next change of the contact law in the recorded motion
  std::size_t on_ = 0;            // index in pieces_ of the signal pieces in use at the end of the linearised steps
  std::vector<double> volts_;
  std::vector<Part> parts_;
  std::vector<double> numbers_;  // matrices of Magnus' series, and derivatives of accelerations by the inputs, for all parts
  std::vector<Jump> jumps_;
  Eigen::MatrixXd rest_;  // derivatives of the rest position at the start by device parameters, one column each
  Node from_, middle_, to_;
  // True when from_ already has the derivatives at the begin of the next part: no jump comes before it.
  bool goes_on_ = false;
};

}  // namespace softland
