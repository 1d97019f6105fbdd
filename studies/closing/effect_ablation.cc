#include "studies/closing/effect_ablation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/built_beam.h"
#include "model/closing.h"
#include "model/forces/electrostatic.h"
#include "model/gas/gas_law.h"
#include "objectives/figure_values.h"
#include "studies/closing/closing_progress.h"
#include "studies/closing/open_command.h"
#include "studies/closing/timing.h"

namespace softland {
namespace {

// Returns the force on the first mode of the beam at rest, with 1 V on one electrode [N].
double force_at_rest(const Device& described, std::size_t electrode) {
  const Switch model(described);
  Switch::Workspace work = model.workspace();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.modes());
  Eigen::VectorXd with(model.modes()), without(model.modes());
  std::vector<double> volts(model.drives(), 0.0);
  model.accelerations(rest.data(), rest.data(), volts, false, work, without.data());
  volts[electrode] = 1;
  model.accelerations(rest.data(), rest.data(), volts, false, work, with.data());
  return with[0] - without[0];
}

double first_frequency(const Device& device) { return Switch(device).basis().angular_frequencies()[0]; }

BoundedClosing closing(const PreparedScene& p, const Progress& progress, const ClosingBound& bound = {}, double done = 0,
                       double share = 1) {
  return bounded_closing(p, p.model, bound, progress, "closings without each effect", done, share);
}

// Returns an effect of the model whose magnitude is the shift of the contact point's rest position between the device with and
// without the effect.
OmissibleEffect rest_effect(const std::string& effect, const Device& d, const Device& without,
                            std::optional<SceneValue> instead) {
  const double rise = d.contact_gap() - without.contact_gap();
  return {.effect = effect,
          .magnitude = {.name = "rise of the contact point", .unit = "m", .value = rise},
          .group = {.name = "over the contact gap", .value = rise / d.gap.contact},
          .instead = std::move(instead)};
}

void add_omissible_rest_shape(const Device& d, std::vector<OmissibleEffect>& list) {
  Device without = d;
  const Beam& beam = part_of<Beam>(d.structure);
  for (std::size_t i = 0; i < beam.layers.size(); ++i) {
    if (beam.layers[i].stress == 0) continue;
    Device relaxed = d;
    part_of<Beam>(relaxed.structure).layers[i].stress = 0;
    list.push_back(rest_effect(fmt::format("structure.layers[{}].stress", i + 1), d, relaxed, 0.0));
  }
  if (const auto* const cantilever = d.structure.find<Cantilever>(); cantilever != nullptr && cantilever->stress_gradient != 0) {
    part_of<Cantilever>(without.structure).stress_gradient = 0;
    list.push_back(rest_effect("structure.stress_gradient", d, without, 0.0));
  }
  if (beam.rest_shape && std::ranges::any_of(beam.rest_shape->heights, [](double height) { return height != 0; })) {
    part_of<Beam>(without.structure).rest_shape.reset();
    list.push_back(rest_effect("structure.rest_shape", d, without, {}));
  }
}

// Adds the parts of the structure that a model can omit: compliant anchors become clamps, sections with holes become solid.
void add_omissible_parts(const Device& d, std::vector<OmissibleEffect>& list) {
  const Beam& beam = part_of<Beam>(d.structure);
  const auto add_anchor = [&](const char* key, std::optional<Anchor> Beam::*end) {
    const std::optional<Anchor>& anchor = beam.*end;
    if (!anchor || anchor->is_clamp() || anchor->is_free()) return;
    Device clamped = d;
    part_of<Beam>(clamped.structure).*end = Anchor{};
    const bool turns = !std::isinf(anchor->rotation);
    list.push_back({.effect = fmt::format("structure.{}", key),
                    .magnitude = {.name = turns ? "stiffness of rotation" : "stiffness",
                                  .unit = turns ? "N m/rad" : "N/m",
                                  .value = turns ? anchor->rotation : anchor->translation},
                    .group = {.name = "change of omega_1", .value = first_frequency(d) / first_frequency(clamped) - 1},
                    .instead = std::string("clamped")});
  };
  add_anchor("anchor", &Beam::anchor);
  add_anchor("far_anchor", &Beam::far_anchor);
  for (std::size_t i = 0; i < beam.sections.size(); ++i) {
    const Holes& holes = beam.sections[i].holes;
    if (!holes.exist()) continue;
    list.push_back({.effect = fmt::format("structure.sections[{}].holes", i + 1),
                    .magnitude = {.name = "side of a hole", .unit = "m", .value = holes.size},
                    .group = {.name = "area left", .value = area_left(holes)},
                    .instead = {}});
  }
}

void add_omissible_structure(const PreparedScene& prepared, std::vector<OmissibleEffect>& list) {
  const Device& d = prepared.scene.device;
  const Structure& s = d.structure;
  if (!s.is_rigid() && s.modes > 1) {
    list.push_back({.effect = "structure.modes",
                    .magnitude = {.name = "highest mode",
                                  .unit = "rad/s",
                                  .value = prepared.model.basis().angular_frequencies()[s.modes - 1]},
                    .group = {.name = "over the first",
                              .value = prepared.model.basis().angular_frequencies()[s.modes - 1] /
                                       prepared.model.basis().angular_frequencies()[0]},
                    .instead = 1,
                    .automatic = false});
  }
  if (s.damping_ratio > 0) {
    list.push_back({.effect = "structure.damping_ratio",
                    .magnitude = {.name = "quality factor", .value = 1 / (2 * s.damping_ratio)},
                    .group = {.name = "damping ratio", .value = s.damping_ratio},
                    .instead = 0.0});
  }
  const auto* const bridge = s.find<Bridge>();
  if (bridge != nullptr && bridge->stretches) {
    list.push_back({.effect = "structure.stretching",
                    .magnitude = {.name = "contact gap", .unit = "m", .value = d.contact_gap()},
                    .group = {.name = "(gap / thickness)^2",
                              .value = std::pow(d.contact_gap() / section_at(s, d.contact_position()).thickness, 2)},
                    .instead = false});
  }
  if (bridge != nullptr && bridge->residual_stress != 0) {
    Device without = d;
    part_of<Bridge>(without.structure).residual_stress = 0;
    list.push_back({.effect = "structure.residual_stress",
                    .magnitude = {.name = "stress", .unit = "Pa", .value = bridge->residual_stress},
                    .group = {.name = "change of omega_1", .value = first_frequency(d) / first_frequency(without) - 1},
                    .instead = 0.0});
  }
  if (const auto* const modal = s.find<ModalStructure>(); modal != nullptr && !std::isnan(modal->axial_stiffness)) {
    list.push_back({.effect = "structure.axial_stiffness",
                    .magnitude = {.name = "stiffness", .unit = "N/m", .value = modal->axial_stiffness},
                    .group = {.name = "(gap / thickness)^2", .value = std::pow(d.contact_gap() / s.thickness, 2)},
                    .instead = {}});
  }
  if (s.find<Beam>() != nullptr) {
    add_omissible_parts(d, list);
    add_omissible_rest_shape(d, list);
  }
  if (d.surface) {
    Device without = d;
    without.surface.reset();
    list.push_back({.effect = "surface",
                    .magnitude = {.name = "elastic modulus", .unit = "N/m", .value = d.surface->elastic_modulus},
                    .group = {.name = "change of omega_1", .value = first_frequency(d) / first_frequency(without) - 1},
                    .instead = {}});
  }
}

void add_omissible_fringing(const PreparedScene& prepared, std::vector<OmissibleEffect>& list) {
  const Device& d = prepared.scene.device;
  for (std::size_t k = 0; k < d.electrodes.size(); ++k) {
    const Electrode& e = d.electrodes[k];
    if (e.fringing == Fringing::none) continue;
    Device without = d;
    without.electrodes[k].fringing = Fringing::none;
    list.push_back({.effect = "electrode." + e.name + ".fringing",
                    .magnitude = {.name = "force added, at rest", .value = force_at_rest(d, k) / force_at_rest(without, k) - 1},
                    .group = {.name = "gap / width", .value = d.gap.electrode / width_at(d.structure, d.contact_position())},
                    .instead = std::string(name_of(fringing_laws, Fringing::none))});
  }
}

// Adds the dielectrics that a model can omit. A dielectric on which the beam closes stays; only the roughness of its face can
// be omitted.
void add_omissible_dielectrics(const PreparedScene& prepared, std::vector<OmissibleEffect>& list) {
  const Device& d = prepared.scene.device;
  for (const Electrode& e : d.electrodes) {
    if (!e.dielectric) continue;
    if (const double neutral = e.dielectric->neutral_voltage(); neutral != 0) {
      const double most = std::abs(prepared.drives.at(e.name).hold_level());
      list.push_back({.effect = "electrode." + e.name + ".dielectric.charge",
                      .magnitude = {.name = "voltage without field", .unit = "V", .value = neutral},
                      .group = {.name = "over all voltages", .value = std::abs(neutral) / (most + std::abs(neutral))},
                      .instead = {}});
    }
    if (e.dielectric->roughness > 0) {
      list.push_back(
          {.effect = "electrode." + e.name + ".dielectric.roughness",
           .magnitude = {.name = "air left under its summits", .unit = "m", .value = e.dielectric->roughness},
           .group = {.name = "over the electrical gap of the face", .value = e.dielectric->roughness / e.dielectric->depth()},
           .instead = 0.0});
    }
    if (d.closes_on_dielectric()) continue;
    list.push_back({.effect = "electrode." + e.name + ".dielectric",
                    .magnitude = {.name = "added to the gap of the field", .unit = "m", .value = e.dielectric->depth()},
                    .group = {.name = "over the rest gap", .value = e.dielectric->depth() / d.gap.electrode},
                    .instead = {}});
  }
}

void add_omissible_gas(const PreparedScene& prepared, std::vector<OmissibleEffect>& list) {
  const Device& d = prepared.scene.device;
  const double width = width_at(d.structure, d.contact_position()), closed = d.closed_gap();
  const double omega = prepared.model.basis().angular_frequencies()[0];
  list.push_back(
      {.effect = "gas",
       .magnitude = {.name = "damping, closed", .unit = "N s/m^2", .value = damping_per_length(*prepared.model.gas(), closed)},
       .group = {.name = "squeeze number, closed"},
       .instead = {}});
  if (const FilmState* const film = film_of(*d.gas)) list.back().group.value = squeeze_number(*film, width, closed, omega);
  if (!std::isnan(far_gap(*d.gas))) {
    list.push_back({.effect = "gas.far_gap",
                    .magnitude = {.name = "damping, at rest",
                                  .unit = "N s/m^2",
                                  .value = damping_per_length(*prepared.model.gas(), far_gap(*d.gas))},
                    .group = {.name = "(near / far gap)^3", .value = std::pow(d.gap.electrode / far_gap(*d.gas), 3)},
                    .instead = {}});
  }
  if (!std::isnan(film_length(*d.gas))) {
    list.push_back({.effect = "gas.film_length",
                    .magnitude = {.name = "damping kept", .value = end_flow(width / film_length(*d.gas))},
                    .group = {.name = "width / length", .value = width / film_length(*d.gas)},
                    .instead = {}});
  }
}

void add_omissible_contact(const PreparedScene& prepared, std::vector<OmissibleEffect>& list) {
  const Device& d = prepared.scene.device;
  const Contact& contact = d.contacts.front();
  const auto section = [](const Contact& c) { return c.name.empty() ? std::string("contact") : "contact." + c.name; };
  if (contact.distribution == ContactDistribution::pad) {
    // Magnitude of the effect: height difference between the ends of the pad, which is pad length times slope of a cantilever
    // that a force at its end bends by the contact gap.
    const double rise = 1.5 * d.contact_gap() / d.structure.length * contact.pad_length;
    list.push_back({.effect = section(contact) + ".distribution",
                    .magnitude = {.name = "tilt of the pad", .unit = "m", .value = rise},
                    .group = {.name = "over the interference", .value = rise / prepared.model.penetration_scale()},
                    .instead = std::string(name_of(contact_distributions, ContactDistribution::centre)),
                    .automatic = false});
  }
  for (std::size_t k = 0; k < d.contacts.size(); ++k) {
    const Contact& c = d.contacts[k];
    if (c.side == Side::far) {
      list.push_back({.effect = section(c),
                      .magnitude = {.name = "gap of the back stop", .unit = "m", .value = d.contact_gap(k)},
                      .group = {.name = "over the contact gap", .value = d.contact_gap(k) / d.contact_gap()},
                      .instead = {}});
    }
    if (const double damping = number_of(c.model, "damping", 0); damping > 0) {
      list.push_back({.effect = section(c) + ".damping",
                      .magnitude = {.name = "damping", .unit = "s/m", .value = damping},
                      .group = {.name = "1 - restitution, at 0.1 m/s", .value = 0.1 * damping},
                      .instead = {}});
    }
  }
}

}  // namespace

std::vector<OmissibleEffect> omissible_effects(const PreparedScene& prepared) {
  const Device& d = prepared.scene.device;
  std::vector<OmissibleEffect> list;
  add_omissible_structure(prepared, list);
  add_omissible_fringing(prepared, list);
  add_omissible_dielectrics(prepared, list);
  if (d.gas) add_omissible_gas(prepared, list);
  if (d.has_contact()) add_omissible_contact(prepared, list);
  if (d.dispersion && !prepared.drives.at(dispersion_drive).waveform) {
    const double bent =
        prepared.model.rest() ? prepared.model.contact_deflection(prepared.model.rest()->data()) : d.contact_gap();
    list.push_back({.effect = "dispersion",
                    .magnitude = {.name = "deflection at rest", .unit = "m", .value = bent},
                    .group = {.name = "over the contact gap", .value = bent / d.contact_gap()},
                    .instead = {}});
  }
  const SceneFile scene = prepared.resolved();
  for (OmissibleEffect& effect : list) effect.choice = scene.written(effect.effect).value();
  return list;
}

PreparedScene copy_without(const PreparedScene& prepared, const std::vector<OmissibleEffect>& effects) {
  const SceneFile frozen = prepared.resolved();
  SceneFile file = frozen.again(prepared.scene.file.name());
  file.assign("simulate.effects", std::string("all"));
  for (const OmissibleEffect& e : effects) {
    // A key inside a section that is left out needs no change of its own: it is removed together with the section.
    const bool inside = std::any_of(effects.begin(), effects.end(),
                                    [&](const OmissibleEffect& other) { return e.effect.starts_with(other.effect + "."); });
    if (inside) continue;
    file.erase(fmt::format("spread.\"{}\"", e.effect));  // [spread] must not vary a key that the scene no longer has
    if (e.instead) {
      file.assign(e.effect, *e.instead);
    } else {
      file.erase(e.effect);
    }
  }
  const auto drops_contact = [&](const OmissibleEffect& e) {
    return std::ranges::any_of(prepared.scene.device.contacts, [&](const Contact& c) { return e.effect == "contact." + c.name; });
  };
  // Remove metrics.closed if one contact is left: the key says whether the connection needs any or all of several contacts.
  const auto left =
      prepared.scene.device.contacts.size() - static_cast<std::size_t>(std::ranges::count_if(effects, drops_contact));
  if (left < 2) file.erase("metrics.closed");
  PreparedScene p = prepare(file);
  p.scene.warnings = prepared.scene.warnings;
  p.pull_in = prepared.pull_in;
  p.drives = prepared.drives.of(p.drive_names());  // keeps the loads of the voltage sources, and so the applied voltages
  p.duration = prepared.duration;
  p.held_from = prepared.held_from;
  p.tolerance = prepared.tolerance;
  return p;
}

double influence(const Metrics& own, const Metrics& other, const MetricsOptions& options) {
  if (!std::isfinite(own.initial_contact_time)) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (const Figure& figure : compared_figures)
    most = std::max(most, relative_difference(figure.counted(other, options), figure.counted(own, options)));
  return most;
}

BoundedClosing bounded_closing(const PreparedScene& prepared, const Switch& model, const ClosingBound& bound,
                               const Progress& progress, const std::string& what, double done, double share) {
  constexpr long steps_per_look = 64;  // number of integrator steps between two readings of the clock
  BoundedClosing found;
  const auto tell = observer(progress, what, prepared.duration, done, share);
  const double start = processor_seconds();
  const Trajectory t = simulate_closing(model, prepared.signals(),
                                        {.duration = prepared.duration,
                                         .tolerance = prepared.tolerance,
                                         .stop = progress.stop,
                                         .observer = [&](double time, const double* q, const double* v) {
                                           if (tell) tell(time, q, v);
                                           keep_state(model, q, found.states);
                                           ++found.steps;
                                           const bool late =
                                               found.steps % steps_per_look == 0 && processor_seconds() - start > bound.seconds;
                                           if (found.steps < bound.steps && !late) return false;
                                           found.end = time;
                                           return true;
                                         }});
  found.seconds = processor_seconds() - start;
  found.metrics = metrics(t, prepared.scene.metrics);
  found.warnings = t.warnings;
  return found;
}

std::vector<EffectAblation> ablate_effects(const PreparedScene& prepared, const BoundedClosing& own, bool timed,
                                           const Progress& progress) {
  std::vector<EffectAblation> list;
  std::vector<OmissibleEffect> effects = omissible_effects(prepared);
  for (OmissibleEffect& effect : effects) {
    const double share = 1.0 / static_cast<double>(effects.size());
    const PreparedScene p = copy_without(prepared, {effect});
    const BoundedClosing one = closing(p, progress, ClosingBound::after(own), static_cast<double>(list.size()) * share, share);
    EffectAblation o{.what = std::move(effect),
                     .metrics = one.metrics,
                     .influence = influence(own.metrics, one.metrics, prepared.scene.metrics),
                     .rhs_seconds = Metrics::unset,
                     .end = one.end};
    if (progress.stopped()) break;
    if (timed) o.rhs_seconds = right_hand_side_seconds(p.model, hold_levels(p.signals()), one.states);
    list.push_back(std::move(o));
  }
  return list;
}

EffectsChoice negligible_effects(const PreparedScene& scene, double tolerance, const Progress& progress) {
  require_open_start(scene.scene, "effects = \"auto\" judges a closing");
  const PreparedScene prepared = closing_of(scene);
  EffectsChoice choice;
  const BoundedClosing own = closing(prepared, progress);
  for (EffectAblation& o : ablate_effects(prepared, own, false, progress)) {
    if (o.what.automatic && !o.end && o.influence <= tolerance) choice.left_out.push_back(std::move(o));
  }
  progress.throw_if_stopped();
  std::sort(choice.left_out.begin(), choice.left_out.end(),
            [](const EffectAblation& a, const EffectAblation& b) { return a.influence < b.influence; });
  for (; !choice.left_out.empty(); choice.left_out.pop_back()) {
    std::vector<OmissibleEffect> effects;
    for (const EffectAblation& o : choice.left_out) effects.push_back(o.what);
    choice.influence = influence(own.metrics, closing(copy_without(prepared, effects), progress).metrics, prepared.scene.metrics);
    progress.throw_if_stopped();
    if (choice.influence <= tolerance) return choice;
  }
  choice.influence = 0;
  return choice;
}

}  // namespace softland
