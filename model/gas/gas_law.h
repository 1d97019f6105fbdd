// The gas laws as one value, and the limits of each.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

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

/// Name in a scene, and where the law holds.
struct GasModelEntry {
  GasModel model;
  std::string_view name;
  double least_knudsen = 0;
  double most_knudsen = std::numeric_limits<double>::infinity();
  double most_squeeze = std::numeric_limits<double>::infinity();  ///< 12 mu a^2 omega / (p h^2)
};

inline constexpr double incompressible = 10;  ///< squeeze number up to which a strip film is; the strip's cut-off is pi^2

inline constexpr std::array gas_models{
    GasModelEntry{.model = GasModel::strip, .name = "strip", .most_knudsen = 0.1, .most_squeeze = incompressible},
    GasModelEntry{.model = GasModel::strip_slit, .name = "strip-slit", .most_knudsen = 0.1, .most_squeeze = incompressible},
    GasModelEntry{.model = GasModel::veijola, .name = "veijola", .most_knudsen = 880, .most_squeeze = incompressible},
    GasModelEntry{.model = GasModel::gallis_torczynski, .name = "gallis-torczynski", .most_squeeze = incompressible},
    GasModelEntry{.model = GasModel::near_contact,
                  .name = "near-contact",
                  .least_knudsen = 1 / NearContactFilm::rarefied,
                  .most_squeeze = incompressible},
    GasModelEntry{.model = GasModel::guo_alexeenko, .name = "guo-alexeenko"},
    GasModelEntry{.model = GasModel::reynolds, .name = "reynolds", .most_knudsen = 0.1, .most_squeeze = 1000},
    GasModelEntry{.model = GasModel::linear, .name = "linear"}};

[[nodiscard]] const GasModelEntry& entry(GasModel model);

/// Damping of a rectangular film over that of a strip of the same length, whose ends would be closed; `ratio` is width over
/// length.
///   1 - (192 / pi^5) ratio sum over odd n of tanh(n pi / (2 ratio)) / n^5
/// 1 - 0.63 ratio for long films, 0.4217 for a square one. Poisson's equation of the incompressible film on a rectangle (Griffin,
/// Richardson & Yamanami, J. Basic Eng. 88 (1966) 451; the series is that of torsion of a rectangular bar).
[[nodiscard]] double end_flow(double ratio);

/// Of the compressible film its incompressible limit. `damping_of_unit_quality` is the damping per length that gives the first
/// mode a quality factor of one [N s/m^2].
[[nodiscard]] GasLaw gas_law(const Gas& gas, const Structure& structure, double damping_of_unit_quality);

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
