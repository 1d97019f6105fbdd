// Writes waveforms as files of arbitrary waveform generators, sampled as the instrument will play them, and simulates a closing
// under the samples.
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

/// The options for sampling a waveform as an arbitrary waveform generator does.
struct Sampling {
  /// Sample rate and number of bits of the generator, as text; they replace those of the scene's section [driver].
  std::optional<std::string> rate, bits;
  std::string drive = {};                ///< the only drive (electrode or piezo) that is exported; empty: all
  std::optional<std::string> amplifier;  ///< volts at the switch per volt at the generator; not set: as in the scene
  std::optional<std::string> marker;     ///< time at which the sync output of the generator falls, as text
};

/// Returns the drives (electrodes and piezos) to export: the drive `named`, or all drives that are not always at 0 V. Throws
/// InvalidInput for any other name.
[[nodiscard]] std::vector<std::string> exported_drives(const PreparedScene& prepared, const std::string& named);

/// Returns the factor from the volts at the generator to the volts at the switch: that of `sampling`, else that of the scene
/// for this electrode or piezo, else 1. Throws InvalidInput unless the factor is above 0.
[[nodiscard]] double amplification(const Drive& drive, const Sampling& sampling);
/// Describes the factor from generator to switch voltage, which amplification() returns, in words; empty if the factor is 1.
[[nodiscard]] std::string amplifier_prose(const Drive& drive, double factor);

/// Writes the sample rate and the number of bits of the generator into the sections [driver.NAME] of these electrodes or
/// piezos.
void set_sampling(SceneFile& file, const std::vector<std::string>& drives, const Sampling& sampling);

/// Throws InvalidRequest if the voltage source has no sample rate, which a file of this format needs.
void require_samples(std::string_view format, const std::string& drive, const DriverModel& source);

/// Returns the samples of an electrode or piezo as a file of this format; `told` is the signal commanded to its source from t =
/// 0 on. Throws InvalidInput if the source does not use samples, and the exceptions of generator_file().
[[nodiscard]] std::string generator_text(const GeneratorFormat& format, const PreparedScene& prepared, const std::string& drive,
                                         const Signal& told, const Sampling& sampling);

/// Describes how the nominal design closes under the samples of a waveform. Adds a warning if the closing is worse than under
/// the original waveform of the scene `drawn`; null: no comparison.
[[nodiscard]] std::vector<std::string> sampled_prose(const PreparedScene& sampled, const PreparedScene* drawn,
                                                     const std::string& drive, const Progress& progress);

}  // namespace softland
