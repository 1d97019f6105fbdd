// The gas of a device: the parameters of its gas law. To add a law, write a header and add its parameters to the variant Gas.
#pragma once

#include <utility>
#include <variant>

#include "model/gas/gallis_torczynski.h"
#include "model/gas/guo_alexeenko.h"
#include "model/gas/linear_damper.h"
#include "model/gas/near_contact.h"
#include "model/gas/slip.h"
#include "model/gas/strip.h"
#include "model/gas/strip_slit.h"
#include "model/gas/veijola.h"

namespace softland {

using Gas = std::variant<StripGas, StripSlitGas, VeijolaGas, GallisTorczynskiGas, NearContactGas, GuoAlexeenkoGas, ReynoldsGas,
                         LinearGas>;

namespace internal {
template <class>
struct LawsOf;
template <class... Laws>
struct LawsOf<std::variant<Laws...>> {
  using Type = std::variant<decltype(std::declval<const Laws&>().law(std::declval<const Film&>()))...>;
};
}  // namespace internal
/// A gas law of any kind: a variant of all types that the alternatives of Gas return by their function law(film).
struct GasLaw : internal::LawsOf<Gas>::Type {
  using variant::variant;
};

/// Returns the state of the gas (viscosity, pressure, temperature) in the parameters of a gas law; null for a law without gas
/// state.
[[nodiscard]] inline const FilmState* film_of(const Gas& gas) {
  return std::visit(
      [](const auto& law) -> const FilmState* {
        if constexpr (requires { law.film; }) return &law.film;
        return nullptr;
      },
      gas);
}
/// Returns the thickness at rest of a second gas film, on the far side [m]; NaN without a second film.
[[nodiscard]] inline double far_gap(const Gas& gas) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.far_gap; }) return law.far_gap;
        return not_given;
      },
      gas);
}
/// Returns the length of the gas film with open ends [m]; NaN for a film that counts as much longer than wide.
[[nodiscard]] inline double film_length(const Gas& gas) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.film_length; }) return law.film_length;
        return not_given;
      },
      gas);
}
/// Returns true for a compressible gas film, whose pressures are further states of the motion: see model/gas/reynolds_film.h.
[[nodiscard]] inline bool is_compressible(const Gas& gas) {
  return std::visit(
      [](const auto& law) {
        return requires { law.is_compressible; };
      },
      gas);
}
[[nodiscard]] inline FilmLimits limits_of(const Gas& gas) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.limits; }) return law.limits;
        return FilmLimits{};
      },
      gas);
}

}  // namespace softland
