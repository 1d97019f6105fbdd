#include "reports/report_files.h"

#include <utility>

#include "base/write_whole.h"
#include "document/svg.h"
#include "reports/closing_charts.h"
#include "reports/closing_document.h"
#include "reports/device_gaps.h"
#include "reports/record_file.h"
#include "studies/closing/sent_signals.h"
#include "waveforms/export.h"

namespace softland {
namespace {

const RobustSearchResult& searched_devices(const SearchReport& report) {
  return std::get<RobustSearchResult>(report.found.result);
}

// Adds the files of a part of the report on a search: of its result, or of the simulated devices.
template <class Part>
void add(std::vector<ReportFile<SearchReport>>& files, const Part& part, const Part& (*part_of)(const SearchReport&)) {
  for (ReportFile<Part>& file : files_of(part)) {
    files.push_back({std::move(file.name),
                     [text = std::move(file.text), part_of](const SearchReport& report) { return text(part_of(report)); }});
  }
}

PreparedScene calibrated(const SearchReport& report) {
  return read_back(*searched_devices(report).calibrated, "calibrated.toml", searched_devices(report).nominal.scene);
}

PreparedScene choice(const SearchReport& report, std::size_t k) {
  const DeviceChoice& one = searched_devices(report).choices[k];
  return read_back(*one.scene, one.name + ".toml", searched_devices(report).nominal.scene);
}

std::string scene_text(const PreparedScene& scene) { return scene.scene.file.text(); }

}  // namespace

std::vector<ReportFile<ClosingRecord>> files_of(const ClosingRecord& result) {
  std::vector<ReportFile<ClosingRecord>> files{
      {"report.html", [](const ClosingRecord& r) { return page_html(closing_document(r)); }},
      {"gap.svg", svg_gap_chart},
      {"result.json", [](const ClosingRecord& r) { return json_text(json_of(r)); }}};
  if (result.devices() != nullptr && result.devices()->courses) files.push_back({"devices.svg", svg_devices});
  if (result.best.figures)
    files.push_back({"trajectory.csv", [](const ClosingRecord& r) { return trajectory_csv(r.best.curve); }});
  return files;
}

std::vector<ReportFile<RobustnessReport>> files_of(const RobustnessReport&) {
  return {{robustness_files[0], [](const RobustnessReport& r) { return page_html(robustness_document(r)); }},
          {robustness_files[1], [](const RobustnessReport& r) { return json_text(json_of(record_of(r)), 2); }},
          {robustness_files[2], robustness_csv}};
}

std::vector<ReportFile<SearchReport>> files_of(const SearchReport& report) {
  std::vector<ReportFile<SearchReport>> files;
  add<ClosingRecord>(files, report.result, [](const SearchReport& r) -> const ClosingRecord& { return r.result; });
  if (report.found.best().best_scene) {
    files.push_back({"best.toml", [](const SearchReport& r) { return scene_text(*r.found.best().best_scene); }});
    files.push_back({"best.csv", [](const SearchReport& r) { return commanded_csv(*r.found.best().best_scene); }});
  }
  const auto* devices = std::get_if<RobustSearchResult>(&report.found.result);
  if (devices != nullptr && devices->nominal.best_scene) {
    files.push_back(
        {for_devices_files[0], [](const SearchReport& r) { return scene_text(*searched_devices(r).nominal.best_scene); }});
    files.push_back(
        {for_devices_files[1], [](const SearchReport& r) { return commanded_csv(*searched_devices(r).nominal.best_scene); }});
  }
  if (devices != nullptr && devices->calibrated) {
    files.push_back({for_devices_files[2], [](const SearchReport& r) { return scene_text(calibrated(r)); }});
    files.push_back({for_devices_files[3], [](const SearchReport& r) { return commanded_csv(calibrated(r)); }});
  }
  if (devices != nullptr) {
    for (std::size_t k = 0; k < devices->choices.size(); ++k) {
      const std::string& name = devices->choices[k].name;
      if (!devices->choices[k].scene) continue;
      files.push_back({name + ".toml", [k](const SearchReport& r) { return scene_text(choice(r, k)); }});
      files.push_back({name + ".csv", [k](const SearchReport& r) { return commanded_csv(choice(r, k)); }});
    }
  }
  if (report.devices)
    add<RobustnessReport>(files, *report.devices, [](const SearchReport& r) -> const RobustnessReport& { return *r.devices; });
  return files;
}

}  // namespace softland
