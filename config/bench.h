// A file of measurements, bench.toml: values measured on fabricated devices of a scene, and their measurement errors.
//
//   [[measurement]]
//   quantity = "closing_time"        # pull_in, release, frequency, capacitance, closing_time, contact, position or velocity
//   drive = "main"                   # driven electrode or piezo; not needed if the scene has one electrode
//   level = "22 V"                   # commanded voltage, for a closing time, a capacitance, or a frequency under voltage
//   waveform = "drive.csv"           # instead of a level: time_s and a column for each drive; "scene": waveform of the scene
//   value = "38.2 us"                # one number, or a list of repeated measurements
//   file = "times.csv"               # instead of a value: file of rows, with a header line
//   error = "50 ns"                  # one standard deviation, absolute or a percentage of the value
//   mode = 1                         # number of the mode, for a frequency
//   until = "60 us"                  # for a position or velocity: rows after this time are skipped
//   edges = 1                        # for a contact: number of its first closings and openings that are used, 1 to 3
//   device = "A7"                    # measured device; measurements without this key belong to one device
//
//   [device.A7]
//   set = ["gap.electrode=3.4 um"]   # known differences of this device from the scene
//
// A CSV file of measured rows has a column of values, and one of levels or of times. The names of the columns begin with the
// quantity, with "level" or "voltage", and with "time". They end in the unit: "closing_time_us", "capacitance [fF]", "time_s".
// The column of a contact is "contact", 0 for open and 1 for closed. Contact, position and velocity are also read from the
// files of instruments (exchange/recording.h), by the keys of a waveform's file (column, time_column, interval, skip,
// time_unit, decimal, shift) and
//
//   unit = "mm/s"                    # unit of a position or velocity, if the file names none, or
//   per_volt = "50 mm/s"             # size of one volt of the channel
//   threshold = "1.5 V"              # for a contact: it is closed where the voltage is above the threshold
//   closed = "below"                 # or where the voltage is below
//   hysteresis = "0.2 V"             # width of a band about the threshold that a change of state must cross
//   merge = "100 ns"                 # shorter states are ignored
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/units.h"
#include "exchange/level_edges.h"

namespace softland {

/// A quantity that a file of measurements may hold, with its dimension and the keys that its [[measurement]] may have.
struct BenchQuantity {
  std::string_view name;
  Dimension dimension;
  bool has_level = false;     ///< true when a measurement of this quantity may have a level (a commanded voltage)
  bool has_waveform = false;  ///< true when a measurement may have a drive waveform instead of a level (a voltage step)
  bool is_over_time = false;  ///< true when the quantity is recorded against time
  bool is_positive = true;    ///< true when measured values of the quantity must be above 0
};

/// Name of the quantity whose measurement is the state of the contact, open or closed, against time.
inline constexpr std::string_view of_contact = "contact";

struct BenchMeasurement {
  std::string quantity;                 ///< name of the measured quantity, one of bench_quantities()
  std::string drive = {};               ///< name of the driven electrode or piezo; empty if the file does not name it
  std::string device = {};              ///< name of the measured device; empty if the file does not name it
  std::vector<double> values = {};      ///< measured values [SI unit]; for a contact, times of its first closings and openings
  std::vector<double> errors = {};      ///< standard deviation of each value [SI unit]
  std::vector<double> levels = {};      ///< commanded voltage of each measured value [V]; empty if the file names none
  std::vector<double> times = {};       ///< time of each measured value of a quantity over time [s]
  bool has_end = false;                 ///< true when rows after the time of the key `until` were removed
  std::optional<std::string> waveform;  ///< source of the drive waveform: "scene", or the path of a file
  int mode = 1;
  std::string place = {};  ///< place of the measurement for messages: "bench.toml:12"
};

struct Bench {
  std::string name;
  std::vector<BenchMeasurement> measurements;
  /// The known differences of each named device from the scene: assignments to keys, such as "gap.electrode=3.4 um".
  std::map<std::string, std::vector<std::string>> changes;
};

[[nodiscard]] const std::vector<BenchQuantity>& bench_quantities();

/// Reads assignments such as `threshold=1.5 V`, which state at which recorded voltage a contact is closed. The keys are those
/// of a contact in a file of measurements. Throws InvalidInput with the option `--contact`, the value and the rule.
[[nodiscard]] ContactTraceKeys contact_trace_keys(const std::vector<std::string>& assignments);

/// Reads a file of measurements. Throws InvalidInput with file, line, key, value and rule.
[[nodiscard]] Bench load_bench(const std::filesystem::path& path);
/// Reads the text of a file of measurements. `name` is the name of the file in messages; paths in the text are relative to
/// `directory`.
[[nodiscard]] Bench parse_bench(std::string_view text, const std::string& name, const std::filesystem::path& directory = ".");

}  // namespace softland
