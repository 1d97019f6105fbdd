// Functions for the verbs that work on database files of studies.
#pragma once

#include <cstdint>
#include <string>

#include "apps/options.h"
#include "store/study_store.h"

namespace softland::apps {

/// Warns if rows of a database file were computed by another version of the program or on another processor: the last digits of
/// their numbers may differ.
void tell_of_other_programs(const std::string& store);

/// Returns a number of rows or points as text with all digits.
[[nodiscard]] std::string whole(std::int64_t count);

/// Returns a duration as text: "2 min" or "3.4 h".
[[nodiscard]] std::string duration_prose(double seconds);

}  // namespace softland::apps
