#include "config/drives.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <variant>

#include "base/engineering.h"
#include "base/require.h"
#include "config/file_rows.h"
#include "config/section_reader.h"
#include "config/units.h"

namespace softland::internal {
namespace {

constexpr std::string_view main_drive = "main";

enum class LimitChecks { without_pull_in, all };

/// Checks that NAME of every [section.NAME] is the name of a drive (electrode or piezo) of the device.
void check_names(const SceneFile::Impl& file, const std::string& section, const Device& device) {
  for (const std::string& name : file.names_in(section)) {
    const std::string path = join_path(section, name);
    if (name == dispersion_drive && section == "driver")
      file.fail_section(path, "the dispersion force has no driver: remove this section");
    if (const std::string why = why_no_drive(device, name); !why.empty()) file.fail_section(path, why);
  }
}

bool on_far_side(const Device& device, std::string_view drive) {
  return std::any_of(device.electrodes.begin(), device.electrodes.end(),
                     [&](const Electrode& e) { return e.name == drive && e.side == Side::far; });
}

void refuse_pull_in_units(const SectionReader& in, const Device& device, std::string_view drive) {
  const bool far = on_far_side(device, drive);
  if (drive != piezo_drive && !far) return;
  for (const std::string_view key : in.keys_in_pull_in_units()) {
    in.require(false, key,
               far ? "an electrode on the far side has no pull-in voltage; give it volts [V]"
                   : "pull-in voltages belong to electrodes; give the piezo volts [V]");
  }
}

double volts(const Quantity& quantity, const PullInVoltages& pull_in) {
  if (quantity.dimension == dimension::static_pull_in) return quantity.value * pull_in.static_pull_in;
  if (quantity.dimension == dimension::dynamic_pull_in) return quantity.value * pull_in.dynamic_pull_in;
  return quantity.value;
}

std::vector<double> volts(const std::vector<Quantity>& quantities, const PullInVoltages& pull_in) {
  std::vector<double> values;
  for (const Quantity& quantity : quantities) values.push_back(volts(quantity, pull_in));
  return values;
}

/// Voltages and slew limit that convert percentages, multiples of pull-in voltages and rise_time = "driver" to SI units.
struct References {
  std::string_view drive;
  const PullInVoltages& pull_in;
  const std::optional<double>& main_hold;                     ///< hold voltage of main_electrode() [V]
  double max_slew = std::numeric_limits<double>::infinity();  ///< slew limit of the voltage source [V/s]
  double before = 0;                                          ///< voltage of the drive before t = 0 [V]
};

/// Returns a voltage difference of a waveform in volts. In the scene it may be a percentage of `base`, the level to which the
/// difference is added; a percentage in a waveform of the piezo is one of the main electrode's hold voltage.
double swing(const SectionReader& in, std::string_view key, const Quantity& given, const References& to, double base) {
  if (given.dimension != dimension::none || to.drive == dispersion_drive) return volts(given, to.pull_in);
  if (to.drive != piezo_drive) {
    in.require(base != 0, key, "is a percentage of the base level, which is 0 V: give volts");
    return given.value * base;
  }
  in.require(
      to.main_hold.has_value(), key,
      "is a percentage of the hold voltage of the main electrode, but no electrode is called 'main' and there are several: "
      "give volts");
  in.require(*to.main_hold != 0, key, "is a percentage of the hold voltage of the main electrode, which is 0 V: give volts");
  return given.value * *to.main_hold;
}

void read_list(const SectionReader& in, std::string_view key, ParameterKind kind, const References& to, double base,
               std::vector<double>& list) {
  if (kind == ParameterKind::swing) {
    for (const Quantity& given : in.quantities(key)) list.push_back(swing(in, key, given, to, base));
  } else {
    list = kind == ParameterKind::level ? volts(in.quantities(key), to.pull_in) : in.numbers(key);
  }
}

template <class Family>
Waveform read_parameters(const SectionReader& in, const References& to) {
  Family waveform;
  double base = 0;  // last voltage level read so far [V]; a percentage of a voltage difference refers to this level
  for (const Parameter<Family>& p : FamilyOf<Family>::parameters) {
    const auto* one = std::get_if<double Family::*>(&p.member);
    if (one == nullptr) {
      read_list(in, p.name, p.kind, to, base, waveform.*std::get<std::vector<double> Family::*>(p.member));
      continue;
    }
    double& value = waveform.*(*one);
    if (p.kind == ParameterKind::level) {
      value = base = volts(in.quantities(p.name).front(), to.pull_in);
    } else if (p.kind == ParameterKind::swing) {
      value = swing(in, p.name, in.quantities(p.name).front(), to, base);
    } else if (p.kind == ParameterKind::angular_frequency && in.is_given(frequency_key)) {
      value = 2 * std::numbers::pi * in.number(frequency_key);
    } else if (in.is_word(p.name)) {  // rise_time = "driver" (steepest_rise): rise from `before` to the level at max_slew
      value = std::abs(base - to.before) / to.max_slew;
    } else if (in.has_value(p.name)) {
      value = in.number(p.name);
    }
  }
  return waveform;
}

Waveform read_waveform(const SectionReader& in, const References& to) {
  for (const std::string_view key : file_keys::all)
    in.require(!in.is_given(key), key, "describes a file: give the key file too, or omit this key");
  std::optional<Waveform> waveform;
  for_each_family([&]<class Family>(const Family&) {
    if (in.text("family") == FamilyOf<Family>::name) waveform = read_parameters<Family>(in, to);
  });
  return waveform.value();
}

Signal compile(const SectionReader& in, const Waveform& waveform, double before) {
  try {
    return signal(waveform, before);
  } catch (const InvalidParameter& error) {
    in.require(!in.is_given(error.parameter()), error.parameter(), error.what());
    in.fail(error.what());
  } catch (const InvalidInput& error) {
    in.fail(error.what());
  }
}

/// Returns the permitted range of a drive voltage [V]. A voltage that the scene gives as a multiple of Vsp or Vdp must be in
/// this range as well, because a resolved scene states the voltage in volts and must be valid.
const Range& any_voltage() {
  static const Range range = Key{.dimensions = {dimension::voltage}}.range_of(dimension::voltage);
  return range;
}

/// Reads the voltage and slew limits of a drive's source; none if it has no limit. An electrode of known pull-in voltages has
/// default_limit() as its default voltage limit.
std::optional<DriverLimits> read_limits(const SectionReader& in, std::string_view drive, const PullInVoltages& known) {
  DriverLimits limits{.min_voltage = 0, .max_voltage = std::numeric_limits<double>::infinity()};
  if (known.dynamic_pull_in > 0 && drive != piezo_drive) {
    limits.max_voltage = std::min(default_limit(known), any_voltage().most);
  } else if (!in.is_present()) {
    return std::nullopt;
  }
  const auto read = [&](std::string_view key, double& limit) {
    if (!in.is_given(key)) return;
    limit = volts(in.quantities(key).front(), known);
    in.require(any_voltage().contains(limit), key, any_voltage().rule("V"));
  };
  read("min_voltage", limits.min_voltage);
  read("max_voltage", limits.max_voltage);
  if (in.is_given("max_slew")) limits.max_slew = in.number("max_slew");
  return limits;
}

/// Reads the voltage source of a drive, without its load: prepare() adds the capacitance of the switch.
DriverModel read_model(const SectionReader& in, std::string_view drive) {
  DriverModel model;
  if (!in.is_present()) return model;
  const auto read = [&](std::string_view key, std::optional<double>& to) {
    if (in.is_given(key)) to = in.number(key);
  };
  read("sample_rate", model.sample_rate);
  read("bandwidth", model.bandwidth);
  read("source_resistance", model.source_resistance);
  if (in.is_given("bits")) {
    model.bits = in.integer("bits");
    in.require(model.sample_rate.has_value(), "bits", "needs sample_rate, because samples are rounded");
    in.require(in.is_given("max_voltage"), "bits", "needs max_voltage: it divides the voltages from min_voltage to max_voltage");
  }
  in.require(!model.source_resistance || drive != piezo_drive, "source_resistance",
             "must not be given for a piezo layer: it is the resistance that charges an electrode");
  if (in.is_given("parallel_capacitance")) {
    model.parallel_capacitance = in.number("parallel_capacitance");
    in.require(model.parallel_capacitance == 0 || model.source_resistance, "parallel_capacitance",
               "needs source_resistance, through which this capacitance is charged");
  }
  return model;
}

/// Reads the errors of a voltage source by which the applied voltage differs from the commanded voltage.
SourceErrors read_errors(const SectionReader& in) {
  SourceErrors errors;
  if (!in.is_present()) return errors;
  if (in.is_given("gain")) errors.gain = in.number("gain");
  if (in.is_given("offset")) errors.offset = in.number("offset");
  if (in.is_given("delay")) errors.delay = in.number("delay");
  return errors;
}

void check_order(const SectionReader& in, const DriverLimits& limits) {
  if (limits.min_voltage < limits.max_voltage) return;
  const std::string_view key = in.is_given("min_voltage") ? "min_voltage" : "max_voltage";
  in.require(false, key,
             fmt::format("min_voltage of {} V must be less than max_voltage of {} V", limits.min_voltage, limits.max_voltage));
}

// Returns the advice to give rise_time to a step waveform that obeys the voltage limits of its source but not the slew limit;
// an empty text for any other waveform.
std::string missing_rise(const Waveform& waveform, double before, const DriverLimits& limits) {
  const Step* const step = std::get_if<Step>(&waveform);
  if (step == nullptr || std::max(step->level, before) > limits.max_voltage || std::min(step->level, before) < limits.min_voltage)
    return {};
  return fmt::format("; rise_time = \"{}\" gives the fastest permitted rise, {}", steepest_rise,
                     engineering(std::abs(step->level - before) / limits.max_slew, "s", 3));
}

/// Returns the electrode whose hold voltage is 100 % for a percentage in a waveform of the piezo; empty when the device has no
/// such electrode.
std::string_view main_electrode(const Device& device) {
  for (const Electrode& electrode : device.electrodes) {
    if (electrode.name == main_drive || device.electrodes.size() == 1) return electrode.name;
  }
  return {};
}

/// Reads the waveforms and sources of all drives. Adds to `notes`, unless null, a note for the user on every instrument file.
Drives read_all(const SceneFile::Impl& file, const Device& device, const std::map<std::string, PullInVoltages>& pull_in,
                LimitChecks checks, std::vector<std::string>* notes = nullptr) {
  std::vector<Drive> drives;
  std::optional<double> main_hold;
  if (!main_electrode(device).empty()) main_hold = 0;
  // drive_names() lists the piezo after the electrodes: its voltages may be percentages of the main electrode's hold voltage.
  for (const std::string& drive : drive_names(device)) {
    Drive& one = drives.emplace_back(Drive{.name = drive});
    const auto found = pull_in.find(one.name);
    const PullInVoltages known = found == pull_in.end() ? PullInVoltages{} : found->second;

    const SectionReader driver(file, "driver", drive);
    const std::optional<DriverLimits>& limits = one.limits = read_limits(driver, drive, known);
    const bool check_limits =
        limits && (checks == LimitChecks::all || (driver.keys_in_pull_in_units().empty() && driver.is_given("max_voltage")));
    if (check_limits) check_order(driver, *limits);
    if (const DriverModel model = read_model(driver, drive); !model.is_ideal()) one.source = model;
    one.errors = read_errors(driver);
    if (driver.is_present() && driver.is_given("amplifier")) one.amplifier = driver.number("amplifier");

    const SectionReader in(file, "waveform", drive);
    if (!in.is_present()) continue;
    // In a scene, the waveform of the dispersion force is a factor on the force; the value of the drive is the factor minus 1.
    const double offset = drive == dispersion_drive ? -1 : 0;
    one.begins_closed = in.is_given(before_state_key) && in.text(before_state_key) == closed_state_word;
    if (in.is_given(before_key)) one.before = offset + volts(in.quantities(before_key).front(), known);
    Waveform waveform;
    if (in.is_given(file_key)) {
      FileRows rows = read_file_rows(in, drive, driver);
      if (rows.before && !in.is_given(before_key)) one.before = offset + *rows.before;
      if (notes != nullptr && !rows.note.empty()) notes->push_back(std::move(rows.note));
      waveform = std::move(rows.table);
    } else {
      waveform = read_waveform(in, {.drive = drive,
                                    .pull_in = known,
                                    .main_hold = main_hold,
                                    .max_slew = limits ? limits->max_slew : std::numeric_limits<double>::infinity(),
                                    .before = one.value_before()});
    }
    if (offset != 0) waveform = raised(std::move(waveform), offset);
    const double before = one.value_before();
    const Signal compiled = compile(in, waveform, before);
    if (const double peak = compiled.peak(); drive != dispersion_drive && !any_voltage().contains(peak)) {
      file.fail_section(in.path(), fmt::format("reaches {}: {}", engineering(peak, "V"), any_voltage().rule("V")));
    }
    if (drive == main_electrode(device)) main_hold = compiled.hold_level();
    if (limits && checks == LimitChecks::all) {
      const bool may_be_samples = !one.source.is_ideal() && std::holds_alternative<Table>(waveform);
      std::string broken = violation(compiled, may_be_samples ? limits_of_samples(*limits, one.source) : *limits);
      if (!broken.empty()) {
        if (!driver.is_present())
          broken += fmt::format("; without [{}] the limits are 0 V and {}", driver.path(), default_limit_prose(known));
        broken += missing_rise(waveform, before, *limits);
        file.fail_section(in.path(), broken);
      }
    }
    one.waveform = std::move(waveform);
  }
  return Drives(std::move(drives));
}

/// Returns the hold voltages of all drives, in order, computed as if Vsp and Vdp of the drives in need_pull_in were `volt` [V].
/// Adds to `notes`, unless null, a note for the user on every instrument file.
std::vector<double> levels_held(const SceneFile::Impl& file, const Scene& scene, double volt, std::vector<std::string>* notes) {
  std::map<std::string, PullInVoltages> pull_in;
  for (const std::string& drive : scene.need_pull_in) pull_in[drive] = {.static_pull_in = volt, .dynamic_pull_in = volt};
  std::vector<double> levels;
  for (const Drive& drive : read_all(file, scene.device, pull_in, LimitChecks::without_pull_in, notes))
    levels.push_back(drive.hold_level());
  return levels;
}

/// Returns true if simulations begin with the switch closed. Throws InvalidInput if drives have different before_state.
bool begins_closed(const SceneFile::Impl& file, const Device& device) {
  std::string closed;  // key of a drive whose before_state is closed
  for (const std::string& drive : drive_names(device)) {
    const SectionReader in(file, "waveform", drive);
    if (!in.is_present() || !in.is_given(before_state_key) || in.text(before_state_key) != closed_state_word) continue;
    in.require(device.has_contact(), before_state_key, "needs a [contact]: a switch without a contact cannot be closed");
    closed = join_path(in.path(), before_state_key);
  }
  if (closed.empty()) return false;
  for (const std::string& drive : drive_names(device)) {
    const SectionReader in(file, "waveform", drive);
    if (!in.is_present() || !in.is_given(before_state_key)) continue;
    in.require(in.text(before_state_key) == closed_state_word, before_state_key,
               fmt::format("contradicts {} = \"closed\": all drives must name the same initial state of the switch", closed));
  }
  return true;
}

}  // namespace

Dimension dimension_of(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::level:
    case ParameterKind::swing:
      break;
    case ParameterKind::time:
    case ParameterKind::end_time:
      return dimension::time;
    case ParameterKind::angular_frequency:
      return dimension::angular_frequency;
    case ParameterKind::angle:
      return dimension::angle;
    case ParameterKind::ratio:
      return dimension::none;
  }
  return dimension::voltage;
}

Waveform raised(Waveform waveform, double by) {
  std::visit(
      [&]<class Family>(Family& w) {
        for (const Parameter<Family>& p : FamilyOf<Family>::parameters) {
          if (p.kind != ParameterKind::level) continue;
          if (const auto* one = std::get_if<double Family::*>(&p.member)) {
            w.*(*one) += by;
          } else {
            for (double& level : w.*std::get<std::vector<double> Family::*>(p.member)) level += by;
          }
        }
      },
      waveform);
  return waveform;
}

std::string why_no_drive(const Device& device, const std::string& name) {
  const std::vector<std::string> known = drive_names(device);
  if (std::find(known.begin(), known.end(), name) != known.end()) return {};
  if (name == piezo_drive) return "the scene has no [piezo] layer";
  if (name == dispersion_drive) return "the scene has no [dispersion] force";
  return "unknown electrode" + hint(name, {known.begin(), known.end()});
}

void check_drive_name(const SceneFile::Impl& file, const std::string& electrode) {
  const std::string path = join_path("electrode", electrode);
  if (electrode == piezo_drive) file.fail_section(path, "the name 'piezo' is reserved for the piezo layer");
  if (electrode == dispersion_drive) file.fail_section(path, "the name 'dispersion' is reserved for the dispersion force");
  // Largest length of an electrode's name, which becomes a column of CSV files and a node of SPICE circuits.
  constexpr std::size_t longest = 64;
  if (electrode == "time_s") file.fail_section(path, "the name 'time_s' is reserved for the time in CSV files");
  if (!is_bare_key(electrode) || electrode.size() > longest) {
    file.fail_section(path, fmt::format("a name must consist of at most {} letters, digits, '_' and '-'", longest));
  }
}

void check_drives(const SceneFile::Impl& file, Scene& scene) {
  const Device& device = scene.device;
  check_names(file, "waveform", device);
  check_names(file, "driver", device);
  for (const std::string& drive : drive_names(device)) {
    const SectionReader waveform(file, "waveform", drive);
    const SectionReader driver(file, "driver", drive);
    refuse_pull_in_units(waveform, device, drive);
    refuse_pull_in_units(driver, device, drive);
    if (drive == piezo_drive && driver.is_present()) {
      for (const std::string_view key : {"min_voltage", "max_voltage"}) {
        if (!driver.is_given(key))
          file.fail_section(driver.path(), fmt::format("missing key '{}' (a voltage such as \"1 V\")", key));
      }
    }
    if (!waveform.keys_in_pull_in_units().empty() || !driver.keys_in_pull_in_units().empty()) {
      scene.need_pull_in.emplace_back(drive);
      if (waveform.keys_in_pull_in_units().empty()) scene.limits_in_pull_in.emplace_back(drive);
    }
  }
  // The pull-in voltages are not known yet, so read the waveforms with 1 V in their place: the rules of the waveform families,
  // such as the order of times, hold for any value. A hold level that differs for 1 V and 0.5 V is a multiple of Vsp or Vdp.
  scene.standing = levels_held(file, scene, 1, &scene.file_notes);
  scene.begins_closed = begins_closed(file, device);
  if (scene.need_pull_in.empty()) return;
  const std::vector<double> of_half = levels_held(file, scene, 0.5, nullptr);
  for (std::size_t k = 0; k < of_half.size(); ++k) {
    if (scene.standing[k] != of_half[k]) scene.standing[k] = 0;
  }
}

Drives read_drives(const SceneFile::Impl& file, const Device& device, const std::map<std::string, PullInVoltages>& pull_in) {
  return read_all(file, device, pull_in, LimitChecks::all);
}

}  // namespace softland::internal
