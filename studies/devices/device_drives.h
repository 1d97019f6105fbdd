// The drives of one device: the waveforms of the nominal device, scaled by factors that are measured on the device, with the
// errors of the device's sources (waveforms/source_errors.h). All drives of a device share one time axis. It begins at the
// first edge of any drive if jitter moves this edge before t = 0.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "studies/closing/prepared.h"
#include "waveforms/source_errors.h"

namespace softland {

/// Scale factors of a device relative to the nominal device, by which the voltages and times of its waveforms are multiplied.
struct DeviceUnits {
  double volts = 1, time = 1;
  double piezo = 1;  ///< factor for the voltages of a piezo, which do not scale with the pull-in voltage Vdp
  /// Derivative of ln(volts) by the measured closing time from which `volts` is computed [1/s]. It converts an error of the
  /// time into an error of the factor.
  double volts_by_time = 0;

  /// True if the voltage factors are finite numbers.
  [[nodiscard]] bool are_known() const { return std::isfinite(volts) && std::isfinite(piezo); }
};

/// Returns the waveforms, in the order of Switch::drives(), scaled by the factors of one device. Voltages before t = 0 are not
/// scaled, nor is the drive of a dispersion force. The voltages of a piezo have a separate factor, since they do not scale with
/// the pull-in voltage.
[[nodiscard]] std::vector<Waveform> in_units(const std::vector<Waveform>& waveforms, const Device& device,
                                             const DeviceUnits& units);

class DeviceDrives {
 public:
  /// Keeps a reference to `nominal`, whose [spread] lists the varied errors of the voltage sources.
  explicit DeviceDrives(const PreparedScene& nominal);

  /// True if a device with these scale factors has drive signals that differ from those of the nominal device.
  [[nodiscard]] bool differ(const DeviceUnits& units) const {
    return has_errors_ || units.volts != 1 || units.piezo != 1 || units.time != 1;
  }
  /// Returns the applied voltages of a device with these values of its varied quantities. `nominal` holds the waveforms of the
  /// nominal device, in the order of Switch::drives() [V].
  [[nodiscard]] std::vector<Signal> signals(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                                            const std::vector<double>& values) const;
  /// Returns the ratios of signals() to without_gains(), one per drive. None if the signals differ by more than a constant
  /// factor, because of scale factors of the device, offsets, delays or jitter.
  [[nodiscard]] std::optional<std::vector<double>> gains(const DeviceUnits& units, const std::vector<double>& values) const;
  /// Returns the applied voltages for the waveforms `nominal` (as in signals()), without scale factors and with sources whose
  /// gain is 1.
  [[nodiscard]] std::vector<Signal> without_gains(const std::vector<Waveform>& nominal) const;
  /// Returns the errors of the voltage source of drive k for these values of the varied quantities, except its jitter.
  [[nodiscard]] SourceErrors errors(std::size_t k, const std::vector<double>& values) const;
  /// Returns the derivatives of errors() by varied quantity i: the derivatives of gain, offset [V] and delay [s].
  [[nodiscard]] SourceErrors errors_by(std::size_t k, std::size_t i) const;
  /// A waveform for the scene of a device, with the gain, offset and delay of the drive's source.
  struct Written {
    Waveform waveform;
    SourceErrors errors = {};
  };
  /// Returns signals() as waveforms: of the same kind as the nominal waveform if possible, else as tables. A table is exact,
  /// except for a sine, which it approximates within 1e-4 of the peak up to the end of the simulated time. Varied errors of a
  /// source are part of the waveform. If the source samples the waveform, these errors act after the samples and are returned
  /// in `errors`, except a delay below 0, which is left out.
  [[nodiscard]] std::vector<Written> written(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                                             const std::vector<double>& values) const;
  /// True if the errors of a drive's source vary. `drive` is its index in Switch::drives().
  [[nodiscard]] bool has_errors(std::size_t drive) const { return !sources_[drive].empty(); }
  /// Returns the values of a device's varied quantities for display. The value of jitter is the random time of the first edge
  /// [s].
  [[nodiscard]] std::vector<double> shown(std::vector<double> values) const;

 private:
  /// A key of a varied quantity in [spread] that is an error of the voltage source of a drive.
  struct Source {
    std::size_t variable, key;  // indices of the varied quantity in [spread], and of the key among its keys
    DriveError error;
  };
  struct Driven;

  [[nodiscard]] double value(const Source& source, const std::vector<double>& values) const;
  [[nodiscard]] Driven driven(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                              const std::vector<double>& values) const;

  const PreparedScene* nominal_;
  std::vector<std::vector<Source>> sources_;  // varied errors of each drive's voltage source
  bool has_errors_ = false;
};

}  // namespace softland
