// Tables of the waveform families: name of a family, such as "pulse", and names and kinds of its parameters. With these tables
// scene files are read, checked and written.
#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "base/require.h"  // declares InvalidParameter

namespace softland {

/// The kind of quantity that a waveform parameter is. It determines the unit, and the forms in which a scene may give the
/// value.
enum class ParameterKind {
  level,              ///< the parameter is a voltage level [V]
  swing,              ///< a voltage difference from a level [V]; a scene may give a percentage of the level
  time,               ///< the parameter is a time or duration [s]
  end_time,           ///< end of a part of the waveform [s], > 0; a scene without this key has no end
  angular_frequency,  ///< an angular frequency [rad/s]; a scene may give the frequency instead
  angle,              ///< the parameter is a phase of a sine [rad]
  ratio,              ///< ratio of two quantities of the waveform, above 0; default 1
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

/// Traits of a waveform family, specialised in the family's header: its `name`, its `parameters`, and an `example` for tests.
/// The trait `from_file` is present if a scene may give the waveform as a file of rows.
template <class Family>
struct FamilyOf;

}  // namespace softland
