// What a user says about a file of modes that the file does not.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace softland {

/// Numbers are NaN-free: what is not said is not there.
struct ModeKeys {
  std::string axis = {};                   ///< "x", "-y": from the clamp to the far end; empty: of a table only
  std::string direction = {};              ///< "-z": of motion, towards the near electrode; empty: of a table only
  std::optional<double> length_unit = {};  ///< of the file's positions [m]
  std::optional<double> mass_unit = {};    ///< of the mass in which the file's modes are normalised [kg]
  std::optional<double> mass = {};         ///< of the structure, even along its axis: normalises modes that are not [kg]
  bool mass_normalised = false;            ///< the modes of the file are, though it does not say so
  std::optional<double> clamp = {};        ///< where the clamp is on the axis of the file, if there is no node [m]
  std::vector<double> frequencies = {};    ///< of the modes of a file that does not hold them [Hz]

  // How a message names a key, such as "structure.mass" or "--mass".
  std::string prefix = {};    ///< "structure.", "--"
  char word_separator = '_';  ///< of their words: '_' or '-'
  /// The name of a key in a message.
  [[nodiscard]] std::string name(std::string key) const {
    for (char& c : key) {
      if (c == '_') c = word_separator;
    }
    return prefix + key;
  }
};

}  // namespace softland
