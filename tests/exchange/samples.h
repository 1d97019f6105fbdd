// Small files in the formats of instruments and simulators. Headers are copied from such files, and numbers follow a rule.
#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "exchange/recording.h"

namespace softland::test {

struct Sample {
  std::string name;
  std::string content;
  std::string format;
  std::vector<std::string> channels;  ///< names of the channels
  std::vector<std::string> units;
  std::vector<double> times;                ///< [s]
  std::vector<std::vector<double>> values;  ///< values of each channel, in its unit
  ReadKeys keys = {};
  bool times_stand_in_it = true;  ///< false if the times follow from an interval
  bool times_add_up = false;      ///< true if each time is relative to the one before
};

/// Returns a multiple of 0.25 V, which every format represents exactly.
inline double level(std::size_t row, std::size_t channel) {
  return static_cast<double>((row * 7 + channel * 13) % 40) * 0.25 - 2.5;
}

inline std::vector<double> times_of(std::size_t count, double first_steps, double step, double per_second = 1) {
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i) times.push_back((first_steps + static_cast<double>(i)) * step / per_second);
  return times;
}

inline std::vector<std::vector<double>> levels_of(std::size_t count, std::size_t channels) {
  std::vector<std::vector<double>> all(channels);
  for (std::size_t c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < count; ++i) all[c].push_back(level(i, c));
  }
  return all;
}

/// Returns a text with row(number) for each row, one per line.
inline std::string rows(std::size_t count, const std::function<std::string(std::size_t)>& row, const std::string& end = "\n") {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += row(i) + end;
  return text;
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

inline std::string as_utf16(const std::string& text, bool big_endian, bool mark) {
  std::string out = !mark ? "" : big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) {
    if (big_endian) out += '\0';
    out += c;
    if (!big_endian) out += '\0';
  }
  return out;
}

template <class Number>
void append_bytes(std::string& out, Number number, bool big_endian) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  for (std::size_t i = 0; i < sizeof number; ++i) out += raw[big_endian ? sizeof number - 1 - i : i];
}

/// Returns the lines of a data set 58 above its numbers.
inline std::string uff_header(const std::string& first, int type, std::size_t count, bool even, const std::string& end = "\n") {
  std::string text = "    -1" + end + first + end;
  for (const char* id : {"made for a test", "NONE", "01-Jan-26 10:00:00", "NONE", "NONE"}) text += id + end;
  text += "    1         0    0         0 tip                1   3 NONE               0   0" + end;
  text += fmt::format("{:10}{:10}{:10}{:13.5E}{:13.5E}{:13.5E}", type, count, even ? 1 : 0, 0.0, even ? 2e-6 : 0.0, 0.0) + end;
  text += fmt::format("{:10}{:5}{:5}{:5} {:<20} {:<20}", 17, 0, 0, 0, "time", "s") + end;
  text += fmt::format("{:10}{:5}{:5}{:5} {:<20} {:<20}", 21, 0, 0, 0, "drive", "V") + end;
  for (int i = 0; i < 2; ++i) text += "         0    0    0    0 NONE                 NONE" + end;
  return text;
}

inline std::string uff_ascii(std::size_t count, bool even) {
  std::string text = uff_header("    58", 2, count, even);
  std::size_t in_line = 0;
  const auto put = [&](double value) {
    text += fmt::format("{:13.5E}", value);
    if (++in_line == 6) text += "\n", in_line = 0;
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (!even) put(static_cast<double>(i * i) * 1e-6);
    put(level(i, 0));
  }
  return text + (in_line == 0 ? "" : "\n") + "    -1\n";
}

inline std::string uff_binary(std::size_t count, bool even, bool wide, bool big_endian) {
  const std::size_t bytes = count * ((wide ? 8U : 4U) + (even ? 0U : 4U));
  std::string text =
      uff_header(fmt::format("    58b{:6}{:6}{:12}{:12}{:6}{:6}{:12}{:12}", big_endian ? 2 : 1, 2, 11, bytes, 0, 0, 0, 0),
                 wide ? 4 : 2, count, even, "\r\n");
  for (std::size_t i = 0; i < count; ++i) {
    if (!even) append_bytes(text, static_cast<float>(i * i), big_endian);
    wide ? append_bytes(text, level(i, 0), big_endian) : append_bytes(text, static_cast<float>(level(i, 0)), big_endian);
  }
  return text + "    -1\r\n";
}

inline std::vector<Sample> all_samples() {
  constexpr std::size_t n = 24;
  const auto v = [](std::size_t i, std::size_t c = 0) { return level(i, c); };
  std::vector<Sample> all;
  const std::string tektronix_head =
      "Model,MSO0000\nFirmware Version,1.00\n\nPoint Format,Y,\nHorizontal Units,s,\nHorizontal Scale,4e-06,\nSample "
      "Interval,1e-06,\n"
      "Record Length,24,\nProbe Attenuation,10,\nVertical Units,V,\nVertical Offset,0,\nVertical Scale,2,\nLabel,,\n";
  const std::string two_columns =
      rows(n, [&](std::size_t i) { return fmt::format("{:.4e},{:.2f}", (static_cast<double>(i) - 4) * 1e-6, v(i)); });
  all.push_back({"tektronix",
                 tektronix_head + "TIME,CH1\n" + two_columns,
                 "Tektronix CSV",
                 {"CH1"},
                 {"V"},
                 times_of(n, -4, 1e-6),
                 levels_of(n, 1)});
  {
    std::string text;
    const std::vector<std::string> beside{
        "Record Length,24",       "Sample Interval,1.0e-06", "Trigger Point,4.0e+00", ",", "Source,CH1", "Vertical Units,V",
        "Vertical Scale,2.0e+00", "Horizontal Units,s",      "Firmware Version,V1"};
    for (std::size_t i = 0; i < n; ++i)
      text +=
          fmt::format("{},,{:.12f},{:10.5f},\n", i < beside.size() ? beside[i] : ",", (static_cast<double>(i) - 4) * 1e-6, v(i));
    all.push_back({"tektronix_beside", text, "Tektronix CSV", {"CH1"}, {"V"}, times_of(n, -4, 1e-6), levels_of(n, 1)});
  }
  all.push_back({"keysight",
                 "x-axis,1,2\nsecond,Volt,Volt\n" + rows(n,
                                                         [&](std::size_t i) {
                                                           return fmt::format("{:+.5E},{:+.4E},{:+.4E}",
                                                                              (static_cast<double>(i) - 4) * 1e-6, v(i), v(i, 1));
                                                         }),
                 "Keysight CSV",
                 {"1", "2"},
                 {"V", "V"},
                 times_of(n, -4, 1e-6),
                 levels_of(n, 2)});
  all.push_back({"rigol_start_and_increment",
                 "X,CH1,CH2,Start,Increment,\r\nSequence,Volt,Volt,-4.000000e-06,1.000000e-06,\r\n" +
                     rows(
                         n, [&](std::size_t i) { return fmt::format("{},{:.2e},{:.2e},,,", i, v(i), v(i, 1)); }, "\r\n"),
                 "Rigol CSV",
                 {"CH1", "CH2"},
                 {"V", "V"},
                 times_of(n, -4, 1e-6),
                 levels_of(n, 2),
                 {},
                 false});
  all.push_back({"rigol_without_x",
                 "CH1,Start,Increment,\r\nVolt,-4.000000e-06,1.000000e-06\r\n" +
                     rows(
                         n, [&](std::size_t i) { return fmt::format("{:.2e},", v(i)); }, "\r\n"),
                 "Rigol CSV",
                 {"CH1"},
                 {"V"},
                 times_of(n, -4, 1e-6),
                 levels_of(n, 1),
                 {},
                 false});
  all.push_back(
      {"rigol_units_in_headings",
       "X,CH 1 (V)\n" +
           rows(n, [&](std::size_t i) { return fmt::format("{:.8f},{:.2f}", (static_cast<double>(i) - 4) * 1e-6, v(i)); }),
       "Rigol CSV",
       {"CH 1"},
       {"V"},
       times_of(n, -4, 1e-6),
       levels_of(n, 1)});
  all.push_back(
      {"siglent",
       "Record Length,Analog:24\nSample Interval,CH1:0.0000010000000\nVertical Units,CH1:V,,,\nHorizontal Units,us,,,\n"
       "Model Number,SDS0000,,,\nSource,CH1\nSecond,Volt\n" +
           rows(n, [&](std::size_t i) { return fmt::format(" {:.11f},{:.5f}", (static_cast<double>(i) - 4) * 1e-6, v(i)); }),
       "Siglent CSV",
       {"CH1"},
       {"V"},
       times_of(n, -4, 1e-6),
       levels_of(n, 1)});
  all.push_back(
      {"lecroy",
       "LECROYWS0000,00000,Waveform\r\nSegments,1,SegmentSize,24\r\nSegment,TrigTime,TimeSinceSegment1\r\n"
       "#1,01-Jan-2026 10:00:00,0                 \r\nTime,Ampl\r\n" +
           rows(
               n, [&](std::size_t i) { return fmt::format("{:.5e},{:.4f}", (static_cast<double>(i) - 4) * 1e-6, v(i)); }, "\r\n"),
       "LeCroy CSV",
       {"Ampl"},
       {""},
       times_of(n, -4, 1e-6),
       levels_of(n, 1)});
  all.push_back({"rohde_schwarz",
                 "in s,C1 in V,C2 in V\r\n" + rows(
                                                  n,
                                                  [&](std::size_t i) {
                                                    return fmt::format("{:.5E},{:.6E},{:.5E}",
                                                                       (static_cast<double>(i) - 4) * 1e-6, v(i), v(i, 1));
                                                  },
                                                  "\r\n"),
                 "Rohde & Schwarz CSV",
                 {"C1", "C2"},
                 {"V", "V"},
                 times_of(n, -4, 1e-6),
                 levels_of(n, 2)});
  {
    std::string text =
        "Memory Length,24,\nTrigger Level,0.000E+00,\nSource,CH2,\nVertical Units,V,\nVertical Scale,6.250E+00,\nHorizontal "
        "Units,s,\n"
        "Horizontal Position,0.000E+00,\nSampling Period,1.000E-06,\nFirmware, V1.00,\nWaveform Data,\n";
    for (std::size_t i = 0; i < n; ++i) text += fmt::format("{},\n", static_cast<int>(v(i) * 4));
    all.push_back({"gw_instek", text, "GW Instek CSV", {"CH2"}, {"V"}, times_of(n, -12, 1e-6), levels_of(n, 1), {}, false});
  }
  all.push_back({"digilent",
                 "#Digilent WaveForms Oscilloscope Acquisition\n#Device Name: Discovery\n#Sample rate: 1e+06Hz\n#Samples: 24\n"
                 "#Channel 1: Range: 500 mV/div Offset: 0 V\n#Frequency: 40 Hz\n\nTime (s),Channel 1 (V),Channel 2 (mV)\n" +
                     rows(n,
                          [&](std::size_t i) {
                            return fmt::format("{:.17g},{:.16f},{:.15f}", (static_cast<double>(i) - 4) * 1e-6, v(i), v(i, 1));
                          }),
                 "Digilent WaveForms CSV",
                 {"Channel 1", "Channel 2"},
                 {"V", "mV"},
                 times_of(n, -4, 1e-6),
                 levels_of(n, 2)});
  const std::string pico = "Time,Channel A,Channel B\n(us),(V),(mV)\n\n" + rows(n, [&](std::size_t i) {
                             return fmt::format("{:.8f},{:.8f},{:.8f}", static_cast<double>(i) - 4, v(i), v(i, 1));
                           });
  all.push_back(
      {"picoscope", pico, "PicoScope CSV", {"Channel A", "Channel B"}, {"V", "mV"}, times_of(n, -4, 1, 1e6), levels_of(n, 2)});
  // The same file in the German locale, with commas in numbers and semicolons between them.
  std::string german = replaced(replaced(pico, ",", ";"), ".", ",");
  all.push_back({"picoscope_decimal_comma",
                 german,
                 "PicoScope CSV",
                 {"Channel A", "Channel B"},
                 {"V", "mV"},
                 times_of(n, -4, 1, 1e6),
                 levels_of(n, 2)});
  all.push_back({"picoscope_utf16",
                 as_utf16(replaced(german, "\n", "\r\n"), false, true),
                 "PicoScope CSV",
                 {"Channel A", "Channel B"},
                 {"V", "mV"},
                 times_of(n, -4, 1, 1e6),
                 levels_of(n, 2)});
  all.push_back({"tabs_and_utf16_without_mark",
                 as_utf16(replaced(german, ";", "\t"), true, false),
                 "PicoScope CSV",
                 {"Channel A", "Channel B"},
                 {"V", "mV"},
                 times_of(n, -4, 1, 1e6),
                 levels_of(n, 2)});
  all.push_back(
      {"quoted_with_mark_and_carriage_returns",
       "\xEF\xBB\xBF" + std::string("\"Log of 1 January 2026\"\r\"Sample interval (us)\",\"1\"\r\"Time [ms]\",\"U [kV]\"\r") +
           rows(
               n, [&](std::size_t i) { return fmt::format("\"{:.4f}\",\"{:.6f}\"", (static_cast<double>(i) - 4) * 1e-3, v(i)); },
               "\r"),
       "columns",
       {"U"},
       {"kV"},
       times_of(n, -4, 1e-6),
       levels_of(n, 1)});
  all.push_back({"quoted_decimal_comma",
                 "\"t (s)\",\"U (V)\"\n" + rows(n,
                                                [&](std::size_t i) {
                                                  return replaced(fmt::format("\"{:.6f}\"|\"{:.3f}\"",
                                                                              (static_cast<double>(i) - 4) * 1e-6, v(i)),
                                                                  ".", ",")
                                                      .replace(i < 4 ? 11U : 10U, 1, ",");
                                                }),
                 "columns",
                 {"U"},
                 {"V"},
                 times_of(n, -4, 1e-6),
                 levels_of(n, 1)});
  ReadKeys redpitaya;
  all.push_back({"red_pitaya",
                 rows(n, [&](std::size_t i) { return fmt::format("{:.8f}", v(i)); }),
                 "columns",
                 {"column 1"},
                 {""},
                 {},
                 levels_of(n, 1),
                 redpitaya,
                 false});
  all.push_back({"sigrok",
                 "; CSV generated by libsigrok 0.5.2\n; Channels (2/2): A0, A1\n; Samplerate: 1 MHz\nA0,A1\n" +
                     rows(n, [&](std::size_t i) { return fmt::format("{:.4f},{:.4f}", v(i), v(i, 1)); }),
                 "sigrok CSV",
                 {"A0", "A1"},
                 {"", ""},
                 times_of(n, 0, 1e-6),
                 levels_of(n, 2),
                 {},
                 false});
  {
    std::string text =
        "data length,24\r\nfrequency,1000.000000\r\namp,5.000000\r\noffset,2.500000\r\nphase,0.000000\r\n\r\n\r\nxpos,value\r\n";
    for (std::size_t i = 0; i < n; ++i) text += fmt::format("{},{}\r\n", i + 1, v(i));
    all.push_back(
        {"easywave", text, "EasyWave CSV", {"value"}, {""}, times_of(n, 0, 1 / (1000.0 * n)), levels_of(n, 1), {}, false});
  }
  {
    std::string text =
        "File Format:1.10\nChannel Count:1\nColumn Char:TAB\nSample Rate:1000000\nHigh Level:3.2767\nLow Level:-3.2767\n"
        "Data Type:\"Short\"\nFilter:\"OFF\"\nData Points:24\nData:\n";
    for (std::size_t i = 0; i < n; ++i) text += fmt::format("{}\n", static_cast<int>(v(i) * 10000));
    all.push_back({"keysight_arb", text, "Keysight arb", {"V"}, {"V"}, times_of(n, 0, 1e-6), levels_of(n, 1), {}, false});
  }
  {
    std::string time = "Time (s)", volts = "CH1 (V)", other = "CH2 (V)";
    for (std::size_t i = 0; i < n; ++i) {
      time += fmt::format(",{:.7f}", (static_cast<double>(i) - 4) * 1e-6);
      volts += fmt::format(",{:.2f}", v(i));
      other += fmt::format(",{:.2f}", v(i, 1));
    }
    all.push_back({"rows_instead_of_columns",
                   time + "\n" + volts + "\n" + other + "\n",
                   "columns",
                   {"CH1", "CH2"},
                   {"V", "V"},
                   times_of(n, -4, 1e-6),
                   levels_of(n, 2)});
  }
  all.push_back({"circuit_simulator",
                 "time;V(out);\n" +
                     rows(n, [&](std::size_t i) { return fmt::format("{:g};{:.2f};", static_cast<double>(i * i) * 1e-9, v(i)); }),
                 "columns",
                 {"V(out)"},
                 {"V"},
                 {},
                 levels_of(n, 1)});
  for (std::size_t i = 0; i < n; ++i) all.back().times.push_back(static_cast<double>(i * i) * 1e-9);
  all.push_back({"spice_pwl_suffixes",
                 "* a drive\n" + rows(n, [&](std::size_t i) { return fmt::format("{}u\t{}m ; point", i, v(i) * 1000); }),
                 "SPICE PWL",
                 {"V"},
                 {"V"},
                 times_of(n, 0, 1, 1e6),
                 levels_of(n, 1)});
  {
    std::string text = "* softland\nVdrive out 0 PWL(0 " + fmt::format("{}", v(0));
    for (std::size_t i = 1; i < n; ++i) text += fmt::format("{}{}u {}", i % 4 == 0 ? "\n+ " : ", ", i, v(i));
    all.push_back({"spice_netlist",
                   text + ")\nRload out 0 1meg\n.end\n",
                   "SPICE PWL",
                   {"Vdrive"},
                   {"V"},
                   times_of(n, 0, 1, 1e6),
                   levels_of(n, 1)});
  }
  {
    std::string text = fmt::format("0 {}\n", v(0));
    for (std::size_t i = 1; i < n; ++i) text += fmt::format("+1u {}\n", v(i));
    all.push_back(
        {"spice_relative_times", text, "SPICE PWL", {"V"}, {"V"}, times_of(n, 0, 1, 1e6), levels_of(n, 1), {}, true, true});
  }
  all.push_back(
      {"uff58", uff_ascii(n - 1, true), "UFF 58", {"drive"}, {"V"}, times_of(n - 1, 0, 2e-6), levels_of(n - 1, 1), {}, false});
  all.push_back({"uff58_uneven", uff_ascii(n, false), "UFF 58", {"drive"}, {"V"}, {}, levels_of(n, 1)});
  for (std::size_t i = 0; i < n; ++i) all.back().times.push_back(static_cast<double>(i * i) * 1e-6);
  all.push_back({"uff58b",
                 uff_binary(n, true, true, false),
                 "UFF 58b",
                 {"drive"},
                 {"V"},
                 times_of(n, 0, 2e-6),
                 levels_of(n, 1),
                 {},
                 false});
  all.push_back(
      {"uff58b_big_endian_uneven", uff_binary(n, false, false, true), "UFF 58b", {"drive"}, {"V"}, {}, levels_of(n, 1)});
  for (std::size_t i = 0; i < n; ++i) all.back().times.push_back(static_cast<double>(i * i));
  return all;
}

}  // namespace softland::test
