// The rows of a table that stand in a file. Internal to config/.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "config/section_reader.h"
#include "waveforms/table.h"

namespace softland::internal {

struct FileRows {
  Table table;                        ///< from t = 0 on
  std::optional<double> before = {};  ///< mean of the rows before t = 0, where there are some [V]
  std::string told = {};              ///< one line about a file that softland did not write; empty for one that it did
};

/// Reads the file that [waveform.NAME] names. A file of softland (a column time_s) is taken to the bit unless a key says
/// something about it; others are read by exchange/, and thinned to what the source of [driver.NAME] can pass where they are
/// long. Throws InvalidInput with key and file.
[[nodiscard]] FileRows read_file_rows(const SectionReader& waveform, std::string_view drive, const SectionReader& driver);

}  // namespace softland::internal
