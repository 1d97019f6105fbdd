#include "model/contact/adhesive_repulsive.h"

#include "integrators/roots.h"

namespace softland {

AdhesiveRepulsiveContact::AdhesiveRepulsiveContact(const SurfacePressure& law, double area)
    : law_(law), area_(area), end_(far(Dual(law.reach, 1))) {
  // From the reach inwards; at the reach itself the pressure is 0 as well.
  constexpr int looks = 4096;
  for (int i = looks - 2; i > 0; --i) {
    const double x = law_.reach * i / looks, further = law_.reach * (i + 1) / looks;
    if (pressure(x) >= 0 && pressure(further) < 0) {
      touch_ = bracketed_zero([&](double at) { return pressure(at); }, x, further);
      return;
    }
  }
}

std::vector<double> AdhesiveRepulsiveContact::kinks() const {
  std::vector<double> all{touch_ - law_.asperity_distance - law_.adhesion_range, touch_ - law_.asperity_distance};
  std::erase_if(all, [](double d) { return !(d > 0); });
  return all;
}

double AdhesiveRepulsiveContact::energy(double d) const {
  const double x = touch_ - d, r = law_.reach, s = law_.smoothing_distance;
  // Antiderivative of 1 / (x^3 + s^3).
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

}  // namespace softland
