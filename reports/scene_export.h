// The waveforms of a scene as what others read: CSV, sources of SPICE, files and integers for generators, the switch itself as a
// part of a circuit; of the drawing, or in the units of a device that was measured.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/watch.h"
#include "config/scene.h"
#include "reports/generator_export.h"

namespace softland {

struct ExportRequest {
  std::string format = "csv";
  std::string signal = "told";                                  ///< or "output"
  std::string measured = {};                                    ///< "Vdp=54.2 V,frequency=10.2 kHz,piezo=1.6 %/V"
  std::optional<std::string> device_pull_in, device_frequency;  ///< the same, each by itself
  Sampling sampling = {};
  int jobs = 1;
};

/// The text of the file. `say` is told, in lines, what is to be known of it, such as how the switch closes under the samples;
/// they name fields as requested() does. Throws InvalidRequest, Interrupted.
[[nodiscard]] std::string exported_text(const SceneFile& scene, const ExportRequest& request, const Watch& watch = {},
                                        const std::function<void(const std::string&)>& say = {});

}  // namespace softland
