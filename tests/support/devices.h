// Devices that several tests use, as data sheets.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/literals.h"
#include "model/contact/contact_law.h"
#include "model/device.h"

namespace softland::test {

/// Gold cantilever of the reference closing: the device of scenes/mem-gold.toml.
[[nodiscard]] inline Device gold_cantilever() {
  using namespace literals;
  return {
      .structure = {.length = 250_um,
                    .width = 20_um,
                    .thickness = 2_um,
                    .modes = 4,
                    .kind = Cantilever{{.youngs_modulus = 78_GPa, .density = 19300_kg_m3}}},
      .gap = {.electrode = 3.5_um, .contact = 2_um},
      .electrodes = {{.name = "main", .begin = 60_um, .end = 240_um, .fringing = Fringing::meijs_fokkema}},
      .gas = StripGas{.film = {.viscosity = 1.86e-5_Pa_s}},
      .contacts = {Contact{
          .model = UniformAsperities{.summits = {.radius = 100_nm, .density = 1e11_per_m2, .effective_modulus = 48_GPa},
                                     .height = 100_nm},
          .pad_length = 5_um}},
  };
}

/// Returns the contact of the gold cantilever's pad under this law.
[[nodiscard]] inline Contact gold_contact(const ContactModel& model) {
  return {.model = model, .pad_length = gold_cantilever().contacts.front().pad_length};
}
/// Returns the summits of a contact with the law asperity-uniform.
[[nodiscard]] inline UniformAsperities& rough(Device& device) {
  return std::get<UniformAsperities>(device.contacts.front().model);
}

/// Returns the gas of the gold cantilever, which has the law strip.
[[nodiscard]] inline FilmState& film(Device& device) { return std::get<StripGas>(*device.gas).film; }
/// Returns the gas of the gold cantilever under every law.
[[nodiscard]] inline std::vector<Gas> gases() {
  std::vector<Gas> all;
  for_each_law<Gas>(
      [&]<class Law>(std::type_identity<Law>) { all.push_back(under(*gold_cantilever().gas, Gas(Law::example()))); });
  return all;
}

/// Returns the example of a law, and if the law has damping or choices, examples with them.
template <class Law>
[[nodiscard]] std::vector<Law> examples(double damping) {
  std::vector<Law> all{Law::example()};
  for (const Field<Law>& field : fields_of<Law>) {
    if (field.key == "damping") {
      all.push_back(Law::example());
      field.in(all.back()) = damping;
    }
    if (field.words == nullptr) continue;
    all.clear();
    for (const std::string_view word : field.words()) {
      all.push_back(Law::example());
      field.choose(all.back(), word);
    }
  }
  return all;
}

[[nodiscard]] inline double damping(const Contact& contact) { return number_of(contact.model, "damping", 0); }
/// Describes a contact for messages.
[[nodiscard]] inline std::string described(const Contact& contact) {
  return fmt::format("{}, damping {}{}", name_of(contact.model), damping(contact),
                     contact.distribution == ContactDistribution::pad ? ", along the pad" : "");
}

/// Returns the contact of the gold cantilever under every contact law, in their order: with damping if the law has it, and with
/// both laws of yield.
[[nodiscard]] inline std::vector<Contact> contacts() {
  std::vector<Contact> all;
  for_each_law<ContactModel>([&]<class Law>(std::type_identity<Law>) {
    if constexpr (!std::is_same_v<Law, RigidStop>) {  // for plates only
      for (const Law& law : examples<Law>(0.5)) all.push_back(gold_contact(law));
    }
  });
  return all;
}

/// Returns the contacts of those laws that can act along the pad. Their surfaces are so rough that a tilted pad does not crush
/// them.
[[nodiscard]] inline std::vector<Contact> pad_contacts() {
  using namespace literals;
  std::vector<Contact> all;
  for (Contact c : contacts()) {
    c.distribution = ContactDistribution::pad;
    if (double* const height = number_of(c.model, "asperity_height")) *height = 400_nm;
    if (why_not_along_pad(gold_cantilever().structure, c).empty()) all.push_back(c);
  }
  return all;
}

/// Gold cantilever with a PZT-5A layer: the device of scenes/mem-gold-pzt.toml.
[[nodiscard]] inline Device gold_pzt_cantilever() {
  using namespace literals;
  Device device = gold_cantilever();
  device.piezo =
      Piezo{.begin = 5_um, .end = 240_um, .thickness = 1_um, .youngs_modulus = 61_GPa, .density = 7750_kg_m3, .d31 = -171_pm_V};
  return device;
}

/// Polysilicon beam between two clamps of Hung and Senturia 1999: the device of scenes/hung-senturia.toml, without its gas.
[[nodiscard]] inline Device hung_senturia() {
  using namespace literals;
  return {.structure = {.length = 610_um,
                        .width = 40_um,
                        .thickness = 2.2_um,
                        .modes = 5,
                        .kind = Bridge{{.youngs_modulus = 149_GPa, .density = 2330_kg_m3}, -3.7e6, false, false}},
          .gap = {.electrode = 2.3_um, .contact = 2.07_um},
          .electrodes = {{.name = "main", .begin = 0, .end = 610_um, .fringing = Fringing::none}}};
}

/// A gold bridge in tension with all features of a beam between two clamps: stretching, two electrodes, film, contact.
[[nodiscard]] inline Device gold_bridge() {
  Device device = gold_cantilever();
  device.structure.kind = Bridge{part_of<Beam>(device.structure)};
  device.structure.modes = 5;
  part_of<Bridge>(device.structure).residual_stress = 2e6;
  device.electrodes.push_back({.name = "second", .begin = 0, .end = 60e-6, .fringing = Fringing::linear});
  return device;
}

/// Nickel switch lumped to a plate on springs: the device of scenes/purdue-nickel.toml. 510 x 123 um.
[[nodiscard]] inline Device nickel_plate() {
  using namespace literals;
  return {
      .structure = {.length = 510_um, .width = 123_um, .thickness = 4_um, .kind = Plate{.mass = 9.2371e-10, .stiffness = 91.303}},
      .gap = {.electrode = 3.49_um, .contact = 3.14_um},
      .electrodes = {{.name = "main", .begin = 0, .end = 510_um, .fringing = Fringing::none}}};
}

/// A plate on springs with all features of a plate: two electrodes, film, linear contact.
[[nodiscard]] inline Device full_plate() {
  using namespace literals;
  return {.structure = {.length = 100_um, .width = 100_um, .thickness = 3_um, .kind = Plate{.mass = 2.4e-9, .stiffness = 42}},
          .gap = {.electrode = 3.8_um, .contact = 2.6_um},
          .electrodes = {{.name = "main", .begin = 0, .end = 70_um, .fringing = Fringing::meijs_fokkema},
                         {.name = "second", .begin = 0, .end = 30_um, .fringing = Fringing::linear}},
          .gas = StripGas{.film = {.viscosity = 1e-6_Pa_s}},
          .contacts = {Contact{.model = LinearSpring{.stiffness = 1e4_N_m}}}};
}

/// Titanium nitride nano-cantilever: the device of scenes/nem-tin.toml.
[[nodiscard]] inline Device nano_cantilever() {
  using namespace literals;
  return {
      .structure = {.length = 300_nm,
                    .width = 200_nm,
                    .thickness = 30_nm,
                    .modes = 4,
                    .damping_ratio = 0.01,
                    .kind = Cantilever{{.youngs_modulus = 220_GPa, .density = 5400_kg_m3}}},
      .gap = {.electrode = 20_nm, .contact = 15_nm},
      .electrodes = {{.name = "main", .begin = 0, .end = 300_nm, .fringing = Fringing::meijs_fokkema}},
      .contacts = {Contact{
          .model = UniformAsperities{.summits = {.radius = 10_nm, .density = 4e15_per_m2, .effective_modulus = 120_GPa},
                                     .height = 2_nm},
          .pad_length = 30_nm}},
      .dispersion = Dispersion{.model = DispersionModel::automatic, .hamaker_constant = 4e-19, .equilibrium_distance = 0.3_nm},
  };
}

/// Gold nano-cantilever that the Casimir force closes at 1.25 times its strength: the device of scenes/nem-casimir.toml.
[[nodiscard]] inline Device casimir_cantilever() {
  using namespace literals;
  return {
      .structure = {.length = 5.1_um,
                    .width = 1_um,
                    .thickness = 50_nm,
                    .modes = 4,
                    .damping_ratio = 0.01,
                    .kind = Cantilever{{.youngs_modulus = 78_GPa, .density = 19300_kg_m3}}},
      .gap = {.electrode = 50_nm, .contact = 30_nm},
      .contacts = {Contact{
          .model = UniformAsperities{.summits = {.radius = 20_nm, .density = 1e14_per_m2, .effective_modulus = 48_GPa},
                                     .height = 4_nm},
          .pad_length = 200_nm}},
      .dispersion = Dispersion{.model = DispersionModel::casimir, .conductor = Conductor::gold},
  };
}

/// The full plate with its second electrode above the plate, and a film there as well (scenes/two-electrodes.toml).
[[nodiscard]] inline Device plate_between_electrodes() {
  using namespace literals;
  Device d = full_plate();
  d.electrodes[1].side = Side::far;
  d.electrodes[1].gap = 3.8_um;
  std::get<StripGas>(*d.gas).far_gap = 3.8_um;
  return d;
}

/// The gold cantilever with an electrode and a film above it, and an electrode with faces on both sides.
[[nodiscard]] inline Device cantilever_between_electrodes() {
  using namespace literals;
  Device d = gold_cantilever();
  d.electrodes.push_back({.name = "upper", .begin = 100_um, .end = 200_um, .side = Side::far, .gap = 3_um});
  d.electrodes.push_back({.name = "around", .begin = 20_um, .end = 60_um, .side = Side::both, .gap = 4_um});
  std::get<StripGas>(*d.gas).far_gap = 3_um;
  return d;
}

}  // namespace softland::test
