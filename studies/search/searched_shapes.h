// Variables, starting points and waveforms of the searched families that are smooth curves, and functions that these families
// share with pulse trains (searched_trains.h). searched_families.cc has the table of families; search_space.h lists the
// variables.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "studies/search/search_space.h"

namespace softland::internal {

using Parameters = std::optional<std::vector<double>>;

/// Returns the voltage, clamped to the limits of the drive's voltage source.
[[nodiscard]] double inside(const DriveSearch& s, double voltage);
/// Returns the piezo voltage [V] that, without other drives, deflects the contact point statically by `lift` away from the
/// contact [m].
[[nodiscard]] double lifting_voltage(const PreparedScene& p, double lift);
/// Returns the period of the first mode [s].
[[nodiscard]] double first_period(const PreparedScene& p);
/// A starting point of the search: full pull for a time, then least pull (coast), so that the switch arrives at its contact at
/// rest (swing.h). If the gas film is compressible, the durations are those of the first mode alone, without damping
/// (bang_bang.h). The other drives stay at their hold levels.
struct ThrowAndCoast {
  double pulling = 0, coasting = 0;           ///< voltages of the pull and of the coast [V]
  double driven_time = 0, coasting_time = 0;  ///< durations of the pull and of the coast [s]
};
/// Durations of the pull after first contact in starting points, as multiples of the plain step's time of first contact. Modes
/// that are still excited decay during this pull.
inline constexpr std::array pushes = {0.5, 1.0, 2.0, 3.5};
/// Returns the pull and the coast of a drive; empty if no pull and coast brings the switch to its contact, and for a drive that
/// pulls away from the contact.
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

/// Adds amplitude, frequency, phase, start, duration and fade of a dither about the hold level, with their bounds. Returns the
/// upper bound of the frequency [rad/s]. Throws InvalidInput if the limits of the drive permit no amplitude.
double add_dither_variables(DriveSearch& s, const PreparedScene& p, double t0);
/// A dither whose slope keeps the slew limit: rise time of its base, start and fades [s], and amplitude [V].
struct SlewedDither {
  double rise_time = 0, start = 0, fade = 0, amplitude = 0;
};
[[nodiscard]] SlewedDither slewed_dither(const DriveSearch& s, double amplitude, double omega, double decay, double start,
                                         double duration, double fade);

}  // namespace softland::internal
