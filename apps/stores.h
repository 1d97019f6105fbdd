// The verbs that work on stores of studies share these functions.
#pragma once

#include <cstdint>
#include <string>

#include "apps/options.h"
#include "store/study_store.h"

namespace softland::apps {

/// Warns if rows of a store were computed by another version of the program or on another processor: their last digits may
/// differ.
void tell_of_other_programs(const std::string& store);

/// Returns a count of rows or points with all its digits.
[[nodiscard]] std::string whole(std::int64_t count);

/// Returns "2 min" or "3.4 h".
[[nodiscard]] std::string duration_prose(double seconds);

}  // namespace softland::apps
