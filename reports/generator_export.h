// Waveforms become files of arbitrary waveform generators: sampled as the instrument will play them, and judged as sampled.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "config/scene.h"
#include "exchange/generator.h"
#include "studies/closing/prepared.h"
#include "waveforms/signal.h"

namespace softland {

/// The sampling of a waveform as the options give it.
struct Sampling {
  std::optional<std::string> rate, bits;  ///< replace those of [driver]
  std::string drive = {};                 ///< the only drive that is exported; empty: all
  std::optional<std::string> amplifier;   ///< volts at the switch over volts at the generator, instead of that of [driver]
  std::optional<std::string> marker;      ///< time of the marker
};

/// Returns the voltage drives that are exported: the named one, or all that are not at 0 V at all times. Throws InvalidInput
/// for a name that is not such a drive.
[[nodiscard]] std::vector<std::string> exported_drives(const PreparedScene& prepared, const std::string& named);

/// Returns the divisor of the volts at the switch in the file of a generator: that of `sampling`, else that of the drive, else
/// 1. Throws InvalidInput where it is not above 0.
[[nodiscard]] double amplification(const Drive& drive, const Sampling& sampling);
/// Returns this factor in words; empty where it is 1.
[[nodiscard]] std::string amplifier_prose(const Drive& drive, double factor);

/// Puts sample rate and bits into [driver] of these drives.
void set_sampling(SceneFile& file, const std::vector<std::string>& drives, const Sampling& sampling);

/// Throws InvalidRequest where this source takes no samples, which a file of this format holds.
void require_samples(std::string_view format, const std::string& drive, const DriverModel& source);

/// Returns the samples of a drive, `told` by its source from t = 0 on, as a file of this format. Throws InvalidInput where the
/// source takes no samples, and what generator_file() throws.
[[nodiscard]] std::string generator_text(const GeneratorFormat& format, const PreparedScene& prepared, const std::string& drive,
                                         const Signal& told, const Sampling& sampling);

/// Says how the nominal design closes under the samples of a drive. Adds a warning where it closes worse than under the
/// original waveform `drawn`; null: no comparison.
[[nodiscard]] std::vector<std::string> sampled_prose(const PreparedScene& sampled, const PreparedScene* drawn,
                                                     const std::string& drive, const Progress& progress);

}  // namespace softland
