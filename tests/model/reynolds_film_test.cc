// The compressible gas film, against the closed form of the linear strip: limits, derivatives and energy.
#include "model/gas/reynolds_film.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include "base/literals.h"
#include "model/closing.h"
#include "model/constants.h"
#include "model/gas/air.h"
#include "model/gas/gas_law.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

using namespace literals;
using Complex = std::complex<double>;

constexpr int nodes = ReynoldsFilm::nodes;
constexpr double width = 40_um;
const ReynoldsGas air{.film = {.viscosity = 1.82e-5_Pa_s, .mean_free_path = 64_nm}};

ReynoldsFilm film(Eigen::Index stations = 1) { return {air.film, width, stations, 20_nm}; }

/// Returns the force per area over p/h of a small oscillation with the squeeze number sigma (Blech 1983): 1 - tanh(B/2)/(B/2),
/// B = sqrt(i sigma).
Complex blech(double sigma) {
  const Complex half = std::sqrt(Complex(0, sigma)) / 2.0;
  return 1.0 - std::tanh(half) / half;
}

/// Returns the same of the implemented film, with slip: the linear response of its states to a unit oscillation of the gap
/// about h.
Complex response(double sigma) {
  const double h = 2.3_um, rarefied = 1 + 6 * mean_free_path(air.film) / h;
  const double omega = sigma * rarefied * air.film.pressure * h * h / (12 * viscosity(air.film) * width * width);
  const ReynoldsFilm f = film();
  const std::vector<double> rest(nodes, 0.0);
  const ReynoldsFilm::Derivatives d = f.derivatives(h, 0, rest.data());
  const Complex rate(0, omega);  // rate of the gap: velocity = -rate
  const Eigen::MatrixXcd system = rate * Eigen::MatrixXcd::Identity(nodes, nodes) - d.by_film.cast<Complex>();
  const Eigen::VectorXcd p = system.partialPivLu().solve(Eigen::VectorXcd(-rate * d.by_velocity.cast<Complex>()));
  const Complex load = f.load_by_film().cast<Complex>().dot(p);
  return load / (width * air.film.pressure / h);  // a growing gap pulls towards the electrode
}

TEST(ReynoldsFilm, OfASmallOscillationIsBlechsStrip) {
  struct Row {
    double sigma, error;  // relative to the force
  };
  for (const auto& [sigma, error] : {Row{1e-3, 1e-10}, Row{1, 1e-10}, Row{pi * pi, 1e-7}, Row{100, 1e-4}, Row{1000, 0.02}}) {
    const Complex expected = blech(sigma);
    EXPECT_LT(std::abs(response(sigma) - expected), error * std::abs(expected)) << "squeeze number " << sigma;
  }
}

TEST(ReynoldsFilm, IsADamperBelowTheCutOffAndASpringAbove) {
  // Real and imaginary parts are equal at pi^2 for the first mode across the width alone; the other modes shift that by a few
  // per cent.
  EXPECT_GT(response(0.9 * pi * pi).imag(), response(0.9 * pi * pi).real());
  EXPECT_LT(response(1.15 * pi * pi).imag(), response(1.15 * pi * pi).real());
  // In the slow limit the film is incompressible, with slip.
  const double h = 2.3_um, slow = 1e-4;
  const double damping = response(slow).imag() / slow * 12 * viscosity(air.film) * std::pow(width / h, 3) / (1 + 6 * 64_nm / h);
  const GasLaw limit = gas_law(air, {.width = width}, 1);
  EXPECT_NEAR(damping, damping_per_length(limit, h), 1e-8 * damping);
}

struct Station {
  double gap, velocity;
  std::vector<double> film;
};

Station random_station(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Station s{.gap = 1_um + 0.8_um * uniform(random), .velocity = uniform(random), .film = {}};
  for (int i = 0; i < nodes; ++i) s.film.push_back(size * uniform(random));
  return s;
}

GapField field_of(const Station& s) {
  return {.gap = Eigen::ArrayXd::Constant(1, s.gap), .velocity = Eigen::ArrayXd::Constant(1, s.velocity), .smallest_gap = s.gap};
}

TEST(ReynoldsFilm, DerivativesAreThoseOfTheRates) {
  constexpr double differences = 1e-7;  // error as a share of the largest entry of the column
  std::mt19937_64 random(1);
  const ReynoldsFilm f = film();
  for (int k = 0; k < 20; ++k) {
    Station s = random_station(random, 0.5);
    const ReynoldsFilm::Derivatives d = f.derivatives(s.gap, s.velocity, s.film.data());
    const auto column = [&](double& unknown, double h) {
      const double at = unknown;
      Eigen::VectorXd plus(nodes), minus(nodes);
      unknown = at + h;
      f.rates(field_of(s), s.film.data(), plus.data());
      unknown = at - h;
      f.rates(field_of(s), s.film.data(), minus.data());
      unknown = at;
      return Eigen::VectorXd((plus - minus) / (2 * h));
    };
    const auto expect = [&](const Eigen::VectorXd& found, const Eigen::VectorXd& expected) {
      EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), differences * expected.cwiseAbs().maxCoeff());
    };
    expect(d.by_gap, column(s.gap, 0.1_nm));
    expect(d.by_velocity, column(s.velocity, 0.01));
    for (int i = 0; i < nodes; ++i) expect(d.by_film.col(i), column(s.film[static_cast<std::size_t>(i)], 1e-4));
  }
}

TEST(ReynoldsFilm, WorkOnItIsStoredOrDissipated) {
  // dU/dt + D = -f v holds exactly, in any state.
  constexpr double rounding = 1e-6;  // error of the difference quotient
  std::mt19937_64 random(2);
  const ReynoldsFilm f = film();
  const Eigen::ArrayXd one = Eigen::ArrayXd::Ones(1);
  for (int k = 0; k < 20; ++k) {
    const Station s = random_station(random, 0.7);
    Eigen::VectorXd rate(nodes);
    f.rates(field_of(s), s.film.data(), rate.data());
    const double dt = 1e-6 / rate.cwiseAbs().maxCoeff();
    const auto energy = [&](double sign) {
      Station moved = s;
      moved.gap -= sign * dt * s.velocity;
      for (int i = 0; i < nodes; ++i) moved.film[static_cast<std::size_t>(i)] += sign * dt * rate[i];
      return f.energy(field_of(moved), one, moved.film.data());
    };
    double load = 0;
    f.add_load(s.film.data(), &load);
    const double stored = (energy(1) - energy(-1)) / (2 * dt), lost = f.dissipated_power(field_of(s), one, s.film.data());
    EXPECT_GT(f.energy(field_of(s), one, s.film.data()), 0);
    EXPECT_NEAR(stored + lost, -load * s.velocity, rounding * (std::abs(stored) + std::abs(lost)));
  }
}

// Gauss-Lobatto points of degree 8, from the middle.
constexpr std::array<double, nodes> places{0, 0.3631174638261782, 0.6771862795107377, 0.8997579954114602};

std::vector<double> parabola(double amplitude) {
  std::vector<double> p;
  for (const double x : places) p.push_back(amplitude * (1 - x * x));
  return p;
}

TEST(ReynoldsFilm, FlowsAsTheNonlinearEquationSays) {
  // In closed form at rest, p = pa (1 + A (1 - x^2)), x = 2 z/a, gives h dp/dt = (h^3 + 6 lambda h^2)/(12 mu) (p^2/2)''.
  const double gap = 1.3_um, amplitude = 0.8;
  const std::vector<double> p = parabola(amplitude);
  std::array<double, nodes> rate{};
  film().rates(field_of({.gap = gap, .velocity = 0, .film = p}), p.data(), rate.data());
  const double diffusion = air.film.pressure * gap * (gap + 6 * 64_nm) / (12 * viscosity(air.film) * std::pow(width / 2, 2));
  for (std::size_t i = 0; i < nodes; ++i) {
    const double bend = -2 * amplitude * (1 + amplitude) + 6 * amplitude * amplitude * places[i] * places[i];
    EXPECT_NEAR(rate[i], diffusion * bend, 1e-10 * diffusion) << i;
  }
}

TEST(ReynoldsFilm, DissipatesWhatTheFlowDoes) {
  // (h^3 + 6 lambda h^2)/(12 mu) int (dp/dz)^2 dz for the parabola.
  const double gap = 1.3_um, amplitude = 1e-3;
  const std::vector<double> p = parabola(amplitude);
  const double expected =
      gap * gap * (gap + 6 * 64_nm) / (12 * viscosity(air.film)) * 16 / (3 * width) * std::pow(amplitude * air.film.pressure, 2);
  const double found =
      film().dissipated_power(field_of({.gap = gap, .velocity = 0, .film = p}), Eigen::ArrayXd::Ones(1), p.data());
  EXPECT_NEAR(found, expected, 1e-5 * expected);
}

TEST(ReynoldsFilm, OfAFastAndLargeStrokeIsAnIsothermalGasSpring) {
  // If the gap changes much faster than gas can leave, p h is constant except at the edges.
  const double h0 = 2_um, h1 = 1_um, speed = 1e5;
  std::vector<double> p(nodes, 0.0), rate(nodes);
  const ReynoldsFilm f = film();
  constexpr int steps = 20000;
  const double dt = (h0 - h1) / speed / steps;
  for (int k = 0; k < steps; ++k) {
    const auto slope = [&](const std::vector<double>& at, double t) {
      f.rates(field_of({.gap = h0 - speed * t, .velocity = speed, .film = at}), at.data(), rate.data());
    };
    slope(p, k * dt);
    std::vector<double> middle = p;
    for (std::size_t i = 0; i < nodes; ++i) middle[i] += dt / 2 * rate[i];
    slope(middle, (k + 0.5) * dt);
    for (std::size_t i = 0; i < nodes; ++i) p[i] += dt * rate[i];
  }
  EXPECT_NEAR(p[0], h0 / h1 - 1, 1e-3);
}

// ---- in a switch

Device gold_with(const Gas& gas) {
  Device d = test::gold_cantilever();
  d.gas = gas;
  return d;
}

TEST(Switch, WithAFilmOfItsOwnStatesHasTheExactJacobian) {
  constexpr double differences = 1e-7;  // error as a share of the largest entry of the column
  for (Device d : {gold_with(air), test::gold_bridge(), test::full_plate()}) {
    d.gas = air;
    const Switch model(d);
    Switch::Workspace work = model.workspace();
    const Eigen::Index n = model.modes(), size = 2 * n + static_cast<Eigen::Index>(model.film_states());
    EXPECT_EQ(model.film_states(), static_cast<std::size_t>(nodes * model.quadrature().points()));
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Eigen::VectorXd state = Eigen::VectorXd::NullaryExpr(size, [&] { return 0.3 * uniform(random); });
    const double shape = model.basis().contact_shape()[0];
    state.head(n).setZero();
    state[0] = 1_um / shape;
    state.segment(n, n) *= 0.1 / shape;
    std::vector<double> volts(model.drives(), 5.0);
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(size, size);
    full.block(0, n, n, n).setIdentity();
    model.jacobian(state.data(), state.data() + n, volts, false, work, full.block(n, 0, n, n), full.block(n, n, n, n));
    model.add_film_derivatives(state.data(), work, full);
    const auto rates = [&](const Eigen::VectorXd& at) {
      Eigen::VectorXd r(size - n);
      model.rates(at.data(), volts, false, work, r.data());
      return r;
    };
    for (Eigen::Index i = 0; i < size; ++i) {
      const double h = i < n ? 0.1_nm / shape : i < 2 * n ? 1e-3 / shape : 1e-5;
      Eigen::VectorXd plus = state, minus = state;
      plus[i] += h;
      minus[i] -= h;
      const Eigen::VectorXd column = (rates(plus) - rates(minus)) / (2 * h);
      EXPECT_LT((column - full.col(i).tail(size - n)).cwiseAbs().maxCoeff(), differences * column.cwiseAbs().maxCoeff()) << i;
    }
  }
}

Trajectory closing(const Device& d, double tolerance, Integrator integrator = Integrator::automatic) {
  const std::vector<Signal> drives{Signal::constant(17.771)};
  return simulate_closing(Switch(d), drives, {.duration = 45_us, .tolerance = tolerance, .integrator = integrator});
}

TEST(ReynoldsFilm, InAClosingAtOneAtmosphereIsNearlyIncompressible) {
  // Squeeze numbers are small here: the compressible film and its incompressible limit agree within a per cent in landing and
  // energy.
  const ReynoldsGas gas{.film = {.viscosity = 1.86e-5_Pa_s, .mean_free_path = 1e-12_m}};
  const Trajectory compressible = closing(gold_with(gas), 1e-6), strip = closing(test::gold_cantilever(), 1e-6);
  ASSERT_EQ(compressible.status, Status::done) << compressible.message;
  ASSERT_GE(compressible.touches.size(), 3u);
  EXPECT_NEAR(compressible.touches[0].begin, strip.touches[0].begin, 0.005 * strip.touches[0].begin);
  EXPECT_NEAR(compressible.touches[0].impact_velocity, strip.touches[0].impact_velocity, 0.02 * strip.touches[0].impact_velocity);
  EXPECT_NE(compressible.touches[0].begin, strip.touches[0].begin);
}

TEST(ReynoldsFilm, InAClosingKeepsTheBalanceOfEnergy) {
  struct Case {
    double pressure;
    Integrator integrator;
  };
  for (const auto& [pressure, integrator] : {Case{101325, Integrator::automatic}, Case{3e3, Integrator::bdf}}) {
    ReynoldsGas gas = air;
    gas.film.mean_free_path = 64_nm * 101325 / pressure;
    gas.film.pressure = pressure;
    const Trajectory t = closing(gold_with(gas), 1e-8, integrator);
    ASSERT_EQ(t.status, Status::done) << t.message;
    EXPECT_GE(t.touches.size(), 3u);
    EXPECT_GT(t.energy.dissipated, 0.001 * t.energy.source_work);
    EXPECT_LT(std::abs(t.energy.residual()), 1e-6 * t.energy.source_work) << pressure;
  }
}

TEST(ReynoldsFilm, ExplicitAndImplicitIntegratorsAgree) {
  constexpr double figures = 1e-4;  // relative: they carry some hundred times the integrator's tolerance
  ReynoldsGas gas = air;
  gas.film.pressure = 3e3;
  gas.film.mean_free_path = 64_nm;
  const Trajectory implicit = closing(gold_with(gas), 1e-7);
  const Trajectory explicitly = closing(gold_with(gas), 1e-7, Integrator::lawson);
  ASSERT_FALSE(implicit.touches.empty());
  ASSERT_FALSE(explicitly.touches.empty());
  EXPECT_NEAR(implicit.touches[0].begin, explicitly.touches[0].begin, figures * explicitly.touches[0].begin);
  EXPECT_NEAR(implicit.touches[0].impact_velocity, explicitly.touches[0].impact_velocity,
              figures * explicitly.touches[0].impact_velocity);
}

}  // namespace
}  // namespace softland
