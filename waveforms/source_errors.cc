#include "waveforms/source_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/require.h"

namespace softland {
namespace {

constexpr double no_bound = std::numeric_limits<double>::infinity();
// Largest shift of a voltage edge towards a neighbouring edge, as a share of the time between the two edges.
constexpr double most_of_gap = 0.49;

/// A voltage edge: the range of signal breakpoints (numbers of pieces) that a delay of the edge shifts together.
struct Edge {
  std::size_t first, last;
};

/// Returns true if the signal piece is a constant level, with or without a sine of constant amplitude.
bool is_level(const SignalPiece& piece) { return piece.slope == 0 && piece.amplitude_slope == 0 && piece.terms.empty(); }

std::vector<Edge> edges_of(const Signal& signal) {
  const std::vector<SignalPiece>& pieces = signal.pieces();
  const bool begins_at_rest = is_level(pieces[0]) && pieces[0].value == signal.before() && !pieces[0].oscillates();
  std::vector<Edge> edges;
  for (std::size_t i = begins_at_rest ? 1 : 0; i < pieces.size(); ++i) {
    const bool is_ramp_between_levels =
        !is_level(pieces[i]) && i + 1 < pieces.size() && is_level(pieces[i + 1]) && (i == 0 || is_level(pieces[i - 1]));
    edges.push_back({.first = i, .last = is_ramp_between_levels ? i + 1 : i});
    i = edges.back().last;
  }
  return edges;
}

/// Returns the times at which the signal pieces begin with all delays [s]. Where the signal starts without an edge, the first
/// time is not used.
std::vector<double> begins(const std::vector<SignalPiece>& pieces, const std::vector<Edge>& edges, const SourceErrors& errors) {
  std::vector<double> all;
  for (const SignalPiece& piece : pieces) all.push_back(piece.begin + errors.delay);
  for (std::size_t j = 0; j < std::min(edges.size(), errors.edges.size()); ++j) {
    const double before = j == 0 ? no_bound : pieces[edges[j].first].begin - pieces[edges[j - 1].last].begin;
    const double after = j + 1 == edges.size() ? no_bound : pieces[edges[j + 1].first].begin - pieces[edges[j].last].begin;
    const double late = std::clamp(errors.edges[j], -most_of_gap * before, most_of_gap * after);
    for (std::size_t i = edges[j].first; i <= edges[j].last; ++i) all[i] = pieces[i].begin + late + errors.delay;
  }
  return all;
}

/// Returns signal piece i moved to [begin, end]. Its straight line and the envelope of its sine keep their end values, the sine
/// is delayed by `late`, and the terms are stretched with the piece.
SignalPiece moved(const Signal& signal, std::size_t i, double begin, double end, double offset, double late) {
  const SignalPiece& piece = signal.pieces()[i];
  SignalPiece own = piece;
  own.begin = begin;
  own.value += offset;
  if (piece.oscillates()) own.phase -= piece.angular_frequency * late;
  if (is_level(piece) || i + 1 == signal.pieces().size()) return own;
  const double old_end = signal.pieces()[i + 1].begin, old_duration = old_end - piece.begin, duration = end - begin;
  const double last = !piece.is_straight() ? piece.value + piece.slope * old_duration : signal.voltage_before(old_end);
  own.slope = (last + offset - own.value) / duration;
  const double quicker = old_duration / duration;
  own.amplitude_slope *= quicker;
  for (SignalTerm& term : own.terms) {
    double power = quicker;
    for (std::size_t k = 1; k < term.cosine.size(); ++k, power *= quicker) term.cosine[k] *= power, term.sine[k] *= power;
    term.decay *= quicker;
    term.angular_frequency *= quicker;
    term.sweep *= quicker * quicker;
  }
  return own;
}

}  // namespace

std::size_t edge_count(const Signal& signal) { return edges_of(signal).size(); }

double first_edge(const Signal& signal, const SourceErrors& errors) {
  const std::vector<Edge> edges = edges_of(signal);
  return edges.empty() ? no_bound : begins(signal.pieces(), edges, errors)[edges.front().first];
}

Signal with_errors(const Signal& given, const SourceErrors& errors, double origin) {
  const auto is_finite = [](double number) { return std::isfinite(number); };
  require(is_finite(errors.gain) && errors.gain > 0 && is_finite(errors.offset) && is_finite(errors.delay) && is_finite(origin) &&
              std::all_of(errors.edges.begin(), errors.edges.end(), is_finite),
          "the errors of a source must be finite, and its gain > 0");
  const Signal signal = errors.gain == 1 ? given : scaled(given, errors.gain);
  const std::vector<SignalPiece>& pieces = signal.pieces();
  const std::vector<Edge> edges = edges_of(given);
  std::vector<double> begin = begins(pieces, edges, errors);
  for (double& time : begin) time = std::max(0.0, time - origin);
  if (edges.empty() || edges.front().first > 0) begin[0] = 0;

  std::vector<SignalPiece> all;
  if (begin[0] > 0) all.push_back({.value = signal.before() + errors.offset});
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double end = i + 1 < pieces.size() ? begin[i + 1] : no_bound;
    // Leave out a piece that rounding has reduced to no duration, as after a delay much longer than the piece.
    if (end > begin[i]) all.push_back(moved(signal, i, begin[i], end, errors.offset, errors.delay - origin));
  }
  return Signal(std::move(all), given.before());
}

}  // namespace softland
