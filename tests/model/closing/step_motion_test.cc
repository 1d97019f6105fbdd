// A step between two knots: its interpolation, its events, and the touches that follow from them.
#include "model/closing/step_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/closing/events.h"
#include "model/closing/pending_knots.h"
#include "model/closing/touch_record.h"
#include "model/contact/contact_law.h"
#include "tests/model/gold.h"

namespace softland {
namespace {

using namespace literals;
using test::gold;

// Modes with the initial velocities `kick` under constant forces whose equilibrium is `pull`.
struct Swing {
  std::vector<double> pull, kick;

  [[nodiscard]] Knot at(double t) const {
    const std::size_t n = pull.size();
    Knot knot{.time = t, .state = std::vector<double>(2 * n), .rates = std::vector<double>(n)};
    for (std::size_t i = 0; i < n; ++i) {
      const double w = gold().basis().angular_frequencies()[static_cast<Eigen::Index>(i)];
      knot.state[i] = pull[i] * (1 - std::cos(w * t)) + kick[i] / w * std::sin(w * t);
      knot.state[n + i] = w * pull[i] * std::sin(w * t) + kick[i] * std::cos(w * t);
      knot.rates[i] = w * w * pull[i] * std::cos(w * t) - w * kick[i] * std::sin(w * t);
    }
    return knot;
  }
};

Swing swing() {
  const Eigen::VectorXd& w = gold().basis().angular_frequencies();
  return {.pull = {1e-12, 2e-14, -3e-15, 1e-15}, .kick = {1e-13 * w[0], -1e-14 * w[1], 1e-15 * w[2], 1e-15 * w[3]}};
}

TrajectoryPoint tip(const Knot& knot) {
  const double* q = knot.state.data();
  return {.time = knot.time,
          .position = gold().contact_deflection(q),
          .velocity = gold().contact_deflection(q + gold().modes()),
          .acceleration = gold().contact_deflection(knot.rates.data())};
}

double length_of_phase(double phase) { return phase / gold().basis().angular_frequencies().maxCoeff(); }

TEST(StepMotion, IsExactForModesUnderConstantForces) {
  const Swing modes = swing();
  StepMotion motion(gold(), 1e-8);
  const double h = length_of_phase(1.9);
  const Knot begin = modes.at(0), end = modes.at(h);
  motion.set(begin, end, tip(end), true);
  ASSERT_TRUE(motion.moves_by_modes());
  ASSERT_GT(motion.pieces(), 3);
  for (int k = 1; k < motion.pieces(); ++k) {
    const TrajectoryPoint exact = tip(modes.at(h * k / motion.pieces()));
    EXPECT_NEAR(motion.knot(k).position, exact.position, 1e-12 * std::abs(tip(end).position));
    EXPECT_NEAR(motion.knot(k).velocity, exact.velocity, 1e-9 * std::abs(tip(end).velocity));
  }
  for (const double share : {0.1, 0.28, 0.72, 0.99}) {
    const Knot exact = modes.at(share * h);
    EXPECT_NEAR(motion.at(share * h).position, tip(exact).position, 1e-12 * std::abs(tip(end).position));
    const std::vector<double>& state = motion.state_at(share);
    for (std::size_t i = 0; i < state.size(); ++i) EXPECT_NEAR(state[i], exact.state[i], 1e-9 * std::abs(end.state[i]) + 1e-24);
  }
}

TEST(StepMotion, HalfwayIsOfSixthAndFourthOrder) {
  const Swing modes = swing();
  StepMotion motion(gold(), 1e-8);
  const double middle = length_of_phase(1);
  // Returns the error of the fastest mode in steps around one instant.
  const auto error = [&](double h, bool accurate_rates) {
    const Knot begin = modes.at(middle - h / 2), end = modes.at(middle + h / 2);
    motion.set(begin, end, tip(end), accurate_rates);
    const auto fastest = static_cast<std::size_t>(gold().modes()) - 1;
    return std::abs(motion.halfway()[fastest] - modes.at(middle).state[fastest]);
  };
  const double h = length_of_phase(1);
  EXPECT_NEAR(std::log2(error(h, true) / error(h / 2, true)), 6, 0.1);
  EXPECT_NEAR(std::log2(error(h, false) / error(h / 2, false)), 4, 0.1);
}

TEST(StepMotion, TakesLongStepsForOneHermitePiece) {
  const Swing modes = swing();
  StepMotion motion(gold(), 1e-8);
  const Knot begin = modes.at(0), end = modes.at(length_of_phase(30));
  motion.set(begin, end, tip(end), false);
  EXPECT_FALSE(motion.moves_by_modes());
  EXPECT_EQ(motion.pieces(), 1);
}

// ---- events, on one quintic

constexpr double swing_plane = 2_um;

class Events : public ::testing::Test {
 protected:
  // Finds the event in a long step, within which only the quintic gives the contact point.
  [[nodiscard]] std::optional<Event> event(const TrajectoryPoint& from, const TrajectoryPoint& to, const ContactPhase& phase) {
    const std::size_t n = static_cast<std::size_t>(gold().modes());
    begin_ = {.time = from.time, .state = std::vector<double>(2 * n), .rates = std::vector<double>(n)};
    end_ = begin_;
    end_.time = to.time;
    motion_.set(begin_, end_, to, true);
    return first_event(TipMotion(motion_, from, to), from, to, phase);
  }

  StepMotion motion_{gold(), 1e-8};
  Knot begin_, end_;
};

// p(t) = peak - a (t - middle)^2 / 2
TrajectoryPoint on_parabola(double peak, double a, double middle, double t) {
  const double x = t - middle;
  return {.time = t, .position = peak - a * x * x / 2, .velocity = -a * x, .acceleration = -a};
}

constexpr double a = 1e4, span = 20e-6;  // half of this time deepens the contact by 0.5 um

TEST_F(Events, FindAGrazingTouchBetweenTwoKnots) {
  const ContactPhase phase(gold());
  for (const double depth : {1e-9, 1e-12, 1e-14}) {
    const double middle = 0.4 * span;
    const auto found =
        event(on_parabola(swing_plane + depth, a, middle, 0), on_parabola(swing_plane + depth, a, middle, span), phase);
    ASSERT_TRUE(found) << depth;
    EXPECT_NEAR(found->time, middle - std::sqrt(2 * depth / a), 1e-4 * span);
    EXPECT_EQ(found->edge->next, Phase::loading);
  }
  const auto missed =
      event(on_parabola(swing_plane - 1e-12, a, span / 2, 0), on_parabola(swing_plane - 1e-12, a, span / 2, span), phase);
  EXPECT_FALSE(missed);
}

TEST_F(Events, TakeTheFirstOfTwo) {
  const Switch model = [] {
    Device device = test::gold_cantilever();
    device.contacts.front().model = HystereticSpring{.stiffness = 1e4, .unloading_stiffness = 4e4};
    return Switch(device);
  }();
  ContactPhase phase(model);
  phase.enter(Phase::loading);
  phase.turn(20_nm);  // the dent is 15 nm deep
  // The motion first deepens the dent, then leaves the contact through it.
  const double middle = span / 2;
  const auto deeper = event(on_parabola(swing_plane + 100_nm, a, middle, middle - 4.2e-6),
                            on_parabola(swing_plane + 100_nm, a, middle, span), phase);
  ASSERT_TRUE(deeper);
  EXPECT_EQ(deeper->edge->next, Phase::loading);
  EXPECT_NEAR(deeper->time, middle - std::sqrt(2 * 80e-9 / a), 1e-12);
  const auto out =
      event(on_parabola(swing_plane + 18_nm, a, middle, middle), on_parabola(swing_plane + 18_nm, a, middle, span), phase);
  ASSERT_TRUE(out);
  EXPECT_EQ(out->edge->next, Phase::dent);
  EXPECT_NEAR(out->time, middle + std::sqrt(2 * 3e-9 / a), 1e-12);
  // While loading, the motion turns back at the deepest point, which is no edge.
  phase.enter(Phase::loading);
  const auto turn = event(on_parabola(swing_plane + 100_nm, a, middle, middle - 4e-6),
                          on_parabola(swing_plane + 100_nm, a, middle, span), phase);
  ASSERT_TRUE(turn);
  EXPECT_FALSE(turn->edge);
  EXPECT_NEAR(turn->time, middle, 1e-12);
}

// ---- the record of touches, and the course

class Listener final : public ClosingObserver {
 public:
  void knot(const TrajectoryPoint& p) override { times.push_back(p.time); }
  void touch(const Touch& t) override { touches.push_back(t); }
  std::vector<double> times;
  std::vector<Touch> touches;
};

TEST(TouchRecord, HandsOverEveryTouchOnce) {
  Listener listener;
  ContactPhase phase(gold());
  TouchRecord record(gold(), 0, phase, listener);
  const Edge in = phase.edges()[0];
  EXPECT_TRUE(record.note({.time = 1, .edge = in}, {.time = 1, .position = swing_plane, .velocity = 0.1}));
  phase.enter(Phase::loading);
  const Edge out = phase.edges()[0];
  EXPECT_TRUE(listener.touches.empty()) << "it is under way";
  EXPECT_FALSE(record.note({.time = 2, .edge = out}, {.time = 2, .position = swing_plane, .velocity = -0.1}));
  phase.enter(Phase::flight);
  EXPECT_TRUE(record.note({.time = 3, .edge = in}, {.time = 3, .position = swing_plane, .velocity = 0.05}));
  ASSERT_EQ(listener.touches.size(), 1u);
  EXPECT_EQ(listener.touches[0].begin, 1);
  EXPECT_EQ(listener.touches[0].end, 2);
  EXPECT_EQ(listener.touches[0].impact_velocity, 0.1);
  record.finish();
  ASSERT_EQ(listener.touches.size(), 2u);
  EXPECT_TRUE(std::isnan(listener.touches[1].end));
  EXPECT_EQ(record.count(), 2);
  EXPECT_EQ(record.first_begin(), 1);
}

TEST(TouchRecord, TakesThePeakBetweenTheKnots) {
  Listener listener;
  ContactPhase phase(gold());
  TouchRecord record(gold(), 0, phase, listener);
  StepMotion motion(gold(), 1e-8);
  const std::size_t n = static_cast<std::size_t>(gold().modes());
  const Knot begin{.time = 0, .state = std::vector<double>(2 * n), .rates = std::vector<double>(n)};
  Knot end = begin;
  end.time = span;
  const TrajectoryPoint from = on_parabola(swing_plane + 5_nm, a, 0.3 * span, 0.29 * span),
                        to = on_parabola(swing_plane + 5_nm, a, 0.3 * span, span);
  motion.set(begin, end, to, true);
  const TipMotion piece(motion, from, to);
  record.take(piece, from, to);
  EXPECT_EQ(record.deepest_penetration(), 0) << "in flight nothing is taken";
  static_cast<void>(record.note({.time = 0.29 * span, .edge = phase.edges()[0]}, from));
  phase.enter(Phase::loading);
  record.take(piece, from, to);
  EXPECT_NEAR(record.deepest_penetration(), 5_nm, 1e-15);
  EXPECT_NEAR(record.last().peak_force, contact_force(gold().contact(), 5_nm), 1e-5 * record.last().peak_force);
  EXPECT_NEAR(record.last().peak_energy, contact_energy(gold().contact(), 5_nm), 1e-5 * record.last().peak_energy);
}

TEST(PendingKnots, HandsOverInOrderAndTakesBackWhatAnEventOvertook) {
  Listener listener;
  PendingKnots pending_knots(gold().device(), 0, listener);
  pending_knots.push({.time = 0});
  pending_knots.hand_over();
  for (const double t : {1.0, 2.0, 3.0}) pending_knots.push({.time = t});
  pending_knots.take_back(2, 0);
  EXPECT_EQ(pending_knots.last().time, 1);
  pending_knots.take_back(0, 1);
  EXPECT_EQ(pending_knots.last().time, 1) << "where the step begins stays";
  pending_knots.push({.time = 1.5});
  pending_knots.last_waiting().time = 1.6;
  pending_knots.hand_over();
  EXPECT_EQ(listener.times, (std::vector{0.0, 1.0, 1.6}));
  EXPECT_EQ(pending_knots.last().time, 1.6);
}

}  // namespace
}  // namespace softland
