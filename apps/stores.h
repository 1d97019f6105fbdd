// What the verbs that work on stores of studies share.
#pragma once

#include <cstdint>
#include <string>

#include "apps/options.h"
#include "config/plan.h"
#include "store/study_store.h"

namespace softland::apps {

/// Who computes here: this program on this machine, for this command line.
[[nodiscard]] StoredOrigin origin_of(const Common& common);

/// Says where rows come from another program, or from one on another processor, whose last digits may differ.
void tell_of_other_programs(const std::string& store);

/// The plan of the exploration that a store holds. Throws InvalidInput where it holds a search.
[[nodiscard]] PlanRequest exploration_in(const StudyReader& store);

/// A count of rows or points with all its digits.
[[nodiscard]] std::string whole(std::int64_t count);

/// "2 min", "3.4 h"
[[nodiscard]] std::string duration_words(double seconds);

}  // namespace softland::apps
