#include "sampling/distribution.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/engineering.h"
#include "base/gauss.h"
#include "base/require.h"
#include "base/standard_normal.h"

namespace softland {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string text(double value) { return engineering(value, ""); }

void require_finite(std::string_view parameter, double value) {
  require_of(parameter, std::isfinite(value), std::string(parameter) + " = " + text(value) + " must be finite");
}

void require_positive(std::string_view parameter, double value) {
  require_of(parameter, std::isfinite(value) && value > 0,
             std::string(parameter) + " = " + text(value) + " must be finite and above 0");
}

// Returns the standard normal density without its factor 1 / sqrt(2 pi), which cancels in moments().
double standard_normal_density(double z) { return std::exp(-z * z / 2); }

// Returns the distribution of the logarithm of a lognormal variable.
Normal logarithm_of(const Lognormal& d) {
  const double ratio = d.standard_deviation / d.mean, variance = std::log1p(ratio * ratio);
  return {.mean = std::log(d.mean) - variance / 2, .standard_deviation = std::sqrt(variance)};
}

// Functions for each kind of distribution: check() tests the parameters, support_of() and quantile_of() return support and
// quantile, up_to() the probability of a value of at most x, below() that of a value below x.

void check(const Normal& d) {
  require_finite("mean", d.mean);
  require_positive("standard_deviation", d.standard_deviation);
}
Interval support_of(const Normal& /*unused*/) { return {.low = -infinity, .high = infinity}; }
double quantile_of(const Normal& d, double p) { return d.mean + d.standard_deviation * standard_normal_quantile(p); }
double up_to(const Normal& d, double x) { return standard_normal_cdf((x - d.mean) / d.standard_deviation); }

void check(const Lognormal& d) {
  require_positive("mean", d.mean);
  require_positive("standard_deviation", d.standard_deviation);
}
Interval support_of(const Lognormal& /*unused*/) { return {.low = 0, .high = infinity}; }
double quantile_of(const Lognormal& d, double p) { return std::exp(quantile_of(logarithm_of(d), p)); }
double up_to(const Lognormal& d, double x) { return x > 0 ? up_to(logarithm_of(d), std::log(x)) : 0; }

void check(const Uniform& d) {
  require_finite("low", d.low);
  require_finite("high", d.high);
  require_of("high", d.high > d.low, "high = " + text(d.high) + " must be above low = " + text(d.low));
}
Interval support_of(const Uniform& d) { return {.low = d.low, .high = d.high}; }
double quantile_of(const Uniform& d, double p) { return d.low + p * (d.high - d.low); }
double up_to(const Uniform& d, double x) { return std::clamp((x - d.low) / (d.high - d.low), 0.0, 1.0); }

void check(const Triangular& d) {
  require_finite("low", d.low);
  require_finite("high", d.high);
  require_of("high", d.high > d.low, "high = " + text(d.high) + " must be above low = " + text(d.low));
  require_of("mode", d.low <= d.mode && d.mode <= d.high,
             "mode = " + text(d.mode) + " must be between low = " + text(d.low) + " and high = " + text(d.high));
}
Interval support_of(const Triangular& d) { return {.low = d.low, .high = d.high}; }
double quantile_of(const Triangular& d, double p) {
  const double width = d.high - d.low;
  return p * width < d.mode - d.low ? d.low + std::sqrt(p * width * (d.mode - d.low))
                                    : d.high - std::sqrt((1 - p) * width * (d.high - d.mode));
}
double up_to(const Triangular& d, double x) {
  const double width = d.high - d.low;
  if (x <= d.low) return 0;
  if (x >= d.high) return 1;
  return x < d.mode ? (x - d.low) * (x - d.low) / (width * (d.mode - d.low))
                    : 1 - (d.high - x) * (d.high - x) / (width * (d.high - d.mode));
}

void check(const Empirical& d) {
  require_of("values", d.values.size() >= 2,
             "an empirical distribution has " + std::to_string(d.values.size()) + " values; it must have at least 2");
  for (std::size_t i = 0; i < d.values.size(); ++i) {
    require_of("values", std::isfinite(d.values[i]),
               "value " + std::to_string(i + 1) + " of an empirical distribution must be finite");
  }
}
Interval support_of(const Empirical& d) { return {.low = d.values.front(), .high = d.values.back()}; }
double quantile_of(const Empirical& d, double p) {
  const double place = p * static_cast<double>(d.values.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), d.values.size() - 2);
  return d.values[i] + (place - static_cast<double>(i)) * (d.values[i + 1] - d.values[i]);
}
// Returns the distribution function of a sample at an x between its sorted values i and i + 1, which differ.
double between(const Empirical& d, std::size_t i, double x) {
  const double fraction = (x - d.values[i]) / (d.values[i + 1] - d.values[i]);
  return (static_cast<double>(i) + fraction) / static_cast<double>(d.values.size() - 1);
}
double up_to(const Empirical& d, double x) {
  const auto above = std::upper_bound(d.values.begin(), d.values.end(), x);
  if (above == d.values.begin()) return 0;
  if (above == d.values.end()) return 1;
  return between(d, static_cast<std::size_t>(above - d.values.begin()) - 1, x);
}
double below(const Empirical& d, double x) {
  const auto from = std::lower_bound(d.values.begin(), d.values.end(), x);
  if (from == d.values.begin()) return 0;
  if (from == d.values.end()) return 1;
  return between(d, static_cast<std::size_t>(from - d.values.begin()) - 1, x);
}
template <class Continuous>
double below(const Continuous& d, double x) {
  return up_to(d, x);
}

struct Moments {
  double mean, standard_deviation;
};

// Returns mean and standard deviation of value(t) for a random t in the range of `breaks`, an ascending list. The density of t
// must be smooth between two breaks, where Gauss quadrature with eight points is exact for polynomials of degree 15.
template <class Value, class Density>
Moments moments(const std::vector<double>& breaks, Value value, Density density) {
  static const GaussRule rule = gauss_rule(8);
  const auto integral = [&](auto integrand) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
      const double half = (breaks[i + 1] - breaks[i]) / 2, middle = (breaks[i + 1] + breaks[i]) / 2;
      for (std::size_t k = 0; k < rule.points.size(); ++k) {
        const double t = middle + half * rule.points[k];
        sum += half * rule.weights[k] * integrand(t) * density(t);
      }
    }
    return sum;
  };
  const double mass = integral([](double /*t*/) { return 1.0; });
  const double mean = integral(value) / mass;
  const double variance = integral([&](double t) { return (value(t) - mean) * (value(t) - mean); }) / mass;
  return {.mean = mean, .standard_deviation = std::sqrt(variance)};
}

// Returns the ends of the intervals of quadrature over a standard normal variable, from low to high in steps of at most 0.5.
std::vector<double> normal_breaks(double low, double high) {
  const int count = std::max(1, static_cast<int>(std::ceil((high - low) / 0.5)));
  std::vector<double> breaks;
  for (int i = 0; i <= count; ++i) breaks.push_back(low + (high - low) * i / count);
  return breaks;
}

// Number of standard deviations up to which a normal density is integrated. At this distance from the mean the density is
// 2e-37 of its largest value; the rest of the range changes no digit of a moment.
constexpr double far_out = 13;

Moments moments_within(const Normal& d, const Interval& x) {
  const double low = std::max((x.low - d.mean) / d.standard_deviation, -far_out);
  const double high = std::min((x.high - d.mean) / d.standard_deviation, far_out);
  const Moments scaled = moments(
      normal_breaks(low, high), [&](double z) { return z; }, standard_normal_density);
  return {.mean = d.mean + d.standard_deviation * scaled.mean,
          .standard_deviation = d.standard_deviation * scaled.standard_deviation};
}

Moments moments_within(const Lognormal& d, const Interval& x) {
  const Normal logarithm = logarithm_of(d);
  const double s = logarithm.standard_deviation;
  const double low = x.low > 0 ? std::max((std::log(x.low) - logarithm.mean) / s, -far_out) : -far_out;
  // The integrand of the second moment, exp(2 s z) times a normal density, has its maximum at z = 2 s instead of 0. So
  // integrate farther by 2 s.
  const double high = std::min((std::log(x.high) - logarithm.mean) / s, far_out + 2 * s);
  return moments(
      normal_breaks(low, high), [&](double z) { return std::exp(logarithm.mean + s * z); }, standard_normal_density);
}

Moments moments_within(const Uniform& /*unused*/, const Interval& x) {
  return moments(
      {x.low, x.high}, [](double t) { return t; }, [](double /*t*/) { return 1.0; });
}

Moments moments_within(const Triangular& d, const Interval& x) {
  const auto density = [&](double t) {
    return t < d.mode ? (t - d.low) / (d.mode - d.low) : d.mode < d.high ? (d.high - t) / (d.high - d.mode) : 0;
  };
  return moments(
      {x.low, std::clamp(d.mode, x.low, x.high), x.high}, [](double t) { return t; }, density);
}

Moments moments_within(const Empirical& d, const Interval& x) {
  const double low = below(d, x.low), high = up_to(d, x.high), n = static_cast<double>(d.values.size() - 1);
  std::vector<double> breaks{low};
  for (std::size_t i = 0; i < d.values.size(); ++i) {
    const double p = static_cast<double>(i) / n;
    if (low < p && p < high) breaks.push_back(p);
  }
  breaks.push_back(high);
  return moments(
      breaks, [&](double p) { return quantile_of(d, p); }, [](double /*p*/) { return 1.0; });
}

}  // namespace

Distribution::Distribution(Parameters parameters, const Truncation& truncation)
    : parameters_(std::move(parameters)), truncation_(truncation) {
  if (auto* const empirical = std::get_if<Empirical>(&parameters_)) {
    check(*empirical);  // refuse NaN before the values are sorted
    std::sort(empirical->values.begin(), empirical->values.end());
  }
  std::visit([](const auto& d) { check(d); }, parameters_);
  const double low = truncation.low, high = truncation.high;
  require_of("truncate_low", !std::isnan(low), "truncate_low must be a number");
  require_of("truncate_high", high >= low, "truncate_high = " + text(high) + " must not be below truncate_low = " + text(low));
  support_ = std::visit([](const auto& d) { return support_of(d); }, parameters_);
  const bool cuts_below = low > support_.low, cuts_above = high < support_.high;
  if (cuts_below || cuts_above) {
    if (cuts_below) below_ = std::visit([&](const auto& d) { return below(d, low); }, parameters_);
    const double to_high = cuts_above ? std::visit([&](const auto& d) { return up_to(d, high); }, parameters_) : 1;
    kept_ = to_high - below_;
    require_of(cuts_below ? "truncate_low" : "truncate_high", kept_ >= least_kept,
               "truncated to [" + text(low) + ", " + text(high) + "] a distribution keeps " + text(kept_) +
                   " of its probability; it must keep at least " + text(least_kept));
    support_ = {.low = std::max(low, support_.low), .high = std::min(high, support_.high)};
  }
  find_moments();
}

void Distribution::find_moments() {
  const auto of_whole = [&](const auto& d) {
    mean_ = d.mean;
    standard_deviation_ = d.standard_deviation;
  };
  const bool whole = kept_ == 1;
  if (whole && kind() == DistributionKind::normal) return of_whole(std::get<Normal>(parameters_));
  if (whole && kind() == DistributionKind::lognormal) return of_whole(std::get<Lognormal>(parameters_));
  const Moments found = std::visit([&](const auto& d) { return moments_within(d, support_); }, parameters_);
  mean_ = found.mean;
  standard_deviation_ = found.standard_deviation;
}

double Distribution::quantile(double p) const {
  if (!(p > 0 && p < 1)) require(false, "p = " + text(p) + " must be above 0 and below 1");
  // Rounding may give the probability 1, at which the quantile of an unbounded distribution is infinite.
  const double of_whole = std::min(below_ + p * kept_, 1 - 0x1p-53);
  const double value = std::visit([&](const auto& d) { return quantile_of(d, of_whole); }, parameters_);
  return std::clamp(value, support_.low, support_.high);  // rounding may move the value beyond the support of the distribution
}

double Distribution::cdf(double x) const {
  if (x >= support_.high) return 1;
  if (!(x >= support_.low)) return std::isnan(x) ? x : 0;
  return std::clamp((std::visit([&](const auto& d) { return up_to(d, x); }, parameters_) - below_) / kept_, 0.0, 1.0);
}

}  // namespace softland
