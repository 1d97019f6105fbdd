// The devices that tests share, as data sheets.
#pragma once

#include <vector>

#include "base/literals.h"
#include "model/contact/contact_law.h"
#include "model/device.h"

namespace softland::test {

/// Gold cantilever of the reference closing: the device of scenes/mem-gold.toml.
[[nodiscard]] inline Device gold_cantilever() {
  using namespace literals;
  return {
      .structure =
          {.length = 250_um, .width = 20_um, .thickness = 2_um, .youngs_modulus = 78_GPa, .density = 19300_kg_m3, .modes = 4},
      .gap = {.electrode = 3.5_um, .contact = 2_um},
      .electrodes = {{.name = "main", .begin = 60_um, .end = 240_um, .fringing = Fringing::meijs_fokkema}},
      .gas = Gas{.model = GasModel::strip, .viscosity = 1.86e-5_Pa_s},
      .contact = Contact{.model = ContactModel::asperity_uniform,
                         .pad_length = 5_um,
                         .asperity_radius = 100_nm,
                         .asperity_density = 1e11_per_m2,
                         .asperity_height = 100_nm,
                         .effective_modulus = 48_GPa},
  };
}

/// The contact of that device under every contact law, in the order of ContactModel, with damping where the law takes it, and for
/// both laws of yield.
[[nodiscard]] inline std::vector<Contact> contacts() {
  using namespace literals;
  std::vector<Contact> all;
  for (const ContactRow& law : contact_laws) {
    for (const double damping : {0.0, 0.5}) {
      if (damping > 0 && !law.keys.contain("damping")) continue;
      if (law.value == ContactModel::rigid) continue;  // a plate's only
      Contact c = *gold_cantilever().contact;
      c.model = law.value;
      c.stiffness = 1e4_N_m;
      c.unloading_stiffness = 1.5e4_N_m;
      c.hardness = 1_GPa;
      c.asperity_deviation = 30_nm;
      c.adhesion_energy = 0.05_N_m;
      c.damping = damping;
      all.push_back(c);
      if (law.value == ContactModel::elastic_plastic) {
        c.plasticity = Plasticity::kogut_etsion;
        all.push_back(c);
      }
    }
  }
  return all;
}

/// Those of them that can act along the pad, doing so, between surfaces so rough that a tilted pad does not crush them.
[[nodiscard]] inline std::vector<Contact> pad_contacts() {
  using namespace literals;
  std::vector<Contact> all;
  for (Contact c : contacts()) {
    c.distribution = ContactDistribution::pad;
    c.asperity_height = 400_nm;
    if (why_not_along_pad(gold_cantilever().structure, c).empty()) all.push_back(c);
  }
  return all;
}

/// The same with a PZT-5A layer: the device of scenes/mem-gold-pzt.toml.
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
  return {.structure = {.kind = StructureKind::clamped_clamped,
                        .length = 610_um,
                        .width = 40_um,
                        .thickness = 2.2_um,
                        .youngs_modulus = 149_GPa,
                        .density = 2330_kg_m3,
                        .modes = 5,
                        .residual_stress = -3.7e6,
                        .stretching = false},
          .gap = {.electrode = 2.3_um, .contact = 2.07_um},
          .electrodes = {{.name = "main", .begin = 0, .end = 610_um, .fringing = Fringing::none}}};
}

/// A gold bridge in tension with everything a beam between two clamps can have: stretching, two electrodes, film, contact.
[[nodiscard]] inline Device gold_bridge() {
  Device device = gold_cantilever();
  device.structure.kind = StructureKind::clamped_clamped;
  device.structure.modes = 5;
  device.structure.residual_stress = 2e6;
  device.electrodes.push_back({.name = "second", .begin = 0, .end = 60e-6, .fringing = Fringing::linear});
  return device;
}

/// Nickel switch lumped to a plate on springs: the device of scenes/purdue-nickel.toml. 510 x 123 um.
[[nodiscard]] inline Device nickel_plate() {
  using namespace literals;
  return {.structure = {.kind = StructureKind::plate,
                        .length = 510_um,
                        .width = 123_um,
                        .thickness = 4_um,
                        .mass = 9.2371e-10,
                        .stiffness = 91.303},
          .gap = {.electrode = 3.49_um, .contact = 3.14_um},
          .electrodes = {{.name = "main", .begin = 0, .end = 510_um, .fringing = Fringing::none}}};
}

/// A plate on springs with everything a plate can have: two electrodes, film, linear contact.
[[nodiscard]] inline Device full_plate() {
  using namespace literals;
  return {
      .structure =
          {.kind = StructureKind::plate, .length = 100_um, .width = 100_um, .thickness = 3_um, .mass = 2.4e-9, .stiffness = 42},
      .gap = {.electrode = 3.8_um, .contact = 2.6_um},
      .electrodes = {{.name = "main", .begin = 0, .end = 70_um, .fringing = Fringing::meijs_fokkema},
                     {.name = "second", .begin = 0, .end = 30_um, .fringing = Fringing::linear}},
      .gas = Gas{.model = GasModel::strip, .viscosity = 1e-6_Pa_s},
      .contact = Contact{.model = ContactModel::linear, .stiffness = 1e4_N_m}};
}

/// Titanium nitride nano-cantilever: the device of scenes/nem-tin.toml.
[[nodiscard]] inline Device nano_cantilever() {
  using namespace literals;
  return {
      .structure = {.length = 300_nm,
                    .width = 200_nm,
                    .thickness = 30_nm,
                    .youngs_modulus = 220_GPa,
                    .density = 5400_kg_m3,
                    .modes = 4,
                    .damping_ratio = 0.01},
      .gap = {.electrode = 20_nm, .contact = 15_nm},
      .electrodes = {{.name = "main", .begin = 0, .end = 300_nm, .fringing = Fringing::meijs_fokkema}},
      .contact = Contact{.model = ContactModel::asperity_uniform,
                         .pad_length = 30_nm,
                         .asperity_radius = 10_nm,
                         .asperity_density = 4e15_per_m2,
                         .asperity_height = 2_nm,
                         .effective_modulus = 120_GPa},
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
                    .youngs_modulus = 78_GPa,
                    .density = 19300_kg_m3,
                    .modes = 4,
                    .damping_ratio = 0.01},
      .gap = {.electrode = 50_nm, .contact = 30_nm},
      .contact = Contact{.model = ContactModel::asperity_uniform,
                         .pad_length = 200_nm,
                         .asperity_radius = 20_nm,
                         .asperity_density = 1e14_per_m2,
                         .asperity_height = 4_nm,
                         .effective_modulus = 48_GPa},
      .dispersion = Dispersion{.model = DispersionModel::casimir, .conductor = Conductor::gold},
  };
}

/// The full plate with the second electrode above the plate and a film there as well; see scenes/two-electrodes.toml.
[[nodiscard]] inline Device plate_between_electrodes() {
  using namespace literals;
  Device d = full_plate();
  d.electrodes[1].side = Side::far;
  d.electrodes[1].gap = 3.8_um;
  d.gas->far_gap = 3.8_um;
  return d;
}

/// The gold cantilever with an electrode above it, under a film, and one whose faces stand on both sides.
[[nodiscard]] inline Device cantilever_between_electrodes() {
  using namespace literals;
  Device d = gold_cantilever();
  d.electrodes.push_back({.name = "upper", .begin = 100_um, .end = 200_um, .side = Side::far, .gap = 3_um});
  d.electrodes.push_back({.name = "around", .begin = 20_um, .end = 60_um, .side = Side::both, .gap = 4_um});
  d.gas->far_gap = 3_um;
  return d;
}

}  // namespace softland::test
