// Shows a page in a real browser, if one is installed.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/write_whole.h"
#include "document/escape.h"
#include "tests/support/temporary_folder.h"

namespace softland::test {

/// Returns the standard output of a command.
inline std::string output(const std::string& command) {
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), got);
  ::pclose(pipe);
  return text;
}

inline std::string browser() {
  std::string name = output("command -v chromium || command -v chromium-browser || command -v google-chrome");
  while (!name.empty() && name.back() == '\n') name.pop_back();
  return name;
}

struct Visit {
  std::string dom;
  std::string console;  ///< text that the page wrote to the console, and uncaught errors
};

inline Visit visit(const std::string& program, const std::string& page) {
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

class PageInBrowser : public ::testing::Test {
 protected:
  void SetUp() override {
    program = browser();
    if (program.empty()) GTEST_SKIP() << "skipped: no browser; needs: chromium";
  }
  std::string program;
};

/// Shows the page in a frame of this width [px] and returns the result of `script`, in which `page` is the page's document.
inline std::string in_frame(const std::string& program, const std::string& page, int width, const std::string& script) {
  return visit(program, "<!DOCTYPE html><body><iframe style=\"width:" + std::to_string(width) +
                            "px;height:900px;border:0\"></iframe><p id=\"said\"></p><script>const frame = "
                            "document.querySelector('iframe'); frame.onload = async () => { const page = frame.contentDocument; "
                            "const say = (words) => { document.getElementById('said').textContent += words + ';'; }; " +
                            script + " say('end'); }; frame.srcdoc = " + internal::script_json(page) + ";</script>")
      .dom;
}

inline std::string said(const std::string& dom) {
  const std::size_t begin = dom.find("<p id=\"said\">");
  return begin == std::string::npos ? dom.substr(0, 200) : dom.substr(begin + 13, dom.find("</p>", begin) - begin - 13);
}

}  // namespace softland::test
