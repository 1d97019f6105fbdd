// Names of a waveform family and of its parameters: a scene reads, checks and writes a waveform by these tables.
#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "base/require.h"  // InvalidParameter

namespace softland {

/// The role of a parameter in the signal. The role decides the unit, and how a scene may give the parameter.
enum class ParameterKind {
  level,              ///< [V]
  swing,              ///< [V] about a level; a scene may give a percentage of that level
  time,               ///< [s]
  end_time,           ///< [s], after 0; without this key in a scene there is no end
  angular_frequency,  ///< [rad/s]; a scene may give the frequency instead
  angle,              ///< [rad]
  ratio,              ///< ratio of two quantities of the signal, above 0; default 1
};

/// One parameter of a waveform family: a number, or several levels, swings or times. A parameter that is not required has a
/// default.
template <class Family>
struct Parameter {
  std::string_view name;
  ParameterKind kind;
  std::variant<double Family::*, std::vector<double> Family::*> member;
  bool required = false;
  std::string_view about = {};
};

/// Traits of a waveform family, specialised in its header: its `name`, its `parameters`, and an `example` for the tests of all
/// families; `from_file` when a file may hold its rows.
template <class Family>
struct FamilyOf;

}  // namespace softland
