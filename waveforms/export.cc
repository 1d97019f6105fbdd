#include "waveforms/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <set>

#include "base/require.h"
#include "waveforms/bounds.h"

namespace softland {
namespace {

/// Largest distance between a curve and the straight lines that replace it, relative to the peak of the signal; it is smaller
/// than a step of a 12-bit converter.
constexpr double sine_tolerance = 1e-4;

void require_signals(const std::map<std::string, Signal>& signals) {
  require(!signals.empty(), "an export needs at least one waveform");
}

void require_end(double end) {
  require(end >= 0 && std::isfinite(end),
          fmt::format("the end of an exported waveform is {} s; it must be finite and >= 0", end));
}

const std::string& column_name(const std::string& drive) {
  require(!drive.empty() && drive.find_first_of(",\"\r\n#") == std::string::npos,
          fmt::format(
              "the name of a drive is \"{}\"; for a CSV file it must not be empty or contain a comma, quote, hash or line break",
              drive));
  return drive;
}

/// Returns the number of the last sample of a signal of held samples; the last sample is held without end.
double last_sample(const Signal& held, double rate) { return std::round(held.pieces().back().begin * rate); }

constexpr double most_chords = 1e7;

void require_few(double chords, double tolerance) {
  require(chords <= most_chords, fmt::format("a polyline within {} V of this waveform needs {} points; it must have at most {}",
                                             tolerance, chords, most_chords));
}

/// Appends the inner points of a polyline that approximates a signal piece with terms. Intervals are halved until their
/// straight lines are within the tolerance; their lengths differ, because the curvature changes along the piece.
void append_halved(std::vector<std::pair<double, double>>& points, const SignalPiece& piece, double begin, double end,
                   double tolerance) {
  std::vector<double> ends{end};
  double count = 0;
  for (double from = begin; !ends.empty();) {
    const double to = ends.back(), length = to - from, middle = from + 0.5 * length;
    const bool near = length * length / 8 * internal::derivative_bound(piece, 2, from, to) <= tolerance;
    if (!near && middle > from && middle < to) {
      ends.push_back(middle);
      require_few(++count, tolerance);
      continue;
    }
    ends.pop_back();
    from = to;
    if (to < end) points.emplace_back(to, piece.voltage(to));
  }
}

/// Appends the points inside (begin, end) of a polyline that approximates a curved signal piece within the tolerance: the error
/// of a straight line over an interval of length h is at most h^2 max|V''| / 8.
void append_inside(std::vector<std::pair<double, double>>& points, const SignalPiece& piece, double begin, double end,
                   double tolerance) {
  if (piece.is_straight() || !(end > begin)) return;
  // A spline of equal levels is straight but for rounding; then no inner points are needed, and a tolerance of 0 is allowed.
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  const double size = std::max(std::abs(piece.voltage(begin)), std::abs(piece.voltage(end))), length = end - begin;
  if (!piece.terms.empty() && length * length / 8 * internal::derivative_bound(piece, 2, begin, end) <= rounding * size) return;
  require(tolerance > 0, fmt::format("the tolerance of the polyline of a curve is {} V; it must be > 0", tolerance));
  if (!piece.terms.empty()) return append_halved(points, piece, begin, end, tolerance);
  const double w = piece.angular_frequency;
  const double envelope = std::max(std::abs(piece.amplitude + piece.amplitude_slope * (begin - piece.begin)),
                                   std::abs(piece.amplitude + piece.amplitude_slope * (end - piece.begin)));
  const double curvature = envelope * w * w + 2 * std::abs(piece.amplitude_slope) * w;
  const double chords = std::ceil((end - begin) * std::sqrt(curvature / (8 * tolerance)));
  require_few(chords, tolerance);
  for (double i = 1; i < chords; ++i) {
    const double time = begin + (end - begin) * (i / chords);
    points.emplace_back(time, piece.voltage(time));
  }
}

}  // namespace

std::vector<std::pair<double, double>> polyline(const Signal& signal, double end, double tolerance, double jump_time) {
  require_end(end);
  require(jump_time >= 0 && std::isfinite(jump_time), fmt::format("jump_time is {} s; it must be finite and >= 0", jump_time));
  // A voltage jump becomes a steep ramp. Its duration is at most this share of the interval to the next breakpoint.
  constexpr double share_of_interval = 1e-3;
  const std::vector<SignalPiece>& pieces = signal.pieces();
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < pieces.size() && pieces[i].begin <= end; ++i) {
    const SignalPiece& piece = pieces[i];
    const double next = i + 1 < pieces.size() ? pieces[i + 1].begin : std::numeric_limits<double>::infinity();
    const double before = signal.voltage_before(piece.begin);
    const double after = piece.voltage(piece.begin);
    double from = piece.begin;
    if (before != after) {
      points.emplace_back(piece.begin, before);
      if (jump_time > 0) {
        from = std::max(piece.begin + std::min(jump_time, share_of_interval * (next - piece.begin)),
                        std::nextafter(piece.begin, std::numeric_limits<double>::infinity()));
      }
    }
    points.emplace_back(from, piece.voltage(from));
    const double to = std::min(next, end);
    append_inside(points, piece, from, to, tolerance);
    if (next > end && end > from) points.emplace_back(end, piece.voltage(end));
  }
  return points;
}

std::string csv(const std::map<std::string, Signal>& signals, double end, const std::map<std::string, double>& sample_rates) {
  require_signals(signals);
  std::set<double> times;
  std::set<double> jumps;
  std::string text = "time_s";
  for (const auto& [drive, signal] : signals) {
    text += "," + column_name(drive);
    if (const auto rate = sample_rates.find(drive); rate != sample_rates.end()) {
      for (double k = 0; k <= last_sample(signal, rate->second); ++k) times.insert(k / rate->second);
      continue;
    }
    for (const auto& [time, voltage] : polyline(signal, end, sine_tolerance * signal.peak(), 0)) {
      times.insert(time);
      if (signal.voltage_before(time) != signal.voltage(time)) jumps.insert(time);
    }
  }
  text += '\n';
  const auto append = [&](double time, auto voltage) {
    // This format is the shortest text that reads back to the same double.
    fmt::format_to(std::back_inserter(text), "{}", time);
    for (const auto& [drive, signal] : signals) fmt::format_to(std::back_inserter(text), ",{}", voltage(signal));
    text += '\n';
  };
  for (const double time : times) {
    if (jumps.contains(time)) append(time, [&](const Signal& signal) { return signal.voltage_before(time); });
    append(time, [&](const Signal& signal) { return signal.voltage(time); });
  }
  return text;
}

std::string codes(const std::map<std::string, Coded>& drives) {
  require(!drives.empty(), "an export of codes needs at least one drive with samples");
  const double rate = drives.begin()->second.sample_rate;
  double last = 0;
  std::string text = "index";
  for (const auto& [drive, coded] : drives) {
    require(coded.sample_rate == rate, fmt::format("drive '{}' has samples at {} Hz, and drive '{}' at {} Hz; "
                                                   "all samples of a file must have the same rate",
                                                   drive, coded.sample_rate, drives.begin()->first, rate));
    text += "," + column_name(drive);
    last = std::max(last, last_sample(coded.held, rate));
  }
  text += '\n';
  for (double k = 0; k <= last; ++k) {
    fmt::format_to(std::back_inserter(text), "{}", k);
    for (const auto& [drive, coded] : drives) {
      const double step = (coded.maximum - coded.minimum) / (std::exp2(coded.bits) - 1);
      fmt::format_to(std::back_inserter(text), ",{}", std::round((coded.held.voltage(k / rate) - coded.minimum) / step));
    }
    text += '\n';
  }
  return text;
}

// SPICE ignores the case of names; letters, digits and underscores are valid in all SPICE simulators.
std::string spice_name(const std::string& drive) {
  std::string name;
  for (const char c : drive) {
    const auto byte = static_cast<unsigned char>(c);
    name += byte < 128 && std::isalnum(byte) != 0 ? static_cast<char>(std::tolower(byte)) : '_';
  }
  return name;
}

std::string spice_pwl(const std::map<std::string, Signal>& signals, double end, std::string_view about) {
  require_signals(signals);
  // Duration of a jump in SPICE: far below any time constant of a switch, but resolved by 17 digits at a time of 1 s.
  const double jump_time = std::min(1e-12, 1e-7 * end);
  std::string text = fmt::format("* {}\n", about);
  std::set<std::string> names;
  for (const auto& [drive, signal] : signals) {
    const std::string name = "softland_" + spice_name(drive);
    require(names.insert(name).second,
            fmt::format("the name of a drive is \"{}\"; it must not have the SPICE name of another drive, {}", drive, name));
    fmt::format_to(std::back_inserter(text), ".subckt {} plus minus\nVdrive plus minus PWL(\n", name);
    double last = -1;
    for (const auto& [time, voltage] : polyline(signal, end, sine_tolerance * signal.peak(), jump_time)) {
      // SPICE requires increasing times. Equal times occur only where two breakpoints differ by a rounding error.
      if (!(time > last)) continue;
      fmt::format_to(std::back_inserter(text), "+ {} {}\n", time, voltage);
      last = time;
    }
    fmt::format_to(std::back_inserter(text), "+ )\n.ends {}\n", name);
  }
  return text;
}

}  // namespace softland
