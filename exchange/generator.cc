#include "exchange/generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "base/engineering.h"
#include "base/require.h"

namespace softland {
namespace {

struct VoltageRange {
  double low, high;
};
// Returns the voltage range of the samples. The range of constant samples is extended to 0 V, that of zeros to 1 V.
VoltageRange range_of(const std::vector<double>& volts) {
  const auto [low, high] = std::ranges::minmax(volts);
  if (low < high) return {low, high};
  return low == 0 ? VoltageRange{0, 1} : VoltageRange{std::min(0.0, low), std::max(0.0, low)};
}

// Returns a Keysight file. Its samples are integers from -32767 for the low level to 32767 for the high level. Source: Keysight
// 33500 Series Operating and Service Guide, "Arbitrary waveform file format".
std::string keysight_arb(const GeneratorSamples& s) {
  constexpr double full_scale = 32767;
  const auto [low, high] = range_of(s.volts);
  std::string text = fmt::format(
      "File Format:1.10\nChecksum:0\nChannel Count:1\nSample Rate:{}\nHigh Level:{}\nLow Level:{}\nMarker Point:{}\n"
      "Data Type:\"short\"\nFilter:\"off\"\nData Points:{}\nData:\n",
      s.rate, high, low, s.marker.value_or(s.volts.size() / 2), s.volts.size());
  const double middle = (high + low) / 2, half = (high - low) / 2;
  for (const double v : s.volts) fmt::format_to(std::back_inserter(text), "{}\n", std::round(full_scale * ((v - middle) / half)));
  return text;
}

// Returns a CSV for Siglent EasyWave, in which the samples cover one period.
std::string siglent_csv(const GeneratorSamples& s) {
  const auto [low, high] = range_of(s.volts);
  const auto count = static_cast<double>(s.volts.size());
  std::string text = fmt::format("data length,{}\nfrequency,{}\namp,{}\noffset,{}\nphase,0\n", s.volts.size(), s.rate / count,
                                 high - low, (high + low) / 2);
  for (int i = 0; i < 7; ++i) text += "\n";
  text += "xpos,value\n";
  for (std::size_t k = 0; k < s.volts.size(); ++k) fmt::format_to(std::back_inserter(text), "{},{}\n", k + 1, s.volts[k]);
  return text;
}

void append_rows(std::string& text, const GeneratorSamples& s) {
  for (std::size_t k = 0; k < s.volts.size(); ++k)
    fmt::format_to(std::back_inserter(text), "{},{}\n", static_cast<double>(k) / s.rate, s.volts[k]);
}

// Returns times and volts below the preamble of an oscilloscope file, which Tektronix ArbExpress and ArbBuilder import.
std::string tektronix_csv(const GeneratorSamples& s) {
  std::string text = fmt::format("Record Length,{}\nSample Interval,{}\nVertical Units,V\nHorizontal Units,s\n\nTIME,{}\n",
                                 s.volts.size(), 1 / s.rate, s.name);
  append_rows(text, s);
  return text;
}

// Returns a CSV for Rigol Ultra Station: its column x is empty, the volts are in column y.
std::string rigol_csv(const GeneratorSamples& s) {
  const auto [low, high] = range_of(s.volts);
  std::string text = fmt::format(
      "RIGOL:DG8:CSV DATA FILE\nTYPE:Arb\nAMP:{} Vpp\nPERIOD:{} S\nDOTS:{}\nMODE:INSERT\nSample Rate:{}\nAWG N:0\nx,y[V]\n",
      2 * std::max(std::abs(low), std::abs(high)), static_cast<double>(s.volts.size()) / s.rate, s.volts.size(), s.rate);
  for (const double v : s.volts) fmt::format_to(std::back_inserter(text), ",{}\n", v);
  return text;
}

// Returns a CSV in the form that the oscilloscope of Digilent WaveForms exports and its generator imports.
std::string digilent_csv(const GeneratorSamples& s) {
  std::string text =
      fmt::format("#Digilent WaveForms\n#Sample rate: {}Hz\n#Samples: {}\n\nTime (s),{} (V)\n", s.rate, s.volts.size(), s.name);
  append_rows(text, s);
  return text;
}

constexpr std::array formats{
    GeneratorFormat{"keysight-arb", "Keysight 33500B", 8, 1'000'000, true, keysight_arb},
    GeneratorFormat{"siglent-csv", "Siglent SDG1000X", 2, 16'384, false, siglent_csv},
    GeneratorFormat{"tektronix-csv", "Tektronix AFG31000", 2, 131'072, false, tektronix_csv},
    GeneratorFormat{"rigol-csv", "Rigol DG800", 2, 2'000'000, false, rigol_csv},
    GeneratorFormat{"digilent-csv", "Digilent Analog Discovery 2", 1, 16'384, false, digilent_csv},
};

}  // namespace

std::span<const GeneratorFormat> generator_formats() { return formats; }

std::string generator_file(const GeneratorFormat& format, GeneratorSamples samples) {
  require(!samples.volts.empty(), "a generator file needs at least one sample");
  require(samples.volts.size() <= format.most, [&] {
    const double most = samples.rate * static_cast<double>(format.most - 1) / static_cast<double>(samples.volts.size() - 1);
    const double step = std::pow(10, std::floor(std::log10(most)) - 2);  // the rate is rounded down to three digits
    return fmt::format("{} samples: a {} takes at most {}; choose a sample rate of at most {}", samples.volts.size(),
                       format.instrument, format.most, engineering(std::floor(most / step) * step, "Hz", 3));
  });
  require(!samples.marker || format.has_marker,
          [&] { return fmt::format("a file for {} cannot hold a marker; omit the marker", format.instrument); });
  samples.volts.resize(std::max(samples.volts.size(), format.fewest), samples.volts.back());
  return format.write(samples);
}

}  // namespace softland
