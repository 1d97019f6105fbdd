// The figures of merit of a closing in one table: what results call each of them, in which unit, which way is better, and what
// decides its last digits. Every list of figures is this table or a selection of it.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <variant>

#include "objectives/cost.h"
#include "objectives/metrics.h"

namespace softland {

/// Which way a figure is better.
enum class Better { lower, neither };

/// What a figure depends on, and with that who can tell its error.
enum class Conditioning {
  first_touch,   ///< the motion until first contact: two runs differ by the error
  high_rebound,  ///< one rebound: two runs differ by the error, unless they part before it
  every_touch,   ///< all touches: two runs differ by the error as long as they have the same touches
  last_rebound,  ///< the end of a sequence of rebounds, chaotic past the first large one: only a cloud of runs tells the range
  open,          ///< the motion of a switch that stays open: two runs differ by the error
  rest,          ///< the equilibrium under the hold levels: the quadrature alone
  drives         ///< the drives alone: it has no error
};

struct Figure {
  using Member = std::variant<double Metrics::*, int Metrics::*, bool Metrics::*>;

  std::string_view key;     ///< in every JSON; ends with the unit
  std::string_view name;    ///< in tables for people
  std::string_view also;    ///< another name that people know; may be empty
  std::string_view symbol;  ///< a short name where there is none
  std::string_view unit;    ///< empty for a count and for yes or no
  Better better = Better::neither;
  Conditioning conditioning = Conditioning::first_touch;
  Member member;

  [[nodiscard]] constexpr bool is_count() const { return std::holds_alternative<int Metrics::*>(member); }
  [[nodiscard]] constexpr bool is_yes_or_no() const { return std::holds_alternative<bool Metrics::*>(member); }
  /// Whether the difference of two runs is an estimate of its error.
  [[nodiscard]] constexpr bool is_told_by_two_runs() const {
    return conditioning == Conditioning::first_touch || conditioning == Conditioning::high_rebound ||
           conditioning == Conditioning::every_touch || conditioning == Conditioning::open;
  }
  /// Whether certify() gives it an error.
  [[nodiscard]] constexpr bool has_error() const { return !is_yes_or_no() && conditioning != Conditioning::drives; }

  /// "Permanent contact (settling time)"
  [[nodiscard]] std::string label() const;
  /// The key without its unit: "initial_contact_time".
  [[nodiscard]] constexpr std::string_view quantity() const {
    return unit.empty() ? key : key.substr(0, key.size() - unit.size() - 1);
  }
  /// The figure of a closing, 1 for yes and 0 for no; NaN where it is not known.
  [[nodiscard]] double value(const Metrics& metrics) const;
  /// The same for comparisons: a rebound too low to count is as high as one that just counts, and a force as large as is steady.
  [[nodiscard]] double counted(const Metrics& metrics, const MetricsOptions& options) const;
};

inline constexpr std::array all_figures{Figure{.key = "initial_contact_time_s",
                                               .name = "First contact",
                                               .symbol = "t_i",
                                               .unit = "s",
                                               .conditioning = Conditioning::first_touch,
                                               .member = &Metrics::initial_contact_time},
                                        Figure{.key = "permanent_contact_time_s",
                                               .name = "Permanent contact",
                                               .also = "settling time",
                                               .symbol = "t_p",
                                               .unit = "s",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::last_rebound,
                                               .member = &Metrics::permanent_contact_time},
                                        Figure{.key = "bounce_time_s",
                                               .name = "Bounce time",
                                               .symbol = "t_b",
                                               .unit = "s",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::last_rebound,
                                               .member = &Metrics::bounce_time},
                                        Figure{.key = "bounce_count",
                                               .name = "Rebounds",
                                               .symbol = "N_B",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::last_rebound,
                                               .member = &Metrics::bounce_count},
                                        Figure{.key = "major_bounce_height_m",
                                               .name = "Highest rebound",
                                               .symbol = "B_H",
                                               .unit = "m",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::high_rebound,
                                               .member = &Metrics::major_bounce_height},
                                        Figure{.key = "first_rebound_time_s",
                                               .name = "First rebound lasts",
                                               .symbol = "t_1",
                                               .unit = "s",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::high_rebound,
                                               .member = &Metrics::first_rebound_time},
                                        Figure{.key = "impact_velocity_m_s",
                                               .name = "Impact speed",
                                               .symbol = "v_i",
                                               .unit = "m/s",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::first_touch,
                                               .member = &Metrics::impact_velocity},
                                        Figure{.key = "peak_contact_force_N",
                                               .name = "Peak contact force",
                                               .symbol = "peak force",
                                               .unit = "N",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::every_touch,
                                               .member = &Metrics::peak_contact_force},
                                        Figure{.key = "impact_energy_J",
                                               .name = "Impact energy",
                                               .symbol = "impact energy",
                                               .unit = "J",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::every_touch,
                                               .member = &Metrics::impact_energy},
                                        Figure{.key = "hold_force_N",
                                               .name = "Hold force",
                                               .symbol = "hold force",
                                               .unit = "N",
                                               .conditioning = Conditioning::rest,
                                               .member = &Metrics::hold_force},
                                        Figure{.key = "steady_force_time_s",
                                               .name = "Steady force from",
                                               .symbol = "t_F",
                                               .unit = "s",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::every_touch,
                                               .member = &Metrics::steady_force_time},
                                        Figure{.key = "least_force_after_touch_N",
                                               .name = "Least force after the touch",
                                               .symbol = "least force",
                                               .unit = "N",
                                               .conditioning = Conditioning::every_touch,
                                               .member = &Metrics::least_force_after_touch},
                                        Figure{.key = "capacitance_F",
                                               .name = "Capacitance at the hold level",
                                               .symbol = "capacitance",
                                               .unit = "F",
                                               .conditioning = Conditioning::rest,
                                               .member = &Metrics::capacitance},
                                        Figure{.key = "static_deflection_m",
                                               .name = "Static deflection",
                                               .symbol = "static deflection",
                                               .unit = "m",
                                               .conditioning = Conditioning::open,
                                               .member = &Metrics::static_deflection},
                                        Figure{.key = "overshoot_m",
                                               .name = "Overshoot",
                                               .symbol = "overshoot",
                                               .unit = "m",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::open,
                                               .member = &Metrics::overshoot},
                                        Figure{.key = "open_settling_time_s",
                                               .name = "Settling time, open",
                                               .symbol = "open settling time",
                                               .unit = "s",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::open,
                                               .member = &Metrics::open_settling_time},
                                        Figure{.key = "drive_energy_J",
                                               .name = "Drive energy",
                                               .symbol = "drive energy",
                                               .unit = "J",
                                               .better = Better::lower,
                                               .conditioning = Conditioning::every_touch,
                                               .member = &Metrics::drive_energy},
                                        Figure{.key = "peak_voltage_V",
                                               .name = "Peak voltage",
                                               .symbol = "peak voltage",
                                               .unit = "V",
                                               .conditioning = Conditioning::drives,
                                               .member = &Metrics::peak_voltage},
                                        Figure{.key = "peak_slew_V_s",
                                               .name = "Peak slew",
                                               .symbol = "peak slew",
                                               .unit = "V/s",
                                               .conditioning = Conditioning::drives,
                                               .member = &Metrics::peak_slew},
                                        Figure{.key = "settled",
                                               .name = "Settled",
                                               .symbol = "settled",
                                               .conditioning = Conditioning::last_rebound,
                                               .member = &Metrics::settled}};

/// The row of a member of Metrics.
[[nodiscard]] constexpr const Figure& figure_of(Figure::Member member) {
  return *std::find_if(all_figures.begin(), all_figures.end(), [&](const Figure& one) { return one.member == member; });
}
/// The figure that a target is about.
[[nodiscard]] const Figure& figure_of(Target target);

/// The figures by which a closing is compared with one of another law or number of modes.
inline constexpr std::array compared_figures{figure_of(&Metrics::initial_contact_time), figure_of(&Metrics::impact_velocity),
                                             figure_of(&Metrics::major_bounce_height)};
/// The figures that the accuracy of a closing is about: these, and one that needs a contact law.
inline constexpr std::array studied_figures{compared_figures[0], compared_figures[1], compared_figures[2],
                                            figure_of(&Metrics::peak_contact_force)};

/// A number for every figure: its value, or its error. NaN: not known.
class FigureValues {
 public:
  constexpr FigureValues() { values_.fill(Metrics::unset); }
  explicit FigureValues(const Metrics& metrics);
  [[nodiscard]] constexpr double& operator[](Figure::Member member) { return values_[index(member)]; }
  [[nodiscard]] constexpr double operator[](Figure::Member member) const { return values_[index(member)]; }
  [[nodiscard]] constexpr double& operator[](const Figure& figure) { return (*this)[figure.member]; }
  [[nodiscard]] constexpr double operator[](const Figure& figure) const { return (*this)[figure.member]; }

 private:
  static constexpr std::size_t index(Figure::Member member) {
    return static_cast<std::size_t>(&figure_of(member) - all_figures.data());
  }
  std::array<double, all_figures.size()> values_;
};

/// (value - reference) / max(|reference|, least): by which part of itself a figure changes. NaN where either is not known.
[[nodiscard]] double relative_change(double value, double reference, double least = 0);
/// Its size, to be held against a tolerance: 0 where both are equal or neither is known, infinite where only one is known.
[[nodiscard]] double relative_difference(double value, double reference, double least = 0);

}  // namespace softland
