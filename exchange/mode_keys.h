// The facts about a file of vibration modes that the user supplies because the file lacks them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace softland {

/// Facts that the user supplies about a file of vibration modes. Members that are not given are empty, 0 or none; no number is
/// NaN.
struct ModeKeys {
  /// Axis of the structure from the clamp to the far end, "x" or "-y"; may be empty for a table of softland.
  std::string axis = {};
  std::string direction = {};  ///< direction of motion towards the near electrode, "-z"; may be empty for a table of softland
  std::optional<double> length_unit = {};  ///< unit of the file's positions [m]
  std::optional<double> mass_unit = {};    ///< unit of mass in which the file's modes are normalised [kg]
  std::optional<double> mass =
      {};  ///< mass of a structure of constant mass per length [kg]; normalises the modes if the file has no modal masses
  bool mass_normalised = false;          ///< true if the modes of the file are mass-normalised, although the file does not say so
  std::optional<double> clamp = {};      ///< position of the clamp on the axis of the file, if there is no node at the clamp [m]
  std::vector<double> frequencies = {};  ///< frequencies of the modes of a file that does not hold them [Hz]

  // How messages write the names of keys: as in a scene ("structure.mass") or as options ("--mass").
  std::string prefix = {};    ///< beginning of the keys' names in messages: "structure.", "--"
  char word_separator = '_';  ///< separator of the words of a key's name: '_' or '-'
  /// Returns the full name of a key for a message, such as "structure.mass_unit".
  [[nodiscard]] std::string name(std::string key) const {
    for (char& c : key) {
      if (c == '_') c = word_separator;
    }
    return prefix + key;
  }
};

}  // namespace softland
