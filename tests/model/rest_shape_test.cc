#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/beam.h"
#include "model/built_beam.h"
#include "model/closing.h"
#include "model/device.h"
#include "model/pull_in.h"
#include "model/switch.h"
#include "tests/model/expect_refused.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

constexpr double gradient = 0.5e12;  // 0.5 MPa/um [Pa/m]

Device curled(Device device, double by = gradient) {
  part_of<Cantilever>(device.structure).stress_gradient = by;
  return device;
}

TEST(RestShape, OfAPlainCantileverIsAParabola) {
  const Device d = curled(test::gold_cantilever());
  const double curvature = gradient / 78_GPa;
  for (const double x : {0.0, 60_um, 125_um, 250_um}) EXPECT_NEAR(d.rest_offset(x), curvature * x * x / 2, 1e-20) << x;
  EXPECT_DOUBLE_EQ(d.contact_gap(), 2_um + curvature * 247.5_um * 247.5_um / 2);
  EXPECT_EQ(curled(d, 0).contact_gap(), d.gap.contact);
}

// A layer stiffens its part of the beam, which curls less. Deflection and slope are continuous at its ends.
TEST(RestShape, IsStraighterWhereALayerStiffensTheBeam) {
  const Device d = curled(test::gold_pzt_cantilever());
  const double plain = gradient / 78_GPa;
  const double layered = plain * plain_section(d.structure).rigidity / layered_section(d.structure, *d.piezo).rigidity;
  const auto curvature = [&](double x) {
    constexpr double step = 1_um;
    return (d.rest_offset(x + step) - 2 * d.rest_offset(x) + d.rest_offset(x - step)) / (step * step);
  };
  constexpr double rounding = 1e-6;
  EXPECT_NEAR(curvature(2.5_um), plain, rounding * plain);
  EXPECT_NEAR(curvature(120_um), layered, rounding * plain);
  EXPECT_NEAR(curvature(245_um), plain, rounding * plain);
  for (const double end : {5_um, 240_um}) {
    constexpr double little = 1e-9;
    const double before = d.rest_offset(end) - d.rest_offset(end - little),
                 after = d.rest_offset(end + little) - d.rest_offset(end);
    EXPECT_NEAR(after / before, 1, 1e-3) << end;
  }
}

// The reference device with an upward curl. Expected values come from an independent program with four modes (Meijs-Fokkema
// fringing, strip film, asperities).
TEST(RestShape, MovesPullInAndTheFirstTouchAsAnIndependentProgramSays) {
  const Switch model(curled(test::gold_cantilever()));
  constexpr double digits = 1e-5;
  EXPECT_NEAR(static_pull_in(model, 0).voltage, 16.048544466889137, digits * 16.05);
  const Trajectory t = simulate_closing(model, std::vector{Signal::constant(20)}, {.duration = 600e-6, .tolerance = 1e-9});
  ASSERT_FALSE(t.touches.empty());
  EXPECT_NEAR(t.touches.front().begin, 3.157064445176383e-05, digits * 3.157e-5);
  EXPECT_NEAR(t.touches.front().impact_velocity, 0.11598065869396677, digits * 0.116);
  EXPECT_NEAR(static_pull_in(Switch(curled(test::gold_cantilever(), -gradient)), 0).voltage, 14.42, 0.005) << "curled down";
}

TEST(RestShape, IsRefusedWhereItWouldTouchAtRest) {
  test::expect_refused([] { validate(curled(test::gold_cantilever(), -6e12)); },
                       "structure: its contact point rests 2.356 um nearer to the contact than that of a straight one, "
                       "gap.contact = 2 um: it would be closed at rest");
  test::expect_refused(
      [] { validate(curled(test::gold_cantilever(), -15e12)); },
      "structure: rests 6.01 um nearer to the electrode than a straight one: it would touch the electrode at rest");
  Device along_pad = curled(test::gold_cantilever());
  along_pad.contacts.front().distribution = ContactDistribution::pad;
  test::expect_refused(
      [&] { validate(along_pad); },
      "contact.distribution = pad: not with a structure that is curled at rest, whose pad is tilted before it moves");
}

// Returns the parabola of a stress gradient as a table with equal steps.
Device sampled(Device device, int steps) {
  const Device as_curled = curled(device);
  RestShape shape;
  for (int k = 0; k <= steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    shape.positions.push_back(Place::share(share));
    shape.heights.push_back(as_curled.rest_offset(share * device.structure.length));
  }
  part_of<Beam>(device.structure).rest_shape = shape;
  return device;
}

// A chord of a parabola lies above it by at most kappa h^2/8.
TEST(RestShapeTable, HasTheGapsOfTheCurveThatItSamples) {
  const Device smooth = curled(test::gold_cantilever());
  const double curvature = gradient / 78_GPa;
  for (const int steps : {5, 20}) {
    const Device d = sampled(test::gold_cantilever(), steps);
    const double step = 250_um / steps, most = curvature * step * step / 8;
    double worst = 0;
    for (int k = 0; k <= 1000; ++k) {
      const double x = 250_um * k / 1000, error = d.rest_offset(x) - smooth.rest_offset(x);
      EXPECT_GE(error, -1e-20) << x;
      worst = std::max(worst, error);
    }
    EXPECT_NEAR(worst, most, 1e-3 * most);
    EXPECT_NEAR(d.contact_gap(), smooth.contact_gap(), most);
  }
}

// The table makes the gap larger by two thirds of kappa h^2/8 on average, and V^2 grows with the cube of the gap.
TEST(RestShapeTable, HasThePullInAndTheFirstTouchOfTheCurveThatItSamples) {
  const double smooth = static_pull_in(Switch(curled(test::gold_cantilever())), 0).voltage;
  const auto error = [&](int steps) {
    return static_pull_in(Switch(sampled(test::gold_cantilever(), steps)), 0).voltage / smooth - 1;
  };
  const double coarse = error(25), fine = error(50);  // the electrode ends at points of both tables
  const double step = 10_um, mean_rise = 2.0 / 3 * gradient / 78_GPa * step * step / 8;
  EXPECT_NEAR(coarse, 1.5 * mean_rise / 3.6_um, 0.4 * coarse);
  EXPECT_NEAR(coarse / fine, 4, 0.1) << "second order in the step";
  const auto first_touch = [](const Device& d) {
    return simulate_closing(Switch(d), std::vector{Signal::constant(20)}, {.duration = 60e-6, .tolerance = 1e-9}).touches.at(0);
  };
  const Touch by_curve = first_touch(curled(test::gold_cantilever())),
              by_table = first_touch(sampled(test::gold_cantilever(), 20));
  constexpr double few = 3e-4;  // relative; three times the error of the gap, 0.2 nm of 2 um
  EXPECT_NEAR(by_table.begin / by_curve.begin, 1, few);
  EXPECT_NEAR(by_table.impact_velocity / by_curve.impact_velocity, 1, few);
}

// Panels of the quadrature end at the kinks, so that more points change nothing.
TEST(RestShapeTable, HasKinksWherePanelsEnd) {
  Device d = test::gold_cantilever();
  part_of<Beam>(d.structure).rest_shape =
      RestShape{.positions = {0, 90_um, 155_um, Place::share(1)}, .heights = {0, 0.4_um, -0.3_um, 0.2_um}};
  const double usual = static_pull_in(Switch(d, {.points_per_length = 48, .points_per_panel = 8}), 0).voltage,
               many = static_pull_in(Switch(d, {.points_per_length = 400, .points_per_panel = 40}), 0).voltage;
  EXPECT_NEAR(usual / many, 1, 1e-9);
}

TEST(RestShapeTable, GoesOnStraightOverALongerBeam) {
  Device d = sampled(test::gold_cantilever(), 5);
  RestShape& shape = *part_of<Beam>(d.structure).rest_shape;
  for (Place& position : shape.positions) position = position.on(250_um);
  d.structure.length = 260_um;
  EXPECT_NEAR(d.rest_offset(260_um), d.rest_offset(250_um) + 0.2 * (d.rest_offset(250_um) - d.rest_offset(200_um)), 1e-18);
  d.structure.length = 240_um;
  EXPECT_EQ(kinks_at_rest(d.structure).size(), 4u);
}

TEST(RestShapeTable, IsRefusedBesideAnotherCurl) {
  Device d = sampled(test::gold_cantilever(), 5);
  part_of<Cantilever>(d.structure).stress_gradient = gradient;
  test::expect_refused([&] { validate(d); },
                       "structure.rest_shape: cannot stand beside stress_gradient, which curls the beam as well");
  part_of<Cantilever>(d.structure).stress_gradient = 0;
  d.contacts.front().distribution = ContactDistribution::pad;
  test::expect_refused(
      [&] { validate(d); },
      "contact.distribution = pad: not with a structure that is curled at rest, whose pad is tilted before it moves");
}

}  // namespace
}  // namespace softland
