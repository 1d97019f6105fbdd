#include "waveforms/table.h"

#include <gtest/gtest.h>

#include "base/literals.h"
#include "tests/support/not_finite.h"
#include "tests/support/temporary_folder.h"
#include "tests/waveforms/expect_invalid.h"

namespace softland {
namespace {

using namespace literals;
using test::expect_invalid;
using test::TemporaryFolder;

TEST(Table, IsLinearBetweenRowsAndHoldsItsLast) {
  const Signal table = signal(Table{.time = {0, 1, 3}, .voltage = {2, 4, -4}});
  EXPECT_EQ(table.voltage(0), 2);
  EXPECT_EQ(table.voltage(0.5), 3);
  EXPECT_EQ(table.voltage(2), 0);
  EXPECT_EQ(table.voltage(3), -4);
  EXPECT_EQ(table.voltage(100), -4);
}

TEST(Table, TwoRowsOfOneTimeAreAJump) {
  const Signal table = signal(Table{.time = {0, 1, 1, 2}, .voltage = {0, 3, 5, 5}});
  EXPECT_EQ(table.breakpoints(), (std::vector<double>{0, 1}));
  EXPECT_EQ(table.voltage_before(1), 3);
  EXPECT_EQ(table.voltage(1), 5);
  EXPECT_EQ(signal(Table{.time = {0, 0}, .voltage = {0, 5}}).pieces(), Signal::constant(5).pieces());
}

TEST(Table, OfOneRowIsAConstant) { EXPECT_EQ(signal(Table{.time = {0}, .voltage = {7}}).pieces(), Signal::constant(7).pieces()); }

TEST(Table, NamesRowValueAndRule) {
  expect_invalid([] { (void)signal(Table{}); }, {"at least one row"});
  expect_invalid([] { (void)signal(Table{.time = {0, 1}, .voltage = {0}}); }, {"2 times and 1 voltages"});
  expect_invalid([] { (void)signal(Table{.time = {1e-6}, .voltage = {0}}); }, {"first row", "1e-06 s", "must be 0"});
  expect_invalid([] { (void)signal(Table{.time = {kNaN}, .voltage = {0}}); }, {"first row", "nan s"});
  expect_invalid([] { (void)signal(Table{.time = {0, 2, 1}, .voltage = {0, 0, 0}}); }, {"row 3", "1 s", "not before"});
  expect_invalid([] { (void)signal(Table{.time = {0, kNaN}, .voltage = {0, 0}}); }, {"row 2", "nan s"});
  expect_invalid([] { (void)signal(Table{.time = {0, 1}, .voltage = {0, kNaN}}); }, {"voltage of row 2", "nan V"});
}

TEST(Table, ReadsTheNamedColumnOfACsvFile) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("drive.csv", "# from a generator\n\ntime_s, main ,piezo\n0,0,+1\n1e-6, 4.5E1 ,-2\n\n2e-6,45,3\n");
  const Table main = read_table(file, "main");
  EXPECT_EQ(main.time, (std::vector<double>{0, 1e-6, 2e-6}));
  EXPECT_EQ(main.voltage, (std::vector<double>{0, 45, 45}));
  EXPECT_EQ(read_table(file, "piezo").voltage, (std::vector<double>{1, -2, 3}));
}

TEST(Table, ReadsFilesOfOtherSystems) {
  const TemporaryFolder folder;
  const Table table = read_table(folder.write("dos.csv", "\xEF\xBB\xBFmain,time_s\r\n5,0\r\n6,1"), "main");
  EXPECT_EQ(table.time, (std::vector<double>{0, 1}));
  EXPECT_EQ(table.voltage, (std::vector<double>{5, 6}));
}

TEST(Table, BadFilesAreNamedWithLineAndRule) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const std::vector<std::string>& parts) {
    const std::string file = folder.write("bad.csv", text);
    expect_invalid([&] { (void)read_table(file, "main"); }, {file});
    expect_invalid([&] { (void)read_table(file, "main"); }, parts);
  };
  refused("", {"no header"});
  refused("time_s,main\n", {"no rows"});
  refused("t,main\n0,1\n", {":1:", "0 columns named \"time_s\""});
  refused("time_s,other\n0,1\n", {":1:", "0 columns named \"main\"", "time_s,other"});
  refused("time_s,main,main\n0,1,2\n", {":1:", "2 columns named \"main\""});
  refused("time_s,main\n0,1\n1\n", {":3:", "1 cells", "2"});
  refused("time_s,main\n0,1\n1,\n", {":3:", "main is \"\"", "finite number"});
  refused("time_s,main\n0,1\n1,2 V\n", {":3:", "main is \"2 V\""});
  refused("time_s,main\n0,nan\n", {":2:", "main is \"nan\""});
  refused("time_s,main\n0,1e999\n", {":2:", "main is \"1e999\""});
  refused("time_s,main\n1,1\n", {":2:", "first time_s is 1 s", "must be 0"});
  refused("time_s,main\n0,1\n2,1\n\n1,1\n", {":5:", "1 s", "2 s"});
  refused("time_s,main\n0,1e308\n1e-3,-1e308\n",
          {":3:", "main is -1e+308 V, 0.001 s after", "the slope between them must be finite"});
  expect_invalid([&] { (void)read_table(folder.path("absent.csv"), "main"); }, {"absent.csv", "cannot be read"});
  expect_invalid([&] { (void)read_table(folder.path(""), "main"); }, {"is a folder"});
}

}  // namespace
}  // namespace softland
