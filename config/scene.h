// A scene file, read and checked: the only place that sees text, units and keys. Everything behind it is plain SI.
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

/// What a key can be given: a number in the key's SI unit, a flag, a whole number or a choice.
using SceneValue = std::variant<double, bool, int, std::string>;

/// The text of a scene with its source positions, and the changes made to it on the command line. A value: copies are
/// independent.
class SceneFile {
 public:
  /// Throws InvalidInput (file, line, column, what) when the file cannot be read or is not TOML.
  static SceneFile load(const std::filesystem::path& path);
  /// `name` stands for the file in messages; relative paths inside the scene are taken from `directory`.
  static SceneFile parse(std::string_view text, std::string name, std::filesystem::path directory = ".");

  /// Applies one `--set key.path=value`. The value is read as TOML; bare text that is not TOML is a string. May create sections.
  /// Where a quantity can be given in one of two ways (accuracy or tolerance), the option takes the place of the other way. about
  /// such a key name the option ("--set gap.contact=...") instead of file and line. Throws InvalidInput for an assignment that is
  /// none.
  void set(std::string_view assignment);
  /// Gives a key this value; a number counts in the key's SI unit. Throws std::logic_error for a key that no scene has.
  void assign(const std::string& path, const SceneValue& value);
  /// Gives a key of one quantity this one, in the unit of its dimension; of a list its element number `element`, counted from 1.
  /// Throws std::logic_error for a key or an element that is not there to be given it.
  void assign(const std::string& path, const Quantity& value, std::size_t element = 0);
  /// Gives the switch a contact that no scene file can describe, whose model is an OwnContact (model/contact/own.h). The scene
  /// must have no [contact]: read_scene() refuses both. What is made of the file has that contact as well, but text() and json()
  /// throw InvalidInput, for they could not say it.
  void add_contact(const Contact& contact);
  /// Takes a section or a key out, if it is there.
  void erase(const std::string& path);
  /// Replaces [waveform.DRIVE] by this waveform in volts and seconds, with digits that read back to the same bits. The rows of a
  /// Table stand in the scene itself. What it stands at before t = 0, and in which state, stays as it is written. Throws
  /// InvalidInput for a waveform outside its family's rules.
  void set_waveform(const std::string& drive, const Waveform& given);

  /// Forgets where keys were written: messages about them then say the name of the file alone.
  void forget_places();

  /// The same scene, written as text and read again under another name, with the contact that was added.
  [[nodiscard]] SceneFile again(std::string name) const;
  /// The scene as TOML text: parsing it again gives the same scene, digit for digit. Throws InvalidInput where a contact was
  /// added.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] nlohmann::json json() const;
  /// What is written at a key path: text as it is, other values as JSON, of a section its model, if it says one. Nothing where
  /// the path is not written.
  [[nodiscard]] std::optional<std::string> written(const std::string& path) const;
  /// The keys of a section, in order; none where it is not written.
  [[nodiscard]] std::vector<std::string> keys(const std::string& section) const;
  [[nodiscard]] const std::string& name() const;
  /// Throws InvalidInput about a key ("structure.length"): file and line or option, key, value, rule. Where the key is not
  /// written, about its section.
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

/// Voltages that the units Vsp and Vdp stand for.
struct PullInVoltages {
  double static_pull_in = 0;   ///< Vsp [V]
  double dynamic_pull_in = 0;  ///< Vdp [V]
};

/// The limit of an electrode without [driver], in a search: by the larger of Vsp and Vdp.
inline constexpr double default_max_voltage = 1.5;
[[nodiscard]] inline double default_limit(const PullInVoltages& pull_in) {
  return default_max_voltage * std::max(pull_in.static_pull_in, pull_in.dynamic_pull_in);
}
/// "1.5 Vsp".
[[nodiscard]] std::string default_limit_words(const PullInVoltages& pull_in);

/// The names of the piezo and of the dispersion force among the drives.
inline constexpr std::string_view piezo_drive = "piezo", dispersion_drive = "dispersion";

/// One drive of a switch, in volts: an electrode or the piezo. That of the dispersion force is its factor less one, so that every
/// drive rests at 0.
struct Drive {
  std::string name = {};                    ///< of the electrode, piezo_drive or dispersion_drive
  std::optional<Waveform> waveform = {};    ///< none: it stays at 0 V
  std::optional<double> before = {};        ///< what is given of it before t = 0 [V]; none: 0 V
  bool begins_closed = false;               ///< its before_state: see Scene::begins_closed
  std::optional<DriverLimits> limits = {};  ///< none: unlimited; of electrodes whose Vdp is known [0, default_limit()]
  DriverModel source = {};                  ///< ideal where the scene says nothing of it; without load before prepare()
  std::optional<double> amplifier = {};     ///< volts at the switch, of which all here are, per volt of the source
  SourceErrors errors = {};                 ///< gain, offset and delay of the source

  [[nodiscard]] double hold_level() const;                                  ///< [V]
  [[nodiscard]] double value_before() const { return before.value_or(0); }  ///< before t = 0 [V]
};

/// The names of the drives of a device, in the order of Switch::drives().
[[nodiscard]] std::vector<std::string> drive_names(const Device& device);

/// The drives of a switch, in the order of Switch::drives().
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
  /// Null where the switch has no such drive.
  [[nodiscard]] const Drive* find(std::string_view name) const;
  /// Throws InvalidInput where the switch has no such drive.
  [[nodiscard]] const Drive& at(std::string_view name) const { return drives_[place(name)]; }
  [[nodiscard]] Drive& at(std::string_view name) { return drives_[place(name)]; }
  /// k of Switch::drives(). Throws InvalidInput where the switch has no such drive.
  [[nodiscard]] std::size_t place(std::string_view name) const;
  /// Those of these names, in the order of the names. Throws InvalidInput where one is missing.
  [[nodiscard]] Drives of(const std::vector<std::string>& names) const;
  /// The waveforms that are given, by name.
  [[nodiscard]] DriveWaveforms waveforms() const;
  /// What is given of them before t = 0, by name [V].
  [[nodiscard]] std::map<std::string, double> before() const;

 private:
  std::vector<Drive> drives_;
};

struct SimulateOptions {
  double duration = 0;     ///< [s]; 0: choose (six periods of the first mode, or four closings by a step)
  double accuracy = 1e-6;  ///< target relative error of t_i, v_i and B_H
  double tolerance = 0;    ///< relative tolerance of the integrator; 0: derived from accuracy
  double open_at = std::numeric_limits<double>::quiet_NaN();  ///< the switch is commanded to open [s]; NaN: told from the drives
  bool automatic_effects = false;                             ///< leave out what changes no figure by more than effects_tolerance
  double effects_tolerance = 1e-3;                            ///< relative, of t_i, v_i and B_H
};

/// What is measured on every device before it is driven: the waveform is then a recipe in the device's own units, V(t) = Vdp f(t
/// f_1), of a piezo V(t) = f(t f_1) / p with p its unit, and the scene's own waveform is that of the nominal device.
struct Calibration {
  /// Of the measurement, relative, one standard deviation; none: it is not measured.
  std::optional<double> pull_in_error = {}, frequency_error = {};
  /// The same of a piezo's unit, the static deflection that it gives the contact point per volt over the contact gap [1/V].
  std::optional<double> piezo_error = {};
  /// Of the closing time of a step to closing_step times the nominal Vdp, one standard deviation [s]; none: it is not measured.
  /// It tells the volts, and is never measured beside Vdp.
  std::optional<double> time_error = {};
  /// Into which devices are sorted by what is measured, each with one waveform; none: every device has its own.
  std::optional<int> classes = {};

  [[nodiscard]] bool is_empty() const { return !pull_in_error && !frequency_error && !piezo_error && !time_error; }
};
/// Names of the measurements in a scene.
inline constexpr std::string_view measured_pull_in = "Vdp", measured_frequency = "frequency", measured_piezo = "piezo",
                                  measured_time = "time";
inline constexpr std::array measurement_names{measured_pull_in, measured_frequency, measured_piezo, measured_time};
/// The step whose closing time is measured, in nominal pull-in voltages (Vdp): slow enough to show what a landing depends on.
inline constexpr double closing_step = 1.2;
/// Of a closing time where nobody says it: of a generator and an oscilloscope [s].
inline constexpr double usual_time_error = 50e-9;
inline constexpr int most_classes = 256;
namespace internal {
inline constexpr std::string_view classes_key = "classes";
}

struct Scene {
  std::string title;
  Device device;
  SimulateOptions simulate;
  bool auto_modes =
      false;  ///< modes = "auto": device has the default number until someone chooses (studies/closing/auto_modes.h)
  MetricsOptions metrics;
  DeviceSpread spread;
  Calibration calibration;
  /// Runs begin in the closed equilibrium under what the drives stand at before t = 0, not in the open one.
  bool begins_closed = false;
  /// Drives (electrode names) whose waveform or written limits use Vsp or Vdp.
  std::vector<std::string> need_pull_in;
  /// Those of them whose limits alone are in Vsp or Vdp.
  std::vector<std::string> limits_in_pull_in = {};
  /// What each drive stands at where the pull-in voltages of another are asked for, in the order of Switch::drives(): its hold
  /// level where that does not depend on Vsp or Vdp, else 0 V; of the dispersion force the factor less one.
  std::vector<double> standing;
  std::vector<std::string> file_notes = {};  ///< what was taken from files of instruments, one line each
  std::vector<std::string> warnings;
  SceneFile file;

  /// Waveforms and limits in volts. `pull_in` must hold every electrode of need_pull_in; electrodes missing from it get no
  /// default limit. Throws InvalidInput for a waveform outside its family's rules or outside its driver's limits.
  [[nodiscard]] Drives drives(const std::map<std::string, PullInVoltages>& pull_in) const;
};

/// Throws InvalidInput whose message has file, line, key path, value, rule and, for an unknown key, the nearest known one.
/// Everything is checked here, waveforms included (up to what needs the pull-in voltages).
[[nodiscard]] Scene read_scene(const SceneFile& file);

/// The scene with every default written out and every voltage in volts; what has no fixed default (a duration that is chosen)
/// stays absent. Throws as Scene::drives does. Its messages say "NAME (resolved)", because its lines are not those of the file.
[[nodiscard]] SceneFile resolved(const Scene& scene, const std::map<std::string, PullInVoltages>& pull_in);

/// The scene with every default written out, quantities in SI units, multiples of pull-in voltages as such, and the content of
/// the files it names in their place: equal scenes have equal texts, however they are written, and this one needs no other file.
/// Messages about it say `name` and no line. Throws as read_scene() does.
[[nodiscard]] SceneFile canonical(const SceneFile& file, const std::string& name);

}  // namespace softland
