#include "studies/inverse/trace_windows.h"

#include <algorithm>
#include <functional>

namespace softland {

TraceWindows::TraceWindows(const Bench& bench, const std::vector<double>& touches) : bench_(bench) {
  for (std::size_t m = 0; m < bench.measurements.size(); ++m) {
    const BenchMeasurement& one = bench.measurements[m];
    const bool is_cut = !one.times.empty() && !one.has_end && one.times.front() <= touches[m] && touches[m] < one.times.back();
    windows_.push_back(is_cut ? Window{.end = touches[m], .grows = true} : Window{});
  }
}

Bench TraceWindows::inside() const {
  Bench cut = bench_;
  for (std::size_t m = 0; m < cut.measurements.size(); ++m) {
    BenchMeasurement& one = cut.measurements[m];
    if (one.times.empty()) continue;
    const auto rows = static_cast<std::size_t>(std::ranges::upper_bound(one.times, windows_[m].end) - one.times.begin());
    one.times.resize(rows);
    one.values.resize(rows);
    one.errors.resize(rows);
    if (!one.levels.empty()) one.levels.resize(rows);
  }
  return cut;
}

bool TraceWindows::grow() {
  constexpr double stretch = 1.25;
  bool any = false;
  for (std::size_t m = 0; m < windows_.size(); ++m) {
    Window& window = windows_[m];
    const double last = window.grows ? bench_.measurements[m].times.back() : window.end;
    window.grows = window.grows && window.end < last;
    if (!window.grows) continue;
    window.begin = window.end;
    window.end = std::min(last, stretch * window.end);
    any = true;
  }
  return any;
}

bool TraceWindows::is_new(std::size_t measurement, double time) const {
  const Window& window = windows_[measurement];
  return window.grows && time > window.begin && time <= window.end;
}

bool TraceWindows::keep(const std::vector<bool>& described) {
  const bool all = std::ranges::all_of(described, std::identity());
  for (std::size_t m = 0; !all && m < windows_.size(); ++m) {
    Window& window = windows_[m];
    if (!window.grows) continue;
    window.end = window.begin;
    window.grows = described[m];
  }
  return all;
}

double TraceWindows::end(std::size_t measurement) const {
  const std::vector<double>& times = bench_.measurements[measurement].times;
  return *(std::ranges::upper_bound(times, windows_[measurement].end) - 1);
}

}  // namespace softland
