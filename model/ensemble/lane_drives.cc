#include "model/ensemble/lane_drives.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace softland::simd {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

bool is_cubic(const SignalTerm& term) { return term.decay == 0 && !term.turns(); }
bool is_tail(const SignalTerm& term) {
  return term.decay != 0 && !term.turns() &&
         std::all_of(term.cosine.begin() + 1, term.cosine.end(), [](double c) { return c == 0; });
}

/// A sequence of short pieces of a drive signal, with the integral of the voltage up to the beginning of each piece.
class PieceRun {
 public:
  PieceRun(std::span<const LanePiece> pieces, double end) : pieces_(pieces), end_(end) {
    for (std::size_t i = 0; i < pieces.size(); ++i) integrals_.push_back(i == 0 ? 0 : integral_to(pieces[i].begin, i - 1));
  }
  [[nodiscard]] double begin() const { return pieces_.front().begin; }
  [[nodiscard]] double end() const { return end_; }
  /// Returns the voltage of the drive at a time in the sequence [V].
  [[nodiscard]] double voltage(double time) const {
    const LanePiece& p = pieces_[piece_at(time)];
    const double s = time - p.begin;
    double sum = p.value + s * (p.slope + s * (p.square + s * p.cube));
    for (int i = 0; i < LanePiece::most_tails; ++i)
      if (p.tail[i] != 0) sum += p.tail[i] * std::exp(-p.decay[i] * s);
    return sum;
  }
  /// Returns the rate of change of the drive's voltage at a time in the sequence [V/s].
  [[nodiscard]] double rate(double time) const {
    const LanePiece& p = pieces_[piece_at(time)];
    const double s = time - p.begin;
    double sum = p.slope + s * (2 * p.square + 3 * s * p.cube);
    for (int i = 0; i < LanePiece::most_tails; ++i) sum -= p.decay[i] * p.tail[i] * std::exp(-p.decay[i] * s);
    return sum;
  }
  /// Returns the integral of the voltage from the beginning of the sequence to `time` [V s].
  [[nodiscard]] double integral(double time) const { return integral_to(time, piece_at(time)); }

  /// Returns the median duration of two consecutive pieces of the sequence [s]: the window of the moving average. A sample of
  /// the signal has one piece or two, so the window is two samples or one.
  [[nodiscard]] double window() const {
    std::vector<double> lengths;
    for (std::size_t i = 0; i + 2 < pieces_.size(); ++i) lengths.push_back(pieces_[i + 2].begin - pieces_[i].begin);
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    return *middle;
  }

 private:
  [[nodiscard]] std::size_t piece_at(double time) const {
    while (near_ + 1 < pieces_.size() && pieces_[near_ + 1].begin <= time) ++near_;
    while (near_ > 0 && pieces_[near_].begin > time) --near_;
    return near_;
  }
  [[nodiscard]] double integral_to(double time, std::size_t piece) const {
    const LanePiece& p = pieces_[piece];
    const double s = time - p.begin;
    double sum = integrals_[piece] + s * (p.value + s * (p.slope / 2 + s * (p.square / 3 + s * p.cube / 4)));
    for (int i = 0; i < LanePiece::most_tails; ++i)
      if (p.tail[i] != 0) sum -= p.tail[i] / p.decay[i] * std::expm1(-p.decay[i] * s);
    return sum;
  }

  std::span<const LanePiece> pieces_;
  double end_;
  std::vector<double> integrals_;
  // Index of the piece used last, from which piece_at() searches: the times increase from call to call.
  mutable std::size_t near_ = 0;
};

struct Knot {
  double time = 0, value = 0, rate = 0;  // time [s], voltage [V] and its rate [V/s] at an end of a cubic piece
};

/// Returns the mean voltage over a window about a time, and the rate of change of this mean. Near an end of the sequence of
/// pieces the window shrinks on both sides.
Knot mean_about(double time, const PieceRun& run, double window) {
  const double before = time - run.begin(), after = run.end() - time;
  if (before <= 0) return {time, run.voltage(time), run.rate(time)};
  if (after <= 0) return {time, run.voltage(time), run.rate(time)};
  const double half = std::min({window / 2, before, after});
  const double mean = (run.integral(time + half) - run.integral(time - half)) / (2 * half);
  if (half == before) return {time, mean, (run.voltage(time + half) - mean) / half};
  if (half == after) return {time, mean, (mean - run.voltage(time - half)) / half};
  return {time, mean, (run.voltage(time + half) - run.voltage(time - half)) / (2 * half)};
}

/// Returns the cubic polynomial that has the given voltages and rates at the times of `a` and `b`.
LanePiece between(const Knot& a, const Knot& b) {
  const double h = b.time - a.time, rise = (b.value - a.value) / h;
  return {.begin = a.time,
          .value = a.value,
          .slope = a.rate,
          .square = (3 * rise - 2 * a.rate - b.rate) / h,
          .cube = (a.rate + b.rate - 2 * rise) / (h * h),
          .longest_step = infinite};
}

/// Returns the integral of the original voltage between the times of `a` and `b`, `integral`, less that of the cubic polynomial
/// between them [V s].
double missing(const Knot& a, const Knot& b, double integral) {
  const double h = b.time - a.time;
  return integral - h * ((a.value + b.value) / 2 + h * (a.rate - b.rate) / 12);
}

/// Restores the integral of the voltage, which the moving average changes at corners. Each knot (end of a cubic) between the
/// first and the last is corrected by the integral that the cubics on both sides lack.
void restore_integral(std::vector<Knot>& knots, const PieceRun& run) {
  const std::size_t last = knots.size() - 1;
  double until = run.integral(knots.front().time);  // integral of the original voltage up to this knot [V s]
  std::vector<double> more(knots.size(), 0);        // correction of the voltage at each knot [V]
  const double step = (run.end() - run.begin()) / static_cast<double>(last);
  for (std::size_t k = 0; k < last; ++k) {
    const double next = run.integral(knots[k + 1].time), lost = missing(knots[k], knots[k + 1], next - until) / step;
    until = next;
    const bool is_first = k == 0, is_last = k + 1 == last;
    if (!is_first) more[k] += is_last ? lost : lost / 2;
    if (!is_last) more[k + 1] += is_first ? lost : lost / 2;
  }
  for (std::size_t k = 1; k < last; ++k) {
    knots[k].value += more[k];
    knots[k].rate += (more[k + 1] - more[k - 1]) / (2 * step);
  }
}

void append_smooth(std::vector<LanePiece>& all, const PieceRun& run, double window) {
  const double length = run.end() - run.begin(), count = std::max(2.0, std::ceil(2 * length / window));
  std::vector<Knot> knots{mean_about(run.begin(), run, window)};
  for (double k = 1; k < count; ++k) knots.push_back(mean_about(run.begin() + length * (k / count), run, window));
  knots.push_back(mean_about(run.end(), run, window));
  restore_integral(knots, run);
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    all.push_back(between(knots[k], knots[k + 1]));
    all.back().joins = k > 0;
  }
}

}  // namespace

bool goes_in_lanes(const Signal& drive) {
  return std::ranges::all_of(drive.pieces(), [](const SignalPiece& p) {
    return std::ranges::count_if(p.terms, is_tail) <= LanePiece::most_tails &&
           std::ranges::all_of(p.terms, [](const SignalTerm& term) { return is_cubic(term) || is_tail(term); });
  });
}

namespace {

/// Returns the longest integration step that resolves a signal piece [s]: as Signal::resolving_step() for a sine, otherwise the
/// shortest time constant.
double longest_step(const Signal& drive, const SignalPiece& piece) {
  if (piece.oscillates()) return drive.resolving_step(piece.begin);
  double step = infinite;
  for (const SignalTerm& term : piece.terms) {
    if (term.decay > 0) step = std::min(step, 1 / term.decay);
  }
  return step;
}

}  // namespace

std::vector<LanePiece> pieces_of(const Signal& drive) {
  std::vector<LanePiece> all;
  all.reserve(drive.pieces().size());
  for (const SignalPiece& p : drive.pieces()) {
    LanePiece& piece = all.emplace_back(LanePiece{.begin = p.begin,
                                                  .value = p.value,
                                                  .slope = p.slope,
                                                  .amplitude = p.amplitude,
                                                  .amplitude_slope = p.amplitude_slope,
                                                  .angular_frequency = p.angular_frequency,
                                                  .phase = p.phase,
                                                  .longest_step = longest_step(drive, p)});
    int tails = 0;
    for (const SignalTerm& term : p.terms) {
      if (is_tail(term)) {
        piece.tail[tails] = term.cosine[0], piece.decay[tails++] = term.decay;
      } else {
        piece.value += term.cosine[0], piece.slope += term.cosine[1];
        piece.square += term.cosine[2], piece.cube += term.cosine[3];
      }
    }
  }
  return all;
}

SmoothedDrive smoothed(std::vector<LanePiece> exact) {
  constexpr std::size_t fewest = 8;  // a moving average replaces only sequences of at least as many short pieces
  const auto is_short = [&](std::size_t i) {
    const LanePiece& p = exact[i];
    const double fastest = std::max(p.decay[0], p.decay[1]);
    return i + 1 < exact.size() && p.tail[0] != 0 && p.amplitude == 0 && p.amplitude_slope == 0 &&
           (exact[i + 1].begin - p.begin) * fastest < 1;
  };
  SmoothedDrive drive;
  for (std::size_t i = 0; i < exact.size();) {
    std::size_t end = i;
    while (is_short(end)) ++end;
    if (end - i < fewest) {
      end = std::max(end, i + 1);
      drive.pieces.insert(drive.pieces.end(), exact.begin() + static_cast<std::ptrdiff_t>(i),
                          exact.begin() + static_cast<std::ptrdiff_t>(end));
    } else {
      const std::span<const LanePiece> all(exact);
      const PieceRun run(all.subspan(i, end - i), exact[end].begin);
      const double window = run.window();
      append_smooth(drive.pieces, run, window);
      drive.window = std::max(drive.window, window);
    }
    i = end;
  }
  return drive;
}

bool LaneDrives::go_in_lanes(std::span<const Signal> drives) {
  return std::ranges::all_of(drives, [this](const Signal& drive) {
    const auto [found, is_new] = go_.try_emplace(&drive);
    if (is_new) found->second = goes_in_lanes(drive);
    return found->second;
  });
}

const std::vector<LanePiece>& LaneDrives::of(const Signal& drive, double fastest) {
  const auto [found, is_new] = known_.try_emplace(&drive);
  Known& known = found->second;
  if (is_new) known.exact = pieces_of(drive), known.smooth = smoothed(known.exact);
  return known.smooth.window > 0 && known.smooth.window * fastest < 1 ? known.smooth.pieces : known.exact;
}

}  // namespace softland::simd
