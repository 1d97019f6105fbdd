// The contact laws of a switch. A contact law is the force that pushes the contact point away, as a function of the
// interference (position of the contact point less the contact gap). Some laws also depend on the rate of the interference, or
// remember its largest value. Each law is a value type with its own file.
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

/// A contact law of any kind: a variant of all types that the alternatives of ContactModel return by their function law(pad).
struct ContactLaw : internal::KernelsOf<ContactModel>::Type {
  using variant::variant;
};

/// A contact law that is one formula for loading and unloading, and that can be inverted. Closings in SIMD lanes and circuit
/// models support such a law, and the law with damping.
template <class Law>
concept InvertibleContact = requires(const Law& law) {
  law.interference(0.0);
  law.interference_of_energy(0.0);
};
/// True for an invertible contact law with the damping of Hunt and Crossley.
template <class Law>
inline constexpr bool is_damped_invertible = false;
template <InvertibleContact Elastic>
inline constexpr bool is_damped_invertible<HuntCrossley<Elastic>> = true;

namespace internal {
template <class>
struct InvertibleOf;
template <class... Laws>
struct InvertibleOf<std::variant<Laws...>>
    : WithKernels<std::variant<>, std::conditional_t<InvertibleContact<Laws>, std::variant<Laws>, std::variant<>>...> {};
}  // namespace internal
/// An invertible contact law of any kind.
using InvertibleContactLaw = internal::InvertibleOf<ContactLaw::variant>::Type;

/// Returns the pad size of a contact, all its equal pads together; `width` is that of the moving part [m].
[[nodiscard]] inline ContactPad pad_of(const Contact& contact, double width) {
  const double one = contact.pad_width > 0 ? contact.pad_width : width;
  return {.width = one * contact.count, .length = contact.pad_length, .count = contact.count};
}

/// Returns the force law of a contact, all its equal pads together; `width` is that of the moving part [m]. The device must be
/// valid.
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

/// Calls f with the contact law like std::visit, but inlined. Use it where speed matters: with more than eleven alternatives
/// std::visit calls through a table, which the compiler cannot inline.
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

/// Returns the contact force [N] at interference d. `state` is that of a contact on which the law acts (ContactState::active).
/// `rate()` returns the rate of d [m/s] and is called only if the law depends on the rate.
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

/// Returns the static contact force on first loading at an interference [N].
[[nodiscard]] inline double contact_force(const ContactLaw& law, double interference) {
  return std::visit([&](const auto& l) { return l.force(interference); }, law);
}
/// Returns the contact force [N] at an interference [m] and its rate [m/s], for a `state` in which the law acts
/// (ContactState::active).
[[nodiscard]] inline double contact_force(const ContactLaw& law, double interference, const ContactState& state, double rate) {
  return std::visit([&](const auto& l) { return force_of(l, interference, state, [&] { return rate; }); }, law);
}
/// Returns the integral of the static contact force on first loading from 0 to the interference [J]: the stored energy of a law
/// without memory.
[[nodiscard]] inline double contact_energy(const ContactLaw& law, double interference) {
  return std::visit([&](const auto& l) { return l.energy(interference); }, law);
}
/// Returns the energy that the contact stores at an interference [J], for a `state` in which the law acts
/// (ContactState::active).
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
/// The residual deformation (dent) that a contact keeps after unloading from its deepest interference; zero for laws without
/// memory.
struct Dent {
  double shift = 0;    ///< residual interference, at which the contact force vanishes [m]
  double lost = 0;     ///< energy that loading to the deepest interference dissipates [J]
  bool heals = false;  ///< true when the dent vanishes as soon as the contact opens
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
/// Returns the height above the contact plane at which a contact law begins to act [m]; 0 for most laws.
[[nodiscard]] inline double contact_reach(const ContactLaw& law) {
  return std::visit(
      [](const auto& l) {
        if constexpr (requires { l.reach(); }) return l.reach();
        return 0.0;
      },
      law);
}
/// Returns the interferences at which the force of a contact law is continuous, but not smooth, in rising order [m]; empty for
/// most laws.
[[nodiscard]] inline std::vector<double> contact_kinks(const ContactLaw& law) {
  return std::visit(
      [](const auto& l) {
        if constexpr (requires { l.kinks(); }) return l.kinks();
        return std::vector<double>();
      },
      law);
}
/// Returns true for a user's own contact law (OwnContact), which has no exact derivatives.
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
