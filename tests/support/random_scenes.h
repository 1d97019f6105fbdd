// Random switches for tests and studies: the shipped scenes, varied in everything that a scene can say.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "config/scene.h"

namespace softland::test {

/// The shipped scenes from which random scenes are made: scene `index` is based on number index % 8.
inline constexpr std::array<std::string_view, 8> scene_families{
    "mem-gold",      "mem-gold-pzt",  "nem-tin",        "nem-casimir",
    "hung-senturia", "purdue-nickel", "two-electrodes", "gap-closing-actuator",
};

/// Returns scene `index` of `seed`: a shipped scene with dimensions, gaps and material varied within 30 %. It has other
/// electrodes, another gas, contact, dispersion force and waveform, one to eight modes, and a window of two to twenty periods
/// of the first mode. It depends on the arguments alone.
///
/// The scene can be prepared. Its drives are in volts, so that no pull-in voltage has to be found. It may start collapsed,
/// never touch, or end in any other way that a run reports. Throws std::logic_error if `most_draws` attempts give no valid
/// scene.
[[nodiscard]] SceneFile random_scene(std::uint64_t seed, std::uint64_t index);
inline constexpr int most_draws = 100;

/// Returns the scene with a compressible film in place of its gas; none for a rigid contact, which excludes such a film.
[[nodiscard]] std::optional<SceneFile> random_film_scene(std::uint64_t seed, std::uint64_t index);

}  // namespace softland::test
