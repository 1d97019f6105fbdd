#include "sampling/polynomial_chaos.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "base/require.h"
#include "base/standard_normal.h"
#include "sampling/points.h"

namespace softland {
namespace {

using Exponents = std::vector<int>;

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr int highest_degree = 50;  // in any sample, higher powers of a normal variable are larger than all other terms
constexpr double candidates_per_figure = 10;

// Returns the values of the orthonormal polynomials of degree 0, ..., degree for a coordinate u of the unit cube: Legendre
// polynomials for a uniform germ, Hermite polynomials for a normal one.
std::vector<double> polynomials(Germ germ, int degree, double u) {
  std::vector<double> values(static_cast<std::size_t>(degree) + 1, 1);
  const double xi = germ == Germ::uniform ? 2 * u - 1 : standard_normal_quantile(u);
  double before = 0, current = 1;  // recurrences give Legendre P_k and Hermite He_k / sqrt(k!)
  for (int k = 1; k <= degree; ++k) {
    const double next = germ == Germ::uniform ? ((2 * k - 1) * xi * current - (k - 1) * before) / k
                                              : (xi * current - std::sqrt(k - 1.0) * before) / std::sqrt(static_cast<double>(k));
    before = current;
    current = next;
    values[static_cast<std::size_t>(k)] = germ == Germ::uniform ? std::sqrt(2.0 * k + 1) * next : next;
  }
  return values;
}

// Appends to `terms` all polynomial terms with the exponents term[0], ..., term[from - 1] of the first variables, and with
// exponents of sum `degree` for the other variables.
void add_terms(std::vector<Exponents>& terms, Exponents& term, std::size_t from, int degree) {
  if (from + 1 == term.size()) {
    term[from] = degree;
    terms.push_back(term);
    return;
  }
  for (int exponent = degree; exponent >= 0; --exponent) {
    term[from] = exponent;
    add_terms(terms, term, from + 1, degree - exponent);
  }
}

struct Value {
  double operator()(const Exponents& term) const {
    double product = 1;
    for (std::size_t i = 0; i < term.size(); ++i) product *= of_variable[i][static_cast<std::size_t>(term[i])];
    return product;
  }
  std::vector<std::vector<double>> of_variable;
};

// The polynomial terms that orthogonal matching pursuit chooses, in the order of choice, as indices of the columns of all
// terms.
struct Pursuit {
  std::vector<Eigen::Index> columns;
  std::vector<double> errors;    // sum of the squared errors at the held-back rows with 1, 2, ... terms
  Eigen::VectorXd coefficients;  // coefficients with all chosen terms
};

// Chooses at most `most` polynomial terms to fit the figures `y` by matching pursuit, the constant first. Row j of `columns`
// holds the values of all terms at the point of figure j. The rows of `held`, of the same form, and their figures `held_y` are
// not fitted: they measure the errors of prediction.
Pursuit pursue(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y, Eigen::Index most, const Eigen::MatrixXd& held,
               const Eigen::VectorXd& held_y) {
  const Eigen::RowVectorXd sizes = columns.colwise().norm();
  // QR factorisation of the chosen columns Psi = Q R: q is Q, q_held its continuation Psi_held R^-1 to the held-back rows, and
  // inverse is R^-1.
  Eigen::MatrixXd q(columns.rows(), most), q_held(held.rows(), most), inverse = Eigen::MatrixXd::Zero(most, most);
  Eigen::VectorXd residual = y, held_residual = held_y, projections(most);
  std::vector<bool> used(static_cast<std::size_t>(columns.cols()), false);
  Pursuit made;
  Eigen::Index k = 0;
  while (k < most) {
    const Eigen::RowVectorXd products = (residual.transpose() * columns).cwiseAbs().cwiseQuotient(sizes);
    Eigen::Index next = k == 0 ? 0 : -1;
    for (Eigen::Index j = 0; k > 0 && j < products.size(); ++j) {
      if (!used[static_cast<std::size_t>(j)] && (next < 0 || products[j] > products[next])) next = j;
    }
    if (next < 0) break;
    used[static_cast<std::size_t>(next)] = true;
    // Gram-Schmidt runs twice: after one pass, rounding errors of the removed part are not orthogonal to Q.
    Eigen::VectorXd direction = columns.col(next), shares = Eigen::VectorXd::Zero(k);
    for (int time = 0; time < 2; ++time) {
      const Eigen::VectorXd share = q.leftCols(k).transpose() * direction;
      direction -= q.leftCols(k) * share;
      shares += share;
    }
    const double size = direction.norm();
    constexpr double dependent = 1e-8;
    if (!(size > dependent * sizes[next])) continue;
    q.col(k) = direction / size;
    q_held.col(k) = (held.col(next) - q_held.leftCols(k) * shares) / size;
    inverse.col(k).head(k) = -inverse.topLeftCorner(k, k) * shares / size;
    inverse(k, k) = 1 / size;
    projections[k] = q.col(k).dot(residual);
    residual -= projections[k] * q.col(k);
    held_residual -= projections[k] * q_held.col(k);
    made.columns.push_back(next);
    made.errors.push_back(held_residual.squaredNorm());
    ++k;
    constexpr double rounding = 1e-14;
    if (residual.norm() <= rounding * y.norm()) break;
  }
  made.coefficients = inverse.topLeftCorner(k, k) * projections.head(k);
  return made;
}

// Returns the number of the cross-validation fold of each figure. The folds are drawn at random, because points next to each
// other in a set may not be independent.
std::vector<std::size_t> folds_of(std::size_t figures) {
  constexpr std::size_t most_folds = 10;
  const SamplePoints order(PointSet::latin_hypercube, 1, 0, Stream::folds, figures);
  const std::size_t folds = std::min(most_folds, figures);
  std::vector<std::size_t> fold(figures);
  for (std::size_t j = 0; j < figures; ++j) {
    double place = 0;
    order.point(j, {&place, 1});
    fold[j] = static_cast<std::size_t>(place * static_cast<double>(folds));
  }
  return fold;
}

// Returns the errors of predicting each cross-validation fold from the other folds. Element k is the sum of the squared errors
// with k + 1 terms.
std::vector<double> prediction_errors(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y,
                                      const std::vector<std::size_t>& fold, Eigen::Index most) {
  std::vector<double> errors(static_cast<std::size_t>(most), 0);
  const std::size_t folds = *std::max_element(fold.begin(), fold.end()) + 1;
  for (std::size_t f = 0; f < folds; ++f) {
    std::vector<Eigen::Index> kept, held;
    for (std::size_t j = 0; j < fold.size(); ++j) (fold[j] == f ? held : kept).push_back(static_cast<Eigen::Index>(j));
    const Pursuit made = pursue(columns(kept, Eigen::all), y(kept), most, columns(held, Eigen::all), y(held));
    // If matching pursuit stopped with fewer terms, use its last error for all larger numbers of terms.
    for (std::size_t k = 0; k < errors.size(); ++k) errors[k] += made.errors[std::min(k, made.errors.size() - 1)];
  }
  return errors;
}

void check(const std::vector<Germ>& germs_of_variables, const Eigen::MatrixXd& points, std::span<const double> figures,
           int most_degree) {
  require_of("points", !germs_of_variables.empty() && points.cols() == static_cast<Eigen::Index>(germs_of_variables.size()),
             "points have " + std::to_string(points.cols()) + " coordinates; there must be one for each of the " +
                 std::to_string(germs_of_variables.size()) + " germs, of which there must be at least one");
  require_of("points", (points.array() > 0 && points.array() < 1).all(), "all coordinates of points must be above 0 and below 1");
  require_of("figures", figures.size() >= 4 && points.rows() == static_cast<Eigen::Index>(figures.size()),
             "there are " + std::to_string(figures.size()) + " figures of " + std::to_string(points.rows()) +
                 " points; there must be one figure per point, and at least 4");
  require_of("figures", std::all_of(figures.begin(), figures.end(), [](double y) { return std::isfinite(y); }),
             "all figures must be finite");
  require_of("most_degree", 1 <= most_degree && most_degree <= highest_degree,
             "most_degree = " + std::to_string(most_degree) + " must be between 1 and " + std::to_string(highest_degree));
}

}  // namespace

PolynomialChaos::PolynomialChaos(const std::vector<Germ>& germs_of_variables, const Eigen::MatrixXd& points,
                                 std::span<const double> figures, int most_degree)
    : germs_(germs_of_variables) {
  check(germs_of_variables, points, figures, most_degree);
  const std::size_t n = figures.size(), d = dimensions();
  // All terms from which pursue() may choose, sorted by degree: the first last[p] have degree p or less.
  std::vector<Exponents> candidates;
  std::vector<std::size_t> last;
  double count = 1;  // number of polynomial terms of degree at most p in d variables: the binomial coefficient of d + p and p
  for (int p = 0; p <= most_degree; ++p) {
    if (p > 0) count *= static_cast<double>(d + static_cast<std::size_t>(p)) / p;
    if (p > 1 && count > candidates_per_figure * static_cast<double>(n)) break;
    Exponents term(d, 0);
    add_terms(candidates, term, 0, p);
    last.push_back(candidates.size());
  }
  Eigen::MatrixXd columns(points.rows(), static_cast<Eigen::Index>(candidates.size()));
  for (Eigen::Index j = 0; j < points.rows(); ++j) {
    Value value;
    for (std::size_t i = 0; i < d; ++i) {
      value.of_variable.push_back(
          polynomials(germs_[i], static_cast<int>(last.size()) - 1, points(j, static_cast<Eigen::Index>(i))));
    }
    for (std::size_t k = 0; k < candidates.size(); ++k) columns(j, static_cast<Eigen::Index>(k)) = value(candidates[k]);
  }

  const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(figures.data(), points.rows());
  const std::vector<std::size_t> fold = folds_of(n);
  double least = std::numeric_limits<double>::infinity();
  std::size_t best_candidates = 1, best_terms = 1;
  for (const std::size_t count_of_degree : last) {
    const auto most = static_cast<Eigen::Index>(std::min(count_of_degree, n / 2));
    const std::vector<double> errors =
        prediction_errors(columns.leftCols(static_cast<Eigen::Index>(count_of_degree)), y, fold, most);
    const auto best = std::min_element(errors.begin(), errors.end());
    if (!(*best < least)) continue;
    least = *best;
    best_candidates = count_of_degree;
    best_terms = static_cast<std::size_t>(best - errors.begin()) + 1;
  }
  const Pursuit made =
      pursue(columns.leftCols(static_cast<Eigen::Index>(best_candidates)), y, static_cast<Eigen::Index>(best_terms),
             Eigen::MatrixXd(0, static_cast<Eigen::Index>(best_candidates)), Eigen::VectorXd(0));
  for (std::size_t k = 0; k < made.columns.size(); ++k) {
    terms_.push_back(candidates[static_cast<std::size_t>(made.columns[k])]);
    coefficients_.push_back(made.coefficients[static_cast<Eigen::Index>(k)]);
    degree_ = std::max(degree_, std::accumulate(terms_.back().begin(), terms_.back().end(), 0));
  }
  const bool constant = std::equal(figures.begin() + 1, figures.end(), figures.begin());
  q2_ = constant ? not_known : 1 - least / (y.array() - y.mean()).square().sum();
}

double PolynomialChaos::operator()(std::span<const double> u) const {
  require(u.size() == dimensions(), "a point must have one coordinate per variable of the expansion");
  require(std::all_of(u.begin(), u.end(), [](double x) { return x > 0 && x < 1; }),
          "every coordinate of a point must be above 0 and below 1");
  Value value;
  for (std::size_t i = 0; i < u.size(); ++i) value.of_variable.push_back(polynomials(germs_[i], degree_, u[i]));
  double sum = 0;
  for (std::size_t k = 0; k < terms_.size(); ++k) sum += coefficients_[k] * value(terms_[k]);
  return sum;
}

double PolynomialChaos::variance() const {
  return std::inner_product(coefficients_.begin() + 1, coefficients_.end(), coefficients_.begin() + 1, 0.0);
}

double PolynomialChaos::first_order(std::size_t i) const {
  require(i < dimensions(), "the number of a variable must be below the number of dimensions");
  double sum = 0;
  for (std::size_t k = 1; k < terms_.size(); ++k) {
    const int whole = std::accumulate(terms_[k].begin(), terms_[k].end(), 0);
    if (terms_[k][i] == whole) sum += coefficients_[k] * coefficients_[k];
  }
  return sum / variance();  // NaN if the variance of the figure is 0
}

double PolynomialChaos::total(std::size_t i) const {
  require(i < dimensions(), "the number of a variable must be below the number of dimensions");
  double sum = 0;
  for (std::size_t k = 1; k < terms_.size(); ++k) {
    if (terms_[k][i] > 0) sum += coefficients_[k] * coefficients_[k];
  }
  return sum / variance();  // NaN if the variance of the figure is 0
}

}  // namespace softland
