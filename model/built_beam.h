// Local size of a beam of sections and layers (model/structure/beam_parts.h), and the rules for sections and layers.
//
// The lower faces of all sections and layers lie in one plane before release, as on a flat sacrificial layer: gaps count from
// this plane. A section's width is constant or linear, so rigidity, mass and moments of a section grow in proportion to the
// width.
//
// Square holes of side s in a square pattern of pitch p leave the share 1 - (s/p)^2 of the area; mass and electrode area fall
// by this factor. The stiffness falls by the ligament efficiency
//
//   k = (k_low + k_high) / 2,   k_low = 1 - r,   k_high = (1 - r) / (1 - r + r^2),   r = s/p
//
// k_low and k_high are bounds of the true stiffness. k_low: stress in continuous strips beside the holes alone, 1 - r of the
// width, is in equilibrium (principle of least complementary energy). k_high: plane cross-sections stay plane. Their width is
// whole between two rows of holes and 1 - r of it in a row, and both pieces act in series (principle of least energy). The half
// distance of the bounds is 9 % of k at r = 0.2, and 14 % at r = 0.5, where it is largest. Derived here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/device.h"

namespace softland {

/// One part of a structure with linear width and constant other properties.
struct LocalSection {
  double begin = 0, end = 0;        ///< begin and end of the part along the structure [m]
  double width = 0, end_width = 0;  ///< width across the structure at begin and end of the part, not reduced by holes [m]
  double thickness = 0;             ///< thickness of the part [m]
  double youngs_modulus = not_given, density = not_given;  ///< Young's modulus [Pa] and density [kg/m^3] of a beam's part
  Holes holes = {};

  [[nodiscard]] double width_at(double x) const {
    return end_width == width ? width : width + (end_width - width) * (x - begin) / (end - begin);
  }
  [[nodiscard]] bool is_even() const { return end_width == width; }
};

/// Returns the share of a structure's area that remains beside the holes.
[[nodiscard]] double area_left(const Holes& holes);
/// Returns the ligament efficiency k, the share of the stiffness along the beam that remains beside the holes.
[[nodiscard]] double ligament_efficiency(const Holes& holes);

/// Returns the parts of a structure from end to end, each with linear width. A structure is a single part unless it is a beam
/// with sections, or is given by a table of modes with widths.
[[nodiscard]] std::vector<LocalSection> local_sections(const Structure& structure);
/// Returns the part of the structure at x, with its width and thickness; where two parts meet, the part further from the clamp.
[[nodiscard]] LocalSection section_at(const Structure& structure, double x);
/// Returns the width across the structure at x, not reduced by holes [m].
[[nodiscard]] double width_at(const Structure& structure, double x);
/// Returns the edges of sections and layers of a beam, from 0 to its length [m]; for all other structures 0 and the length.
[[nodiscard]] std::vector<double> edges_of_parts(const Structure& structure);

/// Returns the positions of kinks in a beam's rest shape, the inner points of its table [m]; empty without a table.
[[nodiscard]] std::vector<double> kinks_at_rest(const Structure& structure);

/// A section, layer or hole pattern that a device cannot have, and the reason.
struct PartConflict {
  std::string key;  ///< key of the conflicting part: "layers[2].span"
  std::string rule;
};
/// Returns a conflict of the sections, layers and holes of a device; none when the beam can be built.
[[nodiscard]] std::optional<PartConflict> part_conflict(const Device& device);

}  // namespace softland
