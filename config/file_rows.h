// Reads the rows (times and voltages) of a table waveform from a file. Internal to config/.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "config/section_reader.h"
#include "waveforms/table.h"

namespace softland::internal {

struct FileRows {
  Table table;                        ///< recorded times and voltages from t = 0 on
  std::optional<double> before = {};  ///< mean voltage of the rows before t = 0, if the file has such rows [V]
  std::string note = {};              ///< note on what was read from a file of another program, or empty
};

/// Reads the file that [waveform.NAME] names. The numbers of a file written by softland (column time_s) are read bit for bit,
/// unless the section has keys that describe the file. Other files are read by exchange/. A long file is thinned: rows that
/// hardly change the voltage after the low-pass filter of [driver.NAME] are removed. Throws InvalidInput with key and file.
[[nodiscard]] FileRows read_file_rows(const SectionReader& waveform, std::string_view drive, const SectionReader& driver);

}  // namespace softland::internal
