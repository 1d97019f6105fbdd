#include "model/contact/resistance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include "model/built_beam.h"
#include "model/constants.h"
#include "model/contact/contact_law.h"

namespace softland {

ContactResistance::ContactResistance(const Contact& contact, double width)
    : is_known_(contact.conduction.is_given()), metal_(contact.conduction), contacts_(contact.count) {
  const ContactPad pad = pad_of(contact, width);
  std::visit(
      [&]<class Law>(const Law& law) {
        if constexpr (requires { law.summits; }) {
          summits_ = law.summits.count(pad);
          radius_ = law.summits.radius;
          modulus_ = law.summits.effective_modulus;
        }
        if constexpr (requires { law.height; }) height_ = law.height;
        if constexpr (requires { law.deviation; }) {
          height_ = law.deviation;
          is_gaussian_ = true;
        }
        if constexpr (requires { law.hardness; }) metal_.hardness = law.hardness;
        if constexpr (std::is_same_v<Law, AdhesiveAsperities>) adhesion_ = 2 * pi * law.summits.radius * law.adhesion_energy;
      },
      contact.model);
}

double ContactResistance::of_spot(double radius, double resistivity, double mean_free_path) {
  const double knudsen = mean_free_path / radius;
  const double gamma = (1 + 0.83 * knudsen) / (1 + 1.33 * knudsen);
  return 4 * resistivity * mean_free_path / (3 * pi * radius * radius) + gamma * resistivity / (2 * radius);
}

double ContactResistance::conductance(double interference, double force) const {
  double touching = 0;
  if (summits_ > 0) {
    const double share =
        is_gaussian_ ? std::erfc((GaussianAsperityContact::first_touch - interference / height_) / std::numbers::sqrt2) / 2
                     : std::clamp(interference / height_, 0.0, 1.0);
    touching = summits_ * share;
  }
  const double load = force + adhesion_ * touching;
  if (!(load > 0)) return 0;
  const double spots = std::max(touching, contacts_), one = load / spots;
  double radius = 0;
  if (metal_.hardness > 0) radius = std::sqrt(one / (pi * metal_.hardness));
  if (summits_ > 0) radius = std::max(radius, std::cbrt(3 * one * radius_ / (4 * modulus_)));
  return 1 / (of_spot(radius, metal_.resistivity, metal_.mean_free_path) / spots + metal_.film_resistance / contacts_);
}

double ContactResistance::resistance(double interference, double force) const {
  return resistance_of(conductance(interference, force));
}

ContactResistance contact_resistance(const Device& device, std::size_t contact) {
  return {device.contacts[contact], width_at(device.structure, device.contact_position(contact))};
}

double connection_conductance(const Device& device, std::span<const double> conductances) {
  const bool in_series = device.connection == Connection::all;
  double sum = 0;
  for (std::size_t c = 0; c < conductances.size(); ++c) {
    if (device.contacts[c].connects) sum += in_series ? 1 / conductances[c] : conductances[c];
  }
  return in_series ? 1 / sum : sum;
}

double resistance_of(double conductance) { return conductance == 0 ? std::numeric_limits<double>::quiet_NaN() : 1 / conductance; }

}  // namespace softland
