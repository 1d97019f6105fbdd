// Files of instruments as the rows of a waveform.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/require.h"
#include "config/read_keys.h"
#include "config/scene.h"
#include "tests/config/small_scene.h"
#include "tests/support/temporary_folder.h"

namespace softland {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

const std::string step_of_main = "family = \"step\"\nlevel = \"1.25 Vdp\"\n";

/// The small scene, with the waveform of its main electrode from a file with this content.
struct FileScene {
  FileScene(const std::string& content, const std::string& keys, const std::string& more = "") : folder() {
    static_cast<void>(folder.write("scope.csv", content));
    const std::string text = edited(small_scene, step_of_main, "family = \"table\"\nfile = \"scope.csv\"\n" + keys) + more;
    path = folder.write("scene.toml", text);
  }
  [[nodiscard]] Scene scene() const { return read_scene(SceneFile::load(path)); }
  [[nodiscard]] Drives drives() const { return scene().drives({{"main", {.static_pull_in = 50, .dynamic_pull_in = 40}}}); }
  [[nodiscard]] Table table() const { return std::get<Table>(drives().at("main").waveform.value()); }
  void refused(const std::vector<std::string>& parts) const {
    try {
      (void)drives();
      ADD_FAILURE() << "accepted";
    } catch (const InvalidInput& error) {
      for (const std::string& part : parts) EXPECT_THAT(error.what(), HasSubstr(part));
    }
  }
  TemporaryFolder folder;
  std::string path;
};

const std::string scope =
    "x-axis,1,2\nsecond,Volt,Volt\n-2E-06,+0.25E+00,1\n-1E-06,+0.25E+00,1\n0E-06,+1E+00,1\n1E-06,+4E+00,1\n2E-06,+5E+00,1\n";

TEST(FileRows, RowsBeforeTheTriggerAreWhatItStandsAtBefore) {
  const FileScene of(scope, "column = 2\n");
  EXPECT_EQ(of.table().time, (std::vector<double>{0, 1e-6, 2e-6}));
  EXPECT_EQ(of.table().voltage, (std::vector<double>{1, 4, 5}));
  EXPECT_EQ(of.drives().at("main").before, 0.25);
  EXPECT_THAT(of.scene().warnings,
              testing::Contains(HasSubstr(
                  "Keysight CSV, \"1\": 5 samples, every 1 us, from -2 us to 2 us; before t = 0: 250 mV, the mean of 2 rows")));
  const FileScene given(scope, "column = 2\nbefore = \"0 V\"\n");
  EXPECT_EQ(given.drives().at("main").before, 0);
}

TEST(FileRows, AResolvedAndACanonicalSceneNeedNoFile) {
  const FileScene of(scope, "column = 2\nscale = 2.0\n");
  const Scene again = read_scene(
      SceneFile::parse(resolved(of.scene(), {{"main", {.static_pull_in = 50, .dynamic_pull_in = 40}}}).text(), "y.toml"));
  const std::map<std::string, PullInVoltages> known{{"main", {.static_pull_in = 50, .dynamic_pull_in = 40}}};
  EXPECT_EQ(std::get<Table>(again.drives(known).at("main").waveform.value()).voltage, (std::vector<double>{2, 8, 10}));
  EXPECT_EQ(again.drives(known).at("main").before, 0.5);
  const Scene same = read_scene(canonical(SceneFile::load(of.path), "z.toml"));
  EXPECT_EQ(same.drives(known).at("main").before, 0.5);
  EXPECT_EQ(std::get<Table>(same.drives(known).at("main").waveform.value()).time, of.table().time);
}

TEST(FileRows, KeysShiftAndScaleThem) {
  const FileScene first(scope, "column = \"1\"\nshift = \"first\"\nscale = 10\n");
  EXPECT_EQ(first.table().time.size(), 5U);
  EXPECT_EQ(first.table().time.front(), 0);
  EXPECT_EQ(first.table().voltage.front(), 2.5);
  EXPECT_FALSE(first.drives().at("main").before);
  const FileScene later(scope, "column = \"1\"\nshift = \"1.5 us\"\n");
  EXPECT_EQ(later.table().time[0], 0);
  EXPECT_DOUBLE_EQ(later.table().voltage[0], 0.25);
  EXPECT_DOUBLE_EQ(later.table().time[1], 0.5e-6);
  const FileScene late(scope, "column = \"1\"\nshift = \"5 us\"\n");
  EXPECT_EQ(late.table().voltage[0], 0.25);
  EXPECT_THAT(late.scene().warnings, testing::Contains(HasSubstr("its first value holds from t = 0 to 3 us")));
  FileScene(scope, "column = \"1\"\nshift = \"-1 ms\"\n").refused({"all rows are before t = 0", "shift"});
}

TEST(FileRows, WhatIsAmbiguousIsRefusedWithTheKey) {
  FileScene(scope, "").refused({"waveform.main.file", "scope.csv", "2 channels", "column = "});
  FileScene("x-axis,1\nsecond,Volt\n-2E-06,0\n-1E-06,3\n0E-06,4\n1E-06,5\n", "")
      .refused({"2 rows before t = 0", "from 0 V to 3 V, but must be constant", "shift = \"first\""});
  FileScene("1.5\n2.5\n3.5\n", "").refused({"neither times nor an interval", "interval = "});
  EXPECT_EQ(FileScene("1.5\n2.5\n3.5\n", "interval = \"1 us\"\n").table().time, (std::vector<double>{0, 1e-6, 2e-6}));
  FileScene("t,U\n0,x\n1,2\n2,3\n3,4\n", "").refused({"scope.csv:2", "column 2"});
}

TEST(FileRows, KeysNeedAFileAndAreChecked) {
  const auto refused = [](const std::string& waveform, const std::string& part) {
    try {
      (void)read_scene(SceneFile::parse(edited(small_scene, step_of_main, waveform), "x.toml"));
      ADD_FAILURE() << "accepted: " << waveform;
    } catch (const InvalidInput& error) {
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  };
  const std::string rows = "family = \"table\"\ntimes = [\"0 s\"]\nvoltages = [\"1 V\"]\n";
  refused(rows + "skip = 1\n", "waveform.main.skip = 1: describes a file: give the key file too, or omit this key");
  refused(rows + "column = 0\n", "waveform.main.column = 0");
  refused(rows + "decimal = \";\"\n", "waveform.main.decimal");
  refused(rows + "interval = \"even\"\n", "waveform.main.interval");
}

TEST(FileRows, AFileOfSoftlandKeepsItsBits) {
  const std::string own = "time_s,main,piezo\n0,1,0\n1e-06,0.1,0\n1e-06,0.30000000000000004,0\n3e-06,7,0\n";
  EXPECT_EQ(FileScene(own, "").table().voltage, (std::vector<double>{1, 0.1, 0.30000000000000004, 7}));
  EXPECT_THAT(FileScene(own, "").scene().warnings, testing::Not(testing::Contains(HasSubstr("samples"))));
  EXPECT_EQ(FileScene(own, "column = \"piezo\"\ninterval = \"uneven\"\n").table().voltage, (std::vector<double>{0, 0, 0, 0}));
}

TEST(FileRows, ALongRecordIsThinnedToWhatTheSourceCanPass) {
  std::string text = "x-axis,1\nsecond,Volt\n";
  for (int i = 0; i < 20000; ++i)
    text += fmt::format("{:.6E},{:.4E}\n", i * 1e-9, i < 3000 ? 0.0 : 20 + 0.01 * (i * 7919 % 13 - 6));
  const FileScene of(text, "", "[driver.main]\nbandwidth = \"1 MHz\"\n");
  EXPECT_LT(of.table().time.size(), 4000U);
  EXPECT_EQ(of.table().time.back(), 19999e-9);
  EXPECT_THAT(of.scene().warnings, testing::Contains(HasSubstr("thinned from 20000 to")));
  EXPECT_THAT(of.scene().warnings, testing::Contains(HasSubstr("with the bandwidth of 1 MHz they differ by less than")));
}

TEST(ReadKeys, AreThoseOfAWaveform) {
  const ReadKeys keys = read_keys({"column=CH2", "time_column=1", "interval=8 ns", "skip=3", "time_unit=ms", "decimal=,"});
  EXPECT_EQ(keys.column, "CH2");
  EXPECT_EQ(keys.time_column_number, 1);
  EXPECT_EQ(keys.interval, 8e-9);
  EXPECT_EQ(keys.skip, 3);
  EXPECT_EQ(keys.time_unit, "ms");
  EXPECT_EQ(keys.decimal, ',');
  EXPECT_TRUE(read_keys({"interval=uneven"}).uneven);
  EXPECT_THROW((void)read_keys({"scale=2"}), InvalidInput);
  try {
    (void)read_keys({"colum=1"});
    ADD_FAILURE() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'column'"));
  }
}

}  // namespace
}  // namespace softland
