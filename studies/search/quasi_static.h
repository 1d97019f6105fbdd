// The quasi-static approach: waveforms that carry the switch to its contact slowly, through stable equilibria, so that every
// device touches softly, and that hold it once it is closed.
//
//   rise    to where the first devices nearly touch, by straight lines that leave no vibration: a line of one period T of mode 1
//           through an input shaper of N impulses half a period apart, whose weights are binomial
//   line    on through the voltages at which devices touch, at a constant rate, its ends through the same shaper
//   hold    the electrode that holds the switch stands low meanwhile and rises when the contact is made; then the drive that
//           carried the switch goes back to its hold level. An electrode that carries the switch itself rises to its hold
//           level.
//
// Straight lines are lines in the quantity that drives the beam: the volts of a piezo, the square of an electrode's volts if it
// carries the switch. With two impulses (ZV) the rise takes 1.5 T, and devices whose frequencies differ by 3.5 % keep 0.7 % of
// it as vibration. With three (ZVD) it takes 2 T and leaves 0.07 %.
//
// Levels of the carrying drive are shares of the voltage at which the nominal design touches while the holder stands at its low
// level, so that the two are searched apart. One set of parameters moves all drives. If the search does not shape the electrode
// (actuator pzt), the electrode keeps its plain step, whose instant is a parameter.
//
// Source of the shapers: N. C. Singer & W. P. Seering, J. Dyn. Syst. Meas. Control 112 (1990) 76.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "optimizers/problem.h"
#include "studies/closing/actuator.h"
#include "studies/closing/prepared.h"
#include "studies/devices/stable_approach.h"

namespace softland {

inline constexpr std::string_view quasi_static_family = "quasi-static";
/// Impulses of the shaper, if no number is named.
inline constexpr std::size_t usual_impulses = 3;

class QuasiStatic {
 public:
  /// `first_touch` is that of the plain step [s].
  QuasiStatic(const PreparedScene& prepared, Actuator actuator, StableApproach approach, std::size_t impulses,
              double first_touch);

  [[nodiscard]] const StableApproach& approach() const { return approach_; }
  /// Drives whose waveforms this makes: the one that carries first, then the holder if there is one.
  [[nodiscard]] std::vector<std::string> drives() const;
  /// Names with their drive: "piezo.rise", "piezo.line_s".
  [[nodiscard]] const std::vector<Variable>& variables() const { return variables_; }
  [[nodiscard]] const std::vector<std::vector<double>>& starts() const { return starts_; }
  [[nodiscard]] DriveWaveforms waveforms(std::span<const double> x) const;
  /// Returns the same with bounds about the closed form for devices that carry a steady force from `steady` on [s]. The closed
  /// form is its start; a shaped holder adds starts with lower levels.
  [[nodiscard]] QuasiStatic paced(double steady) const;

 private:
  /// The way in which the switch is held once it is closed.
  enum class Holding {
    by_itself,  ///< the drive that carried it goes on to its hold level
    shaped,     ///< the holder's waveform is searched
    by_step,    ///< the holder's plain step comes when the contact is made
  };
  using Points = std::vector<std::pair<double, double>>;  // [s, V]

  // `low` is the holder's level before contact [V].
  [[nodiscard]] std::vector<double> closed_form(double steady, double low) const;
  void clamp_starts();
  void bound(const std::vector<double>& start, bool is_paced);
  [[nodiscard]] Waveform carrying(Points points) const;
  /// The voltage at which the nominal design touches while the holder stands at `low` [V].
  [[nodiscard]] double reaches(double low) const;
  /// The share of the touching voltage that is so many standard deviations beyond it, within the limit.
  [[nodiscard]] double share(double deviations) const;

  StableApproach approach_;
  Holding holding_ = Holding::by_itself;
  std::size_t impulses_;
  double period_ = 0;                               // period of mode 1 [s]
  bool is_electrode_ = false;                       // true if an electrode carries
  double neutral_ = 0;                              // its V0, see Switch::neutral_voltage() [V]
  std::vector<std::pair<double, double>> reaches_;  // touching voltages by the holder's level squared: [V^2, V]
  double hold_ = 0, before_ = 0, holder_hold_ = 0, holder_before_ = 0;  // [V]
  DriverLimits limits_, holder_limits_;
  std::vector<Variable> variables_;
  std::vector<std::vector<double>> starts_;
};

}  // namespace softland
