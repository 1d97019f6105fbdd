// The contact laws of a switch: the force that pushes the contact point away, as a function of the interference (position of
// the contact point less the contact gap) and, for some laws, of its rate or its past. Each law is a value type with its own
// file.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "model/contact/adhesive.h"
#include "model/contact/adhesive_repulsive.h"
#include "model/contact/asperity_gaussian.h"
#include "model/contact/asperity_uniform.h"
#include "model/contact/contact.h"
#include "model/contact/contact_state.h"
#include "model/contact/hunt_crossley.h"
#include "model/contact/linear.h"
#include "model/contact/memory.h"
#include "model/contact/rigid.h"

namespace softland {

namespace internal {
/// Adds alternatives to a variant, except those that the variant already has.
template <class Variant, class... More>
struct WithKernels;
template <class... Kernels>
struct WithKernels<std::variant<Kernels...>> {
  using Type = std::variant<Kernels...>;
};
template <class... Kernels, class Next, class... More>
struct WithKernels<std::variant<Kernels...>, Next, More...>
    : WithKernels<
          std::conditional_t<(std::is_same_v<Kernels, Next> || ...), std::variant<Kernels...>, std::variant<Kernels..., Next>>,
          More...> {};
template <class... Kernels, class... Two, class... More>
struct WithKernels<std::variant<Kernels...>, std::variant<Two...>, More...>
    : WithKernels<std::variant<Kernels...>, Two..., More...> {};

template <class Model>
struct KernelsOf;
template <class... Models>
struct KernelsOf<std::variant<Models...>>
    : WithKernels<std::variant<>, decltype(std::declval<const Models&>().law(std::declval<const ContactPad&>()))...> {};
}  // namespace internal

/// A contact law of any kind: the variant of all types that the parameters of ContactModel return by law(pad).
struct ContactLaw : internal::KernelsOf<ContactModel>::Type {
  using variant::variant;
};

/// Returns the pads of a contact, whose moving part has this width [m].
[[nodiscard]] inline ContactPad pad_of(const Contact& contact, double width) {
  const double one = contact.pad_width > 0 ? contact.pad_width : width;
  return {.width = one * contact.count, .length = contact.pad_length, .count = contact.count};
}

/// Returns the law of a valid device's contact, whose moving part has this width [m]: the force of all its pads together.
[[nodiscard]] inline ContactLaw contact_law(const Contact& contact, double width) {
  const auto as_law = [](auto kernel) -> ContactLaw {
    if constexpr (requires { kernel.valueless_by_exception(); }) {
      return std::visit([](auto& one) -> ContactLaw { return std::move(one); }, kernel);
    } else {
      return kernel;
    }
  };
  const ContactPad pad = pad_of(contact, width);
  return std::visit([&](const auto& model) { return as_law(model.law(pad)); }, contact.model);
}

/// Calls f with the contact law, as std::visit does, on the hot path: with more than eleven laws std::visit calls through a
/// table, which the compiler cannot inline.
template <std::size_t I = 0, class F>
decltype(auto) visit_inline(F&& f, const ContactLaw& law) {
  if constexpr (I + 1 < std::variant_size_v<ContactLaw::variant>) {
    if (law.index() != I) return visit_inline<I + 1>(std::forward<F>(f), law);
  }
  return f(*std::get_if<I>(&law));
}

template <class Law>
concept HasMemory = requires(const Law& law) {
  law.shift(0.0);
};

/// Returns the force [N] of a contact law at interference d, in a state in which the law acts. `rate()` returns the rate of d
/// [m/s] and is called only if the law depends on the rate.
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

/// Returns the contact force at an interference at rest, on first loading [N].
[[nodiscard]] inline double contact_force(const ContactLaw& law, double interference) {
  return std::visit([&](const auto& l) { return l.force(interference); }, law);
}
/// Returns the contact force in a state in which the law acts [N].
[[nodiscard]] inline double contact_force(const ContactLaw& law, double interference, const ContactState& state, double rate) {
  return std::visit([&](const auto& l) { return force_of(l, interference, state, [&] { return rate; }); }, law);
}
/// Returns the potential of the static force on first loading [J]; laws without memory store this energy.
[[nodiscard]] inline double contact_energy(const ContactLaw& law, double interference) {
  return std::visit([&](const auto& l) { return l.energy(interference); }, law);
}
/// Returns the energy that the contact stores in a state in which the law acts [J].
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
/// The residual deformation (dent) of a contact after unloading from the deepest interference; zero for laws without memory.
struct Dent {
  double shift = 0;    ///< residual interference, at which the contact force vanishes [m]
  double lost = 0;     ///< energy that is lost when the dent is made [J]
  bool heals = false;  ///< true when the dent of the contact vanishes at the end of the touch
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
/// Returns the power that a contact law with damping dissipates [W]; 0 for other laws.
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
/// Returns the height above the plane of first touch at which a contact law begins to act [m]; 0 for most laws.
[[nodiscard]] inline double contact_reach(const ContactLaw& law) {
  return std::visit(
      [](const auto& l) {
        if constexpr (requires { l.reach(); }) return l.reach();
        return 0.0;
      },
      law);
}
/// Returns the interferences at which the force of a contact law is continuous, but not smooth, in order [m]; none for most
/// laws.
[[nodiscard]] inline std::vector<double> contact_kinks(const ContactLaw& law) {
  return std::visit(
      [](const auto& l) {
        if constexpr (requires { l.kinks(); }) return l.kinks();
        return std::vector<double>();
      },
      law);
}
/// Returns true for a user's own law, which has no exact derivatives.
[[nodiscard]] inline bool is_own(const ContactLaw& law) {
  return std::visit(
      [](const auto& l) {
        return requires { l.own; };
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
