#include "waveforms/signal_slopes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace softland {
namespace {

bool have_same_pieces(const std::vector<Signal>& a, const std::vector<Signal>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Signal& one, const Signal& other) {
    return std::equal(one.pieces().begin(), one.pieces().end(), other.pieces().begin(), other.pieces().end(),
                      [](const SignalPiece& p, const SignalPiece& q) {
                        return p.terms.size() == q.terms.size() && p.oscillates() == q.oscillates();
                      });
  });
}

// Returns true if two numbers (times or voltages) are equal up to rounding errors, such as those of a sum of durations.
bool are_equal(double a, double b) {
  constexpr double roundings = 16 * std::numeric_limits<double>::epsilon();
  return std::abs(a - b) <= roundings * std::max(std::abs(a), std::abs(b));
}
bool are_equal(const SignalTerm& a, const SignalTerm& b) {
  const auto equal = [](double one, double other) { return are_equal(one, other); };
  return std::equal(a.cosine.begin(), a.cosine.end(), b.cosine.begin(), equal) &&
         std::equal(a.sine.begin(), a.sine.end(), b.sine.begin(), equal) && are_equal(a.decay, b.decay) &&
         are_equal(a.angular_frequency, b.angular_frequency) && are_equal(a.sweep, b.sweep);
}
bool are_equal(const SignalPiece& a, const SignalPiece& b) {
  return are_equal(a.begin, b.begin) && are_equal(a.value, b.value) && are_equal(a.slope, b.slope) &&
         are_equal(a.amplitude, b.amplitude) && are_equal(a.amplitude_slope, b.amplitude_slope) &&
         are_equal(a.angular_frequency, b.angular_frequency) && are_equal(a.phase, b.phase) &&
         std::equal(a.terms.begin(), a.terms.end(), b.terms.begin(), b.terms.end(),
                    [](const SignalTerm& one, const SignalTerm& other) { return are_equal(one, other); });
}

bool is_polynomial(const SignalPiece& piece) {
  return !piece.oscillates() && std::all_of(piece.terms.begin(), piece.terms.end(),
                                            [](const SignalTerm& term) { return !term.turns() && term.decay == 0; });
}

// Returns the coefficients of a polynomial signal piece in powers of the time after `origin` [s].
std::array<double, 4> cubic_about(const SignalPiece& piece, double origin) {
  std::array<double, 4> c{piece.value, piece.slope};
  for (const SignalTerm& term : piece.terms) {
    for (std::size_t k = 0; k < c.size(); ++k) c[k] += term.cosine[k];
  }
  const double by = origin - piece.begin;
  return {c[0] + by * (c[1] + by * (c[2] + by * c[3])), c[1] + by * (2 * c[2] + by * 3 * c[3]), c[2] + 3 * by * c[3], c[3]};
}

// Returns the derivative of a signal piece by a parameter, a central difference, in the form of a signal piece. Returns null if
// times or angles of the piece change as well as its amplitudes.
std::shared_ptr<const SignalPiece> derivative(const SignalPiece& above, const SignalPiece& below, double step) {
  const auto turns_alike = [](const SignalTerm& a, const SignalTerm& b) {
    return a.decay == b.decay && a.angular_frequency == b.angular_frequency && a.sweep == b.sweep;
  };
  if (above.begin != below.begin || above.angular_frequency != below.angular_frequency || above.phase != below.phase ||
      !std::equal(above.terms.begin(), above.terms.end(), below.terms.begin(), below.terms.end(), turns_alike))
    return nullptr;
  SignalPiece piece = below;
  piece.terms.clear();
  piece.is_series = false;
  for (double SignalPiece::*size :
       {&SignalPiece::value, &SignalPiece::slope, &SignalPiece::amplitude, &SignalPiece::amplitude_slope}) {
    piece.*size = (above.*size - below.*size) / step;
  }
  for (std::size_t i = 0; i < above.terms.size(); ++i) {
    const SignalTerm &a = above.terms[i], &b = below.terms[i];
    if (are_equal(a, b)) continue;
    SignalTerm term = b;
    for (std::size_t k = 0; k < term.cosine.size(); ++k) {
      term.cosine[k] = (a.cosine[k] - b.cosine[k]) / step;
      term.sine[k] = (a.sine[k] - b.sine[k]) / step;
    }
    piece.terms.push_back(term);
  }
  piece.is_series = below.is_series && piece.terms.size() == below.terms.size();
  return std::make_shared<const SignalPiece>(std::move(piece));
}

// Returns a time inside signal piece k, at which two versions of the signal are compared; for the last piece, a time after its
// beginning.
double inner_time(const std::vector<SignalPiece>& pieces, std::size_t k) {
  constexpr double share = 0.4;
  return k + 1 < pieces.size() ? std::lerp(pieces[k].begin, pieces[k + 1].begin, share) : pieces[k].begin * (1 + share);
}

}  // namespace

// The waveform parameters x, their bounds, and the signals of all drives for parameters near x.
struct SignalSlopes::Neighbourhood {
  const SignalsOf& signals;
  std::span<const double> x, lower, upper;

  // Returns the value of parameter k after a change by `share` of the step of the finite difference, kept within the bounds.
  [[nodiscard]] double beside(std::size_t k, double share) const {
    return std::clamp(x[k] + share * share_of_range * (upper[k] - lower[k]), lower[k], upper[k]);
  }
  [[nodiscard]] bool has_room(std::size_t k) const { return upper[k] > lower[k]; }
  [[nodiscard]] double step(std::size_t k) const { return beside(k, 1) - beside(k, -1); }
  template <class Parameters>
  [[nodiscard]] Signals signals_beside(const Parameters& parameters, double share) const {
    std::vector<double> near(x.begin(), x.end());
    for (const std::size_t k : parameters) {
      if (has_room(k)) near[k] = beside(k, share);
    }
    return signals(near);
  }
};

SignalSlopes::SignalSlopes(const SignalsOf& signals, std::span<const double> x, std::span<const double> lower,
                           std::span<const double> upper, const std::vector<ParameterGroup>& groups)
    : parameters_(x.size()) {
  const Neighbourhood near{signals, x, lower, upper};
  const Signals here = signals(x);
  const auto clear = [&] {
    slopes_.clear();
    for (const Signal& signal : here) slopes_.emplace_back(signal.pieces().size());
    kept_.clear();
  };
  clear();
  are_grouped_ = !groups.empty() && saves(groups.size()) && find_in_groups(near, here, groups);
  if (are_grouped_) return;
  clear();
  find_one_by_one(near, here);
}

// Returns true if finite differences for this number of parameter groups, and one more for the check, are fewer than those for
// all single parameters.
bool SignalSlopes::saves(std::size_t groups) const { return groups + 1 < parameters_; }

void SignalSlopes::find_one_by_one(const Neighbourhood& near, const Signals& here) {
  for (std::size_t k = 0; k < parameters_; ++k) {
    if (!near.has_room(k)) continue;
    Signals above = near.signals_beside(std::array{k}, 1), below = near.signals_beside(std::array{k}, -1);
    const auto is_here = [&](const Signals& signals, double share) {
      return near.beside(k, share) != near.x[k] && have_same_pieces(signals, here);
    };
    const auto moves = [&](double step) {
      return [k, step](std::size_t, std::size_t) { return std::optional(std::pair(k, step)); };
    };
    if (have_same_pieces(above, here) && have_same_pieces(below, here)) {
      add(moves(near.step(k)), std::move(above), std::move(below));
    } else if (is_here(above, 1)) {
      add(moves(near.beside(k, 1) - near.x[k]), std::move(above), here);
    } else if (is_here(below, -1)) {
      add(moves(near.x[k] - near.beside(k, -1)), here, std::move(below));
    } else {
      kinks_.push_back(k);
    }
  }
}

bool SignalSlopes::find_in_groups(const Neighbourhood& near, const Signals& here, const std::vector<ParameterGroup>& groups) {
  for (const ParameterGroup& group : groups) {
    const auto fits = [](const auto& movers, const auto& slopes) { return movers.size() == slopes.size(); };
    if (!std::equal(group.movers.begin(), group.movers.end(), slopes_.begin(), slopes_.end(), fits)) return false;
    Signals above = near.signals_beside(group.parameters, 1), below = near.signals_beside(group.parameters, -1);
    if (!have_same_pieces(above, here) || !have_same_pieces(below, here)) return false;
    const auto mover = [&](std::size_t drive, std::size_t piece) {
      const std::optional<std::size_t> k = group.movers[drive][piece];
      return k && near.has_room(*k) ? std::optional(std::pair(*k, near.step(*k))) : std::nullopt;
    };
    if (!add(mover, std::move(above), std::move(below))) return false;
  }
  return holds_along_all(near, here);
}

bool SignalSlopes::holds_along_all(const Neighbourhood& near, const Signals& here) const {
  constexpr double tolerance =
      // Tolerance of the check relative to the largest change; a parameter in a wrong group causes an error of the size of its
      // change.
      1e-5;
  const auto share = [](std::size_t k) {
    const double golden = std::fmod(0.618033988749895 * static_cast<double>(k + 1), 1.0);
    return (k % 2 == 0 ? 1 : -1) * (0.5 + golden / 2);
  };
  std::vector<double> up(near.x.begin(), near.x.end()), down = up;
  for (std::size_t k = 0; k < parameters_; ++k) {
    if (near.has_room(k)) up[k] = near.beside(k, share(k)), down[k] = near.beside(k, -share(k));
  }
  const Signals above = near.signals(up), below = near.signals(down);
  if (!have_same_pieces(above, here) || !have_same_pieces(below, here)) return false;
  for (std::size_t drive = 0; drive < here.size(); ++drive) {
    double error = 0, begin_error = 0, largest = 0, largest_begin = 0;
    for (std::size_t piece = 0; piece < slopes_[drive].size(); ++piece) {
      const SignalPiece &a = above[drive].pieces()[piece], &b = below[drive].pieces()[piece];
      const double time = inner_time(here[drive].pieces(), piece), change = a.voltage(time) - b.voltage(time);
      double expected = 0, expected_begin = 0;
      for (const Slope& slope : slopes_[drive][piece]) {
        const double step = up[slope.parameter] - down[slope.parameter];
        expected += step * slope.voltage(time);
        expected_begin += step * slope.begin;
        largest = std::max(largest, std::abs(step * slope.voltage(time)));
      }
      largest_begin = std::max(largest_begin, std::abs(expected_begin));
      error = std::max(error, std::abs(change - expected));
      begin_error = std::max(begin_error, std::abs(a.begin - b.begin - expected_begin));
    }
    if (!(error <= tolerance * largest && begin_error <= tolerance * largest_begin)) return false;
  }
  return true;
}

template <class Mover>
bool SignalSlopes::add(Mover&& mover, Signals above, Signals below) {
  bool keeps = false;
  for (std::size_t drive = 0; drive < above.size(); ++drive) {
    for (std::size_t piece = 0; piece < above[drive].pieces().size(); ++piece) {
      const SignalPiece &a = above[drive].pieces()[piece], &b = below[drive].pieces()[piece];
      if (are_equal(a, b)) continue;
      const auto found = mover(drive, piece);
      if (!found) return false;
      const auto& [parameter, step] = *found;
      Slope slope{.parameter = parameter, .begin = (a.begin - b.begin) / step, .per_step = 1 / step};
      if (is_polynomial(a) && is_polynomial(b)) {
        slope.origin = b.begin;
        const std::array<double, 4> high = cubic_about(a, b.begin), low = cubic_about(b, b.begin);
        for (std::size_t k = 0; k < high.size(); ++k) slope.cubic[k] = (high[k] - low[k]) / step;
      } else if ((slope.piece = derivative(a, b, step)) == nullptr) {
        slope.above = &a;
        slope.below = &b;
        keeps = true;
      }
      slopes_[drive][piece].push_back(slope);
    }
  }
  if (keeps) {
    kept_.push_back(std::move(above));
    kept_.push_back(std::move(below));
  }
  return true;
}

std::vector<ParameterGroup> SignalSlopes::groups() const {
  using Moved = std::vector<std::pair<std::size_t, std::size_t>>;
  std::vector<Moved> moved(parameters_);  // signal pieces (drive, piece) that each parameter changes
  ParameterGroup none;
  for (std::size_t drive = 0; drive < slopes_.size(); ++drive) {
    none.movers.emplace_back(slopes_[drive].size());
    for (std::size_t piece = 0; piece < slopes_[drive].size(); ++piece) {
      for (const Slope& slope : slopes_[drive][piece]) moved[slope.parameter].emplace_back(drive, piece);
    }
  }
  std::vector<ParameterGroup> groups;
  for (std::size_t k = 0; k < parameters_; ++k) {
    const auto is_free = [&](const ParameterGroup& group) {
      return std::none_of(moved[k].begin(), moved[k].end(), [&](const auto& at) { return group.movers[at.first][at.second]; });
    };
    auto group = std::find_if(groups.begin(), groups.end(), is_free);
    if (group == groups.end()) group = groups.insert(group, none);
    if (!saves(groups.size())) return {};
    group->parameters.push_back(k);
    for (const auto& [drive, piece] : moved[k]) group->movers[drive][piece] = k;
  }
  return groups;
}

}  // namespace softland
