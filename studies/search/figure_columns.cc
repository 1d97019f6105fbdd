#include "studies/search/figure_columns.h"

#include <array>
#include <string_view>
#include <utility>

namespace softland {

PointFigure parameter_figure(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> suffixes{
      {{"_rad_s", "rad/s"}, {"_rad", "rad"}, {"_s", "s"}, {"_V", "V"}}};
  for (const auto& [suffix, unit] : suffixes) {
    if (!name.ends_with(suffix)) continue;
    std::string quantity = name.substr(0, name.size() - suffix.size());
    return {.quantity = quantity, .name = quantity, .unit = std::string(unit)};
  }
  return {.quantity = name, .name = name, .unit = {}};
}

PointFigure figure_column(const Figure& figure, const std::string& before, const std::string& words) {
  return {.quantity = before + std::string(figure.quantity()),
          .name = std::string(figure.name) + words,
          .unit = std::string(figure.unit)};
}

}  // namespace softland
