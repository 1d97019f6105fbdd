#include "model/gas/reynolds_film.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "model/gas/air.h"

namespace softland {
namespace {

constexpr int degree = 2 * ReynoldsFilm::nodes;  // of the polynomials across the whole width

double legendre(double x) {
  double before = 1, last = x;
  for (int k = 2; k <= degree; ++k) {
    const double next = ((2 * k - 1) * x * last - (k - 1) * before) / k;
    before = last;
    last = next;
  }
  return last;
}

// Gauss-Lobatto points on [-1, 1] in rising order: the ends and the zeros of P'_degree, eigenvalues of a Jacobi matrix.
Eigen::VectorXd lobatto_points() {
  constexpr int inner = degree - 1;
  Eigen::VectorXd off(inner - 1);
  for (int k = 1; k < inner; ++k) off[k - 1] = std::sqrt(k * (k + 2.0) / ((2 * k + 1.0) * (2 * k + 3.0)));
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::VectorXd::Zero(inner), off);
  Eigen::VectorXd points(degree + 1);
  points << -1, solver.eigenvalues(), 1;
  return points;
}

// Of an isothermal gas at p = pa (1 + P), over pa.
double free_energy(double p) { return (1 + p) * std::log1p(p) - p; }

}  // namespace

ReynoldsFilm::ReynoldsFilm(const Gas& gas, double width, Eigen::Index stations, double floor)
    : stations_(stations),
      floor_(floor),
      ambient_(gas.pressure),
      half_width_(width / 2),
      diffusion_(gas.pressure / (12 * viscosity(gas) * half_width_ * half_width_)),
      slip_(6 * mean_free_path(gas)) {
  const Eigen::VectorXd x = lobatto_points();
  Eigen::VectorXd at(degree + 1), weights(degree + 1);
  for (int i = 0; i <= degree; ++i) {
    at[i] = legendre(x[i]);
    weights[i] = 2 / (degree * (degree + 1) * at[i] * at[i]);
  }
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(degree + 1, degree + 1);
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; j <= degree; ++j) {
      if (i != j) slope(i, j) = at[i] / (at[j] * (x[i] - x[j]));
    }
    slope(i, i) = -slope.row(i).sum();  // a constant has no slope
  }
  // Nodes from the middle (0) to the last one inside the edge, each standing for its mirror image as well.
  Eigen::MatrixXd unfold = Eigen::MatrixXd::Zero(degree + 1, nodes);
  for (int i = 0; i < nodes; ++i) unfold(nodes + i, i) = unfold(nodes - i, i) = 1;
  weights_ = unfold.transpose() * weights;
  const Eigen::MatrixXd inward = slope * unfold;
  exchange_ = -(weights_.cwiseInverse().asDiagonal() * (inward.transpose() * weights.asDiagonal() * inward));
  load_by_film_ = -ambient_ * half_width_ * weights_;
}

void ReynoldsFilm::add_load(const double* film, double* load) const {
  for (Eigen::Index s = 0; s < stations_; ++s, film += nodes) {
    for (int i = 0; i < nodes; ++i) load[s] += load_by_film_[i] * film[i];
  }
}

void ReynoldsFilm::rates(const GapField& field, const double* film, double* result) const {
  for (Eigen::Index s = 0; s < stations_; ++s, film += nodes, result += nodes) {
    station(above_floor(field.gap[s]), field.velocity[s], film, result);
  }
}

ReynoldsFilm::Derivatives ReynoldsFilm::derivatives(double gap, double velocity, const double* film) const {
  Derivatives d;
  std::array<Dual, nodes> at, rate;
  for (std::size_t i = 0; i < nodes; ++i) at[i] = Dual(film[i]);
  const auto slopes = [&](double by_gap, double by_velocity) {
    station(Dual(above_floor(gap), by_gap), Dual(velocity, by_velocity), at.data(), rate.data());
    Eigen::Matrix<double, nodes, 1> column;
    for (std::size_t i = 0; i < nodes; ++i) column[static_cast<int>(i)] = rate[i].slope;
    return column;
  };
  d.by_gap = slopes(gap > floor_ ? 1 : 0, 0);
  d.by_velocity = slopes(0, 1);
  for (std::size_t j = 0; j < nodes; ++j) {
    at[j].slope = 1;
    d.by_film.col(static_cast<int>(j)) = slopes(0, 0);
    at[j].slope = 0;
  }
  return d;
}

double ReynoldsFilm::energy(const GapField& field, const Eigen::ArrayXd& weights, const double* film) const {
  double sum = 0;
  for (Eigen::Index s = 0; s < stations_; ++s, film += nodes) {
    double across = 0;
    for (int i = 0; i < nodes; ++i) across += weights_[i] * free_energy(film[i]);
    sum += weights[s] * above_floor(field.gap[s]) * across;
  }
  return ambient_ * half_width_ * sum;
}

double ReynoldsFilm::dissipated_power(const GapField& field, const Eigen::ArrayXd& weights, const double* film) const {
  double sum = 0;
  std::array<double, nodes> in;
  for (Eigen::Index s = 0; s < stations_; ++s, film += nodes) {
    flow(film, in.data());
    double across = 0;
    for (int i = 0; i < nodes; ++i) across -= weights_[i] * std::log1p(film[i]) * in[static_cast<std::size_t>(i)];
    const double gap = above_floor(field.gap[s]);
    sum += weights[s] * gap * diffusion(gap) * across;
  }
  return ambient_ * half_width_ * sum;
}

}  // namespace softland
