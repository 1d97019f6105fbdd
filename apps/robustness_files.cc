#include "apps/robustness_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/output.h"

namespace softland::apps {

std::string box_file(std::string_view key) { return fmt::format("box-{}.toml", figure_of(key).symbol); }

void add_details(RobustnessReport& report, bool other_ways_too, const Watch& watch) {
  if (report.found.interrupted || report.found.devices == 0) return;
  constexpr std::uint64_t devices_per_row = 4, most_rows = 1024;
  const DriveRobustness& last = report.found.drives.back();
  report.sensitivity =
      sensitivity(report.nominal, last, std::clamp<std::uint64_t>(report.options.samples / devices_per_row, 8, most_rows),
                  report.options, watch);
  report.derivatives = derivatives(report.nominal, internal::exactly_measured(report.nominal, last), {}, watch);
  report.windows = hold_windows(report.nominal, report.options, watch);
  report.courses = device_courses(report.nominal, last, report.found, report.options);
  if (other_ways_too) report.other_ways = other_ways(report.nominal, last, report.options, {}, watch);
  report.interrupted = watch.stopped();
}

void write_robustness(ResultFolder& folder, const RobustnessReport& report) {
  folder.write("robustness.html", robustness_html(report));
  folder.write("robustness.json", json_text(robustness_json(report), 2));
  folder.write("devices.csv", robustness_csv(report));
}

}  // namespace softland::apps
