// Compares the states of contacts in runs with touches, rebounds and electrical figures.
#include "studies/devices/contact_states.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/require.h"
#include "studies/closing/open_command.h"
#include "studies/closing/resistance_course.h"
#include "studies/closing/simulate.h"
#include "studies/devices/device_drives.h"
#include "studies/devices/ensemble.h"
#include "tests/studies/scenes.h"

namespace softland {
namespace {

std::vector<std::string> said;  // messages of the last run
StateRecord states_of_scene(const SceneFile& file) {
  said.clear();
  return contact_states(prepare(file), {}, [](const std::string& line) { said.push_back(line); });
}

// A rigid plate on a linear contact is closed exactly in its touches.
TEST(ContactStates, OfAPlateAreItsTouches) {
  const PreparedScene p = prepare(spring_plate());
  const Closing closing = simulate(p, true);
  const StateRecord record = contact_states(p, {}, [](const std::string&) {});
  ASSERT_EQ(record.channels.size(), 1u);
  const StateChannel& connection = record.channels.front();
  EXPECT_EQ(record.end, p.duration);
  EXPECT_TRUE(connection.contact.empty() && !connection.device && !connection.has_resistance);
  const std::vector<Touch>& touches = closing.trajectory.touches;
  ASSERT_EQ(connection.spans.size(), touches.size());
  ASSERT_GT(touches.size(), 3u);
  constexpr double located = 1e-12;  // difference of two root finders [s]
  for (std::size_t k = 0; k < touches.size(); ++k) {
    EXPECT_NEAR(connection.spans[k].begin, touches[k].begin, located);
    if (std::isfinite(touches[k].end))
      EXPECT_NEAR(connection.spans[k].end, touches[k].end, located);
    else
      EXPECT_TRUE(std::isinf(connection.spans[k].end));
  }
}

// Compares with the electrical figures, which the same run finds without a list of edges.
void expect_figures(const StateChannel& channel, const Metrics& m) {
  ASSERT_FALSE(channel.spans.empty());
  EXPECT_EQ(channel.spans.front().begin, m.electrical_contact);
  EXPECT_EQ(channel.spans.size(), static_cast<std::size_t>(m.electrical_bounces) + 1);
  EXPECT_EQ(channel.spans.back().begin, m.electrical_settling);
  EXPECT_TRUE(std::isinf(channel.spans.back().end));
}

TEST(ContactStates, AgreeWithTheElectricalFigures) {
  for (const char* rule : {"metrics.closed_resistance=1 ohm", "metrics.closed_force=20 uN", "metrics.closed_after=0 s"}) {
    SCOPED_TRACE(rule);
    for (const char* after : {"metrics.closed_after=0 s", "metrics.closed_after=0.3 us"}) {
      const PreparedScene p = prepare(scene("ohmic-gold.toml", {rule, after, "simulate.accuracy=1e-4"}));
      const Metrics m = simulate(p, true).metrics;
      EXPECT_GT(m.electrical_bounces, 0);
      expect_figures(contact_states(p, {}, [](const std::string&) {}).channels.front(), m);
    }
  }
}

TEST(ContactStates, OfSeveralContactsAreThoseOfEachAndOfTheConnection) {
  for (const char* closed : {"all", "any"}) {
    SceneFile file = scene("new/two-contacts.toml", {"metrics.closed_after=0 s"});
    file.set(std::string("metrics.closed=") + closed);
    const PreparedScene p = prepare(file);
    const Closing closing = simulate(p, true);
    const StateRecord record = contact_states(p, {}, [](const std::string&) {});
    ASSERT_EQ(record.channels.size(), 1 + closing.contacts.size());
    expect_figures(record.channels.front(), closing.metrics);
    for (std::size_t c = 0; c < closing.contacts.size(); ++c) {
      EXPECT_EQ(record.channels[c + 1].contact, p.scene.device.contacts[c].name);
      if (std::isfinite(closing.contacts[c].metrics.electrical_settling))
        expect_figures(record.channels[c + 1], closing.contacts[c].metrics);
    }
  }
}

TEST(ContactStates, HaveTheResistanceOfTheCourse) {
  const PreparedScene p = prepare(scene("ohmic-gold.toml", {"simulate.accuracy=1e-4"}));
  const Trajectory run = simulate(p, true).trajectory;
  const StateChannel connection = contact_states(p, {}, [](const std::string&) {}).channels.front();
  ASSERT_TRUE(connection.has_resistance);
  std::size_t compared = 0;
  for (const ClosedSpan& span : connection.spans) {
    const double end = std::min(span.end, p.duration);
    ASSERT_GE(span.resistance.size(), 2u);
    EXPECT_EQ(span.resistance.front().first, span.begin);
    EXPECT_NEAR(span.resistance.back().first, end, 1e-12);
    for (std::size_t k = 1; k + 2 < span.resistance.size(); ++k) {
      const auto [a, from] = span.resistance[k];
      const auto [b, to] = span.resistance[k + 1];
      ASSERT_LT(a, b);
      constexpr double shortest = 5e-12;  // shortest interval that is bisected [s]
      if (b - a < shortest) continue;
      for (const double share : {0.25, 0.5}) {
        const std::vector<double> time{std::lerp(a, b, share)};
        const double right = resistance_course(p.scene.device, run, time).front();
        constexpr double near = 0.02;  // allowed error at the middle; interpolation is within 1 %
        EXPECT_NEAR(std::lerp(from, to, share), right, near * right) << time.front();
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 300u);
}

TEST(ContactStates, GoOnAfterTheCommandToOpen) {
  const SceneFile file = gold({"structure.modes=2", "simulate.duration=700 us", "metrics.closed_after=0 s"});
  SceneFile opens = file;
  opens.erase("waveform.main");
  for (const char* key : {"family=pulse", "levels=[\"17 V\", \"0 V\"]", "times=[\"500 us\"]"})
    opens.set(std::string("waveform.main.") + key);
  const PreparedScene p = prepare(opens);
  const Closing closing = simulate(p, true);
  ASSERT_TRUE(closing.command);
  const StateRecord record = contact_states(p, {}, [](const std::string&) {});
  const std::vector<ClosedSpan>& spans = record.channels.front().spans;
  EXPECT_EQ(spans.front().begin, closing.metrics.electrical_contact);
  ASSERT_TRUE(std::isfinite(spans.back().end)) << "it opens";
  EXPECT_GT(spans.back().end, closing.command->time);
  EXPECT_EQ(record.end, p.duration);
}

TEST(ContactStates, ThatBeginClosedBeginAtZero) {
  const StateRecord record = states_of_scene(gold({"structure.modes=2", "simulate.duration=100 us", "waveform.main.level=0 V",
                                                   "waveform.main.before=17 V", "waveform.main.before_state=closed"}));
  const std::vector<ClosedSpan>& spans = record.channels.front().spans;
  ASSERT_FALSE(spans.empty());
  EXPECT_EQ(spans.front().begin, 0);
  EXPECT_GT(spans.front().end, 0);
  EXPECT_LT(spans.front().end, 100e-6);
}

TEST(ContactStates, OfDevicesAreThoseOfTheirOwnRunsWhateverTheThreads) {
  SceneFile file = gold({"structure.modes=2", "simulate.duration=100 us", "simulate.accuracy=1e-3"});
  file.set("spread.\"driver.main.gain\"={ distribution = \"normal\", standard_deviation = \"1 %\" }");
  const PreparedScene nominal = prepare(file);
  const auto made = [&](int jobs) { return contact_states_of_devices(nominal, 5, 7, jobs, {}, [](const std::string&) {}); };
  const StateRecord one = made(1), three = made(3);
  ASSERT_EQ(one.channels.size(), 5u);
  const Ensemble ensemble(nominal, 5, 7);
  const DeviceDrives drives(nominal);
  std::vector<double> first;
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(one.channels[k].device, k);
    ASSERT_EQ(one.channels[k].spans.size(), three.channels[k].spans.size());
    for (std::size_t n = 0; n < one.channels[k].spans.size(); ++n)
      EXPECT_EQ(one.channels[k].spans[n].begin, three.channels[k].spans[n].begin);
    const SampledDevice device = DeviceBuilder(ensemble).device(k);
    const Trajectory run = simulate_closing(*device.model, drives.signals(nominal.waveforms(), {}, device.values),
                                            {.duration = nominal.duration, .tolerance = nominal.tolerance});
    ASSERT_FALSE(one.channels[k].spans.empty());
    EXPECT_NEAR(one.channels[k].spans.front().begin, run.touches.front().begin, 1e-12);
    first.push_back(run.touches.front().begin);
  }
  EXPECT_NE(first[0], first[1]);
}

TEST(ContactStates, AreRefusedWithoutAContactAndToldWhereTheRunEnds) {
  SceneFile file = spring_plate();
  file.erase("contact");
  EXPECT_THROW((void)states_of_scene(file), InvalidInput);
  const StateRecord open = states_of_scene(spring_plate({"waveform.main.level=0.5 Vdp"}));
  EXPECT_TRUE(open.channels.front().spans.empty());
  EXPECT_TRUE(said.empty());
  const StateRecord collapsed = states_of_scene(spring_plate({"contact.stiffness=20 N/m"}));
  EXPECT_EQ(collapsed.channels.front().spans.size(), 1u);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_THAT(said.front(), testing::HasSubstr("does not come to its end"));
}

}  // namespace
}  // namespace softland
