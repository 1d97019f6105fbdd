// Divides the mesh of a structure into cross-sections along its axis, and finds their motion in each mode. Internal to
// exchange/.
//
// All nodes at one place along the axis form a section, whose motion is the mean of its nodes. If most places have fewer than
// three nodes, as in meshes of tetrahedra, the mesh is called irregular. The motion on the axis is then fitted at evenly spaced
// places from the nodes nearby (exchange/local_fit.h).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exchange/layout.h"
#include "exchange/nodal_modes.h"

namespace softland::internal {

/// A direction in the coordinates of a mesh file: 0, 1 or 2 for x, y or z, with a sign.
struct Way {
  std::size_t direction = 0;
  double sign = 1;
};

/// Motion of the sections of a mesh in one mode, in the unit of the mode. The squared motion of all nodes is divided into
/// bending, in-plane, axial and torsional motion.
struct SectionMotion {
  /// Mean displacement of each section: in the switch's direction of motion, in-plane across the axis, and along the axis.
  std::vector<double> along, across, axial;
  /// Displacement of each section by its rotation about the axis, at a distance of half the extent of the mesh.
  std::vector<double> twist;
  double bending = 0, in_plane = 0, axial_share = 0, torsion = 0;
  [[nodiscard]] double all() const { return bending + in_plane + axial_share + torsion; }
};

class MeshSections {
 public:
  /// Sorts the nodes of a mesh into sections. The direction `axis` points from the clamp to the far end, `direction` is that of
  /// the switch's motion. The nodes have the unit `length_unit` [m]. `clamp` [m] is the position of the clamp on the axis;
  /// none: the clamp is at the first node. Throws InvalidInput for nodes at fewer than three places along the axis, including
  /// the clamp, and for an irregular mesh with too few nodes to find the motion at some place.
  MeshSections(const std::vector<Vector3>& nodes, Way axis, Way direction, double length_unit, std::optional<double> clamp,
               const Refusals& refusals);

  [[nodiscard]] std::vector<double> places() const;      ///< distances of the sections from the clamp [m]
  [[nodiscard]] double first() const { return first_; }  ///< position of the first node on the axis [m]
  [[nodiscard]] bool is_irregular() const { return step_ > 0; }
  [[nodiscard]] std::vector<double> widths()
      const;  ///< width of each section, in-plane across the axis [m]; NaN if the mesh has no width there
  [[nodiscard]] std::vector<double> offsets()
      const;  ///< offset of each section's face in the direction of motion from that of the first section [m]
  [[nodiscard]] SectionMotion motion(const NodalMode& mode) const;

 private:
  struct Section {
    double place = 0;  ///< distance of the section from the clamp [m]
    std::vector<std::size_t> nodes;
  };
  [[nodiscard]] double along_axis(const Vector3& v) const;  ///< component of a position along the axis [m]
  [[nodiscard]] double across_of(const Vector3& v) const { return v[3 - axis_.direction - direction_.direction]; }
  void gather();
  [[nodiscard]] bool lacks_sections() const;
  void divide_evenly();
  void measure_extent();
  void add_motion(const Section& section, const NodalMode& mode, SectionMotion& motion) const;
  [[nodiscard]] double twist(const Section& section, const NodalMode& mode, const Vector3& mean) const;
  [[nodiscard]] double fitted(std::size_t place, const NodalMode& mode) const;
  [[nodiscard]] bool stands_still_at_first(const NodalMode& mode) const;

  const std::vector<Vector3>& nodes_;
  Way axis_, direction_;
  double length_unit_;  // length unit of the mesh file [m]
  const Refusals& refusals_;
  std::vector<Section> sections_;
  double first_ = 0, clamp_ = 0;  // positions of the first node and of the clamp on the axis [m]
  double step_ = 0;               // spacing of the fitted places of an irregular mesh [m]; 0 for a mesh with sections
  Vector3 middle_{};              // middle of the mesh, in the length unit of the file
  double extent_ = 0;             // larger extent of the mesh across the axis, in the length unit of the file; 0 for a line
};

}  // namespace softland::internal
