// Ranges of quadrature points along the structure, and the distributed force laws that act on these ranges.
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

/// A range of quadrature points under a structure of one width and thickness, and with one pattern of holes.
struct EvenRange {
  PointRange points;
  double width;      ///< width of the structure after holes are subtracted: the width times the share of area that remains [m]
  double thickness;  ///< thickness of the structure [m]
  Holes holes = {};
  double full_width = width;  ///< width of the structure between its edges, not reduced by holes [m]
};

/// Returns the range of quadrature points between two positions along the structure [m].
[[nodiscard]] PointRange points_in(const Eigen::ArrayXd& positions, double begin, double end);
/// Returns ranges of quadrature points between two positions along the structure, each with constant width and thickness. A
/// uniform structure has one range; when the width changes along the structure each point is a separate range.
[[nodiscard]] std::vector<EvenRange> even_ranges(const Structure& structure, const Eigen::ArrayXd& positions, double begin,
                                                 double end);

/// Returns a force law that acts on a range of quadrature points, as an object of the common base class DistributedLaw. Below
/// the gap `floor` [m] the law is continued by its tangent.
template <class Law>
std::shared_ptr<const DistributedLaw> erased(Law law, PointRange range, double floor) {
  return std::make_shared<const DistributedLawOf<Law>>(law, range.begin, range.end, floor);
}
/// Combines the force laws of several pads, such as those of one electrode, in one law.
[[nodiscard]] std::shared_ptr<const DistributedLaw> one_law(std::vector<std::shared_ptr<const DistributedLaw>> pads);

/// Returns make(law), law being the electrostatic force law of an electrode with this fringing field.
template <class Make>
std::shared_ptr<const DistributedLaw> electrostatic(Fringing fringing, const EvenRange& range, Make&& make) {
  return std::visit([&](const auto& law) { return make(ElectrostaticForce<std::decay_t<decltype(law)>>{law}); },
                    row_of(fringing_laws, fringing).make(range.width, range.thickness));
}
/// Returns the dispersion force on a strip of this width [m].
[[nodiscard]] std::shared_ptr<const DistributedLaw> dispersion_force(const Dispersion& dispersion, double width, PointRange range,
                                                                     double floor);

}  // namespace softland
