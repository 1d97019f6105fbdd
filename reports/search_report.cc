#include "reports/search_report.h"

#include <fmt/format.h>

#include <utility>

#include "base/shell_word.h"
#include "config/scene.h"

namespace softland {
namespace {

// Returns the command line that writes the waveform for a measured device, or, if calibration gains nothing, the waveform for
// all devices; empty if the search found neither.
std::string next_command(const RobustSearchResult& found, const std::filesystem::path& folder) {
  if (!found.calibrated && !found.chosen) return {};
  if (!found.calibrated) return fmt::format("softland export {} --format spice-pwl", shell_word(folder.string()));
  const bool by_time = found.calibrated->written("calibration.time").has_value();
  return fmt::format("softland export {} --measured \"{}\"", shell_word((folder / "calibrated.toml").string()),
                     by_time ? fmt::format("{}={:.4g} us", measured_time, 1e6 * found.closing_time)
                             : fmt::format("{}={:.4g} V", measured_pull_in, found.pull_in));
}

RobustnessOptions options_of(const PlannedSearch& search, std::uint64_t devices) {
  return {.samples = devices, .seed = search.options.seed, .jobs = search.options.jobs};
}

}  // namespace

void add_devices(SearchReport& report, const PlannedSearch& search, const std::string& command, const Progress& progress) {
  if (const auto* searched = std::get_if<RobustSearchResult>(&report.found.result);
      searched != nullptr && !searched->rows.empty()) {
    report.devices.emplace(RobustnessReport{.nominal = searched->varied,
                                            .found = searched->verdict,
                                            .options = options_of(search, search.for_devices->verdict),
                                            .command = command,
                                            .windows = searched->findings.windows});
  }
  const auto* robust = std::get_if<RobustResult>(&report.found.result);
  if (robust == nullptr || !robust->verdict) return;
  report.devices.emplace(RobustnessReport{.nominal = *robust->found.best_scene,
                                          .found = *robust->verdict,
                                          .options = options_of(search, search.robust->verdict),
                                          .command = command});
  add_details(*report.devices, false, progress);
  if (report.devices->interrupted) report.found.best().search.termination = Termination::interrupted;
}

void add_result(SearchReport& report, const PlannedSearch& search, const std::filesystem::path& folder,
                const std::string& command) {
  const auto& found = report.found.result;
  if (const auto* nominal = std::get_if<OptimizeResult>(&found)) {
    report.result = record_of(*nominal, search.options, command);
  } else if (const auto* robust = std::get_if<RobustResult>(&found)) {
    report.result = record_of(*robust, search.options, command);
  } else {
    const auto& searched = std::get<RobustSearchResult>(found);
    report.result = record_of(searched, search.options, next_command(searched, folder), command);
  }
}

}  // namespace softland
