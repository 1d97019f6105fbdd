// The page in a real browser: what the script draws and what it complains about.
#include <gmock/gmock.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "reports/escape.h"
#include "reports/files.h"
#include "reports/html.h"
#include "reports/result_reader.h"
#include "sample_result.h"
#include "tests/support/temporary_folder.h"

namespace softland {
namespace {

using nlohmann::json;
using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::Not;

/// Standard output of a command.
std::string output(const std::string& command) {
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), got);
  ::pclose(pipe);
  return text;
}

std::string browser() {
  std::string name = output("command -v chromium || command -v chromium-browser || command -v google-chrome");
  while (!name.empty() && name.back() == '\n') name.pop_back();
  return name;
}

struct Visit {
  std::string dom;
  std::string console;  ///< what the page wrote to the console, and errors it did not catch
};

Visit visit(const std::string& program, const std::string& page) {
  const TemporaryFolder folder;
  write_whole(folder.path() / "page.html", page);
  const std::string in = folder.path().string();
  const std::string command =
      "timeout 120 '" + program +
      "' --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
      "--disable-component-update --disable-sync --enable-logging=stderr --v=0 --virtual-time-budget=3000 --user-data-dir='" +
      in + "/profile' --dump-dom 'file://" + in + "/page.html' 2>'" + in + "/log'";
  Visit seen;
  seen.dom = output(command);
  seen.console = output("grep -F CONSOLE '" + in + "/log'");
  return seen;
}

std::size_t canvases(const std::string& dom) {
  std::size_t count = 0;
  for (std::size_t at = dom.find("<canvas"); at != std::string::npos; at = dom.find("<canvas", at + 1)) ++count;
  return count;
}

class PageInBrowser : public ::testing::Test {
 protected:
  void SetUp() override {
    program = browser();
    if (program.empty()) GTEST_SKIP() << "no Chromium here (apt-get install chromium)";
  }
  std::string program;
};

TEST_F(PageInBrowser, DrawsEveryChartOfASearchInSilence) {
  const Visit seen = visit(program, html_report(read_result(test::sample_optimize_result(20000))));
  EXPECT_EQ(seen.console, "");
  EXPECT_EQ(canvases(seen.dom), 7u);
  EXPECT_THAT(seen.dom, HasSubstr("class=\"drawn\""));
}

TEST_F(PageInBrowser, DrawsASingleRunInSilence) {
  const Visit seen = visit(program, html_report(read_result(test::sample_simulate_result(3000))));
  EXPECT_EQ(seen.console, "");
  EXPECT_EQ(canvases(seen.dom), 6u);
}

TEST_F(PageInBrowser, BearsAResultWithoutCurvesAndOneFullOfNulls) {
  EXPECT_EQ(visit(program, html_report(read_result(json::object()))).console, "");
  json result = test::sample_optimize_result(300);
  for (json& value : result["curves"]["best"]["tip_gap_m"]) value = nullptr;
  for (std::size_t row = 100; row < 200; ++row) result["curves"]["baseline"]["contact_force_N"][row] = nullptr;
  const Visit seen = visit(program, html_report(read_result(result)));
  EXPECT_EQ(seen.console, "");
  EXPECT_EQ(canvases(seen.dom), 7u);
}

TEST_F(PageInBrowser, RunsNoScriptOfAHostileTitle) {
  json result = test::sample_optimize_result(300);
  const std::string hostile =
      "</script><script>document.body.className='owned'</script><img src=x onerror=\"document.body.className='owned'\">";
  result["title"] = hostile;
  result["best"]["waveforms"][hostile] = {{0, 0}, {1e-6, 1}};
  result["search"]["value_name"] = hostile;
  const Visit seen = visit(program, html_report(read_result(result)));
  EXPECT_EQ(seen.console, "");
  EXPECT_THAT(seen.dom, Not(HasSubstr("class=\"owned\"")));
  EXPECT_THAT(seen.dom, HasSubstr("class=\"drawn\""));
}

/// The page in a frame of this width [px], and what `script` says of it; `page` is its document there.
std::string in_frame(const std::string& program, const std::string& page, int width, const std::string& script) {
  return visit(program, "<!DOCTYPE html><body><iframe style=\"width:" + std::to_string(width) +
                            "px;height:900px;border:0\"></iframe><p id=\"said\"></p><script>const frame = "
                            "document.querySelector('iframe'); frame.onload = async () => { const page = frame.contentDocument; "
                            "const say = (words) => { document.getElementById('said').textContent += words + ';'; }; " +
                            script + " say('end'); }; frame.srcdoc = " + internal::script_json(page) + ";</script>")
      .dom;
}

std::string said(const std::string& dom) {
  const std::size_t begin = dom.find("<p id=\"said\">");
  return begin == std::string::npos ? dom.substr(0, 200) : dom.substr(begin + 13, dom.find("</p>", begin) - begin - 13);
}

/// A search of the scene with the sketch, the limits and the drawing of its parameters.
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

TEST_F(PageInBrowser, CutsNothingOnANarrowScreen) {
  for (const int width : {420, 1280}) {
    const std::string dom = in_frame(program, html_report(read_result(searched())), width,
                                     "for (const one of page.querySelectorAll('html, main, .scroll, .keys, figure')) if "
                                     "(one.scrollWidth > one.clientWidth + 1) say(one.className || one.tagName);");
    EXPECT_EQ(said(dom), "end;") << width;
  }
}

TEST_F(PageInBrowser, ReadsTheSameInBothGapChartsAtOneCursor) {
  const std::string dom = in_frame(
      program, html_report(read_result(searched())), 1280,
      "const over = page.querySelector('#figure-landing .u-over'); const read = (id) => [...page.querySelectorAll('#figure-' + "
      "id + "
      "' .u-value')].map((one) => one.textContent).join(' '); let read_any = false; for (let i = 0; i < 40; ++i) { "
      "over.dispatchEvent(new frame.contentWindow.KeyboardEvent('keydown', {key: 'ArrowRight'})); await new Promise((done) => "
      "setTimeout(done, 20)); const [a, b] = [read('gap'), "
      "read('landing')]; if (/[0-9]/.test(a)) read_any = true; if (a !== b) { say(a + ' is not ' + b); break; } } "
      "say(read_any);");
  EXPECT_EQ(said(dom), "true;end;");
}

TEST_F(PageInBrowser, LeavesRoomForTheNumbersAtItsAxes) {
  json result = searched();
  for (const char* list : {"evaluations", "best_so_far"}) {
    for (json& one : result["search"][list]) one[1] = 12345.0 + 100 * one[1].get<double>();
  }
  const std::string dom =
      in_frame(program, html_report(read_result(result)), 420,
               "for (const canvas of page.querySelectorAll('canvas')) { const {width, height} = canvas; const edge = (x) => "
               "canvas.getContext('2d').getImageData(x, 0, 1, height).data.some((value) => value); if (edge(0) || edge(width - "
               "1)) say('cut: ' + canvas.closest('figure').id); }");
  EXPECT_EQ(said(dom), "end;");
}

TEST_F(PageInBrowser, ReportsWhatAPageComplainsAbout) {
  EXPECT_THAT(visit(program, "<!DOCTYPE html><script>undefined.x</script>").console, HasSubstr("TypeError"));
}

}  // namespace
}  // namespace softland
