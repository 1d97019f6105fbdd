// The page in a real browser: what the script draws and what it complains about.
#include <gmock/gmock.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "reports/files.h"
#include "reports/html.h"
#include "sample_result.h"
#include "temporary_folder.h"

namespace softland {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryFolder;

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
  const Visit seen = visit(program, html_report(testing::sample_optimize_result(20000)));
  EXPECT_EQ(seen.console, "");
  EXPECT_EQ(canvases(seen.dom), 7u);
  EXPECT_THAT(seen.dom, HasSubstr("class=\"drawn\""));
}

TEST_F(PageInBrowser, DrawsASingleRunInSilence) {
  const Visit seen = visit(program, html_report(testing::sample_simulate_result(3000)));
  EXPECT_EQ(seen.console, "");
  EXPECT_EQ(canvases(seen.dom), 6u);
}

TEST_F(PageInBrowser, BearsAResultWithoutCurvesAndOneFullOfNulls) {
  EXPECT_EQ(visit(program, html_report(json::object())).console, "");
  json result = testing::sample_optimize_result(300);
  for (json& value : result["curves"]["best"]["tip_gap_m"]) value = nullptr;
  for (std::size_t row = 100; row < 200; ++row) result["curves"]["baseline"]["contact_force_N"][row] = nullptr;
  const Visit seen = visit(program, html_report(result));
  EXPECT_EQ(seen.console, "");
  EXPECT_EQ(canvases(seen.dom), 7u);
}

TEST_F(PageInBrowser, RunsNoScriptOfAHostileTitle) {
  json result = testing::sample_optimize_result(300);
  const std::string hostile =
      "</script><script>document.body.className='owned'</script><img src=x onerror=\"document.body.className='owned'\">";
  result["title"] = hostile;
  result["best"]["waveforms"][hostile] = {{0, 0}, {1e-6, 1}};
  result["search"]["value_name"] = hostile;
  const Visit seen = visit(program, html_report(result));
  EXPECT_EQ(seen.console, "");
  EXPECT_THAT(seen.dom, Not(HasSubstr("class=\"owned\"")));
  EXPECT_THAT(seen.dom, HasSubstr("class=\"drawn\""));
}

TEST_F(PageInBrowser, ReportsWhatAPageComplainsAbout) {
  EXPECT_THAT(visit(program, "<!DOCTYPE html><script>undefined.x</script>").console, HasSubstr("TypeError"));
}

}  // namespace
}  // namespace softland
