// A search as reports show it, whatever its kind.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "base/progress.h"
#include "reports/closing_record.h"
#include "reports/robustness_report.h"
#include "studies/search/found_search.h"

namespace softland {

/// `result` and `devices` refer to `found`, which stays where it is.
struct SearchReport {
  explicit SearchReport(FoundSearch search) : found(std::move(search)) {}
  SearchReport(const SearchReport&) = delete;
  SearchReport& operator=(const SearchReport&) = delete;

  FoundSearch found;
  std::optional<RobustnessReport> devices = {};  ///< report on devices; none where none were judged
  ClosingRecord result = {};
};

/// Adds the report on the devices that were judged. It is further work for a search by one measure, and `progress` follows it;
/// an interruption marks the search as interrupted.
void add_devices(SearchReport& report, const PlannedSearch& search, const std::string& command, const Progress& progress);

/// Adds the result. `folder` is the final place of the search's files, for the command that says how a device is measured.
void add_result(SearchReport& report, const PlannedSearch& search, const std::filesystem::path& folder,
                const std::string& command);

}  // namespace softland
