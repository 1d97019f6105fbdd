// The gas laws as one value, and the limits of each.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/choice.h"
#include "model/gas/air.h"
#include "model/gas/gallis_torczynski.h"
#include "model/gas/guo_alexeenko.h"
#include "model/gas/linear_damper.h"
#include "model/gas/near_contact.h"
#include "model/gas/slip.h"
#include "model/gas/strip.h"
#include "model/gas/strip_slit.h"
#include "model/gas/veijola.h"
#include "model/trajectory.h"

namespace softland {

using GasLaw = std::variant<StripSqueezeFilm, StripOverSlit, VeijolaFilm, GallisTorczynskiFilm, NearContactFilm, GuoAlexeenkoFilm,
                            SlipFilm, LinearDamper>;

/// What a law is made of.
struct Film {
  const Gas& gas;
  const Structure& structure;
  double viscosity;       ///< that of the gas, less what the open ends of a film let out [Pa s]
  double mean_free_path;  ///< [m]
  double unit_quality;    ///< damping per length that gives the first mode a quality factor of one [N s/m^2]
};

inline constexpr double incompressible = 10;  ///< squeeze number up to which a strip film is; the strip's cut-off is pi^2

/// A law of the squeeze film: its name and its own keys in a scene, where it holds, and its maker.
struct GasRow {
  GasModel value;
  std::string_view name;
  Words keys;
  double least_knudsen = 0;
  double most_knudsen = std::numeric_limits<double>::infinity();
  double most_squeeze = std::numeric_limits<double>::infinity();  ///< 12 mu a^2 omega / (p h^2)
  bool needs_thickness = false;                                   ///< of the moving part
  GasLaw (*make)(const Film&);
};

/// What describes a gas film.
inline constexpr Words film_keys{"viscosity", "pressure", "temperature", "mean_free_path"};

inline constexpr auto gas_laws = std::to_array<GasRow>({
    {.value = GasModel::strip,
     .name = "strip",
     .keys = film_keys + Words{"film_length", "far_gap"},
     .most_knudsen = 0.1,
     .most_squeeze = incompressible,
     .make = [](const Film& f) -> GasLaw { return StripSqueezeFilm{.viscosity = f.viscosity, .width = f.structure.width}; }},
    {.value = GasModel::strip_slit,
     .name = "strip-slit",
     .keys = film_keys + Words{"film_length", "slit_height", "slit_length", "far_gap"},
     .most_knudsen = 0.1,
     .most_squeeze = incompressible,
     .make = [](const Film& f) -> GasLaw {
       return StripOverSlit{.viscosity = f.viscosity,
                            .width = f.structure.width,
                            .slit_height = f.gas.slit_height,
                            .slit_length = f.gas.slit_length};
     }},
    {.value = GasModel::veijola,
     .name = "veijola",
     .keys = film_keys + Words{"film_length", "far_gap"},
     .most_knudsen = 880,
     .most_squeeze = incompressible,
     .make = [](const Film& f) -> GasLaw {
       return VeijolaFilm{.viscosity = f.viscosity, .mean_free_path = f.mean_free_path, .width = f.structure.width};
     }},
    {.value = GasModel::gallis_torczynski,
     .name = "gallis-torczynski",
     .keys = film_keys + Words{"far_gap"},
     .most_squeeze = incompressible,
     .make = [](const Film& f) -> GasLaw {
       return GallisTorczynskiFilm{.viscosity = f.viscosity, .mean_free_path = f.mean_free_path, .width = f.structure.width};
     }},
    {.value = GasModel::near_contact,
     .name = "near-contact",
     .keys = film_keys + Words{"far_gap"},
     .least_knudsen = 1 / NearContactFilm::rarefied,
     .most_squeeze = incompressible,
     .make = [](const Film& f) -> GasLaw {
       return NearContactFilm{.viscosity = f.viscosity, .mean_free_path = f.mean_free_path, .width = f.structure.width};
     }},
    {.value = GasModel::guo_alexeenko,
     .name = "guo-alexeenko",
     .keys = film_keys + Words{"far_gap"},
     .needs_thickness = true,
     .make = [](const Film& f) -> GasLaw {
       return GuoAlexeenkoFilm{
           .mean_free_path = f.mean_free_path, .width = f.structure.width, .thickness = f.structure.thickness};
     }},
    {.value = GasModel::reynolds,
     .name = "reynolds",
     .keys = film_keys,
     .most_knudsen = 0.1,
     .most_squeeze = 1000,
     .make = [](const Film& f) -> GasLaw {
       return SlipFilm{.viscosity = f.viscosity, .mean_free_path = f.mean_free_path, .width = f.structure.width};
     }},
    {.value = GasModel::linear,
     .name = "linear",
     .keys = {"damping", "quality_factor"},
     .make = [](const Film& f) -> GasLaw {
       return LinearDamper{.damping = std::isnan(f.gas.damping) ? f.unit_quality / f.gas.quality_factor : f.gas.damping};
     }},
});
static_assert(is_complete<gas_laws>());

/// Damping of a rectangular film over that of a strip of the same length, whose ends would be closed; `ratio` is width over
/// length.
///   1 - (192 / pi^5) ratio sum over odd n of tanh(n pi / (2 ratio)) / n^5
/// 1 - 0.63 ratio for long films, 0.4217 for a square one. Poisson's equation of the incompressible film on a rectangle (Griffin,
/// Richardson & Yamanami, J. Basic Eng. 88 (1966) 451; the series is that of torsion of a rectangular bar).
[[nodiscard]] double end_flow(double ratio);

/// The gas under another law: without what only laws of other kinds are given, so that a film whose ends are open stays with the
/// laws that can have one.
[[nodiscard]] Gas under_law(Gas gas, GasModel law);

/// Of the compressible film its incompressible limit.
[[nodiscard]] GasLaw gas_law(const Gas& gas, const Structure& structure, double unit_quality);

/// c in f = -c v [N s/m^2] at this gap [m].
[[nodiscard]] inline double damping_per_length(const GasLaw& law, double gap) {
  return std::visit([&](const auto& l) { return -l.load(gap, 1.0); }, law);
}

/// 12 mu a^2 rate / (p h^2), with the rate [1/s] at which the gap h [m] changes.
[[nodiscard]] double squeeze_number(const Gas& gas, double width, double gap, double rate);

/// At the contact point, with the rate |v| / h; 0 where the device's law has no limit for it.
[[nodiscard]] double squeeze_number(const Device& device, const TrajectoryPoint& point);

/// One line per limit of the gas law that a closing left, with law, limit and value. Knudsen numbers are taken between the rest
/// gap and the smallest gap anywhere [m].
[[nodiscard]] std::vector<std::string> gas_warnings(const Device& device, double smallest_gap, double largest_squeeze);

}  // namespace softland
