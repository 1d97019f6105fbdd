// The parts of a beam: sections one after the other along the beam, layers on its faces, and compliant ends. They are plain
// numbers; model/built_beam.h computes their effect on the beam.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "base/field.h"
#include "model/place.h"

namespace softland {

/// Square holes in a square pattern, their sides along and across the beam; no holes when the numbers are not given.
struct Holes {
  double pitch = not_given;  ///< distance between the centres of neighbouring holes [m]
  double size = not_given;   ///< side of a square hole [m]

  [[nodiscard]] bool exist() const { return size > 0; }
};

/// One section of a beam with sections of different size. A number that is not given is that of the whole beam.
struct SectionPart {
  double length = 0;                  ///< length of the section along the beam [m]
  double width = not_given;           ///< width of the beam at the section's start [m]
  double end_width = not_given;       ///< width of the beam at the section's end, linear in between; by default `width` [m]
  double thickness = not_given;       ///< thickness of the section [m]
  double youngs_modulus = not_given;  ///< Young's modulus of the section [Pa]
  double density = not_given;         ///< density of the section [kg/m^3]
  Holes holes = {};
};

/// A layer on one face of the beam, as wide as the beam. Of several layers on the same part of a face, the first is next to the
/// beam.
struct LayerPart {
  Side face = Side::far;              ///< face of the beam that carries the layer, near or far from the electrode
  Place begin, end;                   ///< begin and end of the layer along the beam
  double thickness = 0;               ///< thickness of the layer [m]
  double youngs_modulus = 0;          ///< Young's modulus of the layer [Pa]
  double density = 0;                 ///< density of the layer [kg/m^3]
  double stress = 0;                  ///< stress in the layer along the beam before release, positive in tension [Pa]
  double poissons_ratio = not_given;  ///< Poisson's ratio of the layer; needed with plate_strain
};

/// The shape of a released beam at rest, as a table of heights at positions along the beam; straight lines connect them.
struct RestShape {
  std::vector<Place> positions;  ///< positions along the beam, rising from 0 to the far end
  /// Height of the beam above its straight shape at each position, positive away from the near electrode [m].
  std::vector<double> heights;

  /// Returns the positions of the table on a beam of this length [m].
  [[nodiscard]] std::vector<double> places(double length) const;
  /// Returns the height of the beam at rest above its straight shape, at the position x [m]; beyond the last position of the
  /// table its last straight line continues.
  [[nodiscard]] double height(double x, double length) const;
  /// Returns the least height of a beam of this length at rest above its straight shape [m].
  [[nodiscard]] double lowest(double length) const;
};

/// Stiffnesses of the anchor at an end of a beam; infinite in a direction in which the end is rigid.
struct Anchor {
  static constexpr double rigid = std::numeric_limits<double>::infinity();
  double rotation = rigid;     ///< moment of the anchor per rotation of the beam's end [N m/rad]
  double translation = rigid;  ///< force of the anchor per deflection of the beam's end [N/m]

  [[nodiscard]] bool is_clamp() const { return std::isinf(rotation) && std::isinf(translation); }
  [[nodiscard]] bool is_free() const { return rotation == 0 && translation == 0; }
};
inline constexpr Anchor free_end{.rotation = 0, .translation = 0};

}  // namespace softland
