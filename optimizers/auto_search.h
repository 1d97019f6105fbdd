// The default optimizer: it samples the box for promising points, then descends from the best of them.
//
// It is made for landscapes with narrow curved valleys, some of them dead ends, with kinks, small jumps and noise, 4 to 7
// variables, and a budget of 500 to 2500 evaluations. Each epoch has four steps:
// 1. Points spread over the box are evaluated.
// 2. Local searches start from the best of all known points that lie apart from each other and from where earlier searches
//    went. The best starts cma-es, which follows bent valleys and gets over kinks and small jumps. The second best starts
//    bobyqa, whose quadratic model is the fastest where the objective is smooth.
// 3. The better half of the searches goes on, until one is left.
// 4. The best point is polished; if that converges, the next epoch begins with the rest of the budget.
// The constants were chosen by success rates over the landscapes of tests/optimizers (bench/optimizers prints them).
#pragma once

#include "optimizers/backends.h"
#include "optimizers/evaluation_record.h"

namespace softland::internal {

/// Runs until the record accepts no more evaluations (EvaluationRecord::over), or until an epoch makes no new evaluation.
void search_auto(EvaluationRecord& record);
/// Serves the methods with a gradient, which end at the first kink: cma-es makes the first round of every search; `finisher`
/// continues from the best points found, and polishes.
void search_and_finish(EvaluationRecord& record, const Method& finisher);

}  // namespace softland::internal
