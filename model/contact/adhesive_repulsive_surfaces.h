// The contact law "adhesive-repulsive" of a scene: see model/contact/adhesive_repulsive.h.
#pragma once

#include <string>
#include <string_view>

#include "model/contact/summits.h"

namespace softland {

template <class P>
class AdhesiveRepulsiveContactOf;

/// Parameters of the pressure between two surfaces as a function of their distance (formula in
/// model/contact/adhesive_repulsive.h).
template <class P>
struct SurfacePressureOf {
  P asperity_pressure = 1.2e3;     ///< pressure c1 of the asperities a nanometre below dc [Pa]
  P asperity_distance = 110e-9;    ///< distance dc of the mean planes at which asperities meet [m]
  P wall_pressure = 0.5e9;         ///< pressure c2 of the exponential repulsion at distance 0 [Pa]
  P wall_range = 8.5e-9;           ///< decay length tR of the exponential repulsion [m]
  P adhesion_pressure = 1e3;       ///< pressure c3 of the adhesion a nanometre below dc + ta [Pa]
  P adhesion_range = 2e-9;         ///< distance ta above dc at which adhesion begins [m]
  P hamaker_constant = 0.215e-18;  ///< Hamaker constant A of the attraction [J]
  P smoothing_distance = 30e-9;    ///< distance ds that keeps the attraction finite at distance 0 [m]
  P reach = 1e-6;                  ///< distance xr beyond which the surfaces exert no pressure [m]
};
using SurfacePressure = SurfacePressureOf<double>;

struct AdhesiveRepulsiveSurfaces {
  static constexpr std::string_view name = "adhesive-repulsive", not_along_pad = "which acts before the free end touches";
  static constexpr bool per_area = true, sticks = true;
  SurfacePressure pressure = {};

  static consteval auto fields() {
    using Law = AdhesiveRepulsiveSurfaces;
    using P = SurfacePressure;
    // clang-format off
    return std::to_array<Field<Law>>({
        {.key = "asperity_pressure", .unit = "Pa", .about = "of the asperities, a nanometre within asperity_distance", .in = reach<Law, &Law::pressure, &P::asperity_pressure>, .fallback = "'1.2 kPa'"},
        {.key = "asperity_distance", .unit = "m", .about = "between the mean planes when asperities meet", .in = reach<Law, &Law::pressure, &P::asperity_distance>, .fallback = "'110 nm'"},
        {.key = "wall_pressure", .unit = "Pa", .about = "of the soft wall at distance 0: at the distance x it is wall_pressure exp(-x / wall_range)", .in = reach<Law, &Law::pressure, &P::wall_pressure>, .fallback = "'0.5 GPa'"},
        {.key = "wall_range", .unit = "m", .about = "over which the soft wall falls by e", .in = reach<Law, &Law::pressure, &P::wall_range>, .fallback = "'8.5 nm'"},
        {.key = "adhesion_pressure", .unit = "Pa", .about = "of adhesion, a nanometre within its range", .in = reach<Law, &Law::pressure, &P::adhesion_pressure>, .fallback = "'1 kPa'"},
        {.key = "adhesion_range", .unit = "m", .about = "how far beyond asperity_distance adhesion begins", .in = reach<Law, &Law::pressure, &P::adhesion_range>, .fallback = "'2 nm'"},
        {.key = "hamaker_constant", .unit = "J", .about = "of the attraction from afar", .in = reach<Law, &Law::pressure, &P::hamaker_constant>, .fallback = "'2.15e-19 J'"},
        {.key = "smoothing_distance", .unit = "m", .about = "keeps that attraction finite", .in = reach<Law, &Law::pressure, &P::smoothing_distance>, .fallback = "'30 nm'"},
        {.key = "reach", .unit = "m", .about = "distance of the mean planes beyond which nothing acts; above asperity_distance + adhesion_range, and less than gap.contact above first touch", .in = reach<Law, &Law::pressure, &P::reach>, .fallback = "'1 um'"},
    });
    // clang-format on
  }
  [[nodiscard]] static constexpr AdhesiveRepulsiveSurfaces example() { return {}; }
  /// Returns the interference at which the mean planes of the surfaces meet [m].
  [[nodiscard]] double largest_interference() const;
  /// Returns a message that names the rule violated by the parameters, for this contact gap [m]; empty when they violate none.
  [[nodiscard]] std::string why_invalid(double contact_gap) const;
  [[nodiscard]] AdhesiveRepulsiveContactOf<double> law(const ContactPad& pad) const;
};

}  // namespace softland
