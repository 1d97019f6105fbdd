// A complete scene on one screen. Expected messages cite its line numbers.
#pragma once

#include <string>
#include <string_view>

namespace softland {

inline constexpr std::string_view small_scene = R"(title = "small"
[structure]
kind = "cantilever"
length = "250 um"
width = "20 um"
thickness = "4 um"
youngs_modulus = "78 GPa"
density = "19300 kg/m^3"
[gap]
electrode = "3.5 um"
contact = "2 um"
[electrode.main]
span = ["60 um", "240 um"]
[gas]
model = "strip"
viscosity = "1.86e-5 Pa s"
[contact]
model = "linear"
pad_length = "5 um"
stiffness = "100 N/m"
[piezo]
span = ["5 um", "240 um"]
thickness = "1 um"
youngs_modulus = "61 GPa"
density = "7750 kg/m^3"
d31 = "-171 pm/V"
[waveform.main]
family = "step"
level = "1.25 Vdp"
[waveform.piezo]
family = "pulse"
levels = ["0.2 V", "0.6 V", "0 V"]
times = ["20 us", "41 us"]
edge = "5 us"
[driver.piezo]
min_voltage = "-1 V"
max_voltage = "1 V"
[simulate]
accuracy = 1e-5
)";

/// Returns `text` with the first `from` replaced by `to`. Line breaks in `text` stay where they are.
inline std::string edited(std::string_view text, std::string_view from, std::string_view to) {
  std::string result(text);
  result.replace(result.find(from), from.size(), to);
  return result;
}

}  // namespace softland
