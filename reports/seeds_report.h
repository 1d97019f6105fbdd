// Several searches that differ in their seeds alone, side by side: their spread says how far one search can be relied on.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "document/document.h"
#include "objectives/cost.h"
#include "reports/closing_record.h"
#include "reports/origin.h"

namespace softland {

/// Orders the searches and sets the best one. On the nominal device a confirmed search goes first, then one that meets the
/// goal, then one that settles. Each group is sorted by the target's own figure, then by cost; a rebound below `significant`
/// [m] counts as one, and a sum of targets is sorted by cost alone. Under process variation a search that fulfils its
/// conditions goes first, sorted by cost. Among equals the first seed wins.
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

/// Summarises the outcome of the searches together, in sentences.
[[nodiscard]] std::string seeds_caption(const SeedsFindings& seeds);
/// Makes the caption and a table.
[[nodiscard]] ReportSection seeds_section(const SeedsFindings& seeds);

}  // namespace internal

}  // namespace softland
