// Errors of the drives of single devices.
#include "studies/devices/device_drives.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/closing.h"
#include "sampling/statistics.h"
#include "scenes.h"
#include "studies/devices/robustness.h"
#include "studies/search/robust_cost.h"

namespace softland::device_drives_test {
namespace {

const std::string throw_and_catch =
    "waveform.main={family=\"pulse\", levels=[\"20 V\", \"5 V\", \"17 V\"], times=[\"22 us\", \"30 us\"], edge=\"1 us\"}";

std::string spread(const std::string& key, const std::string& distribution) {
  return fmt::format("spread={{\"driver.main.{}\"={{distribution={}}}}}", key, distribution);
}
std::string normal(const std::string& key, const std::string& deviation) {
  return spread(key, fmt::format("\"normal\", standard_deviation=\"{}\"", deviation));
}

bool same(const DeviceOutcome& a, const Metrics& b) {
  return a.closed() && a.metrics.initial_contact_time == b.initial_contact_time &&
         a.metrics.major_bounce_height == b.major_bounce_height && a.metrics.impact_velocity == b.impact_velocity;
}

// Returns the figures of a scene as `simulate` finds them, in the window and with the tolerance of an ensemble.
Metrics alone(const SceneFile& file) {
  const PreparedScene own = prepare(SceneFile::parse(file.text(), "alone.toml"));
  return metrics(simulate_closing(own.model, own.signals(), {.duration = own.duration, .tolerance = EnsembleRun{}.tolerance}),
                 own.scene.metrics);
}

std::vector<DeviceOutcome> closings(const PreparedScene& nominal, const Ensemble& ensemble, int jobs = 1) {
  // One closing at a time gives bit for bit the result of simulate_closing().
  return close_all(ensemble, {{.waveforms = nominal.waveforms()}},
                   {.duration = nominal.duration, .jobs = jobs, .vectors = Vectors::none})[0];
}

constexpr double figures_of_bits = 1e-9;  // relative change of the figures of a closing by another beginning of the clock

TEST(DeviceDrives, AGainMultipliesTheLevels) {
  const PreparedScene nominal = prepare(gold_at_17_volts({throw_and_catch, normal("gain", "2 %")}));
  const Ensemble ensemble(nominal, 4);
  const std::vector<DeviceOutcome> found = closings(nominal, ensemble);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double gain = ensemble.values(k)[0];
    SceneFile file = gold_at_17_volts({throw_and_catch});
    file.set_waveform("main", Pulse{.levels = {gain * 20, gain * 5, gain * 17}, .times = {22e-6, 30e-6}, .edge = 1e-6});
    EXPECT_TRUE(same(found[k], alone(file))) << k;
  }
  EXPECT_NE(found[0].metrics.initial_contact_time, found[1].metrics.initial_contact_time);
}

// Devices whose sources differ only by a gain share the sampled and filtered signal.
TEST(DeviceDrives, ThatDifferByAGainAreFactorsOfOneSignal) {
  constexpr double rounding = 1e-12;  // error over the largest voltage
  for (const char* source : {"driver.main={max_voltage=\"25 V\", sample_rate=\"5 MHz\", bits=12, bandwidth=\"1 MHz\"}",
                             "driver.main={max_voltage=\"25 V\", bandwidth=\"300 kHz\", delay=\"1 us\"}"}) {
    SCOPED_TRACE(source);
    const PreparedScene nominal = prepare(gold_at_17_volts({throw_and_catch, source, normal("gain", "2 %")}));
    const DeviceDrives drives(nominal);
    const Ensemble ensemble(nominal, 4);
    const std::vector<Signal> one = drives.without_gains(nominal.waveforms());
    for (std::uint64_t k = 0; k < ensemble.size(); ++k) {
      const std::optional<std::vector<double>> gains = drives.gains({}, ensemble.values(k));
      ASSERT_TRUE(gains);
      const std::vector<Signal> own = drives.signals(nominal.waveforms(), {}, ensemble.values(k));
      for (double t = 0; t < 60e-6; t += 0.37e-6)
        EXPECT_NEAR((*gains)[0] * one[0].voltage(t), own[0].voltage(t), rounding * 25) << k << " " << t;
    }
    EXPECT_FALSE(drives.gains({.volts = 1.01}, ensemble.values(0))) << "samples of other volts round otherwise";
    EXPECT_FALSE(drives.gains({.time = 1.01}, ensemble.values(0)));
  }
  for (const std::string& other : {normal("delay", "200 ns"), normal("offset", "0.1 V"), normal("jitter", "50 ns")}) {
    const PreparedScene nominal = prepare(gold_at_17_volts({throw_and_catch, other}));
    const Ensemble ensemble(nominal, 1);
    EXPECT_FALSE(DeviceDrives(nominal).gains({}, ensemble.values(0))) << other;
  }
}

TEST(DeviceDrives, ADelayMovesTheClosingAndNothingElse) {
  const PreparedScene nominal = prepare(gold_at_17_volts({throw_and_catch, normal("delay", "200 ns")}));
  const Ensemble ensemble(nominal, 8);
  const std::vector<DeviceOutcome> found = closings(nominal, ensemble);
  const Metrics in_time = alone(gold_at_17_volts({throw_and_catch}));
  int early = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    // The clock of a device with a single early drive begins with that drive.
    const double delay = ensemble.values(k)[0], late = std::max(0.0, delay);
    early += delay < 0;
    ASSERT_TRUE(found[k].closed());
    EXPECT_NEAR(found[k].metrics.initial_contact_time - late, in_time.initial_contact_time,
                figures_of_bits * in_time.initial_contact_time);
    EXPECT_NEAR(found[k].metrics.impact_velocity, in_time.impact_velocity, 1e-4 * in_time.impact_velocity);
    EXPECT_TRUE(delay >= 0 || same(found[k], in_time)) << "to the bit";
  }
  EXPECT_EQ(early, 4);
}

TEST(DeviceDrives, OfOneDeviceHaveOneClock) {
  const PreparedScene nominal =
      prepare(gold_pzt({"waveform.piezo={family=\"pulse\", levels=[\"0.5 V\", \"0 V\"], times=[\"9 us\"]}",
                        "spread={\"driver.piezo.delay\"={distribution=\"empirical\", values=[\"-40 ns\", "
                        "\"-40 ns\"]}, \"driver.piezo.gain\"={distribution=\"normal\", cov=\"1 %\"}}"}));
  const DeviceDrives drives(nominal);
  const std::vector<Waveform> waveforms = nominal.waveforms();
  const std::vector<Signal> own = drives.signals(waveforms, {}, {-40e-9, 1.02});
  ASSERT_EQ(own.size(), 2U);
  EXPECT_EQ(own[1].pieces()[0].begin, 0);
  EXPECT_EQ(own[1].voltage(0), 0.5 * 1.02) << "the early drive begins the run";
  EXPECT_EQ(own[1].pieces()[1].begin, 9e-6);
  EXPECT_EQ(own[0].voltage(39e-9), 0) << "the other one is late by as much";
  EXPECT_EQ(own[0].pieces()[1].begin, 40e-9);
  EXPECT_EQ(own[0].hold_level(), signal(waveforms[0]).hold_level());
  EXPECT_FALSE(drives.has_errors(0));
  EXPECT_TRUE(drives.has_errors(1));
}

TEST(DeviceDrives, GiveAPiezoVoltsOfItsOwnUnit) {
  const PreparedScene nominal =
      prepare(gold_pzt({"waveform.piezo={family=\"pulse\", levels=[\"0.5 V\", \"0 V\"], times=[\"9 us\"]}"}));
  const std::vector<Waveform> waveforms = nominal.waveforms();
  const DeviceUnits units{.volts = 1.1, .time = 0.9, .piezo = 0.8};
  const std::vector<Waveform> own = in_units(waveforms, nominal.scene.device, units);
  ASSERT_EQ(own.size(), 2U);
  EXPECT_EQ(signal(own[0]).hold_level(), 1.1 * signal(waveforms[0]).hold_level());
  EXPECT_EQ(signal(own[1]).voltage(1e-6), 0.8 * 0.5);
  EXPECT_EQ(signal(own[1]).pieces().back().begin, 0.9 * 9e-6);
  EXPECT_TRUE(DeviceDrives(nominal).differ({.piezo = 0.8}));
  EXPECT_FALSE(DeviceDrives(nominal).differ({}));
}

TEST(DeviceDrives, JitterOfEdgesIsAsWideAsItIsSaid) {
  const PreparedScene nominal = prepare(gold_at_17_volts({throw_and_catch, normal("jitter", "50 ns")}));
  const Ensemble ensemble(nominal, 4096);
  const DeviceDrives drives(nominal);
  const std::vector<Waveform> waveforms{nominal.drives.at("main").waveform.value()};
  std::vector<double> throwing, catching;
  for (std::size_t k = 0; k < ensemble.size(); ++k) {
    const Signal own = drives.signals(waveforms, {}, ensemble.values(k)).front();
    // Beginnings of the edges to 20, 5 and 17 V; each ramp moves as a whole.
    std::vector<double> begins;
    for (const SignalPiece& piece : own.pieces()) {
      if (piece.slope != 0) begins.push_back(piece.begin);
    }
    ASSERT_EQ(begins.size(), 3U);
    throwing.push_back(begins[1] - begins[0] - 22e-6);
    catching.push_back(begins[2] - begins[1] - 8e-6);
  }
  // Differences of two independent times have sqrt(2) times their deviation; two differences with a common time have a
  // correlation of -1/2.
  const double expected = std::sqrt(2.0) * 50e-9, count = static_cast<double>(throwing.size());
  EXPECT_NEAR(sample_standard_deviation(throwing), expected, 4 * expected / std::sqrt(2 * count));
  EXPECT_NEAR(sample_standard_deviation(catching), expected, 4 * expected / std::sqrt(2 * count));
  EXPECT_NEAR(sample_mean(throwing), 0, 4 * expected / std::sqrt(count));
  double product = 0;
  for (std::size_t k = 0; k < throwing.size(); ++k) product += throwing[k] * catching[k] / count;
  EXPECT_NEAR(product / (expected * expected), -0.5, 4 / std::sqrt(count));
}

TEST(DeviceDrives, JitterOnTheirOwnWhereTheyShareAnEntry) {
  const PreparedScene nominal =
      prepare(gold_pzt({"spread={edges={keys=[\"driver.main.jitter\", \"driver.piezo.jitter\"], "
                        "distribution=\"uniform\", half_width=\"50 ns\"}}"}));
  const std::vector<Signal> own =
      DeviceDrives(nominal).signals({Step{.level = 1}, Step{.level = 1}}, {}, Ensemble(nominal, 1).values(0));
  EXPECT_NE(own[0].pieces().back().begin, own[1].pieces().back().begin);
}

TEST(DeviceDrives, AreThoseOfTheNominalDeviceWithoutErrors) {
  const PreparedScene nominal = prepare(gold_at_17_volts({throw_and_catch}));
  const DeviceDrives drives(nominal);
  EXPECT_FALSE(drives.differ({}));
  EXPECT_TRUE(drives.differ({.volts = 1.01, .time = 1}));
  EXPECT_TRUE(DeviceDrives(prepare(gold_at_17_volts({throw_and_catch, normal("gain", "1 %")}))).differ({}));
}

TEST(DeviceDrives, DoNotDependOnThreads) {
  const PreparedScene nominal = prepare(gold_at_17_volts(
      {throw_and_catch, "spread.\"driver.main.jitter\"={distribution=\"normal\", standard_deviation=\"50 ns\"}"}));
  const Ensemble ensemble(nominal, 300);
  const std::vector<DeviceOutcome> one = closings(nominal, ensemble, 1), three = closings(nominal, ensemble, 3);
  ASSERT_EQ(one.size(), 300U);
  for (std::size_t k = 0; k < one.size(); ++k) EXPECT_TRUE(same(one[k], three[k].metrics)) << k;
}

// All errors at once on drives of every kind: the scenes of devices give the results of the ensemble.
TEST(DeviceDrives, AreWrittenIntoTheScenesOfDevices) {
  const std::string all =
      "spread={\"driver.main.gain\"={distribution=\"normal\", cov=\"1 %\"}, \"driver.main.offset\"={distribution=\"normal\", "
      "standard_deviation=\"50 mV\"}, \"driver.main.delay\"={distribution=\"normal\", standard_deviation=\"100 ns\"}, "
      "\"driver.main.jitter\"={distribution=\"normal\", standard_deviation=\"50 ns\"}}";
  const std::string limit = "driver.main.max_slew=\"2e8 V/s\"";
  for (const SceneFile& file :
       {gold_at_17_volts({throw_and_catch, all, limit}), gold_at_17_volts({all}),
        gold_at_17_volts({all,
                          "waveform.main={family=\"table\", times=[\"0 s\", \"10 us\", \"20 us\"], voltages=[\"0 V\", \"20 V\", "
                          "\"17 V\"]}"}),
        gold_at_17_volts({throw_and_catch, all, "calibration.frequency.error=\"1 %\""}),
        gold_at_17_volts({normal("gain", "2 %"),
                          "waveform.main={family=\"harmonic\", base=\"17.7 V\", amplitude=\"1 V\", "
                          "angular_frequency=\"180543 rad/s\"}"})}) {
    const PreparedScene nominal = prepare(file);
    const NamedDrive drive{.name = "own", .waveforms = nominal.drives.waveforms(), .calibration = nominal.scene.calibration};
    const RobustnessOptions options{.samples = 12, .vectors = Vectors::none};
    const Robustness found = robustness(nominal, {drive}, options);
    for (const std::size_t k : {std::size_t{3}, found.drives.back().worst[0]}) {
      const SceneFile own = scene_of_device(nominal, found.drives.back(), k, options);
      EXPECT_TRUE(same(found.drives.back().outcomes[k], alone(own))) << own.text();
      EXPECT_EQ(own.text().find("[spread]"), std::string::npos);
    }
  }
}

TEST(DeviceDrives, StayInTheirFamilyWhereItCanExpressThem) {
  const PreparedScene nominal = prepare(gold_at_17_volts({normal("jitter", "50 ns")}));
  const DeviceDrives drives(nominal);
  const Ensemble ensemble(nominal, 16);
  int early = 0;
  for (std::size_t k = 0; k < ensemble.size(); ++k) {
    const std::vector<double> values = ensemble.values(k);
    const Waveform own = drives.written({Step{.level = 17}}, {}, values).front().waveform;
    const bool is_early = drives.shown(values)[0] < 0;  // the clock begins with its single early edge, whose error has no effect
    EXPECT_EQ(family(own), is_early ? "step" : "table") << k;
    early += is_early;
  }
  EXPECT_GT(early, 2);
  EXPECT_LT(early, 14);
}

TEST(DeviceDrives, OfASineAreWrittenAsCloseLines) {
  const PreparedScene nominal = prepare(gold_at_17_volts(
      {normal("delay", "300 ns"),
       "waveform.main={family=\"harmonic\", base=\"17.7 V\", amplitude=\"1 V\", angular_frequency=\"180543 rad/s\"}"}));
  const DeviceDrives drives(nominal);
  const std::vector<Waveform> given{nominal.drives.at("main").waveform.value()};
  const Signal exact = drives.signals(given, {}, {250e-9}).front();
  const Waveform written = drives.written(given, {}, {250e-9}).front().waveform;
  ASSERT_EQ(family(written), "table");
  const Signal lines = signal(written);
  for (double t = 0; t < nominal.duration; t += 0.11e-6)
    EXPECT_NEAR(lines.voltage(t), exact.voltage(t), 1e-4 * exact.peak()) << t;
}

TEST(DeviceDrives, AnOffsetIsThereOnADriveThatIsNotDriven) {
  const PreparedScene nominal =
      prepare(gold_pzt({"waveform.piezo={family=\"step\", level=\"0 V\"}", "simulate.duration=60 us", "simulate.accuracy=1e-4",
                        "spread={\"driver.piezo.offset\"={distribution=\"uniform\", half_width=\"0.3 V\"}}"}));
  const RobustnessOptions options{.samples = 4, .vectors = Vectors::none};
  const double level = nominal.signals()[0].hold_level();
  const NamedDrive electrode_alone{.name = "own", .waveforms = {{"main", Step{.level = level, .rise_time = 1e-6}}}};
  const Robustness found = robustness(nominal, {electrode_alone}, options);
  ASSERT_EQ(found.drives.back().name, "own");
  const Ensemble ensemble(nominal, 4);
  for (std::size_t k = 0; k < 4; ++k) {
    const PreparedScene own =
        prepare(SceneFile::parse(scene_of_device(nominal, found.drives.back(), k, options).text(), "alone.toml"));
    EXPECT_EQ(own.drives.at("piezo").hold_level(), ensemble.values(k)[0]);
    EXPECT_TRUE(same(found.drives.back().outcomes[k], alone(own.scene.file))) << k;
  }
}

TEST(DeviceDrives, OfASearchAreThoseOfTheVerdict) {
  const SceneFile file = gold({"simulate.duration=150 us",
                               "spread={\"driver.main.gain\"={distribution=\"normal\", cov=\"1 %\"}, "
                               "\"driver.main.jitter\"={distribution=\"normal\", standard_deviation=\"50 ns\"}}"});
  const SearchSetting setting = search_setting(file, Target::bounce, Actuator::electrostatic, "pulse", {});
  const RobustAim aim{.measure = parse_robust_measure("worst", device_figures), .conditions = {}};
  const Ensemble ensemble(setting.given, 6, 5);
  const RobustCost cost(setting, aim, build_all(ensemble, {}, 5, 1));
  const std::vector<Waveform> drive = setting.drives({{"main", Pulse{.levels = {20, 5, 17}, .times = {22e-6, 30e-6}}}});
  const std::vector<DeviceOutcome> searched = cost.close(drive, 0, 6, 2);
  const std::vector<DeviceOutcome> judged = close_all(ensemble, {{.waveforms = drive}}, {.duration = setting.given.duration})[0];
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(searched[k].metrics.initial_contact_time, judged[k].metrics.initial_contact_time);
    EXPECT_EQ(searched[k].metrics.impact_velocity, judged[k].metrics.impact_velocity);
  }
  EXPECT_NE(searched[0].metrics.initial_contact_time, searched[1].metrics.initial_contact_time);
}

const std::string gain_key = "driver.main.gain=1.03", offset_key = "driver.main.offset=\"-0.2 V\"",
                  delay_key = "driver.main.delay=\"0.4 us\"";

// The keys of a source amplify, shift and delay a waveform: the closing is the same as with that waveform written out.
TEST(SourceKeys, AreThoseOfTheWaveformThatTheyMake) {
  SceneFile by_hand = gold_at_17_volts({throw_and_catch});
  by_hand.set_waveform("main", Pulse{.levels = {1.03 * 20, 1.03 * 5, 1.03 * 17}, .times = {22e-6, 30e-6}, .edge = 1e-6});
  const Metrics expected = alone(by_hand), own = alone(gold_at_17_volts({throw_and_catch, gain_key}));
  EXPECT_NEAR(own.initial_contact_time, expected.initial_contact_time, figures_of_bits * expected.initial_contact_time);
  EXPECT_NEAR(own.impact_velocity, expected.impact_velocity, 1e-6 * expected.impact_velocity);
  const Metrics in_time = alone(gold_at_17_volts({throw_and_catch})),
                late = alone(gold_at_17_volts({throw_and_catch, delay_key}));
  EXPECT_NEAR(late.initial_contact_time, in_time.initial_contact_time + 0.4e-6, 1e-12);
  EXPECT_NE(alone(gold_at_17_volts({throw_and_catch, offset_key})).initial_contact_time, in_time.initial_contact_time);
}

// A distribution varies the key: a factor multiplies the scene's value, a value replaces it.
TEST(SourceKeys, AreVariedByADistribution) {
  for (const std::string& samples : {std::string(), std::string("driver.main.sample_rate=\"20 MHz\"")}) {
    SCOPED_TRACE(samples);
    const auto scene = [&](const std::vector<std::string>& more) {
      SceneFile file = gold_at_17_volts({throw_and_catch});
      for (const std::string& one : more) file.set(one);
      if (!samples.empty()) file.set(samples);
      return file;
    };
    const PreparedScene nominal = prepare(scene({gain_key, offset_key, delay_key, spread("gain", "\"normal\", cov=\"1 %\"")}));
    const Ensemble ensemble(nominal, 4);
    const std::vector<DeviceOutcome> found = closings(nominal, ensemble);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const double gain = 1.03 * ensemble.values(k)[0];
      const Metrics expected = alone(scene({fmt::format("driver.main.gain={}", gain), offset_key, delay_key}));
      EXPECT_NEAR(found[k].metrics.initial_contact_time, expected.initial_contact_time,
                  figures_of_bits * expected.initial_contact_time);
      EXPECT_NEAR(found[k].metrics.impact_velocity, expected.impact_velocity, 1e-6 * expected.impact_velocity);
    }
    EXPECT_NE(found[0].metrics.initial_contact_time, found[1].metrics.initial_contact_time);
  }
}

TEST(SourceKeys, StandInTheScenesOfDevices) {
  const std::string both =
      "spread={\"driver.main.gain\"={distribution=\"normal\", cov=\"1 %\"}, \"driver.main.jitter\"={distribution=\"normal\", "
      "standard_deviation=\"50 ns\"}}";
  const std::string samples = "driver.main.sample_rate=\"20 MHz\"";
  for (const SceneFile& file :
       {gold_at_17_volts({throw_and_catch, gain_key, offset_key, delay_key}),
        gold_at_17_volts({throw_and_catch, gain_key, offset_key, delay_key, both}),
        gold_at_17_volts({throw_and_catch, gain_key, offset_key, delay_key, both, samples}),
        gold_at_17_volts({throw_and_catch, both, samples}), gold_at_17_volts({throw_and_catch, gain_key, samples})}) {
    SceneFile varied = file;
    if (!varied.written("spread")) varied.set("spread={\"structure.thickness\"={distribution=\"normal\", cov=\"2 %\"}}");
    const PreparedScene nominal = prepare(varied);
    const NamedDrive drive{.name = "own", .waveforms = nominal.drives.waveforms()};
    const RobustnessOptions options{.samples = 6, .vectors = Vectors::none};
    const Robustness found = robustness(nominal, {drive}, options);
    for (const std::size_t k : {std::size_t{1}, std::size_t{4}}) {
      const SceneFile own = scene_of_device(nominal, found.drives.back(), k, options);
      EXPECT_TRUE(same(found.drives.back().outcomes[k], alone(own))) << own.text();
    }
  }
}

// First contact under a step depends on the error of the voltage, and is late by the delay.
TEST(DeviceDrives, HaveSharesOfTheVariance) {
  const PreparedScene nominal =
      prepare(gold_at_17_volts({"spread={\"driver.main.gain\"={distribution=\"normal\", cov=\"0.03 %\"}, \"driver.main.delay\"="
                                "{distribution=\"uniform\", half_width=\"20 ns\"}, \"driver.main.jitter\"="
                                "{distribution=\"uniform\", half_width=\"20 ns\"}}"}));
  const DriveRobustness step{.name = "step", .waveforms = nominal.drives.waveforms(), .outcomes = {}, .figures = {}};
  const Sensitivity found = sensitivity(nominal, step, 128, {.jobs = 2});
  ASSERT_EQ(found.variables, (std::vector<std::string>{"driver.main.delay", "driver.main.gain", "driver.main.jitter"}));
  ASSERT_TRUE(found.figures[0].estimate.indices);
  const auto& total = found.figures[0].estimate.indices->total;
  EXPECT_NEAR(total[0].value, total[2].value, 0.1) << "of one edge, jitter is a delay";
  EXPECT_GT(total[0].value, 0.02);
  EXPECT_GT(total[1].value, 0.3);
}

}  // namespace
}  // namespace softland::device_drives_test
