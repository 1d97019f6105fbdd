#include "document/chart.h"

namespace softland::internal {

Chart chart_over_time(const std::string& id, const std::string& title, const std::string& y_label, const std::string& y_unit,
                      double until, int height) {
  Chart chart{
      .id = id, .title = title, .x_column = "time_s", .x_label = "Time", .x_unit = "s", .y_label = y_label, .y_unit = y_unit};
  chart.x_home = chart.x_whole = {0, until};
  chart.height = height;
  return chart;
}

}  // namespace softland::internal
