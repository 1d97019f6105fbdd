#include "studies/inverse/fitted_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "config/edited_scene.h"
#include "config/schema.h"

namespace softland {

void set_spread(SceneFile& file, const Fit& fit) {
  if (!fit.population) return;
  const FittedPopulation& all = *fit.population;
  std::vector<std::string> pairs;
  for (std::size_t i = 0; i < all.names.size(); ++i) {
    const SpreadVariable& variable = fit.scene.scene.spread.variables[all.variables[i]];
    std::vector<std::string> keys, weights;
    for (const VariedKey& key : variable.keys) {
      keys.push_back('"' + key.name() + '"');
      weights.push_back(number_text(key.weight));
    }
    // The width of a distribution of factors is relative to its mean, which becomes the fitted value in the scene.
    const std::string width =
        variable.is_factor
            ? fmt::format("cov=\"{:.4g} %\"", 100 * all.deviation[i] / all.mean[i])
            : fmt::format("standard_deviation=\"{}\"", quantity_text(all.deviation[i], variable.keys.front().measured_in));
    const std::string added = variable.is_added ? fmt::format("weights=[{}],", fmt::join(weights, ",")) : "";
    file.set(fmt::format("spread.\"{}\"={{keys=[{}],{}distribution=\"normal\",{}}}", all.names[i], fmt::join(keys, ","), added,
                         width));
    for (std::size_t j = 0; j < i; ++j) {
      constexpr double most = 0.999;  // largest correlation that is written; a higher one would make two variables equal
      const double correlation = all.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      pairs.push_back(fmt::format("[\"{}\",\"{}\",{:.4f}]", all.names[j], all.names[i], std::clamp(correlation, -most, most)));
    }
  }
  if (!pairs.empty()) file.set(fmt::format("spread.correlation=[{}]", fmt::join(pairs, ",")));
}

namespace {

// Returns the fit with the mean over all devices (their population) in place of each device's own values.
Fit of_population(Fit fit) {
  if (!fit.population) return fit;
  for (std::size_t i = 0; i < fit.population->names.size(); ++i) {
    const SpreadVariable& variable = fit.scene.scene.spread.variables[fit.population->variables[i]];
    const double unit = variable.is_factor && variable.keys.size() == 1 ? variable.keys.front().nominal : 1;
    for (FittedUnknown& u : fit.unknowns) {
      if (u.name == fit.population->names[i]) u.value = unit * fit.population->mean[i];
    }
  }
  return fit;
}

}  // namespace

std::string fitted_text(const Fit& fit, std::string_view text, const std::string& path, const std::string& device) {
  std::vector<SceneEdit> edits;
  for (const Fit::FittedKey& key : of_population(fit).keys(device))
    edits.push_back({.path = key.path, .element = key.element, .value = key.value, .remark = "fitted"});
  std::string fitted = edited_scene(text, path, edits);
  if (!fit.population) return fitted;
  SceneFile with_spread = SceneFile::parse(fitted, path, std::filesystem::path(path).parent_path());
  set_spread(with_spread, fit);
  return with_spread_of(fitted, path, with_spread);
}

}  // namespace softland
