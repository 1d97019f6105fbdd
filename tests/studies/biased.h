// Small switches that one drive holds deflected while another drive closes them.
#pragma once

#include <initializer_list>
#include <string_view>

#include "config/scene.h"

namespace softland {

/// Returns a silicon beam with a piezo layer, which closes in a few microseconds.
inline SceneFile small_beam(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = SceneFile::parse(R"(
[structure]
kind = "cantilever"
length = "120 um"
width = "20 um"
thickness = "2 um"
youngs_modulus = "160 GPa"
density = "2330 kg/m^3"
modes = 2
damping_ratio = 0.05
[gap]
electrode = "1.5 um"
contact = "0.9 um"
[electrode.main]
span = ["40 um", "110 um"]
[contact]
model = "linear"
pad_length = "4 um"
stiffness = "500 N/m"
[piezo]
span = ["5 um", "110 um"]
thickness = "0.5 um"
youngs_modulus = "70 GPa"
density = "7500 kg/m^3"
d31 = "-100 pm/V"
[waveform.main]
family = "step"
level = "1.2 Vdp"
[simulate]
accuracy = 1e-6
)",
                                    "small.toml");
  for (const std::string_view change : changes) file.set(change);
  return file;
}

/// Returns a plate on a spring between two electrodes on the near side, for which closed forms exist.
inline SceneFile two_area_plate(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = SceneFile::parse(R"(
[structure]
kind = "plate"
area = "1e-8 m^2"
mass = "2e-9 kg"
stiffness = "40 N/m"
[gap]
electrode = "3 um"
contact = "2.9 um"
[electrode.main]
area = "0.6e-8 m^2"
fringing = "none"
[electrode.bias]
area = "0.4e-8 m^2"
fringing = "none"
[contact]
model = "linear"
stiffness = "1e5 N/m"
[waveform.main]
family = "step"
level = "1.1 Vdp"
)",
                                    "plate.toml");
  for (const std::string_view change : changes) file.set(change);
  return file;
}

}  // namespace softland
