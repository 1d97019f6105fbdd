// Waveforms that open a closed switch and stop it in its open position. Every drive goes from its hold level to 0 V. The drives
// that the actuator may vary then give two pulses, each after a wait at 0 V, within the limits of the voltage sources in
// [driver.*].
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "optimizers/problem.h"
#include "studies/closing/actuator.h"
#include "studies/closing/prepared.h"

namespace softland {

/// Corners of a piecewise linear drive voltage: time since the command to open [s] and voltage [V].
using Corners = std::vector<std::pair<double, double>>;

class BrakePulses {
 public:
  /// Keeps a reference to `given`. `holds` are the commanded voltages before the command to open, in the order of
  /// Switch::drives() [V]. Error messages begin with `asker`, the name of the user's command. Throws InvalidRequest if the
  /// scene lacks the actuator, and InvalidInput if the voltage source of no drive of the actuator has limits.
  BrakePulses(const PreparedScene& given, Actuator actuator, std::vector<double> holds, std::string_view asker);

  [[nodiscard]] const std::vector<Variable>& variables() const { return variables_; }
  /// Returns the starting points of the search: in each, one drive brakes, by one pulse or by a push and then a braking pulse,
  /// at different times and levels. All other drives stay at 0 V.
  [[nodiscard]] std::vector<std::vector<double>> starts() const;
  /// Returns the commanded voltages at a point of the search, one list of corners per drive of the switch.
  [[nodiscard]] std::vector<Corners> commanded(std::span<const double> x) const;
  /// Returns the commanded voltages of the plain opening: every drive goes to 0 V at once, or at the slew limit of its source.
  [[nodiscard]] const std::vector<Corners>& plain() const { return plain_; }
  [[nodiscard]] const std::vector<double>& holds() const { return holds_; }

 private:
  // A drive that may brake the opening, and the index of its parameters in a point of the search.
  struct Brake {
    std::size_t drive = 0;
    // Index of the drive's first parameter in the point: duration of all edges, then wait, level and duration of every pulse.
    std::size_t first = 0;
    DriverLimits limits;
  };

  void add_brake(std::size_t drive, const std::string& name, const DriverLimits& limits);
  [[nodiscard]] std::vector<double> start(const Brake& braking, const std::array<double, 6>& pulse_train) const;
  [[nodiscard]] Corners corners(const Brake& brake, std::span<const double> x) const;

  const PreparedScene& given_;
  double period_;              // period of the switch's first mode [s]
  std::vector<double> holds_;  // hold levels by drive [V]
  std::vector<Corners> plain_;
  std::vector<Brake> brakes_;
  std::vector<Variable> variables_;
};

}  // namespace softland
