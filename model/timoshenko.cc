#include "model/timoshenko.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/decompositions.h"
#include "base/gauss.h"
#include "model/constants.h"

namespace softland {
namespace {

constexpr double shear_coefficient = 5.0 / 6;  // shear coefficient kappa of a rectangular section
constexpr double usual_poissons_ratio = 0.3;
// Largest length / thickness of a beam for which the difference of the frequencies is computed. The difference falls with the
// square of this ratio, and at larger ratios rounding errors spoil it.
constexpr double most_slender = 1000;

// Returns Euler-Bernoulli's wave number of a mode, counted from 1: the root beta of cos(beta) cosh(beta) = 1 between two
// clamps, = -1 with a free end.
double wave_number(int mode, bool both_clamped) {
  const double sign = both_clamped ? -1 : 1;
  double beta = (mode + (both_clamped ? 0.5 : -0.5)) * pi;
  for (int i = 0; i < 20; ++i) {
    const double slope = -std::sin(beta) - sign * std::sinh(beta) / (std::cosh(beta) * std::cosh(beta));
    beta -= (std::cos(beta) + sign / std::cosh(beta)) / slope;
  }
  return beta;
}

// Values and derivatives on [0, 1] of Legendre polynomials times a factor that vanishes at the clamps, a column for each
// polynomial.
struct Basis {
  Eigen::MatrixXd values, slopes;
};

Basis basis(const std::vector<double>& points, int functions, bool both_clamped) {
  const auto rows = static_cast<Eigen::Index>(points.size());
  Basis b{.values = Eigen::MatrixXd(rows, functions), .slopes = Eigen::MatrixXd(rows, functions)};
  for (Eigen::Index p = 0; p < rows; ++p) {
    // Gauss point z in [-1, 1], and the same point mapped to [0, 1], x.
    const double z = points[static_cast<std::size_t>(p)], x = (1 + z) / 2;
    const double held = both_clamped ? x * (1 - x) : x, held_slope = both_clamped ? 1 - 2 * x : 1;
    // Legendre polynomials of degree k - 1 and k at z, and their derivatives by z.
    double last = 0, now = 1, last_slope = 0, slope = 0;
    for (int k = 0; k < functions; ++k) {
      b.values(p, k) = held * now;
      b.slopes(p, k) = held_slope * now + held * 2 * slope;
      const double next = ((2 * k + 1) * z * now - k * last) / (k + 1), next_slope = last_slope + (2 * k + 1) * now;
      last = now, now = next, last_slope = slope, slope = next_slope;
    }
  }
  return b;
}

}  // namespace

std::vector<double> frequency_excess(const Structure& s) {
  const auto* const beam = s.find<Beam>();
  if (beam == nullptr || beam->is_built() || beam->anchor || beam->far_anchor) return {};
  const bool both_clamped = s.has_far_clamp();
  const double nu = std::isnan(beam->poissons_ratio) ? usual_poissons_ratio : beam->poissons_ratio;
  const double beyond = std::min(1.0, most_slender * s.thickness / s.length);
  // Second moment of area over area and squared length, I / (A L^2).
  const double gyration = std::pow(s.thickness / s.length / beyond, 2) / 12;
  const double stiffer = beam->plate_strain ? 1 / (1 - nu * nu) : 1;
  // Bending over shear stiffness, E I / (kappa A G L^2).
  const double shear = gyration * stiffer * 2 * (1 + nu) / shear_coefficient;

  const int functions = 2 * s.modes + 12;
  const GaussRule rule = gauss_rule(functions + 2);
  const Basis b = basis(rule.points, functions, both_clamped);
  const Eigen::VectorXd weights = Eigen::Map<const Eigen::VectorXd>(rule.weights.data(), b.values.rows()) / 2;
  const auto integral = [&](const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) -> Eigen::MatrixXd {
    return left.transpose() * weights.asDiagonal() * right;
  };
  const Eigen::Index n = functions;
  // Matrices for deflection / L and rotation: stiffness in units of E I / L, mass in units of rho A L^3.
  Eigen::MatrixXd stiffness(2 * n, 2 * n), mass = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  stiffness.topLeftCorner(n, n) = integral(b.slopes, b.slopes) / shear;
  stiffness.topRightCorner(n, n) = -integral(b.slopes, b.values) / shear;
  stiffness.bottomLeftCorner(n, n) = stiffness.topRightCorner(n, n).transpose();
  stiffness.bottomRightCorner(n, n) = integral(b.slopes, b.slopes) + integral(b.values, b.values) / shear;
  mass.topLeftCorner(n, n) = integral(b.values, b.values);
  mass.bottomRightCorner(n, n) = gyration * mass.topLeftCorner(n, n);
  const Eigen::VectorXd squares = generalized_eigenvalues(stiffness, mass);
  std::vector<double> excess;
  for (int mode = 1; mode <= s.modes; ++mode) {
    const double here = std::pow(wave_number(mode, both_clamped), 2) / std::sqrt(squares[mode - 1]) - 1;
    excess.push_back(here * beyond * beyond);
  }
  return excess;
}

std::string slenderness_warning(const Structure& s) {
  constexpr double worth_saying = 0.02;
  std::vector<std::string> words;
  const std::vector<double> excess = frequency_excess(s);
  if (std::none_of(excess.begin(), excess.end(), [](double e) { return e >= worth_saying; })) return {};
  for (std::size_t i = 0; i < excess.size(); ++i) {
    if (excess[i] < worth_saying) continue;
    words.push_back(fmt::format("{:.{}f} % (mode {})", 100 * excess[i], excess[i] < 0.1 ? 1 : 0, i + 1));
  }
  return fmt::format(
      "structure: length / thickness = {:.3g}: shear and rotary inertia are left out, which makes the natural frequencies too "
      "high by about {}, as Timoshenko's beam has it",
      s.length / s.thickness, fmt::join(words, ", "));
}

}  // namespace softland
