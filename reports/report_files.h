// The files of reports: which there are, and the text of each.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "reports/closing_record.h"
#include "reports/robustness_report.h"
#include "reports/search_report.h"

namespace softland {

template <class Report>
struct ReportFile {
  std::string name;
  std::function<std::string(const Report&)> text;
};

/// report.html, gap.svg, result.json, and trajectory.csv where there is a trajectory.
[[nodiscard]] std::vector<ReportFile<ClosingRecord>> files_of(const ClosingRecord& result);

/// Those of a judgement of drives on devices, by `robustness` or at the end of a search for devices.
inline constexpr std::array robustness_files{"robustness.html", "robustness.json", "devices.csv"};
[[nodiscard]] std::vector<ReportFile<RobustnessReport>> files_of(const RobustnessReport& report);

/// What a search for devices leaves besides.
inline constexpr std::array for_devices_files{"drawing.toml", "drawing.csv", "calibrated.toml", "calibrated.csv", "fast.toml",
                                              "fast.csv",     "soft.toml",   "soft.csv",        "devices.svg"};
/// Those of the result, the waveforms that were found as scenes and as what sources are told, and those of the devices.
[[nodiscard]] std::vector<ReportFile<SearchReport>> files_of(const SearchReport& report);

}  // namespace softland
