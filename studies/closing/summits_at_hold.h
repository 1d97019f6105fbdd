// How many summits of a rough contact touch where the hold levels press it.
//
// A law of rough surfaces is a mean over many summits. Where fewer than one of them touches, contact forces of it say little of
// one device, in any report that tells them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "studies/closing/prepared.h"

namespace softland {

struct SummitsAtHold {
  double touching = 0;  ///< mean number in touch
  double all = 0;       ///< summits under the pad
};

/// Counts the summits in this closed equilibrium. Empty for a contact along its pad, and for a law without summit heights.
[[nodiscard]] std::optional<SummitsAtHold> summits_at_hold(const Switch& model, const ClosedEquilibrium& closed);

/// "0.22 of 10 summits touch under the hold levels", and what that means where it is fewer than one.
[[nodiscard]] std::string summits_words(const SummitsAtHold& summits);

/// The same as a warning, where hold levels keep the switch closed on fewer than one summit; empty elsewhere.
[[nodiscard]] std::string few_summits_warning(const Switch& model, const std::vector<Signal>& signals);
/// Tells whether this is that warning.
[[nodiscard]] bool is_few_summits_warning(std::string_view warning);

}  // namespace softland
