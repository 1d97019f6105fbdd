// The quasi-static approach: waveforms that move the switch to its contact slowly, through stable equilibria, so that every
// device touches softly, and that keep the switch closed afterwards. The carrying drive moves the beam to its contact. The
// holder is the electrode that keeps the switch closed, if the carrying drive does not.
//
//   rise    The carrying drive goes to a voltage at which hardly a device touches, without vibration: a ramp of one period T of
//           mode 1 passes an input shaper of N impulses half a period apart, whose weights are binomial.
//   line    The carrying drive goes on through the voltages at which devices touch, at a constant rate. If N > 2, this ramp
//           passes the shaper, too.
//   hold    The holder stays at a low level until the contact is made, and rises to its hold level. Then the carrying drive
//           returns to its own hold level. Without a holder, the carrying drive goes on to its hold level.
//
// Ramps are linear in the quantity that drives the beam: the volts of a piezo, the square of an electrode's volts if it
// carries the switch. With two impulses (ZV) the rise takes 1.5 T, and devices whose frequencies differ by 3.5 % keep 0.7 % of
// the rise as vibration. With three (ZVD) the rise takes 2 T and leaves 0.07 %.
//
// Levels of the carrying drive are shares of the voltage at which the nominal design touches while the holder is at its low
// level, so that the search varies the levels of both drives independently. One point of the search gives the waveforms of all
// drives. If the search does not vary the electrode (actuator pzt), the holder keeps its plain step, whose instant is a
// parameter.
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
/// Default number of impulses of the input shaper, which filters the ramps of the waveform.
inline constexpr std::size_t usual_impulses = 3;

class QuasiStatic {
 public:
  /// `first_touch` is the time of the first contact under the plain step [s].
  QuasiStatic(const PreparedScene& prepared, Actuator actuator, StableApproach approach, std::size_t impulses,
              double first_touch);

  [[nodiscard]] const StableApproach& approach() const { return approach_; }
  /// Returns the names of the drives in waveforms(): the drive that moves the switch to its contact, then the electrode that
  /// holds the closed switch, if that is another drive.
  [[nodiscard]] std::vector<std::string> drives() const;
  /// Returns the searched parameters; their names begin with the drive: "piezo.rise", "piezo.line_s".
  [[nodiscard]] const std::vector<Variable>& variables() const { return variables_; }
  [[nodiscard]] const std::vector<std::vector<double>>& starts() const { return starts_; }
  [[nodiscard]] DriveWaveforms waveforms(std::span<const double> x) const;
  /// Returns the quasi-static approach with bounds about its closed-form waveforms, under which devices carry a steady contact
  /// force from `steady` on [s]. The search starts at the closed form, and, if the waveform of the holding electrode is
  /// searched, also at lower levels of this electrode.
  [[nodiscard]] QuasiStatic paced(double steady) const;

 private:
  /// How the switch is kept closed after contact.
  enum class Holding {
    by_itself,  ///< the drive that carries the switch to its contact goes on to its hold level
    shaped,     ///< the waveform of the electrode that holds the closed switch is searched
    by_step,    ///< the plain step of the electrode that holds the closed switch comes after the contact is made
  };
  using Points = std::vector<std::pair<double, double>>;  // corners of a waveform: time [s] and voltage [V]

  // Returns the waveform parameters as for paced(). `low` is the level before contact of the holding electrode [V].
  [[nodiscard]] std::vector<double> closed_form(double steady, double low) const;
  void clamp_starts();
  void bound(const std::vector<double>& start, bool is_paced);
  [[nodiscard]] Waveform carrying(Points points) const;
  /// Returns the voltage of the carrying drive at which the nominal design makes contact while the holding electrode is at
  /// `low` [V].
  [[nodiscard]] double reaches(double low) const;
  /// Returns the voltage of the carrying drive that is `deviations` standard deviations over devices above the voltage at which
  /// contact is made, as a share of the latter, within the limit of the voltage source.
  [[nodiscard]] double share(double deviations) const;

  StableApproach approach_;
  Holding holding_ = Holding::by_itself;
  std::size_t impulses_;
  double period_ = 0;          // period of the first mode [s]
  bool is_electrode_ = false;  // true if the drive that carries the switch to its contact is an electrode
  double neutral_ = 0;         // voltage without force of the drive that carries the switch [V], see Switch::neutral_voltage()
  // Pairs: square of the holding electrode's level [V^2], and voltage of the carrying drive at which contact is then made [V].
  std::vector<std::pair<double, double>> reaches_;
  // Hold level and level before t = 0 [V]: of the drive that carries the switch to its contact, and of the holding electrode.
  double hold_ = 0, before_ = 0, holder_hold_ = 0, holder_before_ = 0;
  DriverLimits limits_, holder_limits_;
  std::vector<Variable> variables_;
  std::vector<std::vector<double>> starts_;
};

}  // namespace softland
