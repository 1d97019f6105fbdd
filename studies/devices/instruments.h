// Readings of instruments on a device, and their derivatives by the varied quantities.
//
//   pull_in       static pull-in voltage, at which a slow ramp closes the switch (model/pull_in.h) [V]
//   release       voltage at which a slow ramp opens the switch again [V]
//   frequency     of small undamped vibrations of the open switch about its rest position at a level [Hz]
//   capacitance   of an electrode of the open switch at rest at a level [F]
//   closing_time  time at which the contact, or the connection of several, first closes under a step to a level, or under
//                 waveforms [s]
//   contact       times of the first edges of the contact's state under waveforms: contact, first opening, next contact [s]
//   position      of the contact point at given times, under waveforms: towards the contact, from a straight beam [m]
//   velocity      of the contact point at given times, under waveforms [m/s]
//
// Voltages and levels are commanded voltages. The voltage at the switch includes the gain and the offset of the source: V =
// gain * commanded + offset. The other drives are at their bias (bias_of()), or at 0 V for frequencies and capacitances. `fit`
// and `calibrate` use the same readings.
//
// Derivatives of the first four readings come from model/static_slopes.h, those of the closing time from
// model/linearized_closing.h. The other readings have no exact derivatives; finite differences between neighbouring closings
// replace them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "base/choice.h"
#include "studies/devices/nearby_devices.h"

namespace softland {

enum class Measurable { pull_in, release, frequency, capacitance, closing_time, contact, position, velocity };

struct MeasurableRow {
  Measurable value;
  std::string_view name;
  std::string_view unit;   ///< SI unit of the reading
  std::string_view words;  ///< name of the reading in sentences
};
inline constexpr std::array measurables{
    MeasurableRow{Measurable::pull_in, "pull_in", "V", "pull-in voltage"},
    MeasurableRow{Measurable::release, "release", "V", "release voltage"},
    MeasurableRow{Measurable::frequency, "frequency", "Hz", "resonance"},
    MeasurableRow{Measurable::capacitance, "capacitance", "F", "capacitance"},
    MeasurableRow{Measurable::closing_time, "closing_time", "s", "closing time"},
    MeasurableRow{Measurable::contact, "contact", "s", "contact record"},
    MeasurableRow{Measurable::position, "position", "m", "position"},
    MeasurableRow{Measurable::velocity, "velocity", "m/s", "velocity"},
};
static_assert(is_complete<measurables>());
[[nodiscard]] inline const MeasurableRow& row_of(Measurable what) { return measurables[static_cast<std::size_t>(what)]; }

struct Instrument {
  Measurable what = Measurable::pull_in;
  std::size_t drive = 0;                 ///< index in Switch::drives() of the drive whose voltage or capacitance is measured
  double level = 0;                      ///< commanded level of the drive [V]
  std::size_t mode = 0;                  ///< index of the mode whose frequency is read, from 0
  std::vector<Waveform> waveforms = {};  ///< commanded waveforms of every drive; empty for a step of `drive` to `level`
  std::vector<double> times = {};        ///< times at which a position or velocity is read [s]
  std::size_t edges = 1;                 ///< number of changes of the contact's state to read: contact, opening, next contact

  /// Returns the number of values that the instrument reads.
  [[nodiscard]] std::size_t size() const;
};

/// Reads one figure of a switch; `level` of the instrument is the applied voltage. The instrument must read a single number,
/// without waveforms. Returns NaN if the switch does not have the figure. `duration` is the time within which a step must close
/// the switch [s].
[[nodiscard]] double read(const Instrument& instrument, const Switch& model, Bias bias, double duration);

/// Reads the devices of a scene, each given by the values of its varied quantities.
class DeviceReader {
 public:
  /// The scene's [spread] must not vary jitter, which has no single value per device. Keeps a reference to `nominal`.
  explicit DeviceReader(const PreparedScene& nominal) : nominal_(nominal), near_(nominal) {}

  /// Selects the device with these values of the varied quantities (DeviceSpread::to_values). Returns false if that device is
  /// impossible.
  [[nodiscard]] bool move_to(const std::vector<double>& values);

  struct Reading {
    Eigen::VectorXd values;  ///< readings, one number per value of the instrument; NaN if the device does not have the figure
    /// Derivatives of the readings: a row for each value, a column for each varied quantity; empty if not requested.
    Eigen::MatrixXd slopes;
  };
  [[nodiscard]] Reading read(const Instrument& instrument, bool with_slopes);

 private:
  [[nodiscard]] std::vector<double> terminal_values(const Instrument& instrument) const;
  [[nodiscard]] SwitchSlopes& slopes();
  [[nodiscard]] Reading static_voltage(const Instrument& instrument, bool with_slopes);
  [[nodiscard]] Reading at_rest(const Instrument& instrument, bool with_slopes);
  [[nodiscard]] Reading touch(const Instrument& instrument, bool with_slopes);
  [[nodiscard]] Reading of_motion(const Instrument& instrument, bool with_slopes);
  [[nodiscard]] Eigen::VectorXd followed(const Instrument& instrument, const Switch& model,
                                         const std::vector<Signal>& signals) const;
  [[nodiscard]] double duration() const;
  [[nodiscard]] std::vector<Waveform> waveforms_of(const Instrument& instrument) const;

  const PreparedScene& nominal_;
  NearbyDevices near_;
  std::optional<Switch> model_;
  std::optional<SwitchSlopes> slopes_;
};

}  // namespace softland
