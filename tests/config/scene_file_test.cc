// Scenes as text: options, inserted waveforms, round trips.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "base/require.h"
#include "config/scene.h"
#include "tests/config/small_scene.h"

namespace softland {
namespace {

const std::map<std::string, PullInVoltages> measured_pull_in{{"main", {.static_pull_in = 50.1, .dynamic_pull_in = 1.0 / 0.023}}};

SceneFile small_file() { return SceneFile::parse(small_scene, "x.toml"); }

TEST(SceneFile, TextReadsBackToTheSameScene) {
  const SceneFile file = small_file();
  const SceneFile again = SceneFile::parse(file.text(), "y.toml");
  EXPECT_EQ(again.json(), file.json());
  EXPECT_EQ(again.text(), file.text());
}

TEST(SceneFile, TextKeepsTheOrderOfTheSchema) {
  const SceneFile file =
      SceneFile::parse("[gap]\ncontact = \"2 um\"\nelectrode = \"3 um\"\n[structure]\nkind = \"x\"\n", "x.toml");
  EXPECT_EQ(file.text(), "[structure]\nkind = \"x\"\n\n[gap]\nelectrode = \"3 um\"\ncontact = \"2 um\"\n");
}

TEST(SceneFile, TextOfAnyTomlReadsBack) {
  const std::string text = R"(a = [1, 2.0, -inf, nan, true, "x\ty", [], {}, { b = "c d", "e f" = 1 }]
"" = 1979-05-27T07:32:00Z
"dotted.key" = 07:32:00
title = "\u0001 \\ \" µ"
[empty]
[deep.er.still]
x = 1e300
[[many]]
y = 1
[[many]]
)";
  const SceneFile file = SceneFile::parse(text, "x.toml");
  const SceneFile again = SceneFile::parse(file.text(), "y.toml");
  EXPECT_EQ(again.text(), file.text());
  EXPECT_EQ(again.json(), file.json());
  EXPECT_THAT(file.text(), testing::HasSubstr("title = \"\\u0001 \\\\ \\\" µ\""));
}

TEST(SceneFile, CopiesAreIndependent) {
  const SceneFile original = small_file();
  SceneFile copy = original;
  copy.set("structure.length=300 um");
  EXPECT_EQ(original.json()["structure"]["length"], "250 um");
  EXPECT_EQ(copy.json()["structure"]["length"], "300 um");
}

TEST(SceneFile, CopiesStillKnowTheirLines) {
  const SceneFile copy = SceneFile(SceneFile::parse(edited(small_scene, "\"4 um\"", "4"), "x.toml"));
  try {
    static_cast<void>(read_scene(copy));
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("x.toml:6: "));
  }
}

TEST(SceneFile, AnOptionIsTomlOrElseBareText) {
  SceneFile file = small_file();
  file.set("structure.modes=6");
  file.set("structure.damping_ratio = 0.5");
  file.set("structure.length=300 um");
  file.set("structure.width=\"30 um\"");
  file.set("electrode.main.span=[\"1 um\", \"2 um\"]");
  file.set("title=a = b # c");
  file.set("spread.\"gap.contact\"={ distribution = \"normal\", cov = 0.1 }");
  const nlohmann::json json = file.json();
  EXPECT_EQ(json["structure"]["modes"], 6);
  EXPECT_EQ(json["structure"]["damping_ratio"], 0.5);
  EXPECT_EQ(json["structure"]["length"], "300 um");
  EXPECT_EQ(json["structure"]["width"], "30 um");
  EXPECT_EQ(json["electrode"]["main"]["span"], (nlohmann::json{"1 um", "2 um"}));
  EXPECT_EQ(json["title"], "a = b # c");
  EXPECT_EQ(json["spread"]["gap.contact"]["cov"], 0.1);
  EXPECT_EQ(SceneFile::parse(file.text(), "y.toml").json(), json);
}

TEST(SceneFile, AnOptionMayCreateASection) {
  SceneFile file =
      SceneFile::parse(edited(small_scene, "[gas]\nmodel = \"strip\"\nviscosity = \"1.86e-5 Pa s\"\n", ""), "x.toml");
  EXPECT_FALSE(read_scene(file).device.gas);
  file.set("gas.model=strip");
  file.set("gas.viscosity=2e-5 Pa s");
  EXPECT_EQ(film_of(*read_scene(file).device.gas)->viscosity, 2e-5);
  EXPECT_THAT(file.text(), testing::HasSubstr("[gas]\nmodel = \"strip\"\nviscosity = \"2e-5 Pa s\"\n"));
}

TEST(SceneFile, AnOptionTakesThePlaceOfTheOtherWayToGiveAQuantity) {
  SceneFile file = small_file();
  file.set("simulate.tolerance=1e-8");
  const Scene scene = read_scene(file);
  EXPECT_EQ(scene.simulate.tolerance, 1e-8);
  EXPECT_FALSE(file.json()["simulate"].contains("accuracy"));
  // The last of several options for a key counts.
  file.set("simulate.accuracy=1e-4");
  EXPECT_EQ(read_scene(file).simulate.accuracy, 1e-4);
}

/// Returns a waveform after it was written as text and read again.
Waveform after_text(const Waveform& waveform) {
  SceneFile file = small_file();
  file.set("driver.main={ min_voltage = \"-1e9 V\", max_voltage = \"1e9 V\" }");
  file.set_waveform("main", waveform);
  const Scene scene = read_scene(SceneFile::parse(file.text(), "y.toml"));
  return scene.drives({}).at("main").waveform.value();
}

TEST(SceneFile, WaveformsReadBackDigitForDigit_long) {
  const bool holds = rc::check([](int seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const auto number = [&](double scale) { return scale * std::uniform_real_distribution<double>(0, 1)(random); };
    const Step step{.level = number(60), .rise_time = number(1e-5)};
    const auto step_again = std::get<Step>(after_text(step));
    RC_ASSERT(step_again.level == step.level && step_again.rise_time == step.rise_time);

    const Harmonic harmonic{.base = number(60),
                            .rise_time = number(1e-5),
                            .amplitude = -number(5),
                            .angular_frequency = number(1e6) + 1,
                            .phase = number(7),
                            .start = number(1e-5),
                            .end = 1e-4 + number(1e-5),
                            .fade = number(1e-5)};
    const auto harmonic_again = std::get<Harmonic>(after_text(harmonic));
    RC_ASSERT(std::memcmp(&harmonic_again, &harmonic, sizeof harmonic) == 0);

    const double edge = number(1e-6);
    const double first = edge + number(1e-5);
    const Pulse pulse{
        .levels = {number(60), -number(1), number(60)}, .times = {first, first + edge + number(1e-5)}, .edge = edge};
    const auto pulse_again = std::get<Pulse>(after_text(pulse));
    RC_ASSERT(pulse_again.levels == pulse.levels && pulse_again.times == pulse.times && pulse_again.edge == pulse.edge);

    const Table table{.time = {0, number(1e-5), 1}, .voltage = {number(1), number(60), number(60)}};
    const auto table_again = std::get<Table>(after_text(table));
    RC_ASSERT(table_again.time == table.time && table_again.voltage == table.voltage);
  });
  EXPECT_TRUE(holds);
}

TEST(SceneFile, AnEndlessHarmonicStaysEndless) {
  const auto harmonic = std::get<Harmonic>(after_text(Harmonic{.base = 1, .amplitude = 1, .angular_frequency = 1}));
  EXPECT_TRUE(std::isinf(harmonic.end));
}

TEST(SceneFile, AWaveformThatBreaksItsFamilyIsNotWritten) {
  SceneFile file = small_file();
  EXPECT_THROW(file.set_waveform("main", Step{.level = std::nan("")}), InvalidInput);
  EXPECT_EQ(file.json(), small_file().json());
}

TEST(SceneFile, ANewWaveformKeepsWhatItsDriveStandsAtBefore) {
  SceneFile file = small_file();
  file.set("waveform.main.before=0.5 Vdp");
  file.set_waveform("main", Pulse{.levels = {45}});
  EXPECT_EQ(file.written("waveform.main.before"), "0.5 Vdp");
  EXPECT_EQ(read_scene(file).drives({{"main", {.static_pull_in = 50, .dynamic_pull_in = 40}}}).at("main").before, 20);
}

TEST(SceneFile, ANewWaveformReplacesAllKeysOfTheOldOne) {
  SceneFile file = small_file();
  file.set("waveform.main.level=99 V");
  file.set_waveform("main", Pulse{.levels = {45}});
  EXPECT_EQ(file.json()["waveform"]["main"],
            (nlohmann::json{{"family", "pulse"}, {"levels", {"45 V"}}, {"times", nlohmann::json::array()}, {"edge", "0 s"}}));
  EXPECT_TRUE(file.json()["waveform"].contains("piezo"));
}

TEST(Resolved, WritesEveryDefaultAndVolts) {
  const Scene scene = read_scene(small_file());
  EXPECT_EQ(resolved(scene, {{"main", {.static_pull_in = 50, .dynamic_pull_in = 40}}}).text(), R"(title = "small"

[structure]
kind = "cantilever"
length = "250 um"
width = "20 um"
thickness = "4 um"
youngs_modulus = "78 GPa"
density = "19300 kg/m^3"
modes = 4
damping_ratio = 0.0
plate_strain = false

[gap]
electrode = "3.5 um"
contact = "2 um"

[electrode.main]
span = ["60 um", "240 um"]
side = "near"
fringing = "meijs-fokkema"

[gas]
model = "strip"
viscosity = "1.86e-5 Pa s"
pressure = "101325 Pa"
temperature = "300 K"

[contact]
model = "linear"
pad_length = "5 um"
distribution = "centre"
stiffness = "100 N/m"

[piezo]
span = ["5 um", "240 um"]
thickness = "1 um"
youngs_modulus = "61 GPa"
density = "7750 kg/m^3"
d31 = "-171 pm/V"

[waveform.main]
family = "step"
level = "50 V"
rise_time = "0 s"

[waveform.piezo]
family = "pulse"
levels = ["0.2 V", "0.6 V", "0 V"]
times = ["2e-05 s", "4.1e-05 s"]
edge = "5e-06 s"

[driver.main]
min_voltage = "0 V"
max_voltage = "75 V"

[driver.piezo]
min_voltage = "-1 V"
max_voltage = "1 V"

[simulate]
accuracy = 1e-05
effects = "all"
effects_tolerance = 0.001

[metrics]
significant_rebound = "1 nm"
)");
}

TEST(Resolved, IsTheSameSceneDigitForDigitAndNeedsNoPullIn) {
  SceneFile file = small_file();
  file.set(
      "waveform.main={ family = \"harmonic\", base = \"1.1 Vsp\", amplitude = \"10 %\", frequency = \"30 kHz\", phase = \"33 "
      "deg\" }");
  file.set("waveform.piezo={ family = \"harmonic\", amplitude = \"1 %\", frequency = \"31 kHz\" }");
  const Scene scene = read_scene(file);
  const Scene again = read_scene(SceneFile::parse(resolved(scene, measured_pull_in).text(), "y.toml"));
  EXPECT_THAT(again.need_pull_in, testing::IsEmpty());
  const Drives before = scene.drives(measured_pull_in);
  const Drives after = again.drives({});
  for (const char* drive : {"main", "piezo"}) {
    const auto a = std::get<Harmonic>(before.at(drive).waveform.value());
    const auto b = std::get<Harmonic>(after.at(drive).waveform.value());
    EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0) << drive;
    EXPECT_EQ(before.at(drive).limits.value().max_voltage, after.at(drive).limits.value().max_voltage) << drive;
    EXPECT_EQ(before.at(drive).limits.value().min_voltage, after.at(drive).limits.value().min_voltage) << drive;
  }
  EXPECT_EQ(resolved(again, {}).text(), resolved(scene, measured_pull_in).text());
}

TEST(Resolved, KeepsToleranceWithoutAddingAccuracy) {
  SceneFile file = small_file();
  file.set("simulate.tolerance=1e-8");
  const SceneFile full = resolved(read_scene(file), measured_pull_in);
  EXPECT_EQ(full.json()["simulate"], (nlohmann::json{{"tolerance", 1e-8}, {"effects", "all"}, {"effects_tolerance", 1e-3}}));
}

TEST(Resolved, MessagesDoNotCiteTheLinesOfTheOriginal) {
  SceneFile full = resolved(read_scene(small_file()), measured_pull_in);
  EXPECT_EQ(full.name(), "x.toml (resolved)");
}

// Reading any bytes gives a scene or a message.
TEST(SceneFile, DamagedTextNeverDoesWorseThanAMessage) {
  constexpr int trials = 1000;
  constexpr std::string_view bytes = "\"'[]{}=.,#\n\\ 0e-^/*%\0\xff\x80uVz";
  std::mt19937 random(1);
  int refused = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::string text(small_scene);
    const auto edits = 1 + random() % 4;
    for (unsigned i = 0; i < edits; ++i) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = bytes[random() % bytes.size()];
          break;
        case 1:
          text.insert(at, 1, bytes[random() % bytes.size()]);
          break;
        case 2:
          text.erase(at, 1 + random() % 20);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), random() % 60));
          break;
      }
    }
    try {
      const Scene scene = read_scene(SceneFile::parse(text, "x.toml"));
      EXPECT_EQ(SceneFile::parse(scene.file.text(), "y.toml").text(), scene.file.text());
    } catch (const InvalidInput& error) {
      ++refused;
      EXPECT_THAT(error.what(), testing::StartsWith("x.toml"));
    }
  }
  EXPECT_GT(refused, trials / 2);
}

TEST(SceneFile, DamagedOptionsNeverDoWorseThanAMessage) {
  constexpr std::string_view bytes = "structure.thickness=2 um\"'[]{}.#\n\\\0\xff";
  std::mt19937 random(2);
  for (int trial = 0; trial < 1000; ++trial) {
    std::string option;
    for (auto length = random() % 12; length > 0; --length) option += bytes[random() % bytes.size()];
    option = (random() % 2 != 0 ? "structure.thickness=" : "gap.") + option;
    try {
      SceneFile file = small_file();
      file.set(option);
      EXPECT_EQ(SceneFile::parse(file.text(), "y.toml").json(), file.json()) << option;
      static_cast<void>(read_scene(file));
    } catch (const InvalidInput& error) {
      EXPECT_THAT(std::string(error.what()), testing::Not(testing::HasSubstr("\n")));
    }
  }
}

TEST(SceneFile, DeepNestingOfAnyKindIsRefused) {
  constexpr int deep = 200000;  // far deeper than a recursive destructor can handle
  std::string dotted = "a";
  for (int i = 0; i < deep; ++i) dotted += ".a";
  const std::string arrays(deep, '[');
  std::string tables = "x = ";
  for (int i = 0; i < deep; ++i) tables += "{a = ";
  for (const std::string& text : {"[" + dotted + "]", dotted + " = 1", "x = {" + dotted + " = 1}", "x = '#'\n" + dotted + " = 1",
                                  "x = {y = \"\"\"\n\"\"\"\"\", " + dotted + " = 1}", "x = " + arrays, tables}) {
    EXPECT_THROW(SceneFile::parse(text, "x.toml"), InvalidInput) << text.substr(0, 40);
  }
}

TEST(SceneFile, DotsOutsideKeysAreNoNesting) {
  const std::string dots(100, '.');
  EXPECT_NO_THROW(SceneFile::parse(
      "# a " + dots + "\ntitle = \"" + dots + "\"\nb = '" + dots + "' # " + dots + "\nc = \"\"\"" + dots + "\n" + dots +
          "\"\"\"\nd = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]\n",
      "x.toml"));
}

}  // namespace
}  // namespace softland
