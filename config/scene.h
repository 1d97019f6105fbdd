// Reads and checks a scene file, which describes a switch, its drives and the simulation, and converts all quantities to SI
// units, in which all other code computes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "config/spread.h"
#include "config/units.h"
#include "model/device.h"
#include "objectives/metrics.h"
#include "waveforms/driver.h"
#include "waveforms/limits.h"
#include "waveforms/source_errors.h"
#include "waveforms/waveform.h"

namespace softland {

/// The value of a key: a number in the key's SI unit, a flag, a whole number or a choice.
using SceneValue = std::variant<double, bool, int, std::string>;

/// The text of a scene with the line of every key, and the changes made to the scene on the command line. Copies are
/// independent.
class SceneFile {
 public:
  /// Reads a scene file. Throws InvalidInput (file, line, column, what) when the file cannot be read or is not TOML.
  static SceneFile load(const std::filesystem::path& path);
  /// Reads the text of a scene. `name` is the name of the file in messages; relative paths inside the scene are taken from
  /// `directory`.
  static SceneFile parse(std::string_view text, std::string name, std::filesystem::path directory = ".");

  /// Applies one assignment of the option `--set key.path=value` to the scene. The value is read as TOML; text that is not TOML
  /// is a string. The function may create sections. If a quantity can be given by one of two keys (accuracy or tolerance), the
  /// other key is removed. Messages about the key name the option ("--set gap.contact=...") instead of file and line. Throws
  /// InvalidInput for an invalid assignment.
  void set(std::string_view assignment);
  /// Sets a key of the scene to a value; a number is in the SI unit of the key. Throws std::logic_error if the schema has no
  /// such key.
  void assign(const std::string& path, const SceneValue& value);
  /// Sets a key of the scene that holds one quantity, or element number `element` (counted from 1) of a key that holds a list.
  /// Throws std::logic_error for a key or an element that does not exist.
  void assign(const std::string& path, const Quantity& value, std::size_t element = 0);
  /// Adds a contact whose law is defined by a program: an OwnContact (model/contact/own.h). The scene must not have [contact];
  /// read_scene() refuses a scene with both. Scenes made from this file have the contact as well, but text() and json() throw
  /// InvalidInput, because a file cannot express the law.
  void add_contact(const Contact& contact);
  /// Removes a section or a key from the scene, if it exists.
  void erase(const std::string& path);
  /// Replaces [waveform.DRIVE] by this waveform in volts and seconds, with digits that read back to the same bits. The rows of
  /// a Table are written into the scene. The keys before and before_state keep their values. Throws InvalidInput for a waveform
  /// whose parameters are invalid, such as times in the wrong order.
  void set_waveform(const std::string& drive, const Waveform& given);

  /// Removes the line numbers of all keys of the scene, so that messages give the name of the scene only: a program wrote the
  /// text, and the user has no file with these lines.
  void forget_places();

  /// Returns a copy with `name` as the name of the file in messages. The text is written and read again, so that line numbers
  /// are those of the written text; a contact from add_contact() is copied.
  [[nodiscard]] SceneFile again(std::string name) const;
  /// Returns the scene as TOML text: parsing the text again gives the same scene, digit for digit. Throws InvalidInput for a
  /// scene to which a contact was added.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] nlohmann::json json() const;
  /// Returns the value at a key path as text: a string as it is, another value as JSON, and for a section the value of its key
  /// `model`, if any. Returns none if the scene does not contain the path.
  [[nodiscard]] std::optional<std::string> written(const std::string& path) const;
  /// Returns the keys that the scene contains in a section, in the order of the text.
  [[nodiscard]] std::vector<std::string> keys(const std::string& section) const;
  [[nodiscard]] const std::string& name() const;
  /// Throws InvalidInput about a key of the scene such as "structure.length", with file and line (or option), key, value and
  /// rule. The message is about the section if the scene does not contain the key.
  [[noreturn]] void refuse(const std::string& path, std::string_view rule) const;

  struct Impl;
  [[nodiscard]] const Impl& impl() const { return *impl_; }
  SceneFile(const SceneFile&);
  SceneFile& operator=(const SceneFile&);
  SceneFile(SceneFile&&) noexcept;
  SceneFile& operator=(SceneFile&&) noexcept;
  ~SceneFile();

 private:
  explicit SceneFile(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The pull-in voltages of an electrode. Scenes may give voltages as multiples of the static (Vsp) and the dynamic (Vdp)
/// pull-in voltage.
struct PullInVoltages {
  double static_pull_in = 0;   ///< Vsp, the static pull-in voltage [V]
  double dynamic_pull_in = 0;  ///< Vdp, the dynamic pull-in voltage [V]
};

/// Largest voltage in a search for an electrode without [driver], as a multiple of the larger of its pull-in voltages Vsp and
/// Vdp.
inline constexpr double default_max_voltage = 1.5;
[[nodiscard]] inline double default_limit(const PullInVoltages& pull_in) {
  return default_max_voltage * std::max(pull_in.static_pull_in, pull_in.dynamic_pull_in);
}
/// Returns the default voltage limit of an electrode as text, for example "1.5 Vsp".
[[nodiscard]] std::string default_limit_prose(const PullInVoltages& pull_in);

/// The names of the piezo and of the dispersion force among the drives.
inline constexpr std::string_view piezo_drive = "piezo", dispersion_drive = "dispersion";

/// One drive of a switch: an electrode or the piezo, with its voltages. The dispersion force is a drive as well: its "voltage"
/// is the factor on the force minus 1, so that 0 leaves the force unchanged, as 0 V leaves an electrode without actuation.
struct Drive {
  std::string name = {};                  ///< name of the drive: an electrode, piezo_drive or dispersion_drive
  std::optional<Waveform> waveform = {};  ///< voltage waveform of the drive; none: 0 V at all times
  std::optional<double> before = {};      ///< voltage before t = 0 that the scene gives [V]; none: 0 V
  bool begins_closed = false;             ///< true when the drive's key before_state is closed: see Scene::begins_closed
  /// Limits of the source; none if unlimited. Without given limits, electrodes of known Vdp have [0, default_limit()].
  std::optional<DriverLimits> limits = {};
  DriverModel source = {};               ///< voltage source, ideal by default; prepare() adds the switch's capacitance as load
  std::optional<double> amplifier = {};  ///< gain of an amplifier after the source; all voltages here are those after it
  SourceErrors errors = {};              ///< errors of the source: gain, offset and delay

  [[nodiscard]] double hold_level() const;                                  ///< voltage that the waveform keeps at its end [V]
  [[nodiscard]] double value_before() const { return before.value_or(0); }  ///< voltage of the drive before t = 0 [V]
};

/// Returns the names of the drives of a device, in the order of Switch::drives().
[[nodiscard]] std::vector<std::string> drive_names(const Device& device);

/// The drives (electrodes, piezo, dispersion force) of a switch, in the order of Switch::drives().
class Drives {
 public:
  Drives() = default;
  explicit Drives(std::vector<Drive> drives) : drives_(std::move(drives)) {}

  [[nodiscard]] std::size_t size() const { return drives_.size(); }
  [[nodiscard]] auto begin() const { return drives_.begin(); }
  [[nodiscard]] auto end() const { return drives_.end(); }
  [[nodiscard]] auto begin() { return drives_.begin(); }
  [[nodiscard]] auto end() { return drives_.end(); }
  [[nodiscard]] const Drive& operator[](std::size_t k) const { return drives_[k]; }
  [[nodiscard]] Drive& operator[](std::size_t k) { return drives_[k]; }
  /// Returns the drive of this name; null if the switch has no such drive.
  [[nodiscard]] const Drive* find(std::string_view name) const;
  /// Returns the drive of this name. Throws InvalidInput if the switch has no such drive.
  [[nodiscard]] const Drive& at(std::string_view name) const { return drives_[place(name)]; }
  [[nodiscard]] Drive& at(std::string_view name) { return drives_[place(name)]; }
  /// Returns the index of a drive in Switch::drives(). Throws InvalidInput if the switch has no such drive.
  [[nodiscard]] std::size_t place(std::string_view name) const;
  /// Returns the drives of these names, in the order of the names. Throws InvalidInput if the switch lacks one of the drives.
  [[nodiscard]] Drives of(const std::vector<std::string>& names) const;
  /// Returns the waveforms of the drives by name of the drive; a drive without a waveform is left out.
  [[nodiscard]] DriveWaveforms waveforms() const;
  /// Returns the voltages before t = 0 that the scene gives, by name of the drive [V].
  [[nodiscard]] std::map<std::string, double> before() const;

 private:
  std::vector<Drive> drives_;
};

struct SimulateOptions {
  double duration = 0;     ///< simulated time [s]; 0: six periods of mode 1, or longer if gas slows the closing
  double accuracy = 1e-6;  ///< target relative error of initial contact time, impact velocity and highest rebound
  double tolerance = 0;    ///< relative tolerance of the integrator; 0: derived from accuracy
  double open_at = std::numeric_limits<double>::quiet_NaN();  ///< time of the command to open [s]; NaN: see open_command()
  bool automatic_effects = false;  ///< true to leave physical effects (force laws) out of the model: see effects_tolerance
  /// An effect stays in the model if it changes first contact time, impact velocity or highest rebound by more than this share.
  double effects_tolerance = 1e-3;
};

/// The per-device calibration: figures measured on every device before actuation. They scale the waveform of the device in
/// voltage and time: V(t) = Vdp f(t f_1), or V(t) = f(t f_1) / p for a piezo. f is the common dimensionless waveform, f_1 the
/// device's first frequency, and p the deflection by the piezo per volt over the contact gap. The waveform in the scene is that
/// of the nominal device.
struct Calibration {
  /// Relative standard deviation of the measured Vdp (dynamic pull-in voltage) and of the measured frequency; none where the
  /// quantity is not measured on every device.
  std::optional<double> pull_in_error = {}, frequency_error = {};
  /// Relative standard deviation of the measured response of a piezo: the static deflection of the contact point per volt,
  /// divided by the contact gap. None where it is not measured.
  std::optional<double> piezo_error = {};
  /// Standard deviation of the measured closing time of a step to closing_step times the nominal Vdp [s]; none where it is not
  /// measured. The closing time gives the scale of the voltages, and is never measured together with Vdp.
  std::optional<double> time_error = {};
  /// Number of classes into which the devices are sorted by the measured values. All devices of a class use one waveform; none
  /// if every device has its own.
  std::optional<int> classes = {};

  [[nodiscard]] bool is_empty() const { return !pull_in_error && !frequency_error && !piezo_error && !time_error; }
};
/// Names of the calibration measurements in a scene.
inline constexpr std::string_view measured_pull_in = "Vdp", measured_frequency = "frequency", measured_piezo = "piezo",
                                  measured_time = "time";
inline constexpr std::array measurement_names{measured_pull_in, measured_frequency, measured_piezo, measured_time};
/// Voltage of the step whose closing time is measured, as a multiple of the nominal Vdp. The switch closes slowly under so low
/// a voltage, so that the time depends on the same properties of the device as a closing with a soft impact.
inline constexpr double closing_step = 1.2;
/// Default standard deviation of a measured closing time [s]: typical timing error of a generator and an oscilloscope.
inline constexpr double usual_time_error = 50e-9;
inline constexpr int most_classes = 256;
namespace internal {
inline constexpr std::string_view classes_key = "classes";
}

struct Scene {
  std::string title;
  Device device;
  SimulateOptions simulate;
  /// True for modes = "auto": studies/closing/auto_modes.h chooses the number of modes; read_scene() sets the default number.
  bool auto_modes = false;
  MetricsOptions metrics;
  DeviceSpread spread;
  Calibration calibration;
  /// True if simulations begin in the closed equilibrium under the drives' voltages before t = 0, instead of the open
  /// equilibrium.
  bool begins_closed = false;
  /// Names of the electrodes whose waveform or voltage limits are in multiples of the pull-in voltages Vsp or Vdp.
  std::vector<std::string> need_pull_in;
  /// Names in need_pull_in of the electrodes of which only the voltage limits are in multiples of Vsp or Vdp.
  std::vector<std::string> limits_in_pull_in = {};
  /// Constant voltage of each drive while the pull-in voltages of another drive are computed, in the order of Switch::drives().
  /// It is the hold voltage if this does not depend on Vsp or Vdp, otherwise 0 V; for the dispersion force, the hold level of
  /// the factor on the force minus 1.
  std::vector<double> standing;
  std::vector<std::string> file_notes = {};  ///< notes for the user on files of instruments, one line each
  std::vector<std::string> warnings;
  SceneFile file;

  /// Returns waveforms and limits of all drives in volts. `pull_in` must hold every electrode of need_pull_in; an electrode
  /// that `pull_in` lacks has no default voltage limit. Throws InvalidInput for a waveform with invalid parameters or outside
  /// the limits of its source.
  [[nodiscard]] Drives drives(const std::map<std::string, PullInVoltages>& pull_in) const;
};

/// Reads and checks a scene, including its waveforms (except what needs the pull-in voltages). Throws InvalidInput whose
/// message has file, line, key path, value, rule and, for an unknown key, the nearest valid key.
[[nodiscard]] Scene read_scene(const SceneFile& file);

/// Returns the scene with every default written out and every voltage in volts. A value that the simulation chooses, such as
/// simulate.duration if not given, is not written. Throws InvalidInput as Scene::drives() does. Messages about the result name
/// the file "NAME (resolved)", because its lines differ from those of the file.
[[nodiscard]] SceneFile resolved(const Scene& scene, const std::map<std::string, PullInVoltages>& pull_in);

/// Returns the canonical form of a scene: every default is written out, quantities are in SI units or multiples of pull-in
/// voltages, and names of files are replaced by their content. Two files of the same scene have the same canonical text.
/// Messages about the result give `name` without a line. Throws InvalidInput as read_scene() does.
[[nodiscard]] SceneFile canonical(const SceneFile& file, const std::string& name);

}  // namespace softland
