// Contact resistance and electrical closing in studies: at the hold voltage, along a run, on devices, and in conditions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "base/require.h"
#include "config/condition.h"
#include "model/contact/contact_law.h"
#include "model/contact/resistance.h"
#include "studies/closing/resistance_course.h"
#include "studies/closing/simulate.h"
#include "studies/devices/ensemble.h"
#include "studies/search/optimize.h"
#include "studies/search/search_setting.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

const char* const metal[] = {"contact.resistivity=22 nOhm m", "contact.hardness=1 GPa", "contact.mean_free_path=38 nm"};

SceneFile conducting_gold(std::initializer_list<std::string_view> changes = {}) {
  SceneFile file = gold({"structure.modes=2", "simulate.duration=250 us", "simulate.accuracy=1e-4"});
  for (const char* key : metal) file.set(key);
  for (const std::string_view change : changes) file.set(change);
  return file;
}

// Two dimples, which 20 V keep closed.
SceneFile two_dimples(const std::string& closed) {
  SceneFile file = gold_at_17_volts({"waveform.main.level=20 V", "simulate.duration=150 us"});
  file.erase("contact");
  file.erase("gap.contact");
  file.erase("spread");
  for (const auto& [name, gap] : {std::pair{"left", "2 um"}, std::pair{"right", "2.0002 um"}}) {
    const std::string path = std::string("contact.") + name + ".";
    for (const std::string key :
         {"model=linear", "pad_length=5 um", "stiffness=1 kN/m", "resistivity=22 nOhm m", "hardness=1 GPa"})
      file.set(path + key);
    file.set(path + "gap=" + gap);
  }
  file.set("metrics.closed=\"" + closed + "\"");
  return file;
}

TEST(ElectricalStudies, TheHoldResistanceIsThatOfTheClosedEquilibrium) {
  const PreparedScene p = prepare(conducting_gold());
  const Closing closing = simulate(p, false);
  const Contact& contact = p.scene.device.contacts.front();
  const ContactLaw law = contact_law(contact, p.scene.device.structure.width);
  const double depth = std::get<UniformAsperityContact>(law).interference(closing.metrics.hold_force);
  const double right = ContactResistance(contact, p.scene.device.structure.width).resistance(depth, closing.metrics.hold_force);
  EXPECT_NEAR(closing.metrics.resistance, right, 1e-9 * right);
  EXPECT_TRUE(closing.metrics.asked.resistance);
  EXPECT_FALSE(closing.metrics.asked.electrical);
  EXPECT_TRUE(std::isnan(simulate(prepare(conducting_gold({"waveform.main.level=5 V"})), false).metrics.resistance)) << "open";
  EXPECT_TRUE(std::isnan(simulate(prepare(gold_with_two_modes()), false).metrics.resistance)) << "nobody asks";
}

// The pad of a contact is as wide as the section above it, and so has the same number of asperities.
TEST(ElectricalStudies, AContactUnderASectionHasItsWidth) {
  const auto closed = [](bool of_sections) {
    SceneFile file = conducting_gold({"contact.asperity_density=1e14 1/m^2", "metrics.closed_resistance=1 ohm"});
    if (of_sections) {
      for (const char* key : {"structure.length", "structure.width"}) file.erase(key);
      file.set("structure.sections=[{length=\"200 um\", width=\"20 um\"}, {length=\"50 um\", width=\"20 um\"}]");
    }
    const PreparedScene p = prepare(file);
    const Closing closing = simulate(p, false);
    const double soon = closing.metrics.electrical_contact + 50e-9;  // an instant in the first touch
    const std::vector<double> course = resistance_course(p.scene.device, closing.trajectory, std::vector<double>{soon});
    return std::tuple(closing.metrics.resistance, closing.metrics.electrical_contact, course.front());
  };
  const auto [hold, first, course] = closed(false);
  const auto [own_hold, own_first, own_course] = closed(true);
  EXPECT_NEAR(own_hold, hold, 1e-4 * hold);
  EXPECT_NEAR(own_first, first, 1e-6 * first);
  EXPECT_NEAR(own_course, course, 1e-4 * course);
}

TEST(ElectricalStudies, AConnectionIsInSeriesOrSideBySide) {
  for (const bool all : {true, false}) {
    const PreparedScene p = prepare(two_dimples(all ? "all" : "any"));
    const Closing closing = simulate(p, false);
    ASSERT_EQ(closing.contacts.size(), 2u);
    double series = 0, conductance = 0;
    for (std::size_t c = 0; c < 2; ++c) {
      const double force = closing.contacts[c].metrics.hold_force;
      ASSERT_GT(force, 0) << c;
      const double own = ContactResistance(p.scene.device.contacts[c], p.scene.device.structure.width).resistance(0, force);
      EXPECT_NEAR(closing.contacts[c].metrics.resistance, own, 1e-9 * own);
      series += own;
      conductance += 1 / own;
    }
    const double right = all ? series : 1 / conductance;
    EXPECT_NEAR(closing.metrics.resistance, right, 1e-9 * right);
  }
}

TEST(ElectricalStudies, TheCourseOfARunIsThatOfItsKnots) {
  const PreparedScene p = prepare(conducting_gold());
  const Trajectory run = simulate(p, false).trajectory;
  std::vector<double> times;
  for (const TrajectoryPoint& point : run.points)
    if (times.empty() || point.time > times.back()) times.push_back(point.time);
  const std::vector<double> course = resistance_course(p.scene.device, run, times);
  ASSERT_EQ(course.size(), times.size());
  const ContactResistance contact(p.scene.device.contacts.front(), p.scene.device.structure.width);
  std::size_t closed = 0, k = 0;
  for (std::size_t i = 0; i < run.points.size(); ++i) {
    const TrajectoryPoint& point = run.points[i];
    if (i + 1 < run.points.size() && run.points[i + 1].time == point.time) continue;  // keep the later point of a jump
    const double right = contact.resistance(point.position - run.contact_gap, point.contact_force);
    ASSERT_EQ(times[k], point.time);
    if (std::isnan(right)) {
      EXPECT_TRUE(std::isnan(course[k])) << point.time;
    } else {
      EXPECT_NEAR(course[k], right, 1e-9 * right) << point.time;
      ++closed;
    }
    ++k;
  }
  EXPECT_GT(closed, times.size() / 10);
  EXPECT_GT(times.size() - closed, times.size() / 10);
  EXPECT_TRUE(resistance_course(prepare(gold_with_two_modes()).scene.device, run, times).empty());
}

TEST(ElectricalStudies, MeasuringChangesNoOtherFigure) {
  const SceneFile plain = gold({"structure.modes=2", "simulate.duration=250 us", "simulate.accuracy=1e-4"});
  const Metrics without = simulate(prepare(plain), false).metrics;
  const Metrics with =
      simulate(prepare(conducting_gold({"metrics.closed_force=0.1 uN", "metrics.closed_resistance=20 ohm"})), false).metrics;
  for (const Figure& figure : asked_among(all_figures, {})) {
    const double a = figure.value(without), b = figure.value(with);
    EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << figure.key;
  }
  EXPECT_GE(with.electrical_contact, with.initial_contact_time);
  EXPECT_TRUE(with.asked.electrical);
}

TEST(ElectricalStudies, DevicesHaveTheFiguresWhetherInLanesOrNot) {
  const PreparedScene nominal = prepare(conducting_gold({"metrics.closed_resistance=20 ohm", "metrics.closed_after=0.1 us"}));
  const std::vector<Signal> signals = nominal.signals();
  std::vector<SampledDevice> devices;
  const Ensemble ensemble(nominal, 4, 1);
  DeviceBuilder builder(ensemble);
  for (std::size_t k = 0; k < 4; ++k) devices.push_back(builder.device(k));
  std::vector<DrivenDevice> driven;
  for (const SampledDevice& device : devices) driven.push_back({.device = &device, .signals = &signals, .duration = 250e-6});
  const auto close = [&](Vectors vectors) {
    return close_driven(driven, nominal.scene.metrics, {.tolerance = 1e-5}, {}, false, vectors);
  };
  const std::vector<DeviceOutcome> one_by_one = close(Vectors::none), together = close(vectors_in_use());
  for (std::size_t k = 0; k < devices.size(); ++k) {
    ASSERT_TRUE(one_by_one[k].closed());
    for (const Figure& figure : device_figures) {
      const double a = one_by_one[k].of(figure), b = together[k].of(figure);
      EXPECT_TRUE(a == b) << figure.key << ": such devices are closed one at a time";
    }
    EXPECT_GT(one_by_one[k].metrics.resistance, 0);
    EXPECT_GT(one_by_one[k].metrics.electrical_contact, one_by_one[k].metrics.initial_contact_time);
  }
}

TEST(ElectricalStudies, AConditionOnAFigureThatTheSceneLacksIsRefused) {
  const auto refusal = [](const SceneFile& file, const char* condition) -> std::string {
    try {
      static_cast<void>(search_setting(file, Target::bounce, Actuator::electrostatic, "pulse", {},
                                       {parse_condition(condition, conditioned_figures)}));
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(refusal(gold_with_two_modes(), "resistance_ohm < 1 ohm"), testing::HasSubstr("resistivity"));
  EXPECT_THAT(refusal(conducting_gold(), "electrical_bounce_count == 0"), testing::HasSubstr("metrics.closed_force"));
  EXPECT_EQ(refusal(conducting_gold({"metrics.closed_force=0.1 uN"}), "electrical_bounce_count == 0"), "");
  EXPECT_EQ(refusal(conducting_gold(), "resistance_ohm < 1 ohm"), "");
}

TEST(ElectricalStudies, ASearchForTheElectricalClosingMakesItSooner) {
  const SceneFile file = scene("ohmic-gold.toml", {"metrics.closed_resistance=1 ohm", "simulate.accuracy=1e-3"});
  const OptimizeResult found = optimize(file, {.target = Target::electrical, .family = "dual-pulse", .max_evaluations = 150});
  ASSERT_TRUE(found.best);
  EXPECT_EQ(found.best->metrics.bounce_count, 0);
  EXPECT_LT(found.best->metrics.electrical_settling, 0.5 * found.baseline.metrics.electrical_settling);
  EXPECT_LT(found.best_cost, 1);
  EXPECT_THROW(optimize(conducting_gold(), {.target = Target::electrical, .max_evaluations = 3}), InvalidInput);
}

}  // namespace
}  // namespace softland
