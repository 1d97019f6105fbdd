// Switches with several contacts against values of an independent program (Hermite elements, located events) and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "integrators/quintic.h"
#include "model/closing.h"
#include "model/pull_in.h"
#include "objectives/metrics.h"
#include "tests/model/expect_refused.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

// Records the figures of the connection and of each contact.
class EachContact final : public ClosingObserver {
 public:
  explicit EachContact(const Switch& model) : connection(model.contact_gap()) {
    for (std::size_t c = 0; c < model.contacts(); ++c) contacts.push_back(std::make_unique<Own>(model.contact_gap(c)));
  }
  void knot(const TrajectoryPoint& p) override {
    connection.knot(p);
    points.push_back(p);
  }
  void touch(const Touch& t) override {
    connection.touch(t);
    touches.push_back(t);
  }
  ClosingObserver* contact(std::size_t c) override { return contacts[c].get(); }

  struct Own final : ClosingObserver {
    explicit Own(double gap) : figures(gap), plane(gap) {}
    void knot(const TrajectoryPoint& p) override {
      figures.knot(p);
      points.push_back(p);
    }
    void touch(const Touch& t) override {
      figures.touch(t);
      touches.push_back(t);
    }
    MetricsObserver figures;
    double plane;
    std::vector<TrajectoryPoint> points;
    std::vector<Touch> touches;
  };
  MetricsObserver connection;
  std::vector<TrajectoryPoint> points;
  std::vector<Touch> touches;
  std::vector<std::unique_ptr<Own>> contacts;
};

Contact spring(const char* name, double at, double gap, double stiffness) {
  return {.model = LinearSpring{.stiffness = stiffness}, .pad_length = 5_um, .name = name, .at = Place(at), .gap = gap};
}

Device cantilever(std::vector<Contact> contacts, int modes) {
  Device d = test::gold_cantilever();
  d.structure.modes = modes;
  d.gap.contact = contacts.front().gap;
  d.electrodes[0].fringing = Fringing::none;
  d.gas.reset();
  d.contacts = std::move(contacts);
  return d;
}

struct ObservedRun {
  ObservedRun(const Device& device, double volts, double duration, double tolerance = 1e-9)
      : model(device),
        each(model),
        end(observe_closing(model, std::vector<Signal>{Signal::constant(volts)}, {.duration = duration, .tolerance = tolerance},
                            each)) {}
  // Returns the figures of one contact.
  Metrics of(std::size_t c) { return each.contacts[c]->figures.metrics(end_of(c)); }
  Trajectory end_of(std::size_t) {
    Trajectory own = end;
    own.contacts.clear();
    return own;
  }
  [[nodiscard]] std::vector<Rebound> rebounds_of(std::size_t c) const {
    Trajectory own;
    own.contact_gap = model.contact_gap(c);
    own.points = each.contacts[c]->points;
    return rebounds(own);
  }
  Switch model;
  EachContact each;
  Trajectory end;
};

void expect_near(double value, double kept, double relative, const char* what) {
  EXPECT_NEAR(value, kept, relative * std::abs(kept)) << what;
}

TEST(SeveralContacts, ATipAndAnInnerContactAgreeWithAnIndependentProgram) {
  struct Row {
    int modes;
    double outer_time, outer_speed, inner_time, inner_speed, time_within, speed_within;
  };
  for (const Row& row :
       {Row{4, 2.9561661381597896e-05, 0.13112502005710247, 2.853372965481327e-05, 0.06913963472815787, 1e-5, 1e-5},
        Row{8, 2.9631814921507792e-05, 0.1450499799368776, 2.8534518589626938e-05, 0.06916521241577067, 2e-5, 1e-4},
        Row{16, 2.9625474403137405e-05, 0.13897917959966413, 2.853444677424049e-05, 0.06917571183799635, 2e-5, 1e-4}}) {
    ObservedRun run(cantilever({spring("tip", 247.5_um, 2_um, 2000), spring("inner", 175_um, 1.1_um, 2000)}, row.modes), 20,
                    60e-6);
    ASSERT_EQ(run.end.status, Status::done) << run.end.message;
    const Metrics outer = run.of(0), inner = run.of(1), both = run.each.connection.metrics(run.end);
    expect_near(outer.initial_contact_time, row.outer_time, row.time_within, "time of the outer contact");
    expect_near(outer.impact_velocity, row.outer_speed, row.speed_within, "speed of the outer contact");
    expect_near(inner.initial_contact_time, row.inner_time, row.time_within, "time of the inner contact");
    expect_near(inner.impact_velocity, row.inner_speed, row.speed_within, "speed of the inner contact");
    EXPECT_EQ(both.initial_contact_time, inner.initial_contact_time) << "the first touch of any is that of the connection";
    EXPECT_EQ(both.impact_velocity, inner.impact_velocity);
  }
}

TEST(SeveralContacts, FirstReboundsAndDepthsAgreeWithAnIndependentProgram) {
  ObservedRun run(cantilever({spring("tip", 247.5_um, 2_um, 2000), spring("inner", 175_um, 1.1_um, 2000)}, 4), 20, 80e-6, 1e-10);
  expect_near(run.rebounds_of(0).front().height, 1.0355785620381237e-06, 1e-5, "first rebound of the outer contact");
  expect_near(run.rebounds_of(1).front().height, 2.5420132006770673e-08, 1e-5, "first rebound of the inner contact");
  ASSERT_EQ(run.end.contacts.size(), 2u);
  expect_near(run.end.contacts[0].deepest_penetration, 9.69770847910643e-09, 1e-5, "depth of the outer contact");
  expect_near(run.end.contacts[1].deepest_penetration, 1.0629444778126158e-08, 1e-5, "depth of the inner contact");
  EXPECT_EQ(run.end.contacts[0].name, "tip");
  EXPECT_EQ(run.end.deepest_penetration, run.end.contacts[1].deepest_penetration);
  EXPECT_LT(run.end.energy_error, 1e-6 * run.model.bending_energy());
}

// A connection that needs all contacts has the largest of their separations; one that needs any contact has the smallest.
TEST(SeveralContacts, TheSeparationIsTheLargestOrTheSmallestOfTheContacts) {
  const std::vector<Contact> apart{spring("tip", 247.5_um, 2_um, 2000), spring("inner", 175_um, 1.1_um, 2000)},
      dimples{spring("high", 247.5_um, 2_um, 1000), spring("low", 242.5_um, 1.97_um, 1000)};
  for (const auto& [contacts, needs] :
       {std::pair(dimples, Connection::all), {dimples, Connection::any}, {apart, Connection::any}}) {
    Device device = cantilever(contacts, 4);
    device.connection = needs;
    ObservedRun run(device, 20, 150e-6);
    const auto separation = [&](std::size_t c, double time) {
      const std::vector<TrajectoryPoint>& points = run.each.contacts[c]->points;
      auto to = std::ranges::lower_bound(points, time, {}, &TrajectoryPoint::time);
      if (to->time == time) return run.model.contact_gap(c) - to->position;
      const auto from = std::prev(to);
      const Quintic curve(from->time, from->position, from->velocity, from->acceleration, to->time, to->position, to->velocity,
                          to->acceleration);
      return run.model.contact_gap(c) - curve.position(time);
    };
    for (const TrajectoryPoint& p : run.each.points) {
      const double a = separation(0, p.time), b = separation(1, p.time);
      const double expected = needs == Connection::all ? std::max(a, b) : std::min(a, b);
      EXPECT_NEAR(run.model.contact_gap() - p.position, expected, 1e-13) << p.time;
    }
    ASSERT_GT(run.each.points.size(), 100u);
    // Every touch of the connection begins and ends at zero separation.
    ASSERT_FALSE(run.each.touches.empty());
    for (const Touch& t : run.each.touches) {
      const auto on_plane = [&](double time) { return std::min(std::abs(separation(0, time)), std::abs(separation(1, time))); };
      EXPECT_LT(on_plane(t.begin), 1e-15) << t.begin;
      if (!std::isnan(t.end)) {
        EXPECT_LT(on_plane(t.end), 1e-15) << t.end;
      }
    }
  }
}

TEST(SeveralContacts, TwoDimplesOfUnequalHeightShareTheImpact) {
  ObservedRun run(cantilever({spring("high", 247.5_um, 2_um, 1000), spring("low", 247.5_um, 2.005_um, 1000)}, 4), 20, 60e-6);
  const Metrics first = run.of(0), second = run.of(1);
  expect_near(first.initial_contact_time, 2.9915755653061727e-05, 1e-5, "time of the first");
  expect_near(first.impact_velocity, 0.13034344896132866, 1e-5, "speed of the first");
  expect_near(second.initial_contact_time, 2.995482072444361e-05, 1e-5, "time of the second");
  expect_near(second.impact_velocity, 0.12326065267964137, 1e-5, "speed of the second");
  expect_near(run.rebounds_of(0).front().height, 5.7910299649032405e-08, 1e-5, "first rebound of the first");
}

// The pull-in is that of the first contact, whichever contacts make the connection.
TEST(SeveralContacts, DynamicPullInIsThatOfTheFirstContact) {
  const std::vector<Contact> dimples{spring("high", 247.5_um, 2_um, 1000), spring("low", 247.5_um, 2.005_um, 1000)};
  const auto pull_in = [](const Device& device) {
    const Switch model(device);
    return dynamic_pull_in(model, 0, static_pull_in(model, 0)).voltage;
  };
  const double alone = pull_in(cantilever({dimples.front()}, 2));
  for (const Connection needs : {Connection::all, Connection::any}) {
    Device device = cantilever(dimples, 2);
    device.connection = needs;
    EXPECT_NEAR(pull_in(device), alone, 2 * dynamic_pull_in_precision * alone);
  }
}

TEST(SeveralContacts, FirstClosingIsThatOfTheConnection) {
  for (const Connection needs : {Connection::all, Connection::any}) {
    Device device = cantilever({spring("high", 247.5_um, 2_um, 1000), spring("low", 247.5_um, 2.005_um, 1000)}, 2);
    device.connection = needs;
    const Switch model(device);
    const std::vector<Signal> step{Signal::constant(20)};
    const ClosingOptions options{.duration = 60e-6, .tolerance = 1e-9};
    EXPECT_EQ(first_closing(model, step, options), simulate_closing(model, step, options).touches.front().begin);
    EXPECT_TRUE(std::isnan(first_closing(model, std::vector<Signal>{Signal::constant(1)}, options)));
  }
}

// Two equal contacts at one place act like one of twice the stiffness.
TEST(SeveralContacts, CountIsTheNumberOfEqualContacts) {
  Contact both = spring("both", 247.5_um, 2_um, 1000);
  both.count = 2;
  const Trajectory two = ObservedRun(cantilever({both}, 4), 20, 60e-6).end,
                   one = ObservedRun(cantilever({spring("one", 247.5_um, 2_um, 2000)}, 4), 20, 60e-6).end;
  EXPECT_EQ(two.deepest_penetration, one.deepest_penetration);
  EXPECT_EQ(two.energy.source_work, one.energy.source_work);
}

// A released plate moves through its rest position to the back stop, in closed form.
TEST(SeveralContacts, ABackStopCatchesAReleasedPlate) {
  Device device{
      .structure = {.length = 100_um, .width = 100_um, .kind = Plate{.mass = 1e-10, .stiffness = 10}},
      .gap = {.electrode = 4_um, .contact = 3_um},
      .electrodes = {{.name = "main", .begin = 0, .end = 100_um, .fringing = Fringing::none}},
      .contacts = {Contact{.model = LinearSpring{.stiffness = 5000}, .name = "main"},
                   Contact{.model = LinearSpring{.stiffness = 2000}, .name = "stop", .gap = 0.5_um, .side = Side::far}}};
  device.contacts[1].connects = false;
  const Switch model(device);
  const std::optional<ClosedEquilibrium> closed = closed_equilibrium(model, std::vector<double>{40});
  ASSERT_TRUE(closed);
  expect_near(model.contact_deflection(closed->q.data()), 3.0083906816728477e-06, 1e-8, "closed place");
  expect_near(closed->contact_force, 4.195340836423788e-05, 1e-7, "hold force");
  EachContact each(model);
  const Trajectory run = observe_closing(model, std::vector<Signal>{Signal::constant(0)},
                                         {.duration = 12e-6, .tolerance = 1e-10, .begins_closed = closed->coordinates()}, each);
  ASSERT_EQ(run.status, Status::done) << run.message;
  ASSERT_EQ(each.contacts[0]->touches.size(), 2u);
  expect_near(each.contacts[0]->touches[0].end, 1.6123714092547125e-07, 1e-8, "time to leave");
  ASSERT_EQ(each.contacts[1]->touches.size(), 1u);
  const Touch& stop = each.contacts[1]->touches[0];
  expect_near(stop.begin, 5.348066617138064e-06, 1e-8, "time to the back stop");
  expect_near(stop.impact_velocity, 0.9399795882381463, 1e-8, "speed there");
  expect_near(stop.peak_force, 0.00041437903540348975, 1e-7, "force there");
  expect_near(stop.end - stop.begin, 6.954392757572174e-07, 1e-7, "time on the back stop");
  expect_near(run.contacts[1].deepest_penetration, 2.0718951770174487e-07, 1e-7, "depth there");
  expect_near(each.contacts[0]->touches[1].begin, 1.1230335369107874e-05, 1e-7, "time of the return");
}

// Two contacts and a back stop, all in touch or within reach, two of them damped.
Device three_contacts() {
  Device device = cantilever(
      {spring("tip", 247.5_um, 2_um, 2000), spring("inner", 175_um, 1.1_um, 3000), spring("stop", 200_um, 0.2_um, 1500)}, 4);
  std::get<LinearSpring>(device.contacts[0].model).damping = 0.3;
  std::get<LinearSpring>(device.contacts[2].model).damping = 0.7;
  device.contacts[2].side = Side::far;
  device.contacts[2].connects = false;
  return device;
}

TEST(SeveralContacts, ForcesHaveTheirPotentialAndDerivatives) {
  const Switch model(three_contacts());
  Switch::Workspace work = model.workspace();
  const std::vector<double> volts{12};
  const Eigen::Index n = model.modes();
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(n);
  int touching = 0;
  for (const double place : {1.7e-6, 2.02e-6, -0.4e-6}) {
    // A shape that does not bring all contacts into touch together.
    Eigen::VectorXd q = Eigen::VectorXd::Unit(n, 0) * (place / model.contact_shape()[0]);
    q[1] = 0.01 * q[0];
    Eigen::VectorXd v(n), force(n), damped(n);
    for (Eigen::Index i = 0; i < n; ++i) v[i] = 1e-7 * static_cast<double>(i + 1);
    for (std::size_t c = 0; c < 3; ++c) touching += model.contact_deflection(q.data(), c) > model.contact_gap(c);
    model.accelerations(q.data(), still.data(), volts, true, work, force.data());
    Eigen::MatrixXd by_q(n, n), by_v(n, n);
    model.accelerations(q.data(), v.data(), volts, true, work, damped.data());
    model.jacobian(q.data(), v.data(), volts, true, work, by_q, by_v);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double h = 1e-5 * q.cwiseAbs().maxCoeff(), dv = 1e-5 * v.cwiseAbs().maxCoeff();
      const auto moved = [&](double by) { return (q + by * Eigen::VectorXd::Unit(n, i)).eval(); };
      const double slope =
          (model.potential(moved(h).data(), volts, true, work) - model.potential(moved(-h).data(), volts, true, work)) / (2 * h);
      EXPECT_NEAR(force[i], -slope, 1e-6 * force.cwiseAbs().maxCoeff()) << place << " " << i;
      Eigen::VectorXd more(n), less(n);
      model.accelerations(moved(h).data(), v.data(), volts, true, work, more.data());
      model.accelerations(moved(-h).data(), v.data(), volts, true, work, less.data());
      EXPECT_LT(((more - less) / (2 * h) - by_q.col(i)).cwiseAbs().maxCoeff(), 1e-6 * by_q.cwiseAbs().maxCoeff()) << place;
      const Eigen::VectorXd faster = v + dv * Eigen::VectorXd::Unit(n, i), slower = v - dv * Eigen::VectorXd::Unit(n, i);
      model.accelerations(q.data(), faster.data(), volts, true, work, more.data());
      model.accelerations(q.data(), slower.data(), volts, true, work, less.data());
      EXPECT_LT(((more - less) / (2 * dv) - by_v.col(i)).cwiseAbs().maxCoeff(),
                1e-6 * by_v.cwiseAbs().maxCoeff() + 1e-9 * model.basis().angular_frequencies()[0])
          << place;
    }
  }
  EXPECT_GE(touching, 3) << "each contact acts in one of the places";
}

TEST(SeveralContacts, EnergiesBalanceWithDamping) {
  Device device = three_contacts();
  ObservedRun run(device, 20, 200e-6);
  ASSERT_EQ(run.end.status, Status::done) << run.end.message;
  EXPECT_GE(run.each.contacts[0]->touches.size(), 1u);
  EXPECT_GT(run.each.contacts[1]->touches.size(), 1u);
  EXPECT_GT(run.end.energy.dissipated, 1e-3 * run.model.bending_energy());
  EXPECT_LT(run.end.energy_error, 1e-5 * run.model.bending_energy());
}

TEST(SeveralContacts, RefusesWhatCannotStandTogether) {
  const auto refused = [](auto change, const std::string& message) {
    Device device = three_contacts();
    change(device);
    test::expect_refused([&] { validate(device); }, message);
  };
  refused(
      [](Device& d) {
        d.contacts[1].at = d.contacts[0].at;
        d.contacts[1].gap = d.gap.contact;
      },
      "contact.inner: stands at the place of contact.tip, with the same gap: one contact with count = 2 says the same");
  refused([](Device& d) { std::swap(d.contacts[1], d.contacts[2]); },
          "contact.inner: the contacts of the near side must come first");
  refused([](Device& d) { std::swap(d.contacts[0], d.contacts[2]); },
          "contact.stop: a back stop closes nothing: a contact of side = \"near\" is missing");
  refused([](Device& d) { d.contacts[1].gap = 3.6_um; }, "contact.inner.gap = 3.6 um: must be below gap.electrode = 3.5 um");
  refused([](Device& d) { d.contacts[2].at = Place(251_um); },
          "contact.stop.at = 251 um: must lie on the beam, whose length is 250 um");
  refused([](Device& d) { d.contacts[1].count = 1.5; }, "contact.inner.count = 1.5: must be a whole number from 1 on");
}

}  // namespace
}  // namespace softland
