#include "studies/closing/summits_at_hold.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "base/engineering.h"
#include "model/built_beam.h"
#include "model/contact/contact_law.h"
#include "studies/closing/simulate.h"

namespace softland {
namespace {

constexpr std::string_view touch_at_hold = "summits touch under the hold levels", too_few = ": fewer than one";

// Returns the share of the summits that touch when a rough contact has the interference d.
template <class Law>
double touching_share(const Law& law, double d) {
  if constexpr (requires { law.deviation; }) {
    return std::erfc((GaussianAsperityContact::first_touch - d / law.deviation) / std::numbers::sqrt2) / 2;
  } else {
    return std::clamp(d / law.height, 0.0, 1.0);
  }
}

}  // namespace

std::optional<SummitsAtHold> summits_at_hold(const Switch& model, const ClosedEquilibrium& closed) {
  const Device& device = model.device();
  // The summits cannot be counted along a pad or a face: the interference of the surfaces differs from point to point.
  if (!device.has_contact() || device.touches_along_pad() || device.contacts.front().along_face) return std::nullopt;
  const double d = model.contact_deflection(closed.q.data()) - device.contact_gap();
  return std::visit(
      [&]<class Law>(const Law& law) -> std::optional<SummitsAtHold> {
        if constexpr (requires { law.summits.density; }) {
          const double all =
              law.summits.count(pad_of(device.contacts.front(), width_at(device.structure, device.contact_position())));
          return SummitsAtHold{.touching = all * touching_share(law, d), .all = all};
        } else {
          return std::nullopt;
        }
      },
      device.contacts.front().model);
}

std::string summits_prose(const SummitsAtHold& summits) {
  return fmt::format(
      "{} of {} {}{}", engineering(summits.touching, "", 2), engineering(summits.all, "", 3), touch_at_hold,
      summits.touching < 1
          ? fmt::format("{}; the contact law is a mean over many summits, and may be wrong for one device", too_few)
          : "");
}

std::string few_summits_warning(const Switch& model, const std::vector<Signal>& signals) {
  const Hold hold = hold_of(model, signals);
  if (!hold.closed || !hold.is_held) return {};
  const std::optional<SummitsAtHold> summits = summits_at_hold(model, *hold.closed);
  return summits && summits->touching < 1 ? "contact forces: " + summits_prose(*summits) : std::string();
}

bool is_few_summits_warning(std::string_view warning) {
  return warning.find(touch_at_hold) != std::string_view::npos && warning.find(too_few) != std::string_view::npos;
}

}  // namespace softland
