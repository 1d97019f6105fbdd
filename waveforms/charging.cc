#include "waveforms/charging.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/require.h"

namespace softland {
namespace {

// Finds the time at which `function` changes its sign, by bisection between two times at which it has opposite signs.
template <class Function>
double sign_change(const Function& function, double low, double high) {
  constexpr int halvings = 50;
  const bool rises = function(high) > 0;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    ((function(middle) > 0) == rises ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

// Returns times that divide [begin, end] into intervals in which V^2 of a signal piece only rises or only falls: the times at
// which V or dV/dt changes its sign.
std::vector<double> turning_times(const SignalPiece& piece, double begin, double end, double resolving_step) {
  constexpr double fewest = 64, most = 1e6;  // limits of the number of samples of a curved piece
  std::vector<double> times{begin, end};
  const auto voltage = [&](double t) { return piece.voltage(t); };
  const auto rate = [&](double t) { return piece.rate(t); };
  const double looks = piece.is_straight() ? 1 : std::clamp(4 * (end - begin) / resolving_step, fewest, most);
  const auto count = static_cast<long>(std::ceil(looks));
  for (long i = 0; i < count; ++i) {
    const double low = begin + (end - begin) * static_cast<double>(i) / static_cast<double>(count);
    const double high = begin + (end - begin) * static_cast<double>(i + 1) / static_cast<double>(count);
    if (voltage(low) * voltage(high) < 0) times.push_back(sign_change(voltage, low, high));
    if (rate(low) * rate(high) < 0) times.push_back(sign_change(rate, low, high));
  }
  std::sort(times.begin(), times.end());
  return times;
}

}  // namespace

double charging(const Signal& signal, double end) {
  require(end >= 0 && std::isfinite(end), "the end of the charging must be finite and at least 0 s");
  double sum = 0, last = signal.before();
  const auto reach = [&](double volts) {
    sum += std::max(0.0, volts * volts - last * last) / 2;
    last = volts;
  };
  // A voltage jump across 0 V first discharges the capacitor, at no cost, and then charges it again from 0 V.
  const auto jump = [&](double volts) {
    if (last * volts < 0) reach(0);
    reach(volts);
  };
  const std::vector<SignalPiece>& pieces = signal.pieces();
  for (std::size_t i = 0; i < pieces.size() && pieces[i].begin <= end; ++i) {
    jump(signal.voltage(pieces[i].begin));
    const double until = i + 1 < pieces.size() ? std::min(end, pieces[i + 1].begin) : end;
    if (pieces[i].is_level()) continue;
    for (const double t : turning_times(pieces[i], pieces[i].begin, until, signal.resolving_step(pieces[i].begin)))
      reach(pieces[i].voltage(t));
  }
  return sum;
}

}  // namespace softland
