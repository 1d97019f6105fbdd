// Steps of the integrator through a closing, each up to the next event of the contact point.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "integrators/stepper.h"
#include "model/closing.h"
#include "model/closing/energy_audit.h"
#include "model/closing/equations.h"
#include "model/closing/events.h"
#include "model/closing/force_record.h"
#include "model/closing/pending_knots.h"
#include "model/closing/resting_plate.h"
#include "model/closing/step_motion.h"
#include "model/closing/tolerances.h"
#include "model/closing/touch_record.h"

namespace softland {

[[nodiscard]] inline bool begins_closed(const ClosingOptions& options) {
  return !options.begins_closed.empty() || options.start == StartState::closed;
}
/// The equilibrium in which a run starts, under what the drives have been before t = 0: an open one unless the options say
/// otherwise. Empty where that does not exist.
[[nodiscard]] std::optional<Eigen::VectorXd> start_of(const Switch& model, std::span<const Signal> signals,
                                                      const ClosingOptions& options);

/// What a closing is made of; the parts keep references to each other.
struct ClosingParts {
  const Switch& model;
  const ClosingOptions& options;
  std::optional<Eigen::VectorXd> rest;  ///< where the run starts; none where there is no such equilibrium
  DriveCourse drives;
  ContactPhase phase;
  ClosingEquations equations;
  RestingPlate plate;
  TouchRecord touches;
  ForceRecord force;
  Course course;
  ClosingObserver& observer;

  ClosingParts(const Switch& switch_model, std::span<const Signal> signals, const ClosingOptions& closing_options,
               ClosingObserver& closing_observer)
      : model(switch_model),
        options(closing_options),
        rest(start_of(switch_model, signals, closing_options)),
        drives(signals),
        phase(model),
        equations(model, drives, phase, options.restart_at_contact),
        plate(model, drives, equations),
        touches(model, phase, closing_observer),
        force(model, options.steady_force),
        course(model.device(), closing_observer),
        observer(closing_observer) {
    if (!rest || !begins_closed(options)) return;
    phase.begin_closed(model.contact_deflection(rest->data()) - model.contact_gap());
    if (phase.in_contact()) touches.begin_closed();
  }
  ClosingParts(const ClosingParts&) = delete;
  ClosingParts& operator=(const ClosingParts&) = delete;

  /// Records the peaks and the contact force of a piece of a step.
  void record(const TipMotion& tip, const TrajectoryPoint& from, const TrajectoryPoint& to);
  /// The contact point at a knot.
  [[nodiscard]] TrajectoryPoint point(const Knot& knot) const;
};

class Stepping {
 public:
  /// At rest, or on the contact. Keeps a reference.
  explicit Stepping(ClosingParts& parts);

  [[nodiscard]] Knot& here() { return here_; }
  [[nodiscard]] const Work& work() const { return work_; }
  /// Counts an evaluation of the drives over a resting plate as a step.
  void count_step() { ++work_.steps; }
  /// Why the last call failed.
  [[nodiscard]] const std::string& message() const { return message_; }

  /// The integrator starts anew from here(), in its present phase. False: failed.
  bool restart();
  /// Whether the work is within its bound; now and then also whether it is done with the right method, and if not goes over to
  /// the other. False: failed.
  bool check_work();

  struct Step {
    FieldFigures field;  ///< at its end
    std::optional<Event> event;
  };
  /// From here() to the end of a step, no further than `stop` and the next event at which to start anew. Peaks and energies of
  /// the step are recorded, its knots wait in the course. None: failed.
  std::optional<Step> advance(double stop, EnergyAudit& audit);

 private:
  [[nodiscard]] const std::vector<double>& tolerances() const;
  [[nodiscard]] bool implicit() const { return is_implicit(work_.integrator); }
  bool fail(const std::string& why);
  void take_state();
  void consider_step();
  bool follow(std::optional<Event>& event);
  bool go_through(const Event& event, const TipMotion& tip);
  bool step_again(const Event& event);
  bool meet(const Edge& edge);
  [[nodiscard]] TrajectoryPoint knot(int k);
  [[nodiscard]] double force_on_line(double time) const;
  void account(const FieldFigures& field, EnergyAudit& audit);

  ClosingParts& parts_;
  std::size_t n_;   // modes
  double plane_;    // of first touch [m]
  double fastest_;  // angular frequency of the last mode [rad/s]
  Tolerances tolerances_;
  StepMotion motion_;  // of the step from here_ to next_
  Knot here_, next_;
  TrajectoryPoint end_;  // of that step
  Work work_;
  std::unique_ptr<Stepper> stepper_;
  double last_step_ = 0;  // that no stop cut short [s]
  long next_look_ = 0;    // at the work, in steps
  int stiff_looks_ = 0;
  std::string message_;
};

}  // namespace softland
