// The assumed process variation of a scene that gives none, so that a search considers varied devices at all.
//
//   thickness and all gaps, by one factor       normal, 2 %
//   Young's modulus                             normal, 3 %
//   a plate: stiffness, and all gaps            normal, 6.7 % (that of a beam of such a thickness) and 2 %
#pragma once

#include <string_view>

#include "config/scene.h"

namespace softland {

/// Words for an assumed spread.
inline constexpr std::string_view assumed_words = "The scene has no [spread]: a usual one is assumed.";

/// Gives a scene without [spread] the assumed one. Returns true when it had none. A section that exists and is empty stays, and
/// is refused when it is read.
bool assume_spread(SceneFile& file);

}  // namespace softland
