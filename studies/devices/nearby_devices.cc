#include "studies/devices/nearby_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/require.h"

namespace softland {
namespace {

// Returns the typical size of a varied quantity, of which the step of finite differences is a share [SI unit, or factor].
double size_of(const SpreadVariable& variable, double value) {
  double size = variable.is_added ? std::numeric_limits<double>::infinity() : std::abs(value);
  for (const VariedKey& key : variable.keys) {
    if (variable.is_added && key.nominal != 0) size = std::min(size, std::abs(key.nominal / key.weight));
  }
  return size > 0 && std::isfinite(size) ? size : variable.distribution.standard_deviation();
}

}  // namespace

NearbyDevices::NearbyDevices(const PreparedScene& nominal, const EnsembleDrive& drive) : NearbyDevices(nominal) {
  drive_ = &drive;
  known_ = drive.known.without_errors();
  const Calibration& calibration = known_.calibration();
  constexpr double precision = 1e-11;  // relative precision of pull-in voltages for finite differences
  if (!calibration.is_empty()) meter_.emplace(nominal, MeasuredQuantities::of(calibration), precision);
}

NearbyDevices::NearbyDevices(const PreparedScene& nominal)
    : nominal_(nominal), ensemble_(nominal, 1), builder_(ensemble_), drives_(nominal) {
  std::vector<double> values;
  for (const SpreadVariable& v : variables()) values.push_back(v.nominal());
  move_to(values);
}

void NearbyDevices::move_to(const std::vector<double>& values) {
  values_ = values;
  steps_.clear();
  for (std::size_t i = 0; i < values.size(); ++i) steps_.push_back(SwitchSlopes::step * size_of(variables()[i], values[i]));
}

bool NearbyDevices::changes_switch(std::size_t i) const {
  const std::vector<VariedKey>& keys = variables()[i].keys;
  return std::any_of(keys.begin(), keys.end(), [](const VariedKey& key) { return !key.drive; });
}

// Returns the devices one step above and below the current device in varied quantity i. Throws InvalidInput if the values of
// one of them are impossible.
SwitchSlopes::Neighbours NearbyDevices::neighbours(std::size_t i) {
  Switch above = device_beside(i, 1), below = device_beside(i, -1);
  SwitchOptions finer = nominal_.quadrature;
  // Both neighbours need the same number of quadrature points: an additional point would look like a change of the device.
  while (above.quadrature().points() != below.quadrature().points()) {
    constexpr double little = 1.01;
    finer.points_per_length *= little;
    above = Switch(above.device(), finer, &nominal_.model);
    below = Switch(below.device(), finer, &nominal_.model);
  }
  const std::vector<VariedKey>& keys = variables()[i].keys;
  const auto is_of_contact = [](const VariedKey& key) {
    return key.drive || key.path == "gap.contact" || key.path.starts_with("contact.");
  };
  return {.above = std::move(above),
          .below = std::move(below),
          .distance = 2 * step(i),
          .acts_in_flight = !std::all_of(keys.begin(), keys.end(), is_of_contact)};
}

// Returns the drive signals of the device with these values of the varied quantities.
std::vector<Signal> NearbyDevices::signals_of(std::span<const double> values) {
  const std::vector<double> own(values.begin(), values.end());
  DeviceUnits units;
  if (meter_) {
    const SampledDevice sampled = builder_.device(own);
    require(sampled.model.has_value(), sampled.refusal);
    units = known_.of(meter_->exact(*sampled.model), 0, 0);
    require(units.are_known(), not_measured);
  }
  return drives_.differ(units) ? drives_.signals(drive_->waveforms, units, own) : nominal_.applied(drive_->waveforms);
}

// True if varied quantity i changes the drives of a device.
bool NearbyDevices::changes_signals(std::size_t i) const {
  const std::vector<VariedKey>& keys = variables()[i].keys;
  return meter_ || std::any_of(keys.begin(), keys.end(), [](const VariedKey& key) { return key.drive.has_value(); });
}

// True if the drive signals one step below and above the current device in quantity i have as many pieces as those of the
// current device. Otherwise the signals have no derivative: an edge of a waveform appears, disappears or becomes the first edge
// of the time axis.
bool NearbyDevices::keeps_pieces(std::size_t i) {
  const auto pieces = [&](double side) {
    std::vector<std::size_t> counts;
    for (const Signal& signal : signals_of(beside(i, side))) counts.push_back(signal.pieces().size());
    return counts;
  };
  return pieces(-1) == pieces(0) && pieces(0) == pieces(1);
}

std::vector<double> NearbyDevices::beside(std::size_t i, double side) const {
  std::vector<double> values = values_;
  values[i] += side * steps_[i];
  return values;
}

Switch NearbyDevices::device_at(std::vector<double> values) {
  SampledDevice sampled = builder_.device(std::move(values));
  require(sampled.model.has_value(), sampled.refusal);
  return std::move(*sampled.model);
}

DeviceChanges NearbyDevices::changes(const Switch& model, std::vector<std::string>& why_none, const Progress& progress) {
  std::vector<std::optional<SwitchSlopes::Neighbours>> neighbours(variables().size());
  std::vector<double> lower = values_, upper = lower;
  for (std::size_t i = 0; i < neighbours.size() && !progress.stopped(); ++i) {
    progress.tell("derivatives", static_cast<double>(i) / static_cast<double>(neighbours.size()));
    try {
      if (changes_switch(i)) neighbours[i] = this->neighbours(i);
      if (!changes_signals(i)) continue;
      if (keeps_pieces(i)) {
        lower[i] -= step(i) / SignalSlopes::share_of_range;
        upper[i] += step(i) / SignalSlopes::share_of_range;
      } else {
        why_none[i] = other_pieces;
      }
    } catch (const InvalidInput& error) {
      why_none[i] = fmt::format("a device next to the nominal one is impossible: {}", error.what());
    }
    if (!why_none[i].empty()) neighbours[i].reset();
  }
  return {.of_switch = SwitchSlopes(model, std::move(neighbours)),
          .of_signals = SignalSlopes([&](std::span<const double> x) { return signals_of(x); }, values_, lower, upper)};
}

SwitchSlopes NearbyDevices::changes_of_switch(const Switch& model) {
  std::vector<std::optional<SwitchSlopes::Neighbours>> neighbours(variables().size());
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    if (changes_switch(i)) neighbours[i] = this->neighbours(i);
  }
  return SwitchSlopes(model, std::move(neighbours));
}

SignalSlopes NearbyDevices::changes_of_signals() {
  std::vector<double> lower = values_, upper = lower;
  for (std::size_t i = 0; i < lower.size(); ++i) {
    if (!changes_signals(i) || !keeps_pieces(i)) continue;
    lower[i] -= step(i) / SignalSlopes::share_of_range;
    upper[i] += step(i) / SignalSlopes::share_of_range;
  }
  return SignalSlopes([&](std::span<const double> x) { return signals_of(x); }, values_, lower, upper);
}

}  // namespace softland
