// Every force law: its value in closed form, its derivative, and its energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/exp_sinh.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/literals.h"
#include "model/constants.h"
#include "model/contact/contact_law.h"
#include "model/distributed_law.h"
#include "model/dual.h"
#include "model/far_side.h"
#include "model/forces/dispersion.h"
#include "model/forces/electrostatic.h"
#include "model/forces/gold_casimir.h"
#include "model/gas/gas_law.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

/// Returns f'(x) by central differences of eighth order with step h.
template <class F>
double derivative(F&& f, double x, double h) {
  return (672 * (f(x + h) - f(x - h)) - 168 * (f(x + 2 * h) - f(x - 2 * h)) + 32 * (f(x + 3 * h) - f(x - 3 * h)) -
          3 * (f(x + 4 * h) - f(x - 4 * h))) /
         (840 * h);
}

/// Lists the laws that a scene can name, from the variant that holds them.
template <class Variant>
struct LawsOf;
template <class... Laws>
struct LawsOf<std::variant<Laws...>> {
  using Types = testing::Types<Laws...>;
};

// ---- fringing: the same checks for every factor

template <class Law>
Law fringing(double width, double thickness) {
  if constexpr (requires { Law{.width = width, .thickness = thickness}; }) {
    return Law{.width = width, .thickness = thickness};
  } else {
    return Law{.width = width};
  }
}

template <class Law>
class FringingLawOfType : public testing::Test {};
using FringingLaws = LawsOf<FringingLaw>::Types;
TYPED_TEST_SUITE(FringingLawOfType, FringingLaws);

constexpr std::array gaps{0.03_um, 0.2_um, 1_um, 3.5_um, 20_um};

TYPED_TEST(FringingLawOfType, ForceIsMinusHalfTheSlopeOfTheCapacitance) {
  constexpr double differences = 1e-9;  // relative: rounding of the difference quotient
  const ElectrostaticForce<TypeParam> law{fringing<TypeParam>(20_um, 2_um)};
  for (const double h : gaps) {
    const double slope = derivative([&](double x) { return law.capacitance(x); }, h, h / 200);
    const double force = law.load(h, 0.0);
    EXPECT_NEAR(-slope / 2, force, differences * force) << "gap " << h;
  }
}

TYPED_TEST(FringingLawOfType, DualSlopeIsTheComplexStepDerivative) {
  constexpr double step = 1e-30;  // complex step: no rounding limits its size
  const ElectrostaticForce<TypeParam> law{fringing<TypeParam>(20_um, 2_um)};
  for (const double h : gaps) {
    const Dual dual = law.load(Dual(h, 1), Dual(0.1));
    const std::complex<double> at = law.load(std::complex<double>(h, step), std::complex<double>(0.1));
    EXPECT_DOUBLE_EQ(dual.value, at.real());
    EXPECT_NEAR(dual.slope, at.imag() / step, 1e-13 * std::abs(dual.slope)) << "gap " << h;
    EXPECT_EQ(law.load(Dual(h), Dual(0.1, 1)).slope, 0) << "no dependence on the velocity";
  }
}

TYPED_TEST(FringingLawOfType, PullsAndPullsHarderAtSmallerGaps) {
  const ElectrostaticForce<TypeParam> law{fringing<TypeParam>(20_um, 2_um)};
  double previous = 0;
  for (double h = 20_um; h > 0.01_um; h /= 1.1) {
    const double force = law.load(h, 0.0);
    EXPECT_GT(force, previous);
    previous = force;
  }
}

TYPED_TEST(FringingLawOfType, BecomesTheParallelPlateAtVanishingGap) {
  const TypeParam law = fringing<TypeParam>(20_um, 2_um);
  EXPECT_NEAR(law.factor(1e-6 * 20_um), 1, 2e-3);  // the face term of van der Meijs & Fokkema vanishes like the root of h
  EXPECT_GE(law.factor(1_nm), 1);
}

TEST(ParallelPlate, IsEps0AreaOverTwoGapSquared) {
  const ElectrostaticForce<NoFringing> law{{.width = 20_um}};
  EXPECT_NEAR(law.load(2_um, 0.0), 8.8541878128e-12 * 20e-6 / (2 * 4e-12), 1e-18);
  EXPECT_NEAR(law.capacitance(2_um), 8.8541878128e-12 * 10, 1e-24);
}

// An electrode above the beam, 5 um away at rest, and one with faces on both sides. The rest gap below is 3.5 um.
template <class Law>
FarSide<ElectrostaticForce<Law>> above() {
  return {.law = {fringing<Law>(20_um, 2_um)}, .both_gaps = 8.5_um, .floor = 0.05_um};
}

TYPED_TEST(FringingLawOfType, OnTheFarSideIsTheMirrorImage) {
  const ElectrostaticForce<TypeParam> law{fringing<TypeParam>(20_um, 2_um)};
  const auto far = above<TypeParam>();
  const BothSides<ElectrostaticForce<TypeParam>> both{.near = law, .far = far};
  for (const double h : {0.03_um, 0.2_um, 1_um, 3.5_um, 8.4_um}) {
    EXPECT_EQ(far.load(h, 0.1), -law.load(8.5_um - h, -0.1));
    EXPECT_EQ(far.potential(h), law.potential(8.5_um - h));
    EXPECT_EQ(both.load(h, 0.1), law.load(h, 0.1) + far.load(h, 0.1));
    EXPECT_EQ(both.potential(h), law.potential(h) + far.potential(h));
  }
}

TYPED_TEST(FringingLawOfType, OnTheFarSideHasItsPotentialAndGoesOnAsATangent) {
  constexpr double differences = 1e-8, little = 1e-10;
  const auto far = above<TypeParam>();
  const double floor = far.both_gaps - far.floor;  // value of the floor in terms of the near gap
  for (const double h : {3.5_um, 8.3_um, 8.44_um, 8.48_um, 8.6_um}) {
    const double expected = derivative([&](double x) { return far.potential(x); }, h, 0.5_nm);
    EXPECT_NEAR(far.load(h, 0.0), expected, differences * std::abs(expected)) << "gap " << h;
    const double slope = derivative([&](double x) { return far.load(x, 0.0); }, h, 0.5_nm);
    EXPECT_NEAR(far.load(Dual(h, 1), Dual()).slope, slope, differences * std::abs(slope)) << "gap " << h;
  }
  EXPECT_NEAR(far.load(floor * (1 - little), 0.0) / far.load(floor * (1 + little), 0.0), 1, 1e-6);
  EXPECT_TRUE(std::isfinite(far.load(8.5_um, 0.0))) << "where the mirrored gap vanishes";
}

TEST(FringingFactor, IsTheTabulatedOne) {
  constexpr double printed = 6e-5;         // four decimals
  constexpr double differentiated = 2e-4;  // the table has this column from difference quotients of the capacitance
  struct Row {
    double a_over_h, b_over_h, bao, linear, meijs_fokkema;
  };
  constexpr std::array<Row, 9> table{{{50, 0.5, 1.0406, 1.0130, 1.0217},
                                      {20, 1, 1.0940, 1.0325, 1.0546},
                                      {10, 0.1, 1.1295, 1.0650, 1.0640},
                                      {10, 0.5, 1.1517, 1.0650, 1.0847},
                                      {10, 1, 1.1658, 1.0650, 1.1002},
                                      {5, 0.5, 1.2592, 1.1300, 1.1543},
                                      {2, 0.5, 1.5021, 1.3250, 1.3451},
                                      {2, 1, 1.5731, 1.3250, 1.4227},
                                      {1, 1, 1.9255, 1.6500, 1.7951}}};
  constexpr double h = 2_um;
  for (const Row& row : table) {
    const double a = row.a_over_h * h, b = row.b_over_h * h;
    EXPECT_NEAR(fringing<Bao2001Fringing>(a, b).factor(h), row.bao, printed) << row.a_over_h << " " << row.b_over_h;
    EXPECT_NEAR(fringing<LinearFringing>(a, b).factor(h), row.linear, printed) << row.a_over_h;
    EXPECT_NEAR(fringing<MeijsFokkemaFringing>(a, b).factor(h), row.meijs_fokkema, differentiated)
        << row.a_over_h << " " << row.b_over_h;
  }
}

TEST(FringingFactor, OfMeijsAndFokkemaHasTheirExponents) {
  // At h = a = b the factor is one plus both coefficients; each term has its own power of h/a and b/h.
  EXPECT_DOUBLE_EQ(fringing<MeijsFokkemaFringing>(1, 1).factor(1.0), 1 + 0.265 + 0.53);
  EXPECT_DOUBLE_EQ(fringing<MeijsFokkemaFringing>(16, 1).factor(1.0), 1 + 0.265 / 8 + 0.53 / 16);
  EXPECT_DOUBLE_EQ(fringing<MeijsFokkemaFringing>(16, 0.25).factor(1.0), 1 + 0.265 / 8 + 0.53 / 32);
}

TEST(FringingFactor, OfMeijsAndFokkemaIsCloseToTheBoundaryElementSolution) {
  // Independent two-dimensional boundary elements; the header states an error of 1.5 % for b <= h.
  struct Row {
    double a_over_h, b_over_h, truth;
  };
  constexpr std::array<Row, 9> table{{{50, 0.5, 1.0173},
                                      {20, 1, 1.0466},
                                      {10, 0.1, 1.0631},
                                      {10, 0.5, 1.0800},
                                      {10, 1, 1.0903},
                                      {5, 0.5, 1.1520},
                                      {2, 0.5, 1.3505},
                                      {2, 1, 1.4122},
                                      {1, 1, 1.8003}}};
  for (const Row& row : table) {
    const double factor = fringing<MeijsFokkemaFringing>(row.a_over_h, row.b_over_h).factor(1.0);
    EXPECT_NEAR(factor, row.truth, 0.015 * row.truth) << row.a_over_h << " " << row.b_over_h;
    const double bao = fringing<Bao2001Fringing>(row.a_over_h, row.b_over_h).factor(1.0);
    EXPECT_GT(bao, 1.02 * row.truth) << "the header says 2 to 11 % too much force";
    EXPECT_LT(bao, 1.115 * row.truth);
  }
}

// ---- dispersion

constexpr VanDerWaals gold_surfaces{.hamaker_constant = 4e-19, .equilibrium_distance = 0.3_nm};

template <class Pressure>
Pressure dispersion() {
  if constexpr (requires(Pressure p) { p.van_der_waals; }) {
    return {.casimir = {}, .van_der_waals = gold_surfaces};
  } else if constexpr (std::is_same_v<Pressure, VanDerWaals>) {
    return gold_surfaces;
  } else {
    return {};
  }
}

template <class Pressure>
class DispersionLaw : public testing::Test {};
using DispersionLaws =
    testing::Types<IdealCasimir, GoldCasimir, VanDerWaals, SmallerOfBoth<IdealCasimir>, SmallerOfBoth<GoldCasimir>>;
TYPED_TEST_SUITE(DispersionLaw, DispersionLaws);

// The gaps lie between the knots of the gold table, at some of them, beyond its ends, and on both sides of the crossovers.
constexpr std::array dispersion_gaps{0.2_nm, 0.7_nm, 1.4_nm, 5_nm, 8_nm, 20_nm, 33_nm, 60_nm, 62_nm, 300_nm, 2_um, 4_um, 9_um};

TYPED_TEST(DispersionLaw, PressureIsTheSlopeOfTheEnergyThatVanishesFarAway) {
  constexpr double differences = 1e-8;  // relative: rounding of the difference quotient
  const TypeParam law = dispersion<TypeParam>();
  const auto expect_slope = [&](double h) {
    const double slope = derivative([&](double x) { return law.energy(x); }, h, h / 500);
    EXPECT_NEAR(slope, law.pressure(h), differences * std::abs(slope)) << "gap " << h;
  };
  for (const double h : dispersion_gaps) expect_slope(h);
  expect_slope(100_um);  // a gap beyond the tabulated ones of gold
  EXPECT_LT(std::abs(law.energy(1.0)), 1e-15 * std::abs(law.energy(1_nm)));
}

TYPED_TEST(DispersionLaw, DualSlopeIsTheDerivativeOfThePressure) {
  constexpr double differences = 1e-8;
  const TypeParam law = dispersion<TypeParam>();
  for (const double h : dispersion_gaps) {
    const double slope = derivative([&](double x) { return law.pressure(x); }, h, h / 500);
    EXPECT_NEAR(law.pressure(Dual(h, 1)).slope, slope, differences * std::abs(slope)) << "gap " << h;
  }
}

TEST(Casimir, PressureOfIdealConductorsIsTheTabulatedOne) {
  constexpr double printed = 4e-4;  // relative: four digits
  const IdealCasimir law;
  for (const auto& [h, p] :
       {std::pair{10_nm, 1.300e5}, {20_nm, 8126.0}, {50_nm, 208.0}, {100_nm, 13.00}, {200_nm, 0.8126}, {1_um, 1.300e-3}}) {
    EXPECT_NEAR(law.pressure(h), p, printed * p) << h;
  }
}

// eta of the header by Gauss-Legendre quadrature in t and z: K = -2 ln(1 - 3 t^2 + 2 t^3), u = K z^4.
double lifshitz_factor(double gap) {
  constexpr double hbar = 1.054571817e-34, c = 299792458, electron_volt = 1.602176634e-19;
  const double plasma = 9 * electron_volt / hbar, gamma = 0.035 * electron_volt / hbar;
  using Gauss = boost::math::quadrature::gauss<double, 60>;
  const auto over_momentum = [&](double t) {
    const double s = t * t * (3 - 2 * t), k0 = -2 * std::log1p(-s), e = std::exp(k0);
    const auto over_frequency = [&](double z) {
      const double u = k0 * std::pow(z, 4), xi = u * c / (2 * gap), eps = 1 + plasma * plasma / (xi * (xi + gamma));
      const double k = std::sqrt(k0 * k0 + (eps - 1) * u * u);
      const double te = (k0 - k) / (k0 + k), tm = (eps * k0 - k) / (eps * k0 + k);
      return (1 / (e / (te * te) - 1) + 1 / (e / (tm * tm) - 1)) * 4 * z * z * z;
    };
    return std::pow(k0, 3) * Gauss::integrate(over_frequency, 0.0, 1.0) * 12 * t * (1 - t) / (1 - s);
  };
  return Gauss::integrate(over_momentum, 0.0, 1.0) * 15 / (2 * std::pow(pi, 4));
}

TEST(Casimir, OfGoldIsTheTabulatedFactorOfTheIdealOne) {
  constexpr double printed = 6e-5;  // four decimals
  struct Row {
    double gap, eta;
  };
  constexpr std::array<Row, 11> table{{{10_nm, 0.0789},
                                       {20_nm, 0.1421},
                                       {30_nm, 0.1953},
                                       {50_nm, 0.2826},
                                       {70_nm, 0.3529},
                                       {100_nm, 0.4366},
                                       {150_nm, 0.5371},
                                       {200_nm, 0.6072},
                                       {300_nm, 0.6977},
                                       {500_nm, 0.7909},
                                       {1_um, 0.8777}}};
  for (const Row& row : table) {
    EXPECT_NEAR(GoldCasimir{}.pressure(row.gap) / IdealCasimir{}.pressure(row.gap), row.eta, printed) << row.gap;
  }
}

TEST(Casimir, OfGoldIsTheLifshitzIntegralAlsoBetweenTheKnots) {
  constexpr double interpolated = 2e-5;  // relative error over the whole table, as stated in the header
  for (double h = 1.02_nm; h < 10_um; h *= 1.17) {
    const double expected = lifshitz_factor(h);
    EXPECT_NEAR(GoldCasimir{}.factor(h), expected, interpolated * expected) << h;
  }
}

TEST(Casimir, OfGoldFollowsTheLifshitzIntegralBeyondTheTable) {
  constexpr double extrapolated = 0.01;  // error of eta below the table, and of 1 - eta above it, as stated in the header
  for (const double h : {0.3_nm, 0.7_nm}) {
    EXPECT_NEAR(GoldCasimir{}.factor(h), lifshitz_factor(h), extrapolated * lifshitz_factor(h)) << h;
  }
  for (const double h : {12_um, 20_um}) {
    const double missing = 1 - lifshitz_factor(h);
    EXPECT_NEAR(1 - GoldCasimir{}.factor(h), missing, extrapolated * missing) << h;
  }
}

TEST(Casimir, OfGoldIsSmoothAtEveryKnotAndBeyondTheTable) {
  constexpr double near = 1e-9, same = 1e-6;
  for (std::size_t k = 0; k < GoldFactor::knots; ++k) {
    const double h = GoldFactor::table().piece(1.01_nm * std::pow(10, static_cast<double>(k) / 10)).begin;
    const Dual below = GoldCasimir{}.factor(Dual(h * (1 - near), 1)), above = GoldCasimir{}.factor(Dual(h * (1 + near), 1));
    EXPECT_NEAR(above.value, below.value, same * below.value);
    EXPECT_NEAR(above.slope, below.slope, same * below.slope);
  }
  double previous = 0;
  for (double h = 0.1_nm; h < 50_um; h *= 1.01) {
    EXPECT_GT(GoldCasimir{}.factor(h), previous);
    previous = GoldCasimir{}.factor(h);
  }
  EXPECT_LT(previous, 1);
}

TEST(VanDerWaals, PressureIsTheTabulatedOne) {
  constexpr double printed = 4e-4;  // relative: four digits
  const VanDerWaals law{.hamaker_constant = 4e-19};
  for (const auto& [h, p] : {std::pair{10_nm, 2.122e4}, {20_nm, 2653.0}, {50_nm, 169.8}, {100_nm, 21.22}}) {
    EXPECT_NEAR(law.pressure(h), p, printed * p) << h;
  }
}

TEST(VanDerWaals, RepelsBelowTheEquilibriumDistance) {
  const double h0 = gold_surfaces.equilibrium_distance, unit = gold_surfaces.hamaker_constant / (6 * pi * h0 * h0 * h0);
  EXPECT_NEAR(gold_surfaces.pressure(h0), 0, 1e-14 * unit);
  EXPECT_LT(gold_surfaces.pressure(0.99 * h0), 0);
  EXPECT_GT(gold_surfaces.pressure(1.01 * h0), 0);
  const double strongest = std::pow(3, 1.0 / 6) * h0;
  EXPECT_NEAR(gold_surfaces.pressure(strongest), 0.3849 * unit, 1e-4 * unit);
  EXPECT_NEAR(gold_surfaces.pressure(Dual(strongest, 1)).slope * h0, 0, 1e-13 * unit);
  // The published energy of separation for A = 4e-19 J and h0 = 0.165 nm without repulsion; with repulsion it is 3/4 of that.
  const VanDerWaals surfaces{.hamaker_constant = 4e-19, .equilibrium_distance = 0.165_nm};
  EXPECT_NEAR(surfaces.energy(0.165_nm), -0.75 * 0.390, 1e-3);
}

TEST(SmallerOfBoth, IsNeverTheSum) {
  const SmallerOfBoth<IdealCasimir> law{.casimir = {}, .van_der_waals = {.hamaker_constant = 4e-19}};
  for (const double h : dispersion_gaps) {
    EXPECT_EQ(law.pressure(h), std::min(law.casimir.pressure(h), law.van_der_waals.pressure(h))) << h;
  }
}

TEST(SmallerOfBoth, ChangesOverWhereTheLimitsAreEqual) {
  for (const double hamaker : {4e-19, 1e-19}) {
    const SmallerOfBoth<IdealCasimir> law{.casimir = {}, .van_der_waals = {.hamaker_constant = hamaker}};
    const double expected = std::pow(pi, 3) * 1.054571817e-34 * 299792458 / (40 * hamaker);
    EXPECT_NEAR(law.crossover, expected, 1e-12 * expected);
    const double below = law.energy(law.crossover * (1 - 1e-12)), above = law.energy(law.crossover * (1 + 1e-12));
    EXPECT_NEAR(below, above, 1e-10 * std::abs(above));
  }
  EXPECT_NEAR((SmallerOfBoth<IdealCasimir>{{}, {.hamaker_constant = 4e-19}}.crossover), 61.3_nm, 0.05_nm);
  // At short distance the Lifshitz law of gold has a Hamaker constant of 2.1e-19 J: a law with a larger one is never the
  // smaller.
  EXPECT_EQ((SmallerOfBoth<GoldCasimir>{{}, {.hamaker_constant = 4e-19}}.crossover), 0);
  EXPECT_GT((SmallerOfBoth<GoldCasimir>{{}, {.hamaker_constant = 1e-19}}.crossover), 10_nm);
}

// ---- gas

// A film of air under a strip of this width; the linear damper is as strong as the strip film at 2 um.
template <class Law>
Law gas_law_of_type(double width, double free_path, double viscosity = 1.86e-5_Pa_s) {
  for (Gas gas : test::gases()) {
    const std::pair<std::string_view, double> numbers[] = {{"viscosity", viscosity},      {"mean_free_path", free_path},
                                                           {"slit_height", width / 8},    {"slit_length", width / 8},
                                                           {"quality_factor", not_given}, {"damping", viscosity * 1000}};
    for (const auto& [key, value] : numbers) {
      if (double* const number = number_of(gas, key)) *number = value;
    }
    const GasLaw law = gas_law(gas, {.width = width, .thickness = 4_um}, 1);
    if (const Law* found = std::get_if<Law>(&law)) return *found;
  }
  throw std::logic_error("no model makes this law");
}

template <class Law>
class GasLawOfType : public testing::Test {};
using GasLaws = LawsOf<GasLaw::variant>::Types;
TYPED_TEST_SUITE(GasLawOfType, GasLaws);

TYPED_TEST(GasLawOfType, OpposesTheMotionAndTakesItsEnergy) {
  const auto law = gas_law_of_type<TypeParam>(20_um, 65_nm);
  for (const double h : gaps) {
    for (const double v : {-1.0, -1e-3, 1e-3, 1.0}) {
      EXPECT_LT(law.load(h, v) * v, 0) << "gap " << h;
      EXPECT_EQ(law.load(h, v), -law.load(h, -v));
      EXPECT_NEAR(law.load(h, v), v * law.load(h, 1.0), 1e-14 * std::abs(law.load(h, v))) << "linear in the velocity";
    }
    EXPECT_EQ(law.load(h, 0.0), 0);
    EXPECT_EQ(damping_per_length(law, h), -law.load(h, 1.0));
  }
}

TYPED_TEST(GasLawOfType, DualSlopesAreTheComplexStepDerivatives) {
  if constexpr (!std::is_same_v<TypeParam,
                                NearContactFilm>) {  // its pieces are chosen by comparisons, which complex numbers lack
    constexpr double step = 1e-30;
    const auto law = gas_law_of_type<TypeParam>(20_um, 65_nm);
    using Complex = std::complex<double>;
    for (const double h : gaps) {
      const double by_gap = law.load(Complex(h, step), Complex(0.2)).imag() / step;
      const double by_velocity = law.load(Complex(h), Complex(0.2, step)).imag() / step;
      EXPECT_NEAR(law.load(Dual(h, 1), Dual(0.2)).slope, by_gap, 1e-12 * std::abs(by_gap));
      EXPECT_NEAR(law.load(Dual(h), Dual(0.2, 1)).slope, by_velocity, 1e-13 * std::abs(by_velocity));
    }
  }
}

TEST(SlipFilm, IsTheStripFilmThinnedBySlip) {
  for (const double h : gaps) {
    const double strip = StripSqueezeFilm{.viscosity = 1.86e-5, .width = 20_um}.load(h, 1.0);
    const double slip = SlipFilm{.viscosity = 1.86e-5, .mean_free_path = 65_nm, .width = 20_um}.load(h, 1.0);
    EXPECT_NEAR(slip * (1 + 6 * 65_nm / h), strip, 1e-12 * std::abs(strip));
  }
}

TEST(StripSqueezeFilm, IsTheTextbookOne) {
  const StripSqueezeFilm film{.viscosity = 1.86e-5_Pa_s, .width = 20_um};
  for (const double h : gaps) {
    const double expected = -1.86e-5 * std::pow(20_um / h, 3) * 0.3;
    EXPECT_NEAR(film.load(h, 0.3), expected, 1e-14 * std::abs(expected));
  }
}

TYPED_TEST(GasLawOfType, OnTheFarSideOpposesTheMotionToo) {
  const auto law = gas_law_of_type<TypeParam>(20_um, 65_nm);
  const FarSide<TypeParam> far{.law = law, .both_gaps = 8.5_um, .floor = 0.05_um};
  for (const double h : {0.03_um, 3.5_um, 8.4_um, 8.48_um, 8.6_um}) {
    EXPECT_LT(far.load(h, 0.2), 0) << "gap " << h;
    EXPECT_NEAR(far.load(h, 0.2), -far.load(h, -0.2), 1e-15);
    const double slope = derivative([&](double x) { return far.load(x, 0.2); }, h, 0.5_nm);
    EXPECT_NEAR(far.load(Dual(h, 1), Dual(0.2)).slope, slope, 1e-8 * std::abs(slope) + 1e-9) << "gap " << h;
  }
  EXPECT_EQ(far.load(3.5_um, 0.2), law.load(8.5_um - 3.5_um, 0.2));
}

TEST(StripOverSlit, IsTheStripWhereTheSlitIsWideAndTwiceAsWideWhereItIsClosed) {
  const StripSqueezeFilm open{.viscosity = 1.86e-5_Pa_s, .width = 20_um}, twice{.viscosity = 1.86e-5_Pa_s, .width = 40_um};
  const auto slit = [](double height) {
    return StripOverSlit{.viscosity = 1.86e-5_Pa_s, .width = 20_um, .slit_height = height, .slit_length = 2_um};
  };
  for (const double h : gaps) {
    EXPECT_NEAR(slit(100 * h).load(h, 1.0), open.load(h, 1.0), 1e-6 * std::abs(open.load(h, 1.0))) << h;
    // The closed edge is the middle of a strip of twice the width, of which the film is one half.
    EXPECT_NEAR(slit(h / 1000).load(h, 1.0), twice.load(h, 1.0) / 2, 1e-6 * std::abs(twice.load(h, 1.0))) << h;
  }
}

TEST(StripOverSlit, SolvesReynoldsEquationWithItsEdges) {
  // Solves p'' = -12 mu v / h^3 with p(0) = 0 and -p'(a) h^3 = p(a) s^3 / l by shooting. The solution is linear in p'(0), so
  // that two shots suffice.
  constexpr double mu = 1.86e-5, a = 20_um, s = 2_um, l = 2.1_um, h = 3_um;
  constexpr double source = 12 * mu / (h * h * h);
  const auto shoot = [&](double slope) {  // the parabola for a constant source is exact
    const double pressure = slope * a - source * a * a / 2, end = slope - source * a;
    return std::pair{-end * h * h * h - pressure * s * s * s / l, slope * a * a / 2 - source * a * a * a / 6};
  };
  const auto [miss_0, force_0] = shoot(0);
  const auto [miss_1, force_1] = shoot(1e9);
  const double force = force_0 + (force_1 - force_0) * miss_0 / (miss_0 - miss_1);
  const StripOverSlit film{.viscosity = mu, .width = a, .slit_height = s, .slit_length = l};
  EXPECT_NEAR(-film.load(h, 1.0), force, 1e-12 * force);
}

TEST(EndFlow, IsThatOfARectangularFilm) {
  // The double Fourier series of Poisson's equation on a rectangle converges slowly to the same value.
  for (const double ratio : {0.05, 0.3, 0.5256, 1.0, 2.5}) {
    double sum = 0;
    for (int m = 1; m < 2000; m += 2) {
      for (int n = 1; n < 2000; n += 2) sum += 1 / (1.0 * m * m * n * n * (m * m + ratio * ratio * n * n));
    }
    const double expected = 12 * 64 / std::pow(pi, 6) * sum;
    EXPECT_NEAR(end_flow(ratio), expected, 1e-6) << ratio;
  }
  EXPECT_NEAR(end_flow(1), 0.42173, 5e-6) << "the square film of the textbooks";
  EXPECT_NEAR(end_flow(1e-3), 1 - 0.63025e-3, 1e-8) << "a long film loses 0.63 widths of its length";
}

TEST(EndFlow, WeakensTheFilmsThatTakeALength) {
  for (Gas gas : test::gases()) {
    double* const length = number_of(gas, "film_length");
    if (length == nullptr) continue;
    const Structure strip{.width = 20_um};
    const double whole = damping_per_length(gas_law(gas, strip, 1), 1_um);
    *length = 40_um;
    EXPECT_NEAR(damping_per_length(gas_law(gas, strip, 1), 1_um), end_flow(0.5) * whole, 1e-12 * whole);
  }
}

// Viscosity of air at 300 K in the tables, 2.3 % below the standard atmosphere [Pa s].
const double viscosity_of_the_tables = 1.7894e-5 * std::pow(300.0 / 297, 0.77);

TEST(GasLaw, HasTheTabulatedDampingPerLength) {
  // Independent values for a = 123 um, b = 4 um, mean free path 65.45 nm; air with the viscosity above, near contact 1.98e-5 Pa
  // s. The tolerance is half a unit of the last printed digit.
  struct Row {
    double gap;
    const char *strip, *veijola, *gallis_torczynski, *near_contact, *guo_alexeenko;
  };
  constexpr std::array<Row, 6> table{{{4_um, "0.524", "0.485", "0.539", "0.448", "1.142"},
                                      {2_um, "4.19", "3.55", "3.68", "2.56", "5.33"},
                                      {1_um, "33.6", "23.8", "23.7", "5.36", "17.5"},
                                      {0.5_um, "268", "140", "136", "4.95", "47.0"},
                                      {0.2_um, "4195", "1152", "1098", "3.56", "157"},
                                      {0.1_um, "33557", "4866", "4740", "2.71", "382"}}};
  const auto expect = [](const GasLaw& law, double gap, const std::string& printed) {
    const std::size_t point = printed.find('.');
    const double digit = point == std::string::npos ? 1 : std::pow(10, -static_cast<double>(printed.size() - point - 1));
    EXPECT_NEAR(damping_per_length(law, gap), std::stod(printed), 0.501 * digit) << "gap " << gap << ", law " << law.index();
  };
  for (const Row& row : table) {
    expect(gas_law_of_type<StripSqueezeFilm>(123_um, 65.45_nm, viscosity_of_the_tables), row.gap, row.strip);
    expect(gas_law_of_type<VeijolaFilm>(123_um, 65.45_nm, viscosity_of_the_tables), row.gap, row.veijola);
    expect(gas_law_of_type<GallisTorczynskiFilm>(123_um, 65.45_nm, viscosity_of_the_tables), row.gap, row.gallis_torczynski);
    expect(gas_law_of_type<NearContactFilm>(123_um, 65.45_nm, 1.98e-5), row.gap, row.near_contact);
    expect(gas_law_of_type<GuoAlexeenkoFilm>(123_um, 65.45_nm), row.gap, row.guo_alexeenko);
  }
}

TEST(VeijolaFilm, HasTheTabulatedViscosityAtEveryPressure) {
  constexpr double printed = 6.3e-4;  // relative: half a unit of the last digit of 8.02e-4
  const Structure strip{.width = 20_um};
  for (const auto& [pressure, reduction] : {std::pair{101325.0, 0.7098}, {1e4, 0.1431}, {1e3, 0.01145}, {100.0, 8.02e-4}}) {
    const Gas gas = VeijolaGas{.film = {.viscosity = viscosity_of_the_tables, .pressure = pressure}};
    const Gas continuum = StripGas{.film = {.viscosity = viscosity_of_the_tables}};
    const double ratio =
        damping_per_length(gas_law(gas, strip, 1), 1_um) / damping_per_length(gas_law(continuum, strip, 1), 1_um);
    EXPECT_NEAR(ratio, reduction, printed * reduction) << pressure << " Pa";
  }
}

TEST(RarefiedFilm, BecomesTheStripFilmWhereTheMeanFreePathVanishes) {
  const auto strip = gas_law_of_type<StripSqueezeFilm>(1e4 * 1_um, 1e-3 * 1_nm);
  const auto veijola = gas_law_of_type<VeijolaFilm>(1e4 * 1_um, 1e-3 * 1_nm);
  const auto gallis_torczynski = gas_law_of_type<GallisTorczynskiFilm>(1e4 * 1_um, 1e-3 * 1_nm);
  const double expected = strip.load(1_um, 1.0);  // Kn = 1e-6, h/a = 1e-4
  EXPECT_NEAR(veijola.load(1_um, 1.0), expected, 2e-6 * std::abs(expected));
  EXPECT_NEAR(gallis_torczynski.load(1_um, 1.0) / expected, 1 + 6 * 0.634 * 1e-4 - 6 * 1e-6, 1e-7);
}

TEST(NearContactFilm, GoesOnSmoothlyWhereItsTangentBegins) {
  constexpr double little = 1e-9;
  const auto film = gas_law_of_type<NearContactFilm>(20_um, 65_nm);
  const double begins = 0.015 * 20_um;
  const auto slope = [&](double h) { return film.load(Dual(h, 1), Dual(0.2)).slope; };
  EXPECT_NEAR(film.load(begins * (1 - little), 0.2), film.load(begins * (1 + little), 0.2), 10 * little * 20);
  EXPECT_NEAR(slope(begins * (1 - little)), slope(begins * (1 + little)), 100 * little * std::abs(slope(begins)));
  for (const double h : gaps) {
    const double expected = derivative([&](double x) { return film.load(x, 0.2); }, h, h / 200);
    EXPECT_NEAR(slope(h), expected, 1e-9 * std::abs(expected)) << "gap " << h;
  }
  EXPECT_LT(damping_per_length(film, 0.05_um), damping_per_length(film, 0.2_um)) << "falls towards contact";
  EXPECT_TRUE(std::isfinite(damping_per_length(film, 1e-6 * 1_nm)));
}

// ---- contact

const Contact gold_pad = test::gold_contact(UniformAsperities::example());
constexpr double beam_width = 20_um;

template <class Law>
ContactLaw law_of(const Law& law) {
  return contact_law(test::gold_contact(law), beam_width);
}
ContactLaw law_of(const ContactModel& model, double damping) {
  ContactModel own = model;
  *number_of(own, "damping") = damping;
  return law_of(own);
}

const std::array<ContactModel, 3> damping_contacts{LinearSpring::example(), UniformAsperities::example(),
                                                   GaussianAsperities::example()};
constexpr HystereticSpring hysteretic{.stiffness = 1e4_N_m, .unloading_stiffness = 2.5e4_N_m};
constexpr std::array plasticities{Plasticity::zmc, Plasticity::kogut_etsion};

ContactLaw plastic_law(Plasticity plasticity) {
  PlasticAsperities law = PlasticAsperities::example();
  law.plasticity = plasticity;
  return law_of(law);
}

std::vector<ContactLaw> remembering() {
  return {law_of(hysteretic), plastic_law(Plasticity::zmc), plastic_law(Plasticity::kogut_etsion)};
}

/// Lists every law that acts only in contact and has a force, with damping if the law has it.
std::vector<ContactLaw> every_contact_law() {
  std::vector<ContactLaw> laws;
  for_each_law<ContactModel>([&]<class Law>(std::type_identity<Law>) {
    for (const Law& law : test::examples<Law>(0.4)) {
      const ContactLaw own = law_of(law);
      if (contact_reach(own) == 0 && contact_force(own, 1_nm) != 0) laws.push_back(own);
    }
  });
  return laws;
}

constexpr std::array interferences{0.1_nm, 3_nm, 40_nm, 99_nm, 101_nm, 250_nm};

TEST(ContactLaw, ForceIsTheSlopeOfTheStoredEnergy) {
  constexpr double differences = 1e-9;
  for (const ContactLaw& law : every_contact_law()) {
    for (const double d : interferences) {
      const double h = std::abs(d - 100_nm) < 2_nm ? 0.05_nm : d / 100;  // do not step across the end of the asperities
      const double slope = derivative([&](double x) { return contact_energy(law, x); }, d, h);
      const double force = contact_force(law, d);
      EXPECT_NEAR(slope, force, differences * std::abs(force)) << "d = " << d << ", law " << law.index();
    }
  }
}

TEST(ContactLaw, DualSlopeIsTheStiffness) {
  constexpr double differences = 1e-9;
  for (const ContactLaw& law : every_contact_law()) {
    for (const double sign : {1.0, -1.0}) {
      for (const double d : interferences) {
        const double h = std::abs(d - 100_nm) < 2_nm ? 0.05_nm : d / 100;
        const double expected = derivative([&](double x) { return contact_force(law, x); }, sign * d, h);
        const double slope = std::visit([&](const auto& l) { return l.force(Dual(sign * d, 1)).slope; }, law);
        const double rounding = 1e-14 * std::abs(contact_force(law, sign * d)) / h;
        EXPECT_NEAR(slope, expected, differences * std::abs(expected) + rounding)
            << "d = " << sign * d << ", law " << law.index();
      }
    }
  }
}

TEST(ContactLaw, BeginsAtZero) {
  for (const ContactLaw& law : every_contact_law()) {
    for (const double rate : {-0.1, 0.0, 0.1}) EXPECT_EQ(contact_force(law, 0, true, rate), 0);
    EXPECT_EQ(contact_energy(law, 0), 0);
    EXPECT_EQ(contact_dissipation(law, 0, -0.1), 0);
  }
}

TEST(ContactLaw, OfClosedFormIsOddAndTheGaussianOneTendsToItsTail) {
  std::vector<ContactLaw> laws = remembering();
  for (const ContactModel& model : {ContactModel(LinearSpring::example()), ContactModel(UniformAsperities::example()),
                                    ContactModel(AdhesiveAsperities::example())}) {
    laws.push_back(law_of(model));
  }
  for (const ContactLaw& law : laws) {
    for (const double d : interferences) {
      EXPECT_DOUBLE_EQ(contact_force(law, -d), -contact_force(law, d));
      EXPECT_DOUBLE_EQ(contact_energy(law, -d), contact_energy(law, d));
    }
  }
  const ContactLaw gaussian = law_of(GaussianAsperities::example());
  const double tail = contact_force(gaussian, -200_nm);
  EXPECT_LT(tail, 0);
  EXPECT_LT(-tail, 2e-5 * contact_force(gaussian, 120_nm)) << "the header says 1e-5 of the force at the mean";
}

TEST(ContactLaw, PushesEverMoreUnlessItIsAdhesive) {
  for (const ContactModel& model : damping_contacts) {
    const ContactLaw law = law_of(model, 0);
    double last = 0;
    for (const double d : interferences) {
      EXPECT_GT(contact_force(law, d), last);
      last = contact_force(law, d);
    }
  }
}

TEST(ContactLaw, KnowsItsLargestInterference) {
  EXPECT_TRUE(std::isinf(largest_interference(LinearSpring::example())));
  EXPECT_TRUE(std::isinf(largest_interference(HystereticSpring::example())));
  EXPECT_TRUE(std::isinf(largest_interference(RigidStop::example())));
  EXPECT_DOUBLE_EQ(largest_interference(PlasticAsperities::example()), 100_nm);
  EXPECT_DOUBLE_EQ(largest_interference(UniformAsperities::example()), 100_nm);
  EXPECT_DOUBLE_EQ(largest_interference(AdhesiveAsperities::example()), 100_nm);
  EXPECT_DOUBLE_EQ(largest_interference(GaussianAsperities::example()), 4 * 30_nm);
}

TEST(ContactLaw, LinearLawIsASpring) {
  const ContactLaw law = law_of(LinearSpring::example());
  EXPECT_DOUBLE_EQ(contact_force(law, 2_nm), 1e4 * 2e-9);
  EXPECT_DOUBLE_EQ(contact_energy(law, 2_nm), 1e4 * 4e-18 / 2);
}

TEST(UniformAsperities, CarryTheHertzLawIntegratedOverTheirHeights) {
  // eta An / Hm times the integral of (4/3) E* sqrt(R) (d - s)^1.5 over the depths s of the summits, by quadrature.
  const ContactLaw law = contact_law(gold_pad, beam_width);
  boost::math::quadrature::tanh_sinh<double> integrator;
  for (const double d : interferences) {
    const double per_depth = 1e11 * beam_width * 5_um / 100_nm * 4.0 / 3 * 48e9 * std::sqrt(100_nm);
    // The integrator's absolute tolerance does not suit metres, so that values are in units of d.
    const double deepest = std::min(1.0, 100_nm / d);
    const double sum = integrator.integrate([](double s) { return std::pow(1 - s, 1.5); }, 0.0, deepest);
    const double expected = per_depth * std::pow(d, 2.5) * sum;
    EXPECT_NEAR(contact_force(law, d), expected, 1e-9 * expected) << "d = " << d;
  }
}

TEST(UniformAsperities, HaveTwoContinuousDerivativesAtFirstTouch) {
  const auto law = std::get<UniformAsperityContact>(contact_law(gold_pad, beam_width));
  const auto slope = [&](double d) { return law.force(Dual(d, 1)).slope; };
  EXPECT_EQ(slope(0), 0);
  // P'' at 0 is the limit of P'(d) / d, which decreases like the root of d from both sides.
  for (const double d : {1_nm, 0.01_nm, 1e-4 * 1_nm}) {
    EXPECT_NEAR((slope(d) / d) / (slope(d / 100) / (d / 100)), 10, 1e-6);
    EXPECT_EQ(slope(-d), slope(d));
  }
}

TEST(UniformAsperities, GoOnSmoothlyWhenTheLastSummitTouches) {
  const auto law = std::get<UniformAsperityContact>(contact_law(gold_pad, beam_width));
  const auto slope = [&](double d) { return law.force(Dual(d, 1)).slope; };
  const double hm = 100_nm, little = 1e-9 * hm;
  constexpr double near = 1e-8;
  EXPECT_NEAR(law.force(hm + little), law.force(hm - little), near * law.force(hm));
  EXPECT_NEAR(slope(hm + little), slope(hm - little), near * slope(hm));
  const double curvature_below = (slope(hm) - slope(hm - 0.001 * hm)) / (0.001 * hm);
  const double curvature_above = (slope(hm + 1e-6 * hm) - slope(hm)) / (1e-6 * hm);
  EXPECT_NEAR(curvature_above, curvature_below, 0.01 * curvature_below);
  // All summits are loaded: stiffer than a linear law, softer than while further summits come into touch.
  EXPECT_GT(law.force(2 * hm), 2 * law.force(hm));
  EXPECT_LT(law.force(2 * hm), std::pow(2, 2.5) * law.force(hm));
}

/// Returns F_n(h) by quadrature.
double gaussian_integral(double n, double h) {
  boost::math::quadrature::exp_sinh<double> integrator;
  // The factor exp(-h t) is inside of the integral and exp(-h^2/2) outside, which keeps the relative accuracy in the tail.
  const auto integrand = [&](double t) { return std::pow(t, n) * std::exp(-t * (t / 2 + h)); };
  if (h >= 0) return std::exp(-h * h / 2) / std::sqrt(2 * pi) * integrator.integrate(integrand, 1e-15);
  // Split the interval at the peak of the integrand.
  boost::math::quadrature::tanh_sinh<double> finite;
  const auto whole = [&](double t) { return std::pow(t, n) * std::exp(-(t + h) * (t + h) / 2); };
  return (finite.integrate(whole, 0.0, -h, 1e-15) + integrator.integrate([&](double t) { return whole(t - h); }, 1e-15)) /
         std::sqrt(2 * pi);
}

TEST(GaussianAsperities, IntegralsAreThoseOfQuadrature) {
  constexpr double digits = 1e-10;  // relative; the header states a tenth of it
  for (double h = -12; h <= 8; h += 0.173) {
    const double f = gaussian_integral(1.5, h);
    EXPECT_NEAR(GaussianAsperityContact::tail(h), f, digits * f) << "h = " << h;
    const double next = gaussian_integral(2.5, h);
    EXPECT_NEAR(GaussianAsperityContact::next_tail(h), next, digits * next) << "h = " << h;
    const double slope = -1.5 * gaussian_integral(0.5, h);
    EXPECT_NEAR(GaussianAsperityContact::tail(Dual(h, 1)).slope, slope, -digits * slope) << "h = " << h;
  }
  EXPECT_EQ(GaussianAsperityContact::tail(50.0), 0);
}

TEST(GaussianAsperities, IntegralsAreTheTabulatedOnes) {
  constexpr double printed = 1e-7;  // relative
  struct Row {
    double h, f15, f25;
  };
  constexpr std::array<Row, 9> table{{{-1, 1.40459747, 2.75550187},
                                      {0, 4.30019994e-1, 6.16634219e-1},
                                      {0.5, 1.95203604e-1, 2.40401571e-1},
                                      {1, 7.56681774e-2, 8.05623356e-2},
                                      {1.5, 2.46394803e-2, 2.28630560e-2},
                                      {2, 6.64817762e-3, 5.42370520e-3},
                                      {2.5, 1.46993824e-3, 1.06368895e-3},
                                      {3, 2.63967554e-4, 1.70872996e-4},
                                      {4, 4.43915596e-6, 2.35338105e-6}}};
  for (const Row& row : table) {
    EXPECT_NEAR(GaussianAsperityContact::tail(row.h), row.f15, printed * row.f15) << row.h;
    EXPECT_NEAR(GaussianAsperityContact::next_tail(row.h), row.f25, printed * row.f25) << row.h;
  }
}

TEST(GaussianAsperities, CarryTheHertzLawIntegratedOverTheirHeights) {
  const ContactLaw law = law_of(GaussianAsperities::example());
  const double sigma = 30_nm;
  const double strength = 1e11 * beam_width * 5_um * 4.0 / 3 * 48e9 * std::sqrt(100_nm) * std::pow(sigma, 1.5);
  for (const double d : {20_nm, 60_nm, 120_nm}) {
    const double expected = strength * (gaussian_integral(1.5, 4 - d / sigma) - gaussian_integral(1.5, 4));
    EXPECT_NEAR(contact_force(law, d), expected, 1e-9 * expected);
  }
}

/// Returns the rebound velocity of a mass that hits the law at v, by Runge-Kutta. The last step is not truncated at the end of
/// contact.
double rebound(const ContactLaw& law, double mass, double v) {
  double d = 0, time_step = 1e-3 * std::sqrt(mass / (contact_force(law, 10_nm) / 10_nm));
  const auto acceleration = [&](double x, double u) { return -contact_force(law, x, true, u) / mass; };
  while (true) {
    const double h = time_step;
    const double k1 = acceleration(d, v), v2 = v + h / 2 * k1, k2 = acceleration(d + h / 2 * v, v2);
    const double v3 = v + h / 2 * k2, k3 = acceleration(d + h / 2 * v2, v3), v4 = v + h * k3;
    const double k4 = acceleration(d + h * v3, v4);
    const double next = d + h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    if (next < 0) return -v;
    d = next;
    v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
}

TEST(HuntCrossley, HasTheRestitutionOfItsClosedFormWhateverTheElasticLaw) {
  constexpr double mass = 1e-11;  // [kg]
  constexpr double end = 1e-4;    // relative; the last step is not truncated, but the force there is negligible
  for (const ContactModel& model : damping_contacts) {
    for (const double c : {0.4, 4.0}) {
      const ContactLaw law = law_of(model, c);
      const double v = 0.1, g = 1.5 * c;
      const auto invariant = [&](double u) { return u / g - std::log1p(g * u) / (g * g); };
      double low = 0, high = std::min(v, 0.999999 / g);  // bisection of invariant(-w) = invariant(v)
      for (int i = 0; i < 60; ++i) {
        const double w = (low + high) / 2;
        (invariant(-w) < invariant(v) ? low : high) = w;
      }
      EXPECT_NEAR(rebound(law, mass, v), low, end * v) << name_of(model) << " c = " << c;
    }
    // e = 1 - c v + O(c^2 v^2)
    const double c = 0.4, v = 0.05;
    const double e = rebound(law_of(model, c), mass, v) / v;
    EXPECT_NEAR(e, 1 - c * v, std::pow(c * v, 2) + end) << name_of(model);
    EXPECT_NEAR(rebound(law_of(model, 0), mass, v), v, end * v) << "without damping nothing is lost";
  }
}

TEST(HuntCrossley, NeverPullsAndAlwaysTakes) {
  for (const ContactModel& model : damping_contacts) {
    const ContactLaw law = law_of(model, 4);
    ASSERT_TRUE(is_rate_dependent(law));
    for (const double d : interferences) {
      for (const double rate : {-10.0, -0.3, -0.01, 0.01, 0.3}) {
        const double elastic = contact_force(law, d), expected = std::max(0.0, elastic * (1 + 6 * rate));
        EXPECT_NEAR(contact_force(law, d, true, rate), expected, 1e-14 * elastic);
        EXPECT_NEAR(contact_dissipation(law, d, rate), (expected - elastic) * rate, 1e-14 * elastic);
        EXPECT_GT(contact_dissipation(law, d, rate), 0);
      }
      EXPECT_EQ(contact_dissipation(law, d, 0), 0);
    }
    EXPECT_FALSE(is_rate_dependent(law_of(model, 0)));
  }
}

TEST(Adhesion, IsTheDmtForceOfEverySummitInTouch) {
  const ContactLaw law = law_of(AdhesiveAsperities::example());
  const ContactLaw repulsion = law_of(UniformAsperities::example());
  const double one = 2 * pi * 100_nm * 0.05, summits = 1e11 * beam_width * 5_um;  // ten
  for (const double d : interferences) {
    const double pull = one * summits * std::min(d, 100_nm) / 100_nm;
    EXPECT_NEAR(contact_force(law, d), contact_force(repulsion, d) - pull, 1e-12 * pull) << "d = " << d;
  }
  EXPECT_LT(contact_force(law, 0.1_nm), 0) << "at small interference adhesion wins";
}

ContactState unloading(const ContactLaw& law, double deepest) {
  ContactState state = true;
  state.unloading = true;
  state.shift = dent(law, deepest).shift;
  return state;
}

TEST(ContactMemory, ForceAndEnergyAreContinuousFromLoadingToUnloadingToTheDent) {
  constexpr double rounding = 1e-12;
  for (const ContactLaw& law : remembering()) {
    ASSERT_TRUE(has_memory(law));
    for (const double deepest : interferences) {
      const ContactState state = unloading(law, deepest);
      const double peak = contact_force(law, deepest), work = contact_energy(law, deepest);
      EXPECT_GT(state.shift, 0);
      EXPECT_LT(state.shift, deepest);
      EXPECT_NEAR(contact_force(law, deepest, state, 0), peak, rounding * peak) << deepest;
      EXPECT_EQ(contact_force(law, state.shift, state, 0), 0);
      EXPECT_EQ(stored_energy(law, state.shift, state), 0);
      EXPECT_NEAR(stored_energy(law, deepest, state), stored_energy(law, deepest, true), rounding * work);
      EXPECT_NEAR(stored_energy(law, deepest, true) + dent(law, deepest).lost, work, rounding * work);
      EXPECT_GT(dent(law, deepest).lost, 0);
    }
  }
  for (const ContactModel& model : damping_contacts) EXPECT_FALSE(has_memory(law_of(model, 0)));
}

TEST(ContactMemory, UnloadingForceIsTheSlopeOfWhatIsStored) {
  constexpr double differences = 1e-9;
  for (const ContactLaw& law : remembering()) {
    const ContactState state = unloading(law, 60_nm);
    for (const double d : {state.shift + 1_nm, 59_nm}) {
      const double slope = derivative([&](double x) { return stored_energy(law, x, state); }, d, 0.05_nm);
      const double force = contact_force(law, d, state, 0);
      EXPECT_NEAR(slope, force, differences * force);
    }
  }
}

TEST(ContactMemory, DeeperDentsHaveTakenMore) {
  for (const ContactLaw& law : remembering()) {
    Dent last;
    for (const double deepest : interferences) {
      const Dent next = dent(law, deepest);
      EXPECT_GT(next.shift, last.shift);
      EXPECT_GT(next.lost, last.lost);
      last = next;
    }
  }
}

TEST(Hysteretic, ReturnsTheShareOfTheWorkThatFollowsFromTheStiffnesses) {
  const ContactLaw law = law_of(hysteretic);
  for (const double deepest : interferences) {
    EXPECT_NEAR(dent(law, deepest).lost / contact_energy(law, deepest), 1 - 1e4 / 2.5e4, 1e-12);
  }
  EXPECT_TRUE(dent(law, 1_nm).heals);
}

/// Returns the load of one asperity of Zhao, Maietta & Chang, as published.
double zmc_asperity(double w, double radius, double hardness, double modulus) {
  constexpr double k = 0.4;
  const double w1 = std::pow(3 * pi * k * hardness / (4 * modulus), 2) * radius, w2 = 54 * w1;
  if (w < w1) return 4.0 / 3 * modulus * std::sqrt(radius) * std::pow(w, 1.5);
  if (w > w2) return 2 * pi * radius * w * hardness;
  const double s = (w - w1) / (w2 - w1);
  const double area = pi * radius * w * (1 - 2 * s * s * s + 3 * s * s);
  return area * (hardness - hardness * (1 - k) * (std::log(w2) - std::log(w)) / (std::log(w2) - std::log(w1)));
}

/// Returns the load of one asperity of Kogut & Etsion: the published fits times factors that make them continuous.
double ke_asperity(double w, double radius, double hardness, double modulus, bool as_published = false) {
  constexpr double factor = 0.577;
  const double wc = std::pow(pi * factor * hardness / (2 * modulus), 2) * radius, u = w / wc;
  const double critical = 2.0 / 3 * factor * hardness * pi * radius * wc;
  const auto scaled = [&](double scale) { return as_published ? 1 : scale; };
  const double third = std::pow(6, 1.425 - 1.263);
  if (u <= 1) return 4.0 / 3 * modulus * std::sqrt(radius) * std::pow(w, 1.5);
  if (u <= 6) return scaled(1 / 1.03) * 1.03 * critical * std::pow(u, 1.425);
  if (u <= 110) return scaled(third / 1.40) * 1.40 * critical * std::pow(u, 1.263);
  return scaled(third * std::pow(110, 0.263) * factor / 3) * 2 * pi * radius * w * hardness;
}

struct Yield {
  double (*load)(double w, double radius, double hardness, double modulus);
  double first;                // interference of first yield [m]
  std::vector<double> limits;  // interferences at which the law of one asperity changes, in units of `first`
};

constexpr double hardness = 1_GPa, modulus = 48_GPa, radius = 100_nm;

Yield yield(Plasticity plasticity) {
  if (plasticity == Plasticity::zmc) {
    return {zmc_asperity, PlasticAsperityLoading<ZmcAsperity>::first_yield(radius, hardness, modulus), {1, 54}};
  }
  return {[](double w, double r, double h, double e) { return ke_asperity(w, r, h, e); },
          PlasticAsperityLoading<KogutEtsionAsperity>::first_yield(radius, hardness, modulus),
          {1, 6, 110}};
}

TEST(ElasticPlastic, CarriesTheLawOfOneAsperityIntegratedOverItsHeights) {
  constexpr double digits = 1e-10;  // relative
  boost::math::quadrature::tanh_sinh<double> integrator;
  for (const Plasticity plasticity : plasticities) {
    const ContactLaw law = plastic_law(plasticity);
    const Yield one = yield(plasticity);
    for (const double d :
         {0.3 * one.first, 3 * one.first, 40 * one.first, 60 * one.first, 60_nm, 100.02_nm, 101_nm, 105_nm, 150_nm}) {
      std::vector<double> corners{std::max(0.0, d - 100_nm), d};
      for (const double limit : one.limits) {
        if (limit * one.first > corners.front() && limit * one.first < d) corners.push_back(limit * one.first);
      }
      std::sort(corners.begin(), corners.end());
      double sum = 0;
      for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const double begin = corners[i], length = corners[i + 1] - begin;
        sum += length *
               integrator.integrate([&](double x) { return one.load(begin + x * length, radius, hardness, modulus); }, 0.0, 1.0);
      }
      const double expected = 1e11 * beam_width * 5_um / 100_nm * sum;
      EXPECT_NEAR(contact_force(law, d), expected, digits * expected)
          << static_cast<int>(plasticity) << ", d = " << d / one.first << " w1";
    }
  }
}

TEST(ElasticPlastic, LoadOfOneAsperityAndItsIntegralsHaveNoJump) {
  constexpr double little = 1e-9;
  const auto expect_none = [](auto asperity, std::initializer_list<double> limits) {
    const auto load = [&](double u) { return asperity.first_integral(Dual(u, 1)).slope; };
    const auto expect_no_jump = [&](auto&& of, double u) {
      EXPECT_NEAR(of(u * (1 + little)), of(u * (1 - little)), 10 * little * of(u)) << u;
    };
    for (const double u : limits) {
      expect_no_jump(load, u);
      expect_no_jump([&](double at) { return asperity.first_integral(at); }, u);
      expect_no_jump([&](double at) { return asperity.second_integral(at); }, u);
    }
  };
  expect_none(ZmcAsperity{}, {1, 54});
  expect_none(KogutEtsionAsperity{}, {1, 6, 110});
}

TEST(ElasticPlastic, KogutEtsionIsScaledByWhatItsHeaderSays) {
  constexpr double printed = 5e-4;  // three digits
  constexpr double little = 1e-12;
  const double w = yield(Plasticity::kogut_etsion).first, critical = ke_asperity(w, radius, hardness, modulus);
  const auto published = [&](double u) { return ke_asperity(u * w, radius, hardness, modulus, true) / critical; };
  const auto scale = [&](double u) { return KogutEtsionAsperity::first_integral(Dual(u, 1)).slope / published(u); };
  EXPECT_NEAR(scale(0.5), 1, little);
  EXPECT_NEAR(scale(3), 0.971, printed);
  EXPECT_NEAR(scale(50), 0.955, printed);
  EXPECT_NEAR(scale(200), 0.885, printed);
  const auto jump = [&](double u) { return published(u * (1 + little)) / published(u * (1 - little)); };
  EXPECT_NEAR(jump(1), 1.03, printed);
  EXPECT_NEAR(jump(6), 1.017, printed);
  EXPECT_NEAR(jump(110), 1.079, printed);
}

/// Returns the energy that one asperity gives back as it unloads from u times the interference of first yield, over the work P
/// w_c of its load there: the fits of Etsion, Kligerman and Kadin (2005, Int. J. Solids Struct. 42, 3716) to finite elements,
/// whose summits are flattened.
double returned_by_flattened_summit(double u) {
  const double residual = u * (1 - std::pow(u, -0.28)) * (1 - std::pow(u, -0.69));
  const double exponent = 1.5 * std::pow(u, -0.0331);
  return (u - residual) / (exponent + 1);
}

TEST(ElasticPlastic, ReturnsMoreEnergyThanAFlattenedSummitAsDocumented) {
  const double w = yield(Plasticity::kogut_etsion).first, critical = ke_asperity(w, radius, hardness, modulus);
  // The sharp summit unloads along Hertz's curve from the load p: 0.4 p p^(2/3).
  const auto sharp = [](double load) { return 0.4 * std::pow(load, 2.0 / 3); };
  constexpr double printed = 5e-3;  // three digits
  struct {
    double u, published, here;
  } const cases[] = {{10, 1.34, 1.30}, {50, 1.65, 1.60}, {100, 1.81, 1.76}};
  for (const auto& [u, published, here] : cases) {
    const double fit = ke_asperity(u * w, radius, hardness, modulus, true) / critical;
    EXPECT_NEAR(sharp(fit) / returned_by_flattened_summit(u), published, printed) << u;
    const double load = KogutEtsionAsperity::first_integral(Dual(u, 1)).slope;
    EXPECT_NEAR(sharp(load) / returned_by_flattened_summit(u), here, printed) << u;
  }
}

TEST(ElasticPlastic, IsElasticBelowFirstYieldAndSofterAbove) {
  const ContactLaw elastic = law_of(UniformAsperities::example());
  for (const Plasticity plasticity : plasticities) {
    const ContactLaw law = plastic_law(plasticity);
    const double w1 = yield(plasticity).first;
    EXPECT_NEAR(contact_force(law, 0.9 * w1), contact_force(elastic, 0.9 * w1), 1e-12 * contact_force(elastic, w1));
    EXPECT_NEAR(dent(law, 0.9 * w1).lost, 0, 1e-12 * contact_energy(law, w1));
    for (const double factor : {1.01, 2.0, 30.0, 80.0, 1000.0}) {
      EXPECT_LT(contact_force(law, factor * w1), contact_force(elastic, factor * w1)) << factor;
    }
    EXPECT_FALSE(dent(law, 1_nm).heals);
  }
}

TEST(UniformAsperities, InterferenceBelongsToItsForce) {
  const auto law = std::get<UniformAsperityContact>(contact_law(gold_pad, beam_width));
  for (const double d : interferences) EXPECT_NEAR(law.interference(law.force(d)), d, 1e-13 * d);
  EXPECT_EQ(law.interference(0), 0);
}

/// Returns the published pressure of the adhesive-repulsive law, less the linear term that makes it vanish at its reach [Pa].
double surface_pressure(double x) {
  constexpr double nm = 1e-9, reach = 1000 * nm, asperities = 110, adhesion = 112;
  const auto far = [](double at) {
    return 0.5e9 * std::exp(-at / (8.5 * nm)) - 0.215e-18 / (6 * pi * (std::pow(at, 3) + std::pow(30 * nm, 3)));
  };
  const double slope = 0.215e-18 / (6 * pi) * 3 * reach * reach / std::pow(std::pow(reach, 3) + std::pow(30 * nm, 3), 2);
  return far(x) - far(reach) - slope * (x - reach) + 1.2e3 * std::pow(std::max(0.0, asperities - x / nm), 1.5) -
         1e3 * std::max(0.0, adhesion - x / nm);
}

// Distances above the plane, in the soft wall, around the onsets of adhesion and asperities (50.06 and 52.06 nm), and deep
// inside.
constexpr std::array near_and_far{-830_nm, -300_nm, -40_nm, -1_nm, 10_nm, 49_nm, 51_nm, 53_nm, 60_nm, 100_nm, 150_nm};

TEST(AdhesiveRepulsive, IsThePublishedPressureLessALine) {
  const AdhesiveRepulsiveContact law(SurfacePressure{}, beam_width * 5_um);
  EXPECT_NEAR(law.touch_distance(), 162.0596_nm, 1e-4 * 1_nm);
  constexpr double digits = 1e-12;  // error of the pressure itself and of its parts at the reach
  for (const double d : near_and_far) {
    const double expected = beam_width * 5_um * surface_pressure(law.touch_distance() - d);
    EXPECT_NEAR(law.force(d), expected, digits * (std::abs(expected) + beam_width * 5_um)) << "d = " << d;
  }
  // The linear term is a small share of the attraction at typical distances.
  for (const double x : {150_nm, 112_nm}) {
    const double attraction = 0.215e-18 / (6 * pi * (std::pow(x, 3) + std::pow(30_nm, 3)));
    const double line = surface_pressure(x) + attraction - 0.5e9 * std::exp(-x / 8.5_nm);
    EXPECT_LT(std::abs(line), 0.0125 * attraction);
  }
}

TEST(AdhesiveRepulsive, StoresTheIntegralOfItsForce) {
  constexpr double digits = 1e-10;    // relative
  constexpr double rounding = 1e-30;  // [J] of the attraction's antiderivative, 1e-15 J
  const AdhesiveRepulsiveContact law(SurfacePressure{}, beam_width * 5_um);
  boost::math::quadrature::tanh_sinh<double> integrator;
  EXPECT_NEAR(law.energy(-law.reach()), 0, rounding);
  const double adhesion = law.touch_distance() - 112_nm, asperities = law.touch_distance() - 110_nm;
  for (const double d : near_and_far) {
    std::vector<double> corners{-law.reach(), d};
    for (const double corner : {-0.5 * law.reach(), 0.0, adhesion, asperities}) {
      if (corner < d) corners.push_back(corner);
    }
    std::sort(corners.begin(), corners.end());
    double sum = 0, size = 0;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      const double begin = corners[i], length = corners[i + 1] - begin;
      const double part = length * integrator.integrate([&](double u) { return law.force(begin + u * length); }, 0.0, 1.0);
      sum += part;
      size += std::abs(part);
    }
    EXPECT_NEAR(law.energy(d), sum, digits * size + rounding) << "d = " << d;
    const double slope = derivative([&](double x) { return law.energy(x); }, d, 0.05_nm);
    EXPECT_NEAR(slope, law.force(d), 1e-8 * (std::abs(law.force(d)) + 10 * beam_width * 5_um)) << "d = " << d;
    const double stiffness = derivative([&](double x) { return law.force(x); }, d, 0.05_nm);
    EXPECT_NEAR(law.force(Dual(d, 1)).slope, stiffness, 1e-8 * (std::abs(stiffness) + beam_width * 5_um / 1_nm)) << "d = " << d;
  }
}

TEST(AdhesiveRepulsive, BeginsSmoothlyAtItsReachAndTouchesWhereItsAttractionEnds) {
  const AdhesiveRepulsiveContact law(SurfacePressure{}, beam_width * 5_um);
  const double area = beam_width * 5_um;
  EXPECT_NEAR(law.force(-law.reach()), 0, 1e-12 * area);
  EXPECT_NEAR(law.force(Dual(-law.reach(), 1)).slope, 0, 1e-12 * area / 1_nm);
  EXPECT_NEAR(law.force(0.0), 0, 1e-9 * area);
  for (double d = -law.reach() + 1_nm; d < -0.1_nm; d += 1_nm) EXPECT_LT(law.force(d), 0) << d;
  EXPECT_GT(law.force(1_nm), 0);
  EXPECT_EQ(contact_reach(law_of(AdhesiveRepulsiveSurfaces())), law.reach());
  EXPECT_EQ(contact_reach(contact_law(gold_pad, beam_width)), 0);
}

TEST(AdhesiveRepulsive, SaysWhereItIsNotSmooth) {
  const AdhesiveRepulsiveContact law(SurfacePressure{}, beam_width * 5_um);
  const auto slope = [&](double d) { return law.force(Dual(d, 1)).slope; };
  const std::vector<double> kinks = contact_kinks(law_of(AdhesiveRepulsiveSurfaces()));
  ASSERT_EQ(kinks.size(), 2u);
  const double jump = slope(kinks[0] + 1e-15) - slope(kinks[0] - 1e-15);
  const double adhesion = beam_width * 5_um * SurfacePressure{}.adhesion_pressure / 1_nm;
  EXPECT_NEAR(jump, -adhesion, 1e-3 * adhesion) << "where adhesion begins";
  // The slope grows like a root at the onset of the asperities.
  const auto bend = [&](double at) { return slope(kinks[1] + at) - slope(kinks[1] - at); };
  EXPECT_NEAR(bend(1e-13) / bend(1e-15), 10, 0.1);
  EXPECT_TRUE(contact_kinks(contact_law(gold_pad, beam_width)).empty());
}

// ---- dual numbers

TEST(Dual, FollowsTheRulesOfDifferentiation) {
  const Dual x(3, 1), y(0.7, -2);
  const auto expect = [](Dual found, double value, double slope) {
    EXPECT_DOUBLE_EQ(found.value, value);
    EXPECT_DOUBLE_EQ(found.slope, slope);
  };
  expect(x + y, 3.7, -1);
  expect(x - y, 2.3, 3);
  expect(-x, -3, -1);
  expect(x * y, 2.1, 0.7 - 6);
  expect(x / y, 3 / 0.7, (0.7 + 6) / 0.49);
  expect(sqrt(x), std::sqrt(3.0), 1 / (2 * std::sqrt(3.0)));
  expect(exp(y), std::exp(0.7), -2 * std::exp(0.7));
  expect(log(y), std::log(0.7), -2 / 0.7);
  expect(abs(Dual(-3, 5)), 3, -5);
  expect(abs(Dual(3, 5)), 3, 5);
  expect(2 * x + 1, 7, 2);
  expect(1 / x, 1.0 / 3, -1.0 / 9);
  expect(power(x, 1.5), std::pow(3.0, 1.5), 1.5 * std::sqrt(3.0));
  EXPECT_TRUE(x > 2.9);
  EXPECT_TRUE(x < 3.1);
  EXPECT_FALSE(x < 3);
}

TEST(Power, IsThatOfTheLibrary) {
  constexpr double claimed = 1e-14;  // relative, as stated; observed: 4e-15 with fused multiply-add, 5.4e-15 without
  double worst = 0;
  for (double x = 1e-9; x < 1e9; x *= 1.0037) {
    for (const double y : {1.159, 3.1, 1.825, 0.966, -1.2, 0.0}) {
      if (std::abs(y * std::log2(x)) > 50) continue;
      const double expected = std::pow(x, y);
      worst = std::max(worst, std::abs(power(x, y) - expected) / expected);
    }
  }
  EXPECT_LT(worst, claimed);
  EXPECT_EQ(power(1.0, 1.159), 1);
  EXPECT_TRUE(!(worst < 0.01 * claimed)) << "the test looked at something";
}

TEST(Power, InverseFourthRootIsExactToRounding) {
  constexpr double claimed = 1e-15;  // relative, as stated; observed: 4e-16
  double worst = 0;
  for (double x = 1e-15; x < 1e15; x *= 1.0037) worst = std::max(worst, std::abs(inverse_fourth_root(x) * std::pow(x, 0.25) - 1));
  EXPECT_LT(worst, claimed);
  const Dual at = inverse_fourth_root(Dual(16, 1));
  EXPECT_DOUBLE_EQ(at.value, 0.5);
  EXPECT_DOUBLE_EQ(at.slope, -0.5 / 64);
}

TEST(Dual, RootAtZeroHasNoInfiniteSlope) {
  EXPECT_EQ(sqrt(Dual(0, 1)).value, 0);
  EXPECT_EQ(sqrt(Dual(0, 1)).slope, 0);
}

// ---- a law along the beam

// Returns a field of at most one lane of points, filled with unused ones.
GapField field(const std::vector<double>& gap, double velocity) {
  constexpr double rest_gap = 3.5_um;
  GapField f{.gap = Eigen::ArrayXd::Constant(lanes, rest_gap), .velocity = Eigen::ArrayXd::Constant(lanes, velocity)};
  std::copy(gap.begin(), gap.end(), f.gap.begin());
  f.smallest_gap = f.gap.minCoeff();
  return f;
}

template <class Law>
double load_at(const DistributedLawOf<Law>& law, double gap, double velocity) {
  std::array<double, lanes> load{};
  law.add_load(field({gap}, velocity), 1, load.data());
  EXPECT_EQ(load[1], 0);
  return load[0];
}

template <class Law>
void expect_tangent_below(const Law& physics, double floor, double velocity) {
  const DistributedLawOf<Law> law(physics, 0, 1, floor);
  const double value = physics.load(floor, velocity), slope = physics.load(Dual(floor, 1), Dual(velocity)).slope;
  EXPECT_DOUBLE_EQ(load_at(law, floor, velocity), value);
  constexpr double close = 1e-6;  // distance of the two sides that are compared, over the floor
  EXPECT_NEAR(load_at(law, floor * (1 - close), velocity), value, 10 * close * std::abs(value));
  for (const double below : {0.5 * floor, 0.0, -3 * floor}) {
    const double expected = value + slope * (below - floor);
    EXPECT_NEAR(load_at(law, below, velocity), expected, 1e-14 * std::abs(expected)) << "gap " << below;
    std::array<double, lanes> by_deflection{}, by_velocity{};
    law.add_derivatives(field({below}, velocity), 1, by_deflection.data(), by_velocity.data());
    EXPECT_DOUBLE_EQ(by_deflection[0], -slope);
  }
}

TEST(DistributedLaw, GoesOnAlongItsTangentBelowTheFloor) {
  constexpr double floor = 35_nm;
  expect_tangent_below(ElectrostaticForce<NoFringing>{fringing<NoFringing>(20_um, 2_um)}, floor, 0.1);
  expect_tangent_below(ElectrostaticForce<LinearFringing>{fringing<LinearFringing>(20_um, 2_um)}, floor, 0.1);
  expect_tangent_below(ElectrostaticForce<MeijsFokkemaFringing>{fringing<MeijsFokkemaFringing>(20_um, 2_um)}, floor, 0.1);
  expect_tangent_below(ElectrostaticForce<Bao2001Fringing>{fringing<Bao2001Fringing>(20_um, 2_um)}, floor, 0.1);
  expect_tangent_below(StripSqueezeFilm{.viscosity = 1.86e-5_Pa_s, .width = 20_um}, floor, 0.1);
}

template <class Law>
class LawAlongTheBeam : public testing::Test {
 protected:
  static Law physics() {
    if constexpr (requires { Law::law; }) {
      return {.law = dispersion<decltype(Law::law)>(), .width = 20_um};
    } else if constexpr (Law::drive_depends) {
      return {fringing<decltype(Law::fringing)>(20_um, 2_um)};
    } else {
      return gas_law_of_type<Law>(20_um, 65_nm);
    }
  }
};
template <class Fringing, class Gas, class... Others>
struct AlongTheBeam;
template <class... Fringing, class... Gas, class... Others>
struct AlongTheBeam<std::variant<Fringing...>, std::variant<Gas...>, Others...> {
  using Types = testing::Types<ElectrostaticForce<Fringing>..., Gas..., Others...>;
};
using LawsAlongTheBeam = AlongTheBeam<FringingLaw, GasLaw::variant, DispersionForce<IdealCasimir>, DispersionForce<GoldCasimir>,
                                      DispersionForce<VanDerWaals>, DispersionForce<SmallerOfBoth<IdealCasimir>>,
                                      DispersionForce<SmallerOfBoth<GoldCasimir>>>::Types;
TYPED_TEST_SUITE(LawAlongTheBeam, LawsAlongTheBeam);

constexpr double gap_floor = 35_nm;
// Gaps above, just above, at, just below and far below the floor; deep below, no gap is left.
constexpr std::array around_the_floor{
    10 * gap_floor, 1.5 * gap_floor, 1.0000001 * gap_floor, gap_floor, 0.9999999 * gap_floor, 0.5 * gap_floor, 0.0,
    -gap_floor,     -5 * gap_floor};

TYPED_TEST(LawAlongTheBeam, HasTheDerivativesOfItsLoadAboveAndBelowTheFloor) {
  constexpr double differences = 1e-5;  // relative; at the floor the second derivative jumps
  const DistributedLawOf law(TestFixture::physics(), 0, 1, gap_floor);
  for (const double h : around_the_floor) {
    for (const double v : {-0.4, 0.1}) {
      std::array<double, lanes> by_deflection{}, by_velocity{};
      law.add_derivatives(field({h}, v), 1, by_deflection.data(), by_velocity.data());
      const double by_gap = derivative([&](double x) { return load_at(law, x, v); }, h, 1e-6 * gap_floor);
      EXPECT_NEAR(by_deflection[0], -by_gap, differences * std::abs(by_gap)) << "gap " << h << ", velocity " << v;
      const double expected = derivative([&](double x) { return load_at(law, h, x); }, v, 0.01);
      EXPECT_NEAR(by_velocity[0], expected, 1e-11 * std::abs(expected)) << "gap " << h << ", velocity " << v;
    }
  }
}

TYPED_TEST(LawAlongTheBeam, HasTheEnergyOfItsLoadAboveAndBelowTheFloor) {
  if constexpr (TypeParam::drive_depends) {
    constexpr double differences = 1e-5;  // relative; at the floor the third derivative jumps
    const DistributedLawOf law(TestFixture::physics(), 0, 1, gap_floor);
    const Eigen::ArrayXd weights = Eigen::ArrayXd::Constant(1, 10_um);
    const auto energy = [&](double h) { return law.potential(field({h}, 0), weights); };
    for (const double h : around_the_floor) {
      const double slope = derivative(energy, h, 1e-3 * gap_floor);
      EXPECT_NEAR(slope, 10_um * load_at(law, h, 0), differences * std::abs(slope)) << "gap " << h;
    }
  }
}

TEST(DistributedLaw, ActsAtItsOwnPointsOnly) {
  const DistributedLawOf law(ElectrostaticForce<NoFringing>{{.width = 20_um}}, 1, 3, 35_nm);
  const std::vector<double> gap{1_um, 2_um, 3_um, 4_um};
  constexpr double drive = 9;  // V^2
  std::vector<double> load(4, 1.0), by_deflection(4, 1.0), by_velocity(4, 1.0);
  law.add_load(field(gap, 0), drive, load.data());
  law.add_derivatives(field(gap, 0), drive, by_deflection.data(), by_velocity.data());
  EXPECT_EQ(load[0], 1);
  EXPECT_EQ(load[3], 1);
  EXPECT_DOUBLE_EQ(load[1], 1 + drive * ElectrostaticForce<NoFringing>{{.width = 20_um}}.load(2_um, 0.0));
  EXPECT_EQ(by_deflection[0], 1);
  EXPECT_GT(by_deflection[1], 1) << "the force grows as the beam deflects";
  EXPECT_EQ(by_velocity, std::vector<double>(4, 1.0));
  const Eigen::ArrayXd weights = Eigen::ArrayXd::Constant(4, 10_um);
  EXPECT_DOUBLE_EQ(law.potential(field(gap, 0), weights), -vacuum_permittivity * 20e-6 * 10e-6 * (1 / 2e-6 + 1 / 3e-6) / 2);
}

TEST(DistributedLaw, OnePointBelowTheFloorChangesNothingAtTheOthers) {
  const DistributedLawOf law(ElectrostaticForce<MeijsFokkemaFringing>{fringing<MeijsFokkemaFringing>(20_um, 2_um)}, 0, 2, 35_nm);
  std::vector<double> alone(lanes, 0.0), beside(lanes, 0.0);
  law.add_load(field({2_um, 3_um}, 0), 1, alone.data());
  law.add_load(field({2_um, 10_nm}, 0), 1, beside.data());
  constexpr double rounding = 1e-14;  // relative: the eighth power of h^(-1/4), by roots and without
  EXPECT_NEAR(alone[0], beside[0], rounding * beside[0]);
}

TEST(PassiveLaw, IgnoresTheDrive) {
  const StripSqueezeFilm film{.viscosity = 1.86e-5_Pa_s, .width = 20_um};
  const DistributedLawOf law(film, 0, 1, 35_nm);
  std::array<double, lanes> load{};
  law.add_load(field({1_um}, 0.3), 0, load.data());
  EXPECT_DOUBLE_EQ(load[0], film.load(1_um, 0.3));
}

}  // namespace
}  // namespace softland
