#include "config/schema/sections.h"

namespace softland::internal {

constexpr std::string_view no_amplification =
    "gain is an error of the source; an amplifier between source and switch is the key amplifier, "
    "volts at the switch per volt of the source, and all voltages are then those at the switch";

Section driver_section() {
  Key bits{.name = "bits",
           .type = KeyType::integer,
           .range = {.least = 1, .most = 24},
           .about = "of the samples: 2^bits voltages from min_voltage to max_voltage; absent: samples are not rounded"};
  return {
      .name = "driver",
      .is_named = true,
      .keys =
          {number("min_voltage", drive_voltage, any, "default for an electrode: 0 V"),
           number("max_voltage", drive_voltage, any, "default for an electrode: 1.5 times the larger of Vsp and Vdp"),
           number("max_slew", {dimension::slew_rate}, positive, "absent: unlimited"),
           number("bandwidth", {dimension::frequency}, positive, "of the source, of first order; absent: unlimited")
               .such_as("1 MHz"),
           number("source_resistance", {dimension::resistance}, positive,
                  "through which it charges the open switch; absent: none"),
           number("parallel_capacitance", {dimension::capacitance}, not_negative,
                  "beside the switch, behind source_resistance; default 0 F"),
           number("sample_rate", {dimension::frequency}, positive, "samples are held; absent: none are taken").such_as("25 MHz"),
           std::move(bits),
           number("amplifier", {dimension::none}, positive,
                  "volts at the switch per volt of the source: all voltages of a scene are those at the switch; default 1"),
           number("gain", {dimension::none}, {.least = 0.5, .most = 2},
                  "error of the source: V(t) = gain f(t - delay) + offset; default 1")
               .or_else(no_amplification),
           number("offset", {dimension::voltage}, any, "from t = 0 on; default 0 V"),
           number("delay", {dimension::time}, not_negative, "of the whole waveform; default 0 s")},
      .about = "limits of the source, hard bounds of every search, and what it makes of a waveform"};
}

}  // namespace softland::internal
