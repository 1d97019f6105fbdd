// Files that arbitrary waveform generators load: samples at a rate, each held until the next, played once. recording.h reads all
// of them back.
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
  double rate = 0;                         ///< [Hz]
  std::vector<double> volts;               ///< samples at the output of the generator
  std::optional<std::size_t> marker = {};  ///< the sample at which its sync output falls
};

/// A kind of file, with the samples that the instrument named takes at the fewest and at the most.
struct GeneratorFormat {
  std::string_view name, instrument;
  std::size_t fewest = 1, most = 1;
  bool has_marker = false;
  std::string (*write)(const GeneratorSamples& samples) = nullptr;
};
[[nodiscard]] std::span<const GeneratorFormat> generator_formats();

/// The file; the last sample is repeated up to the fewest that the instrument takes. Throws InvalidInput where there are none,
/// more than the instrument takes, or a marker that the format cannot say.
[[nodiscard]] std::string generator_file(const GeneratorFormat& format, GeneratorSamples samples);

}  // namespace softland
