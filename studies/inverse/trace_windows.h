// The rows of a trace (recorded curve over time) that a fit uses: first the rows up to first contact, then more and more rows,
// as long as the model describes them. After some bounces the smallest change of a device changes the rest of the trace
// completely, and a search over the whole trace ends in one of many minima.
#pragma once

#include <limits>
#include <vector>

#include "config/bench.h"

namespace softland {

class TraceWindows {
 public:
  /// `touches` are the times of first contact of the nominal design, for each measurement [s]. All rows of a measurement are
  /// used from the beginning if they do not include this time, or if the measurement sets its own end (`until`).
  TraceWindows(const Bench& bench, const std::vector<double>& touches);

  /// Returns the measurements with the rows of traces (recorded curves) that the fit uses at present.
  [[nodiscard]] Bench inside() const;
  /// Adds the next rows to every trace (recorded curve) that has more rows; returns false if no trace has more.
  bool grow();
  /// True if the row at `time` of this measurement belongs to the rows that were added last.
  [[nodiscard]] bool is_new(std::size_t measurement, double time) const;
  /// Confirms the rows of traces (recorded curves) that were added last if `described` is true for all measurements. Otherwise
  /// removes these rows from all traces, and adds no more rows to traces that are not described. Returns false if the fit to
  /// the removed rows must be discarded.
  bool keep(const std::vector<bool>& described);
  /// Returns the time of the last row of a measurement that is used at present [s].
  [[nodiscard]] double end(std::size_t measurement) const;

 private:
  struct Window {
    double begin = 0, end = std::numeric_limits<double>::infinity();  // time span of the trace's rows that were added last [s]
    bool grows = false;
  };
  const Bench& bench_;
  std::vector<Window> windows_;
};

}  // namespace softland
