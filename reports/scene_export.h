// Exports the waveforms of a scene: CSV, sources for SPICE, files and integers for generators; or the switch itself as a
// circuit model. The waveforms suit the nominal design, or are scaled for a measured device.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "config/scene.h"
#include "reports/generator_export.h"
#include "studies/closing/sent_signals.h"

namespace softland {

struct ExportRequest {
  std::string format = "csv";
  std::string signal = "told";  ///< signal to export: "told" (commanded voltages) or "output" (applied voltages)
  std::string measured = {};    ///< measured quantities of a device: "Vdp=54.2 V,frequency=10.2 kHz,piezo=1.6 %/V"
  /// Measured pull-in voltage and frequency of a device, each as a separate option.
  std::optional<std::string> device_pull_in, device_frequency;
  Sampling sampling = {};
  int jobs = 1;
};

/// Returns the text of the exported file. `note` receives remarks, in lines, such as how the switch closes under the samples;
/// they mark the names of options by requested() of base/require.h. Throws InvalidRequest and Interrupted.
[[nodiscard]] std::string exported_text(const SceneFile& scene, const ExportRequest& request, const Progress& progress = {},
                                        const std::function<void(const std::string&)>& note = {});

/// A file that a waveform generator loads.
struct SentFile {
  /// End of the exported file's name: ".csv" for all waveforms, "-main.arb" for that of the electrode `main`.
  std::string ending;
  std::string text;
};
/// Returns the files with the signals of a shot (the voltages of one closing) in a format of `export`, in volts before the
/// amplifiers of [driver], up to `end` [s]. Depending on the format, a file holds all signals, or that of one electrode or
/// piezo which is not always at 0 V. Throws the exceptions of exported_text().
[[nodiscard]] std::vector<SentFile> sent_files(const std::string& format, const PreparedScene& scene, const SentSignals& sent,
                                               double end);
/// Returns all values of SentFile::ending that files for the electrodes and piezos of this scene may have.
[[nodiscard]] std::vector<std::string> sent_endings(const PreparedScene& scene);
/// Throws InvalidRequest if sent_files() can write no waveforms of these electrodes or piezos in this format: the format is
/// unknown, is a circuit model, or needs samples that [driver.NAME] does not give.
void require_shots(const std::string& format, const PreparedScene& scene, const std::vector<std::string>& drives);

}  // namespace softland
