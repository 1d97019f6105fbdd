// Reports several searches that differ only in their seeds, side by side: their scatter shows how reliable one search is.
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

/// Sets SeedsFindings::best. The first criterion on the nominal device is a result that the confirmations support, then a
/// result that meets the goal, then a switch that settles. Further criteria are the figure of merit of the target, then the
/// cost; a rebound below `significant` [m] counts as `significant`, and for a sum of targets only the cost counts. Under
/// process variation, a search whose result fulfils its conditions (such as a least yield) is best, then one with a lower cost.
/// In a tie the lower seed is best.
void rank(SeedsFindings& seeds, const Aim& target, double significant, bool over_devices);

/// The results of an interrupted study of several seeds.
struct SeedsRecord {
  Origin origin;
  SeedsFindings seeds;
};
/// Names the members of the JSON.
void members(internal::Archive& a, SeedsFindings& seeds);
void members(internal::Archive& a, SeedsRecord& record);
[[nodiscard]] nlohmann::json json_of(const SeedsRecord& record);
[[nodiscard]] SeedsRecord read_seeds(const nlohmann::json& from);
[[nodiscard]] std::string text_of(const SeedsRecord& record);

namespace internal {

/// Summarises in sentences the results of the searches with all seeds.
[[nodiscard]] std::string seeds_caption(const SeedsFindings& seeds);
/// Returns a section that compares the searches with different seeds: sentences and a table.
[[nodiscard]] ReportSection seeds_section(const SeedsFindings& seeds);

}  // namespace internal

}  // namespace softland
