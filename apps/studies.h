// The verbs that look at one scene (verbs/study.h), on the command line.
#pragma once

#include "apps/options.h"
#include "verbs/study.h"

namespace softland::apps {

/// Declares what the verb may be told, and runs it. Keeps a reference to `study`.
void add_study(Verb& verb, const verbs::Study& study);

}  // namespace softland::apps
