// What the verbs of a laboratory are told about its instruments, in one wording: `device` simulates these errors, `tune` expects
// them.
#pragma once

#include <optional>
#include <string>

#include "apps/options.h"
#include "config/scene.h"
#include "studies/tuning/contact_record.h"

namespace softland::apps {

struct LaboratoryRequest {
  std::optional<std::string> edge_error, unseen, gain_error, shot_error;
  std::optional<std::string> trigger_delay;  ///< expected by `tune`, which alone has the option
};

/// Adds --edge-error, --unseen, --gain-error and --shot-error.
void with_laboratory(Verb& verb, LaboratoryRequest& request);

/// Of instruments for this scene: those of time follow it, where it is quick and nobody says them. Throws InvalidInput for a
/// quantity of another dimension or below 0, and for a scene that cannot be read.
[[nodiscard]] LaboratoryErrors laboratory_errors(const LaboratoryRequest& request, const SceneFile& file);

}  // namespace softland::apps
