// The devices that tests share, as data sheets.
#pragma once

#include "base/literals.h"
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

/// The same with a PZT-5A layer: the device of scenes/mem-gold-pzt.toml.
[[nodiscard]] inline Device gold_pzt_cantilever() {
  using namespace literals;
  Device device = gold_cantilever();
  device.piezo =
      Piezo{.begin = 5_um, .end = 240_um, .thickness = 1_um, .youngs_modulus = 61_GPa, .density = 7750_kg_m3, .d31 = -171_pm_V};
  return device;
}

}  // namespace softland::test
