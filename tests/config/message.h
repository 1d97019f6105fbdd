// The message about a bad scene.
#pragma once

#include <string>
#include <vector>

#include "base/require.h"
#include "config/scene.h"

namespace softland {

/// Returns the message about a scene with this text and these options; empty if it is accepted.
inline std::string message(const std::string& text, const std::vector<std::string>& options = {}) {
  try {
    SceneFile file = SceneFile::parse(text, "x.toml");
    for (const std::string& option : options) file.set(option);
    const Scene scene = read_scene(file);
    static_cast<void>(scene.drives({{"main", {.static_pull_in = 50, .dynamic_pull_in = 40}}}));
    return {};
  } catch (const InvalidInput& error) {
    return error.what();
  }
}

}  // namespace softland
