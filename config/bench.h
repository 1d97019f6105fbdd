// A file of measurements, bench.toml: what was measured on devices of a scene, and how well.
//
//   [[measurement]]
//   quantity = "closing_time"        # pull_in, release, frequency, capacitance, closing_time, contact, position or velocity
//   drive = "main"                   # which one; not needed where the scene has one electrode
//   level = "22 V"                   # told by the source: of a closing time, a capacitance, a resonance under voltage
//   waveform = "drive.csv"           # instead of a level: time_s and a column for each drive, or "scene" for that of the scene
//   value = "38.2 us"                # one number, or a list of them that were measured alike
//   file = "times.csv"               # instead of a value: rows, with a header line
//   error = "50 ns"                  # one standard deviation, absolute or a percentage of the value
//   mode = 1                         # of a resonance
//   until = "60 us"                  # of a position or velocity: rows after it are left out
//   edges = 1                        # of a contact record: how many edges count from the first touch on, 1 to 3
//   device = "A7"                    # which device; all measurements without one are of one device
//
//   [device.A7]
//   set = ["gap.electrode=3.4 um"]   # what is known to be different of this device
//
// A file of our own has the columns VALUE, LEVEL (voltage, level) or TIME (time): their names begin with the quantity, with
// "level" or "voltage", and with "time", and end in the unit: "closing_time_us", "capacitance [fF]", "time_s". Of a contact
// record the column is "contact", 0 open and 1 closed. Contact, position and velocity are read from the files of instruments as
// well (exchange/recording.h), by the keys of a waveform's file (column, time_column, interval, skip, time_unit, decimal, shift)
// and
//
//   unit = "mm/s"                    # of a position or velocity, where the file names none, or
//   per_volt = "50 mm/s"             # what one volt of it stands for
//   threshold = "1.5 V"              # of a contact: closed where the voltage is above
//   closed = "below"                 # or below
//   hysteresis = "0.2 V"             # about the threshold
//   merge = "100 ns"                 # states that last for less are none
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

/// What a quantity of a bench file is measured in, and what else it has.
struct BenchQuantity {
  std::string_view name;
  Dimension dimension;
  bool has_level = false;     ///< may have one
  bool has_waveform = false;  ///< may have one instead
  bool is_over_time = false;  ///< rows of time
  bool is_positive = true;    ///< can only be above 0
};

struct BenchMeasurement {
  std::string quantity;                 ///< of bench_quantities()
  std::string drive = {};               ///< empty: not said
  std::string device = {};              ///< empty: not said
  std::vector<double> values = {};      ///< [SI unit]
  std::vector<double> errors = {};      ///< of each, one standard deviation [SI unit]
  std::vector<double> levels = {};      ///< of each [V]; empty: none is given
  std::vector<double> times = {};       ///< of each, of what is over time [s]
  bool has_end = false;                 ///< it was said up to when rows count
  std::optional<std::string> waveform;  ///< "scene", or a path
  int mode = 1;
  std::string place = {};  ///< "bench.toml:12", for messages
};

struct Bench {
  std::string name;
  std::vector<BenchMeasurement> measurements;
  std::map<std::string, std::vector<std::string>> changes;  ///< by device: assignments as --set takes them
};

[[nodiscard]] const std::vector<BenchQuantity>& bench_quantities();

/// Of assignments KEY=VALUE, such as `threshold=1.5 V`: how the voltage of a contact is read, by the keys above. Throws
/// InvalidInput with the option `--contact`, the value and the rule.
[[nodiscard]] ContactTraceKeys contact_trace_keys(const std::vector<std::string>& assignments);

/// Throws InvalidInput with file, line, key, value and rule.
[[nodiscard]] Bench load_bench(const std::filesystem::path& path);
/// `name` stands for the text in messages, paths in it are relative to `directory`.
[[nodiscard]] Bench parse_bench(std::string_view text, const std::string& name, const std::filesystem::path& directory = ".");

}  // namespace softland
