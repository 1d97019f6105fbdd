#include "model/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/engineering.h"
#include "base/require.h"
#include "model/beam.h"
#include "model/built_beam.h"
#include "model/constants.h"
#include "model/forces/electrostatic.h"
#include "model/surface.h"

namespace softland {
namespace {

void positive(double value, const char* unit, const char* name) {
  require(!std::isnan(value), [&] { return fmt::format("{}: must be given for this device", name); });
  require(value > 0 && value < 1e30,
          [&] { return fmt::format("{} = {}: must be greater than 0 and below 1e30", name, engineering(value, unit)); });
}

void span(double begin, double end, double length, const std::string& name) {
  require(begin >= 0 && end > begin && end <= length * (1 + 1e-12), [&] {
    return fmt::format("{} = [{}, {}]: must increase and lie on the beam, from 0 m to {}", name, engineering(begin, "m"),
                       engineering(end, "m"), engineering(length, "m"));
  });
}

/// Checks the ranges of the numbers in `owner`, a part of the device. A number that a scene may leave out may also have the
/// value that it has in `unset`, a part without given values.
template <class Owner>
void check_fields(const std::string& part, Owner owner, Owner unset, std::span<const Field<Owner>> fields) {
  for (const Field<Owner>& field : fields) {
    // Skip fields that are not numbers in `owner` or have no range, and numbers whose range only the reader of scene files
    // checks.
    if (field.in == nullptr || !field.beyond.empty() || field.range == Range{}) continue;
    const double value = field.in(owner), missing = field.in(unset);
    const bool may_miss = !field.required || !field.instead_of.empty() || !field.unless.empty();
    if (may_miss && (value == missing || (std::isnan(value) && std::isnan(missing)))) continue;
    const std::string name = part + "." + std::string(field.key), unit(field.unit);
    const auto refuse_unless = [&](bool right, const auto& rule) {
      require(right, [&] { return fmt::format("{} = {}: {}", name, engineering(value, unit), rule()); });
    };
    const Field<Owner>* const bound = find_field(fields, field.not_below);
    if (bound != nullptr) {
      const double least = bound->in(owner);
      refuse_unless(value >= least && value < 1e30, [&] {
        return fmt::format("must not be below {}.{} = {}, and below 1e30 {}", part, field.not_below, engineering(least, unit),
                           unit);
      });
    } else if (field.range == softland::positive) {
      positive(value, unit.c_str(), name.c_str());
    } else {
      refuse_unless(field.range.contains(value), [&] { return field.range.rule(unit); });
    }
  }
}
template <class Law>
void check_fields(const std::string& part, const Law& law) {
  check_fields<Law>(part, law, Law{}, fields_of<Law>);
}

void check_structure(const Device& d) {
  const Structure& s = d.structure;
  positive(s.length, "m", "structure.length");
  const Beam* const beam = s.find<Beam>();
  const bool has_sections = beam != nullptr ? !beam->sections.empty() : s.is_built();
  if (!has_sections) positive(s.width, "m", "structure.width");
  Structure unset;
  std::visit([&]<class Kind>(const Kind&) { unset.kind = Kind{}; }, s.kind);
  check_fields("structure", s, unset, fields_in_force(s));
  if (beam != nullptr && !has_sections) {
    for (const Field<Structure>& field : fields_in_force(s)) {
      if (field.unless.empty()) continue;
      Structure own = s;
      positive(field.in(own), std::string(field.unit).c_str(), ("structure." + std::string(field.key)).c_str());
    }
  }
  require(s.modes >= 1 && s.modes <= most_modes,
          [&] { return fmt::format("structure.modes = {}: must be from 1 to {}", s.modes, most_modes); });
  require(s.damping_ratio >= 0 && s.damping_ratio < 1e3,
          [&] { return fmt::format("structure.damping_ratio = {}: must be in [0, 1000)", s.damping_ratio); });
  std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.why_invalid(d); }) {
          const std::string wrong = kind.why_invalid(d);
          require(wrong.empty(), wrong);
        }
      },
      s.kind);
}

void check_dielectric(const Electrode& e, const Gap& gap) {
  const Dielectric& dielectric = *e.dielectric;
  const std::string name = "electrode." + e.name + ".dielectric.";
  positive(dielectric.thickness, "m", (name + "thickness").c_str());
  require(dielectric.permittivity >= 1 && dielectric.permittivity < 1e6,
          [&] { return fmt::format("{}permittivity = {}: must be from 1 to 1000000", name, dielectric.permittivity); });
  require(dielectric.roughness >= 0 && dielectric.roughness < 1,
          [&] { return fmt::format("{}roughness = {}: must not be negative", name, engineering(dielectric.roughness, "m")); });
  require(std::abs(dielectric.charge) < 1e6, [&] {
    return fmt::format("{}charge = {}: must be between -1 and 1 MC/m^2", name, engineering(dielectric.charge, "C/m^2"));
  });
  if (const auto& landing = dielectric.landing) {
    if (landing->asperities) {
      check_fields(name + "landing", *landing->asperities);
      const double height = landing->asperities->height;
      require(height < gap.electrode, [&] {
        return fmt::format("{}landing.asperity_height = {}: must be below gap.electrode", name, engineering(height, "m"));
      });
      require(std::isnan(landing->stiffness) && landing->from == 0 && landing->asperities->damping == 0,
              [&] { return name + "landing.asperity_height: must not be given with a stiffness, a height `from` or damping"; });
    } else if (!landing->is_wall()) {
      positive(landing->stiffness, "Pa/m", (name + "landing.stiffness").c_str());
    }
    require(landing->from >= 0 && landing->from < gap.electrode, [&] {
      return fmt::format("{}landing.from = {}: must be from 0 m to below gap.electrode", name, engineering(landing->from, "m"));
    });
    require(!std::isnan(landing->stiffness) || landing->from == 0,
            [&] { return name + "landing.from: must be 0 m without landing.stiffness: the face is then a wall"; });
  }
  require(e.side == Side::near,
          [&] { return fmt::format("electrode.{}.dielectric: belongs to an electrode on the near side alone", e.name); });
}

void check_gap_and_electrodes(const Device& d) {
  const Structure& s = d.structure;
  positive(d.gap.electrode, "m", "gap.electrode");
  for (const Electrode& e : d.electrodes) {
    for (const Stretch& pad : e.pads(s.length)) span(pad.begin, pad.end, s.length, "electrode." + e.name + ".span");
    if (e.side != Side::near) positive(e.gap, "m", ("electrode." + e.name + ".gap").c_str());
    if (e.dielectric) check_dielectric(e, d.gap);
    if (row_of(fringing_laws, e.fringing).needs_thickness && !s.is_built()) positive(s.thickness, "m", "structure.thickness");
  }
  require(d.gap.contact > 0 && d.gap.contact <= d.gap.electrode, [&] {
    return fmt::format("gap.contact = {}: must be positive and below gap.electrode = {}", engineering(d.gap.contact, "m"),
                       engineering(d.gap.electrode, "m"));
  });
  if (d.closes_on_dielectric() || d.landing() != nullptr) {
    const std::string wrong = why_no_landing(d);
    require(wrong.empty(), [&] { return fmt::format("gap.contact = {}: {}", engineering(d.gap.contact, "m"), wrong); });
  }
  if (const auto conflict = electrode_conflict(s, d.electrodes)) {
    throw InvalidInput(fmt::format("electrode.{}: {}", d.electrodes[conflict->electrode].name, conflict->why));
  }
}

/// Checks that a structure with a curved rest shape touches neither an electrode nor a contact at rest.
void check_rest_shape(const Device& d) {
  const double lowest = std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.lowest_rest_offset(d); }) return kind.lowest_rest_offset(d);
        return 0.0;
      },
      d.structure.kind);
  require(lowest > -0.99 * d.gap.electrode, [&] {
    return fmt::format("structure: rests {} nearer to the electrode than a straight one: it would touch the electrode at rest",
                       engineering(-lowest, "m", 4));
  });
  require(d.contact_gap() > 0 && d.contact_gap() < 1, [&] {
    return fmt::format(
        "structure: its contact point rests {} nearer to the contact than that of a straight one, gap.contact = {}: "
        "it would be closed at rest",
        engineering(d.gap.contact - d.contact_gap(), "m", 4), engineering(d.gap.contact, "m"));
  });
  require(!d.touches_along_pad() || (d.rest_offset(d.pad().first) == 0 && d.rest_offset(d.pad().second) == 0),
          "contact.distribution = pad: not with a structure that is curled at rest, whose pad is tilted before it moves");
}

void check_gas(const Gas& g, const Structure& s) {
  if (limits_of(g).needs_thickness && !s.is_built()) positive(s.thickness, "m", "structure.thickness");
  std::visit([](const auto& law) { check_fields("gas", law); }, g);
  const std::vector<LocalSection> sections = local_sections(s);
  const bool has_holes = std::ranges::any_of(sections, [](const LocalSection& one) { return one.holes.exist(); });
  require(!has_holes || std::holds_alternative<StripGas>(g) || std::holds_alternative<LinearGas>(g), [&] {
    return fmt::format("gas.model = {}: not over holes, whose film is that of strip, or a linear damper", name_of(g));
  });
  require(!is_compressible(g) || !s.is_built(),
          "gas.model = reynolds: not with a structure whose width changes, nor with layers");
  const auto* const damper = std::get_if<LinearGas>(&g);
  require(damper == nullptr || std::isnan(damper->damping) != std::isnan(damper->quality_factor),
          "gas.model = linear: needs either damping or quality_factor");
}

void check_place_of_contact(const Device& d, std::size_t i, const std::string& path) {
  const Contact& c = d.contacts[i];
  const double x = d.contact_position(i), length = d.structure.length;
  require(x > 0 && x <= length * (1 + 1e-12), [&] {
    return fmt::format("{}.at = {}: must lie on the beam, whose length is {}", path, engineering(x, "m"),
                       engineering(length, "m"));
  });
  const double gap = d.contact_gap(i);
  require(gap > 0 && gap < 1, [&] {
    return fmt::format("{}.gap: the contact rests {} from its plane; this distance must be positive", path,
                       engineering(gap, "m", 4));
  });
  const bool may_reach = c.side == Side::far || c.along_face || (i == 0 && !d.closes_along_face() && d.closes_on_dielectric());
  require(may_reach || gap < d.gap.electrode + d.rest_offset(x), [&] {
    return fmt::format("{}.gap = {}: must be below gap.electrode = {}", path, engineering(gap, "m"),
                       engineering(d.gap.electrode, "m"));
  });
  require(c.count >= 1 && c.count <= 1e6 && c.count == std::floor(c.count),
          [&] { return fmt::format("{}.count = {}: must be a whole number from 1 on", path, c.count); });
}

void check_contact(const Device& d, std::size_t i) {
  const Contact& c = d.contacts[i];
  const Structure& s = d.structure;
  const std::string path = c.name.empty() ? "contact" : "contact." + c.name;
  const bool rigid = std::holds_alternative<RigidStop>(c.model);
  require(!rigid || s.is_rigid(),
          [&] { return path + ".model = rigid: needs a plate; a beam has modes that take part in an impact"; });
  require(!rigid || !d.gas || !is_compressible(*d.gas), [&] {
    return path + ".model = rigid: not with gas.model = reynolds, whose film still flows under a plate that rests";
  });
  // The contact along a dielectric's face has no pad of its own. On a rigid plate the pad size is not needed when the contact
  // law does not depend on the area.
  const bool no_pad = c.along_face || (s.is_rigid() && !acts_per_area(c.model) && c.pad_length == 0);
  require(no_pad || (c.pad_length > 0 && c.pad_length < s.length), [&] {
    return fmt::format("{}.pad_length = {}: must be positive and below structure.length = {}", path,
                       engineering(c.pad_length, "m"), engineering(s.length, "m"));
  });
  require(std::isnan(c.pad_width) || (c.pad_width > 0 && c.pad_width < 1),
          [&] { return fmt::format("{}.pad_width = {}: must be positive", path, engineering(c.pad_width, "m")); });
  std::visit(
      [&](const auto& law) {
        check_fields(path, law);
        if constexpr (requires { law.why_invalid(d.contact_gap(i)); }) {
          const std::string wrong = law.why_invalid(d.contact_gap(i));
          require(wrong.empty(), wrong);
        }
      },
      c.model);
  if (c.distribution == ContactDistribution::pad) {
    const std::string wrong = why_not_along_pad(s, c);
    require(wrong.empty(), [&] { return path + ".distribution = pad: " + wrong; });
  }
  check_place_of_contact(d, i, path);
}

void check_piezo(const Piezo& p, const Structure& s) {
  require(s.why_no_layer().empty(), [&] { return fmt::format("piezo: {}", s.why_no_layer()); });
  span(p.begin.on(s.length), p.end.on(s.length), s.length, "piezo.span");
  positive(p.thickness, "m", "piezo.thickness");
  positive(p.youngs_modulus, "Pa", "piezo.youngs_modulus");
  positive(p.density, "kg/m^3", "piezo.density");
  require(std::isnan(p.relative_permittivity) || (p.relative_permittivity >= 1 && std::isfinite(p.relative_permittivity)),
          [&] { return fmt::format("piezo.relative_permittivity = {}: must be at least 1", p.relative_permittivity); });
  require(p.d31 > -1 && p.d31 < 1,
          [&] { return fmt::format("piezo.d31 = {}: must be between -1 m/V and 1 m/V", engineering(p.d31, "m/V")); });
  require(std::isnan(p.e31) || std::abs(p.e31) < p.youngs_modulus, [&] {
    return fmt::format("piezo.e31 = {}: must be smaller than piezo.youngs_modulus over a volt per metre",
                       engineering(p.e31, "C/m^2"));
  });
}

void check_dispersion(const Dispersion& v, const Gap& gap) {
  positive(v.hamaker_constant, "J", "dispersion.hamaker_constant");
  require(v.equilibrium_distance >= 0 && v.equilibrium_distance < gap.electrode - gap.contact, [&] {
    return fmt::format("dispersion.equilibrium_distance = {}: must not be negative and lie below the closed gap of {}",
                       engineering(v.equilibrium_distance, "m"), engineering(gap.electrode - gap.contact, "m"));
  });
}

}  // namespace

double Device::contact_position(std::size_t contact) const {
  const Contact* const c = contact < contacts.size() ? &contacts[contact] : nullptr;
  if (c != nullptr && c->at) return c->at->on(structure.length);
  if (structure.has_far_clamp()) return structure.length / 2;
  if (c == nullptr || c->distribution == ContactDistribution::pad) return structure.length;
  return structure.length - c->pad_length / 2;
}

double Device::contact_gap(std::size_t contact) const {
  const double offset = rest_offset(contact_position(contact));
  if (contact == 0) return gap.contact + offset;
  return contacts[contact].gap + (contacts[contact].side == Side::far ? -offset : offset);
}

double Device::rest_offset(double x) const {
  return std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.rest_offset(*this, x); }) return kind.rest_offset(*this, x);
        return 0.0;
      },
      structure.kind);
}

std::vector<Stretch> Electrode::pads(double length) const {
  std::vector<Stretch> all{{begin.on(length), end.on(length)}};
  for (const Span& pad : further) all.push_back({pad.begin.on(length), pad.end.on(length)});
  return all;
}

std::optional<ElectrodeConflict> electrode_conflict(const Structure& s, const std::vector<Electrode>& electrodes) {
  struct Pad {
    std::size_t electrode;
    Stretch at;
  };
  const double rounding = 1e-12 * s.length;
  for (const Side side : {Side::near, Side::far}) {
    const std::string_view side_name = side == Side::near ? "near" : "far";
    std::vector<Pad> here;  // pads of electrodes on one side, in order from the clamped end
    for (std::size_t k = 0; k < electrodes.size(); ++k) {
      if (electrodes[k].side != side && electrodes[k].side != Side::both) continue;
      for (const Stretch& pad : electrodes[k].pads(s.length)) here.push_back({k, pad});
    }
    const bool plate = s.is_rigid();
    if (!plate) std::ranges::stable_sort(here, {}, [](const Pad& pad) { return pad.at.begin; });
    double taken = 0;  // length that pads occupy so far: up to this position on a beam, in total on a plate [m]
    for (std::size_t i = 0; i < here.size(); ++i) {
      const Stretch& pad = here[i].at;
      if (i > 0 && (plate ? taken + pad.end - pad.begin > s.length + rounding : pad.begin < taken - rounding)) {
        const std::string& other = electrodes[here[i - 1].electrode].name;
        return ElectrodeConflict{
            here[i].electrode,
            plate ? fmt::format("the electrodes of the {} side must not have more area together than the plate", side_name)
            : here[i].electrode == here[i - 1].electrode
                ? fmt::format("its pads must not overlap: one of them ends at {}", engineering(taken, "m"))
                : fmt::format("must not overlap electrode.{}, which ends at {} on the {} side too", other,
                              engineering(taken, "m"), side_name)};
      }
      taken = plate ? taken + pad.end - pad.begin : pad.end;
    }
  }
  return std::nullopt;
}

std::optional<ContactConflict> contact_conflict(const Device& d) {
  const std::vector<Contact>& all = d.contacts;
  if (all.empty()) return std::nullopt;
  if (all.front().side != Side::near)
    return ContactConflict{0, "a back stop closes nothing: a contact of side = \"near\" is missing"};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Contact& c = all[i];
    if (c.side == Side::both) return ContactConflict{i, "side must be \"near\" or \"far\""};
    if (c.count > 1 && std::holds_alternative<OwnContact>(c.model))
      return ContactConflict{i, "a user's own law is the force of all contacts together: count must be 1"};
    if (all.size() == 1) break;
    if (std::holds_alternative<RigidStop>(c.model))
      return ContactConflict{i, "a contact with model = \"rigid\" must be the only one"};
    if (c.distribution == ContactDistribution::pad)
      return ContactConflict{i, "a contact with distribution = \"pad\" must be the only one"};
    if (i > 0 && c.side == Side::near && !c.along_face && all[i - 1].side == Side::far)
      return ContactConflict{i, "the contacts of the near side must come first"};
    for (std::size_t k = 0; k < i && !d.structure.is_rigid(); ++k) {
      if (all[k].side != c.side || all[k].along_face || c.along_face) continue;
      if (std::abs(d.contact_position(k) - d.contact_position(i)) > 1e-9 * d.structure.length) continue;
      if (d.contact_gap(k) == d.contact_gap(i))
        return ContactConflict{i, fmt::format("stands at the place of contact.{}, with the same gap: one contact with count = 2 "
                                              "says the same",
                                              all[k].name)};
    }
  }
  return std::nullopt;
}

std::string why_not_along_pad(const Structure& structure, const Contact& contact) {
  // Largest length of a contact pad that counts as straight, as a share of the beam's length. Along such a pad the first mode
  // deviates from its tangent by 5e-5 of the deflection at the free end.
  constexpr double longest = 0.1;
  if (structure.is_rigid()) return "a plate touches with all of its pad at once, as at the centre";
  if (contact.at) return "needs a pad that ends at the free end: 'at' says another place";
  if (structure.has_far_clamp()) {
    return "needs a cantilever, whose tilted pad is straight and touches first with its free end; between two clamps the pad "
           "lies flat about the middle";
  }
  if (const std::string_view why = why_not_along_pad(contact.model); !why.empty()) {
    return fmt::format("not with model = \"{}\"{} {}", name_of(contact.model), why == many_dents ? ":" : ",", why);
  }
  if (contact.pad_length > longest * structure.length * (1 + 1e-12)) {
    return fmt::format("the pad counts as straight, so pad_length must not exceed a tenth of the beam's length, {}",
                       engineering(longest * structure.length, "m"));
  }
  return {};
}

void validate(const Device& d) {
  check_structure(d);
  check_gap_and_electrodes(d);
  check_rest_shape(d);
  if (d.gas) check_gas(*d.gas, d.structure);
  for (std::size_t i = 0; i < d.contacts.size(); ++i) check_contact(d, i);
  if (const auto conflict = contact_conflict(d)) {
    throw InvalidInput(fmt::format("contact.{}: {}", d.contacts[conflict->contact].name, conflict->why));
  }
  if (d.piezo) check_piezo(*d.piezo, d.structure);
  if (d.surface) {
    const std::string wrong = why_no_surface(d);
    require(wrong.empty(), [&] { return "surface: " + wrong; });
  }
  if (d.dispersion && d.dispersion->model != DispersionModel::casimir) check_dispersion(*d.dispersion, d.gap);
}

}  // namespace softland
