#include "model/placed_laws.h"

#include <algorithm>

#include "model/built_beam.h"
#include "model/forces/dispersion.h"
#include "model/forces/gold_casimir.h"

namespace softland {

PointRange points_in(const Eigen::ArrayXd& positions, double begin, double end) {
  const auto first = std::lower_bound(positions.begin(), positions.end(), begin);
  const auto last = std::lower_bound(positions.begin(), positions.end(), end);
  return {first - positions.begin(), last - positions.begin()};
}

std::vector<EvenRange> even_ranges(const Structure& s, const Eigen::ArrayXd& positions, double begin, double end) {
  if (!s.is_built()) return {{points_in(positions, begin, end), s.width, s.thickness}};
  std::vector<EvenRange> ranges;
  for (const LocalSection& local : local_sections(s)) {
    const PointRange points = points_in(positions, std::max(begin, local.begin), std::min(end, local.end));
    const double left = area_left(local.holes);
    if (local.is_even()) {
      if (points.begin < points.end) ranges.push_back({points, local.width * left, local.thickness, local.holes, local.width});
    } else {
      for (Eigen::Index p = points.begin; p < points.end; ++p)
        ranges.push_back(
            {{p, p + 1}, local.width_at(positions[p]) * left, local.thickness, local.holes, local.width_at(positions[p])});
    }
  }
  return ranges;
}

std::shared_ptr<const DistributedLaw> one_law(std::vector<std::shared_ptr<const DistributedLaw>> pads) {
  return pads.size() == 1 ? pads.front() : std::make_shared<const LawOnPads>(std::move(pads));
}

std::shared_ptr<const DistributedLaw> dispersion_force(const Dispersion& d, double width, PointRange range, double floor) {
  const auto along = [&](auto law) { return erased(DispersionForce<decltype(law)>{.law = law, .width = width}, range, floor); };
  const VanDerWaals near{.hamaker_constant = d.hamaker_constant, .equilibrium_distance = d.equilibrium_distance};
  if (d.model == DispersionModel::van_der_waals) return along(near);
  const auto with = [&](auto casimir) {
    return d.model == DispersionModel::casimir ? along(casimir) : along(SmallerOfBoth<decltype(casimir)>{casimir, near});
  };
  return d.conductor == Conductor::gold ? with(GoldCasimir{}) : with(IdealCasimir{});
}

}  // namespace softland
