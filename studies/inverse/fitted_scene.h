// Writes the results of a fit into the text of a scene.
#pragma once

#include <string>
#include <string_view>

#include "studies/inverse/fit.h"

namespace softland {

/// Sets the [spread] of the scene to the deviations and correlations over the fitted devices: normal distributions about the
/// scene's values.
void set_spread(SceneFile& file, const Fit& fit);

/// Returns `text`, the scene in the file `path`, with the fitted values of a device; for several devices, with the mean over
/// the devices and their spread. Comments, sources and units stay. Throws InvalidInput for a text that is not a scene.
[[nodiscard]] std::string fitted_text(const Fit& fit, std::string_view text, const std::string& path, const std::string& device);

}  // namespace softland
