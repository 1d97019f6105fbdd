// The process variation that a search assumes for a scene without [spread].
//
//   thickness and all gaps, by one factor       normal, 2 %
//   Young's modulus                             normal, 3 %
//   a plate: stiffness, and all gaps            normal, 6.7 % (as of a beam whose thickness and modulus vary) and 2 %
#pragma once

#include <string_view>

#include "config/scene.h"

namespace softland {

/// Note for the user that a process variation is assumed.
inline constexpr std::string_view assumed_prose = "The scene has no [spread]: a typical process variation is assumed.";

/// Adds the assumed process variation [spread] to a scene that has none, and returns true in that case. An existing empty
/// section is kept; it is refused when the scene is read.
bool assume_spread(SceneFile& file);

}  // namespace softland
