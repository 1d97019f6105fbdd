// The recorded motion of all modes in a closing: smooth arcs (integration steps), and the changes of the contact law between
// them.
#pragma once

#include <cstddef>
#include <vector>

#include "model/closing/observer.h"

namespace softland {

/// Records the motion of a closing, and passes all calls to another observer.
class RecordedMotion final : public ClosingObserver {
 public:
  struct Arc {
    double begin = 0, end = 0;  ///< begin and end of the arc (integration step) [s]
    ContactState contact;
  };
  /// Modal coordinates, velocities and accelerations at one time: pointers into the recorded numbers.
  struct Motion {
    double time = 0;  ///< time of this state of the motion [s]
    const double *q, *v, *accelerations;
  };
  /// A change of the contact law from one of its curves to another; `arc` is the index of the smooth arc that follows.
  struct PhaseEvent {
    std::size_t arc = 0;
    double time = 0;  ///< time of the change of the contact law [s]
    PhaseChange change;
  };

  RecordedMotion() = default;
  /// Keeps a reference to the observer to which all calls are passed.
  explicit RecordedMotion(ClosingObserver& next) : next_(&next) {}

  void knot(const TrajectoryPoint& point) override {
    if (next_ != nullptr) next_->knot(point);
  }
  void touch(const Touch& touch) override {
    if (next_ != nullptr) next_->touch(touch);
  }
  [[nodiscard]] bool follows_motion() const override { return true; }
  void step(const Knot& begin, const Knot& end, const ContactState& contact) override {
    arcs_.push_back({begin.time, end.time, contact});
    for (const Knot* knot : {&begin, &end}) {
      // The state has q, v and film pressures, the rates have accelerations and film rates: the difference of the sizes is the
      // number of modes.
      modes_ = knot->state.size() - knot->rates.size();
      numbers_.insert(numbers_.end(), knot->state.data(), knot->state.data() + 2 * modes_);
      numbers_.insert(numbers_.end(), knot->rates.data(), knot->rates.data() + modes_);
    }
  }
  void on_phase(const Knot& here, const PhaseChange& change) override { passages_.push_back({arcs_.size(), here.time, change}); }

  [[nodiscard]] const std::vector<Arc>& arcs() const { return arcs_; }
  [[nodiscard]] Motion begin(std::size_t arc) const { return motion(arcs_[arc].begin, 2 * arc); }
  [[nodiscard]] Motion end(std::size_t arc) const { return motion(arcs_[arc].end, 2 * arc + 1); }
  [[nodiscard]] const std::vector<PhaseEvent>& passages() const { return passages_; }

 private:
  [[nodiscard]] Motion motion(double time, std::size_t k) const {
    const double* q = numbers_.data() + 3 * modes_ * k;
    return {.time = time, .q = q, .v = q + modes_, .accelerations = q + 2 * modes_};
  }

  ClosingObserver* next_ = nullptr;
  std::vector<Arc> arcs_;
  std::vector<double> numbers_;  // modal coordinates, velocities and accelerations at begin and end of each arc
  std::size_t modes_ = 0;
  std::vector<PhaseEvent> passages_;
};

}  // namespace softland
