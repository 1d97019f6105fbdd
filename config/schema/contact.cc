#include <fmt/format.h>

#include "config/schema/sections.h"
#include "config/section_reader.h"
#include "model/contact/contact_law.h"

namespace softland::internal {
namespace {

Contact& contact(Scene& scene, std::size_t) { return *scene.device.contact; }
SurfacePressure& pressure(Scene& scene, std::size_t) { return scene.device.contact->pressure; }
using OfContact = Of<contact>;

constexpr std::string_view refused_plasticity = "ceb";

/// Numbers that belong to the laws which list them.
template <auto member>
Key contact_number(std::string_view name, const Dimension& dimension, std::string_view about, Range range = positive) {
  return OfContact::number<member>(name, dimension, range, about).of(with_key(contact_laws, name));
}
template <auto member>
Key number_of_pressure(std::string_view name, const Dimension& dimension, std::string_view fallback, std::string_view about) {
  return Of<pressure>::number<member>(name, dimension, positive, about).by_default(fallback).of(with_key(contact_laws, name));
}

std::vector<Key> contact_keys() {
  Key plasticity =
      OfContact::choice<plasticities, &Contact::plasticity>("plasticity", "law of one asperity; ceb jumps and is refused");
  plasticity.choices.push_back(refused_plasticity);
  return {
      OfContact::choice<contact_laws, &Contact::model>("model", "law of the contact force").needed(),
      OfContact::number<&Contact::pad_length>("pad_length", dimension::length, positive,
                                              "the pad ends at the free end, or lies about the middle between two clamps"),
      OfContact::choice<contact_distributions, &Contact::distribution>(
          "distribution", "where the force acts: at the pad's centre, or wherever the pad is beyond the plane")
          .by_default("'centre'"),
      contact_number<&Contact::stiffness>("stiffness", dimension::stiffness,
                                          "contact force per penetration; hysteretic: while loading")
          .needed(),
      contact_number<&Contact::unloading_stiffness>("unloading_stiffness", dimension::stiffness,
                                                    "not below stiffness; restitution squared is stiffness over this")
          .needed(),
      contact_number<&Contact::asperity_radius>("asperity_radius", dimension::length, "radius of the summits")
          .needed()
          .such_as("100 nm"),
      contact_number<&Contact::asperity_density>("asperity_density", dimension::area_density, "summits per area")
          .needed()
          .such_as("1e11 1/m^2"),
      contact_number<&Contact::asperity_height>("asperity_height", dimension::length,
                                                "summit heights are uniform on [0, asperity_height]")
          .needed()
          .such_as("100 nm"),
      contact_number<&Contact::asperity_deviation>(
          "asperity_deviation", dimension::length,
          "standard deviation of the summit heights; first touch at four of them above their mean")
          .needed()
          .such_as("10 nm"),
      contact_number<&Contact::effective_modulus>("effective_modulus", dimension::pressure, "E* of the pair of surfaces")
          .needed()
          .such_as("48 GPa"),
      contact_number<&Contact::hardness>("hardness", dimension::pressure, "of the softer surface").needed().such_as("1 GPa"),
      std::move(plasticity).by_default("'zmc'").of(with_key(contact_laws, "plasticity")),
      contact_number<&Contact::adhesion_energy>("adhesion_energy", dimension::stiffness,
                                                "work of adhesion per area of the pair of surfaces")
          .needed()
          .such_as("0.1 J/m^2"),
  };
}

std::vector<Key> keys_of_pressure() {
  using P = SurfacePressure;
  return {
      number_of_pressure<&P::asperity_pressure>("asperity_pressure", dimension::pressure, "'1.2 kPa'",
                                                "of the asperities, a nanometre within asperity_distance"),
      number_of_pressure<&P::asperity_distance>("asperity_distance", dimension::length, "'110 nm'",
                                                "between the mean planes when asperities meet"),
      number_of_pressure<&P::wall_pressure>("wall_pressure", dimension::pressure, "'0.5 GPa'",
                                            "of the soft wall, continued to distance 0"),
      number_of_pressure<&P::wall_range>("wall_range", dimension::length, "'8.5 nm'", "over which the soft wall falls by e"),
      number_of_pressure<&P::adhesion_pressure>("adhesion_pressure", dimension::pressure, "'1 kPa'",
                                                "of adhesion, a nanometre within its range"),
      number_of_pressure<&P::adhesion_range>("adhesion_range", dimension::length, "'2 nm'",
                                             "how far beyond asperity_distance adhesion begins"),
      number_of_pressure<&P::hamaker_constant>("hamaker_constant", dimension::energy, "'2.15e-19 J'",
                                               "of the attraction from afar"),
      number_of_pressure<&P::smoothing_distance>("smoothing_distance", dimension::length, "'30 nm'",
                                                 "keeps that attraction finite"),
      number_of_pressure<&P::reach>("reach", dimension::length, "'1 um'",
                                    "distance of the mean planes beyond which nothing acts"),
      contact_number<&Contact::restitution>("restitution", dimension::none, "velocity after an impact over that before",
                                            below_one)
          .needed(),
      contact_number<&Contact::damping>(
          "damping", dimension::slowness,
          "of Hunt and Crossley: restitution about 1 over 1 + damping times impact velocity; absent: none"),
  };
}

void check_pad_length(const Device& d, const SectionReader& in) {
  const bool plate = d.structure.kind == StructureKind::plate;
  const bool per_area = row_of(contact_laws, d.contact->model).per_area;
  if (!in.is_given("pad_length")) {
    if (plate && !per_area) return;  // only the area of a plate's pad would count
    in.fail(R"(missing key 'pad_length' (a length such as "2 um"))");
  }
  if (per_area) in.require_of_plate("pad_length", "width");
  in.require(d.contact->pad_length < d.structure.length, "pad_length",
             "must be less than " + (plate ? "structure.area / structure.width" : in.file().written("structure.length")));
}

void check_contact(Scene& scene, const SectionReader& in, std::size_t) {
  const Device& d = scene.device;
  const Contact& c = *d.contact;
  check_pad_length(d, in);
  if (c.model == ContactModel::rigid) {
    in.require(d.structure.kind == StructureKind::plate, "model", "needs a plate: a beam has modes that take part in an impact");
    in.require(!d.gas || !is_compressible(d.gas->model), "model",
               "not with gas.model = \"reynolds\", whose film still flows under a plate that rests");
  }
  if (in.has_value("unloading_stiffness")) {
    in.require(c.unloading_stiffness >= c.stiffness, "unloading_stiffness", "must not be below " + in.written("stiffness"));
  }
  if (c.distribution == ContactDistribution::pad) {
    const std::string wrong = why_not_along_pad(d.structure, c);
    in.require(wrong.empty(), "distribution", wrong);
  }
}

}  // namespace

Section contact_section() {
  std::vector<Key> all = contact_keys();
  for (Key& key : keys_of_pressure()) all.push_back(std::move(key));
  return {.name = "contact",
          .may_vary = true,
          .selector = "model",
          .keys = std::move(all),
          .about = "contact under the tip; absent: the tip meets nothing",
          .begin =
              [](Scene& scene, const SectionReader& in, std::string_view) {
                in.require(!in.has_value("plasticity") || in.text("plasticity") != refused_plasticity, "plasticity",
                           "the force of Chang, Etsion and Bogy as published jumps by about half at the critical interference, "
                           "which no integrator of motion can use; take \"zmc\" or \"ke\"");
                scene.device.contact.emplace();
                return std::size_t{0};
              },
          .check = check_contact};
}

}  // namespace softland::internal
