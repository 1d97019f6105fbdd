#include "reports/robustness_prose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "document/quantity.h"
#include "studies/search/devices_findings.h"

namespace softland::internal {

std::string shown_drive(const std::string& name) {
  return name == for_the_devices ? "best.toml" : name == for_nominal_design ? "drawing.toml" : name;
}

std::string with_article(const std::string& name) { return name == plain_step_row ? "the plain step" : shown_drive(name); }

std::string spread_prose(const DeviceSpread& spread) {
  std::string words;
  for (const SpreadVariable& v : spread.variables) {
    std::string keys;
    for (const VariedKey& key : v.keys) keys += (keys.empty() ? "" : " and ") + key.name();
    // Process variation with a uniform distribution is usually stated by its half width.
    const bool is_uniform = v.distribution.kind() == DistributionKind::uniform;
    const double size = v.distribution.standard_deviation() * (is_uniform ? std::sqrt(3.0) : 1);
    words += fmt::format("{}{} {}{} ({})", words.empty() ? "" : ", ", keys, is_uniform ? "within " : "",
                         v.is_factor ? "± " + percent(size) : "± " + quantity(size, v.keys.front().unit),
                         name_of(distribution_kinds, v.distribution.kind()));
  }
  return words;
}

std::string_view error_prose(const DeviceSpread& spread) {
  return spread.varies_drives() ? " The voltage sources have the errors that [spread] states." : "";
}

std::string outside_prose(const Robustness& found) {
  if (found.drives.empty()) return {};
  const std::vector<DeviceOutcome>& outcomes = found.drives.back().outcomes;
  const auto outside = [](const DeviceOutcome& o) { return !o.failure.empty() && o.metrics.status == Status::not_run; };
  const auto count = std::ranges::count_if(outcomes, outside);
  if (count == 0) return {};
  const std::string& why = std::ranges::find_if(outcomes, outside)->failure;
  return fmt::format(
      " {} of them are outside the model and count as devices that do not close; the first: {}.{}", count, why,
      why.find(".span = ") == std::string::npos ? "" : " A span up to \"tip\", or in percent, follows the length.");
}

std::string devices_text(std::uint64_t devices) { return fmt::format("{} device{}", devices, devices == 1 ? "" : "s"); }

std::string window_prose(const HoldWindows& windows) {
  constexpr int digits = 4;
  std::string words;
  for (const auto& [electrode, window] : windows.of_electrodes) {
    words += fmt::format("{}electrode {} ", words.empty() ? "" : ", ", electrode);
    words += !std::isfinite(window.lower) ? "no voltage"
             : std::isinf(window.upper)
                 ? fmt::format("from {} on", quantity(window.lower, "V", digits))
                 : fmt::format("{} to {}", quantity(window.lower, "V", digits), quantity(window.upper, "V", digits));
  }
  if (words.empty()) return words;
  return fmt::format("Hold voltages that keep {:.0f} % of {} closed, between release and collapse: {}.", 100 * held_share,
                     devices_text(windows.devices), words);
}

std::string calibration_prose(const Calibration& c) {
  std::string words;
  const auto add = [&](std::string_view name, const std::optional<double>& error) {
    if (!error) return;
    words += (words.empty() ? "" : ", ") + std::string(name) + (*error > 0 ? " ± " + percent(*error) : " exactly");
  };
  add(measured_pull_in, c.pull_in_error);
  add(measured_frequency, c.frequency_error);
  add(measured_piezo, c.piezo_error);
  if (c.time_error)
    words += (words.empty() ? "" : ", ") + fmt::format("closing time under {} Vdp{}", closing_step,
                                                       *c.time_error > 0 ? " ± " + quantity(*c.time_error, "s") : " exactly");
  return c.classes ? fmt::format("{}, {} classes", words, *c.classes) : words;
}

std::string why_no_indices(std::size_t rows, std::size_t failed_rows) {
  return fmt::format("no indices: {} of the {} rows of devices hold one without the figure, and at most 1 % may", failed_rows,
                     rows);
}

bool is_erring(const Calibration& c) {
  return c.pull_in_error.value_or(0) > 0 || c.frequency_error.value_or(0) > 0 || c.piezo_error.value_or(0) > 0 ||
         c.time_error.value_or(0) > 0;
}

std::vector<double> shown_values(const Ensemble& ensemble, std::size_t k) {
  return DeviceDrives(ensemble.nominal()).shown(ensemble.values(k));
}

bool is_had(const RobustnessRecord& found, const Figure& figure) {
  const auto some = [&](auto&& holds) { return std::any_of(found.drives.begin(), found.drives.end(), holds); };
  return some([&](const auto& d) { return d.figures[figure].devices > 0; }) ||
         (figure.asked == nullptr && !some([](const auto& d) { return d.closing.devices > 0; }));
}

bool some_collapse(const RobustnessRecord& found) {
  return std::ranges::any_of(found.drives, [](const auto& d) { return d.collapsed.value > 0; });
}

const EstimatedQuantile& quantile_95(const RobustnessRecord::Drive& drive, std::string_view key) {
  return drive.figures[figure_of(key)].quantiles[2];
}

std::string yield_text(const Yield& yield) {
  return fmt::format("{} ({} to {})", share_text(yield.value), share_number(yield.interval.low),
                     share_number(yield.interval.high));
}

std::string quantile_text(const EstimatedQuantile& q, std::string_view unit) {
  if (std::isinf(q.value)) return "∞";
  const double factor = unit.empty() ? 1 : prefix_for(q.value).factor;
  const auto bound = [&](double value) { return std::isfinite(value) ? plain_number(value / factor) : std::string("—"); };
  if (!std::isfinite(q.interval.low) && !std::isfinite(q.interval.high)) return fmt::format("{} (—)", quantity(q.value, unit));
  return fmt::format("{} ({} to {})", quantity(q.value, unit), bound(q.interval.low), bound(q.interval.high));
}

}  // namespace softland::internal
