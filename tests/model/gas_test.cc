// State of the gas, the linear damper's quality factor, and the limits of the gas laws.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/literals.h"
#include "model/closing.h"
#include "model/gas/gas_law.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;

TEST(Gas, OfAirHasTheMeanFreePathOfItsViscosity) {
  constexpr double printed = 1e-4;  // relative: four digits
  EXPECT_NEAR(mean_free_path({}), 67.00_nm, printed * 67.00_nm);
  EXPECT_DOUBLE_EQ(mean_free_path({.pressure = 1e3}), 101.325 * mean_free_path({}));
  EXPECT_DOUBLE_EQ(mean_free_path({.viscosity = 3.6e-5}), 2 * mean_free_path({.viscosity = 1.8e-5}));
  EXPECT_DOUBLE_EQ(mean_free_path({.viscosity = 1.8e-5, .temperature = 1200}),
                   2 * mean_free_path({.viscosity = 1.8e-5, .temperature = 300}));
}

TEST(Gas, OfAirHasTheTabulatedViscosity) {
  constexpr double printed = 0.5001e-9;  // five digits
  // U.S. Standard Atmosphere, 1976, at sea level and in the tropopause.
  for (const auto& [temperature, tabulated] : {std::pair{288.15, 1.7894e-5}, std::pair{216.65, 1.4216e-5}})
    EXPECT_NEAR(viscosity({.temperature = temperature}), tabulated, printed) << temperature;
  // Incropera & DeWitt, Fundamentals of Heat and Mass Transfer, table A.4, which is based on another formula.
  for (const auto& [temperature, tabulated] :
       {std::pair{250.0, 159.6e-7}, std::pair{300.0, 184.6e-7}, std::pair{350.0, 208.2e-7}, std::pair{400.0, 230.1e-7}})
    EXPECT_NEAR(viscosity({.temperature = temperature}), tabulated, 0.01 * tabulated) << temperature;
}

TEST(Gas, GivenNumbersWin) {
  EXPECT_EQ(viscosity({.viscosity = 2e-5, .temperature = 500}), 2e-5);
  EXPECT_EQ(mean_free_path({.pressure = 7, .mean_free_path = 64_nm}), 64_nm);
}

TEST(LinearDamper, GivesTheFirstModeItsQualityFactor) {
  constexpr double quadrature = 1e-9;
  for (Device d : {test::gold_cantilever(), test::gold_pzt_cantilever()}) {
    d.gas = LinearGas{.quality_factor = 8};
    const Switch model(d);
    Switch::Workspace work = model.workspace();
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.modes());
    const Eigen::VectorXd v = Eigen::VectorXd::Unit(model.modes(), 0);
    // Q = omega_1 times twice the mean kinetic energy over the power, for a velocity of one.
    const double power = model.dissipated_power(rest.data(), v.data(), work);
    EXPECT_NEAR(model.basis().angular_frequencies()[0] / power, 8, quadrature * 8);
  }
}

TEST(LinearDamper, OfAUniformBeamDampsEveryModeAtTheSameRate) {
  Device damper = test::gold_cantilever(), modal = damper;
  damper.gas = LinearGas{.quality_factor = 8};
  modal.gas.reset();
  modal.structure.modes = damper.structure.modes = 1;
  modal.structure.damping_ratio = 1.0 / 16;
  const Switch a(damper), b(modal);
  Switch::Workspace work_a = a.workspace(), work_b = b.workspace();
  const double rest = 0, v = 1;
  EXPECT_NEAR(a.dissipated_power(&rest, &v, work_a), b.dissipated_power(&rest, &v, work_b),
              1e-9 * a.basis().angular_frequencies()[0]);
}

Trajectory closing(const Gas& gas) {
  Device d = test::gold_cantilever();
  d.gas = gas;
  return simulate_closing(Switch(d), std::vector<Signal>{Signal::constant(17.771)}, {.duration = 60_us});
}

TEST(GasLimits, AreNotMentionedWithinThem) {
  EXPECT_THAT(closing(StripGas{.film = {.viscosity = 1.86e-5_Pa_s}}).warnings, testing::IsEmpty());
  EXPECT_THAT(closing(LinearGas{.quality_factor = 3}).warnings, testing::IsEmpty());
  EXPECT_THAT(closing(VeijolaGas{.film = {.pressure = 1e3}}).warnings, testing::IsEmpty());
}

TEST(GasLimits, ThatATrajectoryLeavesAreWarnings) {
  using testing::ElementsAre;
  // The closed gap is 1.5 um; at 1e4 Pa the mean free path is 663 nm. The contact yields a little.
  EXPECT_THAT(closing(StripGas{.film = {.pressure = 1e4}}).warnings,
              ElementsAre("gas law strip: Knudsen number 0.46 exceeds 0.1"));
  EXPECT_THAT(closing(NearContactGas{.film = {.mean_free_path = 10_nm}}).warnings,
              ElementsAre("gas law near-contact: Knudsen number 0.0029 is below 0.0047"));
  // Printed with four digits, not as 4.5e+03.
  EXPECT_THAT(closing(StripGas{.film = {.pressure = 1}}).warnings,
              testing::Contains(testing::ContainsRegex("Knudsen number [0-9]{4} exceeds 0.1")));
  // Squeeze numbers of 12 mu a^2 v / (p h^3): about 0.025 at 101325 Pa.
  const auto thin = closing(VeijolaGas{.film = {.pressure = 100, .mean_free_path = 65_nm}}).warnings;
  ASSERT_EQ(thin.size(), 1u);
  EXPECT_THAT(thin[0],
              testing::MatchesRegex("gas law veijola: squeeze number .* exceeds 10: the film is compressed, not squeezed out"));
}

// A thin gas is rarefied, and flows out before it is compressed: the larger Knudsen number is the only limit that is left.
TEST(GasLimits, OfAThinGasAreItsKnudsenNumberAlone) {
  const auto warnings = closing(StripGas{.film = {.pressure = 1}}).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], testing::HasSubstr("Knudsen number"));
  EXPECT_THAT(closing(VeijolaGas{.film = {.pressure = 100}}).warnings, testing::IsEmpty());
}

TEST(SqueezeNumber, IsTheTextbookOneWithTheViscosityOfTheRarefiedGas) {
  const double textbook = 12 * 2e-5 * 4e-10 * 1e5 / (101325 * 4e-12);
  EXPECT_NEAR(squeeze_number({.viscosity = 2e-5, .mean_free_path = 1e-18}, 20_um, 2_um, 1e5), textbook, 1e-11 * textbook);
  // A mean free path as long as the gap.
  EXPECT_DOUBLE_EQ(squeeze_number({.viscosity = 2e-5, .mean_free_path = 2_um}, 20_um, 2_um, 1e5), textbook / 10.638);
}

}  // namespace
}  // namespace softland
