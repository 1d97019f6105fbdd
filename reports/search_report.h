// A search as it is reported, whatever its kind.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "base/watch.h"
#include "reports/closing_record.h"
#include "reports/robustness_report.h"
#include "studies/search/found_search.h"

namespace softland {

/// `result` and `devices` tell of `found`, which stays where it is.
struct SearchReport {
  explicit SearchReport(FoundSearch search) : found(std::move(search)) {}
  SearchReport(const SearchReport&) = delete;
  SearchReport& operator=(const SearchReport&) = delete;

  FoundSearch found;
  std::optional<RobustnessReport> devices = {};  ///< none where none were judged
  ClosingRecord result = {};
};

/// What is known of the devices that were judged. It is further work for a search by one measure, of which `watch` is told; where
/// that is interrupted, so is the search.
void add_devices(SearchReport& report, const PlannedSearch& search, const std::string& command, const Watch& watch);

/// The result. `folder`: where the files of the search will be, for the command that says how a device is measured.
void add_result(SearchReport& report, const PlannedSearch& search, const std::filesystem::path& folder,
                const std::string& command);

}  // namespace softland
