#include "apps/robustness_files.h"

#include <fmt/format.h>

#include "apps/output.h"

namespace softland::apps {

std::string box_file(std::string_view key) { return fmt::format("box-{}.toml", figure_of(key).symbol); }

void write_robustness(ResultFolder& folder, const RobustnessReport& report) {
  folder.write("robustness.html", robustness_html(report));
  folder.write("robustness.json", json_text(robustness_json(report), 2));
  folder.write("devices.csv", robustness_csv(report));
}

}  // namespace softland::apps
