#include "objectives/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/literals.h"
#include "tests/support/not_finite.h"

namespace softland {
namespace {

using namespace literals;

constexpr double kGap = 2e-6;
// Positions and times have the rounding of 2 um and of the window. Every figure that the interpolant reproduces exactly agrees
// within this, relative to the largest number in it.
constexpr double kRounding = 1e-12;

/// A ball that falls on the contact with constant acceleration and keeps the share e of its speed at every impact.
struct BouncingBall {
  double first_height = kGap;  // [m]
  double acceleration = 1e4;   // [m/s^2]
  double restitution = 0.5;

  [[nodiscard]] double impact_speed(int n) const { return std::sqrt(2 * acceleration * first_height) * std::pow(restitution, n); }
  [[nodiscard]] double height(int n) const { return first_height * std::pow(restitution, 2 * n); }
  [[nodiscard]] double first_impact() const { return std::sqrt(2 * first_height / acceleration); }
  /// Returns the beginning of flight n = 1, 2 ... [s].
  [[nodiscard]] double impact(int n) const {
    double time = first_impact();
    for (int k = 1; k < n; ++k) time += 2 * impact_speed(k) / acceleration;
    return time;
  }

  /// Falls, has `flights` rebounds, then rests until `end`. Knots are at impacts, and `inside` further ones in every flight,
  /// none of them at a top.
  [[nodiscard]] Trajectory trajectory(int flights, double end, int inside = 0) const {
    Trajectory result{.status = Status::done, .contact_gap = kGap};
    result.in_contact_period = 1_us;
    const auto fly = [&](double from, double height_0, double speed_up, double duration) {
      for (int i = 0; i <= inside + 1; ++i) {
        // Unequal distances, so that no knot is at a top.
        const double t = duration * std::pow(static_cast<double>(i) / (inside + 1), 1.3);
        const double height = i > inside && speed_up > 0 ? 0 : height_0 + speed_up * t - 0.5 * acceleration * t * t;
        result.points.push_back(
            {.time = from + t, .position = kGap - height, .velocity = acceleration * t - speed_up, .acceleration = acceleration});
      }
    };
    fly(0, first_height, 0, first_impact());
    for (int n = 1; n <= flights; ++n) fly(impact(n), 0, impact_speed(n), 2 * impact_speed(n) / acceleration);
    const double rest = impact(flights + 1);
    result.points.push_back({.time = rest, .position = kGap});
    if (end > rest) result.points.push_back({.time = end, .position = kGap});
    return result;
  }
};

/// Returns knots of a smooth function with two derivatives, at `count` + 1 equally spaced times.
template <typename Function>
Trajectory sampled(Function function, double end, int count) {
  Trajectory result{.status = Status::done, .contact_gap = kGap};
  result.in_contact_period = 0;
  for (int i = 0; i <= count; ++i) {
    const double t = end * i / count;
    const auto [position, velocity, acceleration] = function(t);
    result.points.push_back({.time = t, .position = position, .velocity = velocity, .acceleration = acceleration});
  }
  return result;
}

TEST(Metrics, BouncingBallHasTheHeightsOfAGeometricSeries) {
  const BouncingBall ball;
  for (const int inside : {0, 3}) {
    constexpr int flights = 6;
    const auto found = rebounds(ball.trajectory(flights, 1_ms, inside));
    ASSERT_EQ(found.size(), static_cast<std::size_t>(flights));
    for (int n = 1; n <= flights; ++n) {
      const Rebound& rebound = found[static_cast<std::size_t>(n - 1)];
      EXPECT_NEAR(rebound.height, ball.height(n), kRounding * kGap) << "flight " << n;
      EXPECT_NEAR(rebound.begin, ball.impact(n), kRounding * ball.impact(n)) << "flight " << n;
      EXPECT_NEAR(rebound.end, ball.impact(n + 1), kRounding * ball.impact(n)) << "flight " << n;
      // The top is flat: its time is the root of a velocity with a rounding of 1e-16 of the impact velocity, times the flight.
      EXPECT_NEAR(rebound.time_of_height, 0.5 * (rebound.begin + rebound.end), kRounding * ball.impact(n)) << "flight " << n;
    }
  }
}

TEST(Metrics, BouncingBallGivesEveryFigureInClosedForm) {
  const BouncingBall ball;
  Trajectory trajectory = ball.trajectory(6, 1_ms, 2);
  trajectory.energy.source_work = 3e-12;
  trajectory.hold_force = 4e-6;
  const Metrics m = metrics(trajectory);
  EXPECT_EQ(m.status, Status::done);
  EXPECT_TRUE(m.settled);
  EXPECT_NEAR(m.initial_contact_time, ball.first_impact(), kRounding * ball.first_impact());
  EXPECT_NEAR(m.impact_velocity, ball.impact_speed(0), kRounding * ball.impact_speed(0));
  EXPECT_NEAR(m.major_bounce_height, kGap / 4, kRounding * kGap);
  // Heights 500, 125, 31.25, 7.8, 1.95, 0.49 nm: five of them above 1 nm.
  EXPECT_EQ(m.bounce_count, 5);
  EXPECT_NEAR(m.permanent_contact_time, ball.impact(6), kRounding * ball.impact(6));
  EXPECT_NEAR(m.bounce_time, ball.impact(6) - ball.first_impact(), kRounding * ball.impact(6));
  EXPECT_EQ(m.drive_energy, 3e-12);
  EXPECT_EQ(m.hold_force, 4e-6);
  EXPECT_TRUE(std::isnan(m.peak_contact_force)) << "no touch was recorded";
}

TEST(Metrics, SignificantReboundDecidesCountAndPermanentContact) {
  const BouncingBall ball;
  const Trajectory trajectory = ball.trajectory(6, 1_ms);
  const Metrics coarse = metrics(trajectory, {.significant_rebound = 100_nm});
  EXPECT_EQ(coarse.bounce_count, 2);
  EXPECT_NEAR(coarse.permanent_contact_time, ball.impact(3), kRounding * ball.impact(3));
  const Metrics fine = metrics(trajectory, {.significant_rebound = 0});
  EXPECT_EQ(fine.bounce_count, 6);
  const Metrics blind = metrics(trajectory, {.significant_rebound = 1_um});
  EXPECT_EQ(blind.bounce_count, 0);
  EXPECT_TRUE(blind.settled);
  EXPECT_EQ(blind.permanent_contact_time, blind.initial_contact_time);
  EXPECT_EQ(blind.bounce_time, 0);
  EXPECT_EQ(blind.major_bounce_height, coarse.major_bounce_height) << "the highest rebound, significant or not";
  // A rebound exactly as high as the threshold does not exceed it.
  const double second = rebounds(trajectory)[1].height;
  EXPECT_EQ(metrics(trajectory, {.significant_rebound = second}).bounce_count, 1);
}

TEST(Metrics, SettlesOneInContactPeriodAfterTheLastSignificantRebound) {
  const BouncingBall ball;
  const double landed = ball.impact(6);
  Trajectory trajectory = ball.trajectory(5, landed + 1_us);
  trajectory.in_contact_period = trajectory.points.back().time - rebounds(trajectory).back().end;
  EXPECT_TRUE(metrics(trajectory).settled);
  trajectory.in_contact_period = std::nextafter(trajectory.in_contact_period, 1);
  const Metrics early = metrics(trajectory);
  EXPECT_FALSE(early.settled);
  EXPECT_EQ(early.status, Status::not_settled);
  EXPECT_TRUE(std::isnan(early.permanent_contact_time));
  EXPECT_TRUE(std::isnan(early.bounce_time));
  EXPECT_EQ(early.bounce_count, 5);
  trajectory.in_contact_period = kNaN;
  EXPECT_FALSE(metrics(trajectory).settled) << "nobody knows whether it will stay";
  EXPECT_TRUE(metrics(trajectory, {.significant_rebound = 1_um}).settled)
      << "without a significant rebound the period does not matter";
}

TEST(Metrics, FirstTouchAtTheEndOfTheWindowIsNotYetSettled) {
  const BouncingBall ball;
  Trajectory trajectory = ball.trajectory(0, ball.first_impact() + 2_us);
  EXPECT_TRUE(metrics(trajectory).settled);
  trajectory.points.pop_back();  // the trajectory now ends at its touch
  const Metrics m = metrics(trajectory);
  EXPECT_EQ(m.status, Status::not_settled) << "the rebound, if any, is still to come";
  EXPECT_FALSE(m.settled);
  EXPECT_TRUE(std::isnan(m.permanent_contact_time));
  EXPECT_NEAR(m.initial_contact_time, ball.first_impact(), kRounding * ball.first_impact());
  EXPECT_EQ(m.bounce_count, 0);
}

TEST(Metrics, ReboundUnderWayAtTheEndIsALowerBound) {
  const BouncingBall ball;
  Trajectory trajectory = ball.trajectory(1, 0, 5);
  // The window ends before the top of the first flight.
  const double end = ball.first_impact() + 0.3 * ball.impact_speed(1) / ball.acceleration;
  std::erase_if(trajectory.points, [&](const TrajectoryPoint& point) { return point.time > end; });
  ASSERT_GT(kGap - trajectory.points.back().position, 1_nm);
  const auto found = rebounds(trajectory);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(std::isnan(found[0].end));
  EXPECT_EQ(found[0].time_of_height, trajectory.points.back().time);
  const Metrics m = metrics(trajectory);
  EXPECT_EQ(m.status, Status::not_settled);
  EXPECT_FALSE(m.settled);
  EXPECT_TRUE(std::isnan(m.permanent_contact_time));
  EXPECT_EQ(m.major_bounce_height, kGap - trajectory.points.back().position);
  EXPECT_EQ(m.bounce_count, 1);
  EXPECT_FALSE(metrics(trajectory, {.significant_rebound = 1_um}).settled) << "it may still become significant";
}

TEST(Metrics, KnotsOffThePlaneByRoundingAreOnIt) {
  const BouncingBall ball;
  Trajectory trajectory = ball.trajectory(6, 1_ms);
  for (TrajectoryPoint& point : trajectory.points) {
    if (std::abs(point.position - kGap) <= kRounding * kGap) point.position = std::nextafter(kGap, 0);
  }
  EXPECT_EQ(rebounds(trajectory).size(), 6U);
  EXPECT_NEAR(metrics(trajectory).initial_contact_time, ball.first_impact(), kRounding * ball.first_impact());
  for (TrajectoryPoint& point : trajectory.points) {
    if (std::abs(point.position - kGap) <= kRounding * kGap) point.position = std::nextafter(kGap, 1);
  }
  EXPECT_EQ(rebounds(trajectory).size(), 6U);
}

TEST(Metrics, DampedOscillatorOnACompliantPlaneMatchesItsClosedForm) {
  // x = c - A exp(-b t) cos(w t) starts at rest below the plane and settles c - gap = 2 nm beyond it. No knot is at a crossing
  // or at a top.
  constexpr double rest = kGap + 2e-9;
  constexpr double b = 2e4, w = 1e6;
  const auto position = [](double t) { return rest - kGap * std::exp(-b * t) * std::cos(w * t); };
  const auto motion = [&](double t) {
    const double decay = kGap * std::exp(-b * t);
    return std::array{position(t), decay * (b * std::cos(w * t) + w * std::sin(w * t)),
                      decay * ((w * w - b * b) * std::cos(w * t) - 2 * b * w * std::sin(w * t))};
  };
  // With 40 knots in a period the error of the quintic is (w h)^6 / 46080 of the amplitude, 3e-10.
  constexpr double interpolation = 1e-9;
  const double end = 60 * 2 * std::numbers::pi / w;
  Trajectory trajectory = sampled(motion, end, 60 * 40 + 1);
  trajectory.in_contact_period = 2 * std::numbers::pi / w;
  const auto found = rebounds(trajectory);

  // Tops are at x' = 0, tan(w t) = -b / w, once in a period; they are above the plane as long as A exp(-b t) cos(w t) > 2 nm.
  const double lag = std::atan(b / w);
  std::size_t count = 0;
  for (int n = 1;; ++n) {
    const double top = (2 * std::numbers::pi * n - lag) / w;
    const double height = kGap - position(top);
    if (height <= 0 || top > end) break;
    ASSERT_LT(count, found.size());
    EXPECT_NEAR(found[count].height, height, interpolation * kGap) << "rebound " << n;
    // The error of the time is that of the velocity over the acceleration. The velocity is interpolated with one order less, a
    // factor of 1 / (w h) and a constant.
    EXPECT_NEAR(found[count].time_of_height, top, 100 * interpolation / w) << "rebound " << n;
    EXPECT_NEAR(position(found[count].begin), kGap, interpolation * kGap) << "rebound " << n;
    EXPECT_NEAR(position(found[count].end), kGap, interpolation * kGap) << "rebound " << n;
    ++count;
  }
  EXPECT_EQ(found.size(), count);
  EXPECT_GT(count, 20U);

  const Metrics m = metrics(trajectory, {.significant_rebound = 10_nm});
  EXPECT_TRUE(m.settled);
  EXPECT_NEAR(position(m.initial_contact_time), kGap, interpolation * kGap);
  EXPECT_NEAR(m.impact_velocity, motion(m.initial_contact_time)[1], 10 * interpolation * kGap * w);
  EXPECT_EQ(m.bounce_count, std::count_if(found.begin(), found.end(), [](const Rebound& r) { return r.height > 10_nm; }));
  EXPECT_EQ(m.major_bounce_height, found[0].height);
}

TEST(Metrics, InterpolationOfASineIsOfSixthOrder) {
  // The top of the rebound of gap (1 - 0.1 sin(w t + 1)) is gap / 10, approximated with knots whose distance is halved.
  constexpr double w = 1e6;
  const auto error = [&](int per_period) {
    const auto motion = [&](double t) {
      const double a = w * t + 1;
      return std::array{kGap * (1 - 0.1 * std::sin(a)), -kGap * 0.1 * w * std::cos(a), kGap * 0.1 * w * w * std::sin(a)};
    };
    // The top of the second period is at a fixed share of a step from the nearest knot, so that the constant of the error stays
    // the same.
    const double h = 2 * std::numbers::pi / w / per_period;
    const double top = (2.5 * std::numbers::pi - 1) / w;
    Trajectory trajectory{.status = Status::done, .contact_gap = kGap};
    for (int i = -per_period / 2; i <= per_period / 2; ++i) {
      const double t = top + (i + 0.4) * h;
      const auto [x, v, a] = motion(t);
      trajectory.points.push_back({.time = t, .position = x, .velocity = v, .acceleration = a});
    }
    const auto found = rebounds(trajectory);
    EXPECT_EQ(found.size(), 1U);
    return std::abs(found.at(0).height - 0.1 * kGap) / (0.1 * kGap);
  };
  const double coarse = error(8), middle = error(16), fine = error(32);
  // The next term of the error is smaller by (w h)^2: a tenth of an order with eight knots in a period.
  constexpr double expected_order = 6, order_tolerance = 0.2;
  EXPECT_NEAR(std::log2(coarse / middle), expected_order, order_tolerance);
  EXPECT_NEAR(std::log2(middle / fine), expected_order, order_tolerance);
  EXPECT_LT(coarse, 1e-5);
}

TEST(Metrics, ExcursionInsideOneIntervalIsFound) {
  // The motion is below the plane at both knots of a step and 5 nm above it in the middle, or the other way round.
  for (const double side : {1.0, -1.0}) {
    const auto motion = [&](double t) {
      const double s = t / 1_us;
      // 5 nm at s = 0, -20 nm at s = +-1.
      return std::array{kGap - side * (5_nm - 25_nm * s * s), side * 50_nm * s / 1_us, side * 50_nm / 1_us / 1_us};
    };
    Trajectory trajectory{.status = Status::done, .contact_gap = kGap};
    trajectory.in_contact_period = 0;
    for (const double t : {-1_us, 0.9_us}) {
      const auto [x, v, a] = motion(t);
      trajectory.points.push_back({.time = t + 1_us, .position = x, .velocity = v, .acceleration = a});
    }
    const double crossing = std::sqrt(0.2) * 1e-6;
    const auto found = rebounds(trajectory);
    ASSERT_EQ(found.size(), 1U) << "side " << side;
    const Metrics m = metrics(trajectory);
    if (side > 0) {
      EXPECT_NEAR(found[0].height, 5_nm, kRounding * kGap);
      EXPECT_NEAR(found[0].begin, 1_us - crossing, 1e-9 * 1_us);
      EXPECT_NEAR(found[0].end, 1_us + crossing, 1e-9 * 1_us);
      EXPECT_EQ(m.initial_contact_time, 0);
      EXPECT_EQ(m.bounce_count, 1);
    } else {
      EXPECT_NEAR(m.initial_contact_time, 1_us - crossing, 1e-9 * 1_us);
      EXPECT_NEAR(m.impact_velocity, 50_nm * crossing / 1e-12, 1e-9 * 0.05);
      EXPECT_NEAR(found[0].begin, 1_us + crossing, 1e-9 * 1_us);
      EXPECT_TRUE(std::isnan(found[0].end));
    }
  }
}

TEST(Metrics, GrazingTouchCountsAndNearMissDoesNot) {
  const auto parabola = [](double closest) {
    return [closest](double t) {
      const double s = t / 1_us - 1;
      return std::array{kGap - closest - 100_nm * s * s, -200_nm * s / 1_us, -200_nm / 1_us / 1_us};
    };
  };
  const Metrics touch = metrics(sampled(parabola(0), 2_us, 3));
  EXPECT_NEAR(touch.initial_contact_time, 1_us, 1e-6 * 1_us);
  EXPECT_NEAR(touch.impact_velocity, 0, 1e-6 * 0.2);
  EXPECT_EQ(touch.status, Status::not_settled) << "it leaves again";
  EXPECT_EQ(metrics(sampled(parabola(0.001_nm), 2_us, 3)).status, Status::no_contact);
}

TEST(Metrics, MicroBouncesInsideAMacroBounceAreCountedByTheirOwnHeight) {
  // After the flight of 500 nm the tip settles into the contact, and oscillates across the plane with an amplitude that decreases
  // through 1 nm.
  const BouncingBall ball;
  Trajectory trajectory = ball.trajectory(1, 0, 4);
  const double begin = trajectory.points.back().time;
  constexpr double w = 2e7;
  constexpr int rings = 4, knots = 16;
  for (int i = 0; i <= rings * knots; ++i) {
    const double a = 2 * std::numbers::pi * i / knots;
    const double t = a / w;
    const double depth = 4e-9 * std::exp2(-t * w / (2 * std::numbers::pi));
    const double rate = -std::numbers::ln2 * w / (2 * std::numbers::pi);
    trajectory.points.push_back({.time = begin + t,
                                 .position = kGap + depth * std::sin(a),
                                 .velocity = depth * (w * std::cos(a) + rate * std::sin(a)),
                                 .acceleration = depth * ((rate * rate - w * w) * std::sin(a) + 2 * rate * w * std::cos(a))});
  }
  trajectory.points.push_back({.time = trajectory.points.back().time, .position = kGap});
  trajectory.points.push_back({.time = begin + 1_ms, .position = kGap});
  const auto found = rebounds(trajectory);
  ASSERT_EQ(found.size(), 5U);
  EXPECT_NEAR(found[0].height, 500_nm, kRounding * kGap);
  for (std::size_t n = 1; n < 4; ++n) {
    // Sixth order with 16 knots in a period.
    EXPECT_NEAR(found[n + 1].height / found[n].height, 0.5, 1e-4) << "ring " << n;
  }
  // 2.5, 1.2, 0.6 and 0.3 nm.
  const Metrics m = metrics(trajectory);
  EXPECT_EQ(m.bounce_count, 3);
  EXPECT_NEAR(m.permanent_contact_time, begin + 2 * 2 * std::numbers::pi / w, 1e-9 * begin);
  EXPECT_TRUE(m.settled);
}

TEST(Metrics, TouchesGivePeakForceAndImpactEnergy) {
  Trajectory trajectory = BouncingBall{}.trajectory(2, 1_ms);
  trajectory.touches = {
      {.peak_force = 3e-6, .peak_energy = 2e-12}, {.peak_force = 5e-6, .peak_energy = 1e-12}, {.peak_force = 1e-6}};
  EXPECT_EQ(metrics(trajectory).peak_contact_force, 5e-6);
  EXPECT_DOUBLE_EQ(metrics(trajectory).impact_energy, 3e-12);
  trajectory.force.steady_force_time = 2e-4;
  trajectory.force.least_force_after_touch = 1e-9;
  EXPECT_EQ(metrics(trajectory).steady_force_time, 2e-4);
  EXPECT_EQ(metrics(trajectory).least_force_after_touch, 1e-9);
  trajectory.touches[1].peak_force = kNaN;
  EXPECT_TRUE(std::isnan(metrics(trajectory).peak_contact_force));
}

TEST(Metrics, NoContactLeavesTheContactFiguresUnset) {
  Trajectory trajectory = BouncingBall{}.trajectory(0, 0, 3);
  trajectory.points.resize(3);
  trajectory.energy.source_work = 1e-12;
  trajectory.hold_force = 1e-6;
  const Metrics m = metrics(trajectory);
  EXPECT_EQ(m.status, Status::no_contact);
  EXPECT_FALSE(m.settled);
  for (const double figure : {m.initial_contact_time, m.permanent_contact_time, m.bounce_time, m.major_bounce_height,
                              m.impact_velocity, m.peak_contact_force, m.impact_energy, m.hold_force}) {
    EXPECT_TRUE(std::isnan(figure));
  }
  EXPECT_EQ(m.drive_energy, 1e-12);
  EXPECT_TRUE(rebounds(trajectory).empty());
}

TEST(Metrics, OfARunThatEndsAtItsTouchSayNothingOfWhatFollows) {
  Trajectory trajectory = BouncingBall{}.trajectory(0, 0, 3);
  const double touch = metrics(trajectory).initial_contact_time;
  std::erase_if(trajectory.points, [&](const TrajectoryPoint& p) { return p.time > touch; });
  trajectory.touches = {{.begin = touch, .end = kNaN, .impact_velocity = 1}};
  trajectory.energy.source_work = 1e-12;
  trajectory.hold_force = 1e-6;
  trajectory.ends_at_touch = true;
  const Metrics m = metrics(trajectory);
  EXPECT_EQ(m.status, Status::done);
  EXPECT_FALSE(m.settled);
  EXPECT_EQ(m.initial_contact_time, touch);
  EXPECT_GT(m.impact_velocity, 0);
  EXPECT_EQ(m.drive_energy, 1e-12);
  for (const double figure :
       {m.permanent_contact_time, m.bounce_time, m.major_bounce_height, m.peak_contact_force, m.impact_energy, m.hold_force}) {
    EXPECT_TRUE(std::isnan(figure));
  }
}

TEST(Metrics, EmptyTrajectoriesAndSingleKnotsAreAnswered) {
  EXPECT_EQ(metrics(Trajectory{}).status, Status::not_run);
  EXPECT_EQ(metrics(Trajectory{.status = Status::done, .contact_gap = kGap}).status, Status::no_contact);
  EXPECT_TRUE(rebounds(Trajectory{}).empty());
  Trajectory one{.status = Status::done, .contact_gap = kGap, .points = {{.time = 1, .position = 0}}};
  EXPECT_EQ(metrics(one).status, Status::no_contact);
  one.points[0].position = kGap;
  EXPECT_EQ(metrics(one).status, Status::done);
  EXPECT_EQ(metrics(one).initial_contact_time, 1);
  EXPECT_EQ(metrics(one).permanent_contact_time, 1);
}

TEST(Metrics, RunsThatBrokeOffKeepTheirStatusAndWhatWasKnown) {
  for (const Status status :
       {Status::numerical_failure, Status::interrupted, Status::collapsed_at_rest, Status::collapsed_onto_electrode}) {
    Trajectory trajectory = BouncingBall{}.trajectory(6, 1_ms);
    trajectory.status = status;
    const Metrics m = metrics(trajectory);
    EXPECT_EQ(m.status, status);
    EXPECT_FALSE(m.settled);
    EXPECT_NEAR(m.initial_contact_time, BouncingBall{}.first_impact(), kRounding * m.initial_contact_time);
    EXPECT_GT(m.impact_velocity, 0);
    EXPECT_TRUE(std::isnan(m.permanent_contact_time));
    EXPECT_TRUE(std::isnan(m.bounce_time));
    EXPECT_TRUE(std::isnan(m.major_bounce_height));
    trajectory.points.clear();
    EXPECT_EQ(metrics(trajectory).status, status);
    EXPECT_TRUE(std::isnan(metrics(trajectory).initial_contact_time));
  }
}

TEST(Metrics, AKnotThatIsNotANumberIsANumericalFailure) {
  const auto broken = [](std::size_t at, double TrajectoryPoint::*member, double value) {
    Trajectory trajectory = BouncingBall{}.trajectory(6, 1_ms);
    trajectory.points[at].*member = value;
    return metrics(trajectory);
  };
  for (const auto member :
       {&TrajectoryPoint::time, &TrajectoryPoint::position, &TrajectoryPoint::velocity, &TrajectoryPoint::acceleration}) {
    const Metrics late = broken(5, member, kNaN);
    EXPECT_EQ(late.status, Status::numerical_failure);
    EXPECT_FALSE(late.settled);
    EXPECT_TRUE(std::isnan(late.permanent_contact_time));
    EXPECT_NEAR(late.initial_contact_time, BouncingBall{}.first_impact(), kRounding * late.initial_contact_time);
    EXPECT_TRUE(std::isnan(broken(0, member, kNaN).initial_contact_time));
  }
  EXPECT_EQ(broken(5, &TrajectoryPoint::time, 0).status, Status::numerical_failure) << "time goes back";
  Trajectory trajectory = BouncingBall{}.trajectory(6, 1_ms);
  trajectory.contact_gap = kNaN;
  EXPECT_EQ(metrics(trajectory).status, Status::numerical_failure);
}

TEST(Metrics, StatusOfTheRunIsKeptWhenItIsNotDone) {
  Trajectory trajectory = BouncingBall{}.trajectory(6, 1_ms);
  trajectory.status = Status::not_settled;
  const Metrics m = metrics(trajectory);
  EXPECT_EQ(m.status, Status::not_settled);
  EXPECT_FALSE(m.settled);
  EXPECT_EQ(m.bounce_count, 5) << "the run reached its end";
}

}  // namespace
}  // namespace softland
