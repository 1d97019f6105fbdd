// The verbs of verbs/study.h on the command line.
#pragma once

#include "apps/options.h"
#include "verbs/study.h"

namespace softland::apps {

/// Such a function runs a verb that differs between the doors.
using RunTold = int (*)(const Common&, const verbs::Told&);

/// Runs a verb that is the same for all doors; returns the exit status.
[[nodiscard]] int run_study(const verbs::Study& study, const Common& common, const verbs::Told& told);

/// Declares the options of the verb, and runs it: by `run` where the study has no computation. Keeps a reference to `study`.
void add_study(Verb& verb, const verbs::Study& study, RunTold run = nullptr);

}  // namespace softland::apps
