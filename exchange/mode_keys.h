// The facts about a file of modes that the user supplies because the file lacks them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace softland {

/// Numbers are NaN-free: what is not said is not there.
struct ModeKeys {
  std::string axis = {};                   ///< "x", "-y": from the clamp to the far end; empty: of a table only
  std::string direction = {};              ///< "-z": direction of motion, towards the near electrode; empty for a table only
  std::optional<double> length_unit = {};  ///< unit of the file's positions [m]
  std::optional<double> mass_unit = {};    ///< unit of mass in which the file's modes are normalised [kg]
  std::optional<double> mass = {};         ///< mass of the structure, even along its axis: normalises modes that are not [kg]
  bool mass_normalised = false;            ///< true if the modes of the file are normalised, though it does not say so
  std::optional<double> clamp = {};        ///< place of the clamp on the axis of the file, if there is no node [m]
  std::vector<double> frequencies = {};    ///< frequencies of the modes of a file that does not hold them [Hz]

  // The name of a key in a message, such as "structure.mass" or "--mass".
  std::string prefix = {};    ///< "structure.", "--"
  char word_separator = '_';  ///< separator of their words: '_' or '-'
  /// The name of a key in a message.
  [[nodiscard]] std::string name(std::string key) const {
    for (char& c : key) {
      if (c == '_') c = word_separator;
    }
    return prefix + key;
  }
};

}  // namespace softland
