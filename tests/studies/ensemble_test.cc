// Devices of a spread, and the results of drives on them.
#include "studies/devices/ensemble.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "model/closing.h"
#include "sampling/statistics.h"
#include "scenes.h"
#include "studies/devices/robustness.h"

namespace softland::ensemble_test {
namespace {

// Returns the closing of a device until its first touch.
Metrics closing(const Switch& model, const std::vector<Signal>& drives) {
  return metrics(simulate_closing(model, drives, {.duration = 120e-6, .tolerance = 1e-7}));
}

TEST(Ensemble, HasTheDevicesThatItsScenesDescribe) {
  const std::vector<SceneFile> scenes{
      gold_at_17_volts({"spread.\"gas.viscosity\"={distribution=\"lognormal\", cov=\"10 %\"}"}),
      gold_at_17_volts({"spread.\"structure.length\"={distribution=\"normal\", cov=\"1 %\"}"}),
      scene("two-electrodes.toml", {"spread={\"structure.area\"={distribution=\"uniform\", half_width=\"0.5 %\"}}"}),
      scene("two-electrodes.toml",
            {"structure.width=\"100 um\"", "spread={\"structure.width\"={distribution=\"normal\", cov=\"3 %\"}}"}),
      gold_pzt({"spread.\"piezo.d31\"={distribution=\"normal\", cov=\"3 %\"}"})};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const PreparedScene nominal = prepare(scenes[i]);
    const Ensemble ensemble(nominal, 8, 3);
    DeviceBuilder builder(ensemble);
    for (std::uint64_t k = 0; k < ensemble.size(); ++k) {
      SCOPED_TRACE(fmt::format("scene {} device {}", i, k));
      const SampledDevice device = builder.device(k);
      ASSERT_TRUE(device.model) << device.refusal;
      const PreparedScene alone = prepare(SceneFile::parse(ensemble.scene(device.values).text(), "alone.toml"));
      EXPECT_TRUE(alone.scene.spread.empty());
      const Switch own(alone.scene.device, nominal.quadrature);
      // For a beam of two sections the modes of a device are found from the nominal ones, and closings agree within their
      // tolerance.
      const bool has_sections = nominal.model.has_piezo();
      const double same = has_sections ? 1e-7 : 0;
      EXPECT_TRUE(
          device.model->basis().angular_frequencies().isApprox(own.basis().angular_frequencies(), has_sections ? 1e-11 : 0));
      const Metrics ours = closing(*device.model, nominal.signals()), theirs = closing(own, alone.signals());
      ASSERT_TRUE(std::isfinite(theirs.initial_contact_time));
      EXPECT_NEAR(ours.initial_contact_time, theirs.initial_contact_time, same * theirs.initial_contact_time);
      EXPECT_NEAR(ours.impact_velocity, theirs.impact_velocity, same * theirs.impact_velocity);
      EXPECT_NE(ours.initial_contact_time, closing(nominal.model, nominal.signals()).initial_contact_time);
    }
  }
}

bool same(const DeviceOutcome& a, const DeviceOutcome& b) {
  return a.metrics.initial_contact_time == b.metrics.initial_contact_time && a.metrics.bounce_count == b.metrics.bounce_count &&
         a.metrics.major_bounce_height == b.metrics.major_bounce_height && a.failure == b.failure;
}

TEST(Ensemble, DoesNotDependOnThreadsOrderOrSize) {
  const PreparedScene nominal = prepare(gold_at_17_volts());
  const std::vector<EnsembleDrive> drives{{.waveforms = {nominal.drives.at("main").waveform.value()}}};
  const EnsembleRun run{.duration = nominal.duration};
  const std::vector<DeviceOutcome> all = close_all(Ensemble(nominal, 600), drives, run)[0];
  EnsembleRun threads = run;
  threads.jobs = 3;
  const std::vector<DeviceOutcome> by_threads = close_all(Ensemble(nominal, 600), drives, threads)[0];
  const std::vector<DeviceOutcome> fewer = close_all(Ensemble(nominal, 70), drives, run)[0];
  ASSERT_EQ(all.size(), 600U);
  ASSERT_EQ(by_threads.size(), 600U);
  EXPECT_TRUE(std::equal(all.begin(), all.end(), by_threads.begin(), same));
  ASSERT_EQ(fewer.size(), 70U);
  EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), all.begin(), same));
  const Ensemble ensemble(nominal, 600);
  DeviceBuilder builder(ensemble), other(ensemble);
  for (const std::uint64_t k : {5U, 2U, 599U}) static_cast<void>(other.device(k));
  EXPECT_EQ(builder.device(7).model->basis().angular_frequencies(), other.device(7).model->basis().angular_frequencies());
  // Another seed gives other devices.
  EXPECT_NE(Ensemble(nominal, 600, 2).values(0), ensemble.values(0));
}

TEST(Ensemble, CountsImpossibleDevicesAsTheWorst) {
  // Electrodes are at 0.5 um to 6.5 um and the contact at 2 um: a quarter cannot be built, and the farthest pull too weakly.
  const PreparedScene nominal =
      prepare(gold_at_17_volts({"spread={\"gap.electrode\"={distribution=\"uniform\", half_width=\"3 um\"}}"}));
  const Robustness found = robustness(nominal, {}, {.samples = 256});
  ASSERT_EQ(found.drives.size(), 1U);
  const DriveRobustness& step = found.drives[0];
  const Ensemble ensemble(nominal, 256);
  std::size_t refused = 0, closed = 0;
  for (std::size_t k = 0; k < 256; ++k) {
    const bool impossible = ensemble.values(k)[0] <= 2e-6;
    refused += impossible;
    closed += step.outcomes[k].closed();
    if (impossible) {
      EXPECT_NE(step.outcomes[k].failure.find("gap.contact"), std::string::npos) << step.outcomes[k].failure;
    }
  }
  EXPECT_EQ(refused, 64U) << "Sobol' points stand in every interval alike";
  EXPECT_EQ(step.closing.devices, closed);
  EXPECT_LT(closed, 256 - refused);
  const FigureStatistics& t_i = step.figures[&Metrics::initial_contact_time];
  EXPECT_TRUE(std::isinf(t_i.quantiles[2].value)) << "the 95 % quantile is that of a device that does not close";
  EXPECT_TRUE(std::isfinite(t_i.quantiles[0].value));
  EXPECT_EQ(t_i.devices, closed);
  EXPECT_FALSE(step.outcomes[step.worst[0]].closed()) << "failures are the worst";
}

TEST(Ensemble, NeedsASpread) {
  const PreparedScene nominal = prepare(without(gold_at_17_volts(), "spread"));
  EXPECT_NE(refusal([&] { static_cast<void>(Ensemble(nominal, 10)); }).find("a [spread] section must say"), std::string::npos);
}

// Returns the pull-in voltage of a device independently of PullInMeter: by bisection for a step that touches.
double pull_in_by_bisection(const Switch& model, double low, double high) {
  while (high - low > 1e-5 * high) {
    const double middle = (low + high) / 2;
    const Trajectory t = simulate_closing(model, std::vector<Signal>{Signal::constant(middle)},
                                          {.duration = 2e-3, .tolerance = 1e-7, .after_contact = 0});
    (t.touches.empty() ? low : high) = middle;
  }
  return high;
}

TEST(Calibration, GivesEveryDeviceTheWaveformInItsOwnUnits) {
  const PreparedScene nominal = prepare(gold_at_17_volts(
      {"waveform.main={family=\"pulse\", levels=[\"20 V\", \"5 V\", \"17 V\"], times=[\"22 us\", \"30 us\"], edge=\"1 us\"}"}));
  const Ensemble ensemble(nominal, 6);
  const Calibration exact{.pull_in_error = 0, .frequency_error = 0};
  const std::vector<Waveform> drive{nominal.drives.at("main").waveform.value()};
  const EnsembleRun run{.duration = nominal.duration};
  const auto outcomes = close_all(ensemble, {{.waveforms = drive}, {.waveforms = drive, .known = exact}}, run);
  const double own = pull_in_by_bisection(nominal.model, 10, 20);
  DeviceBuilder builder(ensemble);
  for (std::uint64_t k = 0; k < ensemble.size(); ++k) {
    const SampledDevice device = builder.device(k);
    const double volts = pull_in_by_bisection(*device.model, 10, 20) / own;
    const double time = nominal.model.basis().angular_frequencies()[0] / device.model->basis().angular_frequencies()[0];
    const DeviceUnits units = PullInMeter(nominal, {.pull_in = true}).exact(*device.model);
    EXPECT_NEAR(units.volts, volts, 3e-5);
    EXPECT_DOUBLE_EQ(units.time, time);
    const Metrics expected = closing(*device.model, {signal(scaled(drive[0], volts, time))});
    const Metrics &calibrated = outcomes[1][k].metrics, &fixed = outcomes[0][k].metrics;
    EXPECT_NEAR(calibrated.initial_contact_time, expected.initial_contact_time, 2e-3 * expected.initial_contact_time);
    EXPECT_GT(std::abs(fixed.initial_contact_time - calibrated.initial_contact_time), 5e-3 * expected.initial_contact_time);
  }
}

TEST(Calibration, ErrsAsMuchAsItsMeasurements) {
  const DeviceUnits exact{.volts = 1.03, .time = 0.98};
  const Calibration errors{.pull_in_error = 0.01, .frequency_error = 0.005};
  double sum = 0, squares = 0, product = 0;
  constexpr int devices = 4000;
  for (std::uint64_t k = 0; k < devices; ++k) {
    const DeviceUnits known = PullInMeter::measured(exact, errors, 3, k);
    const double by_volts = known.volts / exact.volts - 1, by_time = exact.time / known.time - 1;
    sum += by_volts;
    squares += by_volts * by_volts;
    product += by_volts * by_time;
  }
  EXPECT_NEAR(sum / devices, 0, 4 * 0.01 / std::sqrt(devices));
  EXPECT_NEAR(std::sqrt(squares / devices), 0.01, 4 * 0.01 / std::sqrt(2.0 * devices));
  EXPECT_NEAR(product / devices, 0, 4 * 0.01 * 0.005 / std::sqrt(devices)) << "the two measurements err apart";
  // A quantity that is not measured has the value of the nominal device.
  EXPECT_EQ(PullInMeter::measured(exact, {.pull_in_error = 0, .frequency_error = {}}, 1, 5).time, 1);
  EXPECT_EQ(PullInMeter::measured(exact, {.pull_in_error = 0, .frequency_error = {}}, 1, 5).volts, exact.volts);
}

// Returns the first touch under a step of the only electrode.
double touch_under(const Switch& model, double volts) {
  const Trajectory end =
      simulate_closing(model, std::vector<Signal>{Signal::constant(volts)}, {.duration = 1e-3, .tolerance = 1e-9});
  return end.touches.front().begin;
}

TEST(Calibration, TellsTheVoltsByAClosingTime) {
  const PreparedScene nominal = prepare(gold_at_17_volts());
  const PullInMeter meter(nominal, {.closing_time = true});
  const double step = closing_step * meter.pull_in();
  EXPECT_NEAR(meter.closing_time(), touch_under(nominal.model, step), 1e-4 * meter.closing_time());
  EXPECT_NEAR(meter.exact(nominal.model).volts, 1, 1e-4);
  const Ensemble ensemble(nominal, 8);
  DeviceBuilder builder(ensemble);
  for (std::uint64_t k = 0; k < ensemble.size(); ++k) {
    const SampledDevice device = builder.device(k);
    const DeviceUnits units = meter.exact(*device.model);
    // The nominal device touches at the same time under a step that is lower by the factor of the device's voltages.
    const double time = touch_under(*device.model, step);
    EXPECT_NEAR(touch_under(nominal.model, step / units.volts), time, 1e-3 * time) << k;
    const double more = touch_under(nominal.model, step / (1.001 * units.volts));
    EXPECT_NEAR(units.volts_by_time, 0.001 / (more - time), 0.1 * units.volts_by_time) << k;
    EXPECT_EQ(PullInMeter::measured(units, {.time_error = 0}, 1, k).volts, units.volts);
  }
}

TEST(Calibration, ByATimeErrsAsMuchAsTheClock) {
  const DeviceUnits exact{.volts = 1.03, .time = 1, .volts_by_time = 2e4};
  double squares = 0;
  constexpr int devices = 4000;
  for (std::uint64_t k = 0; k < devices; ++k)
    squares += std::pow(PullInMeter::measured(exact, {.time_error = 50e-9}, 3, k).volts / exact.volts - 1, 2);
  EXPECT_NEAR(std::sqrt(squares / devices), 1e-3, 4 * 1e-3 / std::sqrt(2.0 * devices));
}

// The unit of a piezo is the static deflection per volt: here from 1 mV and -1 mV at rest.
TEST(Calibration, OfAPiezoIsByWhatAVoltDeflects) {
  const PreparedScene nominal = prepare(gold_pzt());
  const PullInMeter meter(nominal, {.piezo = true});
  const auto unit_of = [](const Switch& model) {
    const auto deflection = [&](double volts) {
      return model.contact_deflection(model.open_equilibrium(std::vector{0.0, volts})->data());
    };
    return std::abs(deflection(1e-3) - deflection(-1e-3)) / 2e-3 / model.device().gap.contact;
  };
  EXPECT_NEAR(PullInMeter::piezo_unit(nominal.model), unit_of(nominal.model), 1e-9 * unit_of(nominal.model));
  EXPECT_EQ(meter.exact(nominal.model).piezo, 1);
  const Ensemble ensemble(nominal, 4);
  DeviceBuilder builder(ensemble);
  for (std::uint64_t k = 0; k < ensemble.size(); ++k) {
    const SampledDevice device = builder.device(k);
    const double ratio = unit_of(nominal.model) / unit_of(*device.model);
    EXPECT_GT(std::abs(ratio - 1), 1e-3);
    EXPECT_NEAR(meter.exact(*device.model).piezo, ratio, 1e-8);
  }
  EXPECT_EQ(PullInMeter::piezo_unit(prepare(gold()).model), 0);
  EXPECT_NE(refusal([] { PullInMeter(prepare(gold()), {.piezo = true}); }).find("piezo cannot be measured: there is no [piezo]"),
            std::string::npos);
  const PreparedScene still = prepare(gold_pzt({"piezo.d31=0 m/V"}));
  EXPECT_NE(refusal([&] { PullInMeter(still, {.piezo = true}); }).find("it does not move the contact point"), std::string::npos);
}

// Devices that differ only in their piezo layer have nearly the same closing if they are driven in its unit.
TEST(Calibration, OfAPiezoUndoesWhatItsLayerDoes) {
  const PreparedScene nominal = prepare(gold_pzt(
      {"waveform.piezo={family=\"pulse\", levels=[\"1 V\", \"-1 V\", \"0 V\"], times=[\"9 us\", \"40 us\"], edge=\"1 us\"}",
       "spread={\"piezo.d31\"={distribution=\"normal\", cov=\"5 %\"}}", "simulate.duration=60 us"}));
  const Ensemble ensemble(nominal, 6);
  const std::vector<Waveform> drive = nominal.waveforms();
  const EnsembleRun run{.duration = nominal.duration};
  const Calibration exact{.pull_in_error = 0, .piezo_error = 0}, without{.pull_in_error = 0};
  const auto outcomes = close_all(ensemble, {{.waveforms = drive, .known = exact}, {.waveforms = drive, .known = without}}, run);
  const double alone = simulate_closing(nominal.model, nominal.applied(drive), {.duration = run.duration, .tolerance = 1e-9})
                           .touches.front()
                           .begin;
  for (std::uint64_t k = 0; k < ensemble.size(); ++k) {
    EXPECT_NEAR(outcomes[0][k].metrics.initial_contact_time, alone, 1e-5 * alone) << k;
    EXPECT_GT(std::abs(outcomes[1][k].metrics.initial_contact_time / alone - 1), 1e-4) << k;
  }
}

TEST(Calibration, OfAPiezoErrsApartFromWhatElseIsMeasured) {
  const DeviceUnits exact{.volts = 1.03, .time = 0.98, .piezo = 1.05};
  const Calibration two{.pull_in_error = 0.01, .frequency_error = 0.005};
  Calibration three = two;
  three.piezo_error = 0.01;
  double squares = 0, by_volts = 0, by_time = 0;
  constexpr int devices = 4000;
  for (std::uint64_t k = 0; k < devices; ++k) {
    const DeviceUnits known = PullInMeter::measured(exact, three, 3, k), others = PullInMeter::measured(exact, two, 3, k);
    ASSERT_EQ(known.volts, others.volts);
    ASSERT_EQ(known.time, others.time);
    ASSERT_EQ(others.piezo, 1) << "not measured";
    const double miss = exact.piezo / known.piezo - 1;
    squares += miss * miss;
    by_volts += miss * (known.volts / exact.volts - 1);
    by_time += miss * (exact.time / known.time - 1);
  }
  EXPECT_NEAR(std::sqrt(squares / devices), 0.01, 4 * 0.01 / std::sqrt(2.0 * devices));
  EXPECT_NEAR(by_volts / devices, 0, 4 * 0.01 * 0.01 / std::sqrt(devices));
  EXPECT_NEAR(by_time / devices, 0, 4 * 0.01 * 0.005 / std::sqrt(devices));
}

// Devices on a grid of voltage and time units, with large distances.
std::vector<DeviceUnits> grid() {
  std::vector<DeviceUnits> units;
  for (const double volts : {0.9, 1.1}) {
    for (const double time : {0.8, 1.2}) {
      for (const double near : {0.999, 1.001}) units.push_back({.volts = volts * near, .time = time * near});
    }
  }
  return units;
}

TEST(MeasuredUnits, AreThoseOfTheCentreOfTheClass) {
  const MeasuredUnits own({.pull_in_error = 0, .frequency_error = 0});
  EXPECT_EQ(own.of({.volts = 1.07, .time = 0.93}).volts, 1.07);
  EXPECT_TRUE(own.classes().empty());

  const MeasuredUnits sorted({.pull_in_error = 0, .frequency_error = 0, .classes = 4}, grid());
  ASSERT_EQ(sorted.classes().size(), 4U);
  for (const MeasuredUnits::Class& one : sorted.classes()) EXPECT_EQ(one.share, 0.25);
  constexpr double of_the_mean = 1e-6;  // the centre is a mean of logarithms
  const DeviceUnits centre = sorted.of({.volts = 1.07, .time = 0.85});
  EXPECT_NEAR(centre.volts, 1.1, of_the_mean);
  EXPECT_NEAR(centre.time, 0.8, of_the_mean);
  EXPECT_TRUE(std::isnan(sorted.of({.volts = Metrics::unset, .time = 1}).volts)) << "not measured, in no class";

  std::vector<DeviceUnits> weak, strong;  // devices with a weak and with a strong piezo
  for (DeviceUnits units : grid()) {
    for (const double piezo : {0.7, 1.3}) units.piezo = piezo, (piezo < 1 ? weak : strong).push_back(units);
  }
  std::vector<DeviceUnits> both = weak;
  both.insert(both.end(), strong.begin(), strong.end());
  const MeasuredUnits by_three({.pull_in_error = 0, .frequency_error = 0, .piezo_error = 0, .classes = 8}, both);
  ASSERT_EQ(by_three.classes().size(), 8U);
  const DeviceUnits of_three = by_three.of({.volts = 1.07, .time = 0.85, .piezo = 0.75});
  EXPECT_NEAR(of_three.volts, 1.1, of_the_mean);
  EXPECT_NEAR(of_three.piezo, 0.7, of_the_mean);
  EXPECT_EQ(centre.piezo, 1) << "not measured";

  const MeasuredUnits by_volts({.pull_in_error = 0, .classes = 2}, grid());
  EXPECT_NEAR(by_volts.of({.volts = 1.07, .time = 0.85}, 1, 0).volts, 1.1, of_the_mean);
  EXPECT_EQ(by_volts.of({.volts = 1.07, .time = 0.85}, 1, 0).time, 1) << "the frequency is not measured";
  EXPECT_NE(refusal([] { static_cast<void>(MeasuredUnits({.pull_in_error = 0, .classes = 2})); }).find("no device"),
            std::string::npos);
}

TEST(MeasuredUnits, SortWhatIsMeasuredWithItsErrors) {
  const Calibration errors{.pull_in_error = 0.1, .frequency_error = 0.1, .classes = 4};
  const MeasuredUnits sorted(errors, grid()), own({.pull_in_error = 0.1, .frequency_error = 0.1});
  const DeviceUnits exact{.volts = 1, .time = 1};
  for (std::uint64_t k = 0; k < 20; ++k) EXPECT_EQ(sorted.of(exact, 3, k).volts, sorted.of(own.of(exact, 3, k)).volts) << k;
}

TEST(Calibration, DrivesADeviceWithTheWaveformOfItsClass) {
  const PreparedScene nominal = prepare(gold_at_17_volts({"simulate.accuracy=1e-3"}));
  const PullInMeter meter(nominal, {});  // measuring a frequency needs no closings
  const Calibration sorted{.frequency_error = 0, .classes = 3};
  const MeasuredUnits known = measured_units(nominal, std::array{sorted}, 1).front();
  EXPECT_EQ(measured_units(nominal, std::array{sorted}, 3).front().classes()[1].centre.time, known.classes()[1].centre.time);
  ASSERT_EQ(known.classes().size(), 3U);
  const std::vector<Waveform> drive{Step{.level = 17.771, .rise_time = 20e-6}};
  const EnsembleRun run{.duration = nominal.duration, .vectors = Vectors::none};
  const std::vector<DeviceOutcome> outcomes =
      close_all(Ensemble(nominal, 12), {{.waveforms = drive, .known = known}}, run).front();
  const Ensemble ensemble(nominal, 12);
  DeviceBuilder builder(ensemble);
  std::set<double> times;
  for (std::uint64_t k = 0; k < 12; ++k) {
    const SampledDevice device = builder.device(k);
    const DeviceUnits units = known.of(meter.exact(*device.model));
    times.insert(units.time);
    const Metrics expected = metrics(simulate_closing(*device.model, std::vector{signal(scaled(drive[0], 1, units.time))},
                                                      {.duration = run.duration, .tolerance = run.tolerance}));
    EXPECT_EQ(outcomes[k].metrics.initial_contact_time, expected.initial_contact_time);
  }
  EXPECT_EQ(times.size(), 3U) << "three waveforms for all devices";
}

TEST(Robustness, SaysWhatAPiezosUnitIsWorthBesideTheOthers_slow) {
  const PreparedScene nominal = prepare(gold_pzt({"simulate.duration=60 us"}));
  const Calibration all{.pull_in_error = 0.01, .frequency_error = 0.005, .piezo_error = 0.01};
  const Robustness found = robustness(nominal, {{.name = "own", .waveforms = nominal.drives.waveforms(), .calibration = all}},
                                      {.samples = 4, .jobs = 2, .worth_of_measuring = true});
  std::vector<std::string> names;
  for (const DriveRobustness& d : found.by_knowledge) names.push_back(d.name);
  EXPECT_EQ(names, (std::vector<std::string>{"nothing", "Vdp", "frequency", "piezo", "Vdp and frequency",
                                             "Vdp, frequency and piezo, 4 classes", "Vdp, frequency and piezo, 8 classes",
                                             "Vdp, frequency and piezo, 16 classes", "Vdp, frequency and piezo"}));
  EXPECT_FALSE(found.by_knowledge[4].known.calibration().piezo_error);
  EXPECT_EQ(found.by_knowledge[8].known.calibration().piezo_error, 0);
}

TEST(Robustness, SaysWhatEachMeasurementIsWorth_optimized) {
  const PreparedScene nominal = prepare(gold_at_17_volts({"waveform.main.rise_time=30 us"}));
  const Calibration errors{.pull_in_error = 0.01, .frequency_error = 0.01};
  RobustnessOptions options{.samples = 24, .jobs = 2, .vectors = Vectors::none, .worth_of_measuring = true};
  const Robustness found =
      robustness(nominal, {{.name = "own", .waveforms = nominal.drives.waveforms(), .calibration = errors}}, options);
  ASSERT_EQ(found.drives.size(), 2U);
  std::vector<std::string> names;
  for (const DriveRobustness& d : found.by_knowledge) names.push_back(d.name);
  ASSERT_EQ(names,
            (std::vector<std::string>{"nothing", "Vdp", "frequency", "Vdp and frequency, 4 classes",
                                      "Vdp and frequency, 8 classes", "Vdp and frequency, 16 classes", "Vdp and frequency"}));
  EXPECT_TRUE(found.drives[0].known.calibration().is_empty()) << "the plain step is that of the nominal device";
  const std::vector<DeviceOutcome> fixed =
      robustness(nominal, {{.name = "own", .waveforms = nominal.drives.waveforms()}}, options).drives[1].outcomes;
  EXPECT_TRUE(std::equal(fixed.begin(), fixed.end(), found.by_knowledge[0].outcomes.begin(), same))
      << "nothing known: fixed volts";
  for (std::size_t i = 1; i < names.size(); ++i)
    EXPECT_FALSE(std::equal(fixed.begin(), fixed.end(), found.by_knowledge[i].outcomes.begin(), same))
        << found.by_knowledge[i].name;
  // In its own units every device has nearly the same closing, in its own periods.
  const Ensemble ensemble(nominal, options.samples);
  DeviceBuilder builder(ensemble);
  const auto spread_of_first_contact = [&](const DriveRobustness& d) {
    std::vector<double> periods;
    for (std::size_t k = 0; k < d.outcomes.size(); ++k)
      periods.push_back(d.outcomes[k].metrics.initial_contact_time * builder.device(k).model->basis().angular_frequencies()[0]);
    return sample_standard_deviation(periods) / sample_mean(periods);
  };
  EXPECT_LT(spread_of_first_contact(found.by_knowledge.back()), spread_of_first_contact(found.by_knowledge[0]) / 3);
  EXPECT_EQ(found.by_knowledge[5].known.classes().size(), 16U);
  EXPECT_TRUE(found.by_knowledge.back().known.classes().empty());
  for (std::size_t i = 3; i < 6; ++i)
    EXPECT_LT(spread_of_first_contact(found.by_knowledge[i + 1]), spread_of_first_contact(found.by_knowledge[i])) << names[i];
  // The scene of a device has the device's own voltages.
  const std::size_t k = 5;
  const PreparedScene alone =
      prepare(SceneFile::parse(scene_of_device(nominal, found.drives[1], k, options).text(), "worst.toml"));
  EXPECT_TRUE(alone.scene.calibration.is_empty());
  const Metrics own =
      metrics(simulate_closing(alone.model, alone.signals(), {.duration = found.duration, .tolerance = found.tolerance}),
              alone.scene.metrics);
  EXPECT_EQ(own.initial_contact_time, found.drives[1].outcomes[k].metrics.initial_contact_time);
  EXPECT_EQ(own.major_bounce_height, found.drives[1].outcomes[k].metrics.major_bounce_height);
}

// Without a simulate.duration the window of this scene ends before its waveform closes the devices.
TEST(Robustness, HasAWindowThatHoldsTheWaveformUnlessTheSceneGivesOne) {
  constexpr double before = 25e-6, after = 30e-6;
  SceneFile file = gold({"structure.modes=2", "simulate.accuracy=1e-3", "driver.main.max_voltage=25 V"});
  file.erase("simulate.duration");
  const double window = prepare(file).duration;
  file.set(
      fmt::format("waveform.main={{family=\"pulse\", levels=[\"0 V\", \"18 V\", \"18.5 V\"], times=[\"{} s\", \"{} s\"], "
                  "edge=\"1 us\"}}",
                  window - before, window + after));
  const auto closing = [&] {
    const PreparedScene nominal = prepare(file);
    return robustness(nominal, {{.name = "late", .waveforms = nominal.drives.waveforms()}}, {.samples = 16}).drives[1].closing;
  };
  EXPECT_EQ(closing().value, 1);
  file.set(fmt::format("simulate.duration=\"{} s\"", window));
  EXPECT_EQ(closing().value, 0) << "the scene asks for this window";
}

TEST(Robustness, JudgesEveryDriveOnTheSameDevicesBesideThePlainStep) {
  const PreparedScene nominal = prepare(gold_at_17_volts({"waveform.main.rise_time=40 us"}));
  const Robustness found = robustness(nominal, {{.name = "slow", .waveforms = nominal.drives.waveforms()}}, {.samples = 128});
  ASSERT_EQ(found.drives.size(), 2U);
  EXPECT_EQ(found.drives[0].name, "plain step");
  EXPECT_EQ(found.drives[1].name, "slow");
  EXPECT_EQ(std::get<Step>(found.drives[0].waveforms.at("main")).rise_time, 0);
  for (const DriveRobustness& drive : found.drives) {
    EXPECT_EQ(drive.outcomes.size(), 128U);
    EXPECT_EQ(drive.closing.value, 1);
    EXPECT_GT(drive.closing.interval.high, drive.closing.interval.low);
  }
  const auto height = &Metrics::major_bounce_height, time = &Metrics::initial_contact_time;
  for (const std::size_t q : {0U, 1U, 2U}) {
    EXPECT_GT(found.drives[1].figures[time].quantiles[q].value, found.drives[0].figures[time].quantiles[q].value);
  }
  // Each statistic against its definition.
  std::vector<double> heights;
  for (const DeviceOutcome& o : found.drives[0].outcomes) heights.push_back(o.metrics.major_bounce_height);
  double mean = 0;
  for (const double h : heights) mean += h / static_cast<double>(heights.size());
  std::sort(heights.begin(), heights.end());
  const FigureStatistics& s = found.drives[0].figures[height];
  EXPECT_NEAR(s.mean, mean, 1e-12 * mean);
  EXPECT_GE(s.quantiles[1].value, heights[63]);
  EXPECT_LE(s.quantiles[1].value, heights[64]);
  EXPECT_EQ(found.drives[0].outcomes[found.drives[0].worst[0]].metrics.major_bounce_height, heights.back());
  // A drive that equals the plain step is not simulated twice.
  const PreparedScene step = prepare(gold_at_17_volts());
  EXPECT_EQ(robustness(step, {{.name = "step", .waveforms = step.drives.waveforms()}}, {.samples = 2}).drives.size(), 1U);
}

TEST(Robustness, GivesTheSceneOfEveryDevice) {
  const PreparedScene nominal = prepare(gold_at_17_volts());
  const RobustnessOptions options{.samples = 16, .vectors = Vectors::none};  // one closing at a time, as in `simulate`
  const Robustness found = robustness(nominal, {}, options);
  for (const std::size_t k : {found.drives[0].worst[0], std::size_t{3}}) {
    const PreparedScene alone =
        prepare(SceneFile::parse(scene_of_device(nominal, found.drives[0], k, options).text(), "worst.toml"));
    const Metrics own =
        metrics(simulate_closing(alone.model, alone.signals(), {.duration = found.duration, .tolerance = found.tolerance}),
                alone.scene.metrics);
    EXPECT_EQ(own.initial_contact_time, found.drives[0].outcomes[k].metrics.initial_contact_time);
    EXPECT_EQ(own.major_bounce_height, found.drives[0].outcomes[k].metrics.major_bounce_height);
  }
}

TEST(Robustness, FollowsTheGapsOfTheFirstDevices) {
  const PreparedScene nominal = prepare(gold_at_17_volts());
  const RobustnessOptions options{.samples = 16, .jobs = 2, .vectors = Vectors::none};
  const Robustness found = robustness(nominal, {}, options);
  const DriveRobustness& step = found.drives[0];
  constexpr double end = 100e-6, interval = 0.1e-6;
  const GapCourses courses = gap_courses(nominal, step, 3, 1001, end, options);
  ASSERT_EQ(courses.gaps.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<double>& gap = courses.gaps[k];
    const SampledDevice device = DeviceBuilder(Ensemble(nominal, 16)).device(k);
    EXPECT_NEAR(gap.front(), device.model->device().gap.contact, 1e-12);
    const auto touch = static_cast<double>(std::ranges::find_if(gap, [](double g) { return g <= 0; }) - gap.begin());
    const Metrics& m = step.outcomes[k].metrics;
    EXPECT_NEAR(touch * interval, m.initial_contact_time, 1.01 * interval);
    // The error of a quadratic through three points is bounded by the largest acceleration.
    const auto at = static_cast<std::size_t>(touch) - 3;
    EXPECT_NEAR(gap[at], (gap[at - 1] + gap[at + 1]) / 2, 1e-3 * gap[at]);
    const double speed = (gap[at] - gap[at + 1]) / interval;
    EXPECT_NEAR(speed, m.impact_velocity, 0.05 * m.impact_velocity);
  }
}

TEST(Robustness, RefusesDrivesThatTheSceneDoesNotAllow) {
  const PreparedScene nominal = prepare(gold_at_17_volts());
  const auto refused = [&](const std::string& drive, const Waveform& waveform) {
    return refusal([&] {
      static_cast<void>(robustness(nominal, {{.name = "x.toml", .waveforms = {{drive, waveform}}}}, {.samples = 1}));
    });
  };
  EXPECT_EQ(refused("piezo", Step{.level = 1}), "x.toml: its drive 'piezo' must be a drive of the first scene");
  EXPECT_EQ(refused("main", Step{.level = 26}).find("x.toml: drive 'main': "), 0U);
}

// A key with two possible units varies in its own.
TEST(Window, RoundedUpHasTwoDigits) {
  for (const int exponent : {-9, -5, -4, 0, 3}) {
    for (int digits = 10; digits < 100; ++digits) {
      const double window = std::stod(fmt::format("{}e{}", digits, exponent));
      EXPECT_EQ(rounded_up(window), window);
      EXPECT_EQ(rounded_up(window * 0.9999), window) << "as the decimal reads, 0.0017 and not 17 * 1e-4";
    }
  }
}

TEST(Ensemble, KeepsTheUnitOfWhatVaries) {
  const SceneFile file = spring_plate({"structure.width=100 um", "gas.model=linear", "gas.damping=2e-5 N s/m",
                                       R"(spread."gas.damping"={ distribution = "normal", cov = "5 %" })"});
  const PreparedScene nominal = prepare(file);
  const Ensemble ensemble(nominal, 3, 1);
  for (std::uint64_t k = 0; k < 3; ++k) {
    const double given = ensemble.values(k)[0] * number_of(*nominal.scene.device.gas, "damping", 0);
    EXPECT_NEAR(number_of(*DeviceBuilder(ensemble).device(k).model->device().gas, "damping", 0), given, 1e-9 * given);
  }
}

}  // namespace
}  // namespace softland::ensemble_test
