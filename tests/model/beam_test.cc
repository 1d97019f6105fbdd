#include "model/beam.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "base/literals.h"
#include "base/require.h"
#include "integrators/roots.h"
#include "model/constants.h"
#include "tests/model/expect_refused.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;
using test::expect_refused;

constexpr double mode_digits = 1e-8;  // relative, of mode numbers and frequencies

constexpr BeamSection uniform{.begin = 0, .end = 2, .rigidity = 3, .mass_per_length = 5};

/// Returns beta_i L of the uniform cantilever: root number `mode` (from 0) of cos x cosh x = -1, written without overflow.
double cantilever_number(int mode) {
  const double middle = (mode + 0.5) * pi;
  return bracketed_zero([](double x) { return std::cos(x) + 1 / std::cosh(x); }, middle - 1, middle + 1);
}

/// Returns beta_i L of the clamped and pinned beam: tan x = tanh x.
double clamped_pinned_number(int mode) {
  const double middle = (mode + 1.25) * pi;
  return bracketed_zero([](double x) { return std::sin(x) - std::tanh(x) * std::cos(x); }, middle - 0.3, middle + 0.3);
}

/// Returns beta_i L of the beam that is clamped at both ends: cos x cosh x = 1.
double clamped_clamped_number(int mode) {
  const double middle = (mode + 1.5) * pi;
  return bracketed_zero([](double x) { return std::cos(x) - 1 / std::cosh(x); }, middle - 1, middle + 1);
}

/// Characteristic function of a uniform beam between two clamps under an axial force N, in units of EI/L^2 and w = omega L^2
/// sqrt(mu/EI). The solutions are combinations of cosh(a x), sinh(a x), cos(b x), sin(b x) with a^2 - b^2 = N, a b = w. The
/// function is 2 a b (1 - cosh a cos b) + (a^2 - b^2) sinh a sin b, here over cosh a.
double tension_characteristic(double force, double w) {
  const double root = std::sqrt(force * force / 4 + w * w);
  const double a = std::sqrt(root + force / 2), b = std::sqrt(root - force / 2);
  return 2 * a * b * (1 / std::cosh(a) - std::cos(b)) + (a * a - b * b) * std::tanh(a) * std::sin(b);
}

constexpr BeamSupport two_clamps{.far_clamp = true};

/// Returns the angular frequency of the uniform section for a mode number [rad/s].
double uniform_frequency(double number) {
  return number * number * std::sqrt(uniform.rigidity / uniform.mass_per_length) / (uniform.end * uniform.end);
}

/// Characteristic determinant of a stepped beam by transfer matrices of (deflection, slope, moment, shear), section by section
/// in closed form: zero at the natural frequencies. The far end is free, or clamped.
double characteristic(const std::vector<BeamSection>& sections, double omega, bool far_clamp = false) {
  Eigen::Matrix4d transfer = Eigen::Matrix4d::Identity();
  for (const BeamSection& s : sections) {
    const double ei = s.rigidity, k = std::pow(s.mass_per_length * omega * omega / ei, 0.25), x = k * (s.end - s.begin);
    const double a = (std::cosh(x) + std::cos(x)) / 2, b = (std::sinh(x) + std::sin(x)) / 2;
    const double c = (std::cosh(x) - std::cos(x)) / 2, d = (std::sinh(x) - std::sin(x)) / 2;
    Eigen::Matrix4d m;
    m << a, b / k, c / (ei * k * k), d / (ei * k * k * k),  //
        k * d, a, b / (ei * k), c / (ei * k * k),           //
        ei * k * k * c, ei * k * d, a, b / k,               //
        ei * k * k * k * b, ei * k * k * c, k * d, a;
    transfer = m * transfer;
  }
  return far_clamp ? transfer.topRightCorner<2, 2>().determinant() : transfer.bottomRightCorner<2, 2>().determinant();
}

TEST(BeamModes, OfTheUniformCantileverHaveTheClosedFormNumbers) {
  const BeamModes beam({uniform}, 20);
  EXPECT_NEAR(cantilever_number(0), 1.87510407, 1e-8);
  for (int i = 0; i < 20; ++i) {
    const double expected = uniform_frequency(cantilever_number(i));
    EXPECT_NEAR(beam.angular_frequencies()[i], expected, mode_digits * expected) << "mode " << i;
  }
}

TEST(BeamModes, DoNotDependOnHowTheBeamIsCut) {
  std::vector<BeamSection> pieces{uniform, uniform, uniform};
  pieces[0].end = pieces[1].begin = 0.013;  // a short piece next to long elements must not reduce the precision of the low modes
  pieces[1].end = pieces[2].begin = 1.7;
  const BeamModes whole({uniform}, 8), cut(pieces, 8);
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(cut.angular_frequencies()[i], whole.angular_frequencies()[i], mode_digits * whole.angular_frequencies()[i]);
    EXPECT_NEAR(cut.value(1.3)[i], whole.value(1.3)[i], 1e-7 * whole.value(uniform.end)[i]) << "mode " << i;
  }
}

TEST(BeamModes, DoNotJumpWhenASectionVanishes) {
  // A layer that ends very close to a section boundary, or covers almost nothing, acts nearly like one that ends there, or
  // none.
  const Device device = test::gold_pzt_cantilever();
  const double length = device.structure.length;
  const auto modes = [&](double begin, double end) {
    Device d = device;
    d.piezo->begin = begin;
    d.piezo->end = end;
    return BeamModes(beam_sections(d), 4);
  };
  const BeamModes full = modes(0, length), bare(beam_sections(test::gold_cantilever()), 4);
  for (double part = 1e-3; part > 1e-16; part /= 10) {
    const auto expect_close = [&](const BeamModes& found, const BeamModes& limit, const char* what) {
      for (int i = 0; i < 4; ++i) {
        const double expected = limit.angular_frequencies()[i], bound = (20 * part + mode_digits) * expected;
        EXPECT_NEAR(found.angular_frequencies()[i], expected, bound) << what << ", part " << part << ", mode " << i;
      }
      EXPECT_NEAR(found.pinned_frequency(247.5_um), limit.pinned_frequency(247.5_um),
                  (20 * part + mode_digits) * limit.pinned_frequency(247.5_um));
      EXPECT_NEAR(found.slope(200_um)[1], limit.slope(200_um)[1], (20 * part + 1e-7) * limit.slope(length)[1]);
    };
    expect_close(modes(0, length * (1 - part)), full, "short of the tip");
    expect_close(modes(length * part, length), full, "short of the root");
    expect_close(modes(length / 2, length / 2 * (1 + part)), bare, "a sliver");
  }
}

TEST(BeamModes, OfASteppedBeamAreTheZerosOfTheTransferDeterminant) {
  const std::vector<BeamSection> sections = beam_sections(test::gold_pzt_cantilever());
  ASSERT_EQ(sections.size(), 3u);
  const BeamModes beam(sections, 6);
  const auto determinant = [&](double omega) { return characteristic(sections, omega); };
  // All zeros up to the sixth mode, from a scan that is fine compared with their spacing.
  std::vector<double> zeros;
  const double step = beam.angular_frequencies()[0] / 4;
  for (double omega = step; zeros.size() < 6; omega += step) {
    if ((determinant(omega) < 0) != (determinant(omega + step) < 0)) {
      zeros.push_back(bracketed_zero(determinant, omega, omega + step));
    }
  }
  for (int i = 0; i < 6; ++i) {
    const double expected = zeros[static_cast<std::size_t>(i)];
    EXPECT_NEAR(beam.angular_frequencies()[i], expected, mode_digits * expected) << "mode " << i;
  }
}

TEST(BeamModes, AreOrthonormalInTheMassOfTheBeam) {
  constexpr int modes = 6;
  constexpr double rounding = 1e-9;
  const std::vector<BeamSection> sections = beam_sections(test::gold_pzt_cantilever());
  const BeamModes beam(sections, modes);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(modes, modes);
  for (const BeamSection& s : sections) {
    constexpr int parts = 12;  // number of parts with thirty Gauss points each, many more than the shapes need
    using Rule = boost::math::quadrature::gauss<double, 30>;
    const double width = (s.end - s.begin) / parts;
    for (int p = 0; p < parts; ++p) {
      for (std::size_t g = 0; g < Rule::abscissa().size(); ++g) {
        for (const double sign : {-1.0, 1.0}) {
          const double x = s.begin + width * (p + 0.5 + sign * Rule::abscissa()[g] / 2);
          const Eigen::VectorXd phi = beam.value(x);
          gram += s.mass_per_length * Rule::weights()[g] * width / 2 * phi * phi.transpose();
        }
      }
    }
  }
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(modes, modes)).cwiseAbs().maxCoeff(), rounding) << gram;
}

TEST(BeamModes, OfTheUniformCantileverEndAtTwoOverRootMass) {
  const BeamModes beam({uniform}, 10);
  const double expected = 2 / std::sqrt(uniform.mass_per_length * uniform.end);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(beam.value(uniform.end)[i], expected, 1e-7 * expected) << "mode " << i;
}

TEST(BeamModes, AreClampedAndRiseToAPositiveTip) {
  const BeamModes beam(beam_sections(test::gold_pzt_cantilever()), 8);
  constexpr double rounding = 1e-12;
  const double length = 250_um, tip = beam.value(length)[0];
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(beam.value(0)[i], 0, rounding * tip);
    EXPECT_NEAR(beam.slope(0)[i], 0, rounding * tip / length);
    EXPECT_GT(beam.value(length)[i], 0.1 * tip);
  }
}

TEST(BeamModes, SlopeIsTheDerivativeOfTheShape) {
  const BeamModes beam(beam_sections(test::gold_pzt_cantilever()), 6);
  const double h = 0.01_um;
  for (const double x : {3_um, 5_um, 100_um, 239_um, 249_um}) {
    const Eigen::VectorXd difference =
        (8 * (beam.value(x + h) - beam.value(x - h)) - (beam.value(x + 2 * h) - beam.value(x - 2 * h))) / (12 * h);
    const Eigen::VectorXd slope = beam.slope(x);
    // At a change of section the curvature jumps: the derivative is the mean of one-sided differences to first order in h.
    const double tolerance = (x == 5_um ? 1e-3 : 1e-7) * slope.cwiseAbs().maxCoeff();
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(slope[i], difference[i], tolerance) << "mode " << i << " at " << x;
  }
}

TEST(BeamModes, BetweenTwoClampsHaveTheClosedFormNumbers) {
  const BeamModes beam({uniform}, 20, two_clamps);
  EXPECT_NEAR(clamped_clamped_number(0), 4.73004, 1e-5);
  EXPECT_NEAR(clamped_clamped_number(1), 7.85320, 1e-5);
  EXPECT_NEAR(clamped_clamped_number(2), 10.99561, 1e-5);
  for (int i = 0; i < 20; ++i) {
    const double expected = uniform_frequency(clamped_clamped_number(i));
    EXPECT_NEAR(beam.angular_frequencies()[i], expected, mode_digits * expected) << "mode " << i;
  }
}

TEST(BeamModes, BetweenTwoClampsAreClampedSymmetricAndPositiveAtFirst) {
  const BeamModes beam({uniform}, 8, two_clamps);
  constexpr double rounding = 1e-10;
  const double length = uniform.end, middle = beam.value(length / 2)[0];
  for (int i = 0; i < 8; ++i) {
    for (const double end : {0.0, length}) {
      EXPECT_NEAR(beam.value(end)[i], 0, rounding * middle) << "mode " << i;
      EXPECT_NEAR(beam.slope(end)[i], 0, rounding * 50 * middle / length) << "mode " << i;
    }
    const double parity = i % 2 == 0 ? 1 : -1;
    EXPECT_NEAR(beam.value(0.3 * length)[i], parity * beam.value(0.7 * length)[i], 1e-7 * middle) << "mode " << i;
    EXPECT_GT(beam.value(0.01 * length)[i], 0) << "mode " << i;
  }
}

TEST(BeamModes, OfASteppedBeamBetweenTwoClampsAreTheZerosOfTheTransferDeterminant) {
  const std::vector<BeamSection> sections = beam_sections(test::gold_pzt_cantilever());
  const BeamModes beam(sections, 4, two_clamps);
  const double step = beam.angular_frequencies()[0] / 50;
  for (int i = 0; i < 4; ++i) {
    const double found = beam.angular_frequencies()[i];
    const double zero =
        bracketed_zero([&](double omega) { return characteristic(sections, omega, true); }, found - step, found + step);
    EXPECT_NEAR(found, zero, mode_digits * zero) << "mode " << i;
  }
}

TEST(BeamModes, UnderAnAxialForceAreTheZerosOfTheCharacteristicFunction) {
  // The forces range from nearly buckled to a stretched string; in units of EI/L^2.
  for (const double force : {-39.0, -20.0, 5.0, 100.0, 3000.0}) {
    const double unit = uniform.rigidity / (uniform.end * uniform.end);
    const BeamModes beam({uniform}, 6, {.far_clamp = true, .axial_force = force * unit});
    const double scale = uniform_frequency(1);
    for (int i = 0; i < 6; ++i) {
      const double w = beam.angular_frequencies()[i] / scale;
      const double zero = bracketed_zero([&](double x) { return tension_characteristic(force, x); }, 0.999 * w, 1.001 * w);
      EXPECT_NEAR(w, zero, mode_digits * zero) << "force " << force << ", mode " << i;
    }
  }
}

TEST(BeamModes, BucklesAtTheClosedFormLoad) {
  // At -4 pi^2 EI/L^2 the beam buckles: the square of the first frequency goes to zero nearly in proportion to the distance.
  const double load = -4 * pi * pi * uniform.rigidity / (uniform.end * uniform.end);
  const auto beam = [&](double part) { return BeamModes({uniform}, 2, {.far_clamp = true, .axial_force = part * load}); };
  constexpr double close = 1e-7;
  const double free = beam(0).angular_frequencies()[0];
  const double buckled = 16 * std::pow(pi, 4) / 3 * close;  // Rayleigh's quotient of the buckled shape, 1 - cos(2 pi x/L)
  EXPECT_NEAR(std::pow(beam(1 - close).angular_frequencies()[0] / free, 2), buckled / std::pow(clamped_clamped_number(0), 4),
              1e-4 * close);
  EXPECT_NEAR(std::pow(beam(0.5).angular_frequencies()[0] / free, 2), 0.5, 0.02);
  expect_refused([] { (void)BeamModes({uniform}, 2, {.far_clamp = true, .axial_force = -30}); },
                 "axial force -30 N: beyond the buckling load of the beam");
  EXPECT_THROW((void)beam(1 + close), InvalidInput);
}

/// Returns a function that vanishes at the modes of a cantilever under the axial force [EI/L^2], omega in units of sqrt(EI/(mu
/// L^4)). At its free end the moment is zero, and the shear force balances the axial force times w'.
double free_end_characteristic(double force, double omega) {
  const double half = force / 2, root = std::hypot(half, omega);
  const double a = std::sqrt(root + half), b = std::sqrt(root - half);  // w of cosh ax, cos bx, sinh ax, sin bx
  const double w2_even = a * a * std::cosh(a) + b * b * std::cos(b), w2_odd = a * a * std::sinh(a) + a * b * std::sin(b);
  const double w3_even = a * (a * a - force) * std::sinh(a) - b * (b * b + force) * std::sin(b);
  const double w3_odd = a * (a * a - force) * std::cosh(a) + a * (b * b + force) * std::cos(b);
  return w2_even * w3_odd - w2_odd * w3_even;
}

TEST(BeamModes, OfACantileverUnderAnAxialForceAreTheZerosOfTheCharacteristicFunction) {
  for (const double force : {-2.4, -1.0, 5.0, 100.0}) {
    const double unit = uniform.rigidity / (uniform.end * uniform.end);
    const BeamModes beam({uniform}, 4, {.axial_force = force * unit});
    const double scale = uniform_frequency(1);
    for (int i = 0; i < 4; ++i) {
      const double w = beam.angular_frequencies()[i] / scale;
      const double zero = bracketed_zero([&](double x) { return free_end_characteristic(force, x); }, 0.999 * w, 1.001 * w);
      EXPECT_NEAR(w, zero, mode_digits * zero) << "force " << force << ", mode " << i;
    }
  }
}

TEST(BeamModes, SlopeProductsAreTheIntegrals) {
  for (const bool clamp : {false, true}) {
    const BeamModes beam({uniform}, 4, {.far_clamp = clamp});
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(4, 4);
    constexpr int parts = 40;
    using Rule = boost::math::quadrature::gauss<double, 7>;
    const double half = uniform.end / parts / 2;
    for (int p = 0; p < parts; ++p) {
      for (std::size_t g = 0; g < Rule::abscissa().size(); ++g) {
        for (const double sign : {-1.0, 1.0}) {
          if (g == 0 && sign > 0) continue;  // the middle point
          const Eigen::VectorXd slope = beam.slope(half * (2 * p + 1 + sign * Rule::abscissa()[g]));
          sum += Rule::weights()[g] * half * slope * slope.transpose();
        }
      }
    }
    EXPECT_LT((beam.slope_products() - sum).cwiseAbs().maxCoeff(), 1e-9 * sum.maxCoeff()) << clamp;
  }
}

TEST(PinnedBeam, BetweenTwoClampsHeldInTheMiddleIsTwoClampedPinnedHalves) {
  const BeamModes beam({uniform}, 4, two_clamps);
  const double expected = 4 * uniform_frequency(clamped_pinned_number(0));
  EXPECT_NEAR(beam.pinned_frequency(uniform.end / 2), expected, mode_digits * expected);
}

TEST(AxialStress, OfAFilmIsWhatItsFreeSidesLeave) {
  Structure s = test::hung_senturia().structure;
  Bridge& bridge = part_of<Bridge>(s);
  EXPECT_EQ(axial_stress(bridge), -3.7e6);
  bridge.biaxial = true;
  bridge.poissons_ratio = 0.25;
  EXPECT_DOUBLE_EQ(axial_stress(bridge), 0.75 * -3.7e6);
  EXPECT_DOUBLE_EQ(beam_support(s).axial_force, 0.75 * -3.7e6 * 40_um * 2.2_um);
  EXPECT_DOUBLE_EQ(buckling_stress(s), pi * pi / 3 * 149_GPa * std::pow(2.2 / 610, 2));
  EXPECT_FALSE(beam_support(test::gold_cantilever().structure).far_clamp);
}

TEST(PinnedBeam, HasTheClampedPinnedFrequencyWhenHeldAtTheTip) {
  const BeamModes beam({uniform}, 4);
  EXPECT_NEAR(clamped_pinned_number(0), 3.92660231, 1e-8);
  const double expected = uniform_frequency(clamped_pinned_number(0));
  EXPECT_NEAR(beam.pinned_frequency(uniform.end), expected, mode_digits * expected);
}

TEST(PinnedBeam, HasTheFreeFrequencyWhenHeldAtANode) {
  // A beam that is held at a node of its second mode keeps that frequency.
  const BeamModes beam({uniform}, 4);
  const double node = bracketed_zero([&](double x) { return beam.value(x)[1]; }, 1.2, uniform.end);
  EXPECT_NEAR(beam.pinned_frequency(node), beam.angular_frequencies()[1], 1e-6 * beam.angular_frequencies()[1]);
}

TEST(BeamSections, FollowTheLayer) {
  const Device device = test::gold_pzt_cantilever();
  const std::vector<BeamSection> s = beam_sections(device);
  ASSERT_EQ(s.size(), 3u);
  EXPECT_EQ(s[0].begin, 0);
  EXPECT_EQ(s[1].begin, device.piezo->begin);
  EXPECT_EQ(s[2].begin, device.piezo->end);
  EXPECT_EQ(s[2].end, device.structure.length);
  EXPECT_EQ(s[0].rigidity, s[2].rigidity);
  EXPECT_GT(s[1].rigidity, s[0].rigidity);
  EXPECT_EQ(beam_sections(test::gold_cantilever()).size(), 1u);
  Device full = device;
  full.piezo->begin = 0;
  full.piezo->end = full.structure.length;
  EXPECT_EQ(beam_sections(full).size(), 1u);
}

// Zheng, Chen & Chen 2017: silicon beam with a PZT-4 layer; published neutral axis and rigidity.
Device zheng_cantilever() {
  return {.structure = {.length = 100_um,
                        .width = 15_um,
                        .thickness = 3_um,
                        .kind = Cantilever{{.youngs_modulus = 169_GPa, .density = 2331_kg_m3}}},
          .gap = {.electrode = 1_um, .contact = 0.9_um},
          .piezo = Piezo{.begin = 0,
                         .end = 100_um,
                         .thickness = 0.5_um,
                         .youngs_modulus = 78.6_GPa,
                         .density = 7500_kg_m3,
                         .d31 = -9.29 / 78.6_GPa}};
}

TEST(CompositeSection, IsThePublishedOne) {
  const Device d = zheng_cantilever();
  const CompositeSection s = layered_section(d.structure, *d.piezo);
  EXPECT_NEAR(s.neutral_axis, 1.874_um, 0.001_um);
  EXPECT_NEAR(s.rigidity, 7.3915e-12, 1e-4 * 7.3915e-12);
  EXPECT_NEAR(plain_section(d.structure).rigidity, 5.704e-12, 1e-4 * 5.704e-12);
  EXPECT_DOUBLE_EQ(s.mass_per_length, 15_um * (2331 * 3_um + 7500 * 0.5_um));
  EXPECT_DOUBLE_EQ(plain_section(d.structure).mass_per_length, 15_um * 2331 * 3_um);
}

TEST(CompositeSection, OfTwoEqualMaterialsIsAThickerBeam) {
  Structure s = zheng_cantilever().structure;
  const auto& beam = part_of<Beam>(s);
  const Piezo same{
      .begin = 0, .end = s.length, .thickness = 2_um, .youngs_modulus = beam.youngs_modulus, .density = beam.density};
  const CompositeSection layered = layered_section(s, same);
  s.thickness += same.thickness;
  const CompositeSection thick = plain_section(s);
  EXPECT_NEAR(layered.neutral_axis, s.thickness / 2, 1e-12 * s.thickness);
  EXPECT_NEAR(layered.rigidity, thick.rigidity, 1e-12 * thick.rigidity);
  EXPECT_NEAR(layered.mass_per_length, thick.mass_per_length, 1e-12 * thick.mass_per_length);
}

TEST(BendingModulus, IsUsedAsGivenUnlessPlateStrainIsAskedFor) {
  Structure s = zheng_cantilever().structure;
  Beam& beam = part_of<Beam>(s);
  beam.poissons_ratio = 0.3;
  EXPECT_EQ(bending_modulus(s), beam.youngs_modulus);
  beam.plate_strain = true;
  EXPECT_DOUBLE_EQ(bending_modulus(s), beam.youngs_modulus / 0.91);
}

TEST(PiezoMoment, OfTheGoldDeviceIsTheReference) {
  const Device d = test::gold_pzt_cantilever();
  constexpr double reference = -2.24964e-10;  // [N m / V], independent program
  EXPECT_NEAR(piezo_moment_per_volt(d.structure, *d.piezo), reference, 1e-5 * std::abs(reference));
}

TEST(PiezoMoment, BendsTheBeamIntoACircularArcAsFarAsTheLayerReaches) {
  const Device d = test::gold_pzt_cantilever();
  const double begin = d.piezo->begin.value, end = d.piezo->end.value, tip_position = d.contact_position();
  const double moment = piezo_moment_per_volt(d.structure, *d.piezo);
  const auto tip = [&](int modes) {
    const BeamModes beam(beam_sections(d), modes);
    const Eigen::VectorXd force = moment * (beam.slope(end) - beam.slope(begin));
    return force.cwiseQuotient(beam.angular_frequencies().cwiseAbs2()).dot(beam.value(tip_position));
  };
  // Exact solution: constant curvature M / EI over the layer, straight beyond it.
  const double exact =
      moment / layered_section(d.structure, *d.piezo).rigidity * (end - begin) * (tip_position - (begin + end) / 2);
  EXPECT_NEAR(exact, -2.121_um, 0.001_um);  // independent program, per volt
  EXPECT_NEAR(tip(4), -2.109_um, 0.001_um);
  EXPECT_NEAR(tip(40), exact, 1e-4 * std::abs(exact));
  EXPECT_LT(std::abs(tip(12) - exact), std::abs(tip(4) - exact));
}

// A beam whose sections, support and tension differ from the nominal ones by about `spread`.
struct Sample {
  std::vector<BeamSection> sections;
  BeamSupport support;
};
Sample sampled(int shape, double spread, std::mt19937_64& random) {
  const auto factor = [&] { return std::exp(spread * std::normal_distribution<>()(random)); };
  Sample s;
  s.support.far_clamp = shape % 2 == 1;
  const double length = 2 * factor(), begin = 0.1 * factor(), end = std::min(1.8 * factor(), 0.99 * length);
  const double rigidity = 3 * factor(), mass = 5 * factor();
  if (shape < 2) {
    s.sections = {{0, begin, rigidity, mass},
                  {begin, end, 2.5 * rigidity * factor(), 1.6 * mass * factor()},
                  {end, length, rigidity, mass}};
  } else {
    s.sections = {{0, length, rigidity, mass}};
  }
  const double unit = rigidity / (length * length);
  if (shape == 2) s.support.axial_force = -0.8 * factor() * unit;
  if (shape == 3) s.support.axial_force = 60 * factor() * unit;
  if (shape == 5) s.support.axial_force = -15 * factor() * unit;
  return s;
}

TEST(BeamModes, FromThoseOfASimilarBeamAreTheSame) {
  // Frequencies agree up to the rounding of a search, which grows as the highest lambda over the lowest. Shapes agree up to
  // that over the distance to the next lambda. Observed: 1e-11 and 1e-10 with GCC, 5e-11 and 4e-10 with clang, which fuses
  // other products and sums.
  constexpr double frequency_rounding = 1e-10, shape_rounding = 1e-9;
  std::mt19937_64 random(5);
  for (const int modes : {1, 4, 6}) {
    for (int shape = 0; shape < 6; ++shape) {
      int searched_again = 0;
      const Sample nominal = sampled(shape, 0, random);
      const BeamModes known(nominal.sections, modes, nominal.support);
      for (const double spread : {0.0, 0.02, 0.1, 0.4}) {
        for (int i = 0; i < 20; ++i) {
          const Sample s = sampled(shape, spread, random);
          const double length = s.sections.back().end;
          const auto built = [&](std::shared_ptr<const NormalisedModes> from) -> std::optional<BeamModes> {
            try {
              return BeamModes(s.sections, modes, s.support, std::move(from));
            } catch (const InvalidInput&) {
              return std::nullopt;
            }
          };
          SCOPED_TRACE(fmt::format("{} modes, shape {}, spread {}, device {}", modes, shape, spread, i));
          const std::optional<BeamModes> searched = built(nullptr), followed = built(known.normalised());
          ASSERT_EQ(searched.has_value(), followed.has_value());  // a beam that buckles is refused by both methods
          if (!searched) continue;
          const Eigen::ArrayXd ratio = followed->angular_frequencies().array() / searched->angular_frequencies().array();
          EXPECT_LT((ratio - 1).abs().maxCoeff(), frequency_rounding);
          EXPECT_NEAR(followed->pinned_frequency(0.55 * length) / searched->pinned_frequency(0.55 * length), 1, 1e-10);
          for (const double x : {0.05, 0.3, 0.77, 0.93, 1.0}) {
            const Eigen::VectorXd value = searched->value(x * length), slope = searched->slope(x * length);
            EXPECT_LT((followed->value(x * length) - value).cwiseAbs().maxCoeff(),
                      shape_rounding * searched->value(length / 3).norm());
            EXPECT_LT((followed->slope(x * length) - slope).cwiseAbs().maxCoeff(),
                      shape_rounding * searched->slope(length / 8).norm());
          }
          const Eigen::MatrixXd products = searched->slope_products();
          EXPECT_LT((followed->slope_products() - products).cwiseAbs().maxCoeff(), shape_rounding * products.maxCoeff());
          const bool is_known = followed->normalised() == known.normalised();
          if (spread == 0.02 && !is_known && followed->slope_products() == products) ++searched_again;
        }
      }
      EXPECT_LT(searched_again, 10) << "a beam so near has other roundings, as it is mostly found without a search";
    }
  }
}

TEST(BeamModes, FromThoseOfAnotherBeamAreStillItsOwn) {
  // The beams differ much from the known one: no mode may be skipped or found twice.
  const BeamModes known({{0, 1.5, 1, 1}, {1.5, 2, 1, 1}}, 5);
  std::mt19937_64 random(8);
  const auto factor = [&] { return std::exp(3 * std::uniform_real_distribution<>(-1, 1)(random)); };
  for (int i = 0; i < 100; ++i) {
    const double step = std::uniform_real_distribution<>(0.1, 1.9)(random);
    const std::vector<BeamSection> sections{{0, step, factor(), factor()}, {step, 2, factor(), factor()}};
    const BeamModes searched(sections, 5), followed(sections, 5, {}, known.normalised());
    const Eigen::ArrayXd ratio = followed.angular_frequencies().array() / searched.angular_frequencies().array();
    EXPECT_LT((ratio - 1).abs().maxCoeff(), 1e-9) << i;
  }
}

TEST(BeamModes, RefuseSectionsThatAreNoBeam) {
  const auto build = [](std::vector<BeamSection> sections, int modes) { return [=] { (void)BeamModes(sections, modes); }; };
  expect_refused(build({uniform}, 0), "modes = 0: must be from 1 to 40");
  expect_refused(build({uniform}, 41), "modes = 41: must be from 1 to 40");
  expect_refused(build({}, 4), "beam sections must start at x = 0");
  BeamSection late = uniform;
  late.begin = 0.1;
  expect_refused(build({late}, 4), "beam sections must start at x = 0");
  const std::string positive = "beam section 0: needs end > begin, rigidity > 0 and mass_per_length > 0";
  for (double BeamSection::*member : {&BeamSection::end, &BeamSection::rigidity, &BeamSection::mass_per_length}) {
    for (const double bad : {0.0, -1.0, std::nan("")}) {
      BeamSection broken = uniform;
      broken.*member = bad;
      expect_refused(build({broken}, 4), positive);
    }
  }
  BeamSection next = uniform;
  next.begin = 2.5, next.end = 3;
  expect_refused(build({uniform, next}, 4), "beam section 1 must begin where the one before it ends");
}

}  // namespace
}  // namespace softland
