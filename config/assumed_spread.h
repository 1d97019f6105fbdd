// The process variation that a search assumes for a scene without [spread].
//
//   beam                      thickness 2 %, Young's modulus 3 %
//   plate                     stiffness 6.7 %, which these two variations give a beam
//   structure of kind modes   natural frequencies 3.5 %
//   every structure           all gaps, by one common factor, 2 %
//
// Each varied quantity is multiplied by an independent normal factor of mean 1, whose standard deviation is the listed number.
#pragma once

#include <string_view>

#include "config/scene.h"

namespace softland {

/// Note that a report shows when assume_spread() has added the process variation.
inline constexpr std::string_view assumed_prose = "The scene has no [spread]: a typical process variation is assumed.";

/// Adds the section [spread] with the assumed process variation to a scene without this section. Returns true if the section
/// was added. An existing [spread] does not change, even if it is empty; read_scene() then refuses the scene.
bool assume_spread(SceneFile& file);

}  // namespace softland
