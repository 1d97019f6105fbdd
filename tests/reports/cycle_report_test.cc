// The page of cycles shows the whole cycle on one time axis.
#include "reports/cycle_report.h"

#include <gmock/gmock.h>

#include <string>

#include "browser.h"
#include "document/svg.h"

namespace softland {
namespace {

using test::in_frame;
using test::PageInBrowser;
using test::said;
using test::visit;
using ::testing::HasSubstr;

const CycleRecord& cycled_record() {
  static const CycleRecord record = [] {
    SceneFile file = SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/mem-gold.toml");
    file.set("structure.modes=1");
    const PreparedScene scene = prepare(file);
    CycleWaveforms waveforms{.name = "mem-gold.toml", .closing = scene.commanded(scene.waveforms()), .opening = {}};
    complete(waveforms, scene);
    return record_of(scene, cycling(scene, waveforms, {.rate = 1e3, .scans = false, .cycles = 4, .devices = 0}), "softland test");
  }();
  return record;
}

TEST(CyclePage, ShowsGapContactAndDrivesOnOneAxisOfTime) {
  const Document document = document_of(cycled_record());
  const internal::Picture drawn = document.draw();
  ASSERT_EQ(drawn.charts.size(), 3U);
  for (const internal::Chart& chart : drawn.charts) {
    EXPECT_EQ(chart.group, "time");
    EXPECT_EQ(chart.x_whole[1], 4e-3);
    EXPECT_EQ(chart.x_home[1], 3e-3);
  }
  EXPECT_EQ(drawn.charts[1].id, "contact");
  EXPECT_TRUE(drawn.charts[1].is_of_bars);
}

TEST(CyclePage, KeepsEveryTouchOfItsCourse) {
  const CycleRecord& record = cycled_record();
  const CycleRecord::Course& course = record.curves.at(record.drives.front().name);
  ASSERT_TRUE(course.closed);
  double in_touch = 0;
  for (const ClosedStretch& one : *course.closed) {
    if (one.begin < 1e-3) in_touch += one.end - one.begin;
  }
  constexpr double rounding = 1e-9;
  EXPECT_NEAR(in_touch / record.drives.front().cycles[0].metrics.closed_time, 1, rounding);
  EXPECT_EQ(json_of(read_cycles(json_of(record))), json_of(record));
}

TEST(CyclePage, DrawsTheRatesThatWereTried) {
  CycleRecord record = cycled_record();
  record.drives.front().steady_rates = {1e3, 2e3};
  record.drives.front().other_rates = {4e3};
  const std::string page = page_html(document_of(record));
  EXPECT_THAT(page, HasSubstr("class=\"steady\""));
  EXPECT_THAT(page, HasSubstr("class=\"unsteady\""));
  EXPECT_THAT(page, HasSubstr("4.00\u00a0kHz"));
  EXPECT_EQ(page_html(document_of(cycled_record())).find("class=\"steady\""), std::string::npos);
}

TEST(CyclePage, SaysWhereTheWaveformsLowerTheRate) {
  CycleRecord record = cycled_record();
  record.drives.push_back(record.drives.front());
  for (CycleRecord::Drive& drive : record.drives) drive.steady_rates = {1e3};
  record.drives[0].largest = 50e3;
  record.drives[1].largest = 17e3;
  EXPECT_THAT(document_of(record).headline,
              HasSubstr("with plain steps, at rates of up to 50.0\u00a0kHz. The waveforms lower the rate"));
  record.drives[1].largest = 60e3;
  EXPECT_EQ(document_of(record).headline.find("lower"), std::string::npos);
}

TEST_F(PageInBrowser, DrawsCyclesInSilenceAndTellsWhenTheContactIsClosed_browser) {
  const std::string page = page_html(document_of(cycled_record()));
  EXPECT_LT(page.size(), 1'000'000U);
  EXPECT_EQ(visit(program, page).console, "");
  const std::string dom = in_frame(
      program, page, 1280,
      "const over = page.querySelector('#figure-contact .u-over'); const seen = new Set(); for (let i = 0; i < 300; ++i) { "
      "over.dispatchEvent(new frame.contentWindow.KeyboardEvent('keydown', {key: 'ArrowRight'})); seen.add([...page."
      "querySelectorAll('#figure-contact .u-value')].pop().textContent); } say([...seen].sort().join(' '));"
      "const bar = page.querySelector('#figure-contact canvas'); const {data} = bar.getContext('2d').getImageData(0, 0, "
      "bar.width, "
      "bar.height); say(data.some((value) => value));");
  EXPECT_EQ(said(dom), "closed open;true;end;");
}

}  // namespace
}  // namespace softland
