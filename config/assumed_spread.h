// How devices differ where a scene does not say it: an assumption, so that a search looks at devices at all.
//
//   thickness and all gaps, by one factor       normal, 2 %
//   Young's modulus                             normal, 3 %
//   a plate: stiffness, and all gaps            normal, 6.7 % (that of a beam of such a thickness) and 2 %
#pragma once

#include <string_view>

#include "config/scene.h"

namespace softland {

/// What is said where it is.
inline constexpr std::string_view assumed_words = "The scene has no [spread]: a usual one is assumed.";

/// Gives a scene without [spread] the assumed one. Returns whether it had none; one that is there and empty stays, and is refused
/// where it is read.
bool assume_spread(SceneFile& file);

}  // namespace softland
