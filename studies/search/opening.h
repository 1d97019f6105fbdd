// The search for a waveform that opens a closed switch and leaves little vibration: the other half of a switching cycle.
//
// The switch rests on its contact under the scene's hold levels until t = 0. The plain opening takes every drive to 0 V at
// once, or as fast as its source can. A beam with little damping then swings about its open position by the contact gap, until
// the gas has damped the vibration. The search brakes the beam. Every drive that the actuator may vary gives two pulses, each
// after a wait at 0 V, within the limits of [driver.*], and then stays at 0 V. One pulse brings an undamped plate under a
// constant pull to rest (Pontryagin; the time reversal of bang_bang.h). The second pulse is for the remaining modes.
//
// The cost is the residual vibration over the contact gap, plus five times the vibration's excess over the band about the open
// position, plus 0.3 times the time until the switch stays open, in periods of its first mode. The best waveform is verified by
// a simulation over the scene's whole simulated time at its accuracy, and confirmed with a tighter integrator and with two more
// modes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "model/trajectory.h"
#include "objectives/opening.h"
#include "optimizers/problem.h"
#include "studies/closing/actuator.h"
#include "studies/closing/prepared.h"
#include "studies/search/search_space.h"

namespace softland {

/// Corners of a piecewise linear drive voltage: time since the command to open [s] and voltage [V].
using Corners = std::vector<std::pair<double, double>>;

/// Waveforms that open a closed switch and stop it in its open position: every drive goes from its hold level to 0 V, and the
/// drives that the actuator may vary then give their pulses.
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

struct OpeningOptions {
  Actuator actuator = Actuator::electrostatic;  ///< drives whose waveforms may brake the beam
  double band = 0.05;  ///< largest distance of an open switch from its open position, as a share of the contact gap
  long max_evaluations = 3000;
  std::uint64_t seed = 1;
  int jobs = 1;
  std::uint64_t devices = 200;  ///< number of varied devices on which the waveform is simulated; 0: none
};

/// A simulated opening, under one signal per drive of the switch.
struct Opening {
  std::vector<Signal> signals = {};
  /// Time of the last change of a drive, from which on all drives are at 0 V [s].
  double voltages_end = std::numeric_limits<double>::quiet_NaN();
  Trajectory trajectory;
  OpeningFigures figures;
};

struct ConfirmingOpening {
  std::string name;  ///< changed setting in a simulation that confirms the best opening: "tolerance 1e-9", "6 modes"
  OpeningFigures figures;
};

/// Openings of varied devices, with the scene's spread or the assumed spread (config/assumed_spread.h), and without errors of
/// the voltage sources. All devices get the voltages of the nominal device. The figures of a device that does not stay open are
/// infinite.
struct DeviceOpenings {
  double open = 0;     ///< share of devices that open, and stay near the open position until the end
  double in_band = 0;  ///< share of devices that stay within the band about the open position from when all drives are at 0 V
  /// 95th percentiles of settling time [s], residual vibration [m] and overshoot [m].
  double settling_time = 0, residual_vibration = 0, overshoot = 0;
};
struct OpeningsOnDevices {
  std::uint64_t devices = 0;  ///< number of devices whose parameters are valid and that are closed under the hold levels
  bool spread_assumed = false;
  DeviceSpread spread = {};  ///< process variation (spread) of the devices
  DeviceOpenings plain, best;
};

/// Least relative reduction of the settling time or of the residual vibration for which an opening waveform is recommended.
inline constexpr double least_gain = 0.05;
/// Returns true if the opening `a` gains over `b`: it settles earlier near the open position by `least_gain`, or, if neither
/// settles, leaves less vibration by `least_gain`. An opening that settles gains over one that does not.
[[nodiscard]] bool gains(const OpeningFigures& a, const OpeningFigures& b);

struct OpeningResult {
  PreparedScene given;
  OpeningOptions options;
  double open_position = 0;  ///< position of the contact point with all drives at 0 V [m]
  /// Half width of the band about the open position in which the switch counts as at rest [m].
  double band = 0;
  double contact_force = 0;   ///< contact force that holds the switch closed before t = 0 [N]
  double window = 0;          ///< simulated time after the command to open [s]
  std::vector<double> holds;  ///< hold levels of the drives before t = 0 [V]
  Opening plain;
  std::optional<Opening> best;               ///< opening by the best waveform; none if no waveform opens the switch
  std::map<std::string, double> parameters;  ///< parameters of the best opening waveform, by drive.name
  /// Scene with the commanded waveforms of the best opening, from the hold levels on, in volts; of the plain opening if there
  /// is no best opening.
  std::optional<SceneFile> scene;
  std::vector<ConfirmingOpening> checks;
  /// Figures of the openings of varied devices; none if not requested, or if no waveform opens the switch.
  std::optional<OpeningsOnDevices> on_devices;
  OptimizerResult search;
  bool better = false;  ///< true if gains() holds for the best opening against the plain one
  /// True if the best opening stays within the band about the open position from when all drives are at 0 V.
  bool goal_met = false;
  bool confirmed = false;  ///< true if the simulations `checks` confirm the best opening
  bool interrupted = false;
};

/// Searches an opening waveform. Throws InvalidInput for a scene without contact, or without an open or a closed equilibrium
/// under its hold levels, for an actuator that the scene lacks or whose drives have no limits, and for options out of range.
/// Throws Interrupted before the first result. Numerical failures are reported in the result.
[[nodiscard]] OpeningResult search_opening(const SceneFile& file, const OpeningOptions& options, const Progress& progress = {});

}  // namespace softland
