// Reads the rows of a table from a file. Internal to config/.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "config/section_reader.h"
#include "waveforms/table.h"

namespace softland::internal {

struct FileRows {
  Table table;                        ///< rows from t = 0 on
  std::optional<double> before = {};  ///< mean of the rows before t = 0, if the file has some [V]
  std::string told = {};              ///< one line about a file that softland did not write; empty for its own files
};

/// Reads the file that [waveform.NAME] names. A file of softland (a column time_s) is taken to the bit unless a key describes
/// it. exchange/ reads others; long ones are thinned to what the source of [driver.NAME] can pass. Throws InvalidInput with key
/// and file.
[[nodiscard]] FileRows read_file_rows(const SectionReader& waveform, std::string_view drive, const SectionReader& driver);

}  // namespace softland::internal
