// Ranges of quadrature points, and the distributed laws that act on them.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "base/choice.h"
#include "model/device.h"
#include "model/distributed_law.h"
#include "model/forces/electrostatic.h"

namespace softland {

struct PointRange {
  Eigen::Index begin, end;
};

/// Points of a range under a structure of one width and thickness, and with one pattern of holes.
struct EvenRange {
  PointRange points;
  double width;      ///< without the holes [m]
  double thickness;  ///< [m]
  Holes holes = {};
  double full_width = width;  ///< with the holes [m]
};

/// Returns the points between two places [m].
[[nodiscard]] PointRange points_in(const Eigen::ArrayXd& positions, double begin, double end);
/// Returns ranges of points between two places, each with constant sizes of the structure. A uniform structure has one range;
/// when the width changes along the structure each point is a range of its own.
[[nodiscard]] std::vector<EvenRange> even_ranges(const Structure& structure, const Eigen::ArrayXd& positions, double begin,
                                                 double end);

/// Returns a law that acts on a range; `floor` is the gap below which its tangent continues it [m].
template <class Law>
std::shared_ptr<const DistributedLaw> erased(Law law, PointRange range, double floor) {
  return std::make_shared<const DistributedLawOf<Law>>(law, range.begin, range.end, floor);
}
/// Combines the laws of all pads of an electrode.
[[nodiscard]] std::shared_ptr<const DistributedLaw> one_law(std::vector<std::shared_ptr<const DistributedLaw>> pads);

/// Calls `make` with the force law of an electrode that has this fringing field.
template <class Make>
std::shared_ptr<const DistributedLaw> electrostatic(Fringing fringing, const EvenRange& range, Make&& make) {
  return std::visit([&](const auto& law) { return make(ElectrostaticForce<std::decay_t<decltype(law)>>{law}); },
                    row_of(fringing_laws, fringing).make(range.width, range.thickness));
}
/// Returns the dispersion force on a strip of this width [m].
[[nodiscard]] std::shared_ptr<const DistributedLaw> dispersion_force(const Dispersion& dispersion, double width, PointRange range,
                                                                     double floor);

}  // namespace softland
