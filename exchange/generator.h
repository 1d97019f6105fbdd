// Writes voltage samples to files for arbitrary waveform generators: samples at a constant rate, each held until the next. The
// reader in recording.h reads these files.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace softland {

struct GeneratorSamples {
  std::string name;
  double rate = 0;                         ///< sample rate of the generator [Hz]
  std::vector<double> volts;               ///< voltage samples at the output of the generator [V]
  std::optional<std::size_t> marker = {};  ///< number of the sample at which the sync (trigger) output goes from high to low
};

/// A file format of waveform generators, with the fewest and the most samples that the instrument of this name accepts.
struct GeneratorFormat {
  std::string_view name, instrument;
  std::size_t fewest = 1, most = 1;
  bool has_marker = false;
  std::string (*write)(const GeneratorSamples& samples) = nullptr;
};
[[nodiscard]] std::span<const GeneratorFormat> generator_formats();

/// Returns the content of a generator file. If there are too few samples for the instrument, the last sample is repeated.
/// Throws InvalidInput for no samples, for too many, or for a marker that the format cannot hold.
[[nodiscard]] std::string generator_file(const GeneratorFormat& format, GeneratorSamples samples);

}  // namespace softland
