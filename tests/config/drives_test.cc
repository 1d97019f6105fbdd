// Waveforms and limits in volts.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/require.h"
#include "config/scene.h"
#include "tests/config/message.h"
#include "tests/config/small_scene.h"

namespace softland {
namespace {

const std::map<std::string, PullInVoltages> pull_in{{"main", {.static_pull_in = 50, .dynamic_pull_in = 40}}};
const std::string main_waveform = "family = \"step\"\nlevel = \"1.25 Vdp\"\n";
const std::string piezo_waveform =
    "family = \"pulse\"\nlevels = [\"0.2 V\", \"0.6 V\", \"0 V\"]\ntimes = [\"20 us\", \"41 us\"]\nedge = \"5 us\"\n";

Scene with_main(const std::string& waveform) {
  return read_scene(SceneFile::parse(edited(small_scene, main_waveform, waveform), "x.toml"));
}

Scene with_piezo(const std::string& waveform) {
  return read_scene(SceneFile::parse(edited(small_scene, piezo_waveform, waveform), "x.toml"));
}

template <class Family>
Family main_drive(const std::string& waveform) {
  return std::get<Family>(with_main(waveform).drives(pull_in).at("main").waveform.value());
}

TEST(Drives, StepsRiseAsSteeplyAsTheirDriverPermits) {
  const auto rise = [](const std::string& driver) {
    const std::string text = edited(small_scene, "level = \"1.25 Vdp\"", "level = \"50 V\"\nrise_time = \"driver\"") + driver;
    const Scene scene = read_scene(SceneFile::parse(text, "x.toml"));
    const auto of = [](const Drives& d) { return std::get<Step>(d.at("main").waveform.value()).rise_time; };
    EXPECT_EQ(of(read_scene(resolved(scene, pull_in)).drives(pull_in)), of(scene.drives(pull_in)));
    return of(scene.drives(pull_in));
  };
  EXPECT_DOUBLE_EQ(rise("[driver.main]\nmax_slew = \"20 V/us\"\nmax_voltage = \"60 V\"\n"), 2.5e-6);
  EXPECT_EQ(rise(""), 0);
}

TEST(Drives, StandBeforeTheyBegin) {
  const auto drives = [](const std::string& waveform) { return with_main(waveform).drives(pull_in); };
  const std::string step = "family = \"step\"\nlevel = \"45 V\"\n";
  EXPECT_THAT(drives(step).before(), testing::IsEmpty());
  EXPECT_EQ(drives(step + "before = \"-3 V\"\n[driver.main]\nmin_voltage = \"-5 V\"\n").at("main").before, -3);
  EXPECT_EQ(drives(step + "before = \"0.5 Vsp\"\n").at("main").before, 25);
  const auto said = [](const std::string& from, const std::string& to) { return message(edited(small_scene, from, to)); };
  EXPECT_EQ(said(main_waveform, step + "before = \"80 V\"\n"),
            "x.toml:27: [waveform.main]: the voltage reaches 80 V, above the driver's max_voltage of 75 V; "
            "without [driver.main] "
            "the limits are 0 V and 1.5 Vsp");
  EXPECT_EQ(said(main_waveform, step + "before = \"3 m\"\n"),
            "x.toml:30: waveform.main.before = \"3 m\": expected a voltage [V], got a length [m]");
  EXPECT_EQ(said(piezo_waveform, "family = \"step\"\nlevel = \"1 V\"\nbefore = \"1 Vdp\"\n"),
            "x.toml:33: waveform.piezo.before = \"1 Vdp\": pull-in voltages belong to electrodes; give the piezo volts [V]");
}

TEST(Drives, StepInVoltsAndInPullInVoltages) {
  EXPECT_EQ(main_drive<Step>("family = \"step\"\nlevel = \"45 V\"\n").level, 45);
  EXPECT_EQ(main_drive<Step>("family = \"step\"\nlevel = \"1.25 Vdp\"\n").level, 1.25 * 40);
  EXPECT_EQ(main_drive<Step>("family = \"step\"\nlevel = \"1.1 Vsp\"\n").level, 1.1 * 50);
  EXPECT_EQ(main_drive<Step>("family = \"step\"\nlevel = \"45 V\"\n").rise_time, 0);
  EXPECT_EQ(main_drive<Step>("family = \"step\"\nlevel = \"45 V\"\nrise_time = \"2 us\"\n").rise_time, 2e-6);
}

TEST(Drives, HarmonicTakesEitherFrequency) {
  const std::string base = "family = \"harmonic\"\nbase = \"1 Vdp\"\namplitude = \"15 %\"\n";
  const auto angular = main_drive<Harmonic>(base + "angular_frequency = \"180543 rad/s\"\n");
  EXPECT_EQ(angular.base, 40);
  EXPECT_EQ(angular.amplitude, 0.15 * 40);
  EXPECT_EQ(angular.angular_frequency, 180543);
  EXPECT_EQ(angular.phase, 0);
  EXPECT_EQ(angular.start, 0);
  EXPECT_TRUE(std::isinf(angular.end));
  EXPECT_EQ(angular.fade, 0);
  const auto cyclic = main_drive<Harmonic>(base +
                                           "frequency = \"30 kHz\"\nphase = \"90 deg\"\nstart = \"1 us\"\nend = \"9 us\"\n"
                                           "fade = \"2 us\"\n");
  EXPECT_EQ(cyclic.angular_frequency, 2 * std::numbers::pi * 30e3);
  EXPECT_DOUBLE_EQ(cyclic.phase, std::numbers::pi / 2);
  EXPECT_EQ(cyclic.start, 1e-6);
  EXPECT_EQ(cyclic.end, 9e-6);
  EXPECT_EQ(cyclic.fade, 2e-6);
}

TEST(Drives, CurvesInVoltsAndInPullInVoltages) {
  const auto curve =
      main_drive<SCurve>("family = \"s-curve\"\nlevels = [\"1 Vdp\", \"20 V\"]\ntimes = [\"9 us\"]\nedge = \"3 us\"\n");
  EXPECT_EQ(curve.levels, (std::vector<double>{40, 20}));
  EXPECT_EQ(curve.edge, 3e-6);
  const std::string dither = "family = \"chirp\"\nbase = \"1 Vdp\"\namplitude = \"15 %\"\nfrequency = \"30 kHz\"\n";
  const auto chirp = main_drive<Chirp>(dither + "frequency_ratio = 2.0\nend = \"90 us\"\n");
  EXPECT_EQ(chirp.amplitude, 0.15 * 40);
  EXPECT_EQ(chirp.angular_frequency, 2 * std::numbers::pi * 30e3);
  EXPECT_EQ(chirp.frequency_ratio, 2);
  EXPECT_TRUE(std::isinf(chirp.decay_time));
  EXPECT_EQ(main_drive<Chirp>(dither + "decay_time = \"9 us\"\n").decay_time, 9e-6);
  EXPECT_EQ(main_drive<Chirp>(dither + "decay_time = \"9 us\"\n").frequency_ratio, 1);
  const auto spline =
      main_drive<BSpline>("family = \"bspline\"\nlevels = [\"0 V\", \"1 Vdp\", \"0.5 Vsp\", \"20 V\"]\nduration = \"50 us\"\n");
  EXPECT_EQ(spline.levels, (std::vector<double>{0, 40, 25, 20}));
  const auto sines = main_drive<Sines>(
      "family = \"sines\"\nbase = \"1 Vdp\"\namplitudes = [\"-10 %\", \"3 V\", \"0.1 Vsp\"]\nduration = \"50 us\"\n");
  EXPECT_THAT(sines.amplitudes, testing::ElementsAre(-4, 3, 5));
}

TEST(Drives, SourcesAreReadAndWrittenBack) {
  const auto with_driver = [](const std::string& keys) {
    return read_scene(SceneFile::parse(std::string(small_scene) + "[driver.main]\nmax_voltage = \"60 V\"\n" + keys, "x.toml"));
  };
  EXPECT_TRUE(with_driver("").drives(pull_in).at("main").source.is_ideal());
  const Scene scene = with_driver(
      "sample_rate = \"5 MHz\"\nbits = 10\nbandwidth = \"2 MHz\"\n"
      "source_resistance = \"1 Mohm\"\nparallel_capacitance = \"3 pF\"\n");
  for (const Scene& one : {scene, read_scene(resolved(scene, pull_in))}) {
    const Drives drives = one.drives(pull_in);
    const DriverModel& model = drives.at("main").source;
    EXPECT_EQ(model.sample_rate, 5e6);
    EXPECT_EQ(model.bits, 10);
    EXPECT_EQ(model.bandwidth, 2e6);
    EXPECT_EQ(model.source_resistance, 1e6);
    EXPECT_EQ(model.parallel_capacitance, 3e-12);
    EXPECT_TRUE(drives.at("piezo").source.is_ideal());
  }
  EXPECT_EQ(resolved(scene, pull_in).json()["driver"]["main"]["bits"], 10);
}

TEST(Drives, ErrorsOfSourcesAreReadAndWrittenBack) {
  const auto with_driver = [](const std::string& keys) {
    return read_scene(SceneFile::parse(std::string(small_scene) + "[driver.main]\nmax_voltage = \"60 V\"\n" + keys, "x.toml"));
  };
  EXPECT_TRUE(with_driver("").drives(pull_in).at("main").errors.are_none());
  EXPECT_TRUE(with_driver("gain = 1\noffset = \"0 V\"\ndelay = \"0 s\"\n").drives(pull_in).at("main").errors.are_none());
  const Scene scene = with_driver("gain = 1.02\noffset = \"-20 mV\"\ndelay = \"50 ns\"\n");
  for (const Scene& one : {scene, read_scene(resolved(scene, pull_in))}) {
    const SourceErrors errors = one.drives(pull_in).at("main").errors;
    EXPECT_EQ(errors.gain, 1.02);
    EXPECT_EQ(errors.offset, -0.02);
    EXPECT_EQ(errors.delay, 50e-9);
  }
  EXPECT_EQ(resolved(with_driver(""), pull_in).json()["driver"]["main"].size(), 2U) << "nothing more than limits";
  // Limits apply to the commanded voltage of 50 V, not to the amplified one, which is above 60 V.
  EXPECT_NO_THROW(static_cast<void>(with_driver("gain = 1.3\n").drives(pull_in)));
  const auto said = [](const std::string& keys) {
    return message(std::string(small_scene) + "[driver.main]\nmax_voltage = \"60 V\"\n" + keys);
  };
  EXPECT_THAT(said("gain = 0\n"), testing::StartsWith("x.toml:42: driver.main.gain = 0: must be "));
  EXPECT_THAT(said("delay = \"-1 us\"\n"), testing::StartsWith("x.toml:42: driver.main.delay = \"-1 us\": must be "));
  EXPECT_THAT(said("offset = \"0.1 Vdp\"\n"),
              testing::StartsWith("x.toml:42: driver.main.offset = \"0.1 Vdp\": expected a voltage"));
}

TEST(Drives, AnAmplifierIsNoGain) {
  const auto text = [](const std::string& keys) {
    return std::string(small_scene) + "[driver.main]\nmax_voltage = \"60 V\"\n" + keys;
  };
  EXPECT_FALSE(read_scene(SceneFile::parse(text(""), "x.toml")).drives(pull_in).at("main").amplifier);
  const Scene scene = read_scene(SceneFile::parse(text("amplifier = 20\n"), "x.toml"));
  for (const Scene& one : {scene, read_scene(resolved(scene, pull_in))}) {
    const Drives drives = one.drives(pull_in);
    EXPECT_EQ(drives.at("main").amplifier, 20);
    EXPECT_EQ(drives.at("main").limits->max_voltage, 60) << "at the switch";
    EXPECT_TRUE(drives.at("main").errors.are_none());
  }
  for (const double gain : {0.5, 2.0}) EXPECT_EQ(message(text(fmt::format("gain = {}\n", gain))), "");
  for (const double gain : {0.499, 2.001, 20.0, 0.05}) {
    EXPECT_THAT(message(text(fmt::format("gain = {}\n", gain))),
                testing::AllOf(testing::HasSubstr("x.toml:42: driver.main.gain"), testing::HasSubstr("must be in [0.5, 2]"),
                               testing::HasSubstr("key amplifier")));
    // The message is the same for a spread of this key.
    const std::string spread =
        fmt::format("[spread]\n\"driver.main.gain\" = {{ distribution = \"empirical\", values = [\"{} %\", \"{} %\"] }}\n",
                    99 * gain, 101 * gain);
    EXPECT_THAT(message(text(spread)),
                testing::AllOf(testing::HasSubstr("the median of driver.main.gain"), testing::HasSubstr("key amplifier")));
  }
  EXPECT_THAT(message(text("amplifier = 0\n")), testing::StartsWith("x.toml:42: driver.main.amplifier = 0: must be "));
  EXPECT_THAT(message(text("amplifier = \"20 V\"\n")), testing::StartsWith("x.toml:42: driver.main.amplifier"));
}

TEST(Drives, SourcesThatMakeNoSenseAreRefused) {
  const auto message = [](const std::string& drive, const std::string& keys) -> std::string {
    try {
      const std::string text = drive == "piezo" ? edited(small_scene, "[driver.piezo]\n", "[driver.piezo]\n" + keys)
                                                : std::string(small_scene) + "[driver.main]\n" + keys;
      static_cast<void>(read_scene(SceneFile::parse(text, "x.toml")));
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message("main", "max_voltage = \"60 V\"\nbits = 10\n"),
            "x.toml:42: driver.main.bits = 10: needs sample_rate, because samples are rounded");
  EXPECT_EQ(message("main", "sample_rate = \"1 MHz\"\nbits = 10\n"),
            "x.toml:42: driver.main.bits = 10: needs max_voltage: it divides the voltages from min_voltage to max_voltage");
  EXPECT_EQ(message("piezo", "source_resistance = \"1 kohm\"\n"),
            "x.toml:36: driver.piezo.source_resistance = \"1 kohm\": must not be given for a piezo layer: "
            "it is the resistance that charges an electrode");
  EXPECT_EQ(message("main", "parallel_capacitance = \"1 pF\"\n"),
            "x.toml:41: driver.main.parallel_capacitance = \"1 pF\": needs source_resistance, "
            "through which this capacitance is charged");
  EXPECT_EQ(message("main", "parallel_capacitance = \"0 F\"\n"), "");
  EXPECT_EQ(message("main", "sample_rate = \"1 MHz\"\n"), "");
  EXPECT_THAT(message("main", "max_voltage = \"60 V\"\nbits = 25\n"), testing::HasSubstr("must be in [1, 24]"));
  EXPECT_THAT(message("main", "sample_rate = \"1 us\"\n"), testing::HasSubstr("frequency"));
}

TEST(Drives, APercentageForThePiezoIsOfTheMainHoldLevel) {
  const Scene scene = with_piezo("family = \"harmonic\"\namplitude = \"1 %\"\nfrequency = \"30 kHz\"\n");
  const auto harmonic = std::get<Harmonic>(scene.drives(pull_in).at("piezo").waveform.value());
  EXPECT_EQ(harmonic.base, 0);
  EXPECT_EQ(harmonic.amplitude, 0.01 * 1.25 * 40);
}

TEST(Drives, APercentageForThePiezoNeedsAMainElectrode) {
  const std::string text =
      edited(edited(small_scene, piezo_waveform, "family = \"harmonic\"\namplitude = \"1 %\"\nfrequency = \"30 kHz\"\n"),
             "[waveform.main]\n" + main_waveform, "");
  const auto message = [](const std::string& scene) -> std::string {
    try {
      static_cast<void>(read_scene(SceneFile::parse(scene, "x.toml")));
      return {};
    } catch (const InvalidInput& error) {
      return error.what();
    }
  };
  EXPECT_EQ(
      message(text),
      "x.toml:29: waveform.piezo.amplitude = \"1 %\": is a percentage of the hold voltage of the main electrode, which is 0 V: "
      "give volts");
  const std::string two = edited(text, "[electrode.main]", "[electrode.left]\nspan = [\"0 m\", \"50 um\"]\n[electrode.right]");
  EXPECT_EQ(message(two),
            "x.toml:31: waveform.piezo.amplitude = \"1 %\": is a percentage of the hold voltage of the main electrode, "
            "but no electrode is called 'main' and there are several: give volts");
}

TEST(Drives, PulseLevelsMayMixVoltsAndPullInVoltages) {
  const auto pulse = main_drive<Pulse>(
      "family = \"pulse\"\nlevels = [\"50 V\", \"0.5 Vdp\", \"1.1 Vsp\"]\ntimes = [\"10 us\", \"20 us\"]\nedge = \"1 us\"\n");
  EXPECT_THAT(pulse.levels, testing::ElementsAre(50, 0.5 * 40, 1.1 * 50));
  EXPECT_THAT(pulse.times, testing::ElementsAre(10e-6, 20e-6));
  EXPECT_EQ(pulse.edge, 1e-6);
  EXPECT_THAT(main_drive<Pulse>("family = \"pulse\"\nlevels = [\"50 V\"]\n").times, testing::IsEmpty());
}

TEST(Drives, ATableStandsInTheSceneOrInAFileBesideIt) {
  const auto inline_table =
      main_drive<Table>("family = \"table\"\ntimes = [\"0 s\", \"10 us\"]\nvoltages = [\"0 V\", \"1 Vdp\"]\n");
  EXPECT_THAT(inline_table.time, testing::ElementsAre(0, 10e-6));
  EXPECT_THAT(inline_table.voltage, testing::ElementsAre(0, 40));

  const std::filesystem::path directory = std::filesystem::path(testing::TempDir()) / "softland tables";
  std::filesystem::create_directories(directory);
  std::ofstream(directory / "drive.csv") << "time_s,main\n0,0\n1e-05,40\n";
  std::ofstream(directory / "scene.toml") << edited(small_scene, main_waveform, "family = \"table\"\nfile = \"drive.csv\"\n");
  const Scene scene = read_scene(SceneFile::load(directory / "scene.toml"));
  const auto file_table = std::get<Table>(scene.drives(pull_in).at("main").waveform.value());
  EXPECT_EQ(file_table.time, inline_table.time);
  EXPECT_EQ(file_table.voltage, inline_table.voltage);
  // The resolved scene does not need the file.
  std::filesystem::remove(directory / "drive.csv");
  const Scene again =
      read_scene(SceneFile::parse(resolved(with_main("family = \"table\"\ntimes = [\"0 s\", \"10 us\"]\nvoltages = [\"0 V\", "
                                                     "\"1 Vdp\"]\n"),
                                           pull_in)
                                      .text(),
                                  "y.toml"));
  EXPECT_EQ(std::get<Table>(again.drives(pull_in).at("main").waveform.value()).voltage, inline_table.voltage);
}

TEST(Drives, WhatIsNotDrivenHasNoWaveform) {
  const Scene scene = read_scene(SceneFile::parse(edited(small_scene, "[waveform.main]\n" + main_waveform, ""), "x.toml"));
  EXPECT_THAT(scene.drives({}).waveforms(), testing::SizeIs(1));
  EXPECT_THAT(scene.need_pull_in, testing::IsEmpty());
}

TEST(Drives, AnElectrodeIsLimitedByDefaultWhereItsPullInIsKnown) {
  const Scene scene = with_main("family = \"step\"\nlevel = \"45 V\"\n");
  EXPECT_THAT(scene.need_pull_in, testing::IsEmpty());
  EXPECT_FALSE(scene.drives({}).at("main").limits);
  const DriverLimits limits = scene.drives(pull_in).at("main").limits.value();
  EXPECT_EQ(limits.min_voltage, 0);
  EXPECT_EQ(limits.max_voltage, 1.5 * 50) << "of the larger of Vsp and Vdp";
  EXPECT_TRUE(std::isinf(limits.max_slew));
  // Vdp is the larger one if a step from rest needs more than the static voltage.
  const std::map<std::string, PullInVoltages> slow{{"main", {.static_pull_in = 30, .dynamic_pull_in = 40}}};
  EXPECT_EQ(scene.drives(slow).at("main").limits.value().max_voltage, 1.5 * 40);
  const Scene above = with_main("family = \"step\"\nlevel = \"1.2 Vsp\"\n");
  EXPECT_NO_THROW(static_cast<void>(above.drives({{"main", {.static_pull_in = 60, .dynamic_pull_in = 40}}})));
}

TEST(Drives, WrittenLimitsReplaceTheDefaultsOneByOne) {
  SceneFile file = SceneFile::parse(small_scene, "x.toml");
  file.set("driver.main.min_voltage=-0.1 Vsp");
  file.set("driver.main.max_slew=60 V/us");
  file.set("waveform.main.rise_time=1 us");
  const DriverLimits limits = read_scene(file).drives(pull_in).at("main").limits.value();
  EXPECT_EQ(limits.min_voltage, -0.1 * 50);
  EXPECT_EQ(limits.max_voltage, 1.5 * 50) << "of the larger of Vsp and Vdp";
  EXPECT_EQ(limits.max_slew, 60e6);
}

TEST(Drives, ThePiezoHasNoDefaultLimits) {
  const Scene scene = read_scene(
      SceneFile::parse(edited(small_scene, "[driver.piezo]\nmin_voltage = \"-1 V\"\nmax_voltage = \"1 V\"\n", ""), "x.toml"));
  EXPECT_FALSE(scene.drives(pull_in).at("piezo").limits);
}

TEST(Drives, PullInIsNeededForWrittenLimitsToo) {
  SceneFile file = SceneFile::parse(edited(small_scene, main_waveform, "family = \"step\"\nlevel = \"45 V\"\n"), "x.toml");
  EXPECT_THAT(read_scene(file).need_pull_in, testing::IsEmpty());
  file.set("driver.main.max_voltage=1.2 Vdp");
  EXPECT_THAT(read_scene(file).need_pull_in, testing::ElementsAre("main"));
}

TEST(Drives, AMissingOrMeaninglessPullInVoltageIsRefused) {
  const Scene scene = read_scene(SceneFile::parse(small_scene, "x.toml"));
  const auto message = [&](const std::map<std::string, PullInVoltages>& voltages) -> std::string {
    try {
      static_cast<void>(scene.drives(voltages));
      return {};
    } catch (const InvalidInput& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message({}), "x.toml: the pull-in voltages of electrode 'main' are needed");
  EXPECT_EQ(message({{"main", {50, std::nan("")}}}),
            "x.toml: electrode 'main' has no pull-in voltage (static 50 V, dynamic nan V) to multiply");
}

TEST(Drives, WrittenLimitsAreOrderedOnceVoltsAreKnown) {
  SceneFile file = SceneFile::parse(small_scene, "x.toml");
  file.set("driver.main.min_voltage=45 V");
  file.set("driver.main.max_voltage=1 Vdp");
  const Scene scene = read_scene(file);
  try {
    static_cast<void>(scene.drives(pull_in));
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "--set driver.main.min_voltage=45 V: min_voltage of 45 V must be less than max_voltage of 40 V");
  }
}

TEST(Drives, LevelsOfTheDispersionForceAreFactorsAndRestIsOne) {
  const std::string section = "[dispersion]\nmodel = \"casimir\"\n[waveform.dispersion]\n";
  const auto waveform = [&](const std::string& keys) {
    const std::string text = edited(small_scene, "[gas]", section + keys + "[gas]");
    return read_scene(SceneFile::parse(text, "x.toml")).drives(pull_in).at("dispersion").waveform.value();
  };
  // The internal value of this drive is the factor less one.
  EXPECT_EQ(std::get<Step>(waveform("family = \"step\"\nlevel = 1.25\n")).level, 0.25);
  EXPECT_EQ(std::get<Step>(waveform("family = \"step\"\nlevel = \"125 %\"\n")).level, 0.25);
  const auto pulse = std::get<Pulse>(waveform("family = \"pulse\"\nlevels = [1.5, 0.75]\ntimes = [\"1 us\"]\n"));
  EXPECT_THAT(pulse.levels, testing::ElementsAre(0.5, -0.25));
  const auto table = std::get<Table>(waveform("family = \"table\"\ntimes = [\"0 s\", \"1 us\"]\nvoltages = [1, 2]\n"));
  EXPECT_THAT(table.voltage, testing::ElementsAre(0, 1));
  const auto harmonic = std::get<Harmonic>(waveform("family = \"harmonic\"\namplitude = 0.1\nfrequency = \"1 MHz\"\n"));
  EXPECT_EQ(harmonic.base, 0);
  EXPECT_EQ(harmonic.amplitude, 0.1);
}

TEST(Drives, OfTheDispersionForceAreWrittenAsTheyWereRead) {
  SceneFile file = SceneFile::parse(edited(small_scene, "[gas]", "[dispersion]\nmodel = \"casimir\"\n[gas]"), "x.toml");
  const auto same = [&](const Waveform& given) {
    file.set_waveform("dispersion", given);
    const SceneFile again = SceneFile::parse(file.text(), "again.toml");
    return signal(read_scene(again).drives(pull_in).at("dispersion").waveform.value()).pieces() == signal(given).pieces();
  };
  EXPECT_TRUE(same(Step{.level = 0.25, .rise_time = 1e-6}));
  EXPECT_TRUE(same(Pulse{.levels = {0.5, -0.25}, .times = {1e-6}, .edge = 1e-7}));
  EXPECT_TRUE(same(Table{.time = {0, 1e-6}, .voltage = {0, 0.5}}));
  EXPECT_TRUE(same(Harmonic{.base = 0.25, .amplitude = 0.5, .angular_frequency = 1e6, .end = 2e-5}));
}

}  // namespace
}  // namespace softland
