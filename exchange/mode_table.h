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

/// One mode of a file and its kind. Motions are means over the nodes of a section, in the unit of the file.
struct ModeFound {
  int number = 0;        ///< number in the file, from 1
  double frequency = 0;  ///< [Hz]
  ModeKind kind = ModeKind::bending;
  double share = 0;  ///< share of the mode's kind in the squared motion of all nodes; 1 if the file holds one direction only
  std::vector<double> along, across, axial;  ///< motion by section in the direction of motion, the third direction, the axis
  std::vector<double> twist;                 ///< motion by rotation about the axis, half the extent of the mesh from its middle
  /// Returns the name of the mode's kind, such as "bending" or "in-plane".
  [[nodiscard]] std::string name() const;
};

struct ModeTable {
  std::string file;
  std::string format;
  std::vector<double> positions;            ///< [m], from 0, the clamp, rising
  std::vector<double> widths;               ///< width by position [m]; NaN where the file does not give it
  std::vector<double> rest_offsets;         ///< height of the face, towards the direction of motion, at rest [m], by position
  std::vector<double> frequencies;          ///< [Hz], rising
  std::vector<std::vector<double>> shapes;  ///< mass-normalised [kg^(-1/2)]: of each mode by position, positive at the far end
  SplineEnd far_end = SplineEnd::free;      ///< clamped if the far end does not move in any mode, and mode_1 has no slope there

  std::size_t nodes = 0;            ///< number of nodes of the mesh; 0 for a table
  std::vector<ModeFound> found;     ///< every mode of a mesh, used or not; empty for a table
  std::vector<double> places = {};  ///< places of the sections of `found`, from the clamp [m]
  std::vector<std::string> left_out = {};
  std::vector<std::string> notes = {};  ///< assumptions about facts that the file does not contain
};

/// Reads a file. Throws InvalidInput with file, line and rule for an unreadable file, for a file without modes (a static
/// result, a pressure), and for an ambiguous file, with the key that decides.
[[nodiscard]] ModeTable read_mode_table(const std::string& file, const ModeKeys& keys);
/// Reads the content of a file; `file` names it in messages.
[[nodiscard]] ModeTable parse_mode_table(std::string_view content, const std::string& file, const ModeKeys& keys);

/// Returns one line with format, nodes, sections, length, modes, frequencies, and what was left out.
[[nodiscard]] std::string summary(const ModeTable& table);

}  // namespace softland
