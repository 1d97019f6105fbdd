#include "exchange/trace.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/waveforms/expect_invalid.h"

namespace softland {
namespace {

using test::expect_invalid;

Trace trace_in(const std::string& text, const ReadKeys& keys = {}, const std::string& usual = "main") {
  return trace_of(parse_recording(text, "x.csv", keys), keys, usual);
}

void trace_refused(const std::string& text, const std::vector<std::string>& parts, const ReadKeys& keys = {}) {
  SCOPED_TRACE(text.substr(0, 200));
  expect_invalid([&] { (void)trace_in(text, keys); }, parts);
}

TEST(Trace, IsTheNamedTheOnlyOrTheUsualChannel) {
  const std::string text = "t (s),A (V),main (mV)\n0,1,2\n1,3,4\n2,5,6\n";
  EXPECT_EQ(trace_in(text).values, (std::vector<double>{0.002, 0.004, 0.006}));
  EXPECT_EQ(trace_in(text, {.column = "A"}).values, (std::vector<double>{1, 3, 5}));
  EXPECT_EQ(trace_in(text, {.column = "A (V)"}).values, (std::vector<double>{1, 3, 5}));
  EXPECT_EQ(trace_in(text, {.column_number = 2}).values, (std::vector<double>{1, 3, 5}));
  EXPECT_EQ(trace_in("t,A\n0,1.5\n1,2\n").values, (std::vector<double>{1.5, 2}));
  trace_refused(text, {"column = \"C\"", "\"A\" (2)", "\"main\" (3)"}, {.column = "C"});
  trace_refused("t,A,B\n0,1,2\n1,3,4\n", {"2 channels", "column = \"A\""});
  trace_refused("t (s),I (A)\n0,1\n1,2\n", {"\"I\" is in A", "unit"});
  EXPECT_EQ(trace_in("t (s),I (A)\n0,1\n1,2\n", {.unit = "mV"}).values, (std::vector<double>{0.001, 0.002}));
}

TEST(Trace, ToldWhatIsTaken) {
  EXPECT_EQ(
      trace_in("t,A\n0,1.5\n1,2\n2,3\n").note,
      "columns, \"A\": 3 samples, every 1 s, from 0 s to 2 s; the file names no unit: V is assumed; the file names no unit of "
      "time: s is assumed");
  EXPECT_EQ(trace_in("t (s),U (V)\n0,1\n1,2\n1.5,3\n4,3\n", {.uneven = true}).note,
            "columns, \"U\": 4 samples, at intervals of 500 ms to 2.5 s, from 0 s to 4 s");
  EXPECT_EQ(trace_in("t (s),U (V)\n3,1\n").note, "columns, \"U\": 1 sample, at 3 s");
}

TEST(Trace, TimesThatRepeatGoBackOrDriftAreRefused) {
  trace_refused("t (s),U (V)\n0,1\n0,2\n1,3\n", {"x.csv:3", "is given twice", "interval = "});
  trace_refused("t (s),U (V)\n0,1\n2,2\n1,3\n", {"x.csv:4", "decreases from 2 s to 1 s", "skip", "interval = "});
  trace_refused("Sample Interval,2e-6\nt (s),U (V)\n0,1\n1e-6,2\n2e-6,3\n3e-6,4\n",
                {"2 us apart", "deviate by 3 us", "interval = \"2 us\""});
  trace_refused("1.5\n2.5\n3.5\n", {"neither times nor an interval", "interval = "});
  std::string odd = "t (s),U (V)\n";
  for (int i = 0; i < 20; ++i) odd += std::to_string(i + (i > 15 ? 1 : 0)) + ".0,1\n";
  trace_refused(odd, {"x.csv:18", "most rows", "interval = \"uneven\""});
  EXPECT_EQ(trace_in(odd, {.uneven = true}).times.back(), 20);
  EXPECT_EQ(trace_in(odd, {.interval = 0.5}).times.back(), 9.5);
  EXPECT_EQ(trace_in("t (s),U (V)\n0,1\n0,2\n1,3\n", {.uneven = true}).times, (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(trace_in("1.5\n2.5\n3.5\n", {.interval = 1e-6}).times, (std::vector<double>{0, 1e-6, 2e-6}));
}

TEST(Trace, TimesThatAreRoundedFollowTheIntervalOfTheFile) {
  std::string text = "Sample Interval,3.2e-8\nTIME (s),CH1 (V)\n";
  for (int i = 0; i < 100; ++i) text += (i < 30 ? "-3.04E-03," : "-3.03E-03,") + std::to_string(i) + "\n";
  const Trace trace = trace_in(text);
  EXPECT_DOUBLE_EQ(trace.times.back(), -3.04e-3 + 99 * 3.2e-8);
  EXPECT_THAT(trace.note, testing::HasSubstr("rounded to 10 us"));
}

TEST(Trace, MissingValuesAtTheEndsAndBetween) {
  const Trace trace = trace_in("t (s),U (V),W (V)\n0,,1\n1,2,1\n2,,1\n3,4,1\n4,,1\n", {.column = "U"});
  EXPECT_EQ(trace.times, (std::vector<double>{1, 3}));
  EXPECT_THAT(trace.note, testing::HasSubstr("3 rows without a number are left out, the first in line 2"));
  trace_refused("t (s),U (V)\n0,1\n1,inf\n2,3\n", {"x.csv:3", "column 2", "must be finite"});
  EXPECT_EQ(trace_in("t (s),U (V)\n0,1\n1,2\n2,inf\n").values, (std::vector<double>{1, 2}));
}

}  // namespace
}  // namespace softland
