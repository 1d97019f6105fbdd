// Tests the value of measurements on a device.
#include "studies/inverse/identification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "scenes.h"

namespace softland::measurements_test {
namespace {

// A waveform that lets the beam coast over the last third of the gap and brakes it.
SceneFile recipe() {
  return gold_at_17_volts(
      {"waveform.main={family=\"pulse\", levels=[\"21 V\", \"0 V\", \"17.771 V\"], times=[\"20 us\", \"32 us\"], "
       "edge=\"1 us\"}",
       "structure.modes=2", "simulate.accuracy=1e-3"});
}

IdentificationOptions quick(int jobs = 2) { return {.samples = 24, .jobs = jobs, .steps = {1.25}}; }

const IdentificationStudy& study() {
  static const IdentificationStudy made = identify(recipe(), quick());
  return made;
}

const Prediction& of(const std::vector<Prediction>& all, std::string_view name) {
  return *std::find_if(all.begin(), all.end(), [&](const Prediction& p) { return p.name == name; });
}

TEST(Measurements, AreOfEveryFigureAndEveryPairTheBestFirst_optimized) {
  std::vector<std::string> names;
  for (const MeasurableFigure& f : study().figures) names.push_back(f.name);
  EXPECT_EQ(names, (std::vector<std::string>{"Vdp", "Vsp", "release", "frequency", "time at 1.25 Vdp"}));
  ASSERT_EQ(study().predictions.size(), 5U + 10U);
  double before = 0;
  for (const Prediction& p : study().predictions) {
    EXPECT_TRUE(p.is_judged);
    EXPECT_GE(p.score, before) << p.name;
    before = p.score;
  }
  EXPECT_FALSE(study().interrupted);
}

TEST(Measurements, OfVoltageAndFrequencyLandDevicesThatFixedVoltagesDoNot) {
  const double nothing = of(study().references, "nothing").score;
  EXPECT_LT(of(study().references, "the best factors themselves").score, 0.5 * nothing);
  EXPECT_LT(of(study().predictions, "Vdp and frequency").score, 0.7 * nothing);
  EXPECT_GT(of(study().predictions, "frequency").score, of(study().predictions, "Vdp and frequency").score);
}

// The best factors of voltages follow from one figure by a straight line, which is fitted to the other half of the devices.
TEST(Measurements, PredictByAFitToTheOtherHalf_optimized) {
  for (std::size_t f = 0; f < study().figures.size(); ++f) {
    const MeasurableFigure& figure = study().figures[f];
    const std::size_t devices = study().devices;
    double square = 0;
    int missed = 0;
    for (const bool first : {true, false}) {
      const auto is_fitted = [&](std::size_t k) { return (k < devices / 2) != first; };
      double n = 0, x = 0, y = 0, xx = 0, xy = 0;
      const auto regressor = [&](std::size_t k) { return std::log(figure.values[k] / figure.nominal); };
      const auto factor = [&](std::size_t k) { return std::log(study().best[k].volts); };
      const auto known = [&](std::size_t k) { return std::isfinite(regressor(k)) && std::isfinite(factor(k)); };
      for (std::size_t k = 0; k < devices; ++k) {
        if (!is_fitted(k) || !known(k)) continue;
        n += 1, x += regressor(k), y += factor(k), xx += regressor(k) * regressor(k), xy += regressor(k) * factor(k);
      }
      const double slope = (n * xy - x * y) / (n * xx - x * x), offset = (y - slope * x) / n;
      for (std::size_t k = 0; k < devices; ++k) {
        if (is_fitted(k) || !known(k)) continue;
        square += std::pow(offset + slope * regressor(k) - factor(k), 2);
        ++missed;
      }
    }
    const double expected = std::sqrt(square / missed);
    EXPECT_NEAR(of(study().predictions, figure.name).volts_miss, expected, 1e-9 * expected) << figure.name;
  }
}

TEST(Measurements, AreTheSameBitsWhateverTheNumberOfJobs_optimized) {
  const IdentificationStudy alone = identify(recipe(), quick(1));
  ASSERT_EQ(alone.predictions.size(), study().predictions.size());
  for (std::size_t i = 0; i < alone.predictions.size(); ++i) {
    EXPECT_EQ(alone.predictions[i].name, study().predictions[i].name);
    EXPECT_EQ(alone.predictions[i].score, study().predictions[i].score);
    EXPECT_EQ(alone.predictions[i].time_miss, study().predictions[i].time_miss);
  }
}

TEST(Measurements, WithErrorsHaveLessValue_optimized) {
  IdentificationOptions options = quick();
  options.pull_in_error = 0.05;
  const IdentificationStudy erring = identify(recipe(), options);
  EXPECT_EQ(erring.figures[0].values, study().figures[0].values) << "without the error";
  EXPECT_GT(of(erring.predictions, "Vdp").volts_miss, 1.3 * of(study().predictions, "Vdp").volts_miss);
  EXPECT_EQ(of(erring.predictions, "frequency").volts_miss, of(study().predictions, "frequency").volts_miss);
}

TEST(Measurements, KeepWhatIsJudgedWhenStopped_optimized) {
  std::atomic<bool> stop = false;
  Progress progress{.stop = &stop, .report = [&](std::string_view what, double part) {
                      if (what.starts_with("evaluating") && part > 0.3) stop = true;
                    }};
  const IdentificationStudy part = identify(recipe(), quick(1), progress);
  EXPECT_TRUE(part.interrupted);
  EXPECT_TRUE(part.predictions.front().is_judged);
  EXPECT_FALSE(part.predictions.back().is_judged);
  EXPECT_TRUE(std::isfinite(part.predictions.back().volts_miss)) << "told, though not judged";
  stop = true;
  EXPECT_THROW(static_cast<void>(identify(recipe(), quick(1), progress)), Interrupted);
}

TEST(Measurements, OfTwoContactsHoldTheClosingTimesOfTheirConnection_optimized) {
  const SceneFile file =
      scene("new/two-contacts.toml", {"waveform.main={family=\"pulse\", levels=[\"1.3 Vdp\", \"0 V\", \"1.25 Vdp\"], "
                                      "times=[\"4 us\", \"5 us\"], edge=\"0.5 us\"}",
                                      "structure.modes=1", "simulate.accuracy=1e-3"});
  const IdentificationStudy found = identify(file, {.samples = 16, .jobs = 2, .steps = {1.25}});
  EXPECT_EQ(found.figures.back().name, "time at 1.25 Vdp");
  EXPECT_TRUE(std::ranges::all_of(found.figures.back().values, [](double time) { return std::isfinite(time); }));
}

// The landing by the piezo is from softland optimize --waveform catch. The devices differ in their layers.
TEST(Measurements, RankAPiezosUnitFirstWhereLittleElseVaries_slow) {
  const SceneFile file = gold_pzt(
      {"waveform.main.level=28.086315 V", "driver.main.max_voltage=34 V",
       "waveform.piezo={family=\"pulse\", levels=[\"-0.164041193 V\", \"0.334724316 V\", \"0.498785465 V\", \"0 V\"], "
       "times=[\"4.18628334 us\", \"28.3294943 us\", \"46.4372444 us\"], edge=\"2.54599131 us\"}",
       "spread={\"piezo.d31\"={distribution=\"normal\", cov=\"10 %\"}, \"structure.thickness\"={distribution=\"normal\", "
       "cov=\"0.1 %\"}}",
       "structure.modes=2", "simulate.accuracy=1e-3"});
  const IdentificationStudy found = identify(file, {.samples = 16, .jobs = 2, .steps = {}});
  EXPECT_TRUE(found.drives_piezo);
  EXPECT_EQ(found.figures.back().name, "piezo");
  const Prediction &by_piezo = of(found.predictions, "piezo"), &by_pull_in = of(found.predictions, "Vdp");
  EXPECT_LT(by_piezo.piezo_unexplained, 0.2);
  EXPECT_GT(by_pull_in.piezo_unexplained, 0.8);
  EXPECT_LT(by_piezo.score, by_pull_in.score);
  EXPECT_LT(of(found.references, "own units: Vdp, frequency, piezo").score,
            of(found.references, "own units: Vdp, frequency").score);
  EXPECT_FALSE(study().drives_piezo);
  EXPECT_TRUE(std::isnan(study().predictions.front().piezo_miss));
}

TEST(Measurements, AssumeASpreadWhereTheSceneHasNone) {
  const IdentificationStudy found = identify(without(recipe(), "spread"), quick());
  EXPECT_TRUE(found.spread_assumed);
  EXPECT_FALSE(study().spread_assumed);
  EXPECT_EQ(found.devices, study().devices);
}

TEST(Measurements, RefuseAWaveformWithoutALanding_optimized) {
  const auto refused = [](const SceneFile& file) { return refusal([&] { static_cast<void>(identify(file, quick())); }); };
  EXPECT_NE(refused(gold_at_17_volts()).find("the plain step"), std::string::npos);
  EXPECT_NE(refused(without(recipe(), "contact")).find("[contact]"), std::string::npos);
}

}  // namespace
}  // namespace softland::measurements_test
