// Modes as a finite-element program writes them: motions of the nodes of a mesh. Internal to exchange/.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/mode_keys.h"

namespace softland::internal {

using Vector3 = std::array<double, 3>;
inline constexpr Vector3 no_motion{0, 0, 0};

struct NodalMode {
  /// Frequency of the mode [Hz]; NaN if the file does not give it.
  double frequency = std::numeric_limits<double>::quiet_NaN();
  double modal_mass =
      std::numeric_limits<double>::quiet_NaN();  ///< modal mass in the unit of the file; NaN if the file does not give it
  std::vector<Vector3> motion;                   ///< displacement of each node in the mode, at the scale of `modal_mass`
  std::string name;                              ///< name of the mode in messages, such as "mode 1"
  bool is_used = true;                           ///< false for a mode that the reduced-order model in the file leaves out
};

struct NodalModes {
  std::string format;
  std::vector<Vector3> nodes;    ///< positions of the nodes in the length unit of the file; NaN where it lacks a coordinate
  std::vector<NodalMode> modes;  ///< modes in the order of the file
  std::array<bool, 3> holds{true, true, true};  ///< true if the file has the x, y or z component of the displacements
  std::optional<double> length_unit = {};       ///< unit of length of the node positions that the file names [m]
  bool needs_length_unit = false;               ///< true if the format has no usual unit of length, so that the user must give it
  std::string normalised_by = {};  ///< data of the file that give the modal masses, in words; empty without such data
  std::vector<std::string> left_out = {}, notes = {};
};

// Two functions for each file format of vibration modes: one recognises a text of this format, the other reads it. Reading
// throws InvalidInput with file, line and rule.
[[nodiscard]] bool is_frd(std::string_view text);
[[nodiscard]] NodalModes read_frd(std::string_view text, const std::string& file);

[[nodiscard]] bool is_comsol(std::string_view text);
[[nodiscard]] NodalModes read_comsol(std::string_view text, const std::string& file);

[[nodiscard]] NodalModes read_uff55(std::string_view content, const std::string& file);

[[nodiscard]] bool is_ansys_rom(std::string_view text);
[[nodiscard]] NodalModes read_ansys_rom(std::string_view text, const std::string& file);

}  // namespace softland::internal
