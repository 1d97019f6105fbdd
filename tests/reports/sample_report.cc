// Writes sample pages and figures into a folder, for inspection by eye.
#include <cstdio>
#include <filesystem>

#include "base/write_whole.h"
#include "document/svg.h"
#include "reports/closing_charts.h"
#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "reports/exploration_report.h"
#include "sample_exploration.h"
#include "sample_result.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: sample_report FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const auto optimize = softland::test::sample_optimize_result();
  const auto simulate = softland::test::sample_simulate_result();
  softland::write_whole(folder / "optimize.html", softland::page_html(closing_document(softland::read_closing(optimize))));
  softland::write_whole(folder / "simulate.html", softland::page_html(closing_document(softland::read_closing(simulate))));
  softland::write_whole(folder / "optimize.svg", softland::svg_gap_chart(softland::read_closing(optimize)));
  softland::write_whole(folder / "simulate.svg", softland::svg_gap_chart(softland::read_closing(simulate)));
  const auto grid = softland::test::sample_grid(200, 200);
  softland::write_whole(folder / "grid.html", softland::page_html(exploration_document(grid)));
  softland::write_whole(folder / "grid.svg", softland::exploration_map_svg(grid, 0, 1, 6));
  softland::write_whole(folder / "cloud.html", softland::page_html(exploration_document(softland::test::sample_cloud(100'000))));
  return 0;
}
