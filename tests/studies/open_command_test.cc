// Commands to open. Oracles: the balance of forces on a plate, its linear oscillators in contact and in flight, the same
// opening from the closed equilibrium, and integrations by other programs.
#include "studies/closing/open_command.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>

#include "model/constants.h"
#include "studies/closing/accuracy.h"
#include "studies/closing/auto_settings.h"
#include "studies/closing/certify.h"
#include "studies/closing/effects.h"
#include "studies/closing/simulate.h"
#include "studies/devices/robustness.h"

namespace softland::open_command_test {
namespace {

using testing::HasSubstr;

constexpr double eps0 = 8.8541878128e-12;
constexpr double k = 10, mass = 1e-10, area = 1e-8, d = 4e-6, dt = 3e-6, kc = 5000;

SceneFile plate(std::string_view rest, double damping_ratio = 0, std::initializer_list<std::string_view> changes = {}) {
  SceneFile file =
      SceneFile::parse(fmt::format("structure = {{ kind = \"plate\", mass = \"1e-10 kg\", stiffness = \"10 N/m\", area = \"1e-8 "
                                   "m^2\", damping_ratio = {} }}\n",
                                   damping_ratio) +
                           std::string(R"(
gap = { electrode = "4 um", contact = "3 um" }
electrode.main.fringing = "none"
contact = { model = "linear", stiffness = "5 kN/m" }
)") + std::string(rest),
                       "plate.toml");
  for (const std::string_view change : changes) file.set(change);
  return file;
}

/// Returns the position of a plate at rest on its contact under a voltage, by Newton's method [m].
double pressed_to(double volts) {
  double y = dt;
  for (int i = 0; i < 50; ++i) {
    const double force = eps0 * area * volts * volts / (2 * (d - y) * (d - y));
    y += (force - k * y - kc * (y - dt)) / (k + kc - 2 * force / (d - y));
  }
  return y;
}

/// The plate released from its rest on the contact: it oscillates about kc dt / (k + kc) until it leaves the contact.
struct LetGo {
  double time, speed;  // time [s] and speed [m/s] at the break of contact
};
LetGo let_go(double volts) {
  const double middle = kc * dt / (k + kc), w = std::sqrt((k + kc) / mass), from = pressed_to(volts) - middle;
  const double phase = std::acos((dt - middle) / from);
  return {.time = phase / w, .speed = from * w * std::sin(phase)};
}

// Values of circuitjs1, pull request 289, by an independent integrator.
TEST(OpenCommand, EndsTheClosingAndBeginsAnOpeningWithFiguresOfItsOwn) {
  const SceneFile file = SceneFile::parse(R"(
structure = { kind = "plate", mass = "1 ug", stiffness = "100 N/m", area = "0.04 mm^2" }
gap = { electrode = "4 um", contact = "3 um" }
electrode.main.fringing = "none"
gas = { model = "linear", quality_factor = 0.7 }
contact = { model = "linear", stiffness = "100 kN/m" }
waveform.main = { family = "pulse", levels = ["90 V", "0 V"], times = ["300 us"] }
simulate.duration = "400 us"
)",
                                          "relay.toml");
  const Closing c = simulate(prepare(file), true);
  const Metrics& m = c.metrics;
  EXPECT_EQ(m.status, Status::done) << testing::PrintToString(c.warnings);
  EXPECT_TRUE(m.settled);
  EXPECT_NEAR(m.initial_contact_time, 17.147769e-6, 5e-13);
  EXPECT_NEAR(m.impact_velocity, 0.7690177, 5e-8);
  EXPECT_NEAR(m.major_bounce_height, 231e-9, 0.5e-9);
  EXPECT_DOUBLE_EQ(m.open_command, 300e-6);
  EXPECT_NEAR(m.opening_time, 0.138073e-6, 5e-13);
  EXPECT_EQ(m.release_bounces, 0);
  EXPECT_EQ(m.release_bounce_height, 0);
  EXPECT_GT(m.steady_force_time, m.initial_contact_time);
  EXPECT_GT(m.hold_force, 0);
  EXPECT_GT(m.release_settling_time, 4.21446e-6);  // half of the travel is done at this time
  for (const Rebound& rebound : c.rebounds) EXPECT_LT(rebound.end, 300e-6);
  EXPECT_LT(c.errors[&Metrics::opening_time], 1e-5 * m.opening_time);
  EXPECT_GT(c.errors[&Metrics::opening_time], 0);
}

TEST(OpenCommand, OfAClosedPlateHasTheFiguresOfTheClosedForm) {
  const PreparedScene p = prepare(plate(R"(
waveform.main = { family = "step", before = "40 V", before_state = "closed", level = "0 V" }
simulate.duration = "40 us"
)"));
  const Metrics m = simulate(p, true).metrics;
  const LetGo expected = let_go(40);
  EXPECT_EQ(m.open_command, 0);
  // Without loss the plate returns, strikes the contact repeatedly, and has a break after each touch.
  EXPECT_GT(m.release_bounces, 0);
  EXPECT_GT(m.release_bounce_height, dt);
  // In a window that ends before the plate has returned, the only break is that of the closed form.
  const PreparedScene once = prepare(plate(R"(
waveform.main = { family = "step", before = "40 V", before_state = "closed", level = "0 V" }
simulate.duration = "10 us"
)"));
  const Metrics first = simulate(once, true).metrics;
  EXPECT_NEAR(first.opening_time, expected.time, 1e-7 * expected.time);
  EXPECT_NEAR(expected.time, 1.6123714092547125e-07, 1e-15);
  const double w = std::sqrt(k / mass);
  EXPECT_NEAR(first.overshoot_open, std::hypot(dt, expected.speed / w), 1e-7 * dt);
}

TEST(OpenCommand, CountsFromTheBeginOfAnEdgeAndToRestWithinTwoPercentOfTheGap) {
  const SceneFile file = plate(R"(
waveform.main = { family = "step", before = "40 V", before_state = "closed", level = "0 V", rise_time = "0.1 us" }
simulate.duration = "200 us"
)",
                               0.1);
  const Metrics m = simulate(prepare(file), true).metrics;
  EXPECT_EQ(m.status, Status::done);
  EXPECT_EQ(m.open_command, 0);
  EXPECT_NEAR(m.opening_time, 1.9390789452193046e-07, 1e-7 * 1.94e-7);
  EXPECT_NEAR(m.overshoot_open, 2.197826193289084e-06, 1e-7 * 2.2e-6);
  EXPECT_NEAR(m.release_settling_time, 0.00012129667503159955, 1e-6 * 1.2e-4);
  EXPECT_GT(m.least_gap_open, 0);
  EXPECT_LT(m.least_gap_open, dt);
}

TEST(OpenCommand, OpensAfterAClosingAsFromTheClosedEquilibrium) {
  const auto run = [](std::string_view waveform) { return simulate(prepare(plate(waveform, 0.3)), true).metrics; };
  const Metrics closed = run(R"(
waveform.main = { family = "table", times = ["0 s", "0.1 us"], voltages = ["40 V", "0 V"], before = "40 V", before_state = "closed" }
simulate.duration = "200 us"
)");
  const Metrics m = run(R"(
waveform.main = { family = "table", times = ["0 s", "100 us", "300 us", "600 us", "600.1 us"], voltages = ["60 V", "60 V", "40 V", "40 V", "0 V"] }
simulate.duration = "800 us"
)");
  EXPECT_EQ(m.status, Status::done);
  EXPECT_DOUBLE_EQ(m.open_command, 600e-6);
  EXPECT_NEAR(m.opening_time, closed.opening_time, 1e-6 * closed.opening_time);
  EXPECT_NEAR(m.overshoot_open, closed.overshoot_open, 1e-6 * closed.overshoot_open);
  EXPECT_NEAR(m.release_settling_time, closed.release_settling_time, 1e-6 * closed.release_settling_time);
  EXPECT_NEAR(m.hold_force, kc * (pressed_to(40) - dt), 1e-9 * m.hold_force);
}

std::optional<double> commanded(std::string_view waveform, StartState start = StartState::open) {
  const PreparedScene p = prepare(plate(waveform));
  const auto found = open_command(p.model, p.signals(), start);
  return found ? std::optional(found->time) : std::nullopt;
}

TEST(OpenCommand, IsTheBeginOfTheLastFallAndNotOfADip) {
  // The plate releases below 26 V.
  EXPECT_EQ(commanded("waveform.main = { family = \"step\", level = \"40 V\" }"), std::nullopt);
  EXPECT_EQ(commanded("waveform.main = { family = \"step\", level = \"10 V\" }"), std::nullopt) << "it never held";
  EXPECT_EQ(commanded(R"(waveform.main = { family = "pulse", levels = ["40 V", "0 V", "40 V"], times = ["50 us", "60 us"] })"),
            std::nullopt);
  EXPECT_EQ(commanded(R"(waveform.main = { family = "pulse", levels = ["40 V", "30 V"], times = ["50 us"] })"), std::nullopt)
      << "that still holds";
  const std::string times = R"(times = ["50 us", "60 us", "70 us", "80 us", "90 us"] })";
  EXPECT_EQ(commanded(R"(waveform.main = { family = "pulse", levels = ["40 V", "0 V", "40 V", "30 V", "5 V", "0 V"], )" + times),
            80e-6);
  EXPECT_EQ(commanded("waveform.main = { family = \"pulse\", levels = [\"40 V\", \"600 V\"], times = [\"50 us\"] }"),
            std::nullopt)
      << "that pulls it through";
  // After a rise, a fall with two slopes begins with its first slope.
  const auto table = [](const char* points) { return fmt::format("waveform.main = {{ family = \"table\", {} }}", points); };
  EXPECT_EQ(commanded(table(R"(times = ["0 s", "40 us", "60 us", "61 us"], voltages = ["35 V", "40 V", "30 V", "0 V"])")), 40e-6);
  EXPECT_EQ(commanded(table(R"(times = ["0 s", "40 us", "50 us", "61 us"], voltages = ["40 V", "30 V", "30 V", "0 V"])")), 50e-6);
}

TEST(OpenCommand, IsTheBeginOfAFallAfterAFilterOrOfASine) {
  // The output of a filter begins to fall when its source is switched.
  EXPECT_NEAR(commanded(R"(waveform.main = { family = "pulse", levels = ["40 V", "0 V"], times = ["50 us"] }
driver.main = { max_voltage = "60 V", bandwidth = "100 kHz" })")
                  .value(),
              50e-6, 1e-15);
  // A half cosine.
  EXPECT_NEAR(
      commanded(R"(waveform.main = { family = "s-curve", levels = ["40 V", "0 V"], times = ["50 us"], edge = "4 us" })").value(),
      50e-6, 0.2e-6);
}

TEST(OpenCommand, OfASwitchThatStartsClosedIsTheFirstFall) {
  const std::string braked =
      "waveform.main = { family = \"pulse\", before = \"40 V\", before_state = \"closed\", levels = [\"0 V\", \"30 V\", \"0 "
      "V\"], "
      "times = [\"5 us\", \"7 us\"] }";
  EXPECT_EQ(commanded(braked, StartState::closed), 0);
  EXPECT_EQ(commanded(braked, StartState::open), 7e-6);
}

TEST(OpenCommand, IsThatOfTheSceneWhereItSaysSo) {
  const std::string rest = R"(
waveform.main = { family = "table", times = ["0 s", "600 us", "601 us"], voltages = ["60 V", "60 V", "0 V"] }
simulate.duration = "800 us"
)";
  const Metrics told = simulate(prepare(plate(rest, 0.3)), true).metrics;
  EXPECT_DOUBLE_EQ(told.open_command, 600e-6);
  const Metrics m = simulate(prepare(plate(rest, 0.3, {"simulate.open_at=\"600.25 us\""})), true).metrics;
  EXPECT_DOUBLE_EQ(m.open_command, 600.25e-6);
  EXPECT_NEAR(m.open_command + m.opening_time, told.open_command + told.opening_time, 1e-12);
  EXPECT_EQ(m.status, Status::done);
  const auto message = [&](std::initializer_list<std::string_view> changes) -> std::string {
    try {
      static_cast<void>(prepare(plate(rest, 0.3, changes)));
    } catch (const InvalidInput& wrong) {
      return wrong.what();
    }
    return {};
  };
  EXPECT_THAT(message({"simulate.open_at=\"800 us\""}), HasSubstr("simulate.open_at"));
  EXPECT_THAT(message({"simulate.open_at=\"800 us\""}), HasSubstr("must lie in the window, which ends at 800 us"));
}

TEST(OpenCommand, LeavesARunUnsettledThatHadNotSettledOrDoesNotComeToRest) {
  const std::string closing = "waveform.main = { family = \"pulse\", levels = [\"45 V\", \"0 V\"], ";
  const Metrics early =
      simulate(prepare(plate(closing + "times = [\"20 us\"] }\nsimulate.duration = \"400 us\"\n", 0.1)), true).metrics;
  EXPECT_EQ(early.status, Status::not_settled);
  EXPECT_FALSE(early.settled);
  EXPECT_TRUE(std::isfinite(early.opening_time));
  const Closing brief = simulate(prepare(plate(closing + "times = [\"300 us\"] }\nsimulate.duration = \"340 us\"\n", 0.1)), true);
  EXPECT_EQ(brief.metrics.status, Status::not_settled);
  EXPECT_TRUE(brief.metrics.settled);
  EXPECT_THAT(brief.warnings, testing::Contains(HasSubstr("not at rest in its open state")));
  // An explicit window, long enough, shows the plate at rest.
  EXPECT_EQ(simulate(prepare(plate(closing + "times = [\"300 us\"] }\n", 0.1)), true).metrics.status, Status::done);
}

TEST(OpenCommand, LeavesTheHoldForceOfTheClosing) {
  const std::string_view rest = R"(
waveform.main = { family = "pulse", levels = ["60 V", "0 V"], times = ["300 us"] }
simulate.duration = "400 us"
)";
  const PreparedScene p = prepare(plate(rest, 0.1));
  const std::vector<Signal> held = until_command(p, p.signals());
  EXPECT_EQ(hold_levels(held), std::vector<double>{60});
  EXPECT_EQ(held.front().voltage(1e-3), 60);
  EXPECT_TRUE(closed_state(p, held).stable.value_or(false));
  const Metrics m = simulate(p, true).metrics;
  EXPECT_NEAR(m.hold_force, kc * (pressed_to(60) - dt), 1e-9 * m.hold_force);
  EXPECT_NEAR(m.closed_time, m.open_command + m.opening_time - m.initial_contact_time - m.separated, 1e-15);
}

// In a window that ends before the command, the drives hold the switch.
TEST(OpenCommand, AfterTheWindowLeavesAClosingThatIsDone) {
  const std::string_view rest = R"(
waveform.main = { family = "pulse", levels = ["60 V", "0 V"], times = ["500 us"] }
simulate.duration = "300 us"
)";
  const PreparedScene p = prepare(plate(rest, 0.1));
  const Closing c = simulate(p, true);
  EXPECT_EQ(c.metrics.status, Status::done) << testing::PrintToString(c.warnings);
  EXPECT_FALSE(c.command);
  EXPECT_TRUE(std::isnan(c.metrics.open_command));
  EXPECT_NEAR(c.metrics.hold_force, kc * (pressed_to(60) - dt), 1e-9 * c.metrics.hold_force);
  const PreparedScene closing = closing_of(p);
  EXPECT_EQ(closing.duration, 300e-6);
  EXPECT_EQ(hold_levels(closing.signals()), std::vector<double>{60});
}

TEST(OpenCommand, BeforeTheFirstTouchIsNone) {
  // The plate is accelerated towards the contact, and released before it arrives.
  const Closing c = simulate(prepare(plate(R"(
waveform.main = { family = "pulse", levels = ["90 V", "0 V"], times = ["4 us"] }
simulate.duration = "60 us"
)")),
                             true);
  ASSERT_TRUE(c.metrics.touched());
  EXPECT_FALSE(c.command);
  EXPECT_TRUE(std::isnan(c.metrics.open_command));
  EXPECT_EQ(c.metrics.status, Status::not_settled);
}

TEST(OpenCommand, TellsTheImpactOnABackStop) {
  const SceneFile file = SceneFile::parse(R"(
structure = { kind = "plate", mass = "1e-10 kg", stiffness = "10 N/m", area = "1e-8 m^2" }
gap = { electrode = "4 um" }
electrode.main.fringing = "none"
contact.tip = { gap = "3 um", model = "linear", stiffness = "5 kN/m" }
contact.stop = { gap = "0.5 um", side = "far", model = "linear", stiffness = "2 kN/m" }
waveform.main = { family = "step", before = "40 V", before_state = "closed", level = "0 V" }
simulate.duration = "10 us"
)",
                                          "stop.toml");
  const Closing c = simulate(prepare(file), true);
  EXPECT_NEAR(c.metrics.opening_time, 1.6123714092547125e-07, 1e-8 * 1.6e-7);
  EXPECT_NEAR(c.metrics.back_stop_velocity, 0.9399795882381463, 1e-8);
}

// Studies of a closing end at the command to open.
TEST(OpenCommand, EndsTheClosingOfOtherStudies) {
  const std::string rest = "spread.\"gap.electrode\" = { distribution = \"normal\", cov = \"1 %\" }\n";
  const PreparedScene held =
      prepare(plate(rest + "waveform.main = { family = \"step\", level = \"60 V\" }\nsimulate.duration = \"300 us\"\n", 0.1));
  const PreparedScene p = prepare(plate(rest + R"(
waveform.main = { family = "pulse", levels = ["60 V", "0 V"], times = ["300 us"] }
simulate.duration = "400 us"
)",
                                        0.1));
  const PreparedScene closing = closing_of(p);
  EXPECT_DOUBLE_EQ(closing.duration, 300e-6);
  const Metrics own = simulate(closing, true).metrics, expected = simulate(held, true).metrics;
  EXPECT_EQ(own.status, Status::done);
  EXPECT_EQ(own.permanent_contact_time, expected.permanent_contact_time);
  const Effects effects = compare_effects(p), of_held = compare_effects(held);
  EXPECT_EQ(effects.own("gas").metrics.major_bounce_height, of_held.own("gas").metrics.major_bounce_height);
  const Closing certified = certify(p, {}, 2);
  EXPECT_EQ(certified.metrics.open_command, 300e-6);
  EXPECT_GT(certified.errors[&Metrics::opening_time], 0);
  EXPECT_LT(certified.errors[&Metrics::opening_time], 1e-4 * certified.metrics.opening_time);
  const RobustnessOptions options{.samples = 16, .jobs = 2, .opens_on_command = true};
  const Robustness found = robustness(closing, {{.name = "own", .waveforms = p.drives.waveforms()}}, options);
  const Robustness of_step = robustness(held, {{.name = "own", .waveforms = held.drives.waveforms()}}, options);
  for (const Robustness* one : {&found, &of_step}) ASSERT_EQ(one->drives.back().outcomes.size(), 16u);
  for (std::size_t i = 0; i < 16; ++i) {
    const Metrics &a = found.drives.back().outcomes[i].metrics, &b = of_step.drives.back().outcomes[i].metrics;
    EXPECT_EQ(a.status, b.status);
    EXPECT_NEAR(a.major_bounce_height, b.major_bounce_height, 1e-6 * b.major_bounce_height);
    EXPECT_NEAR(a.steady_force_time, b.steady_force_time, 1e-6 * b.steady_force_time);
  }
}

}  // namespace
}  // namespace softland::open_command_test
