// What a beam may be built of: sections one after the other along it, layers on its faces, and ends that give way. Plain numbers;
// what they make of the beam is in model/built_beam.h.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "base/field.h"
#include "model/place.h"

namespace softland {

/// Square holes in a square pattern, their sides along and across the beam; what is not given: none.
struct Holes {
  double pitch = not_given;  ///< from centre to centre [m]
  double size = not_given;   ///< side of a hole [m]

  [[nodiscard]] bool exist() const { return size > 0; }
};

/// One stretch of a beam. A number that is not given is that of the structure.
struct SectionPart {
  double length = 0;                  ///< along the beam [m]
  double width = not_given;           ///< where it begins [m]
  double end_width = not_given;       ///< where it ends, linear in between; not given: as where it begins [m]
  double thickness = not_given;       ///< [m]
  double youngs_modulus = not_given;  ///< [Pa]
  double density = not_given;         ///< [kg/m^3]
  Holes holes = {};
};

/// A layer on one face of the beam, as wide as the beam. Of several on a face at one place the later one lies outside.
struct LayerPart {
  Side face = Side::far;              ///< near or far
  Place begin, end;                   ///< along the beam
  double thickness = 0;               ///< [m]
  double youngs_modulus = 0;          ///< [Pa]
  double density = 0;                 ///< [kg/m^3]
  double stress = 0;                  ///< along the beam before its release, positive in tension [Pa]
  double poissons_ratio = not_given;  ///< needed by plate_strain
};

/// How a released beam rests, as a table: straight lines between heights at places along it.
struct RestShape {
  std::vector<Place> positions;  ///< rise from 0 to the far end
  std::vector<double> heights;   ///< over the straight shape, away from the near electrode, one per position [m]

  /// The positions on a beam of this length [m].
  [[nodiscard]] std::vector<double> places(double length) const;
  /// The height at x [m]; the last line goes on beyond the last position.
  [[nodiscard]] double height(double x, double length) const;
  /// The least height of a beam of this length [m].
  [[nodiscard]] double lowest(double length) const;
};

/// How an end is held in the direction of motion: stiffnesses, infinite where it is rigid.
struct Anchor {
  static constexpr double rigid = std::numeric_limits<double>::infinity();
  double rotation = rigid;     ///< moment per turn [N m/rad]
  double translation = rigid;  ///< force per deflection [N/m]

  [[nodiscard]] bool is_clamp() const { return std::isinf(rotation) && std::isinf(translation); }
  [[nodiscard]] bool is_free() const { return rotation == 0 && translation == 0; }
};
inline constexpr Anchor free_end{.rotation = 0, .translation = 0};

}  // namespace softland
