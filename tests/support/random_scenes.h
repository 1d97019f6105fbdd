// Random switches for tests and studies: the shipped scenes, varied in everything that a scene can say.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "config/scene.h"

namespace softland::test {

/// The shipped scenes; scene `index` is made of family index % 8.
inline constexpr std::array<std::string_view, 8> scene_families{
    "mem-gold",      "mem-gold-pzt",  "nem-tin",        "nem-casimir",
    "hung-senturia", "purdue-nickel", "two-electrodes", "gap-closing-actuator",
};

/// Returns scene `index` of `seed`: one of the families with its dimensions, gaps and material within 30 %. It has other
/// electrodes, another gas, contact, dispersion force and waveform, one to eight modes, and a window of two to twenty periods of
/// the first mode. It depends on its arguments alone: neither order nor threads change it. The scene can be prepared; its drives
/// are in volts, so that this takes no search for pull-in voltages. It may start collapsed, never touch, or be anything else that
/// a run reports. Throws std::logic_error when `most_draws` draws give no valid scene.
[[nodiscard]] SceneFile random_scene(std::uint64_t seed, std::uint64_t index);
inline constexpr int most_draws = 100;

/// The same with a compressible film in the place of its gas; none where the contact is rigid, under which such a film cannot be.
[[nodiscard]] std::optional<SceneFile> random_film_scene(std::uint64_t seed, std::uint64_t index);

}  // namespace softland::test
