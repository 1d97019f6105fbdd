// Files for generators, read back.
#include "exchange/generator.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "exchange/trace.h"
#include "tests/waveforms/expect_invalid.h"

namespace softland {
namespace {

using test::expect_invalid;

GeneratorSamples pulse() {
  GeneratorSamples s{.name = "main", .rate = 27e6, .volts = {}};
  for (int k = 0; k < 300; ++k) s.volts.push_back(k < 90 ? 1.05 : k < 150 ? -0.1 / 3 : 0.8 + 1e-3 * std::sin(0.1 * k));
  return s;
}

Trace read_back(const GeneratorFormat& format, const GeneratorSamples& s) {
  return trace_of(parse_recording(generator_file(format, s), "arb.csv"), {}, "main");
}

TEST(GeneratorFile, OfEveryFormatIsReadBack) {
  for (const GeneratorFormat& format : generator_formats()) {
    SCOPED_TRACE(format.name);
    const GeneratorSamples s = pulse();
    const Trace back = read_back(format, s);
    ASSERT_EQ(back.values.size(), s.volts.size()) << back.note;
    for (std::size_t k = 0; k < s.volts.size(); ++k)
      EXPECT_NEAR(back.times[k], static_cast<double>(k) / s.rate, 1e-15 * back.times.back());
    if (format.name != "keysight-arb") {
      EXPECT_EQ(back.values, s.volts);
      continue;
    }
    // Codes are within half a step of the voltages, and unchanged after another round trip.
    const double code = (1.05 + 0.1 / 3) / 65534;
    for (std::size_t k = 0; k < s.volts.size(); ++k) EXPECT_NEAR(back.values[k], s.volts[k], 0.5001 * code);
    GeneratorSamples again = s;
    again.volts = back.values;
    const auto codes = [&](const GeneratorSamples& of) {
      const std::string text = generator_file(format, of);
      return text.substr(text.find("\nData:\n"));
    };
    EXPECT_EQ(codes(again), codes(s));
  }
}

TEST(GeneratorFile, OfSamplesThatAreAllTheSameIsReadBack) {
  for (const GeneratorFormat& format : generator_formats()) {
    for (const double level : {0.0, 1.25, -3.5}) {
      SCOPED_TRACE(fmt::format("{} {}", format.name, level));
      const Trace back = read_back(format, {.name = "main", .rate = 1e6, .volts = std::vector<double>(20, level)});
      EXPECT_EQ(back.values, std::vector<double>(20, level));
    }
  }
}

TEST(GeneratorFile, HoldsAsManySamplesAsTheInstrumentTakes) {
  for (const GeneratorFormat& format : generator_formats()) {
    SCOPED_TRACE(format.name);
    const Trace back = read_back(format, {.name = "main", .rate = 1e6, .volts = {1, 2, 3}});
    ASSERT_EQ(back.values.size(), std::max<std::size_t>(3, format.fewest));
    EXPECT_EQ(back.values.back(), 3);
    expect_invalid(
        [&] { (void)generator_file(format, {.name = "main", .rate = 1e6, .volts = std::vector<double>(format.most + 1, 1.0)}); },
        {std::to_string(format.most), std::string(format.instrument), "sample rate of at most"});
    expect_invalid([&] { (void)generator_file(format, {.name = "main", .rate = 1e6, .volts = {}}); }, {"at least one sample"});
  }
}

TEST(GeneratorFile, SaysWhereTheSyncOutputFalls) {
  GeneratorSamples s = pulse();
  s.marker = 17;
  for (const GeneratorFormat& format : generator_formats()) {
    if (format.has_marker) {
      EXPECT_NE(generator_file(format, s).find("Marker Point:17\n"), std::string::npos);
    } else {
      expect_invalid([&] { (void)generator_file(format, s); }, {std::string(format.instrument), "cannot hold a marker"});
    }
  }
}

}  // namespace
}  // namespace softland
