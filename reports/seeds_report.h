// Several searches that differ in their seeds alone, side by side: their spread says how far one search can be relied on.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "objectives/cost.h"
#include "reports/closing_record.h"
#include "reports/document.h"
#include "reports/origin.h"

namespace softland {

/// Orders the searches and sets which is the best. On the nominal device goes first what is confirmed, then what meets the goal,
/// then what settles, each by the target's own figure, a rebound below `significant` [m] counting as one, and then by cost, a sum
/// of targets by cost alone; over devices that differ what fulfils its conditions, by cost. Of equals the first seed.
void rank(SeedsFindings& seeds, const Aim& target, double significant, bool over_devices);

/// The record that an interrupted study of several seeds leaves.
struct SeedsRecord {
  Origin origin;
  SeedsFindings seeds;
};
[[nodiscard]] nlohmann::json json_of(const SeedsRecord& record);
[[nodiscard]] SeedsRecord read_seeds(const nlohmann::json& from);
[[nodiscard]] std::string text_of(const SeedsRecord& record);

namespace internal {

/// What the searches came to together, in sentences.
[[nodiscard]] std::string seeds_caption(const SeedsFindings& seeds);
/// The caption and a table.
[[nodiscard]] ReportSection seeds_section(const SeedsFindings& seeds);

}  // namespace internal

}  // namespace softland
