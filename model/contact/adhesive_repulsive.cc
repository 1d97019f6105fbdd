#include "model/contact/adhesive_repulsive.h"

#include <fmt/format.h>

#include "base/engineering.h"
#include "integrators/roots.h"

namespace softland {

template <>
double AdhesiveRepulsiveContact::find_touch(const SurfacePressure& law) {
  const AdhesiveRepulsiveContact contact(law, 1, 0);
  // First contact is at the largest distance at which the pressure changes its sign. The sign is checked at this number of
  // distances, from the reach of the law inwards; at the reach itself the pressure is 0.
  constexpr int looks = 4096;
  for (int i = looks - 2; i > 0; --i) {
    const double x = law.reach * i / looks, further = law.reach * (i + 1) / looks;
    if (contact.pressure(x) >= 0 && contact.pressure(further) < 0) {
      return bracketed_zero([&](double at) { return contact.pressure(at); }, x, further);
    }
  }
  return 0;
}

template <>
std::vector<double> AdhesiveRepulsiveContact::kinks() const {
  std::vector<double> all{touch_ - law_.asperity_distance - law_.adhesion_range, touch_ - law_.asperity_distance};
  std::erase_if(all, [](double d) { return !(d > 0); });
  return all;
}

template <>
double AdhesiveRepulsiveContact::energy(double d) const {
  const double x = touch_ - d, r = law_.reach, s = law_.smoothing_distance;
  // Returns the antiderivative of 1 / (x^3 + s^3), to which the attraction is proportional; s is the smoothing distance.
  const auto attraction = [s](double at) {
    const double u = at / s;
    return (std::log((u + 1) / std::sqrt(u * u - u + 1)) + std::sqrt(3) * std::atan((2 * u - 1) / std::sqrt(3))) / (3 * s * s);
  };
  double sum = law_.wall_pressure * law_.wall_range * (std::exp(-x / law_.wall_range) - std::exp(-r / law_.wall_range)) -
               law_.hamaker_constant / (6 * pi) * (attraction(r) - attraction(x)) - end_.value * (r - x) +
               end_.slope * (r - x) * (r - x) / 2;
  const double depth = std::max(0.0, law_.asperity_distance - x) / unit;
  const double near = std::max(0.0, law_.asperity_distance + law_.adhesion_range - x) / unit;
  sum += unit * (law_.asperity_pressure * depth * depth * std::sqrt(depth) / 2.5 - law_.adhesion_pressure * near * near / 2);
  return area_ * sum;
}

std::string AdhesiveRepulsiveSurfaces::why_invalid(double contact_gap) const {
  const double meet = pressure.asperity_distance + pressure.adhesion_range;
  if (!(pressure.reach > meet && pressure.reach <= 1))
    return fmt::format("contact.reach = {}: must exceed asperity_distance + adhesion_range = {} and be at most 1 m",
                       engineering(pressure.reach, "m"), engineering(meet, "m"));
  const AdhesiveRepulsiveContact of_an_area(pressure, 1);
  if (!(of_an_area.touch_distance() > 0)) return "contact: these pressures never turn from attraction to repulsion";
  if (!(of_an_area.reach() < contact_gap))
    return fmt::format("contact.reach = {}: acts {} above the plane of first touch, which must be less than gap.contact = {}",
                       engineering(pressure.reach, "m"), engineering(of_an_area.reach(), "m"), engineering(contact_gap, "m"));
  return {};
}

}  // namespace softland
