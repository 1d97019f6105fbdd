#include "reports/drive_demand.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "studies/closing/prepared.h"

namespace softland::internal {

DriveScale drive_scale(std::string_view drive) {
  if (drive == dispersion_drive) return {.name = "Force factor", .unit = "", .rest = 1};
  return {.name = "Voltage", .unit = "V", .rest = 0};
}

DriveLimits drive_limits(const ClosingRecord& result, const std::string& drive) {
  const auto found = result.scene.drivers.find(drive);
  return found == result.scene.drivers.end() ? DriveLimits{} : found->second;
}

const Points& waveform(const RunRecord& run, const std::string& drive) {
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
