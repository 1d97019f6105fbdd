// The waveforms of a scene are exported for others to read: CSV, sources of SPICE, files and integers for generators, the
// switch itself as a part of a circuit. They belong to the nominal design, or are scaled by the units of a measured device.
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
  std::string signal = "told";  ///< "told" or "output"
  std::string measured = {};    ///< measured quantities: "Vdp=54.2 V,frequency=10.2 kHz,piezo=1.6 %/V"
  std::optional<std::string> device_pull_in, device_frequency;  ///< the same quantities, each by itself
  Sampling sampling = {};
  int jobs = 1;
};

/// Returns the text of the file. `note` receives remarks about it, in lines, such as how the switch closes under the samples;
/// they name fields as requested() does. Throws InvalidRequest, Interrupted.
[[nodiscard]] std::string exported_text(const SceneFile& scene, const ExportRequest& request, const Progress& progress = {},
                                        const std::function<void(const std::string&)>& note = {});

/// A file that a generator loads.
struct SentFile {
  std::string ending;  ///< end of its name: ".csv" for all drives, "-main.arb" for one
  std::string text;
};
/// Writes the signals of a shot in a format of `export`, in volts before the amplifiers of [driver], up to `end` [s]. A file
/// holds all drives, or one of those that are not at 0 V at all times, as the format has it. Throws what exported_text()
/// throws.
[[nodiscard]] std::vector<SentFile> sent_files(const std::string& format, const PreparedScene& scene, const SentSignals& sent,
                                               double end);
/// Returns all endings that files of the drives of this scene may have.
[[nodiscard]] std::vector<std::string> sent_endings(const PreparedScene& scene);
/// Throws InvalidRequest where sent_files() cannot write these drives in this format, whatever their waveforms are. The format
/// may be unknown, may be the switch itself, or may need samples that their [driver] does not take.
void require_shots(const std::string& format, const PreparedScene& scene, const std::vector<std::string>& drives);

}  // namespace softland
