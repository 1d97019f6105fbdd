// Local size of a beam of sections and layers (model/structure/beam_parts.h), and the rules for these parts.
//
// The lower faces of all sections and layers lie in one plane before release, as on a flat sacrificial layer: gaps count from
// that plane. A section's width is constant or linear, so that rigidity, mass and moments of a stretch grow in proportion to
// the width.
//
// Square holes of side s in a square pattern of pitch p leave the share 1 - (s/p)^2 of the area; mass and electrode area fall
// by this factor. The stiffness falls by the ligament efficiency
//
//   k = (k_low + k_high) / 2,   k_low = 1 - r,   k_high = (1 - r) / (1 - r + r^2),   r = s/p
//
// k_low and k_high are bounds. k_low: stress in the ligaments alone, 1 - r of the width, is in equilibrium (least complementary
// energy). k_high: sections that stay plane, full between the holes and 1 - r of the width beside them, in series, are possible
// displacements (least energy). The half distance of the bounds is 9 % of k at r = 0.2, and 14 % at r = 0.5, where it is
// largest. Derived here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/device.h"

namespace softland {

/// One stretch of a structure with linear width and constant other properties.
struct LocalSection {
  double begin = 0, end = 0;                               ///< [m]
  double width = 0, end_width = 0;                         ///< width across the beam at both ends, with its holes [m]
  double thickness = 0;                                    ///< [m]
  double youngs_modulus = not_given, density = not_given;  ///< Young's modulus and density of a beam [Pa], [kg/m^3]
  Holes holes = {};

  [[nodiscard]] double width_at(double x) const {
    return end_width == width ? width : width + (end_width - width) * (x - begin) / (end - begin);
  }
  [[nodiscard]] bool is_even() const { return end_width == width; }
};

/// Returns the share of the area that holes leave.
[[nodiscard]] double area_left(const Holes& holes);
/// Returns the ligament efficiency k, the share of the stiffness along the beam that holes leave.
[[nodiscard]] double ligament_efficiency(const Holes& holes);

/// Returns the stretches of a structure from end to end: a single one unless it has sections, or is a table of modes with
/// widths.
[[nodiscard]] std::vector<LocalSection> local_sections(const Structure& structure);
/// Returns the stretch at this place; where two stretches meet, the one further from the clamp.
[[nodiscard]] LocalSection section_at(const Structure& structure, double x);
/// Returns the width across the structure at this place, with its holes [m].
[[nodiscard]] double width_at(const Structure& structure, double x);
/// Returns the edges of sections and layers of a beam, from 0 to its length [m]; for all other structures 0 and the length.
[[nodiscard]] std::vector<double> edges_of_parts(const Structure& structure);

/// Returns the places where the table of a beam's rest shape has kinks, between its ends [m]; empty without such a table.
[[nodiscard]] std::vector<double> kinks_at_rest(const Structure& structure);

/// A section, layer or hole pattern that a device cannot have, and the reason.
struct PartConflict {
  std::string key;  ///< key of the part: "layers[2].span"
  std::string rule;
};
/// Returns a conflict of the parts of a device; none when the beam can be built.
[[nodiscard]] std::optional<PartConflict> part_conflict(const Device& device);

}  // namespace softland
