#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "config/schema/laws.h"
#include "config/schema/sections.h"

namespace softland::internal {
namespace {

Contact& contact(Scene& scene, std::size_t k) { return scene.device.contacts[k]; }
ContactModel& contact_model(Scene& scene, std::size_t k) { return scene.device.contacts[k].model; }
using OfContact = Of<contact>;

Key place_key() {
  Key key = internal::number(
      "at", {dimension::length, dimension::none}, not_negative,
      "position of the centre of the pad, from the clamped end; absent: the pad ends at the free end, or is in the middle");
  key.words = {tip};
  key.bound.place = [](Scene& scene, std::size_t k, std::size_t) -> Place& {
    std::optional<Place>& at = contact(scene, k).at;
    if (!at) at.emplace();
    return *at;
  };
  return key;
}

Key gap_key() {
  Key key = internal::number(
      "gap", {dimension::length}, positive,
      "gap between the contact point and its contact plane at rest; only for [contact.NAME], and required there");
  key.bound.number = [](Scene& scene, std::size_t k) -> double& {
    return k == 0 ? scene.device.gap.contact : contact(scene, k).gap;
  };
  return key;
}

template <auto member>
Key conduction_key(std::string_view name, const Dimension& dimension, Range range, std::string_view about) {
  Key key = internal::number(name, {dimension}, range, about);
  key.bound.number = [](Scene& scene, std::size_t k) -> double& { return contact(scene, k).conduction.*member; };
  return key;
}

// Returns the keys of the resistance of the closed contact (model/contact/resistance.h). The key hardness is for contact laws
// that have no parameter of this name.
std::vector<Key> conduction_keys() {
  Key hardness =
      conduction_key<&Conduction::hardness>("hardness", dimension::pressure, positive,
                                            "hardness of the softer metal: conducting spots are plastic at this pressure; "
                                            "required with resistivity by laws without asperities");
  for_each_law<ContactModel>([&]<class Law>(std::type_identity<Law>) {
    if constexpr (!requires(Law law) { law.hardness; }) hardness.only_for.push_back(Law::name);
  });
  return {
      conduction_key<&Conduction::resistivity>(
          "resistivity", dimension::resistivity, positive,
          "resistivity of both metals, the mean of two, which gives the contact resistance; absent: no resistance is computed")
          .such_as("22 nohm m"),
      std::move(hardness).such_as("1 GPa"),
      conduction_key<&Conduction::film_resistance>("film_resistance", dimension::resistance, not_negative,
                                                   "resistance in series with each contact; default 0"),
      conduction_key<&Conduction::mean_free_path>(
          "mean_free_path", dimension::length, not_negative,
          "mean free path of the electrons, which increases the resistance of spots of that size; default 0: constriction alone")
          .such_as("38 nm")};
}

std::vector<Key> contact_keys() {
  std::vector<Key> keys = keys_of_laws<ContactModel, contact_model>("law of the contact force; rigid is for a plate only");
  const auto of_every_law = {
      OfContact::number<&Contact::pad_length>("pad_length", dimension::length, positive,
                                              "length of the pad, less than that of the beam; "
                                              "required, but not for a plate on a linear, hysteretic or rigid contact"),
      OfContact::number<&Contact::pad_width>("pad_width", dimension::length, positive,
                                             "width of one pad; absent: that of the beam"),
      OfContact::choice<contact_distributions, &Contact::distribution>(
          "distribution", "where the force acts: at the centre of the pad, or wherever the pad is beyond the contact plane")
          .by_default("'centre'"),
      place_key(),
      gap_key(),
      one_of("side", {name_of(sides, Side::near), name_of(sides, Side::far)},
             "side of the contact; far: a back stop on the side away from the electrode; only for [contact.NAME]; default near"),
      OfContact::number<&Contact::count>(
          "count", dimension::none, {.least = 1, .most = 1000},
          "whole number of equal contacts side by side across the beam, which share the force; default 1")
          .such_as("2")
          .fixed("it is a number of contacts")};
  keys.insert(keys.begin() + 1, of_every_law);
  std::ranges::move(conduction_keys(), std::back_inserter(keys));
  return keys;
}

void check_pad_length(const Device& d, const Contact& c, const SectionReader& in) {
  const bool per_area = acts_per_area(c.model);
  if (!in.is_given("pad_length")) {
    if (d.structure.is_rigid() && !per_area) return;  // for a plate, only a contact law per area needs the pad length
    in.fail(R"(missing key 'pad_length' (a length such as "2 um"))");
  }
  if (per_area && !in.is_given("pad_width")) in.require_of_structure("pad_length", "width", d.structure);
  in.require(c.pad_length < d.structure.length, "pad_length", "must be less than " + in.written_length(d.structure));
}

/// Checks the name and the key `gap` of contact number k in a scene with sections [contact.NAME].
void check_named(const Device& d, std::size_t k, const SectionReader& in) {
  const Contact& c = d.contacts[k];
  constexpr std::size_t longest = 64;
  if (!is_bare_key(c.name) || c.name.size() > longest)
    in.fail(fmt::format("a name must consist of at most {} letters, digits, '_' and '-'", longest));
  if (!in.is_given("gap")) in.fail(R"(missing key 'gap' (a length such as "2 um"))");
  const double own = in.number("gap");
  const SectionReader gap(in.file(), "gap");
  constexpr double most = 0.99;  // largest gap of the contact as a share of the electrode gap, as in check_gap()
  in.require(c.side == Side::far || own < most * d.gap.electrode, "gap",
             fmt::format("must be less than {:g} times {}", most, gap.written("electrode")));
}

void check_conduction(const Contact& c, const SectionReader& in) {
  if (!c.conduction.is_given()) {
    for (const std::string_view key : {"film_resistance", "mean_free_path"})
      in.require(!in.is_given(key), key, "needs 'resistivity', without which no resistance is computed");
    const bool is_of_law = number_of(c.model, "hardness", 0) > 0;
    in.require(is_of_law || !in.is_given("hardness"), "hardness", "needs 'resistivity', without which no resistance is computed");
    return;
  }
  in.require(c.distribution == ContactDistribution::centre, "resistivity",
             "must not be given with distribution = \"pad\", whose load differs from point to point of the pad");
  in.require(c.side == Side::near, "resistivity", "belongs to a contact on the near side: a back stop makes no connection");
  in.require(!std::holds_alternative<AdhesiveRepulsiveSurfaces>(c.model), "resistivity",
             "must not be given with model = \"adhesive-repulsive\", "
             "which does not separate the load on the metal from the pressure of the film");
  const bool has_summits = number_of(c.model, "effective_modulus", 0) > 0;
  if (!has_summits && !(c.conduction.hardness > 0))
    in.fail(R"(missing key 'hardness' (a pressure such as "1 GPa"), which gives the size of a conducting spot under its load)");
}

void check_contact(Scene& scene, const SectionReader& in, std::size_t k) {
  Device& d = scene.device;
  Contact& c = d.contacts[k];
  if (in.is_given("side")) c.side = find_named(sides, in.text("side"))->value;
  c.connects = c.side == Side::near;
  check_pad_length(d, c, in);
  if (in.is_given("at")) {
    in.require(!d.structure.is_rigid(), "at", "belongs to a beam: a plate touches with its whole area");
    in.require(d.contact_position(k) > 0 && d.contact_position(k) <= d.structure.length, "at",
               "must lie on the beam: " + in.written_length(d.structure));
  }
  if (in.is_given("count")) in.require(c.count == std::floor(c.count), "count", "must be a whole number");
  if (c.name.empty()) {
    for (const std::string_view key : {"gap", "side"})
      in.require(!in.is_given(key), key, "belongs to [contact.NAME]; the contact plane of a single [contact] is at gap.contact");
  } else {
    check_named(d, k, in);
  }
  if (std::holds_alternative<RigidStop>(c.model)) {
    in.require(d.structure.is_rigid(), "model", "needs a plate: a beam has modes that take part in an impact");
    in.require(!d.gas || !is_compressible(*d.gas), "model",
               "must not be given with gas.model = \"reynolds\", whose film still flows under a plate at rest");
  }
  check_bounds(c.model, in);
  check_conduction(c, in);
  if (c.distribution == ContactDistribution::pad) {
    const std::string wrong = why_not_along_pad(d.structure, c);
    in.require(wrong.empty(), "distribution", wrong);
  }
}

}  // namespace

Section contact_section() {
  return {
      .name = "contact",
      .may_be_named = true,
      .may_vary = true,
      .selector = "model",
      .keys = contact_keys(),
      .about = "contact under the tip, or one [contact.NAME] of several; absent: no contact",
      .advice = {{"dimple", "'count' gives the number of equal contacts side by side, [contact.NAME] a contact at another place"},
                 {"number", "'count' gives the number of equal contacts side by side, [contact.NAME] a contact at another place"},
                 {"rough",
                  "the roughness of a face is 'asperity_deviation' with model = \"asperity-gaussian\", "
                  "and 'asperity_height' with model = \"asperity-uniform\""}},
      .begin =
          [](Scene& scene, const SectionReader& in, std::string_view name) {
            scene.device.contacts.push_back({.model = law_of<ContactModel>(in), .name = std::string(name)});
            return scene.device.contacts.size() - 1;
          },
      .check = check_contact};
}

}  // namespace softland::internal
