#include "model/contact/contact_law.h"

#include <limits>

namespace softland {
namespace {

template <class Elastic>
ContactLaw damped(Elastic law, double damping) {
  if (damping > 0) return HuntCrossley<Elastic>{.elastic = law, .damping = damping};
  return law;
}

template <class Asperity>
ContactLaw plastic(const Contact& c, double summits, const UniformAsperityContact& elastic) {
  return PlasticAsperityContact<Asperity>{
      .loading = {summits, c.asperity_height, c.asperity_radius, c.hardness, c.effective_modulus}, .elastic = elastic};
}

}  // namespace

ContactLaw contact_law(const Contact& c, double width) {
  const double summits = c.asperity_density * width * c.pad_length;
  const double hertz = summits * c.effective_modulus * std::sqrt(c.asperity_radius);
  const UniformAsperityContact uniform{.strength = hertz / c.asperity_height, .height = c.asperity_height};
  switch (c.model) {
    case ContactModel::linear:
      return damped(LinearContact{.stiffness = c.stiffness}, c.damping);
    case ContactModel::asperity_gaussian: {
      const double sigma = c.asperity_deviation;
      return damped(GaussianAsperityContact{.strength = 4.0 / 3 * hertz * sigma * std::sqrt(sigma), .deviation = sigma},
                    c.damping);
    }
    case ContactModel::adhesive:
      return AdhesiveAsperityContact{.repulsion = uniform,
                                     .attraction = 2 * pi * c.asperity_radius * c.adhesion_energy * summits / c.asperity_height};
    case ContactModel::hysteretic:
      return HystereticContact{.loading = {.stiffness = c.stiffness}, .elastic = {.stiffness = c.unloading_stiffness}};
    case ContactModel::elastic_plastic:
      return c.plasticity == Plasticity::zmc ? plastic<ZmcAsperity>(c, summits, uniform)
                                             : plastic<KogutEtsionAsperity>(c, summits, uniform);
    case ContactModel::rigid:
      return RigidContact{.restitution = c.restitution};
    case ContactModel::adhesive_repulsive:
      return AdhesiveRepulsiveContact(c.pressure, width * c.pad_length);
    case ContactModel::asperity_uniform:
      break;
  }
  return damped(uniform, c.damping);
}

double largest_interference(const Contact& c) {
  switch (c.model) {
    case ContactModel::linear:
    case ContactModel::hysteretic:
    case ContactModel::rigid:
      return std::numeric_limits<double>::infinity();
    case ContactModel::adhesive_repulsive:
      return AdhesiveRepulsiveContact(c.pressure, 1).touch_distance();
    case ContactModel::asperity_gaussian:
      return GaussianAsperityContact::first_touch * c.asperity_deviation;
    case ContactModel::asperity_uniform:
    case ContactModel::adhesive:
    case ContactModel::elastic_plastic:
      break;
  }
  return c.asperity_height;
}

}  // namespace softland
