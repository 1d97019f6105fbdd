#include "studies/search/evaluation_memory.h"

#include <fmt/format.h>

#include "base/require.h"

namespace softland {

std::vector<std::string> FamilyColumns::names() const {
  std::vector<std::string> all;
  for (const std::vector<std::string>& own : families) all.insert(all.end(), own.begin(), own.end());
  return all;
}

std::vector<double> FamilyColumns::row(std::size_t family, std::span<const double> x) const {
  require(family < families.size() && x.size() == families[family].size(),
          [&] { return fmt::format("a point of {} parameters is none of family {}", x.size(), family); });
  std::vector<double> all;
  for (std::size_t k = 0; k < families.size(); ++k) {
    if (k == family) {
      all.insert(all.end(), x.begin(), x.end());
    } else {
      all.insert(all.end(), families[k].size(), std::numeric_limits<double>::quiet_NaN());
    }
  }
  return all;
}

}  // namespace softland
