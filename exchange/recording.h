// Reads a recording of an instrument or a simulator: a time axis, and channels of numbers with names and units.
//
// The reader takes columns of numbers as oscilloscopes, loggers and spreadsheets write them (any separator and decimal sign,
// lines above the numbers, a row of units, channels as rows instead of columns). It takes sources of SPICE (PWL), value change
// dumps (VCD), and data sets 58 and 58b of the Universal File Format. The recording lists what was assumed and what was left
// out. An ambiguous file is refused; the message names the key that the user must give.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace softland {

/// The facts about a recorded file that the user supplies because the file lacks them.
struct ReadKeys {
  std::string column = {};              ///< name of the channel to read; empty: see channel_of()
  int column_number = 0;                ///< number of the channel's column, from 1; 0: selected by name
  std::string time_column = {};         ///< name of the column of times; empty: found by its heading
  int time_column_number = 0;           ///< number of the column of times, from 1; 0: selected by name
  int skip = 0;                         ///< number of lines at the beginning of the file that are skipped
  std::string unit = {};                ///< unit of the channel, such as "mV"; empty: the unit in the file, or else V
  std::string time_unit = {};           ///< unit of the times; empty: the unit in the file, or else s
  char decimal = '\0';                  ///< decimal sign of the file, '.' or ','; '\0': found from the numbers
  std::optional<double> interval = {};  ///< interval between rows, which replaces the times of the file [s]
  bool uneven = false;                  ///< true: do not replace the times by even ones; two rows of equal time mean a jump
};

/// The missing numbers in a column of a recording: line of the first, and kind.
struct Missing {
  std::size_t count = 0;
  std::size_t line = 0;       ///< line of the first missing number in the file
  bool is_overrange = false;  ///< true if the first missing number is written as infinite or not a number, instead of blank
};

struct Channel {
  std::string name;     ///< name of the channel as in the file, without the unit; "column 2" where it has none
  std::string heading;  ///< whole heading of the channel's column
  std::string unit;     ///< unit of the channel, as "V" or "mV"; empty where the file names none
  bool is_voltage = false;
  bool is_state = false;       ///< true for a channel of states 0 and 1 (of a logic signal or a contact)
  double per_si = 1;           ///< number of the channel's unit in one SI unit: 1000 for mV
  int column = 0;              ///< number of the channel's column in the file, from 1
  std::vector<double> values;  ///< values of the channel, one per row, in its unit; NaN where missing
  Missing missing = {};
};

struct Recording {
  std::string file;
  std::string format;
  std::vector<double> times = {};  ///< times of the rows [s]; empty if the file has neither times nor an interval
  bool has_times = false;          ///< true if the file holds the times; false if they are computed from the interval
  bool times_have_unit = false;
  double last_digit = 0;                  ///< resolution of the times: value of their last written digit [s]
  std::optional<double> interval = {};    ///< sampling interval that the file states beside the times [s]
  bool is_breakpoints = false;            ///< true for a piecewise linear waveform; two rows of equal time mean a jump
  std::vector<std::uint32_t> lines = {};  ///< line of the file in which each row is
  std::vector<Channel> channels = {};
  std::vector<std::string> left_out = {};
  std::vector<std::string> notes = {};  ///< assumptions made while reading the file

  [[nodiscard]] std::size_t rows() const { return channels.empty() ? 0 : channels.front().values.size(); }
  /// Returns file and line of a row, such as "scope.csv:17".
  [[nodiscard]] std::string place(std::size_t row) const;
};

/// Returns the channel that the user names in `keys`, else the only channel, else the channel called `usual`. Throws
/// InvalidInput with the names of the channels if no such channel exists.
[[nodiscard]] const Channel& channel_of(const Recording& recording, const ReadKeys& keys, const std::string& usual);

/// Reads a recorded file. Throws InvalidInput with file, line, column and rule for an unreadable file, for a file that
/// holds no voltages or states over time (such as a spectrum or a mesh), and for an ambiguous file.
[[nodiscard]] Recording read_recording(const std::string& file, const ReadKeys& keys = {});
/// Reads the content of a recorded file; `file` is the name of the file in messages.
[[nodiscard]] Recording parse_recording(std::string_view content, const std::string& file, const ReadKeys& keys = {});

/// Properties of the times of a recording.
struct TimeAxis {
  double first = std::numeric_limits<double>::quiet_NaN();  ///< time of the first row [s]
  double last = std::numeric_limits<double>::quiet_NaN();   ///< time of the last row [s]
  /// Sampling interval that the file states, or else the mean interval [s].
  double interval = std::numeric_limits<double>::quiet_NaN();
  /// Least and greatest time between a row and the row above [s].
  double least_interval = std::numeric_limits<double>::infinity(), greatest_interval = -least_interval;
  std::size_t repeated = 0;              ///< number of rows with the same time as the row above
  std::optional<std::size_t> back = {};  ///< first row whose time is before that of the row above
};
[[nodiscard]] TimeAxis time_axis(const std::vector<double>& times, std::optional<double> stated_interval = {});
[[nodiscard]] TimeAxis time_axis(const Recording& recording);

/// Describes the times of rows: "every 1 us, from 0 s to 2 us", "at 3 us" for one row. Intervals that differ by more than the
/// rounding of times are "at intervals of 1 us to 5 us". There must be at least one row.
[[nodiscard]] std::string times_prose(const TimeAxis& axis);

/// Returns one line about a recording: format, channels, samples, interval, first and last time, and what was left out.
[[nodiscard]] std::string summary(const Recording& recording);

}  // namespace softland
