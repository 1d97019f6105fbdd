#include "apps/output.h"

#include <fmt/format.h>

#include <iostream>
#include <system_error>

#include "base/require.h"
#include "reports/files.h"
#include "reports/html.h"
#include "reports/result_json.h"
#include "reports/svg.h"
#include "reports/text.h"

namespace softland::apps {

namespace fs = std::filesystem;
using nlohmann::json;

void make_folder(const std::string& out) {
  std::error_code error;
  fs::create_directories(out, error);
  require(!error, fmt::format("--out {}: the folder cannot be created: {}", out, error.message()));
}

void write_report(const fs::path& folder, const json& result) {
  write_whole(folder / "report.html", html_report(result));
  write_whole(folder / "gap.svg", svg_gap_chart(result));
}

void write_outputs(const Common& c, const json& result, std::vector<std::string> left) {
  if (!c.out.empty()) {
    const fs::path folder = c.out;
    write_whole(folder / "result.json", result.dump() + "\n");
    write_report(folder, result);
    left.insert(left.begin(), {"report.html", "gap.svg", "result.json"});
    const auto curves = result.at("curves").find("best");
    if (curves != result.at("curves").end()) {
      write_whole(folder / "trajectory.csv", trajectory_csv(*curves));
      left.emplace_back("trajectory.csv");
    }
  }
  if (!c.json.empty() && c.json != "-") write_whole(c.json, summary_json(result).dump(2) + "\n");
  if (c.json == "-") {
    std::cout << summary_json(result).dump(2) << "\n";
    return;
  }
  std::cout << text_report(result);
  if (!left.empty()) std::cout << "\n" << wrapped(fmt::format("In {}: {}", c.out, fmt::join(left, ", "))) << "\n";
}

void print_json_or(const Common& c, const json& j, const std::string& text) {
  if (!c.json.empty() && c.json != "-") write_whole(c.json, j.dump(2) + "\n");
  std::cout << (c.json == "-" ? j.dump(2) + "\n" : text);
}

}  // namespace softland::apps
