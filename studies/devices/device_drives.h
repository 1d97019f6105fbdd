// The drives of one device: the waveforms of the nominal one in its own units, with the errors of its sources (waveforms/
// source_errors.h). All drives of a device have one clock, which begins at the first edge of any of them where that is early.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "studies/closing/prepared.h"
#include "waveforms/source_errors.h"

namespace softland {

/// What is known of a device, over what holds for the nominal one: factors of the voltages and of the times of its drives.
struct DeviceUnits {
  double volts = 1, time = 1;
  double piezo = 1;  ///< of the voltages of a piezo, whose unit Vdp does not tell
  /// Of volts that are told by a closing time: by which part they change with it [1/s].
  double volts_by_time = 0;

  /// Whether there are such voltages.
  [[nodiscard]] bool are_known() const { return std::isfinite(volts) && std::isfinite(piezo); }
};

/// The waveforms, in the order of Switch::drives(), in the units of one device. What drives stand at before t = 0 stays what it
/// is: no measured unit and no error of a source changes it. The voltages of a piezo do not follow the pull-in
/// voltage, they have a factor of their own; that of a dispersion force follows nothing.
[[nodiscard]] std::vector<Waveform> in_units(const std::vector<Waveform>& waveforms, const Device& device,
                                             const DeviceUnits& units);

class DeviceDrives {
 public:
  /// Keeps a reference to `nominal`, whose [spread] says which errors there are.
  explicit DeviceDrives(const PreparedScene& nominal);

  /// Whether a device of these units has other drives than the nominal one.
  [[nodiscard]] bool differ(const DeviceUnits& units) const {
    return has_errors_ || units.volts != 1 || units.piezo != 1 || units.time != 1;
  }
  /// What a device gets from its sources, whose varying quantities have these values; `nominal` are the waveforms of the nominal
  /// device, in the order of Switch::drives() [V].
  [[nodiscard]] std::vector<Signal> signals(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                                            const std::vector<double>& values) const;
  /// The factors by which the drives of a device, as signals() has them, differ from those of one whose sources have a gain of 1,
  /// as without_gains() has them; none where more than factors differ, as measured units, offsets, delays and jitter make it.
  [[nodiscard]] std::optional<std::vector<double>> gains(const DeviceUnits& units, const std::vector<double>& values) const;
  /// The drives of a device in the units of the nominal one from sources with a gain of 1; `nominal` as for signals().
  [[nodiscard]] std::vector<Signal> without_gains(const std::vector<Waveform>& nominal) const;
  /// What the source of drive k does wrong where the varying quantities have these values, but for its jitter.
  [[nodiscard]] SourceErrors errors(std::size_t k, const std::vector<double>& values) const;
  /// The derivatives of these errors by varying quantity i: those of gain, offset [V] and delay [s].
  [[nodiscard]] SourceErrors errors_by(std::size_t k, std::size_t i) const;
  /// A waveform, and the gain, offset and delay that the scene of the device is to have beside it.
  struct Written {
    Waveform waveform;
    SourceErrors errors = {};
  };
  /// The same as waveforms: of the given family where that can express them, else a table, which is exact but for a sine,
  /// which its lines follow within 1e-4 of the peak up to the end of the window. Errors that vary stand in the waveform, but
  /// where the source samples it, which they come after: there a delay below 0 is left out.
  [[nodiscard]] std::vector<Written> written(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                                             const std::vector<double>& values) const;
  /// Whether the errors of that drive, in the order of Switch::drives(), vary.
  [[nodiscard]] bool has_errors(std::size_t drive) const { return !sources_[drive].empty(); }
  /// The values of the varying quantities for people: of jitter, the time that is drawn for the first edge [s].
  [[nodiscard]] std::vector<double> shown(std::vector<double> values) const;

 private:
  /// A variable of the spread that is an error of a drive.
  struct Source {
    std::size_t variable, key;  // of the variable
    DriveError error;
  };
  struct Driven;

  [[nodiscard]] double value(const Source& source, const std::vector<double>& values) const;
  [[nodiscard]] Driven driven(const std::vector<Waveform>& nominal, const DeviceUnits& units,
                              const std::vector<double>& values) const;

  const PreparedScene* nominal_;
  std::vector<std::vector<Source>> sources_;  // of each drive
  bool has_errors_ = false;
};

}  // namespace softland
