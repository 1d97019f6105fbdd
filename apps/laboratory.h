// What the verbs of a laboratory are told about its instruments, in one wording: `device` simulates these errors, `tune` expects
// them.
#pragma once

#include <optional>
#include <string>

#include "apps/options.h"
#include "studies/tuning/practice_device.h"

namespace softland::apps {

struct LaboratoryRequest {
  std::optional<std::string> edge_error, unseen, gain_error, shot_error;
};

/// --edge-error, --unseen, --gain-error and --shot-error.
void with_laboratory(Verb& verb, LaboratoryRequest& request);

struct Laboratory {
  double edge_error = PracticeOptions{}.edge_error;  ///< of the time of an edge, one standard deviation [s]
  double unseen = PracticeOptions{}.unseen;          ///< openings shorter than this are not seen [s]
  double gain_error = PracticeOptions{}.gain_error;  ///< of the gain of a source, one standard deviation, relative
  double shot_error = PracticeOptions{}.shot_error;  ///< of the gain from shot to shot, one standard deviation, relative
};
/// Throws InvalidInput for a quantity of another dimension or below 0.
[[nodiscard]] Laboratory laboratory(const LaboratoryRequest& request);

}  // namespace softland::apps
