// What a waveform family is called and what its parameters are: a scene reads, checks and writes a waveform by these tables.
#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "base/require.h"  // InvalidParameter

namespace softland {

/// What a parameter is of the signal: this decides its unit, and how a scene may give it.
enum class ParameterKind {
  level,              ///< [V]
  swing,              ///< [V] about a level; a scene may give a percentage of that level
  time,               ///< [s]
  end_time,           ///< [s], after 0; absent from a scene: never
  angular_frequency,  ///< [rad/s]; a scene may give the frequency instead
  angle,              ///< [rad]
  ratio,              ///< of two quantities of the signal, above 0; 1 where a scene says nothing
};

/// One parameter of a family: a number, or several levels, swings or times. One that is not required has the family's default.
template <class Family>
struct Parameter {
  std::string_view name;
  ParameterKind kind;
  std::variant<double Family::*, std::vector<double> Family::*> member;
  bool required = false;
  std::string_view about = {};
};

/// Specialised beside each family, with its `name`, its `parameters` and an `example`, which tests of all families take;
/// `from_file` where the rows may stand in a file.
template <class Family>
struct FamilyOf;

}  // namespace softland
