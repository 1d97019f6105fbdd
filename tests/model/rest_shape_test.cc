#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/beam.h"
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

// A layer makes its stretch stiffer, so that it curls less; value and slope go on at its ends.
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

// The reference device, curled up: values of an independent program with four modes (Meijs-Fokkema fringing, strip film,
// asperities).
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
  test::expect_refused([] { validate(curled(test::gold_cantilever(), -15e12)); },
                       "structure: rests 6.01 um nearer to the electrode than a straight one: it would touch it at rest");
  Device along_pad = curled(test::gold_cantilever());
  along_pad.contacts.front().distribution = ContactDistribution::pad;
  test::expect_refused(
      [&] { validate(along_pad); },
      "contact.distribution = pad: not with a structure that is curled at rest, whose pad is tilted before it moves");
}

}  // namespace
}  // namespace softland
