#include "studies/closing/effects.h"

#include <algorithm>
#include <cmath>

#include "base/require.h"
#include "model/closing.h"
#include "model/gas/gas_law.h"
#include "studies/closing/closing_progress.h"
#include "studies/closing/open_command.h"
#include "studies/closing/timing.h"

namespace softland {
namespace {

// Returns the reason why this gas cannot surround the device; empty if this is possible.
std::string refusal(Device device, const Gas& gas) {
  device.gas = gas;
  try {
    validate(device);
  } catch (const InvalidInput& wrong) {
    return wrong.what();
  }
  return {};
}

struct LawClosing {
  Effect effect;
  BoundedClosing closing;
};

LawClosing closing_with(const PreparedScene& prepared, const std::optional<Gas>& gas, const ClosingBound& bound,
                        const Progress& progress, double done, double share) {
  Device described = prepared.scene.device;
  described.gas = gas;
  const Switch model(described, prepared.quadrature);
  BoundedClosing closing = bounded_closing(prepared, model, bound, progress, "closings with every gas law", done, share);
  Effect e{.section = "gas",
           .choice = "none",
           .magnitude = {.name = "damping per length, closed", .unit = "N s/m^2", .value = 0},
           .group = {.name = "Knudsen number, closed"},
           .metrics = closing.metrics,
           .rhs_seconds = progress.stopped() ? Metrics::unset
                                             : right_hand_side_seconds(model, hold_levels(prepared.signals()), closing.states),
           .warnings = closing.warnings,
           .end = closing.end};
  if (!gas) return {std::move(e), std::move(closing)};
  const double closed = described.closed_gap();
  e.choice = name_of(*gas);
  e.magnitude.value = damping_per_length(*model.gas(), closed);
  if (const FilmState* const film = film_of(*gas)) e.group.value = mean_free_path(*film) / closed;
  return {std::move(e), std::move(closing)};
}

}  // namespace

const Effect& Effects::own(const std::string& section) const {
  return *std::find_if(list.begin(), list.end(), [&](const Effect& e) { return e.in_scene && e.section == section; });
}

double Effects::spread(const std::string& section, const Figure& figure) const {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const Effect& e : list) {
    if (e.section != section || e.choice == "none") continue;
    const double value = figure.value(e.metrics);
    if (!std::isfinite(value)) return Metrics::unset;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  return (most - least) / figure.value(own(section).metrics);
}

Effects compare_effects(const PreparedScene& scene, const Progress& progress) {
  require_open_start(scene.scene, "effects closes the switch");
  const PreparedScene prepared = closing_of(scene);
  const std::optional<Gas>& own = prepared.scene.device.gas;
  Effects found{.window = prepared.duration};
  std::vector<std::optional<Gas>> laws{std::nullopt};
  for_each_law<Gas>([&]<class Law>(std::type_identity<Law>) {
    const bool in_scene = own && std::holds_alternative<Law>(*own);
    // The linear damper and the film over a slit are compared only if the scene describes them.
    if ((std::is_same_v<Law, LinearGas> || std::is_same_v<Law, StripSlitGas>)&&!in_scene) return;
    const Gas gas = in_scene ? *own : under(own.value_or(Gas{}), Gas(Law{}));
    if (const std::string reason = refusal(prepared.scene.device, gas); !reason.empty()) {
      found.not_compared.push_back({.choice = std::string(Law::name), .reason = reason});
      return;
    }
    laws.emplace_back(gas);
  });
  // The scene's own closing comes first: its cost bounds the cost of the other closings.
  const double share = 1.0 / static_cast<double>(laws.size());
  LawClosing of_scene = closing_with(prepared, own, {}, progress, 0, share);
  if (progress.stopped()) throw Interrupted();
  of_scene.effect.in_scene = true;
  double done = share;
  bool has_own = false;
  for (const std::optional<Gas>& law : laws) {
    if (law.has_value() == own.has_value() && (!own || law->index() == own->index())) {
      found.list.push_back(of_scene.effect);
      has_own = true;
      continue;
    }
    Effect e = closing_with(prepared, law, ClosingBound::after(of_scene.closing), progress, done, share).effect;
    if (progress.stopped()) break;
    done += share;
    found.list.push_back(std::move(e));
  }
  if (!has_own) found.list.push_back(of_scene.effect);
  if (!progress.stopped()) found.ablations = ablate_effects(prepared, of_scene.closing, true, progress);
  found.interrupted = progress.stopped();
  return found;
}

}  // namespace softland
