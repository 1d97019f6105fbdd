// The optimizer `auto`, the default: it samples the box of the variables for promising points, then runs local searches from
// the best of them.
//
// It is made for objectives with narrow curved valleys, some of them dead ends, with kinks, small jumps and noise, 4 to 7
// variables, and a budget of 500 to 2500 evaluations. Each epoch has four steps:
// 1. Points spread over the box are evaluated.
// 2. Local searches start from the best evaluated points that are apart from each other and from points of earlier searches. The
//    best point starts cma-es, which follows curved valleys and crosses kinks and small jumps. The second best point starts
//    bobyqa, whose quadratic model is the fastest if the objective is smooth.
// 3. The better half of the searches continues, until one search is left.
// 4. A local search with small steps improves the best point. If it converges, the next epoch begins with the remaining budget.
// The constants were chosen by success rates on the test objectives of tests/optimizers (bench/optimizers prints the rates).
#pragma once

#include "optimizers/backends.h"
#include "optimizers/evaluation_record.h"

namespace softland::internal {

/// Searches by the optimizer `auto` until the record accepts no more evaluations (EvaluationRecord::over), or until an epoch
/// makes no new evaluation.
void search_auto(EvaluationRecord& record);
/// Searches with a gradient method, `finisher`, which would end at the first kink of the objective if it ran alone. cma-es
/// makes the first round of every local search; `finisher` continues from the best points found, and then searches near the
/// best point.
void search_and_finish(EvaluationRecord& record, const Method& finisher);

}  // namespace softland::internal
