// The default optimizer.
#pragma once

#include <string>

#include "optimizers/ledger.h"

namespace softland::internal {

/// Runs until the ledger is over.
void search_auto(Ledger& ledger);

}  // namespace softland::internal
