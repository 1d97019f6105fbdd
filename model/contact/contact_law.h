// The contact laws a switch can have: the force that pushes the contact point away, as a function of the interference
// d = y(x_c) - dt [m] and, for some, of its rate or its past. Each is a value with its own file; a switch composes one when it is
// built.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/choice.h"
#include "model/constants.h"
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

/// A law of the contact force: its name and its own keys in a scene, its limits, and its maker, which takes the width of the pad.
struct ContactRow {
  ContactModel value;
  std::string_view name;
  Words keys;
  /// Why it cannot act along the pad; empty when it can.
  std::string_view not_along_pad = {};
  /// Acts per area of the pad, so that a plate needs a width and a length of the pad.
  bool per_area = false;
  /// Interference up to which it is physics [m].
  double (*largest_interference)(const Contact&) = [](const Contact&) { return std::numeric_limits<double>::infinity(); };
  ContactLaw (*make)(const Contact&, double width);
};

namespace internal {
/// Summits under the pad.
[[nodiscard]] inline double summits(const Contact& c, double width) { return c.asperity_density * width * c.pad_length; }
/// Force of all summits over d^1.5, by Hertz [N/m^1.5].
[[nodiscard]] inline double hertz(const Contact& c, double width) {
  return summits(c, width) * c.effective_modulus * std::sqrt(c.asperity_radius);
}
[[nodiscard]] inline UniformAsperityContact uniform(const Contact& c, double width) {
  return {.strength = hertz(c, width) / c.asperity_height, .height = c.asperity_height};
}
template <class Elastic>
[[nodiscard]] ContactLaw damped(Elastic law, const Contact& c) {
  if (c.damping > 0) return HuntCrossley<Elastic>{.elastic = law, .damping = c.damping};
  return law;
}
template <class Asperity>
[[nodiscard]] ContactLaw plastic(const Contact& c, double width) {
  return PlasticAsperityContact<Asperity>{
      .loading = {summits(c, width), c.asperity_height, c.asperity_radius, c.hardness, c.effective_modulus},
      .elastic = uniform(c, width)};
}
[[nodiscard]] constexpr double asperity_height(const Contact& c) { return c.asperity_height; }
}  // namespace internal

/// What describes a rough surface.
inline constexpr Words summit_keys{"asperity_radius", "asperity_density", "effective_modulus"};
inline constexpr std::string_view many_dents = "every point of the pad would keep a dent of its own";

inline constexpr auto contact_laws = std::to_array<ContactRow>({
    {.value = ContactModel::linear,
     .name = "linear",
     .keys = {"stiffness", "damping"},
     .make = [](const Contact& c, double) { return internal::damped(LinearContact{.stiffness = c.stiffness}, c); }},
    {.value = ContactModel::asperity_uniform,
     .name = "asperity-uniform",
     .keys = summit_keys + Words{"asperity_height", "damping"},
     .per_area = true,
     .largest_interference = internal::asperity_height,
     .make = [](const Contact& c, double width) { return internal::damped(internal::uniform(c, width), c); }},
    {.value = ContactModel::asperity_gaussian,
     .name = "asperity-gaussian",
     .keys = summit_keys + Words{"asperity_deviation", "damping"},
     .per_area = true,
     .largest_interference = [](const Contact& c) { return GaussianAsperityContact::first_touch * c.asperity_deviation; },
     .make =
         [](const Contact& c, double width) {
           const double sigma = c.asperity_deviation;
           return internal::damped(
               GaussianAsperityContact{.strength = 4.0 / 3 * internal::hertz(c, width) * sigma * std::sqrt(sigma),
                                       .deviation = sigma},
               c);
         }},
    {.value = ContactModel::adhesive,
     .name = "adhesive",
     .keys = summit_keys + Words{"asperity_height", "adhesion_energy"},
     .per_area = true,
     .largest_interference = internal::asperity_height,
     .make = [](const Contact& c, double width) -> ContactLaw {
       return AdhesiveAsperityContact{
           .repulsion = internal::uniform(c, width),
           .attraction = 2 * pi * c.asperity_radius * c.adhesion_energy * internal::summits(c, width) / c.asperity_height};
     }},
    {.value = ContactModel::hysteretic,
     .name = "hysteretic",
     .keys = {"stiffness", "unloading_stiffness"},
     .not_along_pad = many_dents,
     .make = [](const Contact& c, double) -> ContactLaw {
       return HystereticContact{.loading = {.stiffness = c.stiffness}, .elastic = {.stiffness = c.unloading_stiffness}};
     }},
    {.value = ContactModel::elastic_plastic,
     .name = "elastic-plastic",
     .keys = summit_keys + Words{"asperity_height", "hardness", "plasticity"},
     .not_along_pad = many_dents,
     .per_area = true,
     .largest_interference = internal::asperity_height,
     .make =
         [](const Contact& c, double width) {
           return c.plasticity == Plasticity::zmc ? internal::plastic<ZmcAsperity>(c, width)
                                                  : internal::plastic<KogutEtsionAsperity>(c, width);
         }},
    {.value = ContactModel::rigid,
     .name = "rigid",
     .keys = {"restitution"},
     .not_along_pad = "whose impacts have no force",
     .make = [](const Contact& c, double) -> ContactLaw { return RigidContact{.restitution = c.restitution}; }},
    {.value = ContactModel::adhesive_repulsive,
     .name = "adhesive-repulsive",
     .keys = {"asperity_pressure", "asperity_distance", "wall_pressure", "wall_range", "adhesion_pressure", "adhesion_range",
              "hamaker_constant", "smoothing_distance", "reach"},
     .not_along_pad = "which acts before the free end touches",
     .per_area = true,
     .largest_interference = [](const Contact& c) { return AdhesiveRepulsiveContact(c.pressure, 1).touch_distance(); },
     .make = [](const Contact& c, double width) -> ContactLaw {
       return AdhesiveRepulsiveContact(c.pressure, width * c.pad_length);
     }},
});
static_assert(is_complete<contact_laws>());

/// The law of a valid device's contact.
[[nodiscard]] inline ContactLaw contact_law(const Contact& contact, double width) {
  return row_of(contact_laws, contact.model).make(contact, width);
}

/// Interference at which all asperities of a law touch, or four standard deviations of Gaussian ones [m]: beyond, the law is no
/// longer physics. Infinite for a spring.
[[nodiscard]] inline double largest_interference(const Contact& contact) {
  return row_of(contact_laws, contact.model).largest_interference(contact);
}

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
