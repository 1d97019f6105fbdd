#include "model/forces/gold_casimir.h"

#include <cmath>

#include "base/decompositions.h"

namespace softland {
namespace {

struct Tabulated {
  double gap;  // gap between the gold plates [nm]
  double eta;
};

// Table of the reduction factor eta against the gap: the integral of eta in gold_casimir.h by Gauss-Legendre quadrature, with
// all digits correct.
constexpr std::array<Tabulated, GoldFactor::knots> lifshitz{
    {{1, 0.00860746},     {1.259, 0.01082279}, {1.585, 0.01359945}, {1.995, 0.01707059}, {2.512, 0.02141064}, {3.162, 0.02680351},
     {3.981, 0.03349097}, {5.012, 0.04173243}, {6.31, 0.05182469},  {7.943, 0.06408202}, {10, 0.07886161},    {12.59, 0.09651393},
     {15.85, 0.11739672}, {19.95, 0.14186180}, {25.12, 0.17035401}, {31.62, 0.20316199}, {39.81, 0.24067807}, {50.12, 0.28305663},
     {63.1, 0.33022691},  {79.43, 0.38169056}, {100, 0.43657941},   {125.9, 0.49349863}, {158.5, 0.55076693}, {199.5, 0.60662247},
     {251.2, 0.65965333}, {316.2, 0.70850216}, {398.1, 0.75251538}, {501.2, 0.79130475}, {631, 0.82489293},   {794.3, 0.85354032},
     {1000, 0.87772074},  {1259, 0.89793589},  {1585, 0.91471774},  {1995, 0.92857685},  {2512, 0.94001828},  {3162, 0.94942426},
     {3981, 0.95717680},  {5012, 0.96357000},  {6310, 0.96885756},  {7943, 0.97324488},  {10000, 0.97690674}}};

// Slopes h eta'(h) of the reduction factor eta at both ends of the table, by central differences of the integral that defines
// eta.
constexpr double first_rise = 0.00856791, last_rise = 0.01452834;

/// Returns the antiderivative of the Casimir pressure casimir_strength eta / h^4 at gap h, within a piece of the table of eta
/// [J/m^2]; the constant of integration is arbitrary.
double antiderivative(const GoldFactor::Piece& piece, double h) {
  const auto& [begin, e, energy] = piece;
  const double x = h / begin;
  return casimir_strength / (begin * begin * begin) *
         (-e[0] / (3 * x * x * x) - e[1] / (2 * x * x) - e[2] / x + e[3] * std::log(x));
}

}  // namespace

const GoldFactor& GoldFactor::table() {
  static const GoldFactor factor;
  return factor;
}

GoldFactor::GoldFactor() {
  constexpr Eigen::Index n = knots;
  // Cubic spline of eta: solve for the slopes at the gaps of the table [1/nm] that make the second derivative continuous. The
  // slopes at both ends are given.
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right(n);
  equations(0, 0) = equations(n - 1, n - 1) = 1;
  right[0] = first_rise / lifshitz.front().gap;
  right[n - 1] = last_rise / lifshitz.back().gap;
  const auto width = [](std::size_t k) { return lifshitz[k + 1].gap - lifshitz[k].gap; };
  const auto rise = [&](std::size_t k) { return (lifshitz[k + 1].eta - lifshitz[k].eta) / width(k); };
  for (std::size_t k = 1; k + 1 < knots; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double before = width(k - 1), after = width(k);
    equations(i, i - 1) = 1 / before;
    equations(i, i) = 2 / before + 2 / after;
    equations(i, i + 1) = 1 / after;
    right[i] = 3 * (rise(k - 1) / before + rise(k) / after);
  }
  const Eigen::VectorXd slopes = solve_linear(equations, right);

  const double at_first = lifshitz.front().eta, missing = 1 - lifshitz.back().eta;
  near = {2 * at_first - first_rise, first_rise - at_first};
  far = {2 * (missing - last_rise), 2 * last_rise - missing};

  pieces_[knots - 1].begin = lifshitz.back().gap * 1e-9;
  for (std::size_t k = 0; k + 1 < knots; ++k) {
    // Convert each Hermite cubic of eta from t = (x - 1) / r to powers of x, with x = h / begin and r the relative length of
    // the piece.
    const double begin = lifshitz[k].gap, r = width(k) / begin, d = lifshitz[k + 1].eta - lifshitz[k].eta;
    const double m0 = slopes[static_cast<Eigen::Index>(k)] * begin, m1 = slopes[static_cast<Eigen::Index>(k) + 1] * begin;
    const double c0 = lifshitz[k].eta, c1 = m0, c2 = (3 * d / r - 2 * m0 - m1) / r, c3 = (m0 + m1 - 2 * d / r) / (r * r);
    pieces_[k] = {.begin = begin * 1e-9, .powers = {c0 - c1 + c2 - c3, c1 - 2 * c2 + 3 * c3, c2 - 3 * c3, c3}};
  }
  // Integrate the pressure from large to small gaps for the energy, starting with the closed formula beyond the table.
  Piece& end = pieces_[knots - 1];
  end.energy = -casimir_strength / (end.begin * end.begin * end.begin) * (1.0 / 3 - far[0] / 3.5 - far[1] / 4);
  for (std::size_t k = knots - 1; k-- > 0;) {
    Piece& piece = pieces_[k];
    const double next = pieces_[k + 1].begin;
    piece.energy = pieces_[k + 1].energy - antiderivative(piece, next) + antiderivative(piece, piece.begin);
  }
}

double GoldCasimir::energy(double h) const {
  const GoldFactor::Piece& piece = table->piece(h);
  const double x = h / piece.begin;
  if (h < table->first()) {
    const auto& n = table->near;
    return piece.energy -
           casimir_strength / (piece.begin * piece.begin * piece.begin) * (n[0] / 2 * (1 / (x * x) - 1) + n[1] * (1 / x - 1));
  }
  if (!(h < table->last())) {
    return -casimir_strength / (h * h * h) * (1.0 / 3 - table->far[0] / (3.5 * std::sqrt(x)) - table->far[1] / (4 * x));
  }
  return piece.energy + antiderivative(piece, h) - antiderivative(piece, piece.begin);
}

}  // namespace softland
