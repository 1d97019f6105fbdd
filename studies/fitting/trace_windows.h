// Which rows of a trace a fit goes by: at first those up to the first touch, then ever more, as long as the scene describes those
// that come. Past some bounces the least change of a device changes the trace altogether, and a search that sees all of it ends
// in any of many minima.
#pragma once

#include <limits>
#include <vector>

#include "config/bench.h"

namespace softland {

class TraceWindows {
 public:
  /// `touches`: when the nominal design first touches, by measurement [s]. Where that is not finite, and where the measurement
  /// has an end of its own (`until`), all rows count from the beginning.
  TraceWindows(const Bench& bench, const std::vector<double>& touches);

  /// The measurements with the rows that count.
  [[nodiscard]] Bench inside() const;
  /// Takes the next stretch of every trace that has one; false: no trace has.
  bool grow();
  /// Whether a time of this measurement is in the stretch that was taken last.
  [[nodiscard]] bool is_new(std::size_t measurement, double time) const;
  /// Keeps the stretches that were taken last where all are described, by measurement. Else all traces go back to where they
  /// ended before, and those that are not described stay there; false: what was fitted to these stretches is not to be kept.
  bool keep(const std::vector<bool>& described);
  /// Up to when a trace counts: the time of its last row [s].
  [[nodiscard]] double end(std::size_t measurement) const;

 private:
  struct Window {
    double begin = 0, end = std::numeric_limits<double>::infinity();  // of the newest stretch [s]
    bool grows = false;
  };
  const Bench& bench_;
  std::vector<Window> windows_;
};

}  // namespace softland
