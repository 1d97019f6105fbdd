// A switch that is closed and opened periodically: the figures of its cycles, and the largest rate at which every cycle is like
// the first one, which starts from rest. At higher rates the beam still moves when a cycle begins, or the closing is cut short.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "objectives/cycles.h"
#include "studies/closing/prepared.h"
#include "waveforms/signal.h"

namespace softland {

/// Commanded waveforms of one cycle, one per drive of the switch. `closing` starts with the cycle, `opening` with the command
/// to open.
struct CycleWaveforms {
  std::string name;
  std::vector<Signal> closing, opening;
};

/// Returns the drive signals of many cycles: the waveforms of one cycle repeated with the period of `times`. The switch is at
/// rest before the first cycle.
[[nodiscard]] std::vector<Signal> cycled(const CycleWaveforms& waveforms, const CycleTimes& times);

struct Cycles {
  CycleTimes times;
  Status status = Status::not_run;   ///< `done` if the run reached the end of its last cycle
  std::string message = {};          ///< reason why the run ended early; empty if it did not
  std::vector<CycleFigures> cycles;  ///< figures of the completed cycles
  /// Distance of the contact point to the contact plane [m] over time [s]; only if requested.
  std::vector<std::pair<double, double>> gap = {};
  std::vector<Touch> touches = {};  ///< touches of the contact in the run; only if requested
};

/// Largest differences from the first cycle of a run with which a later cycle still counts as equal to the first one.
struct CycleTolerances {
  double share = 0.05;    ///< relative difference of the largest impact velocity and of the highest rebound
  double rebound = 1e-9;  ///< absolute difference of the highest rebound that is always permitted [m]
};

/// True if the switch closes and opens in `cycle` with the impact velocity and rebound height of the first cycle.
[[nodiscard]] bool closes_alike(const CycleFigures& cycle, const CycleFigures& first, const CycleTolerances& tolerances);

/// The cycles of one switch: the nominal design of a scene, or one of the devices of its [spread].
class CycledSwitch {
 public:
  /// Keeps references to its arguments. `driven` is the scene whose voltage sources apply the waveforms to `model`.
  CycledSwitch(const PreparedScene& driven, const Switch& model, const CycleWaveforms& waveforms);

  /// Simulates cycles. With `is_told` the result also has the contact gap over time and the touches, and its figures include
  /// the charge through the load circuit and the electrical state of the contact.
  [[nodiscard]] Cycles run(const CycleTimes& times, bool is_told, const Progress& progress = {}) const;
  /// True if the switch closes and opens in every cycle as in the first cycle. The run ends at the first cycle that differs.
  [[nodiscard]] bool is_steady(const CycleTimes& times, const CycleTolerances& tolerances, const Progress& progress = {}) const;
  /// Durations of the closing part (`on`) and the opening part (`off`) of a cycle [s]. With `rest` durations the part ends when
  /// the switch is at rest. With `least` durations it ends with its waveform, a closing not before first contact. A duration is
  /// infinite if the switch does not come to rest, or does not touch.
  struct PartTimes {
    double rest_on = std::numeric_limits<double>::infinity(), rest_off = std::numeric_limits<double>::infinity();
    double least_on = std::numeric_limits<double>::infinity(), least_off = std::numeric_limits<double>::infinity();
  };
  [[nodiscard]] PartTimes part_times(const Progress& progress = {}) const;

 private:
  // Runs cycles with an observer and ends the run when `is_enough` returns true; `is_enough` may be null.
  [[nodiscard]] Trajectory observe(const CycleTimes& times, ClosingObserver& observer, const Progress& progress,
                                   const std::function<bool()>& is_enough) const;

  const PreparedScene& driven_;
  const Switch& model_;
  const CycleWaveforms& waveforms_;
  MetricsOptions options_;
};

struct RateScan {
  struct Rate {
    double rate = 0;  ///< cycle rate, number of cycles per second [Hz]
    bool is_steady = false;
  };
  std::vector<Rate> rates;  ///< simulated cycle rates, in increasing order
  /// Largest rate up to which all cycles are like the first one (steady) at every simulated rate [Hz]; NaN if the cycles are
  /// steady at no rate.
  double largest = std::numeric_limits<double>::quiet_NaN();
  /// Ranges of rates above `largest` at which the cycles are steady again [Hz].
  std::vector<std::pair<double, double>> windows = {};
};

struct ScanOptions {
  double duty = 0.5;         ///< share of a cycle that lies before its command to open the switch
  double step = 0.05;        ///< relative step from one cycle rate of the scan to the next
  std::size_t cycles = 10;   ///< number of cycles of a run; the first is the reference for the other cycles
  bool beyond_first = true;  ///< true to continue the scan above the first rate at which the cycles are not alike
  CycleTolerances tolerances = {};
};

/// Simulates cycles at increasing rates. At the first rate every cycle begins and ends at rest; the first rate is lowered until
/// its cycles are steady. The last rate leaves just enough time for the waveforms and for first contact.
[[nodiscard]] RateScan scan_rates(const CycledSwitch& cycled, const ScanOptions& options, const Progress& progress = {});

struct CyclingOptions {
  /// Rate of the cycles to report [Hz]; none: the largest steady rate under the given waveforms.
  std::optional<double> rate = {};
  bool scans = true;  ///< false to simulate only the cycles at `rate`, without a scan of rates
  double duty = ScanOptions{}.duty;
  std::size_t cycles = ScanOptions{}.cycles;
  std::uint64_t devices = 50;  ///< number of devices of [spread] whose cycle rates are scanned as well; 0 for none
  std::uint64_t seed = 1;
  int jobs = 1;
};

/// The results of a switch that is closed and opened periodically by one pair of waveforms, for closing and opening.
struct CycledDrive {
  CycleWaveforms waveforms;
  RateScan scan;                        ///< cycle rates of the nominal design, with the rates at which its cycles are steady
  std::vector<double> of_devices = {};  ///< largest steady cycle rate of each device [Hz]; 0 if no rate is steady
  std::optional<Cycles> cycles = {};    ///< cycles of the nominal design at the rate `rate`
};

struct Cycling {
  CyclingOptions options;
  double rate = std::numeric_limits<double>::quiet_NaN();  ///< rate of the cycles in `cycles` [Hz]; NaN without cycles
  std::vector<CycledDrive> drives;                         ///< results with plain steps, then with the given waveforms
  bool interrupted = false;
};

/// Completes the waveforms of a cycle. A missing closing waveform becomes a step to the level at which the opening starts, a
/// missing opening waveform a step to 0 V.
void complete(CycleWaveforms& waveforms, const PreparedScene& given);
/// Returns a cycle of plain steps. Every drive goes at once, as fast as its voltage source permits, to the last level of its
/// closing waveform, and on the command to open to the last level of its opening waveform.
[[nodiscard]] CycleWaveforms plain_cycle(const PreparedScene& given, const CycleWaveforms& waveforms);

/// Searches the steady cycle rates of plain steps and of the given waveforms, and runs the cycles at one rate. Devices have the
/// drives of the nominal design, without errors of the sources. Throws InvalidInput for a scene without contact, and for
/// waveforms that are longer than the closing or opening part of a cycle at the requested rate.
[[nodiscard]] Cycling cycling(const PreparedScene& given, const CycleWaveforms& waveforms, const CyclingOptions& options,
                              const Progress& progress = {});

}  // namespace softland
