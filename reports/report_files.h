// The files of reports: names and texts.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "reports/closing_record.h"
#include "reports/robustness_report.h"
#include "reports/search_session.h"

namespace softland {

template <class Report>
struct ReportFile {
  std::string name;
  std::function<std::string(const Report&)> text;
};

/// Lists the files of the report on a closing: report.html, gap.svg, result.json, and trajectory.csv if the results have a
/// trajectory.
[[nodiscard]] std::vector<ReportFile<ClosingRecord>> files_of(const ClosingRecord& result);

/// Names of the files on simulated devices, from `robustness` or from a search under process variation.
inline constexpr std::array robustness_files{"robustness.html", "robustness.json", "devices.csv"};
[[nodiscard]] std::vector<ReportFile<RobustnessReport>> files_of(const RobustnessReport& report);

/// Names of further files of a search that offers several waveforms for the devices under process variation.
inline constexpr std::array for_devices_files{"drawing.toml", "drawing.csv", "calibrated.toml", "calibrated.csv", "fast.toml",
                                              "fast.csv",     "soft.toml",   "soft.csv",        "devices.svg"};
/// Lists the files of a search's result, of the waveforms found (as scenes and as commanded voltages), and of the report on the
/// devices.
[[nodiscard]] std::vector<ReportFile<SearchReport>> files_of(const SearchReport& report);

}  // namespace softland
