#include "config/schema/sections.h"

namespace softland::internal {

constexpr std::string_view no_amplification =
    "gain is an error of the source; an amplifier between source and switch is the key amplifier, "
    "volts at the switch per volt of the source, and all voltages are then those at the switch";

Section driver_section() {
  Key bits{.name = "bits",
           .type = KeyType::integer,
           .range = {.least = 1, .most = 24},
           .about =
               "samples are rounded to 2^bits evenly spaced voltages from min_voltage to max_voltage; "
               "needs sample_rate and max_voltage; absent: not rounded"};
  return {
      .name = "driver",
      .is_named = true,
      .keys = {number("min_voltage", drive_voltage, any,
                      "smallest voltage, below max_voltage; default for an electrode: 0 V; required for the piezo"),
               number("max_voltage", drive_voltage, any,
                      "largest voltage; default for an electrode: 1.5 times the larger of Vsp and Vdp; required for the piezo"),
               number("max_slew", {dimension::slew_rate}, positive, "largest rate of change; absent: unlimited"),
               number("bandwidth", {dimension::frequency}, positive,
                      "first-order bandwidth of the amplifier, 1/(2 pi T) with the time constant T; "
                      "absent: unlimited")
                   .such_as("1 MHz"),
               number("source_resistance", {dimension::resistance}, positive,
                      "resistance R through which the source charges the open switch, first order "
                      "with T = R (C + parallel_capacitance); absent: none"),
               number("parallel_capacitance", {dimension::capacitance}, not_negative,
                      "of leads, pads and instruments beside the switch, behind source_resistance, which it needs; default 0 F"),
               number("sample_rate", {dimension::frequency}, positive,
                      "rate of samples, each held until the next, at most 1e5 in the window; absent: no sampling")
                   .such_as("25 MHz"),
               std::move(bits),
               number("amplifier", {dimension::none}, positive,
                      "gain of the amplifier, volts at the switch per volt of the source; "
                      "all voltages of a scene are those at the switch; default 1"),
               number("gain", {dimension::none}, {.least = 0.5, .most = 2},
                      "gain error of the source: V(t) = gain f(t - delay) + offset; default 1")
                   .or_else(no_amplification),
               number("offset", {dimension::voltage}, any,
                      "offset error of the source from t = 0 on, also at hold and on a drive without a waveform; default 0 V"),
               number("delay", {dimension::time}, not_negative, "delay of the whole waveform; default 0 s")},
      .about = "limits of the source, which no search exceeds, and the way in which the source applies a waveform"};
}

}  // namespace softland::internal
