// Fits a scene to measurements on devices of the scene.
#include "studies/inverse/fit.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/random.h"
#include "model/pull_in.h"
#include "scenes.h"
#include "studies/inverse/estimate.h"
#include "studies/inverse/fitted_scene.h"
#include "studies/inverse/next_measurement.h"
#include "studies/inverse/trace_windows.h"

namespace softland::fit_test {
namespace {

#define SKIP_WITHOUT_CERES() \
  if (!has_ceres()) GTEST_SKIP() << "skipped: no Ceres; needs: libceres-dev"

constexpr const char* spread =
    R"(spread={"structure.stiffness"={distribution="normal",cov="4 %"},"structure.mass"={distribution="normal",cov="3 %"},gaps={keys=["gap.electrode","gap.contact"],distribution="normal",cov="2 %"}})";
SceneFile plate(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = spring_plate(changes);
  file.set(spread);
  return file;
}

// Parameters of another plate.
struct Truth {
  double stiffness = 1.03, mass = 0.98, gaps = 1.015;
};
double exact(const Instrument& instrument, const Truth& truth) {
  const PreparedScene p = prepare(plate());
  DeviceReader reader(p);
  std::vector<double> values;
  for (const SpreadVariable& v : p.scene.spread.variables)
    values.push_back(v.name == "gaps" ? truth.gaps : v.name == "structure.mass" ? truth.mass : truth.stiffness);
  EXPECT_TRUE(reader.move_to(values));
  return reader.read(instrument, false).values[0];
}

struct Measured {
  const char* quantity;
  Instrument instrument;
  double error;  // error over the value
};
const std::vector<Measured> all_kinds{{"pull_in", {.what = Measurable::pull_in}, 1e-3},
                                      {"release", {.what = Measurable::release}, 1e-3},
                                      {"frequency", {.what = Measurable::frequency}, 1e-4},
                                      {"capacitance", {.what = Measurable::capacitance}, 2e-3},
                                      {"closing_time", {.what = Measurable::closing_time, .level = 110}, 1e-3},
                                      {"closing_time", {.what = Measurable::closing_time, .level = 130}, 1e-3}};

Bench bench_of(const std::vector<Measured>& what, const Truth& truth, double noise = 0, const std::string& device = "",
               std::uint64_t seed = 1) {
  Bench bench{.name = "bench.toml", .measurements = {}, .changes = {}};
  for (std::size_t i = 0; i < what.size(); ++i) {
    const double value = exact(what[i].instrument, truth), error = what[i].error * value;
    BenchMeasurement m{.quantity = what[i].quantity, .device = device, .place = "bench.toml:1"};
    m.values = {value + noise * error * random_normal(seed, Stream::measurement, i)};
    m.errors = {error};
    if (what[i].instrument.level != 0) m.levels = {what[i].instrument.level};
    bench.measurements.push_back(m);
  }
  return bench;
}

const FittedUnknown& unknown(const Fit& fit, const std::string& name) {
  for (const FittedUnknown& u : fit.unknowns) {
    if (u.name == name) return u;
  }
  throw std::logic_error("no unknown " + name);
}

TEST(Fit, FindsTheDeviceThatWasMeasured) {
  SKIP_WITHOUT_CERES();
  const Truth truth;
  // The data have no noise, and are so precise that the prior has no effect.
  std::vector<Measured> sharp = all_kinds;
  for (Measured& m : sharp) m.error *= 1e-4;
  const Fit found = fit(plate(), bench_of(sharp, truth), {.starts = 4});
  ASSERT_TRUE(found.found);
  EXPECT_NEAR(unknown(found, "structure.stiffness").value / (42 * truth.stiffness), 1, 1e-4);
  EXPECT_NEAR(unknown(found, "structure.mass").value / (2.4e-9 * truth.mass), 1, 1e-4);
  EXPECT_NEAR(unknown(found, "gaps").value, truth.gaps, 1e-4);
  EXPECT_EQ(found.minima, 1U);
  EXPECT_LT(found.chi_squared(), 1e-3 * found.chi_squared_before());
}
// An etch that widens both gaps by the same amount.
TEST(Fit, FindsOneAmountThatIsAddedToSeveralKeys) {
  SKIP_WITHOUT_CERES();
  SceneFile file = spring_plate();
  file.set(R"(spread={"structure.stiffness"={distribution="normal",cov="4 %"},)"
           R"(undercut={keys=["gap.electrode","gap.contact"],weights=[1,1],distribution="normal",standard_deviation="100 nm"}})");
  const PreparedScene p = prepare(file);
  constexpr double stiffness = 1.03, undercut = 80e-9, sharp = 1e-7;
  DeviceReader reader(p);
  ASSERT_TRUE(reader.move_to({stiffness, undercut}));
  Bench bench{.name = "bench.toml", .measurements = {}, .changes = {}};
  for (const Measured& one : all_kinds) {
    const double value = reader.read(one.instrument, false).values[0];
    bench.measurements.push_back(
        {.quantity = one.quantity, .values = {value}, .errors = {sharp * value}, .place = "bench.toml:1"});
    if (one.instrument.level != 0) bench.measurements.back().levels = {one.instrument.level};
  }
  const Fit found = fit(file, bench, {.starts = 2});
  ASSERT_TRUE(found.found);
  constexpr double tolerance = 1e-4;  // relative
  EXPECT_NEAR(unknown(found, "undercut").value, undercut, tolerance * undercut);
  EXPECT_EQ(unknown(found, "undercut").nominal, 0);
  EXPECT_EQ(unknown(found, "undercut").unit, "m");
  const double contact = p.scene.device.gap.contact;
  bool is_there = false;
  for (const Fit::FittedKey& key : found.keys("")) {
    if (key.path != "gap.contact") continue;
    is_there = true;
    EXPECT_NEAR(key.value.value, contact + undercut, tolerance * undercut);
  }
  EXPECT_TRUE(is_there);
}
// The velocity of a bouncing switch that differs from its scene, at intervals of a quarter of a microsecond.
struct BouncingDevice {
  SceneFile scene = gold({"structure.modes=2", "waveform.main.level=20 V", "driver.main.max_voltage=40 V"});
  std::vector<double> truth{1.025, 1.0, 0.98};  // factors of thickness, modulus and gaps
  static constexpr double noise = 0.5e-3;       // [m/s]
  double touch = 0;

  [[nodiscard]] Bench bench(double until) {
    const PreparedScene p = prepare(scene);
    std::vector<double> values;
    for (const SpreadVariable& v : p.scene.spread.variables)
      values.push_back(v.name == "gaps" ? truth[2] : v.name == "structure.thickness" ? truth[0] : truth[1]);
    DeviceReader reader(p);
    EXPECT_TRUE(reader.move_to(values));
    Instrument vibrometer{.what = Measurable::velocity, .level = 20};
    for (double t = 0; t < until; t += 0.25e-6) vibrometer.times.push_back(t);
    touch = reader.read({.what = Measurable::closing_time, .level = 20}, false).values[0];
    const Eigen::VectorXd velocities = reader.read(vibrometer, false).values;
    const double resonance = reader.read({.what = Measurable::frequency}, false).values[0], error = 3e-3 * resonance;
    Bench all{.name = "bench.toml", .measurements = {}, .changes = {}};
    all.measurements.push_back({.quantity = "frequency", .values = {resonance}, .errors = {error}, .place = "bench.toml:1"});
    BenchMeasurement trace{.quantity = "velocity", .times = vibrometer.times, .place = "bench.toml:5"};
    for (std::size_t i = 0; i < vibrometer.times.size(); ++i) {
      trace.values.push_back(velocities[static_cast<Eigen::Index>(i)] + noise * random_normal(3, Stream::measurement, i));
      trace.errors.push_back(noise);
      trace.levels.push_back(20);
    }
    all.measurements.push_back(trace);
    return all;
  }
};

TEST(Fit, OfARecordWithBouncesGoesOnAsLongAsTheSceneDescribesThem_optimized) {
  SKIP_WITHOUT_CERES();
  BouncingDevice device;
  const Fit found = fit(device.scene, device.bench(250e-6), {.starts = 8, .suggest = false});
  ASSERT_TRUE(found.found);
  EXPECT_EQ(found.doubts, std::vector<std::string>{});
  ASSERT_EQ(found.traces.size(), 1U);
  EXPECT_GT(found.traces[0].until, 1.2 * device.touch) << "bounces tell more than the way to the contact";
  EXPECT_LT(found.traces[0].until, found.traces[0].recorded);
  for (const auto& [name, value] : {std::pair{"structure.thickness", 2.05e-6}, std::pair{"gaps", 0.98}}) {
    const FittedUnknown& u = unknown(found, name);
    EXPECT_LT(std::abs(u.value - value), 4 * u.standard_error) << name << ' ' << u.value << " +- " << u.standard_error;
    EXPECT_LT(u.standard_error, 2e-3 * value) << name;
  }
}

TEST(Fit, OfARecordThatLeavesTheSceneEndsBefore_optimized) {
  SKIP_WITHOUT_CERES();
  BouncingDevice device;
  Bench bench = device.bench(100e-6);
  BenchMeasurement& trace = bench.measurements[1];
  constexpr double leaves = 30e-6, strange = 20e-3;  // [s], [m/s]
  for (std::size_t i = 0; i < trace.times.size(); ++i) {
    if (trace.times[i] > leaves) trace.values[i] += strange;
  }
  const Fit found = fit(device.scene, bench, {.starts = 8, .suggest = false});
  ASSERT_TRUE(found.found);
  EXPECT_LE(found.traces.at(0).until, leaves);
  const FittedUnknown& gaps = unknown(found, "gaps");
  EXPECT_LT(std::abs(gaps.value - device.truth[2]), 4 * gaps.standard_error);
  trace.has_end = true;
  const Fit whole = fit(device.scene, bench, {.starts = 2, .suggest = false});
  EXPECT_EQ(whole.traces.at(0).until, whole.traces.at(0).recorded) << "the end that is said counts";
  EXPECT_FALSE(whole.doubts.empty());
}

TEST(TraceWindows, GrowTogetherAndStopSeparately) {
  Bench bench{.name = "bench.toml", .measurements = {}, .changes = {}};
  for (int k = 0; k < 3; ++k) {
    BenchMeasurement trace{.quantity = "velocity"};
    for (int i = 0; i <= 20; ++i) trace.times.push_back(i), trace.values.push_back(0), trace.errors.push_back(1);
    bench.measurements.push_back(trace);
  }
  bench.measurements[2].has_end = true;
  TraceWindows windows(bench, {4, 8, 4});
  EXPECT_EQ(windows.inside().measurements[0].times.back(), 4);
  EXPECT_EQ(windows.inside().measurements[1].values.size(), 9U);
  EXPECT_EQ(windows.inside().measurements[2].times.size(), 21U);
  ASSERT_TRUE(windows.grow());
  EXPECT_EQ(windows.end(0), 5);
  EXPECT_EQ(windows.end(1), 10);
  EXPECT_TRUE(windows.is_new(0, 5) && !windows.is_new(0, 4) && !windows.is_new(2, 5));
  EXPECT_FALSE(windows.keep({true, false, true}));
  EXPECT_EQ(windows.end(0), 4);
  EXPECT_EQ(windows.end(1), 8);
  int grown = 0;
  while (windows.grow()) {
    ++grown;
    EXPECT_TRUE(windows.keep({true, true, true}));
    ASSERT_LT(grown, 20);
  }
  EXPECT_EQ(grown, 8) << "4 times 1.25 to the eighth is the first beyond 20";
  EXPECT_EQ(windows.end(0), 20);
  EXPECT_EQ(windows.end(1), 8);
}

TEST(Fit, IsTheSameForAnyNumberOfThreads) {
  SKIP_WITHOUT_CERES();
  const Bench bench = bench_of(all_kinds, {}, 1);
  const Fit one = fit(plate(), bench, {.starts = 6, .jobs = 1}), two = fit(plate(), bench, {.starts = 6, .jobs = 2});
  ASSERT_EQ(one.costs.size(), 6U);
  for (std::size_t i = 0; i < one.unknowns.size(); ++i) {
    EXPECT_EQ(one.unknowns[i].value, two.unknowns[i].value);
    EXPECT_EQ(one.unknowns[i].standard_error, two.unknowns[i].standard_error);
  }
  for (std::size_t i = 0; i < one.costs.size(); ++i) EXPECT_EQ(one.costs[i], two.costs[i]);
}
TEST(Fit, SaysWhichUnknownsTheDataCannotSeparate) {
  SKIP_WITHOUT_CERES();
  // Closing times alone determine one combination of the unknowns.
  std::vector<Measured> times{all_kinds[4], all_kinds[5]};
  const Fit found = fit(plate(), bench_of(times, {}), {.starts = 1});
  ASSERT_FALSE(found.estimate.weak.empty());
  EXPECT_GT(found.estimate.weak.front().unknowns.size(), 1U);
  // The fit ranks further measurements by their value, and the best ones do reduce the errors.
  ASSERT_FALSE(found.next.empty());
  EXPECT_GT(found.next.front().reduction, 0.05);
  for (std::size_t i = 1; i < found.next.size(); ++i) EXPECT_LE(found.next[i].reduction, found.next[i - 1].reduction);
  const Fit all = fit(plate(), bench_of(all_kinds, {}), {.starts = 1});
  EXPECT_TRUE(all.estimate.weak.empty());
}
TEST(Fit, SaysThatVoltagesAndTimesOfAPlateShowNoGap) {
  SKIP_WITHOUT_CERES();
  // Voltages depend on stiffness * gap^3 and on mass / stiffness only. A direction that changes neither is weak.
  std::vector<Measured> without_capacitance = all_kinds;
  without_capacitance.erase(without_capacitance.begin() + 3);
  const Fit found = fit(plate(), bench_of(without_capacitance, {}), {.starts = 1});
  ASSERT_EQ(found.estimate.weak.size(), 1U);
  const WeakDirection& weak = found.estimate.weak.front();
  Eigen::Vector3d change = weak.direction;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const FittedUnknown& u = found.unknowns[static_cast<std::size_t>(i)];
    change[i] *= u.scale / u.nominal;
  }
  const double gaps = change[0], mass = change[1], stiffness = change[2];
  constexpr double by_the_contact =
      0.1;  // the contact has a finite stiffness, so that the release voltage depends a little on the gap
  EXPECT_NEAR(stiffness / gaps, -3, by_the_contact);
  EXPECT_NEAR(mass / stiffness, 1, by_the_contact);
  EXPECT_LT(weak.seen, 0.1);
  EXPECT_EQ(found.next.front().what, Measurable::capacitance);
}
TEST(Fit, OfAKeyWithoutASpreadHasNoPrior) {
  SKIP_WITHOUT_CERES();
  // The device differs by 10 %. With so rough a measurement the prior of the spread would pull the result back.
  const Bench bench = bench_of({{"pull_in", {.what = Measurable::pull_in}, 0.03}}, {.stiffness = 1.1, .mass = 1, .gaps = 1});
  SceneFile without_prior = plate();
  without_prior.erase("spread");
  const Fit free = fit(without_prior, bench, {.unknowns = {"structure.stiffness"}, .starts = 1});
  EXPECT_TRUE(std::isnan(unknown(free, "structure.stiffness").prior_mean));
  EXPECT_NEAR(unknown(free, "structure.stiffness").value / 42, 1.1, 1e-4);
  const Fit held = fit(plate(), bench, {.unknowns = {"structure.stiffness"}, .starts = 1});
  EXPECT_LT(unknown(held, "structure.stiffness").value / 42, 1.06);
}
// A beam of sections that is curled by every key except a table of heights, and the same beam with a table of heights.
SceneFile built_gold(bool by_table) {
  SceneFile file = gold({"structure.modes=2",
                         "structure.sections=[{length=\"60 um\", width=\"15 um\", thickness=\"1.8 um\"}, {length=\"190 um\", "
                         "width=[\"15 um\", \"30 um\"], holes={pitch=\"10 um\", size=\"4 um\"}}]",
                         "structure.anchor={rotation=\"2e-8 N m/rad\"}", "waveform.main.level=5 V"});
  file.erase("spread");
  if (by_table) {
    file.set("structure.rest_shape={positions=[\"0 um\", \"40 %\", \"tip\"], heights=[\"0 nm\", \"50 nm\", \"300 nm\"]}");
  } else {
    file.set("structure.stress_gradient=0.1 MPa/um");
    file.set(
        "structure.layers=[{face=\"far\", span=[\"0 um\", \"60 um\"], thickness=\"0.1 um\", youngs_modulus=\"250 GPa\", "
        "density=\"3100 kg/m^3\", stress=\"5 MPa\"}]");
  }
  return file;
}

TEST(Fit, FindsAnyKeyOfABeamOfParts) {
  SKIP_WITHOUT_CERES();
  const std::vector<Measured> readings{{"pull_in", {.what = Measurable::pull_in}, 0},
                                       {"frequency", {.what = Measurable::frequency}, 0},
                                       {"capacitance", {.what = Measurable::capacitance}, 0}};
  constexpr double truth = 1.06, sharp = 1e-7, tolerance = 1e-4;  // truth and errors over the scene's value
  for (const char* const key :
       {"structure.sections[1].thickness", "structure.sections[1].length", "structure.sections[2].width[2]",
        "structure.sections[2].holes.size", "structure.anchor.rotation", "structure.layers[1].stress",
        "structure.layers[1].thickness", "structure.stress_gradient", "structure.rest_shape.heights[3]"}) {
    const SceneFile file = built_gold(std::string_view(key).find("rest_shape") != std::string_view::npos);
    SceneFile varied = file;
    varied.set(fmt::format("spread.\"{}\"={{distribution=\"normal\",cov=\"10 %\"}}", key));
    const PreparedScene p = prepare(varied);
    DeviceReader reader(p);
    ASSERT_TRUE(reader.move_to({truth})) << key;
    Bench bench{.name = "bench.toml", .measurements = {}, .changes = {}};
    for (const Measured& one : readings) {
      const double value = reader.read(one.instrument, false).values[0];
      bench.measurements.push_back(
          {.quantity = one.quantity, .values = {value}, .errors = {sharp * value}, .place = "bench.toml:1"});
    }
    const Fit found = fit(file, bench, {.unknowns = {key}, .starts = 1, .suggest = false});
    ASSERT_TRUE(found.found) << key;
    const double nominal = p.scene.spread.variables.front().keys.front().nominal;
    EXPECT_NEAR(unknown(found, key).value / nominal, truth, tolerance) << key;
    EXPECT_GT(std::abs(found.residuals.front().normalized_before()), 100) << key << " does not move what is measured";
    // The fitted scene reproduces the measurement.
    SceneFile fitted = file;
    for (const Fit::FittedKey& one : found.keys("")) fitted.assign(one.path, one.value, one.element);
    EXPECT_NEAR(static_pull_in(prepare(fitted).model, 0).voltage / bench.measurements.front().values.front(), 1, tolerance)
        << key;
  }
}

TEST(Fit, FindsACurlAboutAStraightBeamByItsSpread) {
  SKIP_WITHOUT_CERES();
  SceneFile straight = gold({"structure.modes=2", "structure.stress_gradient=0 Pa/m", "waveform.main.level=5 V"});
  straight.erase("spread");
  SceneFile file = straight;
  file.set(R"(spread={"structure.stress_gradient"={distribution="normal",standard_deviation="0.1 MPa/um"}})");
  constexpr double truth = 0.03e12, sharp = 1e-7;  // [Pa/m]; error over the value
  const PreparedScene p = prepare(file);
  DeviceReader reader(p);
  ASSERT_TRUE(reader.move_to({truth}));
  const double value = reader.read({.what = Measurable::pull_in}, false).values[0];
  Bench bench{.name = "bench.toml", .measurements = {}, .changes = {}};
  EXPECT_THROW(static_cast<void>(fit(file, bench, {.starts = 1})), InvalidInput) << "there is nothing to fit";
  bench.measurements.push_back({.quantity = "pull_in", .values = {value}, .errors = {sharp * value}, .place = "bench.toml:1"});
  const Fit found = fit(file, bench, {.starts = 1, .suggest = false});
  ASSERT_TRUE(found.found);
  EXPECT_NEAR(unknown(found, "structure.stress_gradient").value / truth, 1, 1e-3);
  try {
    static_cast<void>(fit(straight, bench, {.unknowns = {"structure.stress_gradient"}, .starts = 1}));
    ADD_FAILURE() << "a factor of 0 is 0";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("give it a standard_deviation in Pa/m"), std::string::npos) << error.what();
  }
}

TEST(Fit, WeighsDownADatumThatDoesNotAgree) {
  SKIP_WITHOUT_CERES();
  Bench bench = bench_of(all_kinds, {});
  bench.measurements[0].values[0] *= 1.05;  // the value is wrong by fifty errors
  const Fit huber = fit(plate(), bench, {.loss = Loss::huber, .starts = 1});
  const Fit none = fit(plate(), bench, {.loss = Loss::none, .starts = 1});
  const auto off = [](const Fit& found) {
    return std::abs(unknown(found, "structure.stiffness").value / 42 - Truth{}.stiffness);
  };
  EXPECT_LT(off(huber), 0.5 * off(none));
}
TEST(Fit, SharesUnknownsOfDevicesAndKeepsTheRestOfEach) {
  SKIP_WITHOUT_CERES();
  Bench bench = bench_of(all_kinds, {.stiffness = 1.03, .mass = 0.98, .gaps = 1.02}, 0, "A");
  for (BenchMeasurement& m : bench_of(all_kinds, {.stiffness = 1.03, .mass = 1.01, .gaps = 0.98}, 0, "B").measurements)
    bench.measurements.push_back(m);
  const Fit found = fit(plate(), bench, {.shared = {"structure.stiffness"}, .starts = 1});
  ASSERT_EQ(found.devices, (std::vector<std::string>{"A", "B"}));
  ASSERT_EQ(found.unknowns.size(), 5U);
  for (const FittedUnknown& u : found.unknowns) {
    if (u.name == "structure.stiffness") {
      EXPECT_EQ(u.device, "");
      EXPECT_NEAR(u.value / 42, 1.03, 2e-3);
    }
    if (u.name == "gaps") {
      EXPECT_NEAR(u.value, u.device == "A" ? 1.02 : 0.98, 2e-3);
    }
  }
  ASSERT_TRUE(found.population.has_value());
  EXPECT_EQ(found.population->names, (std::vector<std::string>{"gaps", "structure.mass"}));
}
TEST(Fit, OfManyDevicesFindsTheSpreadThatTheyCameFrom) {
  SKIP_WITHOUT_CERES();
  constexpr std::size_t devices = 40;
  constexpr double stiffness = 0.03, gaps = 0.015, correlation = 0.6;
  Bench bench{.name = "bench.toml", .measurements = {}, .changes = {}};
  for (std::uint64_t k = 0; k < devices; ++k) {
    const double a = random_normal(2, Stream::fit, 2 * k), b = random_normal(2, Stream::fit, 2 * k + 1);
    const Truth truth{.stiffness = 1.02 + stiffness * a, .mass = 1, .gaps = 1 + gaps * (correlation * a + 0.8 * b)};
    for (BenchMeasurement& m : bench_of(all_kinds, truth, 1, fmt::format("D{}", k), k).measurements)
      bench.measurements.push_back(std::move(m));
  }
  const Fit found = fit(plate(), bench, {.unknowns = {"structure.stiffness", "gaps"}, .starts = 1, .suggest = false});
  ASSERT_TRUE(found.population.has_value());
  const FittedPopulation& all = *found.population;
  ASSERT_EQ(all.names, (std::vector<std::string>{"gaps", "structure.stiffness"}));
  // Three standard errors of the deviation of a sample with this many devices.
  const double open = 3 / std::sqrt(2.0 * devices);
  EXPECT_NEAR(all.deviation[0] / gaps, 1, open);
  EXPECT_NEAR(all.deviation[1] / stiffness, 1, open);
  EXPECT_NEAR(all.mean[1], 1.02, 3 * stiffness / std::sqrt(1.0 * devices));
  EXPECT_NEAR(all.correlation(0, 1), correlation, 3 * (1 - correlation * correlation) / std::sqrt(1.0 * devices));
  // The population is written as a scene for robustness and tune.
  SceneFile file = plate();
  set_spread(file, found);
  const DeviceSpread written = read_scene(file).spread;
  ASSERT_EQ(written.variables.size(), 3U);
  EXPECT_NEAR(written.variables[0].distribution.standard_deviation(), all.deviation[0] / all.mean[0], 1e-5);
  EXPECT_NEAR(written.correlation(0, 2), all.correlation(0, 1), 1e-4);
}
TEST(Fit, RefusesUnknownsThatNoDeviceHas) {
  const Bench bench = bench_of({all_kinds[0]}, {});
  EXPECT_NE(refusal([&] { (void)fit(plate(), bench, {.unknowns = {"structure.stifness"}}); }).find("unknown structure.stifness"),
            std::string::npos);
  EXPECT_NE(refusal([&] { (void)fit(plate(), bench, {.unknowns = {"gap.contact"}}); }).find("entry 'gaps'"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)fit(plate(), bench, {.shared = {"gap.far"}}); }).find("shared gap.far"), std::string::npos);
  Bench other = bench;
  other.measurements[0].drive = "mian";
  EXPECT_NE(refusal([&] { (void)fit(plate(), other, {}); }).find("no drive 'mian'"), std::string::npos);
}

// ---- the linear algebra

TEST(Estimate, OfOneDatumKnowsOneDirection) {
  Eigen::MatrixXd slopes(1, 2);
  slopes << 30, -30;
  const Estimate found = estimate(slopes.transpose() * slopes, Eigen::MatrixXd::Identity(2, 2));
  ASSERT_EQ(found.weak.size(), 1U);
  EXPECT_NEAR(found.weak[0].direction[0], found.weak[0].direction[1], 1e-12);
  EXPECT_NEAR(found.correlation(0, 1), 1, 2e-3);
  EXPECT_NEAR(found.deviation(0), std::sqrt(0.5), 1e-3);
  // The reduction by two measurements is exact as well.
  EXPECT_NEAR(found.reduction({Eigen::Vector2d(30, 30)}), 1 - 1 / (30 * std::sqrt(1.0)), 0.01);
}
TEST(Estimate, OfAPopulationFindsItsMomentsFromExactDevices) {
  constexpr int devices = 400;
  std::vector<KnownDevice> all;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> drawn;
  for (std::uint64_t k = 0; k < devices; ++k) {
    const double a = random_normal(1, Stream::fit, 2 * k), b = random_normal(1, Stream::fit, 2 * k + 1);
    drawn.emplace_back(0.3 + 0.5 * a, -0.2 + 0.5 * (0.8 * a + 0.6 * b));
    sum += drawn.back();
    const Eigen::Matrix2d information = 1e4 * Eigen::Matrix2d::Identity();
    all.push_back({.data = information, .target = information * drawn.back()});
  }
  const NormalBelief found = population_of(all, {.mean = Eigen::Vector2d::Zero(), .covariance = Eigen::Matrix2d::Identity()});
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& one : drawn) covariance += (one - sum / devices) * (one - sum / devices).transpose() / devices;
  constexpr double of_errors = 1e-3;  // error since each device is not known exactly
  EXPECT_LE((found.mean - sum / devices).norm(), of_errors);
  EXPECT_LE((found.covariance - covariance).norm(), of_errors);
}
TEST(LeastSquares, FindsTheMinimumOfRosenbrocksValleyFromManyStarts) {
  SKIP_WITHOUT_CERES();
  const LeastSquares valley{
      .unknowns = 2, .residuals = 2, .robust = 0, .evaluate = [](std::span<const double> x, std::span<double> r, double* j) {
        r[0] = 10 * (x[1] - x[0] * x[0]), r[1] = 1 - x[0];
        if (j != nullptr) j[0] = -20 * x[0], j[1] = 10, j[2] = -1, j[3] = 0;
        return true;
      }};
  const ManyEnds ends =
      solve_from([&] { return valley; }, {{-1.2, 1}, {2, 2}, {0, -1}}, 2,
                 [](const LeastSquaresEnd& a, const LeastSquaresEnd& b) { return std::abs(a.x[0] - b.x[0]) < 1e-4; });
  EXPECT_EQ(ends.minima, 1U);
  for (const LeastSquaresEnd& end : ends.ends) EXPECT_NEAR(end.x[0], 1, 1e-6);
}
TEST(NextMeasurement, KeepsToTheLimitsOfTheDrivers) {
  const auto largest_level = [](const PreparedScene& p) {
    double largest = 0;
    for (const PossibleMeasurement& one : possible_measurements(p)) {
      if (std::isfinite(one.instrument.level)) largest = std::max(largest, one.instrument.level);
    }
    return largest;
  };
  EXPECT_GT(largest_level(prepare(plate())), 90);
  EXPECT_LE(largest_level(prepare(plate({"driver.main.max_voltage=90 V", "waveform.main.level=80 V"}))), 90);
}
TEST(LeastSquares, PassesOnWhatItsFunctionThrows) {
  SKIP_WITHOUT_CERES();
  const LeastSquares broken{
      .unknowns = 1, .residuals = 1, .evaluate = [](auto, auto, double*) -> bool { throw InvalidInput("broken"); }};
  EXPECT_THROW((void)solve(broken, {0}), InvalidInput);
}

}  // namespace
}  // namespace softland::fit_test
