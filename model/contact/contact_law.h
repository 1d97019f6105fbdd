// The contact laws a switch can have: the force that pushes the contact point away, as a function of the interference
// d = y(x_c) - dt [m] and, for some, of its rate. Each is a value with its own file; a switch composes one when it is built.
#pragma once

#include <cmath>
#include <variant>

#include "model/contact/adhesive.h"
#include "model/contact/asperity_gaussian.h"
#include "model/contact/asperity_uniform.h"
#include "model/contact/hunt_crossley.h"
#include "model/contact/linear.h"
#include "model/device.h"

namespace softland {

using ContactLaw =
    std::variant<LinearContact, UniformAsperityContact, GaussianAsperityContact, AdhesiveAsperityContact,
                 HuntCrossley<LinearContact>, HuntCrossley<UniformAsperityContact>, HuntCrossley<GaussianAsperityContact>>;

/// The law of a valid device's contact.
[[nodiscard]] ContactLaw contact_law(const Contact& contact, double width);

/// Interference at which all asperities of a law touch, or four standard deviations of Gaussian ones [m]: beyond, the law is no
/// longer physics. Infinite for a spring.
[[nodiscard]] double largest_interference(const Contact& contact);

/// Force [N] of a law at interference d; `rate()` gives d' [m/s] and is asked for only where the law depends on it.
template <class Law, class S, class Rate>
S force_of(const Law& law, S d, Rate&& rate) {
  if constexpr (requires { law.force(d, d); }) {
    return law.force(d, S(rate()));
  } else {
    return law.force(d);
  }
}

/// At rest [N]
[[nodiscard]] inline double contact_force(const ContactLaw& law, double interference) {
  return std::visit([&](const auto& l) { return l.force(interference); }, law);
}
/// [N]
[[nodiscard]] inline double contact_force(const ContactLaw& law, double interference, double rate) {
  return std::visit([&](const auto& l) { return force_of(l, interference, [&] { return rate; }); }, law);
}
/// Stored [J]
[[nodiscard]] inline double contact_energy(const ContactLaw& law, double interference) {
  return std::visit([&](const auto& l) { return l.energy(interference); }, law);
}
/// Taken out by a law that depends on the rate [W]; 0 for the others.
[[nodiscard]] inline double contact_dissipation(const ContactLaw& law, double interference, double rate) {
  return std::visit(
      [&](const auto& l) {
        if constexpr (requires { l.dissipation(interference, rate); }) {
          return l.dissipation(interference, rate);
        } else {
          return 0.0;
        }
      },
      law);
}
[[nodiscard]] inline bool is_rate_dependent(const ContactLaw& law) {
  return std::visit(
      [](const auto& l) {
        return requires { l.dissipation(0.0, 0.0); };
      },
      law);
}

}  // namespace softland
