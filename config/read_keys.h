// What the keys of a waveform say about the file of its rows.
#pragma once

#include <string>
#include <vector>

#include "exchange/recording.h"

namespace softland {

/// Of assignments KEY=VALUE as --set has them, such as `column=CH1`: those that say how a file is read, not what a scene makes of
/// it. Throws InvalidInput with the option, the value and the rule.
[[nodiscard]] ReadKeys read_keys(const std::vector<std::string>& assignments);

namespace internal {

class SectionReader;
/// Of the keys of [waveform.NAME].
[[nodiscard]] ReadKeys read_keys(const SectionReader& in);

}  // namespace internal
}  // namespace softland
