// Beams of sections, layers and anchors.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "base/require.h"
#include "integrators/roots.h"
#include "model/beam.h"
#include "model/built_beam.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/gas/perforated_strip.h"
#include "model/gas/strip.h"
#include "model/laminate.h"
#include "model/piezo_layer.h"
#include "model/pull_in.h"
#include "model/switch.h"
#include "objectives/metrics.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;
using testing::HasSubstr;

constexpr double digits_of_modes = 1e-9;  // relative, of frequencies

/// Returns a gold beam: no fringing, gas and damping, a linear contact at 247.5 um.
Device gold(std::vector<SectionPart> sections, double electrode_begin, int modes) {
  Device d = test::gold_cantilever();
  d.structure.modes = modes;
  part_of<Beam>(d.structure).sections = std::move(sections);
  d.gas.reset();
  d.electrodes.front().begin = electrode_begin;
  d.electrodes.front().fringing = Fringing::none;
  d.contacts = {test::gold_contact(LinearSpring{.stiffness = 2000})};
  return d;
}
Device even_beam(int modes = 4) { return gold({}, 60_um, modes); }
Device hinged(int modes = 4) {
  return gold({{.length = 60_um, .width = 10_um, .thickness = 1_um}, {.length = 190_um, .width = 40_um, .thickness = 2_um}},
              40_um, modes);
}
/// Returns a beam whose anchor turns like a further piece of beam with a length of one thickness.
Device turning(int modes = 4) {
  Device d = even_beam(modes);
  part_of<Beam>(d.structure).anchor = Anchor{.rotation = plain_section(d.structure).rigidity / 2_um};
  return d;
}
constexpr double case_a_volts = 4, case_u_volts = 20;

/// Values of an independent program of Hermite elements, each with its tolerance.
struct Value {
  double value, tolerance;
};
struct ByModes {
  int modes;
  Value vsp, touch, speed;
};
struct KeptCase {
  std::string name;
  std::function<Device(int)> device;
  double volts;
  std::array<double, 4> frequencies;  // [Hz]
  double vsp;                         // static pull-in voltage of all modes [V]
  std::vector<ByModes> by_modes;
  Value bounce, penetration;  // with four modes: B_H, and the largest penetration of the run [m]
};

constexpr double none = 0;
constexpr double run_window = 200e-6;  // window of the independent program, in which bounces follow one another
const std::vector<KeptCase> cases{
    {"uniform",
     even_beam,
     case_u_volts,
     {10391.99397168356, 65125.514544994796, 182353.32650552614, 357339.74025571166},
     16.05662206614814,
     {{4, {16.05674441758408, 1e-5}, {2.991575565306173e-05, 1e-5}, {0.13034344896132866, 1e-5}},
      {8, {16.05662675185077, 1e-5}, {2.9917565839753452e-05, 2e-5}, {0.13058844400454697, 1e-4}},
      {16, {none, none}, {2.9917663504216188e-05, 2e-5}, {0.13060799892337976, 1e-4}}},
     {1.8519473654577023e-06, 3e-5},
     {1.576877303033677e-08, 7e-5}},
    {"hinged",
     hinged,
     case_a_volts,
     {2209.4270880792105, 35791.79464340722, 124561.11626131929, 307156.82510187075},
     3.389628853562698,
     {{4, {3.389630301105008, 1e-5}, {0.00015476876582808406, 1e-5}, {0.023662520933655215, 1e-5}},
      {8, {3.3896294802142912, 1e-5}, {0.00015476916805133218, 2e-5}, {0.023656603189828995, 1e-4}},
      {16, {none, none}, {0.0001547692030395605, 2e-5}, {0.023656518249029312, 1e-4}}},
     {2.947557496656253e-07, 3e-5},
     {3.0406777806844985e-09, 1e-5}},
    {"turning",
     turning,
     case_u_volts,
     {10229.457214601347, 64133.533949145065, 179640.62595953574, 352149.97194747743},
     15.801497215075566,
     {{4, {15.801617564310975, 1e-5}, {2.9776228240616732e-05, 1e-5}, {0.13413046427176586, 1e-5}},
      {8, {15.801501733775261, 1e-5}, {2.9778195157758537e-05, 2e-5}, {0.1337883541920635, 1e-4}},
      {16, {none, none}, {2.9778301206710105e-05, 2e-5}, {0.13376761964054612, 1e-4}}},
     {1.8674124802552274e-06, 2e-5},
     {1.2702272029210514e-08, 2e-4}},
};

class BuiltBeams : public testing::TestWithParam<KeptCase> {};
INSTANTIATE_TEST_SUITE_P(Beams, BuiltBeams, testing::ValuesIn(cases), [](const auto& one) { return one.param.name; });

void expect_near(double value, const Value& expected, const char* what) {
  EXPECT_NEAR(value, expected.value, expected.tolerance * expected.value) << what;
}

TEST_P(BuiltBeams, HaveTheFrequenciesOfAnIndependentProgram) {
  const Switch model(GetParam().device(4));
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double expected = 2 * pi * GetParam().frequencies[static_cast<std::size_t>(i)];
    EXPECT_NEAR(model.basis().angular_frequencies()[i], expected, 1e-6 * expected) << i;
  }
}

TEST_P(BuiltBeams, ArePulledInAtTheVoltageOfAnIndependentProgram) {
  for (const ByModes& one : GetParam().by_modes) {
    if (one.vsp.value == none) continue;
    expect_near(static_pull_in(Switch(GetParam().device(one.modes)), 0).voltage, one.vsp, "Vsp");
  }
  SwitchOptions options;
  options.modes = most_static_modes;
  expect_near(static_pull_in(Switch(GetParam().device(4), options), 0).voltage, {GetParam().vsp, 1e-5}, "Vsp of all modes");
}

TEST_P(BuiltBeams, CloseAsInAnIndependentProgram) {
  for (const ByModes& one : GetParam().by_modes) {
    SCOPED_TRACE(one.modes);
    const Trajectory t = simulate_closing(Switch(GetParam().device(one.modes)), std::vector{Signal::constant(GetParam().volts)},
                                          {.duration = run_window, .tolerance = 1e-10});
    ASSERT_FALSE(t.touches.empty());
    expect_near(t.touches.front().begin, one.touch, "time of the first touch");
    expect_near(t.touches.front().impact_velocity, one.speed, "impact velocity");
    if (one.modes != 4) continue;
    expect_near(metrics(t).major_bounce_height, GetParam().bounce, "highest rebound");
    expect_near(t.deepest_penetration, GetParam().penetration, "largest penetration");
  }
}

// Sections in sequence; rigidity and mass are those at the middle of each section.
std::vector<BeamSection> stepped() {
  return {{.begin = 0, .end = 0.3, .rigidity = 1, .mass_per_length = 1},
          {.begin = 0.3, .end = 0.7, .rigidity = 6, .mass_per_length = 1.7},
          {.begin = 0.7, .end = 1, .rigidity = 0.4, .mass_per_length = 0.6}};
}
std::vector<BeamSection> tapered() {
  return {{.begin = 0, .end = 0.4, .rigidity = 2, .mass_per_length = 3, .taper = 0.5},
          {.begin = 0.4, .end = 1, .rigidity = 1, .mass_per_length = 1.2, .taper = -0.8}};
}

/// Returns the residual of the conditions at x = L for a beam that meets those at x = 0, vibrating with w [rad/s]: 0 at its
/// frequencies. It integrates y' = t, EI t' = M, M' = V, V' = w^2 mu y by the classical Runge-Kutta method, which shares nothing
double end_condition(const std::vector<BeamSection>& sections, const BeamSupport& support, double w) {
  using State = Eigen::Vector4d;
  std::array<State, 2> solutions;
  if (std::isinf(support.near.translation)) {
    solutions[0] = {0, 0, 0, 1};
  } else {
    solutions[0] = {1, 0, 0, -support.near.translation};
  }
  if (std::isinf(support.near.rotation)) {
    solutions[1] = {0, 0, 1, 0};
  } else {
    solutions[1] = {0, 1, support.near.rotation, 0};
  }
  constexpr int steps = 1000;
  for (const BeamSection& s : sections) {
    const double half = (s.end - s.begin) / 2, step = 2 * half / steps;
    const auto rates = [&](double x, const State& y) -> State {
      const double larger = 1 + s.taper * ((x - s.begin) / half - 1);
      return {y[1], y[2] / (s.rigidity * larger), y[3] + support.axial_force * y[1], w * w * s.mass_per_length * larger * y[0]};
    };
    for (State& y : solutions) {
      for (int k = 0; k < steps; ++k) {
        const double x = s.begin + k * step;
        const State a = rates(x, y), b = rates(x + step / 2, y + step / 2 * a), c = rates(x + step / 2, y + step / 2 * b),
                    d = rates(x + step, y + step * c);
        y += step / 6 * (a + 2 * b + 2 * c + d);
      }
    }
  }
  const Anchor far = support.far_clamp ? Anchor{} : support.far;
  Eigen::Matrix2d left;
  for (int i = 0; i < 2; ++i) {
    const State& y = solutions[static_cast<std::size_t>(i)];
    left(0, i) = std::isinf(far.translation) ? y[0] : y[3] - far.translation * y[0];
    left(1, i) = std::isinf(far.rotation) ? y[1] : y[2] + far.rotation * y[1];
  }
  return left.determinant();
}

void expect_frequencies_by_shooting(const std::vector<BeamSection>& sections, const BeamSupport& support) {
  constexpr int modes = 5;
  constexpr double around = 1e-5;
  const BeamModes beam(sections, modes, support);
  for (int i = 0; i < modes; ++i) {
    const double w = beam.angular_frequencies()[i], low = w * (1 - around), high = w * (1 + around);
    const auto left = [&](double at) { return end_condition(sections, support, at); };
    ASSERT_LT(left(low) * left(high), 0) << i;
    EXPECT_NEAR(w, bracketed_zero(left, low, high), digits_of_modes * w) << i;
  }
}

TEST(SectionModes, AreThoseOfShooting) {
  const std::vector<Anchor> ends{{}, {.rotation = 2}, {.rotation = 0}, {.translation = 50}, {.rotation = 3, .translation = 400}};
  for (const std::vector<BeamSection>& sections : {stepped(), tapered()}) {
    for (const Anchor& near : ends) {
      for (const Anchor& far : ends) {
        SCOPED_TRACE(fmt::format("{} sections, near {} {}, far {} {}", sections.size(), near.rotation, near.translation,
                                 far.rotation, far.translation));
        expect_frequencies_by_shooting(sections, {.far_clamp = far.is_clamp(), .near = near, .far = far});
      }
      if (near.rotation > 0) expect_frequencies_by_shooting(sections, {.near = near});
    }
    expect_frequencies_by_shooting(sections, {.far_clamp = true, .axial_force = -3, .near = {.rotation = 5}});
    expect_frequencies_by_shooting(sections, {.axial_force = 20, .near = {.rotation = 5}, .far = {.rotation = 0}});
  }
}

TEST(SectionModes, OfAnEvenBeamOnHingesAreSines) {
  const std::vector<BeamSection> even{{.begin = 0, .end = 2, .rigidity = 3, .mass_per_length = 5}};
  const Anchor hinge{.rotation = 0};
  const BeamModes beam(even, 6, {.near = hinge, .far = hinge});
  for (int i = 0; i < 6; ++i) {
    const double number = (i + 1) * pi / 2, w = number * number * std::sqrt(3.0 / 5);
    EXPECT_NEAR(beam.angular_frequencies()[i], w, digits_of_modes * w) << i;
    EXPECT_NEAR(beam.value(0.4)[i], std::sin(number * 0.4) / std::sqrt(5), 1e-7) << i;
  }
  const Eigen::MatrixXd slopes = beam.slope_products();
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(slopes(i, i), std::pow((i + 1) * pi / 2, 2) / 5, 1e-7 * slopes(i, i)) << i;
}

// A very stiff spring must give the frequencies of a clamp, without a loss of precision on the way.
TEST(SectionModes, OnStiffSpringsAreThoseBetweenClamps) {
  const BeamModes clamped(tapered(), 4, {.far_clamp = true});
  const Anchor stiff{.rotation = 1e13, .translation = 1e13};
  const BeamModes sprung(tapered(), 4, {.near = stiff, .far = stiff});
  for (int i = 0; i < 4; ++i) {
    const double w = clamped.angular_frequencies()[i];
    EXPECT_NEAR(sprung.angular_frequencies()[i], w, digits_of_modes * w) << i;
    EXPECT_NEAR(sprung.value(0.6)[i], clamped.value(0.6)[i], 1e-7 * std::abs(clamped.value(0.6)[i])) << i;
  }
}

// The same beam by both methods: a spring without effect selects the general method.
TEST(SectionModes, AreTheSameByBothMethods) {
  const BeamModes plain(stepped(), 6), general(stepped(), 6, {.far = {.rotation = 0, .translation = 1e-13}});
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(general.angular_frequencies()[i], plain.angular_frequencies()[i],
                digits_of_modes * plain.angular_frequencies()[i]);
  }
  for (const double x : {0.35, 0.7, 0.95, 1.0})
    EXPECT_NEAR(general.pinned_frequency(x), plain.pinned_frequency(x), digits_of_modes * plain.pinned_frequency(x)) << x;
}

TEST(SectionModes, OfOneBeamInTwoPartsAreThoseOfTheWhole) {
  const Switch whole(even_beam());
  const Switch parts(gold({{.length = 100_um}, {.length = 150_um}}, 60_um, 4));
  for (Eigen::Index i = 0; i < 4; ++i) {
    EXPECT_NEAR(parts.basis().angular_frequencies()[i], whole.basis().angular_frequencies()[i],
                digits_of_modes * whole.basis().angular_frequencies()[i]);
    EXPECT_NEAR(parts.basis().contact_shape()[i], whole.basis().contact_shape()[i],
                1e-8 * std::abs(whole.basis().contact_shape()[i]));
  }
}

// A staircase of many steps approximates a linear width, for every law of a field and a film.
TEST(Tapers, AreTheLimitOfManySteps) {
  constexpr int steps = 40;
  const auto with = [](std::vector<SectionPart> sections, const Gas& gas, Fringing fringing) {
    Device d = gold(std::move(sections), 40_um, 4);
    d.gas = gas;
    d.electrodes.front().fringing = fringing;
    d.dispersion = Dispersion{.hamaker_constant = 4e-19};
    return d;
  };
  std::vector<SectionPart> staircase;
  for (int k = 0; k < steps; ++k) staircase.push_back({.length = 250_um / steps, .width = 40_um - 30_um * (k + 0.5) / steps});
  const std::vector<SectionPart> linear{{.length = 250_um, .width = 40_um, .end_width = 10_um}};
  const Gas strip = *test::gold_cantilever().gas;
  for (const Fringing fringing : {Fringing::none, Fringing::linear, Fringing::meijs_fokkema, Fringing::bao_2001}) {
    const Switch smooth(with(linear, strip, fringing)), rough(with(staircase, strip, fringing));
    EXPECT_NEAR(smooth.basis().angular_frequencies()[0], rough.basis().angular_frequencies()[0],
                5e-4 * rough.basis().angular_frequencies()[0]);
    const double volts = static_pull_in(rough, 0).voltage;
    EXPECT_NEAR(static_pull_in(smooth, 0).voltage, volts, 1e-3 * volts);
    Eigen::VectorXd q = smooth.basis().contact_shape().cwiseQuotient(smooth.basis().squares()), v = q;
    q *= 1e-6 / smooth.contact_deflection(q.data());
    v *= 0.1 / smooth.contact_deflection(v.data());
    Switch::Workspace work = smooth.workspace(), other = rough.workspace();
    const double lost = rough.dissipated_power(q.data(), v.data(), other);
    EXPECT_NEAR(smooth.dissipated_power(q.data(), v.data(), work), lost, 5e-3 * lost);
  }
}

// The gradient of the potential is minus the force, and the power of a field is that of its charge, also on sections.
TEST(Tapers, HaveAForceThatIsTheSlopeOfThePotential) {
  Device d = gold({{.length = 60_um, .width = 12_um}, {.length = 190_um, .width = 40_um, .end_width = 20_um}}, 40_um, 4);
  d.electrodes.front().fringing = Fringing::meijs_fokkema;
  const Switch model(d);
  Switch::Workspace work = model.workspace();
  Eigen::VectorXd q = model.basis().contact_shape().cwiseQuotient(model.basis().squares()), still = Eigen::VectorXd::Zero(4);
  q *= 1e-6 / model.contact_deflection(q.data());
  const std::vector<double> volts{5};
  Eigen::VectorXd force(4);
  model.accelerations(q.data(), still.data(), volts, false, work, force.data());
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double step = 1e-4 * q[0];
    Eigen::VectorXd above = q, below = q;
    above[i] += step, below[i] -= step;
    const double slope =
        (model.potential(above.data(), volts, false, work) - model.potential(below.data(), volts, false, work)) / (2 * step);
    EXPECT_NEAR(force[i], -slope, 1e-6 * force.norm()) << i;
  }
}

const std::vector<Lamina> hinge_of_two{{.modulus = 78e9, .density = 19300, .thickness = 1_um},
                                       {.modulus = 250e9, .density = 3100, .thickness = 0.5_um, .stress = 50e6}};

TEST(Layers, BendAsAnIndependentProgramSays) {
  constexpr double digits = 1e-9;
  const Laminate bent(hinge_of_two);
  EXPECT_NEAR(bent.neutral_axis, 9.618226600985223e-07, digits * 1e-6);
  EXPECT_NEAR(bent.rigidity, 3.612079228243021e-08, digits * 3.6e-8);
  EXPECT_NEAR(bent.curvature, 199.45391676918752, digits * 200);
  std::vector<Lamina> wide = hinge_of_two;
  wide[0].modulus /= 1 - 0.42 * 0.42, wide[1].modulus /= 1 - 0.23 * 0.23;
  const Laminate plate(wide);
  EXPECT_NEAR(plate.neutral_axis, 9.366635034424097e-07, digits * 1e-6);
  EXPECT_NEAR(plate.rigidity, 4.1657847673650004e-08, digits * 4.2e-8);
}

// The layer covers the first 60 um of a beam that is 1 um thick, which is an arc there and straight beyond. A layer on the
// other face bends the beam the other way.
TEST(Layers, CurlTheBeamWhereTheyLie) {
  Device d = even_beam();
  d.structure.thickness = 1_um;
  Beam& beam = part_of<Beam>(d.structure);
  beam.layers = {{.begin = 0, .end = 60_um, .thickness = 0.5_um, .youngs_modulus = 250e9, .density = 3100, .stress = 50e6}};
  const double curvature = 199.45391676918752, arc = curvature * 60_um * 60_um / 2;
  constexpr double digits = 1e-9;
  EXPECT_NEAR(d.rest_offset(30_um), arc / 4, digits * arc);
  EXPECT_NEAR(d.rest_offset(60_um), arc, digits * arc);
  EXPECT_NEAR(d.rest_offset(250_um), arc + curvature * 60_um * 190_um, digits * 10 * arc);
  EXPECT_DOUBLE_EQ(d.contact_gap(), 2_um + d.rest_offset(247.5_um));
  beam.layers.front().face = Side::near;
  EXPECT_NEAR(d.rest_offset(60_um), -arc, digits * arc);
  beam.layers.front().stress = 0;
  EXPECT_EQ(d.rest_offset(60_um), 0);
  EXPECT_EQ(part_of<Cantilever>(d.structure).lowest_rest_offset(d), 0);
}

TEST(Layers, LeaveTheLowestPointInsideABeamThatBendsBothWays) {
  Device d = even_beam();
  part_of<Beam>(d.structure).layers = {
      {.face = Side::near, .begin = 0, .end = 100_um, .thickness = 0.1_um, .youngs_modulus = 78e9, .density = 1, .stress = 20e6},
      {.face = Side::far,
       .begin = 100_um,
       .end = 250_um,
       .thickness = 0.1_um,
       .youngs_modulus = 78e9,
       .density = 1,
       .stress = 40e6}};
  double least = 0;
  for (int k = 0; k <= 5000; ++k) least = std::min(least, d.rest_offset(250_um * k / 5000));
  EXPECT_LT(least, d.rest_offset(250_um));
  EXPECT_NEAR(part_of<Cantilever>(d.structure).lowest_rest_offset(d), least, 1e-6 * -least);
}

// A layer of the beam's own material makes the beam thicker.
TEST(Layers, OfTheBeamsMaterialMakeItThicker) {
  Device thick = even_beam(), thin = even_beam();
  thin.structure.thickness = 1.5_um;
  part_of<Beam>(thin.structure).layers = {
      {.face = Side::near, .begin = 0, .end = 250_um, .thickness = 0.5_um, .youngs_modulus = 78_GPa, .density = 19300}};
  const Switch one(thick), two(thin);
  for (Eigen::Index i = 0; i < 4; ++i) {
    EXPECT_NEAR(two.basis().angular_frequencies()[i], one.basis().angular_frequencies()[i],
                digits_of_modes * one.basis().angular_frequencies()[i]);
  }
}

// Sections of equal size with a piezo layer act like a beam without sections.
TEST(Layers, OfPiezoPushAsOnAPlainBeam) {
  const Device plain = test::gold_pzt_cantilever();
  Device parts = plain;
  part_of<Beam>(parts.structure).sections = {{.length = 100_um}, {.length = 150_um}};
  const Switch one(plain), two(parts);
  constexpr double digits = 1e-8;
  EXPECT_NEAR(two.basis().piezo_deflection(), one.basis().piezo_deflection(), digits * std::abs(one.basis().piezo_deflection()));
  EXPECT_LT(one.basis().piezo_deflection(), 0) << "a positive voltage lifts the tip";
  parts.piezo->relative_permittivity = 1000;
  Device known = plain;
  known.piezo->relative_permittivity = 1000;
  EXPECT_NEAR(layer_capacitance(parts), layer_capacitance(known), 1e-12 * layer_capacitance(known));
}

// Under a linear width the moment of the layer is linear as well: many steps approximate it.
TEST(Layers, OfPiezoPushOnATaper) {
  constexpr int steps = 100;
  Device smooth = test::gold_pzt_cantilever(), rough = smooth;
  part_of<Beam>(smooth.structure).sections = {{.length = 250_um, .width = 40_um, .end_width = 10_um}};
  for (int k = 0; k < steps; ++k)
    part_of<Beam>(rough.structure).sections.push_back({.length = 250_um / steps, .width = 40_um - 30_um * (k + 0.5) / steps});
  const double lift = Switch(rough).basis().piezo_deflection();
  EXPECT_NEAR(Switch(smooth).basis().piezo_deflection(), lift, 1e-4 * std::abs(lift));
}

TEST(HolesInABeam, LeaveStiffnessAndMass) {
  const Holes holes{.pitch = 20_um, .size = 8_um};
  EXPECT_DOUBLE_EQ(area_left(holes), 1 - 0.16);
  EXPECT_GT(ligament_efficiency(holes), 1 - 0.4) << "the ligaments alone";
  EXPECT_LT(ligament_efficiency(holes), area_left(holes)) << "all material that is left";
  EXPECT_EQ(ligament_efficiency({}), 1);
  const Switch plain(even_beam()), holed(gold({{.length = 250_um, .holes = holes}}, 60_um, 4));
  const double softer = std::sqrt(ligament_efficiency(holes) / area_left(holes));
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double w = softer * plain.basis().angular_frequencies()[i];
    EXPECT_NEAR(holed.basis().angular_frequencies()[i], w, digits_of_modes * w);
  }
  // The field acts on the same share of the area, so that pull-in is proportional to the root of stiffness over area.
  const double volts = static_pull_in(plain, 0).voltage * std::sqrt(ligament_efficiency(holes) / area_left(holes));
  EXPECT_NEAR(static_pull_in(holed, 0).voltage, volts, 1e-9 * volts);
}

constexpr double viscosity_of_air = 1.86e-5;  // [Pa s]

// With few holes the gas leaves only at the edges.
TEST(PerforatedFilm, IsTheStripFilmWhereHolesAreFew) {
  const StripSqueezeFilm strip{.viscosity = viscosity_of_air, .width = 20_um};
  const PerforatedStripFilm film(viscosity_of_air, 20_um, 2_um, {.pitch = 20_um, .size = 0.05_um});
  for (const double gap : {0.5_um, 2_um, 3.5_um}) EXPECT_NEAR(film.load(gap, 0.1) / strip.load(gap, 0.1), 1, 1e-3) << gap;
}

// Under a wide plate the gas of every cell leaves through the cell's own hole: the pressure is uniform except at the edges.
TEST(PerforatedFilm, OfAWidePlateIsThatOfItsCells) {
  const Holes holes{.pitch = 10_um, .size = 5_um};
  const double gap = 2_um, per_width = PerforatedStripFilm(viscosity_of_air, 1e-2, 2_um, holes).load(gap, 1.0) / 1e-2;
  // The flow in a hole, at its two ends, and in the film around it, each from a textbook.
  const double hole = 5_um / std::sqrt(pi), cell = 10_um / std::sqrt(pi), flow = 10_um * 10_um;
  const double channel = 8 * viscosity_of_air * 2_um * flow / (pi * std::pow(hole, 4)),
               ends = 3 * viscosity_of_air * flow / std::pow(hole, 3);
  const auto ring = [&](double r) {
    return 12 * viscosity_of_air / std::pow(gap, 3) * (cell * cell / 2 * std::log(r / hole) - (r * r - hole * hole) / 4);
  };
  double mean = 0;  // mean pressure around the hole in the cell
  constexpr int rings = 20000;
  for (int k = 0; k < rings; ++k) {
    const double r = hole + (cell - hole) * (k + 0.5) / rings;
    mean += ring(r) * 2 * r * (cell - hole) / rings / (cell * cell);
  }
  EXPECT_NEAR(-per_width, channel + ends + mean, 2e-3 * -per_width);
}

TEST(PerforatedFilm, ObeysItsEquationAcrossTheWidth) {
  const Holes holes{.pitch = 10_um, .size = 4_um};
  const double gap = 1.5_um, width = 60_um;
  const PerforatedStripFilm film(viscosity_of_air, width, 2_um, holes);
  const double resistance = film.through + film.around / std::pow(gap, 3),
               square = std::pow(gap, 3) * resistance / (12 * viscosity_of_air);
  // p'' = p / l^2 - 12 mu v / h^3 by differences.
  constexpr int places = 2000;
  const double step = width / places;
  std::vector<double> upper(places - 1), right(places - 1);
  const double middle = -2 / (step * step) - 1 / square, beside = 1 / (step * step),
               load = -12 * viscosity_of_air / std::pow(gap, 3);
  for (int k = 0; k < places - 1; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double pivot = middle - (k > 0 ? beside * upper[i - 1] : 0);
    upper[i] = beside / pivot;
    right[i] = (load - (k > 0 ? beside * right[i - 1] : 0)) / pivot;
  }
  double force = 0, pressure = 0;
  for (std::size_t i = places - 1; i-- > 0;) {
    pressure = right[i] - upper[i] * pressure;
    force += pressure * step;
  }
  EXPECT_NEAR(-film.load(gap, 1.0), force, 1e-5 * force);
  EXPECT_LT(force, viscosity_of_air * std::pow(width / gap, 3)) << "below the strip film";
  const Dual at = film.load(Dual(gap, 1), Dual(1.0));
  constexpr double little = 1e-10;
  const double slope = (film.load(gap + little, 1.0) - film.load(gap - little, 1.0)) / (2 * little);
  EXPECT_NEAR(at.slope, slope, 1e-6 * std::abs(slope));
}

TEST(PerforatedFilm, ActsUnderASectionWithHoles) {
  const auto lost = [](const Holes& holes, const Gas& gas) {
    Device d = gold({{.length = 250_um, .holes = holes}}, 60_um, 2);
    d.gas = gas;
    const Switch model(d);
    Switch::Workspace work = model.workspace();
    const Eigen::VectorXd q = Eigen::VectorXd::Zero(2);
    Eigen::VectorXd v = model.basis().contact_shape().cwiseQuotient(model.basis().squares());
    v *= 0.1 / model.contact_deflection(v.data());
    return model.dissipated_power(q.data(), v.data(), work);
  };
  const Gas strip = *test::gold_cantilever().gas;
  EXPECT_LT(lost({.pitch = 10_um, .size = 8_um}, strip), 0.5 * lost({}, strip));
  Device refused = gold({{.length = 250_um, .holes = {.pitch = 10_um, .size = 4_um}}}, 60_um, 2);
  refused.gas = VeijolaGas{};
  try {
    validate(refused);
    ADD_FAILURE() << "a law without holes was taken";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("gas.model = veijola: not over holes"));
  }
}

// Sections in series stretch like springs in series.
TEST(Bridges, OfSectionsStretchAsSpringsInARow) {
  Structure s{
      .length = 300_um, .width = 20_um, .thickness = 2_um, .kind = Bridge{{.youngs_modulus = 78_GPa, .density = 19300}, 10e6}};
  const double force = 10e6 * 20_um * 2_um;
  part_of<Beam>(s).sections = {{.length = 100_um}, {.length = 200_um}};
  EXPECT_NEAR(beam_support(s).axial_force, force, 1e-12 * force);
  part_of<Beam>(s).sections[1].width = 60_um;
  // Every piece would shrink by 10 MPa over E times its length: 300 um in total, against 100 um + 200 um / 3 for the narrow
  // piece.
  EXPECT_NEAR(beam_support(s).axial_force, force * 300 / (100 + 200.0 / 3), 1e-9 * force);
  const Device d{.structure = s};
  const MidPlaneStretching stretching = stretching_of(beam_modes(d), s);
  EXPECT_NEAR(stretching.stiffness, 78_GPa * 20_um * 2_um / (2 * (100_um + 200_um / 3)), 1e-9 * stretching.stiffness);
}

TEST(Bridges, BeyondTheirBucklingLoadAreRefused) {
  Structure s{.length = 300_um, .width = 20_um, .thickness = 2_um, .kind = Bridge{{.youngs_modulus = 78_GPa, .density = 19300}}};
  const double limit = -buckling_stress(s);
  part_of<Beam>(s).sections = {{.length = 100_um}, {.length = 200_um}};
  part_of<Bridge>(s).residual_stress = 0.999 * limit;
  EXPECT_EQ(why_buckled(s), "");
  part_of<Bridge>(s).residual_stress = 1.001 * limit;
  EXPECT_THAT(why_buckled(s), HasSubstr("beyond the buckling load"));
  // Hinges at both ends reduce the stiffness to a quarter.
  part_of<Beam>(s).sections.clear();
  part_of<Beam>(s).anchor = part_of<Beam>(s).far_anchor = Anchor{.rotation = 0};
  part_of<Bridge>(s).residual_stress = 0.999 * limit / 4;
  EXPECT_EQ(why_buckled(s), "");
  part_of<Bridge>(s).residual_stress = 1.001 * limit / 4;
  EXPECT_THAT(why_buckled(s), HasSubstr("beyond the buckling load"));
}

std::string refusal(const Device& d) {
  try {
    validate(d);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return {};
}

TEST(PartsOfABeam, ThatCannotBeAreRefused) {
  const auto with = [](auto change, Device d = hinged()) {
    change(d, part_of<Beam>(d.structure));
    return refusal(d);
  };
  EXPECT_EQ(refusal(hinged()), "");
  EXPECT_THAT(with([](Device&, Beam& b) { b.sections[1].width = 0; }), HasSubstr("structure.sections[2].width: is 0 m"));
  EXPECT_THAT(with([](Device& d, Beam& b) { d.structure.width = 0, b.sections[0].width = not_given; }),
              HasSubstr("structure.sections[1]: needs width"));
  EXPECT_THAT(with([](Device&, Beam& b) { b.sections[1].length = 100_um; }), HasSubstr("structure.sections: have a length of"));
  EXPECT_THAT(with([](Device&, Beam& b) { b.sections[1].holes = {.pitch = 50_um, .size = 8_um}; }),
              HasSubstr("structure.sections[2].holes: the pitch"));
  EXPECT_THAT(with([](Device&, Beam& b) { b.sections[1].holes = {.pitch = 8_um, .size = 8_um}; }),
              HasSubstr("structure.sections[2].holes: needs"));
  const LayerPart layer{.begin = 0, .end = 250_um, .thickness = 0.1_um, .youngs_modulus = 70e9, .density = 2200};
  EXPECT_EQ(with([&](Device&, Beam& b) { b.layers = {layer}; }), "");
  EXPECT_THAT(with([&](Device&, Beam& b) { b.layers = {layer}, b.layers[0].end = 251_um; }),
              HasSubstr("structure.layers[1].span: from 0 m to 251 um: must increase and lie on the beam"));
  EXPECT_THAT(with([&](Device&, Beam& b) { b.layers = {layer}, b.plate_strain = true, b.poissons_ratio = 0.4; }),
              HasSubstr("structure.layers[1]: needs poissons_ratio"));
  EXPECT_THAT(with([&](Device&, Beam& b) { b.layers = {layer}, b.far_anchor = Anchor{}; }),
              HasSubstr("structure.layers: need a beam whose far end is free"));
  EXPECT_THAT(with([&](Device&, Beam& b) { b.anchor = Anchor{.rotation = 0}; }), HasSubstr("structure.anchor: nothing holds"));
  EXPECT_THAT(with([&](Device&, Beam& b) { b.anchor = Anchor{.translation = 0}; }), HasSubstr("structure.anchor: nothing holds"));
  EXPECT_THAT(with([&](Device&, Beam& b) { b.far_anchor = Anchor{.rotation = -1}; }),
              HasSubstr("structure.far_anchor: stiffnesses"));
  EXPECT_THAT(with([&](Device& d, Beam&) { d.surface = Surface{.elastic_modulus = 1}; }),
              HasSubstr("surface: is for a beam without sections"));
  EXPECT_THAT(with([&](Device& d, Beam&) { d.gas = ReynoldsGas{}; }),
              HasSubstr("gas.model = reynolds: not with a structure whose width changes"));
  EXPECT_THAT(with([&](Device& d, Beam& b) { part_of<Cantilever>(d.structure).stress_gradient = 1e10, b.far_anchor = Anchor{}; }),
              HasSubstr("structure.stress_gradient: needs a free far end"));
}

}  // namespace
}  // namespace softland
