// A switch that is closed and opened at a rate: the figures of its cycles, and the largest rate at which it lands as it does
// from rest. A rate is too high if the beam has not come to rest from one cycle to the next, or if the closing is cut short.
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

/// Commanded waveforms of one cycle, one per drive of the switch: `closing` from the begin of the cycle on, `opening` from the
/// command to open on.
struct CycleWaveforms {
  std::string name;
  std::vector<Signal> closing, opening;
};

/// Repeats the waveforms, from the rest before the first closing on.
[[nodiscard]] std::vector<Signal> cycled(const CycleWaveforms& waveforms, const CycleTimes& times);

struct Cycles {
  CycleTimes times;
  Status status = Status::not_run;   ///< done if the run came to its end
  std::string message = {};          ///< reason if it did not
  std::vector<CycleFigures> cycles;  ///< completed cycles
  /// Position of the contact point: time [s] and distance to the contact plane [m]; on request.
  std::vector<std::pair<double, double>> gap = {};
  std::vector<Touch> touches = {};  ///< those of the course
};

/// Permitted differences of a cycle from the first one.
struct CycleTolerances {
  double share = 0.05;    ///< relative difference of the largest impact velocity and the highest rebound
  double rebound = 1e-9;  ///< difference of the highest rebound that never counts [m]
};

/// True if a cycle closes and opens, and lands as the first one does.
[[nodiscard]] bool lands_alike(const CycleFigures& cycle, const CycleFigures& first, const CycleTolerances& tolerances);

/// The cycles of one switch, that of a scene or of one of its devices.
class CycledSwitch {
 public:
  /// Keeps references. `driven` is the scene whose sources give the waveforms.
  CycledSwitch(const PreparedScene& driven, const Switch& model, const CycleWaveforms& waveforms);

  /// Runs cycles. If `is_told` is true, it keeps their course, and they have the figures of a load and of the electrical state.
  [[nodiscard]] Cycles run(const CycleTimes& times, bool is_told, const Watch& watch = {}) const;
  /// True if all of these cycles land like the first one; ends at the first that does not.
  [[nodiscard]] bool is_steady(const CycleTimes& times, const CycleTolerances& tolerances, const Watch& watch = {}) const;
  /// Times that a cycle needs for its closing and for its opening [s]. `rest` is the time to come to rest, in windows that show
  /// it; `least` is that until the first touch or the end of the waveform. Infinite if it does not get there.
  struct PartTimes {
    double rest_on = std::numeric_limits<double>::infinity(), rest_off = std::numeric_limits<double>::infinity();
    double least_on = std::numeric_limits<double>::infinity(), least_off = std::numeric_limits<double>::infinity();
  };
  [[nodiscard]] PartTimes part_times(const Watch& watch = {}) const;

 private:
  // `is_enough` returns true to end the run; may be null.
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
  std::vector<Rate> rates;  ///< tried rates, in rising order
  /// The largest rate below which every rate of the scan is steady [Hz]; NaN if no rate is.
  double largest = std::numeric_limits<double>::quiet_NaN();
  /// Ranges of steady rates above it [Hz].
  std::vector<std::pair<double, double>> windows = {};
};

struct ScanOptions {
  double duty = 0.5;         ///< share of a cycle before its command to open
  double step = 0.05;        ///< relative step from one rate to the next
  std::size_t cycles = 10;   ///< all but the first are compared with it
  bool beyond_first = true;  ///< continues above the first rate that is not steady
  CycleTolerances tolerances = {};
};

/// Scans rates. At the first one every cycle begins and ends at rest; it is lowered if it is not steady. At the last one a part
/// of the cycle becomes too short for its waveform.
[[nodiscard]] RateScan scan_rates(const CycledSwitch& cycled, const ScanOptions& options, const Watch& watch = {});

struct CyclingOptions {
  std::optional<double> rate = {};  ///< rate of the reported cycles [Hz]; none: the largest found for the last waveforms
  bool scans = true;                ///< false: only the cycles at that rate
  double duty = ScanOptions{}.duty;
  std::size_t cycles = ScanOptions{}.cycles;
  std::uint64_t devices = 50;  ///< number of devices of [spread] that are scanned too; 0: none
  std::uint64_t seed = 1;
  int jobs = 1;
};

/// A switch that is cycled by one pair of waveforms.
struct CycledDrive {
  CycleWaveforms waveforms;
  RateScan scan;                        ///< rates of the nominal design
  std::vector<double> of_devices = {};  ///< RateScan::largest of each device, 0 if none [Hz]
  std::optional<Cycles> cycles = {};    ///< cycles of the nominal design at the reported rate
};

struct Cycling {
  CyclingOptions options;
  double rate = std::numeric_limits<double>::quiet_NaN();  ///< rate of the reported cycles [Hz]; NaN: none
  std::vector<CycledDrive> drives;                         ///< the plain one first, alone if no other waveforms were given
  bool interrupted = false;
};

/// Adds missing waveforms: every drive goes at once to the begin of the opening, or to 0 V.
void complete(CycleWaveforms& waveforms, const PreparedScene& given);
/// Returns the plain cycle: every drive goes to its last level of the closing at once, as fast as its driver can, and to that
/// of the opening on command.
[[nodiscard]] CycleWaveforms plain_cycle(const PreparedScene& given, const CycleWaveforms& waveforms);

/// Scans the rates of the plain waveforms and of these, and runs the cycles at one rate. Devices have the drives of the nominal
/// design, without errors of the sources. Throws InvalidInput for a scene without contact, and for waveforms that are longer
/// than their part of a cycle at the requested rate.
[[nodiscard]] Cycling cycling(const PreparedScene& given, const CycleWaveforms& waveforms, const CyclingOptions& options,
                              const Watch& watch = {});

}  // namespace softland
