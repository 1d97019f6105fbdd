// The page in a real browser: what the script draws, and which errors it reports.
#include <gmock/gmock.h>

#include <string>

#include "browser.h"
#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "sample_result.h"

namespace softland {
namespace {

using nlohmann::json;
using test::in_frame;
using test::PageInBrowser;
using test::said;
using test::Visit;
using test::visit;
using ::testing::HasSubstr;
using ::testing::Not;

std::size_t canvases(const std::string& dom) {
  std::size_t count = 0;
  for (std::size_t at = dom.find("<canvas"); at != std::string::npos; at = dom.find("<canvas", at + 1)) ++count;
  return count;
}

TEST_F(PageInBrowser, DrawsEveryChartOfASearchInSilence_browser) {
  const Visit seen = visit(program, page_html(closing_document(read_closing(test::sample_optimize_result(20000)))));
  EXPECT_EQ(seen.console, "");
  EXPECT_EQ(canvases(seen.dom), 7u);
  EXPECT_THAT(seen.dom, HasSubstr("class=\"drawn\""));
}

TEST_F(PageInBrowser, DrawsASingleRunInSilence_browser) {
  const Visit seen = visit(program, page_html(closing_document(read_closing(test::sample_simulate_result(3000)))));
  EXPECT_EQ(seen.console, "");
  EXPECT_EQ(canvases(seen.dom), 6u);
}

TEST_F(PageInBrowser, BearsAResultWithoutCurvesAndOneFullOfNulls_browser) {
  EXPECT_EQ(visit(program, page_html(closing_document(read_closing(json::object())))).console, "");
  json result = test::sample_optimize_result(300);
  for (json& value : result["curves"]["best"]["tip_gap_m"]) value = nullptr;
  for (std::size_t row = 100; row < 200; ++row) result["curves"]["baseline"]["contact_force_N"][row] = nullptr;
  const Visit seen = visit(program, page_html(closing_document(read_closing(result))));
  EXPECT_EQ(seen.console, "");
  EXPECT_EQ(canvases(seen.dom), 7u);
}

TEST_F(PageInBrowser, RunsNoScriptOfAHostileTitle_browser) {
  json result = test::sample_optimize_result(300);
  const std::string hostile =
      "</script><script>document.body.className='owned'</script><img src=x onerror=\"document.body.className='owned'\">";
  result["title"] = hostile;
  result["best"]["waveforms"][hostile] = {{0, 0}, {1e-6, 1}};
  result["search"]["value_name"] = hostile;
  const Visit seen = visit(program, page_html(closing_document(read_closing(result))));
  EXPECT_EQ(seen.console, "");
  EXPECT_THAT(seen.dom, Not(HasSubstr("class=\"owned\"")));
  EXPECT_THAT(seen.dom, HasSubstr("class=\"drawn\""));
}

/// Returns a search of the scene with sketch, limits and the chart of its parameters.
json searched() {
  json result = test::sample_optimize_result(3000);
  result["scene"]["structure"] = {{"kind", "cantilever"}, {"length", "250 um"}};
  result["scene"]["gap"] = {{"electrode", "3.5 um"}, {"contact", "2 um"}};
  result["scene"]["electrode"]["main"] = {{"span", {"60 um", "240 um"}}};
  result["scene"]["piezo"] = {{"span", {"5 um", "240 um"}}};
  result["scene"]["contact"] = {{"pad_length", "5 um"}};
  result["scene"]["driver"]["piezo"] = {{"min_voltage", "-1 V"}, {"max_voltage", "1 V"}, {"max_slew", "1e6 V/s"}};
  result["scene"]["waveform"]["piezo"] = {
      {"family", "pulse"}, {"edge", "5 us"}, {"times", {"19.74662 us", "40.90419 us"}}, {"levels", {"0.17 V", "0.6 V", "0 V"}}};
  result["best"]["bounds"] = {{"piezo.level_1_V", {-1, 1}}, {"piezo.level_2_V", {-1, 0.603}}};
  return result;
}

TEST_F(PageInBrowser, CutsNothingOnANarrowScreen_browser) {
  for (const int width : {420, 1280}) {
    const std::string dom = in_frame(program, page_html(closing_document(read_closing(searched()))), width,
                                     "for (const one of page.querySelectorAll('html, main, .scroll, .keys, figure')) if "
                                     "(one.scrollWidth > one.clientWidth + 1) say(one.className || one.tagName);");
    EXPECT_EQ(said(dom), "end;") << width;
  }
}

TEST_F(PageInBrowser, ReadsTheSameInBothGapChartsAtOneCursor_browser) {
  const std::string dom = in_frame(
      program, page_html(closing_document(read_closing(searched()))), 1280,
      "const over = page.querySelector('#figure-landing .u-over'); const read = (id) => [...page.querySelectorAll('#figure-' + "
      "id + "
      "' .u-value')].map((one) => one.textContent).join(' '); let read_any = false; for (let i = 0; i < 40; ++i) { "
      "over.dispatchEvent(new frame.contentWindow.KeyboardEvent('keydown', {key: 'ArrowRight'})); await new Promise((done) => "
      "setTimeout(done, 20)); const [a, b] = [read('gap'), "
      "read('landing')]; if (/[0-9]/.test(a)) read_any = true; if (a !== b) { say(a + ' is not ' + b); break; } } "
      "say(read_any);");
  EXPECT_EQ(said(dom), "true;end;");
}

TEST_F(PageInBrowser, LeavesRoomForTheNumbersAtItsAxes_browser) {
  json result = searched();
  for (const char* list : {"evaluations", "best_so_far"}) {
    for (json& one : result["search"][list]) one[1] = 12345.0 + 100 * one[1].get<double>();
  }
  const std::string dom =
      in_frame(program, page_html(closing_document(read_closing(result))), 420,
               "for (const canvas of page.querySelectorAll('canvas')) { const {width, height} = canvas; const edge = (x) => "
               "canvas.getContext('2d').getImageData(x, 0, 1, height).data.some((value) => value); if (edge(0) || edge(width - "
               "1)) say('cut: ' + canvas.closest('figure').id); }");
  EXPECT_EQ(said(dom), "end;");
}

TEST_F(PageInBrowser, ReportsWhatAPageComplainsAbout_browser) {
  EXPECT_THAT(visit(program, "<!DOCTYPE html><script>undefined.x</script>").console, HasSubstr("TypeError"));
}

}  // namespace
}  // namespace softland
