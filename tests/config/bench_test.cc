// Files of measurements, and scenes in which numbers are replaced and the rest of the text is kept.
#include "config/bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "base/require.h"
#include "config/edited_scene.h"
#include "tests/support/temporary_folder.h"

namespace softland::bench_test {
namespace {

Bench parsed(const std::string& text) { return parse_bench(text, "bench.toml"); }
std::string refusal(const std::string& text) {
  try {
    (void)parsed(text);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return {};
}
void expect_refused(const std::string& text, const std::string& words) {
  EXPECT_NE(refusal(text).find(words), std::string::npos) << text << "\nsays " << refusal(text);
}

TEST(Bench, HasValuesWithErrorsInSiUnits) {
  const Bench bench = parsed(R"(
[[measurement]]
quantity = "pull_in"
value = ["17.1 V", "17.3 V"]
error = "1 %"
[[measurement]]
quantity = "closing_time"
drive = "main"
level = "22 V"
value = "38.2 us"
error = "50 ns"
device = "A7"
[device.A7]
set = ["gap.electrode=3.4 um"]
)");
  ASSERT_EQ(bench.measurements.size(), 2U);
  EXPECT_EQ(bench.measurements[0].values, (std::vector<double>{17.1, 17.3}));
  EXPECT_NEAR(bench.measurements[0].errors[1], 0.173, 1e-12);
  EXPECT_EQ(bench.measurements[1].values, std::vector<double>{38.2e-6});
  EXPECT_EQ(bench.measurements[1].errors, std::vector<double>{50e-9});
  EXPECT_EQ(bench.measurements[1].levels, std::vector<double>{22});
  EXPECT_EQ(bench.measurements[1].place, "bench.toml:6");
  EXPECT_EQ(bench.changes.at("A7"), std::vector<std::string>{"gap.electrode=3.4 um"});
}
TEST(Bench, ReadsRowsInTheUnitsOfTheirHeader) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "c.csv") << "voltage_mV,capacitance [fF]\n0,41.5\n5000,42\n";
  std::ofstream(folder.path() / "t.csv") << "# scope\ntime [us],contact\n0,0\n1,0\n2,1\n3,1\n4,0\n";
  std::ofstream(folder.path() / "v.csv") << "time_s,velocity_m_s\n0,0\n1e-6,0.01\n";
  const Bench bench = parse_bench(R"(
[[measurement]]
quantity = "capacitance"
file = "c.csv"
error = "0.1 fF"
[[measurement]]
quantity = "contact"
file = "t.csv"
level = "20 V"
edges = 2
error = "50 ns"
[[measurement]]
quantity = "velocity"
file = "v.csv"
level = "20 V"
error = "1 mm/s"
[[measurement]]
quantity = "velocity"
file = "v.csv"
level = "20 V"
error = "1 mm/s"
until = "0.5 us"
)",
                                  "bench.toml", folder.path());
  EXPECT_EQ(bench.measurements[3].times, std::vector<double>{0});
  EXPECT_TRUE(bench.measurements[3].has_end && !bench.measurements[2].has_end);
  EXPECT_EQ(bench.measurements[0].levels, (std::vector<double>{0, 5}));
  EXPECT_NEAR(bench.measurements[0].values[0], 41.5e-15, 1e-27);
  ASSERT_EQ(bench.measurements[1].values.size(), 2U);
  EXPECT_NEAR(bench.measurements[1].values[0], 1.5e-6, 1e-18);
  EXPECT_NEAR(bench.measurements[1].values[1], 3.5e-6, 1e-18);
  EXPECT_EQ(bench.measurements[2].times, (std::vector<double>{0, 1e-6}));
  for (const std::size_t moves : {1U, 2U}) EXPECT_EQ(bench.measurements[moves].levels, (std::vector<double>{20, 20}));
}
// An export of a Tektronix oscilloscope: rows every 10 ns from 2 us before the trigger, with a low voltage while the contact is
// closed.
constexpr const char* scope_file = R"(Record Length,8
Sample Interval,1e-06
Vertical Units,V
TIME,CH1,CH2
-2e-06,0,3.3
-1e-06,0,3.3
0,5,3.3
1e-06,5,3.3
2e-06,5,0.3
3e-06,5,0.1
4e-06,5,3.1
5e-06,5,0.1
)";
constexpr const char* vibrometer_file = R"(    -1
    58
vibrometer
NONE
26-Nov-26 12:00:00
NONE
NONE
    1         0    0         0 NONE               0   0 NONE               0   0
         2         4         1  0.00000E+00  1.00000E-06  0.00000E+00
        17    0    0    0 Time                 s
        11    0    0    0 tip                  mm/s
         0    0    0    0 NONE                 NONE
         0    0    0    0 NONE                 NONE
  0.00000E+00  1.50000E+00  4.00000E+00  9.00000E+00
    -1
)";

TEST(Bench, ReadsWhatInstrumentsWrite) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "scope.csv") << scope_file;
  std::ofstream(folder.path() / "tip.uff") << vibrometer_file;
  std::ofstream(folder.path() / "decoder.csv") << "time (us),decoder (mV)\n-1,0\n0,0\n1,100\n2,300\n";
  std::ofstream(folder.path() / "capture.vcd")
      << "$timescale 1 ns $end $var wire 1 ! D0 $end $enddefinitions $end\n#0 1!\n#3000 0!\n#4000 1!\n";
  const Bench bench = parse_bench(R"(
[[measurement]]
quantity = "contact"
file = "scope.csv"
column = "CH2"
threshold = "1.3 V"
closed = "below"
hysteresis = "0.2 V"
level = "20 V"
edges = 3
error = "50 ns"
[[measurement]]
quantity = "contact"
file = "scope.csv"
column = 3
threshold = "1.3 V"
closed = "below"
merge = "1.5 us"
shift = "1 us"
level = "20 V"
error = "50 ns"
[[measurement]]
quantity = "velocity"
file = "tip.uff"
level = "20 V"
error = "1 mm/s"
[[measurement]]
quantity = "velocity"
file = "tip.uff"
unit = "m/s"
level = "20 V"
error = "1 mm/s"
[[measurement]]
quantity = "position"
file = "decoder.csv"
per_volt = "2 um"
level = "20 V"
error = "1 nm"
[[measurement]]
quantity = "contact"
file = "capture.vcd"
closed = "below"
level = "20 V"
edges = 2
error = "1 ns"
)",
                                  "bench.toml", folder.path());
  constexpr double rounding = 1e-15;
  const auto expect_near = [](const std::vector<double>& found, const std::vector<double>& due, double most) {
    ASSERT_EQ(found.size(), due.size());
    for (std::size_t k = 0; k < due.size(); ++k) EXPECT_NEAR(found[k], due[k], most) << k;
  };
  expect_near(bench.measurements[0].values, {1e-6 + 2e-6 / 3, 3.4e-6, 4.6e-6}, rounding);
  expect_near(bench.measurements[1].values, {2e-6 + 2e-6 / 3}, rounding);
  EXPECT_EQ(bench.measurements[2].times, (std::vector<double>{0, 1e-6, 2e-6, 3e-6}));
  expect_near(bench.measurements[2].values, {0, 1.5e-3, 4e-3, 9e-3}, rounding);
  expect_near(bench.measurements[3].values, {0, 1.5, 4, 9}, rounding);
  expect_near(bench.measurements[4].times, {0, 1e-6, 2e-6}, rounding);
  expect_near(bench.measurements[4].values, {0, 0.2e-6, 0.6e-6}, rounding);
  expect_near(bench.measurements[5].values, {3e-6, 4e-6}, rounding);
}
TEST(Bench, NamesTheKeyThatAFileOfAnInstrumentLacks) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "scope.csv") << scope_file;
  std::ofstream(folder.path() / "plain.csv") << "t,x\n0,1\n1e-6,2\n";
  const auto expect_so = [&](const std::string& quantity, const std::string& keys, const std::string& words) {
    try {
      (void)parse_bench("[[measurement]]\nquantity = \"" + quantity + "\"\nlevel = \"9 V\"\nerror = \"1 %\"\n" + keys, "b.toml",
                        folder.path());
      ADD_FAILURE() << keys;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  const std::string scope = "file = \"scope.csv\"\n", low = scope + "column = \"CH2\"\nthreshold = \"1 V\"\n";
  expect_so("contact", scope, "missing key 'threshold'");
  expect_so("contact", scope + "threshold = \"1 V\"", "column");
  expect_so("contact", low, "the contact must be open at t = 0; closed = \"below\"");
  expect_so("contact", low + "closed = \"under\"", "b.toml:8: measurement.closed = \"under\": must be \"above\" or \"below\"");
  expect_so("contact", low + "closed = \"below\"\nmerge = \"9 us\"\nedges = 2", "its voltage has 1 edges");
  expect_so("contact", low + "hysteresis = \"-1 V\"", "must be at least 0");
  expect_so("contact", low + "thresold = \"1 V\"", "did you mean 'threshold'?");
  expect_so("contact", low + "per_volt = \"1 um\"", "is of a position or velocity only");
  expect_so("velocity", scope + "threshold = \"1 V\"", "applies to a contact record only");
  expect_so("velocity", scope + "column = \"CH2\"", "the velocity is in V: expected a velocity [m/s]; per_volt");
  expect_so("velocity", scope + "column = 2\nunit = \"um\"", "the velocity is in um: expected a velocity");
  expect_so("velocity", scope + "column = 2\nunit = \"m/s\"\nper_volt = \"1 m/s\"", "must not be given together with unit");
  expect_so("velocity", "file = \"plain.csv\"", "the file names no unit: give unit");
  expect_so("velocity", scope + "column = 2\nunit = \"m/s\"\nuntil = \"-1 us\"", "must not be before the first row");
  expect_so("contact", low + "closed = \"below\"\nuntil = \"9 us\"", "is of a position or velocity only");
  expect_so("capacitance", scope + "column = 2", "applies to a file of values over time only");
}
TEST(Bench, ContactKeysOfAnOptionAreThoseOfAMeasurement) {
  const ContactTraceKeys keys =
      contact_trace_keys({"threshold=1.5 V", "closed=below", "column=2", "merge=\"100 ns\"", "shift=first"});
  EXPECT_EQ(keys.contact.threshold, 1.5);
  EXPECT_TRUE(keys.contact.is_closed_below);
  EXPECT_EQ(keys.contact.merge, 100e-9);
  EXPECT_EQ(keys.file.column_number, 2);
  EXPECT_TRUE(keys.shift.first_is_zero);
  const auto refused = [](const std::vector<std::string>& assignments) -> std::string {
    try {
      (void)contact_trace_keys(assignments);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(refused({"threshold"}), "--contact threshold: must be KEY=VALUE, such as \"threshold=1.5 V\"");
  EXPECT_TRUE(std::isnan(contact_trace_keys({"column=D0"}).contact.threshold)) << "of a channel of states";
  EXPECT_EQ(refused({"threshold=1.5 A"}), "--contact: threshold = \"1.5 A\": expected a voltage [V], got a current [A]");
  EXPECT_NE(refused({"threshold=1 V", "thershold=1 V"}).find("did you mean 'threshold'?"), std::string::npos);
}
TEST(Bench, RefusesWhatItCannotMean) {
  const std::string begin = "[[measurement]]\nquantity = \"pull_in\"\n";
  expect_refused("", "must have at least one [[measurement]]");
  expect_refused("measurements = 1", "unknown key (did you mean 'measurement'?)");
  expect_refused("[[measurement]]\nquantity = \"pullin\"\nvalue = \"1 V\"\nerror = \"1 %\"", "did you mean 'pull_in'?");
  expect_refused(begin + "value = \"1 V\"", "bench.toml:1: [[measurement]]: missing key 'error'");
  expect_refused(begin + "error = \"1 %\"", "needs either 'value' or 'file'");
  expect_refused(begin + "value = \"1 um\"\nerror = \"1 %\"",
                 "bench.toml:3: measurement.value = \"1 um\": expected a voltage [V], got a length [m]");
  expect_refused(begin + "value = 17.1\nerror = \"1 %\"", "expected a voltage in quotes");
  expect_refused(begin + "value = \"1 V\"\nerror = \"0 V\"", "must be above 0");
  expect_refused(begin + "value = \"-1 V\"\nerror = \"1 %\"", "a pull_in must be above 0");
  expect_refused(begin + "value = \"1 V\"\nerror = \"1 %\"\nlevel = \"3 V\"", "must not be given for a pull_in");
  expect_refused(begin + "value = \"1 V\"\nerror = \"1 %\"\nmode = 2", "applies to a frequency only");
  expect_refused(begin + "value = \"1 V\"\nerror = \"1 %\"\neror = 2", "unknown key (did you mean 'error'?)");
  expect_refused(begin + "file = \"none.csv\"\nerror = \"1 %\"", "measurement.file = \"none.csv\"");
  expect_refused(begin + "value = \"1 V\"\nerror = \"1 %\"\n[device.B]\nset = [\"gap.contact=1 um\"]",
                 "no measurement belongs to this device");
  expect_refused("[[measurement]]\nquantity = \"position\"\nvalue = \"1 um\"\nerror = \"1 nm\"", "name a file");
}

constexpr const char* written = R"(title = "µ-switch"  # µ before a value on its line
[structure]          # a beam
thickness = "2 um"   # SEM, wafer 3
youngs_modulus = "78 GPa"
damping_ratio = 0.01
[gap]
electrode = "3500 nm"
[electrode.main]
span = ["60 um", "96 %"]   # from the clamp
)";
TEST(EditedScene, KeepsCommentsOrderAndUnits) {
  const std::string now = edited_scene(
      written, "s.toml",
      {{.path = "structure.thickness", .value = {.value = 2.05e-6, .dimension = dimension::length}, .remark = "fitted"},
       {.path = "structure.damping_ratio", .value = {.value = 0.02, .dimension = dimension::none}},
       {.path = "gap.electrode", .value = {.value = 3.4567e-6, .dimension = dimension::length}},
       {.path = "electrode.main.span", .element = 2, .value = {.value = 0.95, .dimension = dimension::none}},
       {.path = "gap.contact", .value = {.value = 2e-6, .dimension = dimension::length}},
       {.path = "gas.viscosity", .value = {.value = 1.8e-5, .dimension = dimension::viscosity}}});
  EXPECT_EQ(now, R"(title = "µ-switch"  # µ before a value on its line
[structure]          # a beam
thickness = "2.05 um"   # SEM, wafer 3  # fitted, was "2 um"
youngs_modulus = "78 GPa"
damping_ratio = 0.02
[gap]
contact = "2e-06 m"
electrode = "3456.7 nm"
[electrode.main]
span = ["60 um", "95 %"]   # from the clamp

[gas]
viscosity = "1.8e-05 Pa s"
)");
}
TEST(EditedScene, TakesTheSpreadOfAnotherScene) {
  const std::string text = "a = 1  # kept\n[spread]\nx = { cov = \"1 %\" }\n[gap]\ncontact = \"1 um\"  # kept too\n";
  const std::string now = with_spread_of(text, "s.toml", SceneFile::parse("[spread]\ny = { cov = \"2 %\" }\n", "t.toml"));
  EXPECT_EQ(now, "a = 1  # kept\n[spread]\ny = { cov = \"2 %\" }\n\n[gap]\ncontact = \"1 um\"  # kept too\n");
  EXPECT_EQ(with_spread_of("a = 1\n", "s.toml", SceneFile::parse("[spread]\ny = { cov = \"2 %\" }\n", "t.toml")),
            "a = 1\n\n[spread]\ny = { cov = \"2 %\" }\n");
  EXPECT_THROW((void)with_spread_of("spread.x = 1\n", "s.toml", SceneFile::parse("[spread]\ny = 1\n", "t.toml")), InvalidInput);
}

}  // namespace
}  // namespace softland::bench_test
