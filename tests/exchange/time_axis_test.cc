// Compares every source of a time axis with the others: column of times, interval, rate, start, count, period, units.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/require.h"
#include "exchange/recording.h"
#include "tests/exchange/samples.h"
#include "tests/waveforms/expect_invalid.h"

namespace softland {
namespace {

using test::all_samples;
using test::expect_invalid;
using test::replaced;
using test::rows;
using test::Sample;

Recording read_axis(const std::string& text, const ReadKeys& keys = {}) { return parse_recording(text, "x.csv", keys); }

void axis_refused(const std::string& text, const std::vector<std::string>& parts, const ReadKeys& keys = {}) {
  SCOPED_TRACE(text.substr(0, 300));
  expect_invalid([&] { (void)read_axis(text, keys); }, parts);
}

/// A source of a time axis in a header, and a contradictory one, with the same interval, start or count otherwise.
struct Contradiction {
  std::string written, contradicting;
  std::vector<std::string> named;  ///< texts that the message of the refusal contains
};

/// Returns the sources in the header of a sample, for every format.
std::vector<Contradiction> contradictions_of(const std::string& sample) {
  const std::vector<std::string> interval{"apart", "interval = "}, count{"samples", "holds 24", "interval = "};
  if (sample == "tektronix")
    return {{"Sample Interval,1e-06", "Sample Interval,1e-03", interval},
            {"Horizontal Units,s,", "Horizontal Units,ms,\nSample Rate,1 MHz,", interval},
            {"Record Length,24", "Record Length,12", count},
            {"Record Length,24,", "Record Length,24,\nTrigger Point,12,", {"Trigger Point", "interval = "}}};
  if (sample == "tektronix_beside")
    return {{"Sample Interval,1.0e-06", "Sample Interval,4.0e-06", interval},
            {"Trigger Point,4.0e+00", "Trigger Point,1.2e+01", {"Trigger Point", "-12 us", "-4 us"}},
            {"Record Length,24", "Record Length,20", count}};
  if (sample == "siglent") return {{"CH1:0.0000010000000", "CH1:0.0010000000000", interval}, {"Analog:24", "Analog:12", count}};
  if (sample == "rigol_start_and_increment")
    return {{"X,CH1", "Sample Interval,1e-9\r\nX,CH1", interval},
            {"X,CH1", "X Origin,3e-3\r\nX,CH1", {"X Origin", "Start", "skip"}}};
  if (sample == "rigol_without_x")
    return {{"CH1,", "Sample Interval,1e-9\r\nCH1,", interval}, {"CH1,", "X Origin,3e-3\r\nCH1,", {"X Origin", "Start", "skip"}}};
  if (sample == "gw_instek")
    return {{"Sampling Period,1.000E-06,", "Sampling Period,1.000E-06,\nSample Rate,500 kHz,", interval},
            {"Memory Length,24", "Memory Length,12", count},
            {"Horizontal Position,0.000E+00,",
             "Horizontal Position,0.000E+00,\nTrigger Point,2,",
             {"Horizontal Position", "Trigger Point"}}};
  if (sample == "digilent") return {{"1e+06Hz", "1e+05Hz", interval}, {"#Samples: 24", "#Samples: 12", count}};
  if (sample == "quoted_with_mark_and_carriage_returns")
    return {{"\"Sample interval (us)\",\"1\"", "\"Sample interval (us)\",\"1000\"", interval}};
  if (sample == "sigrok") return {{"; Samplerate: 1 MHz", "; Samplerate: 1 MHz\n; Sample interval: 1 ms", interval}};
  if (sample == "easywave")
    return {{"data length,24", "data length,12", count},
            {"frequency,1000.000000", "frequency,1000.000000\r\nperiod,1", interval}};
  if (sample == "keysight_arb")
    return {{"Sample Rate:1000000", "Sample Rate:1000000\nSample Interval:1e-3", interval},
            {"Data Points:24", "Data Points:12", count}};
  if (sample == "uff58_uneven")
    return {{"  0.00000E+00  0.00000E+00", "  0.00000E+00  1.00000E-03", interval},
            {"  0.00000E+00  0.00000E+00", "  5.00000E+00  0.00000E+00", {"first abscissa", "5 s"}}};
  return {};
}

TEST(TimeAxis, SourcesThatContradictEachOtherAreRefusedInEveryFormat) {
  std::size_t tried = 0;
  for (const Sample& sample : all_samples()) {
    for (const Contradiction& one : contradictions_of(sample.name)) {
      SCOPED_TRACE(sample.name + ": " + one.contradicting);
      const std::size_t at = sample.content.find(one.written);
      ASSERT_NE(at, std::string::npos);
      std::string text = sample.content;
      text.replace(at, one.written.size(), one.contradicting);
      axis_refused(text, one.named, sample.keys);
      // Keys have precedence over the header.
      ReadKeys keys = sample.keys;
      keys.interval = 1e-6;
      EXPECT_NO_THROW((void)read_axis(text, keys));
      ++tried;
    }
  }
  EXPECT_EQ(tried, 26U);
}

TEST(TimeAxis, SourcesThatAgreeToAnIntervalAreTaken) {
  const std::string numbers = rows(24, [](std::size_t i) { return fmt::format("{:.6f},1", 1e-4 * static_cast<double>(i)); });
  const auto head = [&](const std::string& lines) { return lines + "Time (s),U (V)\n" + numbers; };
  // A difference of up to one interval, and rounded digits, are accepted.
  for (const double start : {0.0, 0.9e-4, -0.9e-4})
    EXPECT_NO_THROW((void)read_axis(head(fmt::format("Sample Interval,1e-4\nStart,{}\n", start))));
  for (const double interval : {1.03e-4, 0.97e-4})
    EXPECT_NO_THROW((void)read_axis(head(fmt::format("Sample Interval,{}\n", interval))));
  for (const double start : {1.1e-4, -1.1e-4, 1.0})
    axis_refused(head(fmt::format("Sample Interval,1e-4\nStart,{}\n", start)),
                 {"\"Start\"", "first row", "interval = \"uneven\""});
  for (const double interval : {1.05e-4, 0.95e-4, 1e-7, 0.1})
    axis_refused(head(fmt::format("Sample Interval,{}\n", interval)), {"\"Sample Interval\"", "deviate by", "time_unit"});
  // A time of day is not the time of a sample.
  EXPECT_NO_THROW((void)read_axis(head("Sample Interval,1e-4\nStart Time: 14:09:15\n")));
  EXPECT_EQ(read_axis(head("Sample Interval,1\n"), {.uneven = true}).times[1], 1e-4);
}

/// Returns rows of EasyWave, whose "xpos" has one of its possible meanings.
std::string easywave(std::size_t declared, std::size_t count, const std::function<double(std::size_t)>& xpos) {
  std::string text = fmt::format("data length,{}\nfrequency,1000\namp,3\noffset,0\nphase,0\n,\n,\nxpos,value\n", declared);
  for (std::size_t i = 0; i < count; ++i) text += fmt::format("{},{}\n", xpos(i), test::level(i, 0));
  return text;
}

TEST(TimeAxis, XposIsANumberAShareOfThePeriodOrATime) {
  constexpr std::size_t declared = 256;
  constexpr double interval = 1e-3 / declared;
  for (const std::size_t count : {declared, declared / 8}) {
    for (const double step : {1.0, 1.0 / declared, interval}) {
      for (const double first : {0.0, step == 1 ? 1.0 : 0.0}) {
        SCOPED_TRACE(fmt::format("{} rows, {} apart, from {}", count, step, first));
        const Recording made =
            read_axis(easywave(declared, count, [&](std::size_t i) { return first + step * static_cast<double>(i); }));
        ASSERT_EQ(made.times.size(), count);
        EXPECT_EQ(made.format, "EasyWave CSV");
        for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(made.times[i], interval * static_cast<double>(i), 1e-12);
      }
    }
    axis_refused(
        easywave(declared, count, [](std::size_t i) { return 0.3 * static_cast<double>(i); }),
        {"\"xpos\" increases by 0.3", "share of a period of 256 samples", "\"frequency\" and \"data length\"", "interval = "});
  }
  axis_refused(replaced(easywave(8, 8, [](std::size_t i) { return static_cast<double>(i) / 8; }), "frequency,1000\n", ""),
               {"\"xpos\"", "\"frequency\"", "interval = ", "time_unit"});
}

TEST(TimeAxis, NumbersOfSamplesThatBeginLaterAreLater) {
  const auto rigol = [](std::size_t first) {
    return "X,CH1,Start,Increment,\nSequence,Volt,-1.0e-03,2.0e-06\n" +
           rows(20, [&](std::size_t i) { return fmt::format("{},{},", first + i, test::level(i, 0)); });
  };
  for (const std::size_t first : {0U, 1U, 22U, 500U}) {
    const Recording made = read_axis(rigol(first));
    for (std::size_t i = 0; i < 20; ++i) EXPECT_NEAR(made.times[i], -1e-3 + 2e-6 * static_cast<double>(first + i), 1e-15);
    EXPECT_EQ(made.notes.empty(), first == 0);
  }
  // The first sample of a generator has number 1.
  const Recording later = read_axis(easywave(256, 20, [](std::size_t i) { return static_cast<double>(i + 11); }));
  EXPECT_NEAR(later.times.front(), 10 * 1e-3 / 256, 1e-15);
  axis_refused(easywave(256, 20, [](std::size_t i) { return static_cast<double>(i + 250); }),
               {"states 256 samples", "holds 269"});
}

TEST(TimeAxis, TheUnitAboveIsThatOfTheTimes) {
  const std::string numbers =
      rows(12, [](std::size_t i) { return fmt::format("{:.3f},{:.2f}", 0.001 * static_cast<double>(i), test::level(i, 0)); });
  const auto head = [&](const std::string& lines) { return lines + "TIME,CH1\n" + numbers; };
  for (const std::string interval : {"", "Sample Interval,0.001\n", "Sample Interval,1e-6 s\n", "Sample Interval,1e-6\n"}) {
    const Recording ms = read_axis(head("Horizontal Units,ms\n" + interval));
    EXPECT_NEAR(ms.times[1], 1e-6, 1e-18) << interval;
    EXPECT_TRUE(ms.times_have_unit);
    if (!interval.empty()) {
      EXPECT_NEAR(*ms.interval, 1e-6, 1e-18);
    }
  }
  axis_refused(head("Horizontal Units,ms\nSample Interval,5\n"), {"\"Sample Interval\"", "time_unit"});
  axis_refused(head("Horizontal Units,V\n"), {"in V", "not a unit of time", "time_unit"});
  axis_refused("Horizontal Units,ms\nSample Interval,1e-3\nVolts\n1.5\n2.5\n3.5\n", {"1 us or 1 ms", "interval = "});
  // The unit in the name of a column must be that of the header, unless an interval in seconds confirms it.
  const std::string own = "Time (s),CH1\n" + numbers;
  axis_refused("Horizontal Units,us\n" + own, {"times are in s", "in us", "time_unit"});
  EXPECT_EQ(read_axis("Horizontal Units,us\n" + own, {.time_unit = "s"}).times[1], 1e-3);
  EXPECT_EQ(read_axis("Horizontal Units,us\nSample Interval,0.001\n" + own).times[1], 1e-3);
}

TEST(TimeAxis, SignsAndRoundedTimesInBlanksAreNoPwl) {
  for (const double from : {-1e-8, 0.0}) {
    for (const bool has_suffix : {false, true}) {
      std::string text;
      for (int i = 0; i < 60; ++i) {
        const double time = std::floor((from + 0.5e-9 * i) / 1e-9 + 1e-6);
        text +=
            has_suffix ? fmt::format("{:+}n {:+.2f}\n", time, 0.1 * i) : fmt::format("{:+.2e} {:+.2e}\n", time * 1e-9, 0.1 * i);
      }
      if (has_suffix && from == 0) continue;  // every time has a plus sign and a suffix, as times relative to the one before have
      const Recording made = read_axis(text);
      EXPECT_NEAR(made.times.back(), from + 29e-9, 1e-15) << text.substr(0, 60);
    }
  }
  std::string unsigned_times;
  for (int i = 0; i < 60; ++i) unsigned_times += fmt::format("{:.2e} {:.2e}\n", std::floor(0.5 * i + 1e-6) * 1e-9, 0.1 * i);
  EXPECT_EQ(read_axis(unsigned_times).format, "columns");
  // Jumps, and times relative to the one before.
  EXPECT_TRUE(read_axis("0 0\n1e-6 0\n1e-6 5\n2e-6 5\n2e-6 0\n9e-6 0\n").is_breakpoints);
  EXPECT_EQ(read_axis("0 0\n+1e-6 5\n+1e-6 0\n").times, (std::vector<double>{0, 1e-6, 2e-6}));
  EXPECT_EQ(read_axis("0 0\n+1u -5\n+1u 0\n").times, (std::vector<double>{0, 1e-6, 2e-6}));
}

TEST(TimeAxis, UnitsInCellsAreRead) {
  const auto cells = [](const std::string& separator, const std::string& between) {
    return rows(24, [&](std::size_t i) {
      const double time = static_cast<double>(i) - 12;  // [us]
      return fmt::format(
          "{}{}{:.1f}{}V",
          std::abs(time) < 5 ? fmt::format("{:.1f}{}ns", 1000 * time, between) : fmt::format("{:.4f}{}us", time, between),
          separator, 0.1 * static_cast<double>(i), between);
    });
  };
  for (const std::string separator : {",", ";", "\t", " "}) {
    for (const std::string between : {"", " "}) {
      for (const std::string head : {"", "Time,CH1\n"}) {
        SCOPED_TRACE(fmt::format("\"{}\" \"{}\" {}", separator, between, head));
        const Recording made = read_axis(replaced(head, ",", separator) + cells(separator, between));
        ASSERT_EQ(made.times.size(), 24U);
        ASSERT_EQ(made.channels.size(), 1U);
        for (std::size_t i = 0; i < 24; ++i) {
          EXPECT_NEAR(made.times[i], 1e-6 * (static_cast<double>(i) - 12), 1e-18);
          EXPECT_NEAR(made.channels[0].values[i], 0.1 * static_cast<double>(i), 1e-15);
        }
        EXPECT_EQ(made.channels[0].unit, "V");
      }
    }
  }
  axis_refused("t,U\n0.5 us,1 V\n1.5 us,2\n2.5 us,3 V\n", {"x.csv:3", "column 2", "have a unit, V"});
  axis_refused("t,U\n0.5,1\n1.5,2 V\n2.5,3\n", {"x.csv:3", "column 2", "have none"});
  axis_refused("t,U\n0.5 us,1 V\n1.5 us,2 V\n2.5 V,3 V\n", {"x.csv:4", "column 1", "are in us"});
  EXPECT_EQ(read_axis("t;U\n0,5 us;1 V\n1,5 us;2 V\n2,5 us;3 V\n").channels[0].values, (std::vector<double>{1, 2, 3}));
}

TEST(TimeAxis, AQuotedPreambleWithEqualsSignsIsRead) {
  const auto rigol = [](const std::string& points, const std::string& rate) {
    return "\"Number of Data points =\"," + points +
           ",\n\"Time Scale (s/DIV) =\",1E-7,\n\"Time Delay (s) =\",0,\n\"Sampling Frequency (Hz)=\"," + rate +
           ",\n\"Trigger Mode = \",0,\n\"Channel Data\",\"CH 1\",\"CH 2\"\n\"Attenuation = \",10,1\n\"PosOrig (V) = "
           "\",0.2,-6\n\"Inverted = \",\"NO\",\"NO\"\n"
           "\"Time (s)\",\"Voltage (V)\",\"Voltage (V)\"\n" +
           rows(24, [](std::size_t i) { return fmt::format("{}E-9,{},{}", 2 * i, test::level(i, 0), test::level(i, 1)); });
  };
  const Recording made = read_axis(rigol("24", "500000000"));
  EXPECT_EQ(made.format, "Rigol CSV");
  EXPECT_EQ(made.interval, 1 / 5e8);
  EXPECT_NEAR(made.times.back(), 46e-9, 1e-20);
  axis_refused(rigol("24", "250000000"), {"\"Sampling Frequency (Hz)\"", "4 ns apart", "interval = "});
  axis_refused(rigol("12", "500000000"), {"states 12 samples", "\"Number of Data points\""});
}

}  // namespace
}  // namespace softland
