// Waveforms that open a closed switch and stop it in its open position: from its hold level every drive goes to 0 V, and those
// that the actuator may shape give two pulses after that, each after a wait at 0 V, within the limits of [driver.*].
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

/// Corners of a voltage: time since the command to open [s] and voltage [V].
using Corners = std::vector<std::pair<double, double>>;

class BrakePulses {
 public:
  /// Keeps a reference. `holds`: what the drives are told at the command, in the order of the switch [V]; `asker` begins the
  /// messages. Throws InvalidRequest where the scene lacks the actuator, InvalidInput where none of its drives has limits.
  BrakePulses(const PreparedScene& given, Actuator actuator, std::vector<double> holds, std::string_view asker);

  [[nodiscard]] const std::vector<Variable>& variables() const { return variables_; }
  /// One drive brakes while the others stay at 0 V: by one pulse, or pushes first and brakes then, at different times and levels.
  [[nodiscard]] std::vector<std::vector<double>> starts() const;
  /// What the drives are told at a point, one per drive of the switch.
  [[nodiscard]] std::vector<Corners> told(std::span<const double> x) const;
  /// Every drive goes to 0 V at once, or as fast as its driver can.
  [[nodiscard]] const std::vector<Corners>& plain() const { return plain_; }
  [[nodiscard]] const std::vector<double>& holds() const { return holds_; }

 private:
  // A drive that may brake, and its parameters among those of a point.
  struct Brake {
    std::size_t drive = 0;
    std::size_t first = 0;  // of its parameters: edge, then wait, level, duration of every pulse
    DriverLimits limits;
  };

  void add_brake(std::size_t drive, const std::string& name, const DriverLimits& limits);
  [[nodiscard]] std::vector<double> start(const Brake& braking, const std::array<double, 6>& pulse_train) const;
  [[nodiscard]] Corners corners(const Brake& brake, std::span<const double> x) const;

  const PreparedScene& given_;
  double period_;              // of the first mode [s]
  std::vector<double> holds_;  // [V]
  std::vector<Corners> plain_;
  std::vector<Brake> brakes_;
  std::vector<Variable> variables_;
};

}  // namespace softland
