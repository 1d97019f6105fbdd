// The gas of a device: the parameters of one of its laws. A new law is a header and a line here.
#pragma once

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

/// The state of the gas; null for a law that does not ask for it.
[[nodiscard]] inline const FilmState* film_of(const Gas& gas) {
  return std::visit(
      [](const auto& law) -> const FilmState* {
        if constexpr (requires { law.film; }) return &law.film;
        return nullptr;
      },
      gas);
}
/// Rest thickness of a second film, on the far side [m]; not a number where there is none.
[[nodiscard]] inline double far_gap(const Gas& gas) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.far_gap; }) return law.far_gap;
        return not_given;
      },
      gas);
}
/// Of one film whose ends are open [m]; not a number where it is much longer than wide.
[[nodiscard]] inline double film_length(const Gas& gas) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.film_length; }) return law.film_length;
        return not_given;
      },
      gas);
}
/// A film that can be compressed, with pressures as states of their own: see model/gas/reynolds_film.h.
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
