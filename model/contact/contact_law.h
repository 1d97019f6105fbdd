// The contact laws a switch can have: the force that pushes the contact point away, as a function of the interference
// d = y(x_c) - dt [m] and, for some, of its rate or its past. Each is a value with its own file; a switch composes one when it is
// built.
#pragma once

#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "model/contact/adhesive.h"
#include "model/contact/adhesive_repulsive.h"
#include "model/contact/asperity_gaussian.h"
#include "model/contact/asperity_uniform.h"
#include "model/contact/hunt_crossley.h"
#include "model/contact/linear.h"
#include "model/contact/memory.h"
#include "model/contact/rigid.h"
#include "model/device.h"

namespace softland {

using ContactLaw = std::variant<UniformAsperityContact, LinearContact, GaussianAsperityContact, AdhesiveAsperityContact,
                                HuntCrossley<LinearContact>, HuntCrossley<UniformAsperityContact>,
                                HuntCrossley<GaussianAsperityContact>, HystereticContact, PlasticAsperityContact<ZmcAsperity>,
                                PlasticAsperityContact<KogutEtsionAsperity>, RigidContact, AdhesiveRepulsiveContact>;

/// The law of a valid device's contact.
[[nodiscard]] ContactLaw contact_law(const Contact& contact, double width);

/// Interference at which all asperities of a law touch, or four standard deviations of Gaussian ones [m]: beyond, the law is no
/// longer physics. Infinite for a spring.
[[nodiscard]] double largest_interference(const Contact& contact);

/// std::visit for the hot path: with more than eleven laws that one calls through a table, which the compiler cannot see through.
template <std::size_t I = 0, class F>
decltype(auto) visit_inline(F&& f, const ContactLaw& law) {
  if constexpr (I + 1 < std::variant_size_v<ContactLaw>) {
    if (law.index() != I) return visit_inline<I + 1>(std::forward<F>(f), law);
  }
  return f(*std::get_if<I>(&law));
}

template <class Law>
concept HasMemory = requires(const Law& law) {
  law.shift(0.0);
};

/// Force [N] of a law at interference d in a state in which it acts; `rate()` gives d' [m/s] and is asked for only where the law
/// depends on it.
template <class Law, class S, class Rate>
S force_of(const Law& law, S d, const ContactState& state, Rate&& rate) {
  if constexpr (HasMemory<Law>) {
    return law.force(d, state);
  } else if constexpr (requires { law.dissipation(0.0, 0.0); }) {
    return law.force(d, S(rate()));
  } else {
    return law.force(d);
  }
}

/// At rest, on first loading [N]
[[nodiscard]] inline double contact_force(const ContactLaw& law, double interference) {
  return std::visit([&](const auto& l) { return l.force(interference); }, law);
}
/// In a state in which the law acts [N]
[[nodiscard]] inline double contact_force(const ContactLaw& law, double interference, const ContactState& state, double rate) {
  return std::visit([&](const auto& l) { return force_of(l, interference, state, [&] { return rate; }); }, law);
}
/// Potential of the static force on first loading [J]; for laws without memory that is what they store.
[[nodiscard]] inline double contact_energy(const ContactLaw& law, double interference) {
  return std::visit([&](const auto& l) { return l.energy(interference); }, law);
}
/// Stored in a state in which the law acts [J]
[[nodiscard]] inline double stored_energy(const ContactLaw& law, double interference, const ContactState& state) {
  return std::visit(
      [&](const auto& l) {
        if constexpr (requires { l.stored(interference, state); }) {
          return l.stored(interference, state);
        } else {
          return l.energy(interference);
        }
      },
      law);
}
/// What a law with memory keeps of the deepest interference; nothing for the others.
struct Dent {
  double shift = 0;    ///< residual interference [m]
  double lost = 0;     ///< energy that making it has taken [J]
  bool heals = false;  ///< forgotten when contact ends
};
[[nodiscard]] inline Dent dent(const ContactLaw& law, double deepest) {
  return std::visit(
      [&](const auto& l) {
        if constexpr (HasMemory<std::decay_t<decltype(l)>>) {
          return Dent{.shift = l.shift(deepest), .lost = l.lost(deepest), .heals = l.heals};
        } else {
          return Dent{};
        }
      },
      law);
}
[[nodiscard]] inline bool has_memory(const ContactLaw& law) {
  return std::visit([](const auto& l) { return HasMemory<std::decay_t<decltype(l)>>; }, law);
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
/// How far above the plane of first touch a law acts [m]; 0 for most.
[[nodiscard]] inline double contact_reach(const ContactLaw& law) {
  const auto* far = std::get_if<AdhesiveRepulsiveContact>(&law);
  return far != nullptr ? far->reach() : 0;
}
/// Interferences beyond touch at which a law is continuous, but not smooth, in order [m]; none for most.
[[nodiscard]] inline std::vector<double> contact_kinks(const ContactLaw& law) {
  const auto* far = std::get_if<AdhesiveRepulsiveContact>(&law);
  return far != nullptr ? far->kinks() : std::vector<double>{};
}
[[nodiscard]] inline bool is_rate_dependent(const ContactLaw& law) {
  return std::visit(
      [](const auto& l) {
        return requires { l.dissipation(0.0, 0.0); };
      },
      law);
}

}  // namespace softland
