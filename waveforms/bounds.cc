#include "waveforms/bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace softland::internal {
namespace {

/// A term of a signal piece that can be differentiated by time: polynomials times a decaying cosine and sine.
struct Differentiated {
  // Number of coefficients of each polynomial: a cubic, whose degree a frequency sweep raises by one for each of four
  // derivatives.
  static constexpr std::size_t size = 8;
  std::array<double, size> cosine = {}, sine = {};
  double decay = 0, angular_frequency = 0, sweep = 0;

  explicit Differentiated(const TermOf<double>& term)
      : decay(term.decay), angular_frequency(term.angular_frequency), sweep(term.sweep) {
    std::copy(term.cosine.begin(), term.cosine.end(), cosine.begin());
    std::copy(term.sine.begin(), term.sine.end(), sine.begin());
  }

  void differentiate() {
    std::array<double, size> c = {}, s = {};
    for (std::size_t k = 0; k < size; ++k) {
      c[k] += angular_frequency * sine[k] - decay * cosine[k];
      s[k] -= angular_frequency * cosine[k] + decay * sine[k];
      if (k + 1 == size) break;
      c[k] += static_cast<double>(k + 1) * cosine[k + 1];
      s[k] += static_cast<double>(k + 1) * sine[k + 1];
      c[k + 1] += sweep * sine[k];
      s[k + 1] -= sweep * cosine[k];
    }
    cosine = c, sine = s;
  }

  /// Returns true if the term is a cosine and sine of constant amplitude, so that bound() does not depend on time.
  [[nodiscard]] bool is_steady() const {
    bool is_constant = decay == 0;
    for (std::size_t k = 1; k < size; ++k) is_constant = is_constant && cosine[k] == 0 && sine[k] == 0;
    return is_constant;
  }
  /// Returns a bound on the absolute value of the term between the times `first` and `last`, counted from the piece's
  /// beginning.
  [[nodiscard]] double bound(double first, double last) const {
    const double longest = std::max(std::abs(first), std::abs(last));
    double power = 1, sum = 0;
    for (std::size_t k = 0; k < size; ++k, power *= longest) sum += (std::abs(cosine[k]) + std::abs(sine[k])) * power;
    return sum * std::exp(-decay * (decay > 0 ? first : last));
  }
};

/// A bound on the derivative of given order of a signal piece's voltage, for any interval. The terms are differentiated only
/// once.
class DerivativeBound {
 public:
  DerivativeBound(const SignalPieceOf<double>& piece, int order) : piece_(piece), order_(order) {
    for (const TermOf<double>& term : piece.terms) {
      Differentiated d(term);
      for (int i = 0; i < order; ++i) d.differentiate();
      if (d.is_steady()) {
        steady_ += d.bound(0, 0);
      } else {
        others_.push_back(d);
      }
    }
  }

  double operator()(double from, double to) const {
    double sum = steady_;
    for (const Differentiated& d : others_) sum += d.bound(from - piece_.begin, to - piece_.begin);
    if (piece_.oscillates()) {
      const double w = piece_.angular_frequency;
      const double envelope = std::max(std::abs(piece_.amplitude + piece_.amplitude_slope * (from - piece_.begin)),
                                       std::abs(piece_.amplitude + piece_.amplitude_slope * (to - piece_.begin)));
      sum += (envelope * w + order_ * std::abs(piece_.amplitude_slope)) * std::pow(w, order_ - 1);
    }
    return sum;
  }

 private:
  const SignalPieceOf<double>& piece_;
  int order_;
  double steady_ = 0;
  std::vector<Differentiated> others_;
};

/// Returns the sum of the largest absolute values of all parts of a signal piece's voltage on [from, to], a scale for errors.
/// The same for dV/dt if `of_rate` is true.
double size_of(const SignalPieceOf<double>& piece, bool of_rate, double from, double to) {
  double sum = 0;
  for (const TermOf<double>& term : piece.terms) {
    Differentiated d(term);
    if (of_rate) d.differentiate();
    sum += d.bound(from - piece.begin, to - piece.begin);
  }
  const double longest = std::max(std::abs(from - piece.begin), std::abs(to - piece.begin));
  const double swing = std::abs(piece.amplitude) + std::abs(piece.amplitude_slope) * longest;
  return sum + (of_rate ? std::abs(piece.slope) + std::abs(piece.amplitude_slope) + swing * piece.angular_frequency
                        : std::abs(piece.value) + std::abs(piece.slope) * longest + swing);
}

/// Returns a time in [from, to] at which the function is within `tolerance` of its maximum. `curvature(a, b)` is a bound on
/// |f''| between a and b. Within an interval of length h, f exceeds its larger end value by at most h^2 / 8 times this bound.
template <typename Function, typename Curvature>
double time_of_maximum(Function function, const Curvature& curvature, double from, double to, double tolerance) {
  struct Interval {
    double begin, end, at_begin, at_end;
  };
  std::vector<Interval> open{{from, to, function(from), function(to)}};
  double place = open[0].at_begin >= open[0].at_end ? from : to, best = std::max(open[0].at_begin, open[0].at_end);
  // Largest number of computed values. A piece needs more only if its times are so late that sines of them have no correct
  // digit.
  constexpr long most_values = 10'000'000;
  for (long values = 0; !open.empty() && values < most_values; ++values) {
    const Interval i = open.back();
    open.pop_back();
    const double length = i.end - i.begin, middle = i.begin + 0.5 * length;
    if (!(middle > i.begin && middle < i.end)) continue;
    const double above = length * length / 8 * curvature(i.begin, i.end);
    if (std::max(i.at_begin, i.at_end) + above <= best + tolerance) continue;
    const double at_middle = function(middle);
    if (at_middle > best) best = at_middle, place = middle;
    open.push_back({i.begin, middle, i.at_begin, at_middle});
    open.push_back({middle, i.end, at_middle, i.at_end});
  }
  return place;
}

}  // namespace

double derivative_bound(const SignalPieceOf<double>& piece, int order, double from, double to) {
  return DerivativeBound(piece, order)(from, to);
}

void append_extrema_of_terms(std::vector<double>& times, const SignalPieceOf<double>& piece, bool of_rate, double from,
                             double to) {
  constexpr double promised = 1e-9;
  const double tolerance = promised * size_of(piece, of_rate, from, to);
  const DerivativeBound curvature(piece, of_rate ? 3 : 2);
  for (const double sign : {1.0, -1.0}) {
    const auto function = [&](double time) { return sign * (of_rate ? piece.rate(time) : piece.voltage(time)); };
    times.push_back(time_of_maximum(function, curvature, from, to, tolerance));
  }
}

double duration_of_terms(const SignalPieceOf<double>& piece) {
  // Number of time constants after which a decaying term counts as 0: exp(-50) is 2e-22, and the factor of a cubic polynomial
  // grows only by 1e5 in that time.
  constexpr double time_constants = 50;
  double longest = 0;
  for (const TermOf<double>& term : piece.terms) longest = std::max(longest, time_constants / term.decay);
  return longest;
}

}  // namespace softland::internal
