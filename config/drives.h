// Reads waveforms and voltage limits of a scene's drives into volts. Internal to config/.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "config/scene.h"
#include "config/scene_file_impl.h"
#include "config/units.h"
#include "waveforms/waveform.h"

namespace softland::internal {

inline constexpr std::string_view frequency_key = "frequency";  ///< key that may replace the angular frequency of a waveform
inline constexpr std::string_view file_key = "file";            ///< key for a file with times and voltages of the waveform
/// Keys of [waveform.NAME] that say how its `file` is read, for example the unit of the times, which many files lack.
namespace file_keys {
inline constexpr std::string_view column = "column", time_column = "time_column", interval = "interval", skip = "skip",
                                  unit = "unit", time_unit = "time_unit", decimal = "decimal", scale = "scale", shift = "shift";
inline constexpr std::string_view uneven = "uneven";  ///< value of the key `interval`: do not replace the times by even ones
inline constexpr std::string_view first = "first";    ///< value of the key `shift`: the first row of the file is at t = 0
inline constexpr std::array all{column, time_column, interval, skip, unit, time_unit, decimal, scale, shift};
}  // namespace file_keys
inline constexpr std::string_view before_key = "before";  ///< key of every waveform: its voltage before t = 0
/// Key of every waveform. Its value, open or closed, is the state of the switch, an equilibrium, in which a simulation begins.
inline constexpr std::string_view before_state_key = "before_state", open_state = "open", closed_state_word = "closed";
/// Value of the key rise_time that selects the shortest rise permitted by max_slew of the voltage source.
inline constexpr std::string_view steepest_rise = "driver";

/// Returns the dimension in which a scene gives a waveform parameter, such as a time. For voltage levels and differences it is
/// voltage; callers treat the dispersion force, whose levels are plain numbers, separately.
[[nodiscard]] Dimension dimension_of(ParameterKind kind);

/// Returns the waveform with every voltage level raised by `by` [V].
[[nodiscard]] Waveform raised(Waveform waveform, double by);

/// Returns for a message why the device has no drive of this name, with the nearest valid name; empty if the drive exists.
[[nodiscard]] std::string why_no_drive(const Device& device, const std::string& name);

/// Throws InvalidInput for an electrode name that is reserved ("piezo"), too long, or not letters, digits, '_' and '-'.
void check_drive_name(const SceneFile::Impl& file, const std::string& electrode);

/// Checks every [waveform.NAME] and [driver.NAME], except the limits that depend on pull-in voltages. Throws InvalidInput. Sets
/// need_pull_in, limits_in_pull_in, standing, begins_closed and file_notes of the scene.
void check_drives(const SceneFile::Impl& file, Scene& scene);

/// Reads the waveforms and sources of all drives, in volts. Throws InvalidInput for a waveform outside the limits of its
/// source.
[[nodiscard]] Drives read_drives(const SceneFile::Impl& file, const Device& device,
                                 const std::map<std::string, PullInVoltages>& pull_in);

}  // namespace softland::internal
