// A nickel bridge with its contact at the centre.
#pragma once

#include <string_view>

namespace softland::test {

inline constexpr std::string_view nickel_bridge = R"([structure]
kind = "clamped-clamped"
length = "400 um"
width = "60 um"
thickness = "2 um"
youngs_modulus = "190 GPa"
density = "8900 kg/m^3"
residual_stress = "20 MPa"
modes = 5
[gap]
electrode = "2.5 um"
contact = "1.5 um"
[electrode.main]
span = ["50 um", "350 um"]
[gas]
model = "strip"
[contact]
model = "asperity-uniform"
pad_length = "10 um"
asperity_radius = "100 nm"
asperity_density = "1e12 1/m^2"
asperity_height = "100 nm"
effective_modulus = "60 GPa"
[waveform.main]
family = "step"
level = "1.25 Vdp"
[driver.main]
max_voltage = "1.5 Vdp"
[simulate]
accuracy = 1e-4
)";

}  // namespace softland::test
