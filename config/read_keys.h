// The keys of a waveform that describe the file of its rows.
#pragma once

#include <string>
#include <vector>

#include "exchange/recording.h"

namespace softland {

/// Reads assignments KEY=VALUE as --set has them, such as `column=CH1`: those that tell how to read a file, not how a scene
/// uses it. Throws InvalidInput with the option, the value and the rule.
[[nodiscard]] ReadKeys read_keys(const std::vector<std::string>& assignments);

namespace internal {

class SectionReader;
/// Reads the keys of [waveform.NAME].
[[nodiscard]] ReadKeys read_keys(const SectionReader& in);

}  // namespace internal
}  // namespace softland
