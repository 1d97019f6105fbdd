// The files of a search, and their content about a waveform.
#include "reports/report_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "reports/search_session.h"
#include "studies/closing/sent_signals.h"
#include "waveforms/export.h"

namespace softland {
namespace {

using testing::IsSupersetOf;

SceneFile gold_from_samples() {
  SceneFile file = SceneFile::load(SOFTLAND_SOURCE_DIR "/scenes/mem-gold.toml");
  for (const char* change : {"simulate.accuracy=1e-4", "driver.main.sample_rate=5 MHz", "driver.main.bits=12",
                             "driver.main.bandwidth=1 MHz", "simulate.duration=200 us"})
    file.set(change);
  return file;
}

std::vector<std::string> names_of(const SearchReport& report) {
  std::vector<std::string> names;
  for (const ReportFile<SearchReport>& file : files_of(report)) names.push_back(file.name);
  return names;
}

std::string text_of(const SearchReport& report, const std::string& name) {
  for (const ReportFile<SearchReport>& file : files_of(report)) {
    if (file.name == name) return file.text(report);
  }
  return {};
}

TEST(FilesOfASearch, HoldWhatSourcesAreToldAndNotWhatTheyMakeOfIt_long) {
  PlannedSearch search = planned(completed({.waveform = "pulse", .samples = "100", .budget = "600"}, gold_from_samples()),
                                 gold_from_samples(), "pulse");
  SearchReport report(run(search));
  add_devices(report, search, "", {});
  add_result(report, search, "there", {});
  ASSERT_THAT(names_of(report),
              IsSupersetOf({"result.json", "report.html", "gap.svg", "trajectory.csv", "best.toml", "best.csv", "drawing.toml",
                            "drawing.csv", "robustness.html", "robustness.json", "devices.csv"}));
  const auto& devices = std::get<RobustSearchResult>(report.found.result);
  const PreparedScene& drawing = *devices.nominal.best_scene;
  EXPECT_EQ(text_of(report, "drawing.csv"), commanded_csv(drawing));
  EXPECT_NE(text_of(report, "drawing.csv"), csv(named_signals(drawing), drawing.duration)) << "the output of the source";
  EXPECT_EQ(text_of(report, "best.csv"), commanded_csv(*report.found.best().best_scene));
  EXPECT_EQ(text_of(report, "drawing.toml"), drawing.scene.file.text());
}

TEST(FilesOfASearch, AreFewerWhereNothingIsAskedOfDevices) {
  SceneFile file = SceneFile::load(SOFTLAND_SOURCE_DIR "/scenes/mem-gold.toml");
  file.set("simulate.accuracy=1e-4");
  PlannedSearch search = planned(completed({.waveform = "pulse", .robust = "none", .budget = "40"}, file), file);
  SearchReport report(run(search));
  add_devices(report, search, "", {});
  add_result(report, search, "there", {});
  EXPECT_FALSE(report.devices);
  EXPECT_EQ(names_of(report),
            (std::vector<std::string>{"report.html", "gap.svg", "result.json", "trajectory.csv", "best.toml", "best.csv"}));
}

}  // namespace
}  // namespace softland
