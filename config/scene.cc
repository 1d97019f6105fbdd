#include "config/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/engineering.h"
#include "base/require.h"
#include "config/drives.h"
#include "config/file_rows.h"
#include "config/modal_table.h"
#include "config/section_reader.h"
#include "config/spread_reader.h"
#include "model/built_beam.h"

namespace softland {
namespace {

using internal::SectionReader;

void check_section_names(const SceneFile::Impl& file) {
  std::vector<std::string_view> known;
  for (const internal::Section& section : internal::schema()) {
    if (!section.name.empty() && section.entry.empty()) known.push_back(section.name);
  }
  for (const auto& [name, node] : file.root) {
    if (internal::find_section("")->find(name.str())) continue;
    const std::string path = internal::join_path("", name.str());
    const internal::Section* section = internal::find_section(name.str());
    if (!section || name.str().empty()) {
      if (node.is_table()) file.fail_section(path, "unknown section" + internal::hint(name.str(), known));
      known.emplace_back("title");
      file.fail(path, "unknown key" + internal::hint(name.str(), known));
    }
  }
}

/// Sets the members of the scene that the keys of one section describe, and checks the rules between several keys.
void read_section(Scene& scene, const internal::Section& section, const SectionReader& in, std::string_view name = {}) {
  if (!in.is_present() && !section.always_in_force) return;
  const std::size_t entry = section.begin(scene, in, name);
  in.set_members(scene, entry);
  if (section.check != nullptr) section.check(scene, in, entry);
}

void read_sections(Scene& scene, const SceneFile::Impl& file) {
  for (const internal::Section& section : internal::schema()) {
    if (section.begin == nullptr) continue;
    if (!file.is_named(section)) {
      read_section(scene, section, SectionReader(file, section.name));
      continue;
    }
    for (const std::string& name : file.names_in(std::string(section.name))) {
      if (section.is_named) internal::check_drive_name(file, name);
      read_section(scene, section, SectionReader(file, section.name, name), name);
    }
  }
}

/// Checks that no two electrodes on the same side of the beam overlap.
void check_electrodes(const Device& device, const SceneFile::Impl& file) {
  const auto conflict = electrode_conflict(device.structure, device.electrodes);
  if (!conflict) return;
  const SectionReader in(file, "electrode", device.electrodes[conflict->electrode].name);
  for (const std::string_view key : {"span", "area"}) in.require(!in.is_given(key), key, conflict->why);
  in.fail(conflict->why);
}

void check_contacts(const Device& device, const SceneFile::Impl& file) {
  const auto conflict = contact_conflict(device);
  if (!conflict) return;
  const std::string& name = device.contacts[conflict->contact].name;
  file.fail_section(name.empty() ? "contact" : "contact." + name, conflict->why);
}

Calibration read_calibration(const SceneFile::Impl& file, const Device& device) {
  Calibration calibration;
  const auto error_named = [&](std::string_view name) {
    return name == measured_pull_in     ? &calibration.pull_in_error
           : name == measured_frequency ? &calibration.frequency_error
           : name == measured_piezo     ? &calibration.piezo_error
           : name == measured_time      ? &calibration.time_error
                                        : nullptr;
  };
  for (const std::string& name : file.names_in("calibration")) {
    std::optional<double>* const measured = error_named(name);
    if (measured == nullptr) {
      file.fail_section(internal::join_path("calibration", name),
                        "unknown measurement" + internal::hint(name, {measurement_names.begin(), measurement_names.end()}));
    }
    const SectionReader in(file, "calibration", name);
    const Quantity& error = in.quantities("error").front();
    if (error.value != 0)
      in.require((error.dimension == dimension::time) == (name == measured_time), "error",
                 name == measured_time ? "must be a time [s]" : "must be a percentage or a plain number");
    *measured = error.value;
  }
  if (calibration.piezo_error && !device.piezo)
    file.fail_section("calibration.piezo", "needs a [piezo] layer, whose deflection is measured");
  if (calibration.time_error && calibration.pull_in_error)
    file.fail_section("calibration.time", "must not be combined with Vdp, which gives the voltage scale of a device as well");
  if (const toml::node* classes = file.find({"calibration", std::string(internal::classes_key)})) {
    const std::string path = internal::join_path("calibration", internal::classes_key);
    const auto number = classes->is_integer() ? classes->as_integer()->get() : 0;
    if (number < 2 || number > most_classes) file.fail(path, fmt::format("must be a whole number from 2 to {}", most_classes));
    if (calibration.is_empty())
      file.fail(path, fmt::format("needs a measurement by which devices are sorted: add [calibration.{}] or [calibration.{}]",
                                  measured_pull_in, measured_frequency));
    calibration.classes = static_cast<int>(number);
  }
  return calibration;
}

std::vector<std::string> find_warnings(const SceneFile::Impl& file, const Device& device) {
  std::vector<std::string> warnings;
  if (device.electrodes.empty() && !device.piezo && !file.find({"waveform", "dispersion"})) {
    warnings.push_back(file.name + ": no drive can move this switch: add [electrode.NAME] or [piezo]");
  }
  if (const auto& surface = device.surface; surface && surface->residual_stress != 0 && !device.structure.has_far_clamp() &&
                                            surface->cantilever_load == ResidualLoad::none) {
    warnings.push_back(fmt::format(
        "{}: surface.residual_stress has no effect on a cantilever; surface.cantilever_load selects its effect", file.name));
  }
  constexpr double wide = 5;          // ratio of width to thickness above which a beam bends more like a plate
  constexpr double rounding = 1e-12;  // a width of exactly five thicknesses, as 20 um to 4 um, must give no warning
  const Structure& structure = device.structure;
  const auto* const beam = structure.find<Beam>();
  if (beam != nullptr && structure.is_built() && !beam->plate_strain && !file.find({"structure", "plate_strain"})) {
    for (const LocalSection& local : local_sections(structure)) {
      if (std::max(local.width, local.end_width) <= wide * local.thickness * (1 + rounding)) continue;
      warnings.push_back(fmt::format(
          "{}: structure: wider than five thicknesses from {} to {}; "
          "moduli are used as given (plate_strain = false), plate_strain = true with poissons_ratio would use E / (1 - nu^2)",
          file.origin("structure").text, engineering(local.begin, "m"), engineering(local.end, "m")));
      break;
    }
  } else if (beam != nullptr && !file.find({"structure", "plate_strain"}) &&
             structure.width > wide * structure.thickness * (1 + rounding)) {
    warnings.push_back(
        fmt::format("{}: {}: more than five thicknesses; youngs_modulus is used as given (plate_strain = false), "
                    "plate_strain = true with poissons_ratio would use E / (1 - nu^2)",
                    file.origin("structure.width").text, file.written("structure.width")));
  }
  if (beam != nullptr && beam->plate_strain && device.piezo && std::isnan(device.piezo->e31)) {
    const double more = 1 / (1 - beam->poissons_ratio) - 1;
    warnings.push_back(fmt::format(
        "{}: with plate_strain = true a layer pulls across the width as well: "
        "its moment is {:.0f} % above that of d31 at the beam's Poisson's ratio; give e31 = d31 E / (1 - nu) of the layer",
        file.origin("piezo.d31").text, 100 * more));
  }
  if (const auto* const modal = structure.find<ModalStructure>();
      modal != nullptr && modal->table->has_far_clamp() && std::isnan(modal->axial_stiffness)) {
    warnings.push_back(
        fmt::format("{}: between two clamps bending stretches the structure, "
                    "which is simulated where structure.axial_stiffness (E A / L of an even beam) is given; "
                    "without it deflections must be small against the thickness",
                    file.origin("structure.far_anchor").text));
  }
  if (const auto* adhesive = device.has_contact() ? std::get_if<AdhesiveAsperities>(&device.contacts.front().model) : nullptr) {
    const double tabor = adhesive->tabor_number();
    if (tabor > AdhesiveAsperities::largest_tabor_number)
      warnings.push_back(fmt::format(
          "{}: the Tabor number of its summits is {:.2g}; the adhesion of this law (DMT) is for numbers below about {:.1g}: "
          "soft or strongly adhesive summits have as little as 3/4 of its pull-off force, and dissipate energy",
          file.origin("contact.adhesion_energy").text, tabor, AdhesiveAsperities::largest_tabor_number));
  }
  return warnings;
}

/// Warns if a number of [structure] varies while sections of the beam have their own fixed value of this number.
void warn_of_fixed_sections(const SceneFile::Impl& file, const DeviceSpread& spread, std::vector<std::string>& warnings) {
  const auto* const beam_sections = file.find({"structure", "sections"});
  if (beam_sections == nullptr || !beam_sections->is_array()) return;
  std::set<std::string> varied;
  for (const SpreadVariable& variable : spread.variables) {
    for (const VariedKey& key : variable.keys) varied.insert(key.path);
  }
  for (const SpreadVariable& variable : spread.variables) {
    for (const std::string key : {"width", "thickness", "youngs_modulus", "density"}) {
      const std::string whole = "structure." + key;
      if (std::ranges::find(variable.keys, whole, &VariedKey::path) == variable.keys.end()) continue;
      std::vector<std::string> fixed;
      for (std::size_t k = 1; k <= beam_sections->as_array()->size(); ++k) {
        const std::string section = fmt::format("sections[{}]", k);
        std::string own = fmt::format("structure.{}.{}", section, key);
        if (file.find({"structure", section, key}) != nullptr && !varied.contains(own)) fixed.push_back(std::move(own));
      }
      if (fixed.empty()) continue;
      warnings.push_back(fmt::format("{}: {} {} not vary with {}: name all of them in keys of one entry of [spread]",
                                     file.origin(join_path("spread", variable.name)).text, fmt::join(fixed, ", "),
                                     fixed.size() == 1 ? "does" : "do", whole));
    }
  }
}

/// Returns the sections of the scene as one TOML table: those in the file, and those whose defaults apply without a section.
/// The function keys_of(reader) must return the keys of a section, as SectionReader::with_defaults() does. The section [spread]
/// is that of resolved_spread().
template <class KeysOf>
toml::table sections_of(const SceneFile::Impl& file, KeysOf&& keys_of) {
  toml::table root;
  for (const internal::Section& section : internal::schema()) {
    const std::string name(section.name);
    if (name == "spread") {
      if (toml::table spread = internal::resolved_spread(file); !spread.empty()) root.insert(name, std::move(spread));
    } else if (name.empty()) {
      root = keys_of(SectionReader(file, ""));
    } else if (!file.is_named(section)) {
      const SectionReader in(file, name);
      if (in.is_present() || section.always_in_force) root.insert(name, keys_of(in));
    } else {
      toml::table named;
      for (const std::string& entry : file.names_in(name)) named.insert(entry, keys_of(SectionReader(file, name, entry)));
      if (const toml::node* key = section.beside.empty() ? nullptr : file.find({name, std::string(section.beside)}))
        key->visit([&](const auto& node) { named.insert(section.beside, node); });
      if (!named.empty()) root.insert(name, std::move(named));
    }
  }
  return root;
}

}  // namespace

Scene read_scene(const SceneFile& file) {
  const SceneFile::Impl& impl = file.impl();
  check_section_names(impl);
  Scene scene{
      .title = {}, .device = {}, .simulate = {}, .metrics = {}, .need_pull_in = {}, .standing = {}, .warnings = {}, .file = file};
  read_sections(scene, impl);
  if (impl.own_contact) {
    if (scene.device.has_contact())
      impl.fail_section("contact", "must be omitted: a program has already given this scene a contact law");
    scene.device.contacts = {*impl.own_contact};
  }
  check_electrodes(scene.device, impl);
  check_contacts(scene.device, impl);
  internal::check_drives(impl, scene);
  internal::read_spread(scene, impl);
  scene.calibration = read_calibration(impl, scene.device);
  scene.warnings = find_warnings(impl, scene.device);
  warn_of_fixed_sections(impl, scene.spread, scene.warnings);
  scene.warnings.insert(scene.warnings.begin(), scene.file_notes.begin(), scene.file_notes.end());
  try {
    validate(scene.device);
  } catch (const InvalidInput& error) {
    throw InvalidInput(fmt::format("{}: {}", impl.name, error.what()));
  }
  return scene;
}

std::vector<std::string> drive_names(const Device& device) {
  std::vector<std::string> names;
  for (const Electrode& electrode : device.electrodes) names.push_back(electrode.name);
  if (device.dispersion) names.emplace_back(dispersion_drive);
  if (device.piezo) names.emplace_back(piezo_drive);
  return names;
}

double Drive::hold_level() const { return waveform ? signal(*waveform).hold_level() : 0; }

const Drive* Drives::find(std::string_view name) const {
  const auto found = std::ranges::find(drives_, name, &Drive::name);
  return found == drives_.end() ? nullptr : &*found;
}

std::size_t Drives::place(std::string_view name) const {
  const Drive* const found = find(name);
  require(found != nullptr, [&] { return fmt::format("unknown drive '{}'", name); });
  return static_cast<std::size_t>(found - drives_.data());
}

Drives Drives::of(const std::vector<std::string>& names) const {
  Drives some;
  for (const std::string& name : names) some.drives_.push_back(at(name));
  return some;
}

DriveWaveforms Drives::waveforms() const {
  DriveWaveforms all;
  for (const Drive& drive : drives_) {
    if (drive.waveform) all.emplace(drive.name, *drive.waveform);
  }
  return all;
}

std::map<std::string, double> Drives::before() const {
  std::map<std::string, double> all;
  for (const Drive& drive : drives_) {
    if (drive.before) all.emplace(drive.name, *drive.before);
  }
  return all;
}

Drives Scene::drives(const std::map<std::string, PullInVoltages>& pull_in) const {
  for (const std::string& name : need_pull_in) {
    const auto known = pull_in.find(name);
    require(known != pull_in.end(), fmt::format("{}: the pull-in voltages of electrode '{}' are needed", file.name(), name));
    const auto& [static_voltage, dynamic_voltage] = known->second;
    require(static_voltage > 0 && dynamic_voltage > 0 && std::isfinite(static_voltage) && std::isfinite(dynamic_voltage),
            fmt::format("{}: electrode '{}' has no pull-in voltage (static {} V, dynamic {} V) to multiply", file.name(), name,
                        static_voltage, dynamic_voltage));
  }
  return internal::read_drives(file.impl(), device, pull_in);
}

std::string default_limit_prose(const PullInVoltages& pull_in) {
  return fmt::format("{} {}", default_max_voltage, pull_in.static_pull_in > pull_in.dynamic_pull_in ? "Vsp" : "Vdp");
}

SceneFile resolved(const Scene& scene, const std::map<std::string, PullInVoltages>& pull_in) {
  const Drives drives = scene.drives(pull_in);
  const SceneFile::Impl& impl = scene.file.impl();
  toml::table root = sections_of(impl, [](const SectionReader& in) { return in.with_defaults(); });
  internal::hold_table(root, scene.device.structure);
  for (const char* drive_section : {"waveform", "driver"}) root.erase(drive_section);
  toml::table drivers;
  for (const Drive& drive : drives) {
    if (!drive.limits) continue;
    toml::table keys;
    const auto insert = [&](std::string_view key, double value, const Dimension& unit) {
      if (std::isfinite(value)) keys.insert(key, quantity_text(value, unit));
    };
    insert("min_voltage", drive.limits->min_voltage, dimension::voltage);
    insert("max_voltage", drive.limits->max_voltage, dimension::voltage);
    insert("max_slew", drive.limits->max_slew, dimension::slew_rate);
    const DriverModel& source = drive.source;
    if (source.bandwidth) insert("bandwidth", *source.bandwidth, dimension::frequency);
    if (source.source_resistance) insert("source_resistance", *source.source_resistance, dimension::resistance);
    if (source.parallel_capacitance > 0) insert("parallel_capacitance", source.parallel_capacitance, dimension::capacitance);
    if (source.sample_rate) insert("sample_rate", *source.sample_rate, dimension::frequency);
    if (source.bits) keys.insert("bits", *source.bits);
    if (drive.amplifier) keys.insert("amplifier", *drive.amplifier);
    if (drive.errors.gain != 1) keys.insert("gain", drive.errors.gain);
    if (drive.errors.offset != 0) insert("offset", drive.errors.offset, dimension::voltage);
    if (drive.errors.delay != 0) insert("delay", drive.errors.delay, dimension::time);
    drivers.insert(drive.name, std::move(keys));
  }
  if (!drivers.empty()) root.insert("driver", std::move(drivers));

  // Write the scene and read it again, so that messages can cite lines of the result.
  SceneFile file = SceneFile::parse(internal::write_scene(root), impl.name + " (resolved)", impl.directory);
  if (impl.own_contact) file.add_contact(*impl.own_contact);
  for (const auto& [name, waveform] : drives.waveforms()) file.set_waveform(name, waveform);
  for (const auto& [name, value] : drives.before()) {
    const bool is_factor = name == dispersion_drive;
    file.assign(internal::join_path(internal::join_path("waveform", name), internal::before_key),
                is_factor ? Quantity{.value = 1 + value, .dimension = dimension::none}
                          : Quantity{.value = value, .dimension = dimension::voltage});
  }
  for (const Drive& drive : drives) {
    if (!drive.begins_closed) continue;
    file.assign(internal::join_path(internal::join_path("waveform", drive.name), internal::before_state_key),
                std::string(internal::closed_state_word));
  }
  return file;
}

SceneFile canonical(const SceneFile& file, const std::string& name) {
  const Scene scene = read_scene(file);
  const SceneFile::Impl& impl = scene.file.impl();
  toml::table root = sections_of(impl, [](const SectionReader& in) { return in.in_si_units(); });
  internal::hold_table(root, scene.device.structure);
  SceneFile same = SceneFile::parse(internal::write_scene(root), name);
  for (const std::string& drive : impl.names_in("waveform")) {
    const SectionReader in(impl, "waveform", drive);
    if (!in.is_given(internal::file_key)) continue;
    internal::FileRows read = internal::read_file_rows(in, drive, SectionReader(impl, "driver", drive));
    const bool is_factor = drive == dispersion_drive;
    Waveform rows = std::move(read.table);
    same.set_waveform(drive, is_factor ? internal::raised(std::move(rows), -1) : std::move(rows));
    if (read.before && !in.is_given(internal::before_key))
      same.assign(internal::join_path(internal::join_path("waveform", drive), internal::before_key),
                  Quantity{.value = *read.before, .dimension = is_factor ? dimension::none : dimension::voltage});
  }
  if (impl.own_contact) same.add_contact(*impl.own_contact);
  same.forget_places();
  return same;
}

}  // namespace softland
