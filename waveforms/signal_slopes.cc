#include "waveforms/signal_slopes.h"

#include <algorithm>

namespace softland {
namespace {

constexpr double share_of_range = 1e-6;

bool have_same_pieces(const std::vector<Signal>& a, const std::vector<Signal>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Signal& one, const Signal& other) {
    return std::equal(one.pieces().begin(), one.pieces().end(), other.pieces().begin(), other.pieces().end(),
                      [](const SignalPiece& p, const SignalPiece& q) {
                        return p.terms.size() == q.terms.size() && p.oscillates() == q.oscillates();
                      });
  });
}

}  // namespace

SignalSlopes::SignalSlopes(const SignalsOf& signals, std::span<const double> x, std::span<const double> lower,
                           std::span<const double> upper)
    : parameters_(x.size()) {
  const std::vector<Signal> here = signals(x);
  for (const Signal& signal : here) slopes_.emplace_back(signal.pieces().size());
  std::vector<double> near(x.begin(), x.end());
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double step = share_of_range * (upper[k] - lower[k]);
    if (!(step > 0)) continue;
    const double up = std::min(upper[k], x[k] + step), down = std::max(lower[k], x[k] - step);
    near[k] = up;
    const std::vector<Signal> above = signals(near);
    near[k] = down;
    const std::vector<Signal> below = signals(near);
    near[k] = x[k];
    if (have_same_pieces(above, here) && have_same_pieces(below, here)) {
      add(k, above, below, up - down);
    } else if (up > x[k] && have_same_pieces(above, here)) {
      add(k, above, here, up - x[k]);
    } else if (down < x[k] && have_same_pieces(below, here)) {
      add(k, here, below, x[k] - down);
    } else {
      kinks_.push_back(k);
    }
  }
}

void SignalSlopes::add(std::size_t parameter, const std::vector<Signal>& above, const std::vector<Signal>& below, double step) {
  for (std::size_t drive = 0; drive < above.size(); ++drive) {
    for (std::size_t piece = 0; piece < above[drive].pieces().size(); ++piece) {
      const SignalPiece &a = above[drive].pieces()[piece], &b = below[drive].pieces()[piece];
      if (a == b) continue;
      Slope slope{.parameter = parameter,
                  .begin = (a.begin - b.begin) / step,
                  .straight = a.is_straight() && b.is_straight(),
                  .above = {},
                  .below = {},
                  .per_step = 1 / step};
      if (slope.straight) {
        slope.at_zero = ((a.value - b.value) - (a.slope * a.begin - b.slope * b.begin)) / step;
        slope.rate = (a.slope - b.slope) / step;
      } else {
        slope.above = a;
        slope.below = b;
      }
      slopes_[drive][piece].push_back(std::move(slope));
    }
  }
}

}  // namespace softland
