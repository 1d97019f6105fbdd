// The motion of all modes in a closing as it was found: smooth arcs, and what happens between them.
#pragma once

#include <cstddef>
#include <vector>

#include "model/closing/observer.h"

namespace softland {

/// Records the motion, and passes everything on to another observer.
class MotionTape final : public ClosingObserver {
 public:
  struct Arc {
    Knot begin, end;
    ContactState contact;
  };
  /// Before the arc of this number.
  struct Passage {
    std::size_t arc = 0;
    Knot here;
    PhaseChange change;
  };

  MotionTape() = default;
  /// Keeps a reference.
  explicit MotionTape(ClosingObserver& next) : next_(&next) {}

  void knot(const TrajectoryPoint& point) override {
    if (next_ != nullptr) next_->knot(point);
  }
  void touch(const Touch& touch) override {
    if (next_ != nullptr) next_->touch(touch);
  }
  [[nodiscard]] bool follows_motion() const override { return true; }
  void step(const Knot& begin, const Knot& end, const ContactState& contact) override { arcs_.push_back({begin, end, contact}); }
  void pass(const Knot& here, const PhaseChange& change) override { passages_.push_back({arcs_.size(), here, change}); }

  [[nodiscard]] const std::vector<Arc>& arcs() const { return arcs_; }
  [[nodiscard]] const std::vector<Passage>& passages() const { return passages_; }

 private:
  ClosingObserver* next_ = nullptr;
  std::vector<Arc> arcs_;
  std::vector<Passage> passages_;
};

}  // namespace softland
