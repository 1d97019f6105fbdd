// The quasi-static approach: waveforms that carry the switch to its contact slowly, through stable equilibria, so that every
// device touches softly, whatever it is, and that hold it once it is closed.
//
//   rise    to where the first devices nearly touch, by straight lines that leave no vibration: a line of one period T of mode 1
//           through an input shaper of N impulses half a period apart, whose weights are binomial
//   line    on through the voltages at which devices touch, at a constant rate, its ends through the same shaper
//   hold    the electrode that holds the switch stands low meanwhile and comes up when the contact is made; then the drive that
//           carried the switch goes back to its hold level. An electrode that carries the switch itself goes up to its hold
//           level.
//
// Straight lines are lines in what drives the beam: the volts of a piezo, the square of an electrode's volts where it carries the
// switch. With two impulses (ZV) the rise takes 1.5 T and devices whose frequencies differ by 3.5 % keep 0.7 % of it as
// vibration; with three (ZVD) it takes 2 T and leaves 0.07 %.
//
// Levels of the drive that carries the switch are shares of the voltage at which the nominal design touches while the holder
// stands at its low level: the two are then searched apart. One set of parameters moves all drives. Where the electrode is not
// the search's to shape (actuator pzt) it keeps its plain step, whose instant is a parameter.
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
/// Of the shaper, where no number is named.
inline constexpr std::size_t usual_impulses = 3;

class QuasiStatic {
 public:
  /// `first_touch` of the plain step [s].
  QuasiStatic(const PreparedScene& prepared, Actuator actuator, StableApproach approach, std::size_t impulses,
              double first_touch);

  [[nodiscard]] const StableApproach& approach() const { return approach_; }
  /// Drives whose waveforms this makes: the one that carries first, then the holder if there is one.
  [[nodiscard]] std::vector<std::string> drives() const;
  /// Names with their drive: "piezo.rise", "piezo.line_s".
  [[nodiscard]] const std::vector<Variable>& variables() const { return variables_; }
  [[nodiscard]] const std::vector<std::vector<double>>& starts() const { return starts_; }
  [[nodiscard]] DriveWaveforms waveforms(std::span<const double> x) const;
  /// The same with bounds about the closed form for devices that carry a steady force from `steady` on [s], where its starts are:
  /// one, and of a holder that is shaped others that stand lower.
  [[nodiscard]] QuasiStatic paced(double steady) const;

 private:
  /// How the switch is held once it is closed.
  enum class Holding {
    by_itself,  ///< the drive that carried it goes on to its hold level
    shaped,     ///< the holder's waveform is searched
    by_step,    ///< the holder's plain step comes when the contact is made
  };
  using Points = std::vector<std::pair<double, double>>;  // [s, V]

  // The holder stands at `low` before contact [V].
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
  double period_ = 0;                                                   // of mode 1 [s]
  bool is_electrode_ = false;                                           // the one that carries
  double neutral_ = 0;                                                  // its V0, see Switch::neutral_voltage() [V]
  std::vector<std::pair<double, double>> reaches_;                      // by the holder's level squared: [V^2, V]
  double hold_ = 0, before_ = 0, holder_hold_ = 0, holder_before_ = 0;  // [V]
  DriverLimits limits_, holder_limits_;
  std::vector<Variable> variables_;
  std::vector<std::vector<double>> starts_;
};

}  // namespace softland
