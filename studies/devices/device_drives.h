// The drives of one device: the waveforms of the nominal one in its own units, with the errors of its sources (waveforms/
// source_errors.h). All drives of a device have one clock, which begins at the first edge of any of them if that is early.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "studies/closing/prepared.h"
#include "waveforms/source_errors.h"

namespace softland {

/// Known units of a device, over those of the nominal one: factors of the voltages and of the times of its drives.
struct DeviceUnits {
  double volts = 1, time = 1;
  double piezo = 1;  ///< factor of a piezo's voltages, whose unit does not follow from Vdp
  /// Relative change of volts that follow from a closing time, by that time [1/s].
  double volts_by_time = 0;

  /// True if the units are known.
  [[nodiscard]] bool are_known() const { return std::isfinite(volts) && std::isfinite(piezo); }
};

/// Returns the waveforms, in the order of Switch::drives(), in the units of one device. Voltages before t = 0 stay: no measured
/// unit and no error of a source changes them. The voltages of a piezo do not follow the pull-in voltage, they have a factor of
/// their own; that of a dispersion force follows nothing.
[[nodiscard]] std::vector<Waveform> in_units(const std::vector<Waveform>& waveforms, const Device& device,
                                             const DeviceUnits& units);

class DeviceDrives {
 public:
  /// Keeps a reference to `nominal`, whose [spread] lists the errors.
  explicit DeviceDrives(const PreparedScene& nominal);

  /// True if a device of these units has other drives than the nominal one.
  [[nodiscard]] bool differ(const DeviceUnits& units) const {
    return has_errors_ || units.volts != 1 || units.piezo != 1 || units.time != 1;
  }
  /// The outputs of a device's sources for these values of its varied quantities; `nominal` are the waveforms of the nominal
  /// device, in the order of Switch::drives() [V].
  [[nodiscard]] std::vector<Signal> signals(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                                            const std::vector<double>& values) const;
  /// The factors of the drives of a device, as in signals(), over those of a device whose sources have a gain of 1, as in
  /// without_gains(). None if more than factors differ, as with measured units, offsets, delays and jitter.
  [[nodiscard]] std::optional<std::vector<double>> gains(const DeviceUnits& units, const std::vector<double>& values) const;
  /// The drives of a device in the units of the nominal one from sources with a gain of 1; `nominal` as for signals().
  [[nodiscard]] std::vector<Signal> without_gains(const std::vector<Waveform>& nominal) const;
  /// The errors of the source of drive k for these values of the varied quantities, except its jitter.
  [[nodiscard]] SourceErrors errors(std::size_t k, const std::vector<double>& values) const;
  /// The derivatives of these errors by varied quantity i: those of gain, offset [V] and delay [s].
  [[nodiscard]] SourceErrors errors_by(std::size_t k, std::size_t i) const;
  /// A waveform, and the gain, offset and delay that belong to it in the scene of the device.
  struct Written {
    Waveform waveform;
    SourceErrors errors = {};
  };
  /// The same as waveforms: of the given family if that can express them, else a table. A table is exact except for a sine,
  /// which its lines follow within 1e-4 of the peak up to the end of the window. Varied errors stand in the waveform, but not
  /// if the source samples it: they act after the samples there, and a delay below 0 is left out.
  [[nodiscard]] std::vector<Written> written(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                                             const std::vector<double>& values) const;
  /// True if the errors of that drive, in the order of Switch::drives(), vary.
  [[nodiscard]] bool has_errors(std::size_t drive) const { return !sources_[drive].empty(); }
  /// The values of the varied quantities for display: for jitter, the time that is drawn for the first edge [s].
  [[nodiscard]] std::vector<double> shown(std::vector<double> values) const;

 private:
  /// A variable of the spread that is an error of a drive.
  struct Source {
    std::size_t variable, key;  // key of the variable
    DriveError error;
  };
  struct Driven;

  [[nodiscard]] double value(const Source& source, const std::vector<double>& values) const;
  [[nodiscard]] Driven driven(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                              const std::vector<double>& values) const;

  const PreparedScene* nominal_;
  std::vector<std::vector<Source>> sources_;  // sources of each drive
  bool has_errors_ = false;
};

}  // namespace softland
