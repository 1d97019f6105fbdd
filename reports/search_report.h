// A search of any kind, with the data that reports show.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "base/progress.h"
#include "reports/closing_record.h"
#include "reports/robustness_report.h"
#include "studies/search/search_request.h"

namespace softland {

/// A search result with the data for reports. `result` and `devices` keep references to `found`: a SearchReport must not be
/// moved.
struct SearchReport {
  explicit SearchReport(FoundSearch search) : found(std::move(search)) {}
  SearchReport(const SearchReport&) = delete;
  SearchReport& operator=(const SearchReport&) = delete;

  FoundSearch found;
  /// Report on simulated devices under process variation; none if no devices were simulated.
  std::optional<RobustnessReport> devices = {};
  ClosingRecord result = {};
};

/// Adds the report on devices under process variation. A search that minimises one statistic of the devices needs further
/// simulations for this, which `progress` watches; an interruption marks the search as interrupted.
void add_devices(SearchReport& report, const PlannedSearch& search, const std::string& command, const Progress& progress);

/// Sets `result`, from which reports are made. `folder` is the final folder of the files: a report suggests a command that
/// scales the waveform in the folder for a measured device.
void add_result(SearchReport& report, const PlannedSearch& search, const std::filesystem::path& folder,
                const std::string& command);

}  // namespace softland
