// Records of contacts as files: read back by softland, by the tools of GTKWave and by ngspice.
#include "reports/contact_states_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "base/require.h"
#include "exchange/level_edges.h"
#include "exchange/recording.h"
#include "exchange/trace.h"
#include "reports/recording_report.h"
#include "tests/support/temporary_folder.h"

namespace softland {
namespace {

using test::TemporaryFolder;

constexpr double for_ever = std::numeric_limits<double>::infinity();

// A connection with two bounces, one of them shorter than a nanosecond by less than a picosecond, a contact that begins closed,
// and a contact of a device that never closes.
StateRecord closed_twice() {
  const StateChannel connection{.has_resistance = true,
                                .spans = {{1.2345678912e-6, 1.5e-6, {{1.2345678912e-6, 40}, {1.3e-6, 2}, {1.5e-6, 9}}},
                                          {1.5009e-6, 2.25e-6, {{1.5009e-6, 9}, {2.25e-6, 9}}},
                                          {3e-6, for_ever, {{3e-6, 4}, {4e-6, 0.5}, {9e-6, 0.5}}}}};
  const StateChannel left{.contact = "left", .spans = {{0, 2.5e-6}, {2.75e-6, for_ever}}};
  return {.end = 9e-6, .channels = {connection, left}};
}
StateRecord devices() {
  StateRecord record = closed_twice();
  for (StateChannel& one : record.channels) one.device = 11;
  record.channels.push_back({.device = 12, .contact = {}, .spans = {}});
  return record;
}

std::string channel_name(const StateChannel& one, const std::string& what) {
  return (one.device ? fmt::format("device_{}_", *one.device) : std::string()) +
         (one.contact.empty() ? std::string() : one.contact + "_") + what;
}
std::string dumped_name(const StateChannel& one, const std::string& what) {
  return "softland." + (one.device ? fmt::format("device_{}.", *one.device) : std::string()) +
         (one.contact.empty() ? std::string() : one.contact + "_") + what;
}

std::vector<LevelEdge> edges_of(const StateChannel& one) {
  std::vector<LevelEdge> edges;
  for (const ClosedSpan& span : one.spans) {
    edges.push_back({.time = span.begin, .closed = true});
    if (std::isfinite(span.end)) edges.push_back({.time = span.end, .closed = false});
  }
  return edges;
}

std::vector<LevelEdge> edges_in(const std::string& text, const std::string& file, const std::string& column) {
  const ReadKeys keys{.column = column};
  return level_edges(trace_of(parse_recording(text, file, keys), keys, "", true), {.threshold = 0.5});
}

void expect_edges(const std::vector<LevelEdge>& found, const StateChannel& one, double most) {
  const std::vector<LevelEdge> right = edges_of(one);
  ASSERT_EQ(found.size(), right.size());
  for (std::size_t k = 0; k < right.size(); ++k) {
    EXPECT_NEAR(found[k].time, right[k].time, most) << k;
    EXPECT_EQ(found[k].closed, right[k].closed) << k;
  }
}

constexpr double half_a_picosecond = 0.5001e-12, written = 1e-21;  // half of the resolution; error of written numbers [s]

TEST(ContactStatesFile, IsReadBackToTheSameEdges) {
  for (const StateRecord& record : {closed_twice(), devices()}) {
    const std::string table = contact_states_csv(record), dump = contact_states_vcd(record), sources = contact_states_pwl(record);
    for (const StateChannel& one : record.channels) {
      SCOPED_TRACE(channel_name(one, "closed"));
      expect_edges(edges_in(table, "x.csv", channel_name(one, "closed")), one, 0);
      expect_edges(edges_in(dump, "x.vcd", dumped_name(one, "closed")), one, half_a_picosecond);
      expect_edges(edges_in(sources, "x.cir", "softland_" + channel_name(one, "closed") + ".Vdrive"), one, written);
    }
    EXPECT_EQ(parse_recording(dump, "x.vcd").times.back(), record.end);
  }
}

// Returns the value just after a time, with linear interpolation.
double value_at(const Trace& trace, double time) {
  const auto to = static_cast<std::size_t>(std::ranges::upper_bound(trace.times, time) - trace.times.begin());
  if (to == trace.times.size()) return trace.values.back();
  const double a = trace.times[to - 1], b = trace.times[to];
  return std::lerp(trace.values[to - 1], trace.values[to], (time - a) / (b - a));
}

TEST(ContactStatesFile, HasTheResistanceWhileTheContactIsClosed) {
  const StateRecord record = closed_twice();
  const auto trace = [](const std::string& text, const std::string& file, const std::string& column) {
    const ReadKeys keys{.column = column};
    return trace_of(parse_recording(text, file, keys), keys, "", true);
  };
  const Trace table = trace(contact_states_csv(record), "x.csv", "resistance");
  const Trace dump = trace(contact_states_vcd(record), "x.vcd", "resistance_ohm");
  const Trace source = trace(contact_states_pwl(record), "x.cir", "softland_resistance_ohm.Vdrive");
  constexpr double step = 0.051, digits = 1e-5;  // allowed relative error of interpolation; of written numbers
  for (const auto& [time, right] : {std::pair{1.25e-6, 40 - 38 * (1.25e-6 - 1.2345678912e-6) / (1.3e-6 - 1.2345678912e-6)},
                                    {1.4e-6, 5.5},
                                    {2e-6, 9.0},
                                    {3.5e-6, 2.25},
                                    {5e-6, 0.5}}) {
    EXPECT_NEAR(value_at(table, time), right, digits * right) << time;
    EXPECT_NEAR(value_at(source, time), right, digits * right) << time;
    EXPECT_NEAR(value_at(dump, time), right, step * right) << time;
  }
  for (const double time : {1e-6, 1.50045e-6, 2.9e-6}) {
    EXPECT_EQ(value_at(dump, time), open_resistance) << time;
    EXPECT_NEAR(value_at(source, time), open_resistance, 1) << time;
  }
  EXPECT_EQ(parse_recording(contact_states_csv(record), "x.csv").channels[1].missing.line, 2u) << "no number while it is open";
}

// A dump leaves out bounces of less than a picosecond, and edges of a source do not overlap.
TEST(ContactStatesFile, KeepsShortStatesApart) {
  StateRecord record{.end = 2e-6, .channels = {{.spans = {{1e-6, 1e-6 + 0.2e-12}, {1e-6 + 0.3e-12, 1.5e-6}}}}};
  const StateChannel joined{.spans = {{1e-6, 1.5e-6}}};
  expect_edges(edges_in(contact_states_vcd(record), "x.vcd", "closed"), joined, half_a_picosecond);
  expect_edges(edges_in(contact_states_csv(record), "x.csv", "closed"), record.channels.front(), 0);
  expect_edges(edges_in(contact_states_pwl(record), "x.cir", "softland_closed.Vdrive"), record.channels.front(), 1e-18);
}

TEST(ContactStatesFile, HasShortIdentifiersOfManyChannels) {
  StateRecord record{.end = 1e-3, .channels = {}};
  constexpr std::size_t many = 9100;  // number of channels, whose identifiers have one, two and three characters
  for (std::size_t k = 0; k < many; ++k) record.channels.push_back({.device = k, .spans = {{1e-9 * static_cast<double>(k + 1)}}});
  const std::string dump = contact_states_vcd(record);
  for (const std::size_t k : {std::size_t{0}, std::size_t{93}, std::size_t{94}, std::size_t{8929}, std::size_t{8930}, many - 1})
    expect_edges(edges_in(dump, "x.vcd", fmt::format("softland.device_{}.closed", k)), record.channels[k], half_a_picosecond);
  EXPECT_THROW((void)contact_states_csv(record), InvalidInput) << "of 9100 columns and twice as many rows";
}

TEST(ContactStatesFile, IsReadByGtkWave_optimized) {
  if (std::system("command -v vcd2fst >/dev/null && command -v fst2vcd >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "skipped: no other reader of value change dumps; needs: gtkwave";
  const TemporaryFolder folder;
  for (const StateRecord& record : {closed_twice(), devices()}) {
    const std::string dump = contact_states_vcd(record);
    (void)folder.write("contact.vcd", dump);
    const std::string command =
        fmt::format("cd '{}' && vcd2fst contact.vcd contact.fst && fst2vcd contact.fst > again.vcd", folder.path(""));
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::stringstream again;
    again << std::ifstream(folder.path("again.vcd")).rdbuf();
    for (const StateChannel& one : record.channels) {
      expect_edges(edges_in(again.str(), "again.vcd", dumped_name(one, "closed")), one, half_a_picosecond);
      if (!one.has_resistance) continue;
      const ReadKeys keys{.column = dumped_name(one, "resistance_ohm")};
      EXPECT_EQ(trace_of(parse_recording(again.str(), "again.vcd", keys), keys, "", true).values,
                trace_of(parse_recording(dump, "x.vcd", keys), keys, "", true).values);
    }
  }
}

// Only few rows of a long file are drawn. A step of one variable among many changes of another is vertical.
TEST(ContactStatesFile, IsDrawnAsSteps) {
  StateRecord record{.end = 1e-3, .channels = {{.spans = {}}, {.contact = "left", .spans = {{0.123456e-3}}}}};
  for (int k = 1; k < 20'000; ++k) record.channels[0].spans.push_back({2e-8 * k, 2e-8 * k + 1e-8});
  const std::string picture = recording_svg(parse_recording(contact_states_vcd(record), "x.vcd"));
  const std::size_t begin = picture.rfind("<path d=\"M"), end = picture.find('"', begin + 10);
  const std::string line = picture.substr(begin, end - begin);
  EXPECT_LE(std::ranges::count(line, ' '), 9) << line;
}

// A switch that is driven by the state, and a resistor with the contact resistance, in a circuit at 1 V.
TEST(ContactStatesFile, DrivesASwitchAndAResistorInNgspice_optimized) {
  if (std::system("command -v ngspice >/dev/null 2>&1") != 0) GTEST_SKIP() << "skipped: no circuit simulator; needs: ngspice";
  const StateRecord record = closed_twice();
  const TemporaryFolder folder;
  (void)folder.write("contact.cir", contact_states_pwl(record));
  (void)folder.write("deck.cir", R"(a contact record in a circuit
.include contact.cir
V1 in 0 1
Xc c 0 softland_closed
S1 in a c 0 closes
.model closes sw(vt=0.5 ron=1 roff=1e9)
Ra a 0 999
Xr r 0 softland_resistance_ohm
Rc in b R='V(r)'
Rb b 0 1
.tran 5n 9u 0 5n
.control
set numdgt=15
set wr_singlescale
run
wrdata out.txt v(c) v(a) v(b)
quit 0
.endc
.end
)");
  ASSERT_EQ(std::system(fmt::format("cd '{}' && ngspice -b deck.cir >log.txt 2>&1", folder.path("")).c_str()), 0)
      << std::ifstream(folder.path("log.txt")).rdbuf();
  std::ifstream result(folder.path("out.txt"));
  Trace state, voltage;
  double time = 0, closed = 0, behind = 0, over = 0;
  while (result >> time >> closed >> behind >> over) {
    state.times.push_back(time), voltage.times.push_back(time);
    state.values.push_back(closed), voltage.values.push_back(over);
    if (std::abs(closed - 0.5) > 0.01) {
      EXPECT_NEAR(behind, closed > 0.5 ? 0.999 : 0, 1e-6) << time;
    }
  }
  EXPECT_GT(state.times.size(), 1000u);
  constexpr double corner = 5e-12;  // ngspice merges corners that are closer [s]
  expect_edges(level_edges(state, {.threshold = 0.5}), record.channels.front(), corner);
  for (const auto& [at, resistance] : {std::pair{1.4e-6, 5.5}, {2e-6, 9.0}, {3.5e-6, 2.25}, {5e-6, 0.5}, {1e-6, 1e12}})
    EXPECT_NEAR(value_at(voltage, at), 1 / (1 + resistance), 1e-4) << at;
}

}  // namespace
}  // namespace softland
