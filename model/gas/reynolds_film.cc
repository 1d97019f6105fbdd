#include "model/gas/reynolds_film.h"

#include <cmath>

#include "base/decompositions.h"
#include "model/gas/air.h"

namespace softland {
namespace {

constexpr int degree = 2 * internal::StripNodes::count;  // degree of the pressure polynomial across the width

double legendre(double x) {
  double before = 1, last = x;
  for (int k = 2; k <= degree; ++k) {
    const double next = ((2 * k - 1) * x * last - (k - 1) * before) / k;
    before = last;
    last = next;
  }
  return last;
}

// Returns the Gauss-Lobatto points on [-1, 1] in rising order: both ends, and the zeros of the derivative of the Legendre
// polynomial of this degree, computed as the eigenvalues of a Jacobi matrix.
Eigen::VectorXd lobatto_points() {
  constexpr int inner = degree - 1;
  Eigen::VectorXd off(inner - 1);
  for (int k = 1; k < inner; ++k) off[k - 1] = std::sqrt(k * (k + 2.0) / ((2 * k + 1.0) * (2 * k + 3.0)));
  Eigen::VectorXd points(degree + 1);
  points << -1, tridiagonal_eigen(Eigen::VectorXd::Zero(inner), off).values, 1;
  return points;
}

// Returns the free energy per volume of an isothermal gas at the pressure pa (1 + p), divided by the ambient pressure pa.
double free_energy(double p) { return (1 + p) * std::log1p(p) - p; }

}  // namespace

namespace internal {

StripNodes strip_nodes() {
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
    slope(i, i) = -slope.row(i).sum();  // each row has the sum 0, as the derivative of a constant is 0
  }
  constexpr int count = StripNodes::count;
  Eigen::MatrixXd unfold = Eigen::MatrixXd::Zero(degree + 1, count);
  for (int i = 0; i < count; ++i) unfold(count + i, i) = unfold(count - i, i) = 1;
  StripNodes nodes;
  nodes.weights = unfold.transpose() * weights;
  const Eigen::MatrixXd inward = slope * unfold;
  nodes.exchange = -(nodes.weights.cwiseInverse().asDiagonal() * (inward.transpose() * weights.asDiagonal() * inward));
  return nodes;
}

}  // namespace internal

ReynoldsFilm::ReynoldsFilm(const FilmState& gas, double width, Eigen::Index stations, double floor)
    : stations_(stations), floor_(floor), station_(gas.pressure, viscosity(gas), mean_free_path(gas), width) {}

void ReynoldsFilm::add_load(const double* film, double* load) const {
  for (Eigen::Index s = 0; s < stations_; ++s, film += nodes) {
    station_.add_load(film, load[s]);
  }
}

void ReynoldsFilm::rates(const GapField& field, const double* film, double* result) const {
  for (Eigen::Index s = 0; s < stations_; ++s, film += nodes, result += nodes) {
    station_.rates(above_floor(field.gap[s]), field.velocity[s], film, result);
  }
}

ReynoldsFilm::Derivatives ReynoldsFilm::derivatives(double gap, double velocity, const double* film) const {
  Derivatives d;
  std::array<Dual, nodes> at, rate;
  for (std::size_t i = 0; i < nodes; ++i) at[i] = Dual(film[i]);
  const auto slopes = [&](double by_gap, double by_velocity) {
    station_.rates(Dual(above_floor(gap), by_gap), Dual(velocity, by_velocity), at.data(), rate.data());
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
    for (int i = 0; i < nodes; ++i) across += station_.weights()[i] * free_energy(film[i]);
    sum += weights[s] * above_floor(field.gap[s]) * across;
  }
  return station_.ambient() * station_.half_width() * sum;
}

double ReynoldsFilm::dissipated_power(const GapField& field, const Eigen::ArrayXd& weights, const double* film) const {
  double sum = 0;
  std::array<double, nodes> in;
  for (Eigen::Index s = 0; s < stations_; ++s, film += nodes) {
    station_.flow(film, in.data());
    double across = 0;
    for (int i = 0; i < nodes; ++i) across -= station_.weights()[i] * std::log1p(film[i]) * in[static_cast<std::size_t>(i)];
    const double gap = above_floor(field.gap[s]);
    sum += weights[s] * gap * station_.diffusion(gap) * across;
  }
  return station_.ambient() * station_.half_width() * sum;
}

}  // namespace softland
