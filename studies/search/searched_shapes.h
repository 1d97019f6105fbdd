// Variables, starting points and waveforms of the searched families that are curves, and the parts that trains
// (searched_trains.h) share with them. Their rows stand in searched_families.cc; search_space.h lists what they vary.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "studies/search/search_space.h"

namespace softland::internal {

using Parameters = std::optional<std::vector<double>>;

/// The voltage within the limits of the drive.
[[nodiscard]] double inside(const DriveSearch& s, double voltage);
/// Voltage [V] of the piezo whose static effect on the contact point alone is `lift` away from the contact [m].
[[nodiscard]] double lifting_voltage(const PreparedScene& p, double lift);
/// Period of the first mode [s].
[[nodiscard]] double first_period(const PreparedScene& p);
/// Full pull and then none, as it lands the switch (swing.h). If the gas film is compressible, the landing is that of the first
/// mode alone, without damping (bang_bang.h). The other drives stand at their hold levels.
struct ThrowAndCoast {
  double pulling = 0, coasting = 0;           ///< [V]
  double driven_time = 0, coasting_time = 0;  ///< [s]
};
/// Durations of the pull after the landing, in first touches of the plain step. Searches begin with them: the modes that still
/// ring decay meanwhile.
inline constexpr std::array pushes = {0.5, 1.0, 2.0, 3.5};
/// Nothing if no such landing exists, and for a drive that pulls away from the contact.
[[nodiscard]] std::optional<ThrowAndCoast> throw_and_coast(const DriveSearch& s, const PreparedScene& p);

void add_s_curve(DriveSearch& s, const PreparedScene& p, double t0);
void add_dither(DriveSearch& s, const PreparedScene& p, double t0);
void add_chirp(DriveSearch& s, const PreparedScene& p, double t0);
void add_bspline(DriveSearch& s, const PreparedScene& p, double t0);
void add_sines(DriveSearch& s, const PreparedScene& p, double t0);
[[nodiscard]] Waveform s_curve_at(const DriveSearch& s, std::span<const double> x);
[[nodiscard]] Waveform dither_at(const DriveSearch& s, std::span<const double> x);
[[nodiscard]] Waveform chirp_at(const DriveSearch& s, std::span<const double> x);
[[nodiscard]] Waveform bspline_at(const DriveSearch& s, std::span<const double> x);
[[nodiscard]] Waveform sines_at(const DriveSearch& s, std::span<const double> x);
[[nodiscard]] Parameters of_s_curve(const DriveSearch& s, const Waveform& waveform);
[[nodiscard]] Parameters of_dither(const DriveSearch& s, const Waveform& waveform);
[[nodiscard]] Parameters of_chirp(const DriveSearch& s, const Waveform& waveform);
[[nodiscard]] Parameters of_bspline(const DriveSearch& s, const Waveform& waveform);
[[nodiscard]] Parameters of_sines(const DriveSearch& s, const Waveform& waveform);

/// Adds amplitude, frequency, phase and start of a dither about the hold level, with their bounds. Returns the highest
/// frequency [rad/s]. Throws InvalidInput if the limits leave it no room.
double add_dither_variables(DriveSearch& s, const PreparedScene& p, double t0);
/// A dither under a slew limit: the duration of its fades, and its amplitude. Its angle turns by at most `omega` [rad/s], and
/// it decays in `decay` [s].
struct SlewedDither {
  double rise_time = 0, start = 0, fade = 0, amplitude = 0;
};
[[nodiscard]] SlewedDither slewed_dither(const DriveSearch& s, double amplitude, double omega, double decay, double start,
                                         double duration, double fade);

}  // namespace softland::internal
