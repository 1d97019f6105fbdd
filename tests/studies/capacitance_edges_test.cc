// Compares records of a capacitance with records of a contact that lies where the capacitance has the threshold.
#include "studies/inverse/capacitance_edges.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/closing.h"
#include "model/constants.h"
#include "studies/inverse/practice_device.h"
#include "studies/inverse/tuner.h"
#include "studies/inverse/tuning_model.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

// A plate of 100 by 100 um, 3.8 um above its electrode: C = eps0 A / h.
constexpr double area = 1e-8, rest = 3.8e-6, contact = 2.6e-6;
double capacitance_at(double gap) { return vacuum_permittivity * area / gap; }

SceneFile plate(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file =
      scene("new/plate.toml", {"electrode.main.fringing=none", "waveform.main.level=110 V", "driver.main.max_voltage=130 V"});
  for (const std::string_view change : changes) file.set(change);
  return file;
}

class ClosingPlate {
 public:
  explicit ClosingPlate(const SceneFile& file)
      : prepared_(prepare(file)), signals_(prepared_.signals()), options_{.duration = prepared_.duration, .tolerance = 1e-8} {}
  [[nodiscard]] Trajectory contact() const { return simulate_closing(prepared_.model, signals_, options_); }
  [[nodiscard]] std::vector<CapacitanceRise> rises(double threshold) const {
    CapacitanceEdges edges(prepared_.model, searched_drive(prepared_.model.device()), threshold);
    static_cast<void>(observe_closing(prepared_.model, signals_, options_, edges));
    return edges.rises();
  }

 private:
  PreparedScene prepared_;
  std::vector<Signal> signals_;
  ClosingOptions options_;
};

TEST(CapacitanceEdges, RiseWhereAContactAtThatGapWouldTouch) {
  const ClosingPlate closing(plate());
  constexpr double of_integrator = 1e-6;
  for (const double nearer : {1.2e-6, 2.0e-6, 2.55e-6}) {
    const std::string gap = fmt::format("gap.contact={} um", nearer * 1e6);
    const Touch touch = ClosingPlate(plate({gap})).contact().touches.front();
    const double threshold = capacitance_at(rest - nearer);
    const std::vector<CapacitanceRise> rises = closing.rises(threshold);
    ASSERT_FALSE(rises.empty()) << nearer;
    EXPECT_NEAR(rises.front().begin / touch.begin, 1, of_integrator) << nearer;
    EXPECT_NEAR(rises.front().rate / (threshold / (rest - nearer) * touch.impact_velocity), 1, 10 * of_integrator) << nearer;
  }
}

TEST(CapacitanceEdges, FallWhileThePlateBouncesBeyondTheThreshold) {
  const ClosingPlate closing(plate());
  const Trajectory contact_alone = closing.contact();
  ASSERT_GT(contact_alone.touches.size(), 2U);
  constexpr double nearly = 1e-4;  // distance to the contact over the gap
  const std::vector<CapacitanceRise> rises = closing.rises(capacitance_at((rest - contact) * (1 + nearly)));
  ASSERT_GT(rises.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT(rises[k].begin, contact_alone.touches[k].begin);
    EXPECT_GT(rises[k].end, contact_alone.touches[k].end);
    EXPECT_NEAR(rises[k].begin / contact_alone.touches[k].begin, 1, 1e-3);
    EXPECT_NEAR(rises[k].end / contact_alone.touches[k].end, 1, 1e-3);
  }
  EXPECT_TRUE(std::isnan(rises.back().end)) << "it is closed at the end";
  EXPECT_TRUE(closing.rises(2 * capacitance_at(rest - contact)).empty());
}

// The message has both capacitances. The one of the open switch is eps0 A / h.
TEST(CapacitanceEdges, AThresholdOutsideOfTheTwoCapacitancesIsRefused) {
  const PreparedScene nominal = prepare(plate());
  const double rise = capacitance_rise(nominal, capacitance_at(2e-6));
  EXPECT_NEAR(rise / (capacitance_at(rest - contact) - capacitance_at(rest)), 1, 0.01) << "the contact gives way a little";
  for (const double threshold : {capacitance_at(rest) / 2, 2 * capacitance_at(rest - contact)}) {
    try {
      (void)capacitance_rise(nominal, threshold);
      ADD_FAILURE() << threshold;
    } catch (const InvalidInput& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("23.3 fF, and that of the closed one, 73."));
    }
  }
}

// The belief simulates the same values of a device that a practice device reports.
TEST(CapacitanceEdges, ABeliefPredictsTheRecordOfThePracticeDevice) {
  LaboratoryErrors laboratory{.edge_error = 0, .unseen = 0, .gain_error = 0, .shot_error = 0, .trigger_delay = 0};
  laboratory.capacitance = capacitance_at(1.3e-6);
  SceneFile file = plate();
  const PracticeDevice device(file, {.seed = 4, .laboratory = laboratory});
  laboratory.edge_error = 1e-9;
  const TuningModel scene(file, {.laboratory = laboratory, .effort = 0.02}, {});
  EXPECT_FALSE(scene.is_in_lanes());
  const std::vector<Waveform> step{Step{.level = 110}};
  const PracticeClosing shown = device.close(1, step, scene.hold_time());
  ASSERT_EQ(shown.record.error, "");
  const Particle same{.z = Eigen::VectorXd::Zero(scene.size()), .sampled = device.device()};
  const std::vector<PredictedShot> shots{{.device = &same, .waveforms = &step}};
  const PredictedClosing predicted = scene.close(shots)[0];
  ASSERT_TRUE(predicted.is_seen_to_close());
  constexpr double of_tolerance = 1e-4;
  EXPECT_NEAR(predicted.recorded_touch() / *first_touch(shown.record), 1, of_tolerance);
  EXPECT_LT(predicted.recorded_touch(), (1 - of_tolerance) * predicted.touch) << "before the contact touches";
  EXPECT_NEAR(predicted.touch / shown.motion.initial_contact_time, 1, of_tolerance);
  const auto openings_shown = openings(shown.record);
  const auto seen = predicted.seen();
  ASSERT_FALSE(seen.openings.empty() || openings_shown.empty());
  EXPECT_NEAR(seen.openings[0].begin / openings_shown[0].begin, 1, of_tolerance);
}

TEST(CapacitanceEdges, ADeviceIsLandedByItsCapacitanceAlone_optimized) {
  LaboratoryErrors laboratory = usual_errors(plate());
  laboratory.capacitance = capacitance_at(rest - contact) * 0.97;
  const PracticeDevice device(plate(), {.seed = 7, .laboratory = laboratory});
  Tuner tuner(plate(), {.jobs = 2, .laboratory = laboratory, .effort = 0.2});
  PracticeClosing last;
  for (std::uint64_t shot = 1; shot <= 8 && !tuner.is_done(); ++shot) {
    double end = 0;
    for (const Waveform& waveform : tuner.next().waveforms) end = std::max(end, signal(waveform).breakpoints().back());
    last = device.close(shot, tuner.next().waveforms, end + tuner.next().hold_time);
    tuner.learn(last.record);
  }
  const Metrics step = metrics(ClosingPlate(plate()).contact());
  EXPECT_TRUE(tuner.is_done());
  EXPECT_LT(last.motion.impact_velocity, 0.3 * step.impact_velocity);
}

}  // namespace
}  // namespace softland
