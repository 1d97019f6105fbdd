// The facts about a file of modes that the user supplies because the file lacks them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace softland {

/// Members that are not given are empty, 0 or none; no number is NaN.
struct ModeKeys {
  std::string axis = {};       ///< axis from the clamp to the far end, "x" or "-y"; empty for a table of softland only
  std::string direction = {};  ///< direction of motion towards the near electrode, "-z"; empty for a table of softland only
  std::optional<double> length_unit = {};  ///< unit of the file's positions [m]
  std::optional<double> mass_unit = {};    ///< unit of mass in which the file's modes are normalised [kg]
  std::optional<double> mass =
      {};  ///< mass of a structure of constant mass per length; normalises modes that are not mass-normalised [kg]
  bool mass_normalised = false;          ///< true if the modes of the file are mass-normalised, although the file does not say so
  std::optional<double> clamp = {};      ///< position of the clamp on the axis of the file, if there is no node at the clamp [m]
  std::vector<double> frequencies = {};  ///< frequencies of the modes of a file that does not hold them [Hz]

  // The following members form the names of keys in messages, such as "structure.mass" or "--mass".
  std::string prefix = {};    ///< "structure.", "--"
  char word_separator = '_';  ///< separator of the words of a name: '_' or '-'
  /// Returns the name of a key for a message.
  [[nodiscard]] std::string name(std::string key) const {
    for (char& c : key) {
      if (c == '_') c = word_separator;
    }
    return prefix + key;
  }
};

}  // namespace softland
