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
// What a closing does after the last moment that a figure depends on is not linearised.
//
// Forward, d is carried along for all parameters at once. Backward (adjoint), the weights that a figure gives to d are carried
// from the end to the beginning: its cost hardly depends on the number of parameters. Both take the exponential times vectors, by
// its Taylor series, and never the exponential itself.
//
// A parameter of the device adds F_p (model/switch_slopes.h) to what drives the equations, the derivative of the rest that the
// closing starts from, and what it does to the times of events at fixed q: an edge is crossed where the interference, which
// depends on the shape of the modes at the contact and on the contact gap, has a certain value.
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

/// The derivative of a figure: weights of d at the end of an arc, before what follows it. What is measured at a time that moves
/// with the beginning of a piece has a rate for it, and what depends on the device at fixed q and v its derivative by each of
/// SwitchSlopes::moving().
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
  Eigen::VectorXd by_device = {};  ///< empty: 0
};

class LinearizedClosing {
 public:
  using Modal = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_modes, 1>;  ///< a number to each mode, without an allocation

  /// A step of the tape, or the part of one until the contact point turns back in it, and the rest.
  struct Arc {
    double begin = 0, end = 0;  ///< [s]
    Modal q, v;                 ///< at its end
    Modal accelerations;        ///< at its end
    bool turns = false;         ///< the contact point turns back at its end
    ContactState contact;
    std::size_t step = 0;            ///< of the tape
    std::size_t pieces_entered = 0;  ///< see pieces()
  };
  /// A passage of the tape after so many arcs.
  struct PhaseEvent {
    std::size_t arcs = 0;
    PhaseChange change;
  };

  /// Of a closing that was run with restart_at_contact, under these signals. Keeps references to all but the number.
  /// `refinement`: parts of a step, at the least. `by_device`: how the switch changes with the parameters; none: not at all. They
  /// are as many as those of the signals.
  LinearizedClosing(const Switch& model, std::span<const Signal> signals, const RecordedMotion& tape, int refinement = 1,
                    SwitchSlopes* by_device = nullptr);

  /// Why there is no derivative, in words; empty where there is.
  [[nodiscard]] static std::string refusal(const Switch& model);

  [[nodiscard]] const std::vector<Arc>& arcs() const { return arcs_; }
  /// Of the drives, all along an arc.
  [[nodiscard]] const std::vector<std::size_t>& pieces(const Arc& arc) const { return pieces_[arc.pieces_entered]; }
  [[nodiscard]] const std::vector<PhaseEvent>& passages() const { return passages_; }
  /// Null where the parameters do not change the switch.
  [[nodiscard]] const SwitchSlopes* by_device() const { return by_device_; }

  /// Derivatives of figures, a row each, with respect to the parameters: adjoint.
  [[nodiscard]] Eigen::MatrixXd backward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes);
  /// The same numbers: forward.
  [[nodiscard]] Eigen::MatrixXd forward(const std::vector<FigureSlope>& figures, const SignalSlopes& slopes);

 private:
  using Index = Eigen::Index;

  // The derivatives of the accelerations at one state, in units in which q is times the fastest frequency.
  struct Node {
    Eigen::MatrixXd by_q, by_v;
    Eigen::MatrixXd inputs;  // by the drives, by the dent of a contact with memory, by parameters of the device
  };
  // A part of an arc, short enough for the series.
  struct Part {
    double begin = 0, end = 0;  // [s]
    std::size_t arc = 0;
    bool ends_arc = false;
    int terms = 0;  // of the series of its exponential
  };
  // Magnus' series of a part and what drives and dents add: places in numbers_.
  struct Transition {
    const double* magnus;  // rows of whole lanes
    const double* begin;   // inputs at the begin,
    const double* middle;  // in the middle
    const double* end;     // and at the end of the part, modes x inputs each
  };
  // d, and the shift's derivative below it, after an event: matrix * d + by_device + sum over moved pieces. No matrix: d stays.
  struct Jump {
    std::size_t parts = 0;                                              // before it
    std::optional<Eigen::MatrixXd> matrix;                              // 2 modes + 1 square
    std::vector<std::pair<FigureSlope::Moved, Eigen::VectorXd>> moved;  // d gains the vector times d(begin)/dp
    Eigen::MatrixXd by_device = {};                                     // a column to each moving parameter, or none
  };

  // The course, without derivatives.
  void follow_tape();
  void enter_pieces(double t);
  void add_arcs(std::size_t step);
  void note_passage(const PhaseChange& change);
  // The derivatives, as far as the figures ask for them.
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
  // Of the gradient, of a parameter that changes the switch.
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
  Index n_, size_;  // modes, unknowns: 2 modes
  Index stride_;    // size_ in whole lanes
  SwitchSlopes* by_device_;
  Index dent_, moving_, inputs_;  // drives; parameters of the device; both and the dent
  double fastest_;                // [rad/s]
  Switch::Workspace work_;
  int refinement_;
  std::vector<std::vector<std::size_t>> pieces_;  // that the drives were on, one set after the other
  std::vector<Arc> arcs_;
  std::vector<PhaseEvent> passages_;

  std::size_t steps_ = 0;         // of the tape that are linearised,
  std::size_t next_arc_ = 0;      // the arc that follows them,
  std::size_t next_passage_ = 0;  // and the passage of the tape
  std::size_t on_ = 0;            // of pieces_, at present
  std::vector<double> volts_;     // of the drives, at present
  std::vector<Part> parts_;
  std::vector<double> numbers_;  // of the parts, Magnus' series and inputs
  std::vector<Jump> jumps_;
  Eigen::MatrixXd rest_;  // derivative of the motion's beginning, a column to each moving parameter
  Node from_, middle_, to_;
  bool goes_on_ = false;  // from_ is where the next part begins
};

}  // namespace softland
