// Observers of closings that report the progress to a listener.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "base/progress.h"

namespace softland {

/// Returns a ClosingOptions::observer that reports the progress of a closing of `duration` [s]. The closing is the `share` of a
/// computation of which `done` is complete. The observer is empty if `progress` has no listener, and must not outlive
/// `progress`.
[[nodiscard]] inline std::function<bool(double, const double*, const double*)> observer(const Progress& progress,
                                                                                        std::string what, double duration,
                                                                                        double done = 0, double share = 1) {
  if (!progress.report) return {};
  return [&progress, what = std::move(what), duration, done, share](double time, const double*, const double*) {
    progress.tell(what, std::min(1.0, done + share * time / duration));
    return false;
  };
}

}  // namespace softland
