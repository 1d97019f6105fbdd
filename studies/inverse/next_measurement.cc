#include "studies/inverse/next_measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/engineering.h"
#include "studies/closing/actuator.h"

namespace softland {

std::vector<PossibleMeasurement> possible_measurements(const PreparedScene& p) {
  constexpr double of_volts = 0.005, of_frequency = 1e-3, of_capacitance = 0.01;
  std::vector<PossibleMeasurement> all;
  const auto add = [&](std::string name, const Instrument& instrument, double error, double relative) {
    all.push_back({.name = std::move(name), .instrument = instrument, .error = error, .relative_error = relative});
  };
  for (int mode = 0; mode < std::min(2, p.model.modes()); ++mode)
    add(mode == 0 ? "resonance" : "second resonance", {.what = Measurable::frequency, .mode = static_cast<std::size_t>(mode)}, 0,
        of_frequency);
  const std::vector<std::string> names = p.drive_names();
  for (std::size_t k = 0; k < p.scene.device.electrodes.size(); ++k) {
    if (!pulls_in(p.scene.device, k)) continue;
    const std::string of = p.scene.device.electrodes.size() > 1 ? fmt::format(" of '{}'", names[k]) : "";
    const double volts = static_pull_in(p.model, k, bias_of(p.scene, k)).voltage;
    add("pull-in voltage" + of, {.what = Measurable::pull_in, .drive = k}, 0, of_volts);
    add("capacitance at 0 V" + of, {.what = Measurable::capacitance, .drive = k}, 0, of_capacitance);
    if (p.model.has_contact()) add("release voltage" + of, {.what = Measurable::release, .drive = k}, 0, of_volts);
    if (!std::isfinite(volts)) continue;
    const std::optional<DriverLimits>& limits = p.drives[k].limits;
    const auto is_allowed = [&](double level) {
      return !limits || (level >= limits->min_voltage && level <= limits->max_voltage);
    };
    const auto rounded = [](double v) { return std::stod(fmt::format("{:.3g}", v)); };
    const double half = rounded(0.8 * volts);
    if (is_allowed(half)) {
      add(fmt::format("capacitance at {}{}", engineering(half, "V", 4), of),
          {.what = Measurable::capacitance, .drive = k, .level = half}, 0, of_capacitance);
      add(fmt::format("resonance at {}{}", engineering(half, "V", 4), of),
          {.what = Measurable::frequency, .drive = k, .level = half}, 0, of_frequency);
    }
    if (!p.model.has_contact()) continue;
    for (const double over : {1.1, 1.5, 2.0, 3.0}) {
      const double level = rounded(over * volts);
      if (!is_allowed(level)) continue;
      add(fmt::format("closing time at {}{}", engineering(level, "V", 4), of),
          {.what = Measurable::closing_time, .drive = k, .level = level}, usual_time_error, 0);
    }
  }
  return all;
}

}  // namespace softland
