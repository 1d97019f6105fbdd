// The number of summits of a rough contact that touch the other surface under the contact force at the hold levels.
//
// A law of rough surfaces is a mean over many summits. If the mean number of touching summits is below one, the contact force
// of the law says little about a single device.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "studies/closing/prepared.h"

namespace softland {

struct SummitsAtHold {
  double touching = 0;  ///< mean number of summits of the rough surface in contact
  double all = 0;       ///< number of summits of the rough surface under the contact pad
};

/// Counts the summits in this closed equilibrium. Empty for a contact along the pad, and for a law without summit heights.
[[nodiscard]] std::optional<SummitsAtHold> summits_at_hold(const Switch& model, const ClosedEquilibrium& closed);

/// Describes the number of touching summits: "0.22 of 10 summits touch under the hold levels", with the consequence if fewer
/// than one summit touches.
[[nodiscard]] std::string summits_prose(const SummitsAtHold& summits);

/// Returns summits_prose() as a warning if the hold levels keep the switch closed on fewer than one summit; empty otherwise.
[[nodiscard]] std::string few_summits_warning(const Switch& model, const std::vector<Signal>& signals);
/// True if few_summits_warning() returned the text `warning`.
[[nodiscard]] bool is_few_summits_warning(std::string_view warning);

}  // namespace softland
