#include "waveforms/own_waveform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/require.h"

namespace softland {
namespace {

constexpr int most_halvings = 40;
// Points within a signal piece, from 0 at its beginning to 1 at its end. A cubic interpolates the user's waveform at `nodes`,
// the extreme points of the Chebyshev polynomial of degree 3; the error of the cubic is checked at `checks`.
constexpr std::array nodes{0.0, 0.25, 0.75, 1.0};
constexpr std::array checks{0.1, 0.5, 0.9};

// Returns the coefficients, in rising order, of the cubic that has four voltages at the `nodes`. Its argument is the position
// in the signal piece, from 0 to 1.
std::array<double, 4> cubic_through(std::array<double, 4> values) {
  for (std::size_t order = 1; order < 4; ++order) {
    for (std::size_t k = 3; k >= order; --k) values[k] = (values[k] - values[k - 1]) / (nodes[k] - nodes[k - order]);
  }
  std::array<double, 4> cubic{values[3], 0, 0, 0};
  for (std::size_t k = 3; k-- > 0;) {
    for (std::size_t power = 3; power > 0; --power) cubic[power] = cubic[power - 1] - nodes[k] * cubic[power];
    cubic[0] = values[k] - nodes[k] * cubic[0];
  }
  return cubic;
}

double at(const std::array<double, 4>& c, double part) { return c[0] + part * (c[1] + part * (c[2] + part * c[3])); }

// Converts a user's own waveform to a signal: cubic pieces that approximate its voltage.
class Following {
 public:
  explicit Following(const Own& own) : own_(own) {}

  std::vector<SignalPiece> pieces() {
    const std::vector<double> times = breakpoints();
    for (std::size_t k = 0; k + 1 < times.size(); ++k) see(times[k], times[k + 1]);
    const double held = voltage(times.back());
    largest_ = std::max(largest_, std::abs(held));
    for (std::size_t k = 0; k + 1 < times.size(); ++k) {
      // At a jump, voltage(end) is the voltage after the jump; the cubics of the interval must end on the voltage just before
      // it.
      constexpr double rounding = 1e-12;
      const double end = times[k + 1], before = voltage(std::nextafter(end, times[k])), after = voltage(end);
      const double ends_on = std::abs(after - before) > rounding * largest_ ? before : after;
      follow([&](double time) { return time < end ? voltage(time) : ends_on; }, times[k], end, 0);
    }
    pieces_.push_back({.begin = times.back(), .value = held});
    return std::move(pieces_);
  }

 private:
  [[nodiscard]] std::string named(const std::string& what) const { return described(own_) + ": " + what; }

  [[nodiscard]] double voltage(double time) const {
    const double volts = own_.waveform->voltage(time, own_.x);
    require(std::isfinite(volts),
            [&] { return named(fmt::format("the voltage at {} s is {}; it must be finite", time, volts)); });
    return volts;
  }

  [[nodiscard]] std::vector<double> breakpoints() const {
    std::vector<double> times{0};
    const std::vector<double> given = own_.waveform->breakpoints(own_.x);
    if (given.empty()) check_constant();
    for (const double time : given) {
      require(std::isfinite(time) && time >= times.back(), [&] {
        return named(fmt::format("its breakpoint at {} s follows that at {} s; breakpoints must be finite and increase from 0",
                                 time, times.back()));
      });
      if (times.size() > 1 && internal::coincide(time, times.back())) times.pop_back();
      if (time > times.back()) times.push_back(time);
    }
    return times;
  }

  // Checks a user's waveform without breakpoints: its voltage must be constant and not 0 V.
  void check_constant() const {
    constexpr double first = 1e-12, last = 1e3;  // range of times at which the voltage is compared to that at t = 0 [s]
    constexpr int looks = 300;
    const double begin = voltage(0);
    double when = 0;
    for (int k = 0; k <= looks && when == 0; ++k) {
      const double time = first * std::pow(last / first, static_cast<double>(k) / looks);
      if (voltage(time) != begin) when = time;
    }
    require(begin != 0 && when == 0, [&] {
      return named(
          fmt::format("it has no breakpoints, so that it would keep its voltage at t = 0 s, {} V{}; "
                      "breakpoints are the times at which it kinks or jumps, and the last one is its end",
                      begin, when > 0 ? fmt::format(", and it is {} V at {:.3g} s", voltage(when), when) : ""));
    });
  }

  // Updates the largest absolute voltage of the user's waveform, the scale of the accuracy, by samples in an interval.
  void see(double begin, double end) {
    constexpr int instants = 64;
    for (int k = 0; k < instants; ++k)
      largest_ = std::max(largest_, std::abs(voltage(std::lerp(begin, end, (k + 0.5) / instants))));
  }

  template <class Voltage>
  void follow(const Voltage& until, double begin, double end, int halvings) {
    const double duration = end - begin;
    std::array<double, 4> values{};
    for (std::size_t k = 0; k < nodes.size(); ++k) values[k] = until(k + 1 < nodes.size() ? begin + nodes[k] * duration : end);
    const std::array<double, 4> cubic = cubic_through(values);
    double missed = 0, bent = 0;
    for (const double part : checks) {
      const double volts = until(begin + part * duration);
      missed = std::max(missed, std::abs(volts - at(cubic, part)));
      bent = std::max(bent, std::abs(volts - std::lerp(values.front(), values.back(), part)));
    }
    for (std::size_t k = 1; k + 1 < nodes.size(); ++k)
      bent = std::max(bent, std::abs(values[k] - std::lerp(values.front(), values.back(), nodes[k])));
    constexpr double rounding = 1e-14;
    if (!(bent > rounding * largest_)) {
      pieces_.push_back({.begin = begin, .value = values.front(), .slope = (values.back() - values.front()) / duration});
    } else if (!(missed > own_waveform_accuracy * largest_)) {
      pieces_.push_back({.begin = begin, .value = cubic[0], .slope = cubic[1] / duration});
      const double squared = duration * duration;
      pieces_.back().terms.push_back({.cosine = {0, 0, cubic[2] / squared, cubic[3] / (squared * duration)}});
    } else {
      const double middle = begin + duration / 2;
      require(halvings < most_halvings && begin < middle && middle < end && pieces_.size() < most_own_pieces, [&] {
        return named(fmt::format("it is not smooth at {:.9g} s: it must have a breakpoint at every kink or jump", middle));
      });
      follow(until, begin, middle, halvings + 1);
      follow(until, middle, end, halvings + 1);
    }
  }

  const Own& own_;
  double largest_ = 0;  // largest absolute voltage of the user's waveform [V]
  std::vector<SignalPiece> pieces_;
};

void check(const Own& own) {
  require(own.waveform != nullptr, "an own waveform is null");
  const std::size_t due = own.waveform->parameters().size();
  require(own.x.size() == due,
          [&] { return fmt::format("{}: has {} parameters, but {} values are given", described(own), due, own.x.size()); });
}

}  // namespace

std::string described(const Own& own) {
  return fmt::format("the own waveform '{}'", own.waveform ? own.waveform->name() : std::string_view("null"));
}

Own own(std::shared_ptr<const OwnWaveform> waveform) {
  Own made{.waveform = std::move(waveform)};
  require(made.waveform != nullptr, "an own waveform is null");
  for (const OwnParameter& p : made.waveform->parameters()) {
    require(!p.name.empty() && std::isfinite(p.lower) && std::isfinite(p.upper) && p.lower <= p.start && p.start <= p.upper, [&] {
      return fmt::format(
          "{}: its parameter '{}' from {} to {} begins at {}; "
          "it must have a name, and begin within finite bounds",
          described(made), p.name, p.lower, p.upper, p.start);
    });
    made.x.push_back(p.start);
  }
  return made;
}

Signal signal(const Own& own, double before) {
  check(own);
  std::vector<SignalPiece> pieces = Following(own).pieces();
  for (SignalPiece& piece : pieces) {
    piece.begin *= own.time;
    piece.value *= own.volts;
    piece.slope *= own.volts / own.time;
    double power = own.volts;
    for (SignalTerm& term : piece.terms) {
      for (double& coefficient : term.cosine) coefficient *= std::exchange(power, power / own.time);
    }
  }
  return Signal(std::move(pieces), before);
}

}  // namespace softland
