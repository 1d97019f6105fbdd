#include "reports/result_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "studies/closing/prepared.h"

namespace softland::internal {

double drawable(double value) {
  constexpr double most = 1e100;
  if (!(std::abs(value) <= most)) return std::numeric_limits<double>::quiet_NaN();
  return std::abs(value) < 1 / most ? 0 : value;
}

Points drawable(const Points& points) {
  Points all;
  for (const auto& [x, y] : points) {
    const std::array point{drawable(x), drawable(y)};
    if (std::isfinite(point[0]) && std::isfinite(point[1])) all.push_back(point);
  }
  return all;
}

double window_end(const Result& result) {
  double end = std::numeric_limits<double>::quiet_NaN();
  for (const ResultRun* run : {&result.best, &result.baseline}) {
    if (!run->curve.time.empty()) end = std::fmax(end, drawable(run->curve.time.back()));
  }
  return end;
}

std::vector<double> evaluation_indices(const ResultSearch& search) {
  std::vector<double> indices;
  for (const auto& [index, value] : search.evaluations) indices.push_back(index);
  std::sort(indices.begin(), indices.end());
  return indices;
}

double evaluations_until(const std::vector<double>& indices, double index) {
  if (indices.empty()) return index;
  return static_cast<double>(std::upper_bound(indices.begin(), indices.end(), index) - indices.begin());
}

DriveScale drive_scale(std::string_view drive) {
  if (drive == dispersion_drive) return {.name = "Force factor", .unit = "", .rest = 1};
  return {.name = "Voltage", .unit = "V", .rest = 0};
}

DriveLimits drive_limits(const Result& result, const std::string& drive) {
  const auto found = result.scene.drivers.find(drive);
  return found == result.scene.drivers.end() ? DriveLimits{} : found->second;
}

const Points& waveform(const ResultRun& run, const std::string& drive) {
  static const Points none;
  const auto found = run.waveforms.find(drive);
  return found == run.waveforms.end() ? none : found->second;
}

double DriveDemand::peak() const { return std::max(std::abs(lowest), std::abs(highest)); }

DriveDemand drive_demand(const Points& waveform, double rest) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  DriveDemand demand{.lowest = infinity, .highest = -infinity};
  double time = 0, level = rest;
  for (const auto& [next, to] : waveform) {
    if (!std::isfinite(next) || !std::isfinite(to)) continue;
    if (to != level) demand.slew = std::max(demand.slew, next > time ? std::abs(to - level) / (next - time) : infinity);
    demand.lowest = std::min(demand.lowest, to);
    demand.highest = std::max(demand.highest, to);
    time = next;
    level = to;
  }
  if (demand.lowest > demand.highest) demand.lowest = demand.highest = demand.slew = std::numeric_limits<double>::quiet_NaN();
  return demand;
}

}  // namespace softland::internal
