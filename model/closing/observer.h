// Who receives the course of a closing: all of it, or only what figures are made of.
#pragma once

#include "model/trajectory.h"

namespace softland {

class ClosingObserver {
 public:
  virtual ~ClosingObserver() = default;
  /// The next knot, in order of time. Knots are handed over step by step, once nothing changes them any more.
  virtual void knot(const TrajectoryPoint&) {}
  /// A touch that is over, or at the end of the run the one that holds, whose end is NaN.
  virtual void touch(const Touch&) {}

 protected:
  ClosingObserver() = default;
  ClosingObserver(const ClosingObserver&) = default;
  ClosingObserver& operator=(const ClosingObserver&) = default;
};

}  // namespace softland
