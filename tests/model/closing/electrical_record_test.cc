// Electrical closing, against closed forms of a plate, the knots of whole closings, and the mechanical figures.
#include "model/closing/electrical_record.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "base/literals.h"
#include "integrators/quintic.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/contact/contact_law.h"
#include "model/contact/resistance.h"
#include "model/pull_in.h"
#include "tests/support/devices.h"
#include "waveforms/pulse.h"

namespace softland {
namespace {

using namespace literals;

constexpr Conduction gold_metal{.resistivity = 2.2e-8, .hardness = 1e9, .mean_free_path = 38e-9};
constexpr double never = std::numeric_limits<double>::quiet_NaN();

/// A lossless plate on springs that rests closed on a linear contact and is released at t = 0: it leaves the contact and
/// returns.
struct LetGo {
  static constexpr double mass = 1e-10, stiffness = 10, gap = 3e-6, contact_stiffness = 5000;  // [kg], [N/m], [m], [N/m]

  LetGo() {
    device = {.structure = {.length = 100_um, .width = 100_um, .kind = Plate{.mass = mass, .stiffness = stiffness}},
              .gap = {.electrode = 4_um, .contact = gap},
              .electrodes = {{.name = "main", .begin = 0, .end = 100_um, .fringing = Fringing::none}},
              .contacts = {{.model = LinearSpring{.stiffness = contact_stiffness}, .conduction = gold_metal}}};
  }
  [[nodiscard]] Trajectory run(double duration) const {
    const Switch model(device);
    const std::vector<double> start{(gap + penetration) * std::sqrt(mass)};
    return simulate_closing(model, std::vector<Signal>{Signal::constant(0)},
                            {.duration = duration, .tolerance = 1e-11, .begins_closed = start});
  }
  /// Returns the time from the release until the contact force has this value [s].
  [[nodiscard]] static double time_to(double force) {
    const double still = contact_stiffness * gap / (stiffness + contact_stiffness), swing = gap + penetration - still;
    return std::acos((gap + force / contact_stiffness - still) / swing) / std::sqrt((stiffness + contact_stiffness) / mass);
  }
  /// Returns the time between leaving the contact and returning to it [s].
  [[nodiscard]] static double flight() {
    const double free = std::sqrt(stiffness / mass), bound = std::sqrt((stiffness + contact_stiffness) / mass);
    const double still = contact_stiffness * gap / (stiffness + contact_stiffness), swing = gap + penetration - still;
    const double speed = swing * bound * std::sin(bound * time_to(0));
    return 2 * (std::numbers::pi - std::atan2(speed / free, gap)) / free;
  }

  static constexpr double penetration = 20e-9;  // [m]
  Device device;
};

TEST(ElectricalRecord, AgreesWithTheClosedFormOfAPlateThatComesBack) {
  constexpr double exact = 1e-9;  // relative error that the integrator's tolerance allows
  LetGo plate;
  for (const double threshold : {0.0, 5e-6, 40e-6, 90e-6}) {
    SCOPED_TRACE(threshold);
    plate.device.electrical = {.force = threshold};
    const double opens = LetGo::time_to(threshold), leaves = LetGo::time_to(0), period = 2 * leaves + LetGo::flight();
    const double closes = period - opens;
    // The window ends at the largest force of the third touch.
    const ElectricalOutcome found = plate.run(2 * period).electrical;
    EXPECT_EQ(found.first_closed, 0);
    EXPECT_EQ(found.openings, 2);
    EXPECT_NEAR(found.closed_from, period + closes, exact * period);
    plate.device.electrical.after = 1.01 * (closes - opens);
    const ElectricalOutcome all = plate.run(2 * period).electrical;
    EXPECT_EQ(all.openings, 0) << "none lasts as long";
    EXPECT_EQ(all.closed_from, 0);
    plate.device.electrical.after = 0.99 * (closes - opens);
    EXPECT_EQ(plate.run(2 * period).electrical.openings, 2);
    // The plate is in flight at the end.
    const ElectricalOutcome open = plate.run(period + period / 2).electrical;
    EXPECT_EQ(open.openings, 1) << "what is not yet longer than counts does not count";
    EXPECT_TRUE(std::isnan(open.closed_from));
    plate.device.electrical.after = never;
    EXPECT_EQ(plate.run(period + period / 2).electrical.openings, 2);
  }
  plate.device.electrical = {.force = 150e-6};
  EXPECT_TRUE(std::isnan(plate.run(100_us).electrical.first_closed)) << "it is never pressed as hard";
  plate.device.electrical = {};
  EXPECT_TRUE(std::isnan(plate.run(100_us).electrical.first_closed)) << "nobody asks";
}

TEST(ElectricalRecord, OfAResistanceIsThatOfTheForceThatHasIt) {
  LetGo plate;
  const ContactResistance contact(plate.device.contacts.front(), plate.device.structure.width);
  const double twice_back = 2 * (2 * LetGo::time_to(0) + LetGo::flight());
  for (const double threshold : {5e-6, 40e-6, 90e-6}) {
    plate.device.electrical = {.force = threshold};
    const ElectricalOutcome by_force = plate.run(twice_back).electrical;
    plate.device.electrical = {.resistance = contact.resistance(threshold / LetGo::contact_stiffness, threshold)};
    const ElectricalOutcome by_resistance = plate.run(twice_back).electrical;
    EXPECT_EQ(by_resistance.openings, by_force.openings);
    EXPECT_NEAR(by_resistance.closed_from, by_force.closed_from, 1e-13) << "[s]";
    plate.device.electrical.force = threshold / 2;
    EXPECT_NEAR(plate.run(twice_back).electrical.closed_from, by_force.closed_from, 1e-13) << "the stricter of two decides";
  }
}

// Records the course of every contact.
class Courses final : public ClosingObserver {
 public:
  explicit Courses(std::size_t contacts) {
    for (std::size_t c = 0; c < contacts; ++c) each.push_back(std::make_unique<Own>());
  }
  void knot(const TrajectoryPoint& p) override { only.knot(p); }
  void touch(const Touch& t) override { only.touch(t); }
  ClosingObserver* contact(std::size_t c) override { return each[c].get(); }

  struct Own final : ClosingObserver {
    void knot(const TrajectoryPoint& p) override { points.push_back(p); }
    void touch(const Touch& t) override { touches.push_back(t); }
    std::vector<TrajectoryPoint> points;
    std::vector<Touch> touches;
  };
  Own only;
  std::vector<std::unique_ptr<Own>> each;
};

// Returns the position of a contact at a time, by the interpolant between its knots.
double place_at(const std::vector<TrajectoryPoint>& points, double time) {
  const auto to = std::ranges::lower_bound(points, time, {}, &TrajectoryPoint::time);
  if (to == points.begin()) return to->position;
  const TrajectoryPoint &a = *(to - 1), &b = *to;
  if (!(b.time > a.time)) return b.position;
  return Quintic(a.time, a.position, a.velocity, a.acceleration, b.time, b.position, b.velocity, b.acceleration).position(time);
}

struct SampledOutcome {
  double first = never, from = never;
  int openings = 0;
};

TEST(ElectricalRecord, OfAConnectionAgreesWithTheCoursesOfItsContacts) {
  constexpr double sample = 5e-10;  // [s]
  Device device = test::gold_cantilever();
  device.electrodes[0].fringing = Fringing::none;
  device.gap.contact = 2_um;
  device.contacts = {{.model = LinearSpring{.stiffness = 2000, .damping = 20},
                      .pad_length = 5_um,
                      .name = "outer",
                      .at = Place(247.5_um),
                      .gap = 2_um,
                      .conduction = gold_metal},
                     {.model = LinearSpring{.stiffness = 2000, .damping = 20},
                      .pad_length = 5_um,
                      .name = "inner",
                      .at = Place(200_um),
                      .gap = 1.42_um,
                      .conduction = gold_metal}};
  int bounced = 0, lasting = 0;
  for (const Connection connection : {Connection::all, Connection::any}) {
    for (const ElectricalClosing& closing :
         {ElectricalClosing{.force = 4e-6}, ElectricalClosing{.resistance = 0.6}, ElectricalClosing{.after = 0}}) {
      SCOPED_TRACE(fmt::format("{} {} {}", name_of(connections, connection), closing.force, closing.resistance));
      device.connection = connection;
      device.electrical = closing;
      const Switch model(device);
      Courses courses(2);
      const Trajectory run =
          observe_closing(model, std::vector<Signal>{Signal::constant(20)}, {.duration = 300_us, .tolerance = 1e-8}, courses);
      ASSERT_EQ(run.status, Status::done) << run.message;
      std::vector<ContactResistance> resistances;
      for (const Contact& c : device.contacts) resistances.emplace_back(c, device.structure.width);
      SampledOutcome of[3];
      bool closed[3] = {};
      const auto samples = static_cast<int>(300_us / sample);
      for (int s = 0; s <= samples; ++s) {
        const double time = std::min(300_us, s * sample);
        double force[2], depth[2];
        std::vector<double> conductances;
        for (std::size_t c = 0; c < 2; ++c) {
          depth[c] = place_at(courses.each[c]->points, time) - model.contact_gap(c);
          const double before = place_at(courses.each[c]->points, time - sample / 2),
                       after = place_at(courses.each[c]->points, time + sample / 2);
          force[c] = depth[c] > 0 ? contact_force(model.contact(c), depth[c], true, (after - before) / sample) : 0;
          conductances.push_back(resistances[c].conductance(depth[c], force[c]));
        }
        const bool all = connection == Connection::all;
        const auto is_closed = [&](double own_depth, double own_force, double conductance) {
          if (closing.force >= 0) return own_force > closing.force;
          return closing.resistance > 0 ? conductance * closing.resistance > 1 : own_depth > 0;
        };
        const auto pick = [&](const double* two) { return all ? std::min(two[0], two[1]) : std::max(two[0], two[1]); };
        for (int i = 0; i < 3; ++i) {
          const bool now = i == 2 ? is_closed(pick(depth), pick(force), connection_conductance(device, conductances))
                                  : is_closed(depth[i], force[i], conductances[static_cast<std::size_t>(i)]);
          if (now && !closed[i]) {
            if (std::isnan(of[i].first)) of[i].first = time;
            of[i].from = time;
          }
          if (!now && closed[i]) ++of[i].openings;
          closed[i] = now;
        }
      }
      const ElectricalOutcome found[3] = {run.contacts[0].electrical, run.contacts[1].electrical, run.electrical};
      for (int i = 0; i < 3; ++i) {
        SCOPED_TRACE(i);
        EXPECT_EQ(found[i].openings, of[i].openings);
        bounced += found[i].openings > 0;
        if (std::isnan(of[i].first)) {
          EXPECT_TRUE(std::isnan(found[i].first_closed));
          continue;
        }
        EXPECT_NEAR(found[i].first_closed, of[i].first, 2 * sample);
        if (!closed[i]) {
          EXPECT_TRUE(std::isnan(found[i].closed_from));
          continue;
        }
        ++lasting;
        EXPECT_NEAR(found[i].closed_from, of[i].from, 2 * sample);
      }
    }
  }
  EXPECT_GE(bounced, 6);
  EXPECT_GE(lasting, 3);
}

// Holds under every law, also with memory or losses.
TEST(ElectricalRecord, OfTouchIsTheMechanicalOneUnderEveryLaw) {
  int several = 0;
  for (const Contact& contact : test::contacts()) {
    SCOPED_TRACE(test::described(contact));
    Device device = test::gold_cantilever();
    device.contacts = {contact};
    device.electrical = {.after = 0};
    const Switch model(device);
    if (model.contact_reach() > 0) continue;
    const std::vector<Signal> drives{Signal::constant(17.771)};
    const Trajectory t = simulate_closing(model, drives, {.duration = 150_us, .tolerance = 1e-7});
    ASSERT_EQ(t.status, Status::done) << t.message;
    EXPECT_NEAR(t.electrical.first_closed, t.touches.front().begin, 1e-13) << "[s]";
    EXPECT_EQ(t.electrical.openings + (std::isnan(t.electrical.closed_from) ? 0 : 1), static_cast<int>(t.touches.size()));
    if (std::isnan(t.touches.back().end)) {
      EXPECT_NEAR(t.electrical.closed_from, t.touches.back().begin, 1e-13) << "[s]";
    }
    several += t.touches.size() > 3;
    device.electrical = {};
    const Trajectory unasked = simulate_closing(Switch(device), drives, {.duration = 150_us, .tolerance = 1e-7});
    EXPECT_EQ(unasked.points.back().position, t.points.back().position) << "measuring changes nothing";
    EXPECT_EQ(unasked.work.steps, t.work.steps);
  }
  EXPECT_GE(several, 3);
}

// The force record finds the last time above a threshold independently.
TEST(ElectricalRecord, OfAForceEndsWhereTheForceIsSteady) {
  int steady = 0;
  std::vector<Contact> all = test::contacts();
  for (const Contact& padded : test::pad_contacts()) all.push_back(padded);
  for (const Contact& contact : all) {
    SCOPED_TRACE(test::described(contact));
    Device device = test::gold_cantilever();
    device.contacts = {contact};
    const std::vector<Signal> drives{signal(Pulse{.levels = {21_V, 0_V, 17_V}, .times = {20_us, 33_us}, .edge = 0.5_us})};
    const auto closed = closed_equilibrium(Switch(device), hold_levels(drives));
    for (const double share : {0.03, 0.1, 0.4}) {
      const double threshold = share * (closed ? closed->contact_force : 1e-6);
      device.electrical = {.force = threshold};
      const Trajectory t =
          simulate_closing(Switch(device), drives, {.duration = 150_us, .tolerance = 1e-7, .steady_force = threshold});
      ASSERT_EQ(t.status, Status::done) << t.message;
      EXPECT_EQ(std::isnan(t.electrical.closed_from), std::isnan(t.force.steady_force_time));
      if (std::isnan(t.force.steady_force_time)) continue;
      ++steady;
      EXPECT_NEAR(t.electrical.closed_from, t.force.steady_force_time, 1e-12) << "[s]";
    }
  }
  EXPECT_GE(steady, 5);
}

// The contact force of a plate at rest on a rigid contact has a closed form.
TEST(ElectricalRecord, FollowsAPlateThatRestsOnARigidContact) {
  constexpr double threshold = 20e-6;  // [N]
  LetGo plate;
  plate.device.contacts.front() = {.model = RigidStop{.restitution = 0}, .conduction = gold_metal};
  const Signal drive = Signal::piecewise_linear({{0, 45_V}, {100_us, 45_V}, {110_us, 30_V}, {120_us, 30_V}, {130_us, 45_V}});
  const double air = plate.device.gap.electrode - LetGo::gap;
  const double volts = air * std::sqrt(2 * (threshold + LetGo::stiffness * LetGo::gap) / (vacuum_permittivity * 1e-8));
  ASSERT_TRUE(volts > 30_V && volts < 45_V);
  const ContactResistance contact(plate.device.contacts.front(), plate.device.structure.width);
  for (const ElectricalClosing& closing :
       {ElectricalClosing{.force = threshold}, ElectricalClosing{.resistance = contact.resistance(0, threshold)}}) {
    plate.device.electrical = closing;
    const Trajectory t =
        simulate_closing(Switch(plate.device), std::vector<Signal>{drive}, {.duration = 200_us, .tolerance = 1e-9});
    ASSERT_EQ(t.status, Status::done) << t.message;
    ASSERT_EQ(t.touches.size(), 1u);
    EXPECT_EQ(t.electrical.first_closed, t.touches.front().begin);
    EXPECT_EQ(t.electrical.openings, 1);
    EXPECT_NEAR(t.electrical.closed_from, 120_us + 10_us * (volts - 30_V) / 15_V, 1e-13) << "[s]";
  }
}

}  // namespace
}  // namespace softland
