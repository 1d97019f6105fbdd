// The parts of a beam: sections one after the other along it, layers on its faces, and compliant ends. They are plain numbers;
// model/built_beam.h computes their effect on the beam.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "base/field.h"
#include "model/place.h"

namespace softland {

/// Square holes in a square pattern, their sides along and across the beam; no holes when the numbers are not given.
struct Holes {
  double pitch = not_given;  ///< distance from centre to centre [m]
  double size = not_given;   ///< side of a hole [m]

  [[nodiscard]] bool exist() const { return size > 0; }
};

/// One section of a beam. A number that is not given is that of the structure.
struct SectionPart {
  double length = 0;                  ///< length along the beam [m]
  double width = not_given;           ///< width at the section's start [m]
  double end_width = not_given;       ///< width at the section's end, linear in between; by default `width` [m]
  double thickness = not_given;       ///< [m]
  double youngs_modulus = not_given;  ///< [Pa]
  double density = not_given;         ///< [kg/m^3]
  Holes holes = {};
};

/// A layer on one face of the beam, as wide as the beam. When several layers cover the same place of a face, later layers lie
/// outside.
struct LayerPart {
  Side face = Side::far;              ///< near or far
  Place begin, end;                   ///< interval along the beam
  double thickness = 0;               ///< [m]
  double youngs_modulus = 0;          ///< [Pa]
  double density = 0;                 ///< [kg/m^3]
  double stress = 0;                  ///< stress along the beam before its release, positive in tension [Pa]
  double poissons_ratio = not_given;  ///< needed with plate_strain
};

/// The rest shape of a released beam as a table: straight lines between heights at places along the beam.
struct RestShape {
  std::vector<Place> positions;  ///< positions, rising from 0 to the far end
  std::vector<double> heights;   ///< heights over the straight shape, away from the near electrode, one per position [m]

  /// Returns the positions on a beam of this length [m].
  [[nodiscard]] std::vector<double> places(double length) const;
  /// Returns the height at x [m]; beyond the last position the last line continues.
  [[nodiscard]] double height(double x, double length) const;
  /// Returns the least height of a beam of this length [m].
  [[nodiscard]] double lowest(double length) const;
};

/// Stiffnesses of the support at an end of a beam; infinite in a direction in which the end is rigid.
struct Anchor {
  static constexpr double rigid = std::numeric_limits<double>::infinity();
  double rotation = rigid;     ///< moment per rotation [N m/rad]
  double translation = rigid;  ///< force per deflection [N/m]

  [[nodiscard]] bool is_clamp() const { return std::isinf(rotation) && std::isinf(translation); }
  [[nodiscard]] bool is_free() const { return rotation == 0 && translation == 0; }
};
inline constexpr Anchor free_end{.rotation = 0, .translation = 0};

}  // namespace softland
