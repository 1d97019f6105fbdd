// The neighbours of a device: each differs from the device by a small step in one varied quantity. Derivatives by the varied
// quantities are computed from these neighbours.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "model/switch_slopes.h"
#include "studies/devices/ensemble.h"
#include "waveforms/signal_slopes.h"

namespace softland {

/// Derivatives of a switch and of its drives by the varied quantities.
struct DeviceChanges {
  SwitchSlopes of_switch;
  SignalSlopes of_signals;
};

class NearbyDevices {
 public:
  static constexpr const char* other_pieces = "the waveforms have other pieces on either side of its nominal value";

  /// Starts at the nominal device of a scene under the set of waveforms `drive`. The scene's [spread] must not vary jitter.
  /// Keeps references to its arguments.
  NearbyDevices(const PreparedScene& nominal, const EnsembleDrive& drive);

  /// Starts at the nominal device without a set of waveforms: call drive_by() before a function that returns drive signals.
  explicit NearbyDevices(const PreparedScene& nominal);
  NearbyDevices(const NearbyDevices&) = delete;
  NearbyDevices& operator=(const NearbyDevices&) = delete;
  /// Replaces the set of waveforms by another one with the same calibration. Keeps a reference to `drive`.
  void drive_by(const EnsembleDrive& drive) { drive_ = &drive; }

  /// Selects the device with these values of the varied quantities (DeviceSpread::to_values) as the current device.
  void move_to(const std::vector<double>& values);
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  /// Returns the current device. Throws InvalidInput if its values are impossible.
  [[nodiscard]] Switch device() { return device_at(values_); }
  /// Returns the size of the finite-difference step in varied quantity i [unit of the quantity].
  [[nodiscard]] double step(std::size_t i) const { return steps_[i]; }
  /// Returns the device one step above the current device in quantity i (`side` 1) or below it (-1). Throws the exceptions of
  /// device().
  [[nodiscard]] Switch device_beside(std::size_t i, double side) { return device_at(beside(i, side)); }
  /// Return the drive signals of the current device, and of the device one step beside it in quantity i (`side` 1 or -1).
  [[nodiscard]] std::vector<Signal> signals() { return signals_of(values_); }
  [[nodiscard]] std::vector<Signal> signals_beside(std::size_t i, double side) { return signals_of(beside(i, side)); }

  /// Returns the derivatives of device(), which is `model`, and of its drive signals by the varied quantities. Writes the
  /// reason into `why_none` of each quantity that has no derivatives, unless that string already has a reason.
  [[nodiscard]] DeviceChanges changes(const Switch& model, std::vector<std::string>& why_none, const Progress& progress = {});
  /// Return the derivatives by the varied quantities of the switch alone, and of the drive signals alone. Both functions throw
  /// the exceptions of device().
  [[nodiscard]] SwitchSlopes changes_of_switch(const Switch& model);
  [[nodiscard]] SignalSlopes changes_of_signals();
  /// Returns the errors of the voltage source of drive k on the current device, except its jitter.
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
  MeasuredUnits known_;
  Ensemble ensemble_;
  DeviceBuilder builder_;
  DeviceDrives drives_;
  std::optional<PullInMeter> meter_;
  std::vector<double> values_, steps_;
};

}  // namespace softland
