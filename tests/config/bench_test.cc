// Files of measurements, and scenes that get other numbers and keep their words.
#include "config/bench.h"

#include <gtest/gtest.h>

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
)",
                                  "bench.toml", folder.path());
  EXPECT_EQ(bench.measurements[0].levels, (std::vector<double>{0, 5}));
  EXPECT_NEAR(bench.measurements[0].values[0], 41.5e-15, 1e-27);
  ASSERT_EQ(bench.measurements[1].values.size(), 2U);
  EXPECT_NEAR(bench.measurements[1].values[0], 1.5e-6, 1e-18);
  EXPECT_NEAR(bench.measurements[1].values[1], 3.5e-6, 1e-18);
  EXPECT_EQ(bench.measurements[2].times, (std::vector<double>{0, 1e-6}));
  for (const std::size_t moves : {1U, 2U}) EXPECT_EQ(bench.measurements[moves].levels, (std::vector<double>{20, 20}));
}
TEST(Bench, RefusesWhatItCannotMean) {
  const std::string begin = "[[measurement]]\nquantity = \"pull_in\"\n";
  expect_refused("", "there is no [[measurement]]");
  expect_refused("measurements = 1", "unknown key (did you mean 'measurement'?)");
  expect_refused("[[measurement]]\nquantity = \"pullin\"\nvalue = \"1 V\"\nerror = \"1 %\"", "did you mean 'pull_in'?");
  expect_refused(begin + "value = \"1 V\"", "bench.toml:1: [[measurement]]: missing key 'error'");
  expect_refused(begin + "error = \"1 %\"", "must have one of 'value' and 'file'");
  expect_refused(begin + "value = \"1 um\"\nerror = \"1 %\"",
                 "bench.toml:3: measurement.value = \"1 um\": expected a voltage [V], got a length [m]");
  expect_refused(begin + "value = 17.1\nerror = \"1 %\"", "expected a voltage in quotes");
  expect_refused(begin + "value = \"1 V\"\nerror = \"0 V\"", "must be above 0");
  expect_refused(begin + "value = \"1 V\"\nerror = \"1 %\"\nlevel = \"3 V\"", "a pull_in has none");
  expect_refused(begin + "value = \"1 V\"\nerror = \"1 %\"\nmode = 2", "is of a frequency only");
  expect_refused(begin + "value = \"1 V\"\nerror = \"1 %\"\neror = 2", "unknown key (did you mean 'error'?)");
  expect_refused(begin + "file = \"none.csv\"\nerror = \"1 %\"", "measurement.file = \"none.csv\"");
  expect_refused(begin + "value = \"1 V\"\nerror = \"1 %\"\n[device.B]\nset = [\"gap.contact=1 um\"]",
                 "no measurement is of this device");
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
