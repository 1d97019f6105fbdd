#include "model/dormand_prince.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace softland::internal {
namespace {

constexpr double nodes[7] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
constexpr double tableau[7][6] = {{},
                                  {1.0 / 5},
                                  {3.0 / 40, 9.0 / 40},
                                  {44.0 / 45, -56.0 / 15, 32.0 / 9},
                                  {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                  {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                  {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
// Fifth minus fourth order.
constexpr double difference[7] = {71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

constexpr double integral = 0.04;
constexpr double proportional = 0.2 - 0.75 * integral;
constexpr double safety = 0.9;
constexpr double least_growth = 0.2, most_growth = 10;
constexpr double first_growth = 1e4;  // a first step is a guess
constexpr double least_error = 1e-4;  // what the controller remembers at the least
constexpr double not_finite = 0.1;    // shrinks a step whose error is not a number

}  // namespace

DormandPrince::DormandPrince(const OdeSystem& system) : system_(system), n_(system.size), y_(n_), trial_(n_), weights_(n_) {
  k_.fill(std::vector<double>(n_));
}

bool DormandPrince::restart(double t, const double* y, const std::vector<double>& absolute, double first_step, double max_step) {
  t_ = t;
  std::copy_n(y, n_, y_.begin());
  std::transform(absolute.begin(), absolute.end(), weights_.begin(), [](double a) { return 1 / a; });
  h_ = first_step;
  max_step_ = max_step;
  last_error_ = 1;
  first_ = true;
  system_.rhs(t_, y_.data(), k_[0].data());
  return true;
}

template <std::size_t Stage>
void DormandPrince::evaluate(double t, double h) {
  std::array<const double*, Stage> k;
  std::array<double, Stage> factor;
  for (std::size_t j = 0; j < Stage; ++j) {
    k[j] = k_[j].data();
    factor[j] = h * tableau[Stage][j];
  }
  const double* __restrict y = y_.data();
  double* __restrict z = trial_.data();
  for (std::size_t i = 0; i < n_; ++i) {
    double sum = y[i];
    for (std::size_t j = 0; j < Stage; ++j) sum += factor[j] * k[j][i];
    z[i] = sum;
  }
  system_.rhs(t, z, k_[Stage].data());
}

double DormandPrince::error(double h) const {
  double sum = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    double estimate = 0;
    for (std::size_t j = 0; j < stages; ++j) estimate += difference[j] * k_[j][i];
    estimate *= h * weights_[i];
    sum += estimate * estimate;
  }
  return std::sqrt(sum / static_cast<double>(n_));
}

bool DormandPrince::step(double t_stop) {
  double most = first_ ? first_growth : most_growth;
  while (true) {
    double h = std::min(h_, max_step_);
    const bool stops = t_ + h >= t_stop;
    if (stops) h = t_stop - t_;
    if (!(t_ + h > t_)) {
      message_ = fmt::format("no step is short enough for the tolerance at t = {:.9g} s", t_);
      return false;
    }
    const double end = stops ? t_stop : t_ + h;
    evaluate<1>(t_ + nodes[1] * h, h);
    evaluate<2>(t_ + nodes[2] * h, h);
    evaluate<3>(t_ + nodes[3] * h, h);
    evaluate<4>(t_ + nodes[4] * h, h);
    evaluate<5>(end, h);
    evaluate<6>(end, h);
    const double e = error(h);
    if (!std::isfinite(e)) {
      h_ = not_finite * h;
      most = 1;
      continue;
    }
    const double growth = safety * std::pow(std::max(e, 1e-300), -proportional) * std::pow(last_error_, integral);
    if (e <= 1) {
      t_ = end;
      y_.swap(trial_);
      k_[0].swap(k_[6]);
      last_error_ = std::max(e, least_error);
      // A step cut short by t_stop says little about the ones after it, which begin with a restart anyway.
      h_ = h * std::clamp(growth, least_growth, most);
      first_ = false;
      return true;
    }
    h_ = h * std::clamp(growth, least_growth, 0.9);
    most = 1;
  }
}

}  // namespace softland::internal
