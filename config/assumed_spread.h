// The process variation that a search assumes for a scene without [spread].
//
//   beam                      thickness 2 %, Young's modulus 3 %
//   plate                     stiffness 6.7 %, which these two variations give a beam
//   structure of given modes  natural frequencies 3.5 %
//   every structure           all gaps, by one common factor, 2 %
//
// Each varied quantity is multiplied by an independent normal factor with this standard deviation.
#pragma once

#include <string_view>

#include "config/scene.h"

namespace softland {

/// Note for the user that a process variation is assumed.
inline constexpr std::string_view assumed_prose = "The scene has no [spread]: a typical process variation is assumed.";

/// Adds the assumed process variation [spread] to a scene that has none, and returns true in that case. An existing section is
/// kept; read_scene() refuses an empty one.
bool assume_spread(SceneFile& file);

}  // namespace softland
