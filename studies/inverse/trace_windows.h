// The rows of a trace that a fit uses: at first those up to the first touch, then ever more, as long as the scene describes
// them. Past some bounces the least change of a device changes the trace altogether. A search that sees all of it ends in any
// of many minima.
#pragma once

#include <limits>
#include <vector>

#include "config/bench.h"

namespace softland {

class TraceWindows {
 public:
  /// `touches` are the first touches of the nominal design, by measurement [s]. All rows count from the beginning if that is
  /// not finite, or if the measurement has an end of its own (`until`).
  TraceWindows(const Bench& bench, const std::vector<double>& touches);

  /// The measurements with the rows that count.
  [[nodiscard]] Bench inside() const;
  /// Takes the next stretch of every trace that has one; returns false if no trace has.
  bool grow();
  /// True if a time of this measurement is in the newest stretch.
  [[nodiscard]] bool is_new(std::size_t measurement, double time) const;
  /// Keeps the newest stretches if all are described, by measurement. Else all traces go back to their earlier ends, and those
  /// that are not described stay there. Returns false if the fit to these stretches must be dropped.
  bool keep(const std::vector<bool>& described);
  /// The end of a trace that counts: the time of its last row [s].
  [[nodiscard]] double end(std::size_t measurement) const;

 private:
  struct Window {
    double begin = 0, end = std::numeric_limits<double>::infinity();  // newest stretch [s]
    bool grows = false;
  };
  const Bench& bench_;
  std::vector<Window> windows_;
};

}  // namespace softland
