// The devices on either side of one device, a small step apart in each varied quantity, from which derivatives by these
// quantities are computed.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/watch.h"
#include "model/switch_slopes.h"
#include "studies/devices/ensemble.h"
#include "waveforms/signal_slopes.h"

namespace softland {

/// Changes of a switch and of its drives by the varied quantities.
struct DeviceChanges {
  SwitchSlopes of_switch;
  SignalSlopes of_signals;
};

class NearbyDevices {
 public:
  static constexpr const char* other_pieces = "the waveforms have other pieces on either side of its nominal value";

  /// Starts at the nominal device of a scene whose [spread] has no jitter, under this drive. Keeps references.
  NearbyDevices(const PreparedScene& nominal, const EnsembleDrive& drive);

  /// The same without a drive yet: call drive_by() before asking for signals.
  explicit NearbyDevices(const PreparedScene& nominal);
  NearbyDevices(const NearbyDevices&) = delete;
  NearbyDevices& operator=(const NearbyDevices&) = delete;
  /// Takes another drive, of the same calibration. Keeps a reference.
  void drive_by(const EnsembleDrive& drive) { drive_ = &drive; }

  /// Moves to the device with these values, as DeviceSpread::to_values.
  void move_to(const std::vector<double>& values);
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  /// The device there. Throws InvalidInput if it cannot be described.
  [[nodiscard]] Switch device() { return device_at(values_); }
  /// The change of a quantity to either side [unit of its value].
  [[nodiscard]] double step(std::size_t i) const { return steps_[i]; }
  /// The device a step above it in one quantity (`side` 1) or below (-1). Throws as device() does.
  [[nodiscard]] Switch device_beside(std::size_t i, double side) { return device_at(beside(i, side)); }
  /// The signals of the device, and of those beside it.
  [[nodiscard]] std::vector<Signal> signals() { return signals_of(values_); }
  [[nodiscard]] std::vector<Signal> signals_beside(std::size_t i, double side) { return signals_of(beside(i, side)); }

  /// Changes of `model`, which is device(), and of its signals. Gives the reason for each quantity without derivatives, if that
  /// is empty.
  [[nodiscard]] DeviceChanges changes(const Switch& model, std::vector<std::string>& why_none, const Watch& watch = {});
  /// The same for the switch alone, and for the signals alone. Throw as device() does.
  [[nodiscard]] SwitchSlopes changes_of_switch(const Switch& model);
  [[nodiscard]] SignalSlopes changes_of_signals();
  /// The errors of the source of drive k on this device, except its jitter.
  [[nodiscard]] SourceErrors source_errors(std::size_t k) const { return drives_.errors(k, values_); }
  [[nodiscard]] SourceErrors source_errors_by(std::size_t k, std::size_t i) const { return drives_.errors_by(k, i); }

 private:
  [[nodiscard]] const std::vector<SpreadVariable>& variables() const { return nominal_.scene.spread.variables; }
  [[nodiscard]] bool changes_switch(std::size_t i) const;
  [[nodiscard]] SwitchSlopes::Neighbours neighbours(std::size_t i);
  [[nodiscard]] std::vector<Signal> signals_of(std::span<const double> values);
  [[nodiscard]] bool changes_signals(std::size_t i) const;
  [[nodiscard]] bool keeps_pieces(std::size_t i);
  [[nodiscard]] std::vector<double> beside(std::size_t i, double side) const;
  [[nodiscard]] Switch device_at(std::vector<double> values);

  const PreparedScene& nominal_;
  const EnsembleDrive* drive_ = nullptr;
  KnownUnits known_;
  Ensemble ensemble_;
  DeviceBuilder builder_;
  DeviceDrives drives_;
  std::optional<DeviceMeter> meter_;
  std::vector<double> values_, steps_;
};

}  // namespace softland
