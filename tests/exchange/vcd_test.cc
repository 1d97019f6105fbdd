// Value change dumps of logic analysers and simulators.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/require.h"
#include "exchange/level_edges.h"
#include "exchange/recording.h"
#include "tests/exchange/byte_changes.h"
#include "tests/support/temporary_folder.h"
#include "tests/waveforms/expect_invalid.h"

namespace softland {
namespace {

using test::expect_invalid;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

Recording read_dump(const std::string& text, const ReadKeys& keys = {}) { return parse_recording(text, "x.vcd", keys); }

// A capture of two probes by sigrok-cli.
const std::string of_analyser = R"($date Mon Nov 30 08:00:00 2026 $end
$version libsigrok 0.5.2 $end
$comment
  Acquisition with 2/2 channels at 12 MHz
$end
$timescale 1 ns $end
$scope module libsigrok $end
$var wire 1 ! D0 $end
$var wire 1 " contact $end
$upscope $end
$enddefinitions $end
#0 0! 0"
#100 1!
#2500 1"
#2600 0! 0"
#2700 1"
#9000
)";

// A dump of a simulator with nested modules: a vector, an integer, a real number, an alias, unknown states.
const std::string of_simulator = R"($comment a test $end
$timescale
	10ps
$end
$scope module top $end
$var wire 1 ! clk $end
$var reg 4 "a count [3:0] $end
$var integer 32 #1 number $end
$scope begin part $end
$var wire 1 ! clk $end
$var real 1 $ level_mV $end
$var event 1 % done $end
$upscope $end
$upscope $end
$enddefinitions $end
$comment values $end
$dumpvars
x!
bx "a
b11111111111111111111111111111110 #1
r1.5 $
$end
#10
1!
b101 "a
1%
#20
0!
1!
#30
$dumpoff
x!
bz "a
$end
#40
$dumpon
0!
b1 "a
rinf $
$end
)";

TEST(Vcd, IsReadAsStepsBetweenRows) {
  const Recording found = read_dump(of_analyser);
  EXPECT_EQ(found.format, "VCD");
  EXPECT_TRUE(found.is_breakpoints);
  EXPECT_THAT(found.times, ElementsAre(0, 100e-9, 100e-9, 2.5e-6, 2.5e-6, 2.6e-6, 2.6e-6, 2.7e-6, 2.7e-6, 9e-6));
  ASSERT_EQ(found.channels.size(), 2u);
  EXPECT_EQ(found.channels[0].name, "D0");
  EXPECT_EQ(found.channels[0].heading, "libsigrok.D0");
  EXPECT_EQ(found.channels[1].column, 2);
  EXPECT_TRUE(found.channels[1].is_state);
  EXPECT_THAT(found.channels[0].values, ElementsAre(0, 0, 1, 1, 1, 1, 0, 0, 0, 0));
  EXPECT_THAT(found.channels[1].values, ElementsAre(0, 0, 0, 0, 1, 1, 0, 0, 1, 1));
  EXPECT_EQ(found.place(3), "x.vcd:14");
  EXPECT_TRUE(found.notes.empty() && found.left_out.empty());
}

TEST(Vcd, HoldsVectorsNumbersAliasesAndUnknownStates) {
  const Recording found = read_dump(of_simulator);
  ASSERT_EQ(found.channels.size(), 5u);
  const auto values = [&](std::size_t k) { return found.channels[k].values; };
  const auto are = [](const std::vector<double>& right) { return testing::Pointwise(testing::NanSensitiveDoubleEq(), right); };
  EXPECT_THAT(found.times, ElementsAre(100e-12, 200e-12, 200e-12, 300e-12, 300e-12, 400e-12, 400e-12))
      << "from the first time on";
  EXPECT_EQ(found.channels[0].name, "top.clk");
  EXPECT_EQ(found.channels[3].name, "top.part.clk");
  EXPECT_THAT(values(0), are({1, 1, 1, 1, unknown, unknown, 0})) << "the last change at a time counts";
  EXPECT_THAT(values(3), are(values(0)));
  EXPECT_EQ(found.channels[1].name, "count[3:0]");
  EXPECT_FALSE(found.channels[1].is_state);
  EXPECT_THAT(values(1), are({5, 5, 5, 5, unknown, unknown, 1}));
  EXPECT_THAT(values(2), are(std::vector<double>(7, -2)));
  EXPECT_EQ(found.channels[4].unit, "mV");
  EXPECT_THAT(values(4), are({1.5, 1.5, 1.5, 1.5, 1.5, 1.5, unknown}));
  EXPECT_EQ(found.channels[0].missing.count, 2u);
  EXPECT_EQ(found.channels[0].missing.line, 32u);
  EXPECT_THAT(found.notes, ElementsAre("x and z are missing numbers, in 4 of 5 channels"));
  EXPECT_THAT(found.left_out, ElementsAre("1 variables that are text or events"));
}

TEST(Vcd, TakesTheVariableThatTheKeysName) {
  for (const ReadKeys& keys : {ReadKeys{.column = "top.part.clk"}, ReadKeys{.column_number = 4}}) {
    const Recording found = read_dump(of_simulator, keys);
    ASSERT_EQ(found.channels.size(), 1u);
    EXPECT_EQ(channel_of(found, keys, "").heading, "top.part.clk");
  }
  const ReadKeys both{.column = "clk"};
  const Recording found = read_dump(of_simulator, both);
  expect_invalid([&] { (void)channel_of(found, both, ""); }, {"x.vcd", "top.clk", "top.part.clk"});
}

TEST(Vcd, TakesEveryUnitOfTime) {
  const auto end = [](const std::string& scale, const ReadKeys& keys = {}) {
    return read_dump(scale + "$var wire 1 ! a $end $enddefinitions $end #0 0! #3 1!\n", keys).times.back();
  };
  for (const auto& [scale, seconds] :
       {std::pair{"1 s", 3.0}, {"100ms", 0.3}, {"10 us", 30e-6}, {"1ns", 3e-9}, {"10ps", 30e-12}, {"1 fs", 3e-15}})
    EXPECT_EQ(end(std::string("$timescale ") + scale + " $end "), seconds) << scale;
  EXPECT_EQ(end("", {.time_unit = "ns"}), 3e-9);
  expect_invalid([&] { (void)end(""); }, {"x.vcd:1", "no $timescale", "time_unit"});
  expect_invalid([&] { (void)end("$timescale 1 min $end"); }, {"x.vcd:1", "$timescale 1min", "must be"});
}

TEST(Vcd, IsRefusedWithFileLineAndRule) {
  const std::string head = "$timescale 1 ns $end\n$var wire 1 ! a $end\n$enddefinitions $end\n";
  const auto refused = [](const std::string& text, const std::vector<std::string>& parts) {
    SCOPED_TRACE(text);
    expect_invalid([&] { (void)read_dump(text); }, parts);
  };
  refused(head, {"x.vcd:4", "must have a time"});
  refused("$timescale 1 ns $end\n$var wire 1 ! a $end\n", {"x.vcd:3", "before $enddefinitions"});
  refused("$timescale 1 ns", {"x.vcd:1", "$end"});
  refused("$timescale 1 ns $end\n$var wire 1 ! $end\n", {"x.vcd:2", "$var TYPE BITS IDENTIFIER NAME $end"});
  refused("$timescale 1 ns $end\n$upscope $end\n", {"x.vcd:2", "must follow the $scope"});
  refused("$timescale 1 ns $end\nwire\n", {"x.vcd:2", "\"wire\"", "declaration"});
  refused("$timescale 1 ns $end\n$var event 1 ! a $end\n$enddefinitions $end\n#0\n1!\n", {"a variable that is a number"});
  refused(head + "#0\n1?\n#1\n", {"x.vcd:5", "\"?\"", "declared by $var"});
  refused(head + "#10\n1!\n#9\n0!\n", {"x.vcd:6", "before #10", "must not decrease"});
  refused(head + "#-1\n1!\n", {"x.vcd:4", "\"#-1\"", "2^64"});
  refused(head + "#99999999999999999999\n1!\n", {"2^64"});
  refused(head + "#0\nb12 !\n#1\n", {"x.vcd:5", "bits"});
  refused(head + "#0\nr1.5.3 !\n#1\n", {"x.vcd:5", "number"});
  refused(head + "#0\npDU 0 !\n#1\n", {"x.vcd:5", "\"pDU\""});
}

TEST(Vcd, ThatIsCutIsReadUpToThere) {
  std::size_t read = 0;
  for (std::size_t size = 0; size < of_simulator.size(); ++size) {
    try {
      const Recording cut = read_dump(of_simulator.substr(0, size));
      ++read;
      EXPECT_TRUE(!cut.notes.empty() || !cut.left_out.empty() || of_simulator[size - 1] == '\n') << size;
      for (std::size_t row = 1; row < cut.rows(); ++row) EXPECT_GE(cut.times[row], cut.times[row - 1]);
    } catch (const InvalidInput& refusal) {
      EXPECT_THAT(refusal.what(), HasSubstr("x.vcd"));
    }
  }
  EXPECT_GT(read, 80u);
}

TEST(Vcd, OfChangedBytesIsReadOrRefused_long) {
  for (const std::string& whole : {of_analyser, of_simulator}) {
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
      try {
        const Recording found = read_dump(test::changed_by_a_byte(whole, seed).content);
        for (const Channel& channel : found.channels) EXPECT_EQ(channel.values.size(), found.times.size());
        EXPECT_TRUE(std::ranges::is_sorted(found.times));
      } catch (const InvalidInput&) {
        continue;
      }
    }
  }
}

// All rows of all variables would exceed the memory, and so would the paths of nested scopes.
TEST(Vcd, OfMoreThanFitsIsRefusedUnlessAVariableIsNamed_optimized) {
  std::string head = "$timescale 1 ns $end\n", scopes = head, changes;
  constexpr int variables = 20'000;
  for (int k = 0; k < variables; ++k) {
    head += fmt::format("$var wire 1 v{0} a{0} $end\n", k);
    scopes += fmt::format("$scope module s $end\n$var wire 1 v{0} a{0} $end\n", k);
    changes += fmt::format("#{0}\n1v{0}\n", k);
  }
  const std::string end = "$enddefinitions $end\n";
  for (const std::string& text : {head + end + changes, scopes + end + "#0\n1v0\n"})
    expect_invalid([&] { (void)read_dump(text); }, {"x.vcd", "20000 variables", "column = \"a"});
  EXPECT_THAT(read_dump(head + end + changes, {.column = "a7"}).times, ElementsAre(0, 7e-9, 7e-9, 19999e-9));
}

TEST(Vcd, OfAMillionChangesIsReadInAboutASecond_optimized) {
  std::string text = "$timescale 1 ns $end $var wire 1 ! a $end $var wire 1 \" b $end $enddefinitions $end\n";
  constexpr int changes = 1'000'000;
  for (int k = 0; k < changes; ++k) text += fmt::format("#{}\n{}{}\n", 3 * k, k / 2 % 2, k % 2 == 0 ? '!' : '"');
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(read_dump(text).rows(), 2u * changes - 1);
  constexpr double busy = 10;  // [s], on a busy machine
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), busy);
}

TEST(Vcd, OfAnAnalyserIsARecordOfTheContact) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("capture.vcd", of_analyser);
  const auto times = [&](const ContactTraceKeys& keys) {
    std::vector<double> all;
    for (const LevelEdge& edge : contact_edges(file, keys)) all.push_back(edge.time);
    return all;
  };
  EXPECT_THAT(times({.file = {}, .contact = {.threshold = unknown}}), ElementsAre(2.5e-6, 2.6e-6, 2.7e-6)) << "by its name";
  EXPECT_THAT(times({.file = {.column = "D0"}, .contact = {.threshold = unknown}}), ElementsAre(100e-9, 2.6e-6));
  EXPECT_THAT(times({.file = {}, .shift = {.shift = -1e-6}, .contact = {.threshold = unknown, .merge = 150e-9}}),
              ElementsAre(testing::DoubleNear(1.5e-6, 1e-15)));
  const std::string volts = folder.write("scope.csv", "Time (s),CH1 (V)\n0,0\n1e-6,5\n2e-6,5\n");
  expect_invalid([&] { (void)contact_edges(volts, {.file = {}, .contact = {.threshold = unknown}}); },
                 {"scope.csv", "missing key 'threshold'"});
}

}  // namespace
}  // namespace softland
