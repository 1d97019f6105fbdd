// The figures of merit of a closing in one table: name in results, unit, whether a lower value is better, and how the error is
// estimated. Every list of figures is this table or a selection of it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "objectives/metrics.h"

namespace softland {

/// Tells whether a lower value of a figure of merit is better.
enum class Better { lower, neither };

/// The part of the motion that determines a figure of merit. This part decides whether the difference between two runs of
/// different accuracy estimates the error of the figure.
enum class Conditioning {
  first_touch,  ///< the motion until first contact: the difference between two runs estimates the figure's error
  /// One rebound: the difference between two runs estimates the figure's error, unless a rebound before it differs between the
  /// runs.
  high_rebound,
  every_touch,   ///< all touches: the difference of two runs estimates the figure's error when both have the same touches
  last_rebound,  ///< the end of a sequence of rebounds, which is chaotic: only an ensemble of runs gives the figure's range
  open,          ///< the motion of a switch that stays open: the difference between two runs estimates the figure's error
  rest,          ///< the equilibrium under the hold levels; the figure's only error is that of the quadrature along the beam
  drives         ///< the drives alone, not the motion: the figure of merit has no error
};

struct Figure {
  using Member = std::variant<double Metrics::*, int Metrics::*, bool Metrics::*>;

  std::string_view key;     ///< name of the figure in every JSON; ends with the unit
  std::string_view name;    ///< name of the figure in tables of a report
  std::string_view also;    ///< another common name of the figure; may be empty
  std::string_view symbol;  ///< short name of the figure, such as t_b; may be empty
  std::string_view about;   ///< what the figure is, in one line
  std::string_view unit;    ///< unit of the figure; empty for a count and for yes or no
  Better better = Better::neither;
  Conditioning conditioning = Conditioning::first_touch;
  Member member;
  /// Figure whose derivative serves as that of this figure: last_rebound_end for the permanent contact time. Null when the
  /// figure has no derivative.
  double Metrics::*slope = nullptr;
  bool of_results = true, of_devices = false;  ///< true when results show the figure for one closing, or for varied devices
  /// Optional request of a scene without which results omit the figure; null: always shown.
  bool AskedFigures::*asked = nullptr;
  /// Value that statistics of varied devices use for a device that does not close.
  double worst = std::numeric_limits<double>::infinity();

  [[nodiscard]] constexpr bool is_count() const { return std::holds_alternative<int Metrics::*>(member); }
  [[nodiscard]] constexpr bool is_yes_or_no() const { return std::holds_alternative<bool Metrics::*>(member); }
  /// Returns true when the difference between two runs of different accuracy estimates the figure's error.
  [[nodiscard]] constexpr bool error_is_from_two_runs() const {
    return conditioning == Conditioning::first_touch || conditioning == Conditioning::high_rebound ||
           conditioning == Conditioning::every_touch || conditioning == Conditioning::open;
  }
  /// Returns true when results show the figure for a scene that requests the optional figures `of_scene`.
  [[nodiscard]] constexpr bool is_asked(const AskedFigures& of_scene) const { return asked == nullptr || of_scene.*asked; }
  /// Returns true when certify(), which repeats a run at higher accuracy, estimates an error of the figure.
  [[nodiscard]] constexpr bool has_error() const { return !is_yes_or_no() && conditioning != Conditioning::drives; }

  /// Returns the figure's name with its other name in common use, for example "Permanent contact (settling time)".
  [[nodiscard]] std::string label() const;
  /// Returns the figure's key without its unit, for example "initial_contact_time".
  [[nodiscard]] constexpr std::string_view quantity() const {
    return unit.empty() ? key : key.substr(0, key.size() - unit.size() - 1);
  }
  /// Returns the value of the figure for a closing, 1 for yes and 0 for no; NaN when the figure is not known.
  [[nodiscard]] double value(const Metrics& metrics) const;
  /// Returns the value with which closings are compared: a rebound height of at least the least significant height, and a least
  /// contact force of at least the steady force, since values below these limits do not matter.
  [[nodiscard]] double counted(const Metrics& metrics, const MetricsOptions& options) const;
};

/// The table of all figures of merit.
inline constexpr auto figure_table = std::to_array<Figure>({
    {.key = "initial_contact_time_s",
     .name = "First contact",
     .symbol = "t_i",
     .about = "time at which the contact point first reaches the contact plane",
     .unit = "s",
     .conditioning = Conditioning::first_touch,
     .member = &Metrics::initial_contact_time,
     .slope = &Metrics::initial_contact_time,
     .of_devices = true},
    {.key = "permanent_contact_time_s",
     .name = "Permanent contact",
     .also = "settling time",
     .symbol = "t_p",
     .about = "end of the last significant rebound, t_i without any; no value unless settled",
     .unit = "s",
     .better = Better::lower,
     .conditioning = Conditioning::last_rebound,
     .member = &Metrics::permanent_contact_time,
     .slope = &Metrics::last_rebound_end,
     .of_devices = true},
    {.key = "bounce_time_s",
     .name = "Bounce time",
     .symbol = "t_b",
     .about = "t_p - t_i; no value unless settled",
     .unit = "s",
     .better = Better::lower,
     .conditioning = Conditioning::last_rebound,
     .member = &Metrics::bounce_time},
    {.key = "bounce_count",
     .name = "Rebounds",
     .symbol = "N_B",
     .about = "number of significant rebounds, which are higher than metrics.significant_rebound",
     .better = Better::lower,
     .conditioning = Conditioning::last_rebound,
     .member = &Metrics::bounce_count,
     .of_devices = true},
    {.key = "major_bounce_height_m",
     .name = "Highest rebound",
     .symbol = "B_H",
     .about = "height of the highest rebound, significant or not; 0 without any; "
              "a lower bound if it is under way at the end of the window",
     .unit = "m",
     .better = Better::lower,
     .conditioning = Conditioning::high_rebound,
     .member = &Metrics::major_bounce_height,
     .slope = &Metrics::major_bounce_height,
     .of_devices = true},
    {.key = "first_rebound_time_s",
     .name = "First rebound lasts",
     .symbol = "t_1",
     .about = "duration of the first significant rebound; 0 without any; no value while it is under way at the end of the window",
     .unit = "s",
     .better = Better::lower,
     .conditioning = Conditioning::high_rebound,
     .member = &Metrics::first_rebound_time},
    {.key = "impact_velocity_m_s",
     .name = "Impact velocity",
     .symbol = "v_i",
     .about = "speed of the contact point at first contact",
     .unit = "m/s",
     .better = Better::lower,
     .conditioning = Conditioning::first_touch,
     .member = &Metrics::impact_velocity,
     .slope = &Metrics::impact_velocity,
     .of_devices = true},
    {.key = "largest_impact_velocity_m_s",
     .name = "Largest impact velocity",
     .symbol = "v_max",
     .about = "largest impact velocity of all touches, not only of the first",
     .unit = "m/s",
     .better = Better::lower,
     .conditioning = Conditioning::every_touch,
     .member = &Metrics::largest_impact_velocity,
     .slope = &Metrics::largest_impact_velocity,
     .of_results = false,
     .of_devices = true},
    {.key = "peak_contact_force_N",
     .name = "Peak contact force",
     .symbol = "peak force",
     .about = "largest force of the contact law; no value on a rigid contact, where an impact has an impulse",
     .unit = "N",
     .better = Better::lower,
     .conditioning = Conditioning::every_touch,
     .member = &Metrics::peak_contact_force,
     .slope = &Metrics::peak_contact_force,
     .of_devices = true},
    {.key = "impact_energy_J",
     .name = "Impact energy",
     .symbol = "impact energy",
     .about =
         "sum over touches of the largest energy stored in the contact law; on a rigid contact, of the kinetic energy at impact",
     .unit = "J",
     .better = Better::lower,
     .conditioning = Conditioning::every_touch,
     .member = &Metrics::impact_energy,
     .slope = &Metrics::impact_energy,
     .of_devices = true},
    {.key = "pressure_over_hardness",
     .name = "Contact pressure over hardness",
     .symbol = "p/H",
     .about = "largest mean pressure of the highest summit, over the hardness; a summit yields from 0.4 on; "
              "for contacts with asperities and a hardness",
     .better = Better::lower,
     .conditioning = Conditioning::every_touch,
     .member = &Metrics::pressure,
     .asked = &AskedFigures::pressure},
    {.key = "make_charge_C",
     .name = "Charge transferred at make",
     .symbol = "charge at make",
     .about =
         "charge that [load] drives through the contact while its force is below the steady force, until the command to open",
     .unit = "C",
     .better = Better::lower,
     .conditioning = Conditioning::every_touch,
     .member = &Metrics::make_charge,
     .asked = &AskedFigures::charge},
    {.key = "break_charge_C",
     .name = "Charge transferred at break",
     .symbol = "charge at break",
     .about =
         "charge that [load] drives through the contact while its force is below the steady force, from the command to open on",
     .unit = "C",
     .better = Better::lower,
     .conditioning = Conditioning::open,
     .member = &Metrics::break_charge,
     .asked = &AskedFigures::break_charge},
    {.key = "hold_force_N",
     .name = "Hold force",
     .symbol = "hold force",
     .about = "contact force of the stable closed equilibrium under the hold levels, not the force at the end of the run",
     .unit = "N",
     .conditioning = Conditioning::rest,
     .member = &Metrics::hold_force},
    {.key = "steady_force_time_s",
     .name = "Steady force from",
     .symbol = "t_F",
     .about = "last time at which the contact force comes up to metrics.steady_force "
              "of the hold force, below which it then never falls",
     .unit = "s",
     .better = Better::lower,
     .conditioning = Conditioning::every_touch,
     .member = &Metrics::steady_force_time,
     .of_devices = true},
    {.key = "least_force_after_touch_N",
     .name = "Least force after the touch",
     .symbol = "least force",
     .about = "smallest contact force from its first maximum after t_i to the end of the window; "
              "0 if the contact opens, below 0 only with adhesion",
     .unit = "N",
     .conditioning = Conditioning::every_touch,
     .member = &Metrics::least_force_after_touch,
     .of_devices = true,
     .worst = 0},
    {.key = "resistance_ohm",
     .name = "Contact resistance at the hold level",
     .symbol = "contact resistance",
     .about =
         "resistance of the connection in the stable closed equilibrium under the hold levels; for contacts with a resistivity",
     .unit = "ohm",
     .conditioning = Conditioning::rest,
     .member = &Metrics::resistance,
     .of_devices = true,
     .asked = &AskedFigures::resistance},
    {.key = "electrical_contact_time_s",
     .name = "First electrical contact",
     .symbol = "t_e",
     .about = "first time at which the connection is electrically closed; for scenes with a key metrics.closed_...",
     .unit = "s",
     .conditioning = Conditioning::every_touch,
     .member = &Metrics::electrical_contact,
     .of_devices = true,
     .asked = &AskedFigures::electrical},
    {.key = "electrical_settling_time_s",
     .name = "Electrically closed from",
     .symbol = "t_c",
     .about = "time from which the connection stays electrically closed to the end of the window; no value where it is open then",
     .unit = "s",
     .better = Better::lower,
     .conditioning = Conditioning::last_rebound,
     .member = &Metrics::electrical_settling,
     .of_devices = true,
     .asked = &AskedFigures::electrical},
    {.key = "electrical_bounce_count",
     .name = "Electrical bounces",
     .symbol = "N_e",
     .about = "openings of the connection after t_e that are longer than metrics.closed_after; no value where it never closes",
     .better = Better::lower,
     .conditioning = Conditioning::last_rebound,
     .member = &Metrics::electrical_bounces,
     .of_devices = true,
     .asked = &AskedFigures::electrical},
    {.key = "capacitance_F",
     .name = "Capacitance at the hold level",
     .symbol = "capacitance",
     .about = "of the electrode that closes the switch, in the closed equilibrium under the hold levels; "
              "in the open one where nothing touched",
     .unit = "F",
     .conditioning = Conditioning::rest,
     .member = &Metrics::capacitance},
    {.key = "static_deflection_m",
     .name = "Static deflection",
     .symbol = "static deflection",
     .about = "deflection of the contact point in the stable open equilibrium under the hold levels; only where nothing touched",
     .unit = "m",
     .conditioning = Conditioning::open,
     .member = &Metrics::static_deflection},
    {.key = "overshoot_m",
     .name = "Overshoot",
     .symbol = "overshoot",
     .about = "largest excursion of the contact point beyond the static deflection, seen from its start; 0 if none; "
              "only where nothing touched",
     .unit = "m",
     .better = Better::lower,
     .conditioning = Conditioning::open,
     .member = &Metrics::overshoot},
    {.key = "open_settling_time_s",
     .name = "Settling time, open",
     .symbol = "open settling time",
     .about = "time from which the contact point stays within 2 % of its largest distance from the static deflection; "
              "only where nothing touched",
     .unit = "s",
     .better = Better::lower,
     .conditioning = Conditioning::open,
     .member = &Metrics::open_settling_time},
    {.key = "open_command_s",
     .name = "Command to open",
     .symbol = "command to open",
     .about = "time at which the drives command the closed switch to open",
     .unit = "s",
     .conditioning = Conditioning::drives,
     .member = &Metrics::open_command,
     .asked = &AskedFigures::opening},
    {.key = "opening_time_s",
     .name = "Opening time",
     .symbol = "opening time",
     .about = "time from the command to the last break of the contact; no value where it is closed at the end",
     .unit = "s",
     .better = Better::lower,
     .conditioning = Conditioning::open,
     .member = &Metrics::opening_time,
     .asked = &AskedFigures::opening},
    {.key = "release_bounces",
     .name = "Bounces on opening",
     .symbol = "bounces on opening",
     .about = "separations higher than metrics.significant_rebound that end in a touch after the command",
     .better = Better::lower,
     .conditioning = Conditioning::last_rebound,
     .member = &Metrics::release_bounces,
     .asked = &AskedFigures::opening},
    {.key = "release_bounce_height_m",
     .name = "Highest bounce on opening",
     .symbol = "highest bounce on opening",
     .about = "largest separation in a bounce on opening; 0 without any",
     .unit = "m",
     .better = Better::lower,
     .conditioning = Conditioning::open,
     .member = &Metrics::release_bounce_height,
     .asked = &AskedFigures::opening},
    {.key = "release_settling_time_s",
     .name = "Open and at rest",
     .symbol = "open and at rest",
     .about = "time from the command until the contact point stays within 2 % of the contact gap of its open equilibrium",
     .unit = "s",
     .better = Better::lower,
     .conditioning = Conditioning::open,
     .member = &Metrics::release_settling_time,
     .asked = &AskedFigures::opening},
    {.key = "overshoot_open_m",
     .name = "Overshoot on opening",
     .symbol = "overshoot on opening",
     .about = "largest excursion beyond the open equilibrium, away from the contact",
     .unit = "m",
     .better = Better::lower,
     .conditioning = Conditioning::open,
     .member = &Metrics::overshoot_open,
     .asked = &AskedFigures::opening},
    {.key = "least_gap_open_m",
     .name = "Least gap after opening",
     .symbol = "least gap",
     .about = "smallest separation on the way back after the last break",
     .unit = "m",
     .conditioning = Conditioning::open,
     .member = &Metrics::least_gap_open,
     .asked = &AskedFigures::opening},
    {.key = "closed_time_s",
     .name = "Time in touch",
     .symbol = "time in touch",
     .about = "time from the first touch to the last break, less the time in which the contact is open in between",
     .unit = "s",
     .conditioning = Conditioning::every_touch,
     .member = &Metrics::closed_time,
     .asked = &AskedFigures::opening},
    {.key = "back_stop_velocity_m_s",
     .name = "Impact velocity on the back stop",
     .symbol = "impact on the back stop",
     .about = "largest impact velocity on a back stop after the command, 0 without any; only of switches with a back stop",
     .unit = "m/s",
     .better = Better::lower,
     .conditioning = Conditioning::open,
     .member = &Metrics::back_stop_velocity,
     .asked = &AskedFigures::opening},
    {.key = "drive_energy_J",
     .name = "Drive energy",
     .symbol = "drive energy",
     .about = "sum over all drives of the integral of V dQ over the whole window",
     .unit = "J",
     .better = Better::lower,
     .conditioning = Conditioning::every_touch,
     .member = &Metrics::drive_energy},
    {.key = "peak_voltage_V",
     .name = "Peak voltage",
     .symbol = "peak voltage",
     .about = "largest absolute voltage of the electrodes' drives in the window; of the piezo only where there is no electrode",
     .unit = "V",
     .conditioning = Conditioning::drives,
     .member = &Metrics::peak_voltage},
    {.key = "peak_slew_V_s",
     .name = "Peak slew",
     .symbol = "peak slew",
     .about = "largest rate of change of any drive; a jump has none",
     .unit = "V/s",
     .conditioning = Conditioning::drives,
     .member = &Metrics::peak_slew},
    {.key = "settled",
     .name = "Settled",
     .symbol = "settled",
     .about = "permanent contact began at least one in-contact period before the end "
              "of the window, and the closed equilibrium is stable",
     .conditioning = Conditioning::last_rebound,
     .member = &Metrics::settled},
    {.key = "closest_m",
     .name = "Closest approach",
     .symbol = "closest approach",
     .about = "smallest separation before the first touch, known also without contact",
     .unit = "m",
     .member = &Metrics::closest,
     .slope = &Metrics::closest,
     .of_results = false},
    {.key = "separated_s",
     .name = "Time in separation",
     .symbol = "time in separation",
     .about = "time above the contact plane after the first touch",
     .unit = "s",
     .member = &Metrics::separated,
     .slope = &Metrics::separated,
     .of_results = false},
    {.key = "last_rebound_end_s",
     .name = "End of the last rebound",
     .symbol = "end of the last rebound",
     .about = "end of the last significant rebound; end of the run if that rebound is under way; t_i without any",
     .unit = "s",
     .member = &Metrics::last_rebound_end,
     .slope = &Metrics::last_rebound_end,
     .of_results = false},
    {.key = "landing_excess_J",
     .name = "Landing excess",
     .symbol = "landing excess",
     .about = "energy above that of the closed equilibrium, after the touch and with all drives at their hold levels; at least 0",
     .unit = "J",
     .member = &Metrics::landing_excess,
     .slope = &Metrics::landing_excess,
     .of_results = false},
});

/// Returns a list of the figures for which `chosen` returns true, in the order of figure_table, at compile time.
template <bool (*chosen)(const Figure&)>
[[nodiscard]] consteval auto figures_that_are() {
  std::array<Figure, static_cast<std::size_t>(std::count_if(figure_table.begin(), figure_table.end(), chosen))> all{};
  std::copy_if(figure_table.begin(), figure_table.end(), all.begin(), chosen);
  return all;
}
namespace internal {
constexpr bool is_of_results(const Figure& one) { return one.of_results; }
constexpr bool is_of_devices(const Figure& one) { return one.of_devices; }
constexpr bool is_number_of_results(const Figure& one) { return one.of_results && !one.is_yes_or_no(); }
constexpr bool is_derived(const Figure& one) { return one.slope != nullptr && (one.of_results || one.of_devices); }
}  // namespace internal
/// Selections of figure_table: figures that results show for a closing; figures of varied devices, on which conditions on
/// devices may be set; figures that conditions on one closing may use; figures that have derivatives.
inline constexpr auto all_figures = figures_that_are<internal::is_of_results>();
inline constexpr auto device_figures = figures_that_are<internal::is_of_devices>();
inline constexpr auto conditioned_figures = figures_that_are<internal::is_number_of_results>();
inline constexpr auto derived_figures = figures_that_are<internal::is_derived>();

/// Returns the members of `figures` that results show for a scene that requests the optional figures `asked`.
[[nodiscard]] std::vector<Figure> asked_among(std::span<const Figure> figures, const AskedFigures& asked);

/// Returns the entry of figure_table for a member of Metrics.
[[nodiscard]] constexpr const Figure& figure_of(Figure::Member member) {
  return *std::find_if(figure_table.begin(), figure_table.end(), [&](const Figure& one) { return one.member == member; });
}
[[nodiscard]] constexpr std::string_view key_of(Figure::Member member) { return figure_of(member).key; }
/// Returns the entry of figure_table with this key, which must exist.
[[nodiscard]] constexpr const Figure& figure_of(std::string_view key) {
  return *std::find_if(figure_table.begin(), figure_table.end(), [&](const Figure& one) { return one.key == key; });
}

/// The figures by which closings with different laws or different numbers of modes are compared.
inline constexpr std::array compared_figures{figure_of(&Metrics::initial_contact_time), figure_of(&Metrics::impact_velocity),
                                             figure_of(&Metrics::major_bounce_height)};
/// The figures that an accuracy study of a closing compares: compared_figures, and the peak contact force.
inline constexpr std::array studied_figures{compared_figures[0], compared_figures[1], compared_figures[2],
                                            figure_of(&Metrics::peak_contact_force)};

}  // namespace softland
