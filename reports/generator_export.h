// Waveforms as files of arbitrary waveform generators: sampled as the instrument will play them, and judged as sampled.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/watch.h"
#include "config/scene.h"
#include "exchange/generator.h"
#include "studies/closing/prepared.h"
#include "waveforms/signal.h"

namespace softland {

/// How the samples of a waveform are taken, as options say it.
struct Sampling {
  std::optional<std::string> rate, bits;  ///< instead of those of [driver]
  std::string drive = {};                 ///< the only one that is exported; empty: all
  std::optional<std::string> amplifier;   ///< volts at the switch over volts at the generator, instead of that of [driver]
  std::optional<std::string> marker;      ///< a time
};

/// The drives of voltages that are exported: the named one, or all that are not at 0 V at all times. Throws InvalidInput where it
/// is none.
[[nodiscard]] std::vector<std::string> exported_drives(const PreparedScene& prepared, const std::string& named);

/// The divisor of the volts at the switch in the file of a generator: what `sampling` says, else the drive, else 1. Throws
/// InvalidInput where it is not above 0.
[[nodiscard]] double amplification(const Drive& drive, const Sampling& sampling);
/// Tells this factor; empty where it is 1.
[[nodiscard]] std::string amplifier_words(const Drive& drive, double factor);

/// Puts sample rate and bits into [driver] of these drives.
void set_sampling(SceneFile& file, const std::vector<std::string>& drives, const Sampling& sampling);

/// Throws InvalidRequest where this source takes no samples, which a file of this format holds.
void require_samples(std::string_view format, const std::string& drive, const DriverModel& source);

/// The samples of a drive, `told` by its source from t = 0 on, as a file of this format. Throws InvalidInput where the source
/// takes no samples, and what generator_file() throws.
[[nodiscard]] std::string generator_text(const GeneratorFormat& format, const PreparedScene& prepared, const std::string& drive,
                                         const Signal& told, const Sampling& sampling);

/// How the nominal design closes under the samples of a drive, and a warning where it does not as well as under the waveform that
/// they were taken of; null: that is not there without them.
[[nodiscard]] std::vector<std::string> sampled_words(const PreparedScene& sampled, const PreparedScene* drawn,
                                                     const std::string& drive, const Watch& watch);

}  // namespace softland
