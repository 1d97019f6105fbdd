// Runs the verbs of verbs/study.h from the command line.
#pragma once

#include "apps/options.h"
#include "verbs/study.h"

namespace softland::apps {

/// A function that runs a verb on the command line and returns the exit status of the program. It is for a verb that the Python
/// module runs by other code.
using RunTold = int (*)(const Common&, const verbs::Arguments&);

/// Runs a verb whose computation the command line and the Python module share; returns the exit status of the program.
[[nodiscard]] int run_study(const verbs::Study& study, const Common& common, const verbs::Arguments& arguments);

/// Declares the options of the verb, and its action: run_study(), or `run` for a verb whose description `study` has no
/// computation. Keeps a reference to `study`.
void add_study(Verb& verb, const verbs::Study& study, RunTold run = nullptr);

}  // namespace softland::apps
