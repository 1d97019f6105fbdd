// What the verbs that work on stores of studies share.
#pragma once

#include <string>

#include "apps/options.h"
#include "store/study_store.h"

namespace softland::apps {

/// Who computes here: this program on this machine, for this command line.
[[nodiscard]] StoredOrigin origin_of(const Common& common);

/// "2 min", "3.4 h"
[[nodiscard]] std::string duration_words(double seconds);

}  // namespace softland::apps
