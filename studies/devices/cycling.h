// A switch that is closed and opened at a rate: the figures of its cycles, and the largest rate at which it lands as it does from
// rest. A rate is too high where the beam has not come to rest from one cycle to the next, or the closing is cut short.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/watch.h"
#include "objectives/cycles.h"
#include "studies/closing/prepared.h"
#include "waveforms/signal.h"

namespace softland {

/// What the sources are told in one cycle, one per drive of the switch: from the begin of the cycle on, and from the command to
/// open on.
struct CycleWaveforms {
  std::string name;
  std::vector<Signal> closing, opening;
};

/// The same again and again, from the rest before the first closing on.
[[nodiscard]] std::vector<Signal> cycled(const CycleWaveforms& waveforms, const CycleTimes& times);

struct Cycles {
  CycleTimes times;
  Status status = Status::not_run;   ///< done where the run came to its end
  std::string message = {};          ///< why, where it did not
  std::vector<CycleFigures> cycles;  ///< those that ended
  /// Position of the contact point: time [s] and distance to the contact plane [m]; where it was asked for.
  std::vector<std::pair<double, double>> gap = {};
  std::vector<Touch> touches = {};  ///< those of the course
};

/// What a cycle may differ by from the first one.
struct CycleTolerances {
  double share = 0.05;    ///< what the largest impact velocity and the highest rebound may differ by
  double rebound = 1e-9;  ///< what the highest rebound may always differ by [m]
};

/// Whether a cycle closes and opens, and lands as the first one does.
[[nodiscard]] bool lands_alike(const CycleFigures& cycle, const CycleFigures& first, const CycleTolerances& tolerances);

/// The cycles of one switch, of a scene or of one of its devices.
class CycledSwitch {
 public:
  /// Keeps references. `driven`: the scene whose sources give the waveforms.
  CycledSwitch(const PreparedScene& driven, const Switch& model, const CycleWaveforms& waveforms);

  /// Runs cycles; asked to, keeps the course.
  [[nodiscard]] Cycles run(const CycleTimes& times, bool keeps_gap, const Watch& watch = {}) const;
  /// Whether all of these cycles land like the first one: given up at the first that does not.
  [[nodiscard]] bool is_steady(const CycleTimes& times, const CycleTolerances& tolerances, const Watch& watch = {}) const;
  /// What a cycle needs for its closing and for its opening [s]: to come to rest, in windows that show it, and at the least,
  /// until the first touch or the end of the waveform. Infinite where it does not.
  struct PartTimes {
    double rest_on = std::numeric_limits<double>::infinity(), rest_off = std::numeric_limits<double>::infinity();
    double least_on = std::numeric_limits<double>::infinity(), least_off = std::numeric_limits<double>::infinity();
  };
  [[nodiscard]] PartTimes part_times(const Watch& watch = {}) const;

 private:
  // `is_enough` ends the run; may be null.
  [[nodiscard]] Trajectory observe(const CycleTimes& times, ClosingObserver& observer, const Watch& watch,
                                   const std::function<bool()>& is_enough) const;

  const PreparedScene& driven_;
  const Switch& model_;
  const CycleWaveforms& waveforms_;
  MetricsOptions options_;
};

struct RateScan {
  struct Rate {
    double rate = 0;  ///< [Hz]
    bool is_steady = false;
  };
  std::vector<Rate> rates;  ///< that were tried, in rising order
  /// The largest below which every rate of the scan is steady [Hz]; NaN where there is none.
  double largest = std::numeric_limits<double>::quiet_NaN();
  /// Ranges of steady rates above it [Hz].
  std::vector<std::pair<double, double>> windows = {};
};

struct ScanOptions {
  double duty = 0.5;         ///< share of a cycle before its command to open
  double step = 0.05;        ///< from one rate to the next
  std::size_t cycles = 10;   ///< all but the first are compared with it
  bool beyond_first = true;  ///< goes on above the first rate that is not steady
  CycleTolerances tolerances = {};
};

/// Tries rates, from one at which every cycle begins and ends at rest, or lower where that is not steady, up to that at which no
/// waveform fits in.
[[nodiscard]] RateScan scan_rates(const CycledSwitch& cycled, const ScanOptions& options, const Watch& watch = {});

struct CyclingOptions {
  std::optional<double> rate = {};  ///< whose cycles are told [Hz]; none: the largest found for the last waveforms
  bool scans = true;                ///< else the cycles at that rate are all
  double duty = ScanOptions{}.duty;
  std::size_t cycles = ScanOptions{}.cycles;
  std::uint64_t devices = 50;  ///< so many of [spread] are scanned too; 0: none
  std::uint64_t seed = 1;
  int jobs = 1;
};

/// A switch that is cycled by one pair of waveforms.
struct CycledDrive {
  CycleWaveforms waveforms;
  RateScan scan;                        ///< rates of the nominal design
  std::vector<double> of_devices = {};  ///< RateScan::largest of each device, 0 where there is none [Hz]
  std::optional<Cycles> cycles = {};    ///< the nominal design at the rate that is told
};

struct Cycling {
  CyclingOptions options;
  double rate = std::numeric_limits<double>::quiet_NaN();  ///< whose cycles are told [Hz]; NaN: none
  std::vector<CycledDrive> drives;                         ///< the plain one first, alone where it is what was given
  bool interrupted = false;
};

/// What waveforms lack: every drive goes at once to where the opening begins, or to 0 V.
void complete(CycleWaveforms& waveforms, const PreparedScene& given);
/// Every drive goes to its last level of the closing at once, as fast as its driver can, and to that of the opening on command.
[[nodiscard]] CycleWaveforms plain_cycle(const PreparedScene& given, const CycleWaveforms& waveforms);

/// Scans the rates of the plain waveforms and of these, and runs the cycles at one rate. Devices are driven as the nominal design
/// is, by sources that do not err. Throws InvalidInput for a scene without contact, and where waveforms are longer than their
/// part of a cycle at the rate that is asked for.
[[nodiscard]] Cycling cycling(const PreparedScene& given, const CycleWaveforms& waveforms, const CyclingOptions& options,
                              const Watch& watch = {});

}  // namespace softland
