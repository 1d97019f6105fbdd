// The keys of [waveform.NAME] that describe how the file of the waveform's rows is read.
#pragma once

#include <string>
#include <vector>

#include "exchange/recording.h"

namespace softland {

/// Reads assignments KEY=VALUE, such as `column=CH1`, of the keys that describe how a recorded file is read. Throws
/// InvalidInput with the option, the value and the rule.
[[nodiscard]] ReadKeys read_keys(const std::vector<std::string>& assignments);

namespace internal {

class SectionReader;
/// Reads the keys that describe how a recorded file is read from [waveform.NAME] of a scene.
[[nodiscard]] ReadKeys read_keys(const SectionReader& in);

}  // namespace internal
}  // namespace softland
