// Reads modes that another program computed, and makes a table of mode shapes along the axis of a structure.
//
// The reader takes tables of softland (CSV), results of *FREQUENCY of CalculiX (.frd) and exports of COMSOL as text and CSV. It
// takes data sets 55 of the Universal File Format with the node positions (15, 2411), and reduced-order models of ANSYS (.rom).
// All nodes at one place along the axis form a section, whose motion is the mean of its nodes. Only modes that bend along the
// direction of motion are used; in-plane, axial and torsional modes are listed as left out. Nothing is assumed without a note:
// the user supplies what a file lacks (units, mass), or the error names the key to give.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/clamped_spline.h"
#include "exchange/mode_keys.h"

namespace softland {

enum class ModeKind { bending, in_plane, axial, torsional, unused };

/// One mode of a file, its kind, and its motion by cross-sections of the mesh, in the length unit of the file.
struct ModeFound {
  int number = 0;        ///< number of the mode in the file, from 1
  double frequency = 0;  ///< frequency of the mode [Hz]
  ModeKind kind = ModeKind::bending;
  double share = 0;  ///< squared motion of this kind over the whole squared motion; 1 if a file has only one component
  /// Mean displacement of each section: in the switch's direction of motion, in-plane across the axis, and along the axis.
  std::vector<double> along, across, axial;
  /// Displacement of each section by its rotation about the axis, at a distance of half the extent of the mesh.
  std::vector<double> twist;
  /// Returns the name of the mode's kind, such as "bending" or "in-plane".
  [[nodiscard]] std::string name() const;
};

struct ModeTable {
  std::string file;
  std::string format;
  std::vector<double> positions;  ///< positions along the axis, rising from the clamp at 0 [m]
  std::vector<double> widths;     ///< width of the structure at each position [m]; NaN where the file does not give it
  /// Height of the structure's face at each position, towards the direction of motion, at rest [m].
  std::vector<double> rest_offsets;
  std::vector<double> frequencies;  ///< frequencies of the modes, rising [Hz]
  /// Mass-normalised shape of each mode at each position, positive at the far end [kg^(-1/2)].
  std::vector<std::vector<double>> shapes;
  /// End condition at the far end: clamped if the far end moves in no mode, and the first shape has no slope there.
  SplineEnd far_end = SplineEnd::free;

  std::size_t nodes = 0;            ///< number of nodes of the mesh; 0 for a table of modes
  std::vector<ModeFound> found;     ///< every mode of a mesh file, used or not; empty for a table of modes
  std::vector<double> places = {};  ///< distances of the mesh sections in `found` from the clamp [m]
  std::vector<std::string> left_out = {};
  std::vector<std::string> notes = {};  ///< assumptions about facts that the file does not contain
};

/// Reads a file of vibration modes. Throws InvalidInput with file, line and rule for an unreadable file, for a file without
/// modes (such as a static result), and for an ambiguous file; the message then names the key that the user must give.
[[nodiscard]] ModeTable read_mode_table(const std::string& file, const ModeKeys& keys);
/// Reads the content of a file of vibration modes; `file` is the name of the file in messages.
[[nodiscard]] ModeTable parse_mode_table(std::string_view content, const std::string& file, const ModeKeys& keys);

/// Returns one line about a file of modes: format, nodes, sections, length, modes, frequencies, and what was left out.
[[nodiscard]] std::string summary(const ModeTable& table);

}  // namespace softland
