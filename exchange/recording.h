// A recording of an instrument or a simulator: a time axis and channels of numbers with names and units.
//
// The reader takes columns of numbers as oscilloscopes, loggers and spreadsheets write them (any separator and decimal sign,
// lines above the numbers, a row of units, rows instead of columns). It takes sources of SPICE (PWL), value change dumps (VCD),
// and data sets 58 and 58b of the Universal File Format. Nothing is guessed in silence: the recording lists what was left out.
// Text that can be read in two ways is refused with the key that decides.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace softland {

/// The facts about a file that the user supplies because the file lacks them.
struct ReadKeys {
  std::string column = {};              ///< name of the channel; empty: the only one
  int column_number = 0;                ///< the same by its place among all columns, from 1; 0: by name
  std::string time_column = {};         ///< name of the column of times; empty: found by its heading
  int time_column_number = 0;           ///< the same by its place, from 1; 0: by name
  int skip = 0;                         ///< lines at the beginning that are not looked at
  std::string unit = {};                ///< unit of the channel, such as "mV"; empty: the file's, or else V
  std::string time_unit = {};           ///< unit of the times; empty: the file's, or else s
  char decimal = '\0';                  ///< '.' or ','; '\0': found
  std::optional<double> interval = {};  ///< interval between rows, which are even, whatever the times are [s]
  bool uneven = false;                  ///< times are taken as they stand; rows of one time are a jump
};

/// The numbers that a column of a file lacks.
struct Missing {
  std::size_t count = 0;
  std::size_t line = 0;       ///< line of the first one
  bool is_overrange = false;  ///< true if the first one is infinite or not a number, rather than blank
};

struct Channel {
  std::string name;     ///< name as in the file, without the unit; "column 2" where it has none
  std::string heading;  ///< the whole heading
  std::string unit;     ///< usual symbol, "V", "mV"; empty where the file names none
  bool is_voltage = false;
  bool is_state = false;       ///< 0 or 1, of logic or of a contact: a number without a unit
  double per_si = 1;           ///< number of units that make one SI unit
  int column = 0;              ///< number in the file, from 1
  std::vector<double> values;  ///< [unit], one per row; NaN where it is missing
  Missing missing = {};
};

struct Recording {
  std::string file;
  std::string format;
  std::vector<double> times = {};  ///< [s], one per row; empty where the file has none and says no interval
  bool has_times = false;          ///< the times stand in the file, rather than follow from the interval
  bool times_have_unit = false;
  double last_digit = 0;                  ///< last digit of the times in the file [s]
  std::optional<double> interval = {};    ///< interval that the file states beside the times [s]
  bool is_breakpoints = false;            ///< the rows are corners of straight lines: uneven, and two of one time are a jump
  std::vector<std::uint32_t> lines = {};  ///< line of each row
  std::vector<Channel> channels = {};
  std::vector<std::string> left_out = {};
  std::vector<std::string> notes = {};  ///< remarks on what was taken

  [[nodiscard]] std::size_t rows() const { return channels.empty() ? 0 : channels.front().values.size(); }
  /// "scope.csv:17"
  [[nodiscard]] std::string place(std::size_t row) const;
};

/// The channel that the keys name; or else the only one; or else the one called `usual`. Throws InvalidInput with the names there
/// are.
[[nodiscard]] const Channel& channel_of(const Recording& recording, const ReadKeys& keys, const std::string& usual);

/// Reads a file. Throws InvalidInput with file, line, column and rule for what cannot be read, for what is no record over time (a
/// spectrum, rows of logic states, a mesh), and for what can be read in two ways.
[[nodiscard]] Recording read_recording(const std::string& file, const ReadKeys& keys = {});
/// The same for the content of a file; `file` stands for it in messages.
[[nodiscard]] Recording parse_recording(std::string_view content, const std::string& file, const ReadKeys& keys = {});

/// A look at the times of a recording.
struct TimeAxis {
  double first = std::numeric_limits<double>::quiet_NaN();     ///< [s]
  double last = std::numeric_limits<double>::quiet_NaN();      ///< [s]
  double interval = std::numeric_limits<double>::quiet_NaN();  ///< interval that the file says, or else the mean [s]
  std::size_t repeated = 0;                                    ///< rows of the same time as the row above
  std::optional<std::size_t> back = {};                        ///< the first row that is before the one above
};
[[nodiscard]] TimeAxis time_axis(const Recording& recording);

/// One line: format, channels, samples, interval, first and last time, what was left out.
[[nodiscard]] std::string summary(const Recording& recording);

}  // namespace softland
